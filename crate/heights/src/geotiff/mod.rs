//! GeoTIFF with one band of heights, and perhaps an alpha band or a mask beside it. Of its place on Earth
//! only the spacing is used and which way is up.
//!
//! The directories are read by the crate `tiff`, strips and tiles here (`pixels`).

mod metadata;
mod pixels;
mod place;
mod tags;
mod unpack;

use crate::samples::{Meaning, Samples, count};
use crate::{Fault, Grid, Import};
use pixels::Pixels;
use tags::{Directory, File};

/// What GDAL calls an alpha band, or an extra band of unknown purpose.
const UNSPECIFIED: u64 = 0;
const PALETTE: u64 = 3;
/// The bit of `NewSubfileType` for a mask of another image.
const MASK: u64 = 4;

pub(crate) fn read(bytes: &[u8], import: &Import) -> Result<Grid, Fault> {
    let mut file = File::open(bytes)?;
    let directories = file.directories()?;
    let Some(image) = directories.first() else { return Err(Fault::damaged("TIFF", "it holds no image")) };
    let mut warnings = Vec::new();

    let pixels = Pixels::of(&mut file, image)?;
    count(pixels.columns, pixels.rows)?;
    let has_palette = file.number(image, tags::PHOTOMETRIC)? == Some(PALETTE);
    if has_palette || pixels.bands > 2 {
        let bands = if has_palette { "a palette".to_owned() } else { format!("{} bands", pixels.bands) };
        let expected =
            "one band of heights, or a second one for alpha; gdal_translate -b 1 takes the first of many";
        return Err(Fault::value("pixel format", bands, expected));
    }
    let place = place::read(&mut file, image, import, &mut warnings)?;
    let own = metadata::read(&mut file, image)?;
    let metres = match own.metres {
        Some(metres) => metres,
        None => place.metres_of_heights(&mut warnings),
    };
    let (scale, offset) = (own.scale.unwrap_or(1.0), own.offset.unwrap_or(0.0));
    let no_data = no_data(&mut file, image)?;
    let meaning = Meaning { no_data, scale: scale * metres, offset_m: offset * metres };

    let mut samples = Samples::new(pixels.columns, pixels.rows)?;
    let mut alpha = Alpha::default();
    pixels.each(bytes, &mut |band, at, number| match (band, number) {
        (0, Some(number)) => match meaning.height_m(number) {
            Some(height_m) => samples.put(at, height_m),
            None => samples.hole(at, String::new, || number.to_string()),
        },
        (0, None) => samples.hole(at, String::new, || "absent".to_owned()),
        (_, number) => alpha.put(at, number.unwrap_or(0.0)),
    })?;
    if pixels.bands == 2 {
        if file.numbers(image, tags::EXTRA_SAMPLES)?.first().is_none_or(|&kind| kind == UNSPECIFIED) {
            warnings.push(alpha.as_guessed()?);
        }
        alpha.clear.iter().for_each(|&at| samples.hole(at, String::new, || "transparent".to_owned()));
    }
    for directory in &directories[1..] {
        if file.number(directory, tags::NEW_SUBFILE_TYPE)? == Some(MASK) {
            mask(&mut file, directory, bytes, &mut samples)?;
        }
    }
    samples.grid(place.cell_m, place.first_row, import.holes, warnings)
}

/// A second band.
#[derive(Default)]
struct Alpha {
    /// Samples that it says are not there.
    clear: Vec<usize>,
    /// What it says of the others.
    opaque: Option<f64>,
    /// Whether it says one thing of all others.
    has_more: bool,
}

impl Alpha {
    fn put(&mut self, at: usize, number: f64) {
        if number == 0.0 {
            self.clear.push(at);
        } else if self.opaque.get_or_insert(number).to_bits() != number.to_bits() {
            self.has_more = true;
        }
    }

    /// The warning for a band that is not said to be alpha, and looks like it.
    fn as_guessed(&self) -> Result<String, Fault> {
        match self.opaque {
            Some(opaque) if !self.has_more => Ok(format!(
                "the second band is {opaque} or 0 everywhere: it is taken for alpha, and 0 for a hole"
            )),
            _ => {
                let expected =
                    "one band of heights, or a second one that is alpha; gdal_translate -b 1 takes the first";
                Err(Fault::value("pixel format", "2 bands", expected))
            }
        }
    }
}

/// Makes holes of what a mask hides.
fn mask(file: &mut File, directory: &Directory, bytes: &[u8], samples: &mut Samples) -> Result<(), Fault> {
    let mask = Pixels::of(file, directory)?;
    let (columns, rows) = (samples.columns, samples.rows);
    // Masks of smaller copies of the image.
    if (mask.columns, mask.rows) != (columns, rows) {
        return Ok(());
    }
    if mask.bands != 1 {
        return Err(Fault::value("mask", format!("{} bands", mask.bands), "one band"));
    }
    mask.each(bytes, &mut |_, at, number| {
        if number.unwrap_or(0.0) == 0.0 {
            samples.hole(at, String::new, || "masked".to_owned());
        }
    })
}

/// The value that marks holes: GDAL stores it as text.
fn no_data(file: &mut File, image: &Directory) -> Result<Option<f64>, Fault> {
    let Some(text) = file.text(image, tags::GDAL_NODATA)? else { return Ok(None) };
    let trimmed = text.trim_matches(['\0', ' ']);
    match trimmed.parse::<f64>() {
        Ok(number) => Ok(Some(number).filter(|number| number.is_finite())),
        Err(_) => Err(Fault::value("GDAL_NODATA", trimmed, "a number")),
    }
}

#[cfg(test)]
mod tests;
