//! Strips and tiles as they are packed: compression, and the predictors that come before it.

use crate::Fault;
use std::borrow::Cow;
use std::io::Read as _;

const PACK_BITS: u64 = 32773;

/// Unpacks at least `length` bytes, which a whole strip or tile has.
pub(super) fn unpack(compression: u64, packed: &[u8], length: usize) -> Result<Cow<'_, [u8]>, Fault> {
    let unpacked = match compression {
        1 => Cow::Borrowed(packed),
        5 => Cow::Owned(lzw(packed, length)),
        8 | 32946 => Cow::Owned(deflate(packed, length)?),
        PACK_BITS => Cow::Owned(pack_bits(packed, length)),
        50000 => Cow::Owned(zstd(packed, length)?),
        other => {
            let expected = "none, LZW, Deflate, PackBits or ZSTD; gdal_translate -co COMPRESS=DEFLATE \
                            writes one of them";
            return Err(Fault::value("Compression", name(other), expected));
        }
    };
    if unpacked.len() < length {
        let reason = format!("a strip or tile of {} bytes: expected {length}", unpacked.len());
        return Err(Fault::damaged("TIFF", reason));
    }
    Ok(unpacked)
}

fn name(compression: u64) -> String {
    let name = match compression {
        2..=4 => "fax",
        6 | 7 => "JPEG",
        34712 | 34713 => "JPEG 2000",
        34887 => "LERC",
        34925 => "LZMA",
        50001 | 34927 => "WebP",
        50002 => "JPEG XL",
        _ => return compression.to_string(),
    };
    format!("{compression} ({name})")
}

/// Like libtiff, this stops when it has enough: many a writer leaves the end code out.
fn lzw(packed: &[u8], length: usize) -> Vec<u8> {
    let configuration = weezl::decode::Configuration::with_tiff_size_switch(weezl::BitOrder::Msb, 8);
    let mut decoder = configuration.with_yield_on_full_buffer(true).build();
    let mut unpacked = vec![0; length];
    let (mut begin, mut end) = (0, 0);
    while end < length {
        let step = decoder.decode_bytes(&packed[begin..], &mut unpacked[end..]);
        begin += step.consumed_in;
        end += step.consumed_out;
        let goes_on = step.status.is_ok_and(|status| matches!(status, weezl::LzwStatus::Ok));
        if !goes_on || (step.consumed_in, step.consumed_out) == (0, 0) {
            break;
        }
    }
    unpacked.truncate(end);
    unpacked
}

fn deflate(packed: &[u8], length: usize) -> Result<Vec<u8>, Fault> {
    let mut decoder = fdeflate::Decompressor::new();
    let mut unpacked = vec![0; length];
    let (mut begin, mut end) = (0, 0);
    while end < length && !decoder.is_done() {
        let step = decoder.read(&packed[begin..], &mut unpacked, end, false);
        let (taken, given) = step.map_err(|error| Fault::damaged("TIFF", format!("Deflate: {error:?}")))?;
        begin += taken;
        end += given;
        if (taken, given) == (0, 0) {
            break;
        }
    }
    unpacked.truncate(end);
    Ok(unpacked)
}

fn zstd(packed: &[u8], length: usize) -> Result<Vec<u8>, Fault> {
    let damaged = |error: String| Fault::damaged("TIFF", format!("ZSTD: {error}"));
    let decoder =
        ruzstd::decoding::StreamingDecoder::new(packed).map_err(|error| damaged(error.to_string()))?;
    let mut unpacked = Vec::new();
    decoder.take(length as u64).read_to_end(&mut unpacked).map_err(|error| damaged(error.to_string()))?;
    Ok(unpacked)
}

fn pack_bits(packed: &[u8], length: usize) -> Vec<u8> {
    let mut unpacked = Vec::new();
    let mut rest = packed.iter().copied();
    while unpacked.len() < length
        && let Some(head) = rest.next()
    {
        match head {
            0..=127 => unpacked.extend(rest.by_ref().take(usize::from(head) + 1)),
            128 => {}
            129..=255 => {
                let Some(byte) = rest.next() else { break };
                unpacked.resize(unpacked.len() + 257 - usize::from(head), byte);
            }
        }
    }
    unpacked
}

/// Undoes the predictor of whole numbers in a row: each sample is the difference to the one before.
pub(super) fn undo_differences(row: &mut [u8], bytes: usize, bands: usize, is_big_endian: bool) {
    let number = |sample: &[u8]| {
        let add = |sum: u64, &byte: &u8| sum << 8 | u64::from(byte);
        if is_big_endian { sample.iter().fold(0, add) } else { sample.iter().rev().fold(0, add) }
    };
    for at in (bands * bytes..row.len()).step_by(bytes) {
        let before = number(&row[at - bands * bytes..][..bytes]);
        let sum = before.wrapping_add(number(&row[at..][..bytes]));
        let digits = sum.to_le_bytes();
        for (place, byte) in row[at..][..bytes].iter_mut().enumerate() {
            *byte = digits[if is_big_endian { bytes - 1 - place } else { place }];
        }
    }
}

/// Undoes the predictor of floating point in a row: differences of bytes, those of one rank together, the
/// highest first. The samples are then big-endian, whatever the file is.
pub(super) fn undo_float_differences(row: &mut [u8], bytes: usize, bands: usize) {
    for at in bands..row.len() {
        row[at] = row[at].wrapping_add(row[at - bands]);
    }
    let ranks = row.to_vec();
    let samples = row.len() / bytes;
    for (sample, whole) in row.chunks_exact_mut(bytes).enumerate() {
        for (rank, byte) in whole.iter_mut().enumerate() {
            *byte = ranks[rank * samples + sample];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packed_bits_are_runs_and_copies() {
        assert_eq!(pack_bits(&[2, 7, 8, 9, 254, 5, 128, 0, 1], 7), [7, 8, 9, 5, 5, 5, 1]);
        assert_eq!(pack_bits(&[254], 7), []);
        assert!(unpack(PACK_BITS, &[0, 1], 2).unwrap_err().to_string().contains("1 bytes: expected 2"));
    }

    #[test]
    fn lzw_without_an_end_code_is_read() {
        let mut packed =
            weezl::encode::Encoder::with_tiff_size_switch(weezl::BitOrder::Msb, 8).encode(&[9; 300]).unwrap();
        assert_eq!(lzw(&packed, 300), [9; 300]);
        packed.pop();
        packed.pop();
        assert!(lzw(&packed, 250).iter().all(|&byte| byte == 9));
        assert_eq!(lzw(&packed, 250).len(), 250);
        assert!(lzw(&[0x80, 0x3f, 0xff, 0xff], 40).len() < 40);
    }

    #[test]
    fn differences_of_whole_numbers_wrap_and_know_their_bands() {
        let mut row = [0xff, 0x00, 0x02, 0x00, 0x01, 0x00];
        undo_differences(&mut row, 2, 1, false);
        assert_eq!(row, [0xff, 0x00, 0x01, 0x01, 0x02, 0x01]);
        let mut row = [0x00, 0xff, 0x00, 0x02, 0xff, 0xff];
        undo_differences(&mut row, 2, 1, true);
        assert_eq!(row, [0x00, 0xff, 0x01, 0x01, 0x01, 0x00]);
        let mut row = [1, 10, 1, 10, 255, 246];
        undo_differences(&mut row, 1, 2, false);
        assert_eq!(row, [1, 10, 2, 20, 1, 10]);
    }

    #[test]
    fn unknown_compressions_are_named() {
        let fault = unpack(34887, &[], 1).unwrap_err().to_string();
        assert!(fault.starts_with("Compression = 34887 (LERC): expected none, LZW"), "{fault}");
    }
}
