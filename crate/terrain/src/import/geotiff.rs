//! GeoTIFF with one band of heights in metres, first row north. Only the pixel scale is used, not the origin.

use super::south_first;
use crate::terrain::TerrainFault;
use mapless_world::{HeightField, check_grid};
use std::io::Cursor;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;
use tiff::{ColorType, TiffError};

/// The key of the coordinate system's kind in a `GeoKeyDirectory`, and its value for degrees of longitude and
/// latitude.
const MODEL_TYPE_KEY: u16 = 1024;
const GEOGRAPHIC: u16 = 2;

pub(super) fn read(bytes: &[u8], cell_m: Option<f64>) -> Result<HeightField, TerrainFault> {
    let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(damaged)?;
    let mut limits = Limits::default();
    limits.decoding_buffer_size = 160 << 20;
    limits.intermediate_buffer_size = 160 << 20;
    limits.ifd_value_size = 1 << 20;
    decoder = decoder.with_limits(limits);
    let (columns, rows) = decoder.dimensions().map_err(damaged)?;
    let (columns, rows) = (columns as usize, rows as usize);
    let colour = decoder.colortype().map_err(damaged)?;
    if !matches!(colour, ColorType::Gray(_)) {
        return Err(TerrainFault::value("pixel format", format!("{colour:?}"), "one band of heights"));
    }
    let cell_m = match cell_m {
        Some(cell_m) => cell_m,
        None => own_cell_m(&mut decoder)?,
    };
    let count = check_grid(columns, rows, cell_m)?;
    let no_data = no_data(&mut decoder)?;
    let heights = numbers(decoder.read_image().map_err(damaged)?);
    if heights.len() != count {
        return Err(TerrainFault::damaged("TIFF", format!("{} samples: expected {count}", heights.len())));
    }
    let is_hole = |height: f64| {
        !height.is_finite() || no_data.is_some_and(|hole| (height - hole).abs() <= 1e-6 * hole.abs())
    };
    if let Some(at) = heights.iter().position(|&height| is_hole(height)) {
        let place = format!("row {}, column {}", at / columns + 1, at % columns + 1);
        return Err(TerrainFault::value(
            place,
            heights[at],
            "a height in metres; fill the holes of the grid first",
        ));
    }
    let mut heights_m: Vec<f32> = heights.into_iter().map(|height| height as f32).collect();
    south_first(&mut heights_m, columns);
    Ok(HeightField::new(columns, rows, cell_m, heights_m)?)
}

fn damaged(error: TiffError) -> TerrainFault {
    TerrainFault::damaged("TIFF", error)
}

fn own_cell_m(decoder: &mut Decoder<Cursor<&[u8]>>) -> Result<f64, TerrainFault> {
    if let Some(keys) = decoder.find_tag(Tag::GeoKeyDirectoryTag).map_err(damaged)? {
        let keys = keys.into_u16_vec().map_err(damaged)?;
        let is_geographic = |entry: &[u16]| entry[0] == MODEL_TYPE_KEY && entry[3] == GEOGRAPHIC;
        // The first four numbers are the directory's own header.
        if keys.chunks_exact(4).skip(1).any(is_geographic) {
            let expected = "a projected grid in metres; give its spacing with [import] cell_m in a recipe";
            return Err(TerrainFault::value("GTModelTypeGeoKey", "geographic (degrees)", expected));
        }
    }
    let Some(scale) = decoder.find_tag(Tag::ModelPixelScaleTag).map_err(damaged)? else {
        let expected = "the size of a pixel; give it with [import] cell_m in a recipe";
        return Err(TerrainFault::value("ModelPixelScale", "absent", expected));
    };
    match scale.into_f64_vec().map_err(damaged)?.as_slice() {
        [x, y, ..] if (x - y).abs() <= 1e-6 * x.abs() => Ok(*x),
        other => Err(TerrainFault::value("ModelPixelScale", format!("{other:?}"), "square pixels")),
    }
}

/// The value that marks holes: GDAL stores it as text. Every NaN is refused as a height anyway.
fn no_data(decoder: &mut Decoder<Cursor<&[u8]>>) -> Result<Option<f64>, TerrainFault> {
    let Some(value) = decoder.find_tag(Tag::GdalNodata).map_err(damaged)? else { return Ok(None) };
    let text = value.into_string().map_err(damaged)?;
    let trimmed = text.trim_matches(['\0', ' ']);
    match trimmed.parse::<f64>() {
        Ok(number) => Ok(Some(number).filter(|number| number.is_finite())),
        Err(_) => Err(TerrainFault::value("GDAL_NODATA", trimmed, "a number")),
    }
}

fn numbers(samples: DecodingResult) -> Vec<f64> {
    fn widen<T: Copy>(samples: &[T], number: impl Fn(T) -> f64) -> Vec<f64> {
        samples.iter().map(|&sample| number(sample)).collect()
    }
    match samples {
        DecodingResult::U8(samples) => widen(&samples, f64::from),
        DecodingResult::U16(samples) => widen(&samples, f64::from),
        DecodingResult::U32(samples) => widen(&samples, f64::from),
        DecodingResult::U64(samples) => widen(&samples, |sample| sample as f64),
        DecodingResult::F16(samples) => widen(&samples, |sample| sample.to_f64()),
        DecodingResult::F32(samples) => widen(&samples, f64::from),
        DecodingResult::F64(samples) => samples,
        DecodingResult::I8(samples) => widen(&samples, f64::from),
        DecodingResult::I16(samples) => widen(&samples, f64::from),
        DecodingResult::I32(samples) => widen(&samples, f64::from),
        DecodingResult::I64(samples) => widen(&samples, |sample| sample as f64),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tiff::encoder::colortype::{ColorType as Encoded, Gray16, Gray32Float, GrayI16, RGB8};
    use tiff::encoder::{TiffEncoder, TiffValue};

    fn encode<C: Encoded>(
        columns: u32,
        rows: u32,
        samples: &[C::Inner],
        scale: Option<&[f64]>,
        more: impl FnOnce(&mut dyn FnMut(Tag, &str)),
        keys: Option<&[u16]>,
    ) -> Vec<u8>
    where
        [C::Inner]: TiffValue,
    {
        let mut bytes = Vec::new();
        let mut encoder = TiffEncoder::new(Cursor::new(&mut bytes)).unwrap();
        let mut image = encoder.new_image::<C>(columns, rows).unwrap();
        if let Some(scale) = scale {
            image.encoder().write_tag(Tag::ModelPixelScaleTag, scale).unwrap();
        }
        if let Some(keys) = keys {
            image.encoder().write_tag(Tag::GeoKeyDirectoryTag, keys).unwrap();
        }
        more(&mut |tag, text| image.encoder().write_tag(tag, text).unwrap());
        image.write_data(samples).unwrap();
        bytes
    }

    const HALF_METRE: &[f64] = &[0.5, 0.5, 0.0];

    #[test]
    fn integer_and_float_samples_give_the_same_ground() {
        let float = encode::<Gray32Float>(3, 2, &[1., 2., 3., -4., 5., 6.], Some(HALF_METRE), |_| (), None);
        let field = read(&float, None).unwrap();
        assert_eq!(field.heights_m(), [-4.0, 5.0, 6.0, 1.0, 2.0, 3.0]);
        assert_eq!(field.cell_m(), 0.5);
        let integer = encode::<GrayI16>(3, 2, &[1, 2, 3, -4, 5, 6], Some(HALF_METRE), |_| (), None);
        assert_eq!(read(&integer, None).unwrap(), field);
        assert_eq!(read(&integer, Some(2.0)).unwrap().cell_m(), 2.0);
    }

    #[test]
    fn faults_are_named() {
        let fault = |bytes: &[u8]| read(bytes, None).unwrap_err().to_string();
        let grid = |scale, keys| encode::<Gray16>(2, 2, &[1, 2, 3, 4], scale, |_| (), keys);
        assert_eq!(
            fault(&grid(None, None)),
            "ModelPixelScale = absent: expected the size of a pixel; give it with [import] cell_m in a recipe"
        );
        assert!(fault(&grid(Some(&[1.0, 2.0, 0.0]), None)).ends_with("expected square pixels"));
        let degrees = fault(&grid(Some(HALF_METRE), Some(&[1, 1, 0, 1, 1024, 0, 1, 2])));
        assert!(degrees.starts_with("GTModelTypeGeoKey = geographic (degrees)"), "{degrees}");
        assert!(read(&grid(Some(HALF_METRE), Some(&[1, 1, 0, 1, 1024, 0, 1, 1])), None).is_ok());
        let hole =
            encode::<Gray16>(2, 2, &[1, 2, 3, 4], Some(HALF_METRE), |tag| tag(Tag::GdalNodata, "3"), None);
        assert!(
            fault(&hole).starts_with("row 2, column 1 = 3: expected a height in metres"),
            "{}",
            fault(&hole)
        );
        let nan = encode::<Gray32Float>(2, 2, &[1.0, f32::NAN, 3.0, 4.0], Some(HALF_METRE), |_| (), None);
        assert!(fault(&nan).starts_with("row 1, column 2 = NaN"), "{}", fault(&nan));
        let one = encode::<Gray16>(1, 1, &[1], Some(HALF_METRE), |_| (), None);
        assert_eq!(fault(&one), "1 × 1 samples: expected at least 2 × 2");
        let colour = encode::<RGB8>(2, 2, &[0; 12], Some(HALF_METRE), |_| (), None);
        assert_eq!(fault(&colour), "pixel format = RGB(8): expected one band of heights");
    }

    #[test]
    fn damage_never_panics() {
        let samples: Vec<f32> = (0..400).map(|i| i as f32).collect();
        let whole = encode::<Gray32Float>(20, 20, &samples, Some(HALF_METRE), |_| (), None);
        for length in 0..whole.len() {
            drop(read(&whole[..length], None));
        }
        for at in 0..whole.len() {
            for flip in [0x01, 0x80, 0xff] {
                let mut bytes = whole.clone();
                bytes[at] ^= flip;
                drop(read(&bytes, None));
            }
        }
    }
}
