//! Uncompressed grey BMP images of 8 bits, the form in which Verti-Bench has its heights.

use crate::fault::Fault;

/// Heights as grey levels.
#[derive(Clone, Debug, PartialEq)]
pub struct GreyImage {
    /// Pixels from west to east.
    pub columns: usize,
    /// Pixels from north to south.
    pub rows: usize,
    /// From the north-west, row by row.
    pub levels: Vec<u8>,
}

impl GreyImage {
    /// Reads an uncompressed grey BMP image of 8 bits.
    ///
    /// # Errors
    /// The place in the file, what is there and what was expected.
    pub fn from_bmp(bytes: &[u8]) -> Result<Self, Fault> {
        read(bytes).map_err(Fault)
    }
}

/// File header and the oldest information header that is in use.
const HEADERS: usize = 14 + 40;
/// Most pixels along a side: as many as heights have.
const MAX_SIDE: usize = 4096;

fn read(bytes: &[u8]) -> Result<GreyImage, String> {
    if !bytes.starts_with(b"BM") {
        let found: String = bytes.iter().take(2).map(|byte| format!("{byte:02x} ")).collect();
        return Err(format!("it begins with {found:?}: expected \"BM\", a BMP image"));
    }
    if bytes.len() < HEADERS {
        return Err(format!("it ends after {} bytes: expected {HEADERS} bytes of headers", bytes.len()));
    }
    let expect = |what: &str, found: u32, expected: u32| {
        let fault = || format!("{what} = {found}: expected {expected}, an uncompressed image of 8 bits");
        if found == expected { Ok(()) } else { Err(fault()) }
    };
    expect("bits per pixel", number(bytes, 28) & 0xffff, 8)?;
    expect("compression", number(bytes, 30), 0)?;
    let (width, height) = (number(bytes, 18).cast_signed(), number(bytes, 22).cast_signed());
    let side = |what: &str, pixels: u32| match pixels as usize {
        side @ 2..=MAX_SIDE => Ok(side),
        side => Err(format!("{what} = {side} pixels: expected 2 to {MAX_SIDE}")),
    };
    let columns = side("width", width.cast_unsigned())?;
    // Rows begin in the south, unless their number is negative.
    let (rows, is_northern_first) = (side("height", height.unsigned_abs())?, height < 0);
    let greys = palette(bytes)?;
    let (begin, stride) = (number(bytes, 10) as usize, columns.next_multiple_of(4));
    let pixels = bytes.get(begin..).and_then(|pixels| pixels.get(..stride * rows));
    let pixels = pixels.ok_or_else(|| {
        let expected = format!("{rows} rows of {stride} bytes from byte {begin} on");
        format!("it ends after {} bytes: expected {expected}", bytes.len())
    })?;
    let mut lines: Vec<&[u8]> = pixels.chunks_exact(stride).map(|line| &line[..columns]).collect();
    if !is_northern_first {
        lines.reverse();
    }
    let mut levels = Vec::with_capacity(columns * rows);
    for (row, line) in lines.into_iter().enumerate() {
        for (column, &index) in line.iter().enumerate() {
            let grey = greys.get(usize::from(index)).copied().ok_or_else(|| {
                let place = format!("row {}, column {}", row + 1, column + 1);
                format!("{place}: colour {index}: expected one of {}", greys.len())
            })?;
            levels.push(grey);
        }
    }
    Ok(GreyImage { columns, rows, levels })
}

/// The little-endian number at byte `at`, or 0 behind the end.
fn number(bytes: &[u8], at: usize) -> u32 {
    let four = bytes.get(at..).and_then(|rest| rest.first_chunk());
    four.map_or(0, |four| u32::from_le_bytes(*four))
}

/// The grey of each colour.
fn palette(bytes: &[u8]) -> Result<Vec<u8>, String> {
    let colours = match number(bytes, 46) as usize {
        0 => 256,
        colours => colours.min(256),
    };
    let begin = 14 + number(bytes, 14) as usize;
    let entries = bytes.get(begin..).and_then(|rest| rest.get(..4 * colours));
    let entries = entries.ok_or_else(|| {
        let expected = format!("{colours} colours from byte {begin} on");
        format!("it ends after {} bytes: expected {expected}", bytes.len())
    })?;
    let grey = |(index, entry): (usize, &[u8])| match *entry {
        [blue, green, red, _] if blue == green && green == red => Ok(blue),
        _ => Err(format!("colour {index} = {entry:?}: expected a grey")),
    };
    entries.chunks_exact(4).enumerate().map(grey).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::bmp;

    #[test]
    fn rows_come_from_the_north_without_their_padding() {
        let image = GreyImage { columns: 3, rows: 2, levels: vec![1, 2, 3, 40, 50, 255] };
        assert_eq!(read(&bmp(3, &image.levels)), Ok(image));
    }

    #[test]
    fn a_negative_height_means_that_the_first_row_is_the_northern_one() {
        let mut bytes = bmp(3, &[1, 2, 3, 40, 50, 255]);
        bytes[22..26].copy_from_slice(&(-2_i32).to_le_bytes());
        assert_eq!(read(&bytes).unwrap().levels, [40, 50, 255, 1, 2, 3]);
    }

    #[test]
    fn levels_are_those_of_the_palette() {
        let mut bytes = bmp(2, &[0, 1, 2, 3]);
        bytes[54 + 4 * 3..54 + 4 * 4].copy_from_slice(&[77, 77, 77, 0]);
        assert_eq!(read(&bytes).unwrap().levels, [0, 1, 2, 77]);
    }

    #[test]
    fn what_is_wrong_is_named() {
        let whole = bmp(3, &[1, 2, 3, 4, 5, 6]);
        let fault = |change: &dyn Fn(&mut Vec<u8>)| {
            let mut bytes = whole.clone();
            change(&mut bytes);
            read(&bytes).unwrap_err()
        };
        for (error, expected) in [
            (fault(&|bytes| bytes[0] = b'P'), "it begins with \"50 4d \": expected \"BM\""),
            (fault(&|bytes| bytes.truncate(30)), "it ends after 30 bytes: expected 54 bytes of headers"),
            (fault(&|bytes| bytes[28] = 24), "bits per pixel = 24: expected 8"),
            (fault(&|bytes| bytes[30] = 1), "compression = 1: expected 0"),
            (fault(&|bytes| bytes[18] = 1), "width = 1 pixels: expected 2 to 4096"),
            (fault(&|bytes| bytes[25] = 0x80), "height = 2147483646 pixels"),
            (fault(&|bytes| bytes[58] = 9), "colour 1 = [9, 1, 1, 0]: expected a grey"),
            (fault(&|bytes| bytes.truncate(500)), "expected 256 colours from byte 54 on"),
            (fault(&|bytes| bytes.truncate(1085)), "expected 2 rows of 4 bytes from byte 1078 on"),
        ] {
            assert!(error.contains(expected), "{expected} is not in: {error}");
        }
        // A palette that is too short for the pixels, whose rows begin with the northern one.
        let mut bytes = whole.clone();
        bytes[46] = 5;
        assert_eq!(read(&bytes).unwrap_err(), "row 2, column 2: colour 5: expected one of 5");
    }

    #[test]
    fn no_end_of_a_file_is_a_panic() {
        let whole = bmp(3, &[1, 2, 3, 4, 5, 6]);
        assert!((0..whole.len()).all(|length| read(&whole[..length]).is_err()));
    }
}
