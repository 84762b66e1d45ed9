//! A file's directories and their tags.

use crate::Fault;
use std::io::Cursor;
use tiff::TiffError;
use tiff::decoder::{Decoder, Limits};
pub(super) use tiff::tags::Tag;
pub(super) use tiff::{Directory, tags::ByteOrder};

pub(super) const COLUMNS: Tag = Tag::ImageWidth;
pub(super) const ROWS: Tag = Tag::ImageLength;
pub(super) const PHOTOMETRIC: Tag = Tag::PhotometricInterpretation;
pub(super) const EXTRA_SAMPLES: Tag = Tag::ExtraSamples;
pub(super) const NEW_SUBFILE_TYPE: Tag = Tag::NewSubfileType;
pub(super) const GDAL_METADATA: Tag = Tag::Unknown(42112);
pub(super) const GDAL_NODATA: Tag = Tag::GdalNodata;

/// More directories than any pyramid of images has.
const MOST_DIRECTORIES: usize = 64;

pub(super) struct File<'a> {
    decoder: Decoder<Cursor<&'a [u8]>>,
}

pub(super) fn damaged(error: TiffError) -> Fault {
    Fault::damaged("TIFF", error)
}

impl<'a> File<'a> {
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self, Fault> {
        let decoder = Decoder::new(Cursor::new(bytes)).map_err(damaged)?;
        let mut limits = Limits::default();
        limits.ifd_value_size = 1 << 20;
        Ok(Self { decoder: decoder.with_limits(limits) })
    }

    /// The image's directory, and those after it.
    pub(super) fn directories(&mut self) -> Result<Vec<Directory>, Fault> {
        let mut next = self.decoder.ifd_pointer();
        let mut directories = Vec::new();
        while let Some(pointer) = next
            && directories.len() < MOST_DIRECTORIES
        {
            let directory = self.decoder.read_directory(pointer).map_err(damaged)?;
            next = directory.next();
            directories.push(directory);
        }
        Ok(directories)
    }

    pub(super) fn byte_order(&self) -> ByteOrder {
        self.decoder.byte_order()
    }

    /// The whole numbers of a tag; none where it is absent.
    pub(super) fn numbers(&mut self, directory: &Directory, tag: Tag) -> Result<Vec<u64>, Fault> {
        let value = self.decoder.read_directory_tags(directory).find_tag(tag).map_err(damaged)?;
        value.map_or(Ok(Vec::new()), |value| value.into_u64_vec().map_err(damaged))
    }

    /// The first whole number of a tag.
    pub(super) fn number(&mut self, directory: &Directory, tag: Tag) -> Result<Option<u64>, Fault> {
        Ok(self.numbers(directory, tag)?.first().copied())
    }

    pub(super) fn doubles(&mut self, directory: &Directory, tag: Tag) -> Result<Option<Vec<f64>>, Fault> {
        let value = self.decoder.read_directory_tags(directory).find_tag(tag).map_err(damaged)?;
        value.map(|value| value.into_f64_vec().map_err(damaged)).transpose()
    }

    pub(super) fn text(&mut self, directory: &Directory, tag: Tag) -> Result<Option<String>, Fault> {
        let value = self.decoder.read_directory_tags(directory).find_tag(tag).map_err(damaged)?;
        value.map(|value| value.into_string().map_err(damaged)).transpose()
    }
}
