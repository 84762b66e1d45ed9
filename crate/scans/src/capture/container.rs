//! The packets of a pcap or pcapng file, as they were captured.
//!
//! The first bytes say which of both a file is, since tools write either with the extension `.pcap`. The
//! capture's own time stamps are not read: the sensor's are better.

use pcap_parser::nom::Err as Stop;
use pcap_parser::pcapng::{Block, parse_block_be, parse_block_le, parse_sectionheaderblock};
use pcap_parser::{
    PcapError, parse_pcap_frame, parse_pcap_frame_be, parse_pcap_frame_modified, parse_pcap_header,
};

use crate::error::ScanFault;
use crate::scan::ScanWarning;

/// The first bytes of a pcapng file.
const PCAPNG: [u8; 4] = [0x0a, 0x0d, 0x0d, 0x0a];
/// The upper bits of a pcap's link type say whether packets end with a check sum.
const LINK_BITS: u32 = 0x03ff_ffff;

/// A packet of a capture.
pub(crate) struct Frame<'a> {
    /// Place among the packets of the capture, from 1.
    pub(crate) number: usize,
    /// Link type, as tcpdump numbers them.
    pub(crate) link: u32,
    /// What was captured.
    pub(crate) bytes: &'a [u8],
    /// Length on the wire.
    pub(crate) wire_bytes: usize,
}

/// The packets of a capture up to its end, or to where it is cut or damaged.
pub(crate) fn frames<'a>(
    capture: &'a [u8],
    warnings: &mut Vec<ScanWarning>,
) -> Result<Vec<Frame<'a>>, ScanFault> {
    let mut frames = Vec::new();
    let stop = if capture.starts_with(&PCAPNG) {
        parse_sectionheaderblock(capture).map_err(|stop| damaged("pcapng", &stop))?;
        read_pcapng(capture, &mut frames)
    } else {
        read_pcap(capture, &mut frames)?
    };
    let packet = frames.len() + 1;
    match stop {
        None => {}
        Some(Stop::Incomplete(_)) => warnings.push(ScanWarning::CutOff { packet }),
        Some(_) => warnings.push(ScanWarning::Unreadable { packet }),
    }
    Ok(frames)
}

fn damaged(format: &'static str, stop: &Stop<PcapError<&[u8]>>) -> ScanFault {
    let reason = match stop {
        Stop::Incomplete(_) => "it ends inside its header",
        Stop::Error(_) | Stop::Failure(_) => "expected the magic number of a pcap or pcapng file",
    };
    ScanFault::Damaged { format, reason: reason.to_owned() }
}

/// Reads packets until the end, which is `None`, or until one cannot be read.
type Ended<'a> = Option<Stop<PcapError<&'a [u8]>>>;

fn read_pcap<'a>(capture: &'a [u8], frames: &mut Vec<Frame<'a>>) -> Result<Ended<'a>, ScanFault> {
    let (mut rest, header) = parse_pcap_header(capture).map_err(|stop| damaged("pcap", &stop))?;
    let parse = match (header.is_modified_format(), header.is_bigendian()) {
        (true, _) => parse_pcap_frame_modified,
        (false, true) => parse_pcap_frame_be,
        (false, false) => parse_pcap_frame,
    };
    while !rest.is_empty() {
        let (after, packet) = match parse(rest) {
            Ok(next) => next,
            Err(stop) => return Ok(Some(stop)),
        };
        rest = after;
        frames.push(Frame {
            number: frames.len() + 1,
            link: header.network.0.cast_unsigned() & LINK_BITS,
            bytes: packet.data,
            wire_bytes: packet.origlen as usize,
        });
    }
    Ok(None)
}

struct Interface {
    link: u32,
    /// Bytes captured of each packet at most; 0 is all.
    snaplen: usize,
}

fn read_pcapng<'a>(capture: &'a [u8], frames: &mut Vec<Frame<'a>>) -> Ended<'a> {
    let mut rest = capture;
    let mut is_big_endian = false;
    let mut interfaces: Vec<Interface> = Vec::new();
    while !rest.is_empty() {
        let parsed = if is_big_endian { parse_block_be(rest) } else { parse_block_le(rest) };
        let (after, block) = match parsed {
            Ok(next) => next,
            Err(stop) => return Some(stop),
        };
        rest = after;
        let (interface, bytes, wire_bytes) = match block {
            Block::SectionHeader(section) => {
                is_big_endian = section.big_endian();
                interfaces.clear();
                continue;
            }
            Block::InterfaceDescription(interface) => {
                let link = interface.linktype.0.cast_unsigned();
                interfaces.push(Interface { link, snaplen: interface.snaplen as usize });
                continue;
            }
            Block::EnhancedPacket(packet) => {
                let length = packet.data.len().min(packet.caplen as usize);
                (interfaces.get(packet.if_id as usize), &packet.data[..length], packet.origlen)
            }
            // A simple packet is of the first interface, and tells its length on the wire alone.
            Block::SimplePacket(packet) => {
                let interface = interfaces.first();
                let snaplen = interface.map_or(0, |interface| interface.snaplen);
                let most = if snaplen == 0 { usize::MAX } else { snaplen };
                let length = packet.data.len().min(packet.origlen as usize).min(most);
                (interface, &packet.data[..length], packet.origlen)
            }
            _ => continue,
        };
        let Some(interface) = interface else {
            return Some(Stop::Error(PcapError::HeaderNotRecognized));
        };
        let number = frames.len() + 1;
        frames.push(Frame { number, link: interface.link, bytes, wire_bytes: wire_bytes as usize });
    }
    None
}
