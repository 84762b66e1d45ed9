//! Chunks that others compressed, by decoders without C.

use std::io::{self, Read};

use mcap::sans_io::decompressor::{DecompressResult, Decompressor};
use mcap::sans_io::linear_reader::LinearReader;
use mcap::{McapError, McapResult};

/// No chunk holds more bytes than this once decompressed.
const MOST: u64 = 1 << 30;

type Decode = fn(&[u8]) -> io::Result<Vec<u8>>;

/// Decodes whole chunks.
struct Whole {
    name: &'static str,
    decode: Decode,
    decoded: Vec<u8>,
    taken: usize,
}

/// Lets `reader` read chunks in lz4 and zstd.
pub(crate) fn add_to(reader: &mut LinearReader) -> McapResult<()> {
    let decoders: [(_, Decode); 2] = [
        ("lz4", |bytes| read(lz4_flex::frame::FrameDecoder::new(bytes))),
        ("zstd", |bytes| read(ruzstd::decoding::StreamingDecoder::new(bytes).map_err(io::Error::other)?)),
    ];
    for (name, decode) in decoders {
        reader.add_decompressor(Whole { name, decode, decoded: Vec::new(), taken: 0 })?;
    }
    Ok(())
}

fn read(decoder: impl Read) -> io::Result<Vec<u8>> {
    let mut decoded = Vec::new();
    decoder.take(MOST).read_to_end(&mut decoded)?;
    Ok(decoded)
}

impl Decompressor for Whole {
    /// All of the chunk.
    fn next_read_size(&self) -> usize {
        usize::MAX
    }

    fn decompress(&mut self, src: &[u8], dst: &mut [u8]) -> McapResult<DecompressResult> {
        if !src.is_empty() {
            let decode = self.decode;
            self.decoded = decode(src).map_err(|error| McapError::DecompressionError(error.to_string()))?;
            self.taken = 0;
        }
        let left = &self.decoded[self.taken..];
        let wrote = left.len().min(dst.len());
        dst[..wrote].copy_from_slice(&left[..wrote]);
        self.taken += wrote;
        Ok(DecompressResult { consumed: src.len(), wrote })
    }

    fn reset(&mut self) -> McapResult<()> {
        (self.decoded, self.taken) = (Vec::new(), 0);
        Ok(())
    }

    fn name(&self) -> &'static str {
        self.name
    }
}
