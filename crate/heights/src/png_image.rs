//! PNG: one grey level of 16 bits is 1 mm unless a recipe gives the heights of black and white, which 8 bits
//! need.

use crate::samples::{FirstRow, Samples, count};
use crate::spacing::{MIN_CELL_M, square};
use crate::{Fault, Grid, Import};
use png::{BitDepth, ColorType, Decoder, DecodingError, Info, Limits, Unit};
use std::io::Cursor;

/// Spacing of an image that does not say its own.
const DEFAULT_CELL_M: f64 = 0.25;
const METRES_PER_LEVEL: f64 = 0.001;

pub(crate) fn read(bytes: &[u8], import: &Import) -> Result<Grid, Fault> {
    let damaged = |error: DecodingError| Fault::damaged("PNG", error);
    let decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: 64 << 20 });
    let mut reader = decoder.read_info().map_err(damaged)?;
    let info = reader.info();
    let (colours, alpha) = match info.color_type {
        ColorType::Grayscale => (1, false),
        ColorType::GrayscaleAlpha => (1, true),
        ColorType::Rgb => (3, false),
        ColorType::Rgba => (3, true),
        ColorType::Indexed => return Err(pixel_format(info)),
    };
    let (depth, white) = match (info.bit_depth, import.range_m) {
        (BitDepth::Sixteen, _) => (2, u16::MAX),
        (BitDepth::Eight, Some(_)) => (1, u16::from(u8::MAX)),
        _ => return Err(pixel_format(info)),
    };
    let mut warnings = Vec::new();
    let cell_m = match import.cell_m {
        Some(cell_m) => cell_m,
        None => own_cell_m(info, &mut warnings)?,
    };
    let (columns, rows) = (info.width as usize, info.height as usize);
    let bytes_of_pixel = (colours + usize::from(alpha)) * depth;
    let clear = info.trns.as_deref().filter(|_| colours == 1).and_then(|level| level.try_into().ok());
    let clear = clear.map(u16::from_be_bytes);
    let mut levels = vec![0; count(columns, rows)? * bytes_of_pixel];
    reader.next_frame(&mut levels).map_err(damaged)?;

    let (black_m, level_m) = match import.range_m {
        Some((black_m, white_m)) => (black_m, (white_m - black_m) / f64::from(white)),
        None => (0.0, METRES_PER_LEVEL),
    };
    let mut samples = Samples::new(columns, rows)?;
    for (at, pixel) in levels.chunks_exact(bytes_of_pixel).enumerate() {
        let level = |channel: usize| match depth {
            1 => u16::from(pixel[channel]),
            _ => u16::from_be_bytes([pixel[2 * channel], pixel[2 * channel + 1]]),
        };
        let grey = level(0);
        if (1..colours).any(|channel| level(channel) != grey) {
            let place = format!("row {}, column {}", at / columns + 1, at % columns + 1);
            let found = format!("red {grey}, green {}, blue {}", level(1), level(2));
            return Err(Fault::value(place, found, "a grey level; colours are no heights"));
        }
        if (alpha && level(colours) == 0) || clear == Some(grey) {
            samples.hole(at, String::new, || "transparent".to_owned());
        } else {
            samples.put(at, black_m + f64::from(grey) * level_m);
        }
    }
    samples.grid(cell_m, FirstRow::North, import.holes, warnings)
}

fn pixel_format(info: &Info) -> Fault {
    let found = format!("{:?}, {} bits", info.color_type, info.bit_depth as u8);
    let expected =
        "greyscale of 16 bits, or of 8 bits with height_min_m and height_max_m under [import] of a recipe";
    Fault::value("pixel format", found, expected)
}

fn own_cell_m(info: &Info, warnings: &mut Vec<String>) -> Result<f64, Fault> {
    let Some(pitch) = info.pixel_dims.filter(|pitch| pitch.unit == Unit::Meter) else {
        return Ok(DEFAULT_CELL_M);
    };
    let [east, north] = [pitch.xppu, pitch.yppu].map(|pixels| 1.0 / f64::from(pixels));
    // A printer's dots are smaller, and a pixel cannot be larger than 1 m.
    if ![east, north].iter().all(|side| (MIN_CELL_M..=1.0).contains(side)) {
        warnings.push(format!(
            "pHYs = {} × {} pixels per metre is a printer's, not a spacing of heights: {DEFAULT_CELL_M} m is \
             taken in its place; cell_m under [import] of a recipe says another",
            pitch.xppu, pitch.yppu
        ));
        return Ok(DEFAULT_CELL_M);
    }
    square("chunk pHYs", east, north, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Holes;
    use png::{Encoder, PixelDimensions};
    use proptest::prelude::*;

    fn encode(
        (width, height): (u32, u32),
        (colour, depth): (ColorType, BitDepth),
        data: &[u8],
        per_metre: Option<(u32, u32)>,
    ) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = Encoder::new(&mut bytes, width, height);
        encoder.set_color(colour);
        encoder.set_depth(depth);
        if colour == ColorType::Indexed {
            encoder.set_palette(vec![0; 9]);
        }
        encoder.set_pixel_dims(per_metre.map(|(xppu, yppu)| PixelDimensions {
            xppu,
            yppu,
            unit: Unit::Meter,
        }));
        encoder.write_header().unwrap().write_image_data(data).unwrap();
        bytes
    }

    fn grey(size: (u32, u32), levels: &[u16], per_metre: Option<(u32, u32)>) -> Vec<u8> {
        let data: Vec<u8> = levels.iter().flat_map(|level| level.to_be_bytes()).collect();
        encode(size, (ColorType::Grayscale, BitDepth::Sixteen), &data, per_metre)
    }

    fn plain(bytes: &[u8]) -> Result<Grid, Fault> {
        read(bytes, &Import::default())
    }

    fn ranged(bytes: &[u8]) -> Result<Grid, Fault> {
        read(bytes, &Import { range_m: Some((-1.0, 50.0)), ..Import::default() })
    }

    #[test]
    fn levels_are_millimetres_and_the_first_row_is_north() {
        let grid = plain(&grey((3, 2), &[1000, 2000, 3000, 0, 500, 65535], None)).unwrap();
        assert_eq!((grid.columns, grid.rows, grid.cell_m), (3, 2, 0.25));
        assert_eq!(grid.heights_m, [0.0, 0.5, 65.535, 1.0, 2.0, 3.0]);
        assert!(grid.warnings.is_empty());
    }

    #[test]
    fn spacing_comes_from_phys_or_the_recipe() {
        let bytes = grey((2, 2), &[0, 65535, 0, 65535], Some((4, 4)));
        assert_eq!(plain(&bytes).unwrap().cell_m, 0.25);
        let import = Import { cell_m: Some(0.5), range_m: Some((-2.0, 3.0)), holes: Holes::Refuse };
        let grid = read(&bytes, &import).unwrap();
        assert_eq!((grid.cell_m, grid.heights_m), (0.5, vec![-2.0, 3.0, -2.0, 3.0]));
        let oblong = plain(&grey((2, 2), &[0; 4], Some((4, 5)))).unwrap_err().to_string();
        assert!(oblong.starts_with("chunk pHYs = 0.25 × 0.2: expected square pixels"), "{oblong}");
    }

    #[test]
    fn the_resolution_of_a_printer_is_no_spacing() {
        for dots in [(2835, 2835), (11811, 11811), (2835, 3000), (0, 0)] {
            let grid = plain(&grey((2, 2), &[0; 4], Some(dots))).unwrap();
            assert_eq!(grid.cell_m, 0.25);
            let [warning] = grid.warnings.as_slice() else { panic!("{:?}", grid.warnings) };
            assert!(warning.contains("pHYs") && warning.contains("cell_m"), "{warning}");
        }
    }

    #[test]
    fn eight_bits_are_heights_where_the_range_is_given() {
        let bytes = encode((2, 2), (ColorType::Grayscale, BitDepth::Eight), &[0, 255, 51, 102], None);
        let fault = plain(&bytes).unwrap_err().to_string();
        assert!(
            fault.starts_with("pixel format = Grayscale, 8 bits: expected greyscale of 16 bits"),
            "{fault}"
        );
        assert!(fault.contains("height_min_m"), "{fault}");
        let heights = ranged(&bytes).unwrap().heights_m;
        let expected = [9.2, 19.4, -1.0, 50.0];
        assert!(
            heights.iter().zip(expected).all(|(height, right): (&f32, f32)| (height - right).abs() < 1e-5)
        );
    }

    #[test]
    fn greys_in_colour_are_read_and_colours_refused() {
        let rgb = (ColorType::Rgb, BitDepth::Eight);
        let grid = ranged(&encode((2, 2), rgb, &[5, 5, 5, 0, 0, 0, 255, 255, 255, 9, 9, 9], None)).unwrap();
        assert_eq!(grid.heights_m[0], 50.0);
        let fault = ranged(&encode((2, 2), rgb, &[5, 5, 5, 0, 0, 0, 2, 2, 2, 9, 9, 8], None)).unwrap_err();
        let expected =
            "row 2, column 2 = red 9, green 9, blue 8: expected a grey level; colours are no heights";
        assert_eq!(fault.to_string(), expected);
        let rgba = (ColorType::Rgba, BitDepth::Sixteen);
        let pixel = [[1, 2, 1, 2, 1, 2, 0, 1]; 4].concat();
        assert_eq!(plain(&encode((2, 2), rgba, &pixel, None)).unwrap().heights_m, [0.258; 4]);
        for (depth, data) in [(BitDepth::Two, [0; 2].as_slice()), (BitDepth::Eight, &[0; 4])] {
            let palette = encode((2, 2), (ColorType::Indexed, depth), data, None);
            assert!(ranged(&palette).unwrap_err().to_string().starts_with("pixel format = Indexed"));
        }
    }

    #[test]
    fn transparent_pixels_are_holes() {
        let grey_alpha = (ColorType::GrayscaleAlpha, BitDepth::Sixteen);
        let data = [0, 1, 255, 255, 0, 2, 0, 0, 0, 1, 0, 1, 0, 1, 255, 255];
        let bytes = encode((2, 2), grey_alpha, &data, None);
        let fault = plain(&bytes).unwrap_err().to_string();
        assert!(
            fault.starts_with("row 1, column 2 = transparent: expected a height in metres; 1 of 4"),
            "{fault}"
        );
        let filled = read(&bytes, &Import { holes: Holes::Fill, ..Import::default() }).unwrap();
        assert_eq!(filled.heights_m, [0.001; 4]);
    }

    #[test]
    fn one_sample_is_no_grid() {
        let one = plain(&grey((1, 1), &[7], None)).unwrap_err();
        assert_eq!(one.to_string(), "1 × 1 samples: expected at least 2 × 2");
    }

    #[test]
    fn truncated_images_are_refused() {
        let levels: Vec<u16> = (0..64 * 64).map(|i| (i * 7919 % 60_000) as u16).collect();
        let whole = grey((64, 64), &levels, Some((4, 4)));
        assert!(plain(&whole).is_ok());
        // Past the pixels, only the closing chunk is missing.
        for length in (0..whole.len() - 20).step_by(13) {
            let fault = plain(&whole[..length]).unwrap_err();
            assert!(fault.to_string().starts_with("not a valid PNG file: "), "{length}: {fault}");
        }
        for at in 0..whole.len().min(600) {
            let mut bytes = whole.clone();
            bytes[at] ^= 0x55;
            drop(plain(&bytes));
            drop(ranged(&bytes));
        }
    }

    proptest! {
        #[test]
        fn a_written_image_reads_back(
            width in 2..9u32, height in 2..9u32, levels in prop::collection::vec(any::<u16>(), 64),
        ) {
            let columns = width as usize;
            let levels = &levels[..columns * height as usize];
            let grid = plain(&grey((width, height), levels, None)).unwrap();
            let rows = levels.chunks_exact(columns).rev().flatten();
            let height_m = |&level: &u16| (f64::from(level) * METRES_PER_LEVEL) as f32;
            let expected: Vec<f32> = rows.map(height_m).collect();
            prop_assert_eq!(grid.heights_m, expected);
        }
    }
}
