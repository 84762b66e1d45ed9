use super::*;
use crate::Holes;
use proptest::prelude::*;

/// A value of a tag.
#[derive(Clone)]
enum Field {
    Shorts(Vec<u16>),
    Longs(Vec<u32>),
    Doubles(Vec<f64>),
    Text(String),
}

use Field::{Doubles, Longs, Shorts, Text};

/// An image to write.
#[derive(Clone)]
struct Image {
    size: [usize; 2],
    /// `SampleFormat` and `BitsPerSample`.
    format: (u16, u16),
    bands: usize,
    is_planar: bool,
    compression: u16,
    predictor: u16,
    tile: Option<[usize; 2]>,
    rows_per_strip: usize,
    /// Row by row, bands beside each other.
    numbers: Vec<f64>,
    more: Vec<(u16, Field)>,
    /// A strip or tile that is left out.
    absent: Option<usize>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Container {
    is_big_endian: bool,
    is_big_tiff: bool,
}

const SCALE: u16 = 33550;
const TRANSFORMATION: u16 = 34264;
const KEYS: u16 = 34735;
const KEY_DOUBLES: u16 = 34736;
const METADATA: u16 = 42112;
const NODATA: u16 = 42113;
const PHOTO: u16 = 262;
const FLOAT32: (u16, u16) = (3, 32);

fn half_metre() -> (u16, Field) {
    (SCALE, Doubles(vec![0.5, 0.5, 0.0]))
}

/// The keys of a coordinate system, each with its number.
fn keys(entries: &[(u16, u16)]) -> (u16, Field) {
    let mut numbers = vec![1, 1, 0, entries.len() as u16];
    entries.iter().for_each(|&(key, value)| numbers.extend([key, 0, 1, value]));
    (KEYS, Shorts(numbers))
}

impl Image {
    fn new(size: [usize; 2], format: (u16, u16), numbers: &[f64], more: &[(u16, Field)]) -> Self {
        let [columns, rows] = size;
        Self {
            size,
            format,
            bands: numbers.len() / (columns * rows),
            is_planar: false,
            compression: 1,
            predictor: 1,
            tile: None,
            rows_per_strip: rows,
            numbers: numbers.to_vec(),
            more: more.to_vec(),
            absent: None,
        }
    }

    fn bytes_of(&self, number: f64, is_big_endian: bool) -> Vec<u8> {
        let mut bytes = match self.format {
            (3, 16) => f16_bits(number).to_be_bytes().to_vec(),
            (3, 32) => (number as f32).to_be_bytes().to_vec(),
            (3, _) => number.to_be_bytes().to_vec(),
            (2, bits) => (number as i64).to_be_bytes()[8 - usize::from(bits) / 8..].to_vec(),
            (_, bits) => (number as u64).to_be_bytes()[8 - usize::from(bits) / 8..].to_vec(),
        };
        if !is_big_endian {
            bytes.reverse();
        }
        bytes
    }

    /// Each strip or tile as it is stored.
    fn chunks(&self, is_big_endian: bool) -> Vec<Vec<u8>> {
        let [columns, rows] = self.size;
        let [wide, tall] = self.tile.unwrap_or([columns, self.rows_per_strip]);
        let planes: Vec<Vec<usize>> = if self.is_planar {
            (0..self.bands).map(|band| vec![band]).collect()
        } else {
            vec![(0..self.bands).collect()]
        };
        let mut chunks = Vec::new();
        for bands in planes {
            for top in (0..rows).step_by(tall) {
                for left in (0..columns).step_by(wide) {
                    let stored = if self.tile.is_some() { tall } else { tall.min(rows - top) };
                    let lines =
                        (top..top + stored).map(|row| self.line(row, left, wide, &bands, is_big_endian));
                    chunks.push(self.packed(&lines.collect::<Vec<_>>().concat()));
                }
            }
        }
        chunks
    }

    fn line(&self, row: usize, left: usize, wide: usize, bands: &[usize], is_big_endian: bool) -> Vec<u8> {
        let [columns, rows] = self.size;
        let sample = |column: usize, band: usize| {
            let inside = row < rows && column < columns;
            if inside { self.numbers[(row * columns + column) * self.bands + band] } else { 0.0 }
        };
        let numbers: Vec<f64> = (left..left + wide)
            .flat_map(|column| bands.iter().map(move |&band| sample(column, band)))
            .collect();
        if self.format == (1, 1) {
            let bits = numbers.chunks(8).map(|eight| {
                eight.iter().enumerate().fold(0, |byte, (at, &bit)| byte | ((bit as u8) << (7 - at)))
            });
            return bits.collect();
        }
        let width = usize::from(self.format.1) / 8;
        let bytes = |big| numbers.iter().flat_map(|&number| self.bytes_of(number, big)).collect::<Vec<_>>();
        match self.predictor {
            2 => {
                let values: Vec<u64> = bytes(true)
                    .chunks(width)
                    .map(|sample| sample.iter().fold(0, |sum, &byte| sum << 8 | u64::from(byte)))
                    .collect();
                let before = |at: usize| if at < bands.len() { 0 } else { values[at - bands.len()] };
                let differences = (0..values.len()).map(|at| values[at].wrapping_sub(before(at)));
                let stored = differences.flat_map(|difference| {
                    let mut stored = difference.to_be_bytes()[8 - width..].to_vec();
                    if !is_big_endian {
                        stored.reverse();
                    }
                    stored
                });
                stored.collect()
            }
            3 => {
                let whole = bytes(true);
                let ranks: Vec<u8> =
                    (0..width).flat_map(|rank| whole[rank..].iter().step_by(width).copied()).collect();
                let before = |at: usize| if at < bands.len() { 0 } else { ranks[at - bands.len()] };
                (0..ranks.len()).map(|at| ranks[at].wrapping_sub(before(at))).collect()
            }
            _ => bytes(is_big_endian),
        }
    }

    fn packed(&self, bytes: &[u8]) -> Vec<u8> {
        match self.compression {
            5 => {
                weezl::encode::Encoder::with_tiff_size_switch(weezl::BitOrder::Msb, 8).encode(bytes).unwrap()
            }
            8 | 32946 => fdeflate::compress_to_vec(bytes),
            50000 => ruzstd::encoding::compress_to_vec(bytes, ruzstd::encoding::CompressionLevel::Fastest),
            32773 => bytes.chunks(128).flat_map(|run| [&[run.len() as u8 - 1], run].concat()).collect(),
            _ => bytes.to_vec(),
        }
    }

    fn fields(&self, offsets: Vec<u32>, lengths: Vec<u32>) -> Vec<(u16, Field)> {
        let mut fields = vec![
            (256, Longs(vec![self.size[0] as u32])),
            (257, Longs(vec![self.size[1] as u32])),
            (258, Shorts(vec![self.format.1; self.bands])),
            (259, Shorts(vec![self.compression])),
            (PHOTO, Shorts(vec![1])),
            (277, Shorts(vec![self.bands as u16])),
            (284, Shorts(vec![if self.is_planar { 2 } else { 1 }])),
            (317, Shorts(vec![self.predictor])),
            (339, Shorts(vec![self.format.0; self.bands])),
        ];
        match self.tile {
            Some([wide, tall]) => fields.extend([
                (322, Longs(vec![wide as u32])),
                (323, Longs(vec![tall as u32])),
                (324, Longs(offsets)),
                (325, Longs(lengths)),
            ]),
            None => fields.extend([
                (273, Longs(offsets)),
                (278, Longs(vec![self.rows_per_strip as u32])),
                (279, Longs(lengths)),
            ]),
        }
        for (tag, field) in &self.more {
            fields.retain(|(own, _)| own != tag);
            fields.push((*tag, field.clone()));
        }
        fields.sort_by_key(|(tag, _)| *tag);
        fields
    }
}

/// The bits of a number that 16 bits hold exactly.
fn f16_bits(number: f64) -> u16 {
    half::f16::from_f64(number).to_bits()
}

fn put(bytes: &mut Vec<u8>, number: u64, width: usize, is_big_endian: bool) {
    let digits = number.to_be_bytes();
    let mut digits = digits[8 - width..].to_vec();
    if !is_big_endian {
        digits.reverse();
    }
    bytes.extend(digits);
}

/// A TIFF file of these images.
fn file(images: &[Image], Container { is_big_endian, is_big_tiff }: Container) -> Vec<u8> {
    let order = |bytes: &mut Vec<u8>, number: u64, width: usize| put(bytes, number, width, is_big_endian);
    let offset_width = if is_big_tiff { 8 } else { 4 };
    let mut bytes = if is_big_endian { b"MM".to_vec() } else { b"II".to_vec() };
    if is_big_tiff {
        [43, 8, 0].into_iter().for_each(|number| order(&mut bytes, number, 2));
    } else {
        order(&mut bytes, 42, 2);
    }
    let mut link = bytes.len();
    order(&mut bytes, 0, offset_width);
    for image in images {
        let (mut offsets, mut lengths) = (Vec::new(), Vec::new());
        for (index, chunk) in image.chunks(is_big_endian).into_iter().enumerate() {
            let is_absent = image.absent == Some(index);
            offsets.push(if is_absent { 0 } else { bytes.len() as u32 });
            lengths.push(if is_absent { 0 } else { chunk.len() as u32 });
            bytes.extend(chunk);
        }
        let mut entries = Vec::new();
        let fields = image.fields(offsets, lengths);
        order(&mut entries, fields.len() as u64, if is_big_tiff { 8 } else { 2 });
        for (tag, field) in fields {
            let (kind, width, numbers): (u64, usize, Vec<u64>) = match field {
                Shorts(numbers) => (3, 2, numbers.into_iter().map(u64::from).collect()),
                Longs(numbers) => (4, 4, numbers.into_iter().map(u64::from).collect()),
                Doubles(numbers) => (12, 8, numbers.into_iter().map(f64::to_bits).collect()),
                Text(text) => (2, 1, text.bytes().chain([0]).map(u64::from).collect()),
            };
            let mut value = Vec::new();
            numbers.iter().for_each(|&number| order(&mut value, number, width));
            order(&mut entries, u64::from(tag), 2);
            order(&mut entries, kind, 2);
            order(&mut entries, numbers.len() as u64, offset_width);
            if value.len() > offset_width {
                order(&mut entries, bytes.len() as u64, offset_width);
                bytes.extend(value);
            } else {
                value.resize(offset_width, 0);
                entries.extend(value);
            }
        }
        let mut here = Vec::new();
        order(&mut here, bytes.len() as u64, offset_width);
        bytes[link..link + offset_width].copy_from_slice(&here);
        bytes.extend(entries);
        link = bytes.len();
        order(&mut bytes, 0, offset_width);
    }
    bytes
}

fn plain(image: Image) -> Result<Grid, Fault> {
    read(&file(&[image], Container::default()), &Import::default())
}

fn fault(image: Image) -> String {
    plain(image).unwrap_err().to_string()
}

/// Four heights, the first row in the north.
fn small(more: &[(u16, Field)]) -> Image {
    Image::new([2, 2], FLOAT32, &[1.0, 2.0, 3.0, 4.5], more)
}

fn near(grid: &Grid, cell_m: f64, heights_m: &[f64]) {
    assert!((grid.cell_m - cell_m).abs() < 1e-9, "{}", grid.cell_m);
    let close = |(height, right): (&f32, &f64)| (f64::from(*height) - right).abs() < 1e-6;
    assert!(grid.heights_m.iter().zip(heights_m).all(close), "{:?}", grid.heights_m);
}

#[test]
fn every_way_of_storing_gives_the_same_ground() {
    let [columns, rows] = [37, 21];
    let numbers: Vec<f64> = (0..columns * rows).map(|at| ((at * 7) % 90) as f64).collect();
    let containers = [(false, false), (true, false), (false, true), (true, true)]
        .map(|(is_big_endian, is_big_tiff)| Container { is_big_endian, is_big_tiff });
    let formats =
        [(1, 8), (1, 16), (1, 32), (1, 64), (2, 8), (2, 16), (2, 32), (2, 64), (3, 16), (3, 32), (3, 64)];
    let right = plain(Image::new([columns, rows], FLOAT32, &numbers, &[half_metre()])).unwrap();
    assert_eq!(right.heights_m[0], numbers[20 * 37] as f32);
    for container in containers {
        for format in formats {
            for (compression, predictor) in [
                (1, 1),
                (1, 2),
                (1, 3),
                (5, 1),
                (5, 2),
                (8, 2),
                (8, 3),
                (32946, 1),
                (32773, 1),
                (50000, 1),
                (50000, 3),
            ] {
                if predictor == 3 && format.0 != 3 {
                    continue;
                }
                for tile in [None, Some([16, 16]), Some([64, 32])] {
                    let mut image = Image::new([columns, rows], format, &numbers, &[half_metre()]);
                    (image.compression, image.predictor, image.tile, image.rows_per_strip) =
                        (compression, predictor, tile, 8);
                    let grid = read(&file(&[image], container), &Import::default());
                    assert_eq!(
                        grid.as_ref(),
                        Ok(&right),
                        "{container:?}, {format:?}, {compression}, {predictor}, {tile:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn signed_numbers_and_fractions_keep_their_values() {
    let numbers = [-3.0, 2.0, -100.0, 127.0];
    for format in [(2, 8), (2, 16), (2, 32), (2, 64), (3, 16), (3, 32), (3, 64)] {
        let grid = plain(Image::new([2, 2], format, &numbers, &[half_metre()])).unwrap();
        assert_eq!(grid.heights_m, [-100.0, 127.0, -3.0, 2.0], "{format:?}");
    }
    let white_is_low = (PHOTO, Shorts(vec![0]));
    let grid =
        plain(Image::new([2, 2], (1, 8), &[1.0, 2.0, 3.0, 255.0], &[half_metre(), white_is_low])).unwrap();
    assert_eq!(grid.heights_m, [3.0, 255.0, 1.0, 2.0]);
}

#[test]
fn holes_are_known_by_tag_by_value_and_by_absence() {
    let hole = |more: &[(u16, Field)], numbers: &[f64]| {
        let more = [&[half_metre()], more].concat();
        let text = fault(Image::new([2, 2], FLOAT32, numbers, &more));
        text.split(';').next().unwrap().to_owned()
    };
    let no_data = |text: &str| [(NODATA, Text(text.to_owned()))];
    let at_3 = "row 2, column 1 = 3: expected a height in metres";
    assert_eq!(hole(&no_data("3"), &[1.0, 2.0, 3.0, 4.0]), at_3);
    assert_eq!(hole(&no_data(" 3.0 "), &[1.0, 2.0, 3.0, 4.0]), at_3);
    for void in [-9999.0, -32768.0, -3.4028234663852886e38, f64::NAN] {
        let text = hole(&no_data("-1"), &[1.0, void, 3.0, 4.0]);
        assert!(text.starts_with("row 1, column 2 = ") && text.contains("expected a height"), "{text}");
    }
    assert!(hole(&no_data("three"), &[1.0; 4]).starts_with("GDAL_NODATA = three: expected a number"));

    let mut sparse = Image::new([4, 4], FLOAT32, &[1.0; 16], &[half_metre()]);
    (sparse.tile, sparse.absent) = (Some([2, 2]), Some(1));
    let text = fault(sparse.clone());
    assert!(text.starts_with("row 1, column 3 = absent: expected a height in metres; 4 of 16"), "{text}");
    let bytes = file(&[sparse], Container::default());
    let filled = read(&bytes, &Import { holes: Holes::Fill, ..Import::default() }).unwrap();
    assert_eq!(filled.heights_m, [1.0; 16]);
}

#[test]
fn an_alpha_band_hides_holes() {
    let two_bands = |numbers: &[f64], kind: &[u16], is_planar: bool| {
        let mut image = Image::new([2, 2], FLOAT32, numbers, &[half_metre(), (338, Shorts(kind.to_vec()))]);
        image.is_planar = is_planar;
        image
    };
    let opaque = [1.0, 255.0, 2.0, 255.0, 3.0, 255.0, 4.0, 255.0];
    for is_planar in [false, true] {
        let grid = plain(two_bands(&opaque, &[0], is_planar)).unwrap();
        assert_eq!(grid.heights_m, [3.0, 4.0, 1.0, 2.0]);
        assert!(grid.warnings[0].contains("taken for alpha"), "{:?}", grid.warnings);
        let said = plain(two_bands(&opaque, &[2], is_planar)).unwrap();
        assert_eq!((said.heights_m, said.warnings.len()), (grid.heights_m, 0));
        let clear = [1.0, 255.0, 2.0, 0.0, 3.0, 255.0, 4.0, 255.0];
        let text = fault(two_bands(&clear, &[0], is_planar));
        assert!(text.starts_with("row 1, column 2 = transparent: expected a height"), "{text}");
    }
    let two_heights = [1.0, 10.0, 2.0, 20.0, 3.0, 30.0, 4.0, 40.0];
    assert!(fault(two_bands(&two_heights, &[0], false)).contains("2 bands: expected one band of heights"));
    let three = fault(Image::new([2, 2], (1, 8), &[0.0; 12], &[half_metre()]));
    assert!(three.starts_with("pixel format = 3 bands: expected one band of heights"), "{three}");
}

#[test]
fn a_mask_hides_holes() {
    for (format, compression) in [((1, 1), 1), ((1, 1), 8), ((1, 8), 1)] {
        let mut mask = Image::new(
            [2, 2],
            format,
            &[1.0, 1.0, 0.0, 1.0],
            &[(254, Longs(vec![4])), (PHOTO, Shorts(vec![4]))],
        );
        mask.compression = compression;
        let overview = Image::new([1, 1], FLOAT32, &[7.0], &[(254, Longs(vec![1]))]);
        let bytes = file(&[small(&[half_metre()]), overview, mask], Container::default());
        let text = read(&bytes, &Import::default()).unwrap_err().to_string();
        assert!(text.starts_with("row 2, column 1 = masked: expected a height"), "{text}");
    }
}

#[test]
fn feet_become_metres_with_a_warning() {
    let us_foot = 1200.0 / 3937.0;
    let feet: Vec<f64> = [1.0, 2.0, 3.0, 4.5].iter().map(|height| height / us_foot).collect();
    let image = |more: &[(u16, Field)]| Image::new([2, 2], (3, 64), &feet, more);
    let side = (SCALE, Doubles(vec![0.5 / us_foot, 0.5 / us_foot, 0.0]));
    let grid = plain(image(&[side.clone(), keys(&[(1024, 1), (3076, 9003)])])).unwrap();
    near(&grid, 0.5, &[3.0, 4.5, 1.0, 2.0]);
    assert_eq!(grid.warnings.len(), 2, "{:?}", grid.warnings);
    assert!(grid.warnings.iter().all(|warning| warning.contains("US survey foot")), "{:?}", grid.warnings);

    // Heights in metres over a grid in feet, and the other way round.
    let grid = plain(small(&[side, keys(&[(1024, 1), (3076, 9003), (4099, 9001)])])).unwrap();
    near(&grid, 0.5, &[3.0, 4.5, 1.0, 2.0]);
    let grid = plain(image(&[half_metre(), keys(&[(1024, 1), (3076, 9001), (4099, 9003)])])).unwrap();
    near(&grid, 0.5, &[3.0, 4.5, 1.0, 2.0]);
    let unit = (METADATA, Text("<Item role=\"unittype\" sample=\"0\">US survey foot</Item>".to_owned()));
    near(&plain(image(&[half_metre(), unit])).unwrap(), 0.5, &[3.0, 4.5, 1.0, 2.0]);

    let own = (KEYS, Shorts(vec![1, 1, 0, 3, 1024, 0, 1, 1, 3076, 0, 1, 32767, 3077, 34736, 1, 0]));
    let grid = plain(small(&[half_metre(), own.clone(), (KEY_DOUBLES, Doubles(vec![2.0]))])).unwrap();
    near(&grid, 1.0, &[6.0, 9.0, 2.0, 4.0]);
    assert!(fault(small(&[half_metre(), own])).starts_with("ProjLinearUnitSizeGeoKey = absent"));
    let rods = fault(small(&[half_metre(), keys(&[(1024, 1), (3076, 9042)])]));
    assert!(rods.starts_with("ProjLinearUnitsGeoKey = 9042: expected metres or feet"), "{rods}");
}

#[test]
fn scale_and_offset_are_applied() {
    let xml = "<GDALMetadata><Item name=\"OFFSET\" sample=\"0\" role=\"offset\">10</Item>\
               <Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.001</Item></GDALMetadata>";
    let more = [half_metre(), (METADATA, Text(xml.to_owned()))];
    let grid = plain(Image::new([2, 2], (2, 16), &[1500.0, -2000.0, 3.0, 4.0], &more)).unwrap();
    near(&grid, 0.5, &[10.003, 10.004, 11.5, 8.0]);
}

#[test]
fn a_transformation_says_which_way_is_up() {
    let matrix = |east: f64, across: f64, along: f64, north: f64| {
        let matrix =
            vec![east, across, 0.0, 5e5, along, north, 0.0, 4e6, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        (TRANSFORMATION, Doubles(matrix))
    };
    let north_up = plain(small(&[matrix(0.5, 0.0, 0.0, -0.5)])).unwrap();
    near(&north_up, 0.5, &[3.0, 4.5, 1.0, 2.0]);
    let south_up = plain(small(&[matrix(0.5, 0.0, 0.0, 0.5)])).unwrap();
    near(&south_up, 0.5, &[1.0, 2.0, 3.0, 4.5]);
    let wider = Import { cell_m: Some(2.0), ..Import::default() };
    let bytes = file(&[small(&[matrix(0.5, 0.0, 0.0, 0.5)])], Container::default());
    near(&read(&bytes, &wider).unwrap(), 2.0, &[1.0, 2.0, 3.0, 4.5]);
    assert!(fault(small(&[matrix(0.4, 0.3, -0.3, -0.4)])).contains("expected rows that run east"));
    assert!(fault(small(&[matrix(-0.5, 0.0, 0.0, -0.5)])).contains("expected columns from west to east"));
    let negative = plain(small(&[(SCALE, Doubles(vec![0.5, -0.5, 0.0]))])).unwrap();
    near(&negative, 0.5, &[3.0, 4.5, 1.0, 2.0]);
    assert!(negative.warnings[0].contains("ModelPixelScale is negative"), "{:?}", negative.warnings);
}

#[test]
fn spacing_is_the_files_or_the_recipes() {
    let nearly = plain(small(&[(SCALE, Doubles(vec![0.5, 0.500004, 0.0]))])).unwrap();
    assert!((nearly.cell_m - 0.5).abs() < 1e-5);
    let oblong = fault(small(&[(SCALE, Doubles(vec![0.5, 1.0, 0.0]))]));
    assert!(
        oblong.starts_with("ModelPixelScale = 0.5 × 1: expected square pixels") && oblong.contains("cell_m"),
        "{oblong}"
    );
    assert!(
        fault(small(&[]))
            .starts_with("ModelPixelScale = absent: expected the size of a pixel; give the spacing")
    );
    for degrees in [keys(&[(1024, 2)]), keys(&[(2048, 4326)])] {
        let small = small(&[(SCALE, Doubles(vec![0.0003, 0.0003, 0.0])), degrees]);
        let text = fault(small.clone());
        assert!(
            text.starts_with("GTModelTypeGeoKey = geographic (degrees)") && text.contains("cell_m"),
            "{text}"
        );
        let given = Import { cell_m: Some(30.0), ..Import::default() };
        near(&read(&file(&[small], Container::default()), &given).unwrap(), 30.0, &[3.0, 4.5, 1.0, 2.0]);
    }
    let unsaid = fault(small(&[(SCALE, Doubles(vec![0.0003, 0.0003, 0.0]))]));
    assert!(
        unsaid.starts_with("ModelPixelScale = 0.0003: expected at least 0.01 m; if it is in degrees"),
        "{unsaid}"
    );
}

#[test]
fn what_is_not_read_is_named() {
    let with = |change: fn(&mut Image)| {
        let mut image = small(&[half_metre()]);
        change(&mut image);
        fault(image)
    };
    assert!(with(|image| image.compression = 34887).starts_with("Compression = 34887 (LERC)"));
    assert!(
        with(|image| image.format = (1, 12)).starts_with("pixel format = unsigned, 12 bits: expected whole")
    );
    let palette = fault(Image::new(
        [2, 2],
        (1, 8),
        &[0.0; 4],
        &[half_metre(), (PHOTO, Shorts(vec![3])), (320, Shorts(vec![0; 768]))],
    ));
    assert!(palette.starts_with("pixel format = a palette"), "{palette}");
    assert_eq!(
        fault(Image::new([1, 1], FLOAT32, &[1.0], &[half_metre()])),
        "1 × 1 samples: expected at least 2 × 2"
    );
}

#[test]
fn damage_never_panics() {
    let numbers: Vec<f64> = (0..800).map(f64::from).collect();
    let mut tiled = Image::new([20, 20], FLOAT32, &numbers, &[half_metre(), (338, Shorts(vec![2]))]);
    (tiled.tile, tiled.compression, tiled.predictor) = (Some([16, 16]), 5, 3);
    let mut striped =
        Image::new([20, 20], FLOAT32, &numbers[..400], &[half_metre(), keys(&[(1024, 1), (3076, 9003)])]);
    (striped.rows_per_strip, striped.compression, striped.predictor) = (7, 50000, 2);
    for image in [tiled, striped] {
        let whole = file(&[image], Container::default());
        for length in 0..whole.len() {
            drop(read(&whole[..length], &Import::default()));
        }
        for at in 0..whole.len() {
            for flip in [0x01, 0x80, 0xff] {
                let mut bytes = whole.clone();
                bytes[at] ^= flip;
                drop(read(&bytes, &Import { holes: Holes::Fill, ..Import::default() }));
            }
        }
    }
}

proptest! {
    #[test]
    fn a_written_file_reads_back(
        columns in 2..40usize, rows in 2..40usize, seed in any::<u32>(), tall in 1..40usize,
        (compression, predictor) in
            prop::sample::select(vec![(1, 1), (5, 2), (5, 3), (8, 3), (50000, 2), (32773, 1)]),
        tile in prop::option::of((1..4usize, 1..4usize)),
        is_big_endian in any::<bool>(), is_big_tiff in any::<bool>(),
    ) {
        let mut state = seed;
        let mut number = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / 4096.0 - 400.0
        };
        let numbers: Vec<f64> = (0..columns * rows).map(|_| f64::from(number() as f32)).collect();
        let mut image = Image::new([columns, rows], FLOAT32, &numbers, &[half_metre()]);
        (image.compression, image.predictor, image.rows_per_strip) = (compression, predictor, tall.min(rows));
        image.tile = tile.map(|(wide, tall)| [16 * wide, 16 * tall]);
        let bytes = file(&[image], Container { is_big_endian, is_big_tiff });
        let grid = read(&bytes, &Import::default()).unwrap();
        let south_first = numbers.chunks(columns).rev().flatten();
        let expected: Vec<f32> = south_first.map(|&number| number as f32).collect();
        prop_assert_eq!(grid.heights_m, expected);
    }
}
