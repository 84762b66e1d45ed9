//! From the frame of a link to the IP packet in it.
//!
//! Lengths in headers are not trusted: the VLP-16's position packets name a wrong one.

use etherparse::{EtherType, LaxSlicedPacket};

/// The link types that are read, for messages; the numbers are tcpdump's.
pub(crate) const SUPPORTED: &str = "1 (Ethernet), 101, 12, 14, 228 or 229 (raw IP), 113 or 276 (Linux \
    cooked), 0 or 108 (loopback), 9, 50 or 51 (PPP), 109 (ENC), 239 (NFLOG), 258 or 149 (PKTAP)";

const PPP_IPV4: u16 = 0x0021;
const PPP_IPV6: u16 = 0x0057;
/// The packet itself among the parts of an NFLOG message.
const NFLOG_PAYLOAD: u16 = 9;

/// What a frame holds.
pub(crate) enum Content<'a> {
    Packet(Box<LaxSlicedPacket<'a>>),
    /// The frame is damaged or holds no IP.
    Nothing,
    /// The link type is not supported.
    UnknownLink,
}

/// Takes a frame apart.
pub(crate) fn content(link: u32, frame: &[u8]) -> Content<'_> {
    let sliced = match link {
        0 | 108 => ip_after(frame, 4),
        1 => LaxSlicedPacket::from_ethernet(frame).ok(),
        9 | 50 => ppp(frame),
        12 | 14 | 101 | 228 | 229 => ip_after(frame, 0),
        51 => frame.get(6..).and_then(ppp),
        109 => ip_after(frame, 12),
        113 => ether_type(frame, 14, 16),
        149 | 258 => return pktap(frame),
        239 => nflog(frame),
        276 => ether_type(frame, 0, 20),
        _ => return Content::UnknownLink,
    };
    sliced.map_or(Content::Nothing, |sliced| Content::Packet(Box::new(sliced)))
}

fn ip_after(frame: &[u8], header_bytes: usize) -> Option<LaxSlicedPacket<'_>> {
    LaxSlicedPacket::from_ip(frame.get(header_bytes..)?).ok()
}

/// A header with the type of Ethernet at `at`, and what it names after the header.
fn ether_type(frame: &[u8], at: usize, header_bytes: usize) -> Option<LaxSlicedPacket<'_>> {
    let kind = EtherType(big_endian(frame, at)?);
    Some(LaxSlicedPacket::from_ether_type(kind, frame.get(header_bytes..)?))
}

fn ppp(frame: &[u8]) -> Option<LaxSlicedPacket<'_>> {
    let frame = frame.strip_prefix(&[0xff, 0x03]).unwrap_or(frame);
    matches!(big_endian(frame, 0)?, PPP_IPV4 | PPP_IPV6).then(|| ip_after(frame, 2)).flatten()
}

/// The messages of Linux's firewall: a header of four bytes, then parts with length and type in the order of
/// the machine's bytes, of which nearly all are little-endian.
fn nflog(frame: &[u8]) -> Option<LaxSlicedPacket<'_>> {
    let mut parts = frame.get(4..)?;
    loop {
        let [a, b, c, d] = *parts.first_chunk()?;
        let length = usize::from(u16::from_le_bytes([a, b]));
        if u16::from_le_bytes([c, d]) == NFLOG_PAYLOAD {
            return ip_after(parts.get(..length)?, 4);
        }
        // Parts are as long as whole words; each has a header of one.
        parts = parts.get(length.max(4).next_multiple_of(4)..)?;
    }
}

/// macOS's header, which names its own length and the link type of the frame that follows.
fn pktap(frame: &[u8]) -> Content<'_> {
    let word = |at: usize| {
        let bytes = frame.get(at..)?.first_chunk()?;
        Some(u32::from_le_bytes(*bytes))
    };
    let inner = word(0).and_then(|length| frame.get(length as usize..)).zip(word(8));
    match inner {
        Some((_, 149 | 258)) | None => Content::Nothing,
        Some((inner, link)) => content(link, inner),
    }
}

fn big_endian(bytes: &[u8], at: usize) -> Option<u16> {
    Some(u16::from_be_bytes(*bytes.get(at..)?.first_chunk()?))
}
