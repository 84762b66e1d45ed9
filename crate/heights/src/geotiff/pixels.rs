//! The samples of an image in strips or tiles, as numbers.

use super::tags::{self, ByteOrder, Directory, File, Tag};
use super::unpack::{undo_differences, undo_float_differences, unpack};
use crate::Fault;
use crate::samples::MAX_SAMPLES;
use half::f16;
use std::borrow::Cow;

const FORMATS: &str = "whole numbers of 8, 16, 32 or 64 bits, or floating point of 16, 32 or 64";
const INTEGER_PREDICTOR: u64 = 2;
const FLOAT_PREDICTOR: u64 = 3;
const SEPARATE_PLANES: u64 = 2;

#[derive(Clone, Copy)]
enum Format {
    /// One bit, as masks have.
    Bit,
    Unsigned,
    Signed,
    Float,
}

/// Where and how an image's samples are stored.
pub(super) struct Pixels {
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) bands: usize,
    format: Format,
    /// Of a sample; of one bit, too.
    bytes: usize,
    is_big_endian: bool,
    /// Whether each band has strips or tiles of its own.
    is_planar: bool,
    compression: u64,
    predictor: u64,
    /// Of a strip or tile.
    chunk: [usize; 2],
    is_tiled: bool,
    /// Begin and length of each strip or tile in the file.
    places: Vec<(u64, u64)>,
}

/// Takes a sample: its band, its index, and its number, if it is stored.
type Visit<'a> = &'a mut dyn FnMut(usize, usize, Option<f64>);

impl Pixels {
    pub(super) fn of(file: &mut File, directory: &Directory) -> Result<Self, Fault> {
        let mut number = |tag: Tag, default: u64| -> Result<u64, Fault> {
            Ok(file.number(directory, tag)?.unwrap_or(default))
        };
        let size = |number: u64| usize::try_from(number).unwrap_or(usize::MAX);
        let [columns, rows] = [size(number(tags::COLUMNS, 0)?), size(number(tags::ROWS, 0)?)];
        let bands = size(number(Tag::SamplesPerPixel, 1)?);
        let bits = number(Tag::BitsPerSample, 1)?;
        let (format, bytes) = match (number(Tag::SampleFormat, 1)?, bits) {
            (1 | 4, 1) => (Format::Bit, 1),
            (1 | 4, 8 | 16 | 32 | 64) => (Format::Unsigned, bits / 8),
            (2, 8 | 16 | 32 | 64) => (Format::Signed, bits / 8),
            (3, 16 | 32 | 64) => (Format::Float, bits / 8),
            (format, _) => {
                let format = match format {
                    1 | 4 => "unsigned".to_owned(),
                    2 => "signed".to_owned(),
                    3 => "floating point".to_owned(),
                    other => format!("format {other}"),
                };
                return Err(Fault::value("pixel format", format!("{format}, {bits} bits"), FORMATS));
            }
        };
        let predictor = number(Tag::Predictor, 1)?;
        let is_known = match predictor {
            1 => true,
            INTEGER_PREDICTOR => !matches!(format, Format::Bit),
            FLOAT_PREDICTOR => matches!(format, Format::Float),
            _ => false,
        };
        if !is_known {
            return Err(Fault::value("Predictor", predictor, "1, 2, or 3 for floating point"));
        }
        let compression = number(Tag::Compression, 1)?;
        let is_planar = number(Tag::PlanarConfiguration, 1)? == SEPARATE_PLANES;
        let tile = [number(Tag::TileWidth, 0)?, number(Tag::TileLength, 0)?].map(size);
        let strip = size(number(Tag::RowsPerStrip, u64::MAX)?).min(rows);
        let is_tiled = tile != [0, 0];
        let [offsets, lengths] = if is_tiled {
            [Tag::TileOffsets, Tag::TileByteCounts]
        } else {
            [Tag::StripOffsets, Tag::StripByteCounts]
        };
        let places =
            file.numbers(directory, offsets)?.into_iter().zip(file.numbers(directory, lengths)?).collect();
        Ok(Self {
            columns,
            rows,
            bands,
            format,
            bytes: bytes as usize,
            is_big_endian: matches!(file.byte_order(), ByteOrder::BigEndian),
            is_planar,
            compression,
            predictor,
            chunk: if is_tiled { tile } else { [columns, strip] },
            is_tiled,
            places,
        })
    }

    /// Visits every sample of every band, strip by strip or tile by tile.
    pub(super) fn each(&self, file: &[u8], visit: Visit<'_>) -> Result<(), Fault> {
        let [across, down] = [self.columns, self.rows];
        let [chunk_columns, chunk_rows] = self.chunk;
        if chunk_columns == 0 || chunk_rows == 0 {
            return Err(Fault::damaged("TIFF", "strips or tiles without samples"));
        }
        let chunks = [across.div_ceil(chunk_columns), down.div_ceil(chunk_rows)];
        let planes = if self.is_planar { self.bands } else { 1 };
        let wanted = [planes, chunks[0], chunks[1]].into_iter().try_fold(1, usize::checked_mul);
        if wanted != Some(self.places.len()) {
            let reason =
                format!("{} strips or tiles: expected {}", self.places.len(), wanted.unwrap_or(usize::MAX));
            return Err(Fault::damaged("TIFF", reason));
        }
        // Tiles reach beyond the image, but not far.
        let stored =
            [chunk_columns, chunk_rows, self.places.len()].into_iter().try_fold(1, usize::checked_mul);
        if stored.is_none_or(|stored| stored > 4 * MAX_SAMPLES) {
            let found = format!("{chunk_columns} × {chunk_rows}");
            return Err(Fault::value("tile size", found, "tiles that are not much larger than the image"));
        }
        for (index, &place) in self.places.iter().enumerate() {
            let (plane, index) = (index / (chunks[0] * chunks[1]), index % (chunks[0] * chunks[1]));
            let [left, top] = [index % chunks[0] * chunk_columns, index / chunks[0] * chunk_rows];
            self.chunk(file, place, plane, [left, top], visit)?;
        }
        Ok(())
    }

    fn chunk(
        &self,
        file: &[u8],
        (begin, length): (u64, u64),
        plane: usize,
        [left, top]: [usize; 2],
        visit: Visit<'_>,
    ) -> Result<(), Fault> {
        let [chunk_columns, chunk_rows] = self.chunk;
        let [columns, rows] = [chunk_columns.min(self.columns - left), chunk_rows.min(self.rows - top)];
        let bands = if self.is_planar { 1 } else { self.bands };
        let place = |row: usize, column: usize| (top + row) * self.columns + left + column;
        if length == 0 {
            // GDAL leaves out what holds nothing.
            for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
                (0..bands).for_each(|band| visit(plane + band, place(row, column), None));
            }
            return Ok(());
        }
        let outside = || {
            let reason =
                format!("a strip or tile at byte {begin} with {length} bytes: expected it within the file");
            Fault::damaged("TIFF", reason)
        };
        let [begin, length] = [begin, length].map(|number| usize::try_from(number).unwrap_or(usize::MAX));
        let packed = file.get(begin..begin.saturating_add(length)).ok_or_else(outside)?;
        // The last strip ends with the image; tiles are always whole.
        let stored_rows = if self.is_tiled { chunk_rows } else { rows };
        let row_bytes = match self.format {
            Format::Bit => (chunk_columns * bands).div_ceil(8),
            _ => chunk_columns * bands * self.bytes,
        };
        let unpacked = unpack(self.compression, packed, stored_rows * row_bytes)?;
        for (row, line) in unpacked.chunks_exact(row_bytes).take(rows).enumerate() {
            let line = self.unpredicted(line, bands);
            for column in 0..columns {
                for band in 0..bands {
                    let number = self.number(&line, column * bands + band);
                    visit(plane + band, place(row, column), Some(number));
                }
            }
        }
        Ok(())
    }

    fn unpredicted<'a>(&self, line: &'a [u8], bands: usize) -> Cow<'a, [u8]> {
        let mut line = Cow::Borrowed(line);
        match self.predictor {
            INTEGER_PREDICTOR => undo_differences(line.to_mut(), self.bytes, bands, self.is_big_endian),
            FLOAT_PREDICTOR => undo_float_differences(line.to_mut(), self.bytes, bands),
            _ => {}
        }
        line
    }

    /// The number at an index of a line.
    fn number(&self, line: &[u8], index: usize) -> f64 {
        if matches!(self.format, Format::Bit) {
            return f64::from(line[index / 8] >> (7 - index % 8) & 1);
        }
        let mut digits = [0; 8];
        let stored = &line[index * self.bytes..][..self.bytes];
        digits[8 - self.bytes..].copy_from_slice(stored);
        if !self.is_big_endian && self.predictor != FLOAT_PREDICTOR {
            digits[8 - self.bytes..].reverse();
        }
        let whole = u64::from_be_bytes(digits);
        match (self.format, self.bytes) {
            (Format::Float, 2) => f16::from_bits(whole as u16).to_f64(),
            (Format::Float, 4) => f64::from(f32::from_bits(whole as u32)),
            (Format::Float, _) => f64::from_bits(whole),
            (Format::Signed, 1) => f64::from(whole as i8),
            (Format::Signed, 2) => f64::from(whole as i16),
            (Format::Signed, 4) => f64::from(whole as i32),
            (Format::Signed, _) => whole as i64 as f64,
            (Format::Unsigned | Format::Bit, _) => whole as f64,
        }
    }
}
