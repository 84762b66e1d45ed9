//! 16-bit greyscale PNG: one grey level is 1 mm unless a recipe gives the heights of black and white.

use super::{Scale, south_first};
use crate::terrain::TerrainFault;
use mapless_world::{HeightField, check_grid};
use png::{BitDepth, ColorType, Decoder, DecodingError, Limits, Unit};
use std::io::Cursor;

/// Spacing of an image that does not say its own.
const DEFAULT_CELL_M: f64 = 0.25;
const METRES_PER_LEVEL: f64 = 0.001;

pub(super) fn read(bytes: &[u8], scale: &Scale) -> Result<HeightField, TerrainFault> {
    let damaged = |error: DecodingError| TerrainFault::damaged("PNG", error);
    let decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: 64 << 20 });
    let mut reader = decoder.read_info().map_err(damaged)?;
    let info = reader.info();
    if (info.color_type, info.bit_depth) != (ColorType::Grayscale, BitDepth::Sixteen) {
        let found = format!("{:?}, {} bits", info.color_type, info.bit_depth as u8);
        return Err(TerrainFault::value("pixel format", found, "greyscale, 16 bits"));
    }
    let cell_m = match scale.cell_m {
        Some(cell_m) => cell_m,
        None => own_cell_m(info)?,
    };
    let (columns, rows) = (info.width as usize, info.height as usize);
    let count = check_grid(columns, rows, cell_m)?;
    let mut samples = vec![0; count * 2];
    reader.next_frame(&mut samples).map_err(damaged)?;
    let (black_m, level_m) = match scale.range_m {
        Some((black_m, white_m)) => (black_m, (white_m - black_m) / f64::from(u16::MAX)),
        None => (0.0, METRES_PER_LEVEL),
    };
    let mut heights_m: Vec<f32> = samples
        .chunks_exact(2)
        .map(|pair| (black_m + f64::from(u16::from_be_bytes([pair[0], pair[1]])) * level_m) as f32)
        .collect();
    south_first(&mut heights_m, columns);
    Ok(HeightField::new(columns, rows, cell_m, heights_m)?)
}

fn own_cell_m(info: &png::Info) -> Result<f64, TerrainFault> {
    match info.pixel_dims {
        Some(pitch) if pitch.unit == Unit::Meter => {
            if pitch.xppu != pitch.yppu {
                let found = format!("{} × {} pixels per metre", pitch.xppu, pitch.yppu);
                return Err(TerrainFault::value("chunk pHYs", found, "square pixels"));
            }
            Ok(1.0 / f64::from(pitch.xppu))
        }
        _ => Ok(DEFAULT_CELL_M),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use png::{Encoder, PixelDimensions};

    fn encode(width: u32, height: u32, levels: &[u16], per_metre: Option<(u32, u32)>) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = Encoder::new(&mut bytes, width, height);
        encoder.set_color(ColorType::Grayscale);
        encoder.set_depth(BitDepth::Sixteen);
        encoder.set_pixel_dims(per_metre.map(|(xppu, yppu)| PixelDimensions {
            xppu,
            yppu,
            unit: Unit::Meter,
        }));
        let data: Vec<u8> = levels.iter().flat_map(|level| level.to_be_bytes()).collect();
        encoder.write_header().unwrap().write_image_data(&data).unwrap();
        bytes
    }

    #[test]
    fn levels_are_millimetres_and_the_first_row_is_north() {
        let bytes = encode(3, 2, &[1000, 2000, 3000, 0, 500, 65535], None);
        let field = read(&bytes, &Scale::default()).unwrap();
        assert_eq!((field.columns(), field.rows(), field.cell_m()), (3, 2, 0.25));
        assert_eq!(field.heights_m(), [0.0, 0.5, 65.535, 1.0, 2.0, 3.0]);
    }

    #[test]
    fn spacing_comes_from_phys_or_the_recipe() {
        let bytes = encode(2, 2, &[0, 65535, 0, 65535], Some((4, 4)));
        assert_eq!(read(&bytes, &Scale::default()).unwrap().cell_m(), 0.25);
        let scale = Scale { cell_m: Some(0.5), range_m: Some((-2.0, 3.0)) };
        let field = read(&bytes, &scale).unwrap();
        assert_eq!((field.cell_m(), field.height_range_m()), (0.5, (-2.0, 3.0)));
        let fault = read(&encode(2, 2, &[0; 4], Some((4, 5))), &Scale::default()).unwrap_err();
        assert_eq!(fault.to_string(), "chunk pHYs = 4 × 5 pixels per metre: expected square pixels");
        let fault = read(&encode(2, 2, &[0; 4], Some((0, 0))), &Scale::default()).unwrap_err();
        assert_eq!(fault.to_string(), "spacing of inf m: expected 0.01 to 1000 m");
    }

    #[test]
    fn faults_are_named() {
        let one = read(&encode(1, 1, &[7], None), &Scale::default()).unwrap_err();
        assert_eq!(one.to_string(), "1 × 1 samples: expected at least 2 × 2");
        let mut colour = Vec::new();
        let mut encoder = Encoder::new(&mut colour, 2, 2);
        encoder.set_color(ColorType::Rgb);
        encoder.write_header().unwrap().write_image_data(&[0; 12]).unwrap();
        let fault = read(&colour, &Scale::default()).unwrap_err();
        assert_eq!(fault.to_string(), "pixel format = Rgb, 8 bits: expected greyscale, 16 bits");
    }

    #[test]
    fn truncated_images_are_refused() {
        let levels: Vec<u16> = (0..64 * 64).map(|i| (i * 7919 % 60_000) as u16).collect();
        let whole = encode(64, 64, &levels, Some((4, 4)));
        assert!(read(&whole, &Scale::default()).is_ok());
        // Past the pixels, only the closing chunk is missing.
        for length in (0..whole.len() - 20).step_by(13) {
            let fault = read(&whole[..length], &Scale::default()).unwrap_err();
            assert!(fault.to_string().starts_with("not a valid PNG file: "), "{length}: {fault}");
        }
        for at in 0..whole.len().min(600) {
            let mut bytes = whole.clone();
            bytes[at] ^= 0x55;
            drop(read(&bytes, &Scale::default()));
        }
    }
}
