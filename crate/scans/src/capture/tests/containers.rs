//! Kinds of files, of links, and of what IP does with a packet.

use etherparse::{IpFragOffset, IpNumber, Ipv4Header, Ipv6FragmentHeader, Ipv6Header};
use pcap_file::TsResolution;
use pcap_file::pcapng::PcapNgWriter;
use pcap_file::pcapng::blocks::Block;
use pcap_file::pcapng::blocks::enhanced_packet::EnhancedPacketBlock;
use pcap_file::pcapng::blocks::interface_description::{
    InterfaceDescriptionBlock, InterfaceDescriptionOption,
};
use pcap_file::pcapng::blocks::section_header::SectionHeaderBlock;
use pcap_file::pcapng::blocks::simple_packet::SimplePacketBlock;

use super::*;

const COUNT: usize = 116;

/// A capture in sections of two interfaces each, the second with nanoseconds; every packet beyond `simple` of
/// them in a section is enhanced and on the second interface.
pub(super) fn pcapng(endianness: Endianness, frames: &[Vec<u8>], simple: usize) -> Vec<u8> {
    let mut file = Vec::new();
    for frames in frames.chunks(50).chain(frames.is_empty().then_some(frames)) {
        let section = SectionHeaderBlock { endianness, ..Default::default() };
        let mut writer = PcapNgWriter::with_section_header(Vec::new(), section).unwrap();
        for resolution in [6, 9] {
            let mut interface = InterfaceDescriptionBlock::new(DataLink::ETHERNET, 0);
            interface.options.push(InterfaceDescriptionOption::IfTsResol(resolution));
            writer.write_block(&Block::InterfaceDescription(interface)).unwrap();
        }
        for (index, frame) in frames.iter().enumerate() {
            let (data, original_len) = (frame.as_slice().into(), frame.len() as u32);
            let block = if index < simple {
                Block::SimplePacket(SimplePacketBlock { original_len, data })
            } else {
                let (interface_id, timestamp) = (1, Duration::ZERO);
                let options = Vec::new();
                Block::EnhancedPacket(EnhancedPacketBlock {
                    interface_id,
                    timestamp,
                    original_len,
                    data,
                    options,
                })
            };
            writer.write_block(&block).unwrap();
        }
        file.extend(writer.into_inner());
    }
    file
}

/// The IP packet in an Ethernet frame.
fn ip(frame: &[u8]) -> &[u8] {
    &frame[14..]
}

#[test]
fn every_container_holds_the_same_points() {
    let frames = frames(&packets(COUNT));
    let expected = points(&pcap(&frames), 0);
    for endianness in [Endianness::Little, Endianness::Big] {
        for ts_resolution in [TsResolution::MicroSecond, TsResolution::NanoSecond] {
            let header =
                PcapHeader { endianness, ts_resolution, datalink: DataLink::ETHERNET, ..Default::default() };
            assert_eq!(points(&pcap_of(header, &frames), 0), expected);
        }
        for simple in [0, 20, 50] {
            assert_eq!(points(&pcapng(endianness, &frames, simple), 0), expected);
        }
    }
    let mixed = [pcapng(Endianness::Big, &frames[..60], 9), pcapng(Endianness::Little, &frames[60..], 0)];
    assert_eq!(points(&mixed.concat(), 0), expected);
}

/// Puts a link layer around an IP datagram.
type Wrapper<'a> = &'a dyn Fn(&[u8]) -> Vec<u8>;

#[test]
fn every_link_type_holds_the_same_points() {
    let frames = frames(&packets(COUNT));
    let expected = points(&pcap(&frames), 0);
    let tag = |tags: &[u8], frame: &[u8]| [&frame[..12], tags, &frame[12..]].concat();
    let before = |head: &[u8], frame: &[u8]| [head, frame].concat();
    let sll = [&[0; 14][..], &[8, 0]].concat();
    let sll_tagged = [&[0; 14][..], &[0x81, 0, 0, 5, 8, 0]].concat();
    let sll2 = [&[8, 0][..], &[0; 18]].concat();
    let pktap = [&[112, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0][..], &[0; 100]].concat();
    let nflog = |frame: &[u8]| {
        let length = (4 + ip(frame).len() as u16).to_le_bytes();
        [&[2, 0, 0, 0, 5, 0, 10, 0, 1, 0, 0, 0, length[0], length[1], 9, 0], ip(frame)].concat()
    };
    let pppoe = [0x11, 0, 0, 1, 0, 0, 0, 0x21];
    let wrap: &[(u32, Wrapper<'_>)] = &[
        (1, &|frame| tag(&[0x81, 0, 0, 5], frame)),
        (1, &|frame| tag(&[0x88, 0xa8, 0, 7, 0x81, 0, 0, 5], frame)),
        // Packets end with a check sum of four bytes.
        (1 | 0x2400_0000, &|frame| [frame, &[1, 2, 3, 4]].concat()),
        (12, &|frame| ip(frame).to_vec()),
        (14, &|frame| ip(frame).to_vec()),
        (101, &|frame| ip(frame).to_vec()),
        (228, &|frame| ip(frame).to_vec()),
        (0, &|frame| before(&[2, 0, 0, 0], ip(frame))),
        (0, &|frame| before(&[0, 0, 0, 2], ip(frame))),
        (108, &|frame| before(&[0, 0, 0, 2], ip(frame))),
        (113, &|frame| before(&sll, ip(frame))),
        (113, &|frame| before(&sll_tagged, ip(frame))),
        (276, &|frame| before(&sll2, ip(frame))),
        (9, &|frame| before(&[0xff, 3, 0, 0x21], ip(frame))),
        (50, &|frame| before(&[0, 0x21], ip(frame))),
        (51, &|frame| before(&pppoe, ip(frame))),
        (109, &|frame| before(&[0; 12], ip(frame))),
        (149, &|frame| before(&pktap, frame)),
        (258, &|frame| before(&pktap, frame)),
        (239, &|frame| nflog(frame)),
    ];
    for (link, wrap) in wrap {
        let wrapped: Vec<Vec<u8>> = frames.iter().map(|frame| wrap(frame)).collect();
        let mut capture = pcap(&wrapped);
        capture[20..24].copy_from_slice(&link.to_le_bytes());
        assert_eq!(points(&capture, 0), expected, "link type {link}");
    }
}

#[test]
fn a_link_type_that_is_not_read_is_named() {
    let frames = frames(&packets(COUNT));
    let mut capture = pcap(&frames);
    capture[20] = 105;
    assert!(fault(&capture, 0).starts_with("a.pcap: link type = 105: expected 1 (Ethernet), 101"));
    let mut mixed = pcapng(Endianness::Little, &frames, 0);
    let usb = InterfaceDescriptionBlock::new(DataLink::USBPCAP, 0);
    let section = SectionHeaderBlock { endianness: Endianness::Little, ..Default::default() };
    let mut writer = PcapNgWriter::with_section_header(Vec::new(), section).unwrap();
    writer.write_block(&Block::InterfaceDescription(usb)).unwrap();
    writer
        .write_block(&Block::SimplePacket(SimplePacketBlock { original_len: 3, data: (&[1; 3]).into() }))
        .unwrap();
    mixed.extend(writer.into_inner());
    assert_eq!(warned(&mixed, 0).1, "1 packet of link type 249 left out");
}

#[test]
fn ipv6_is_read_whole_and_in_fragments() {
    let packets = packets(COUNT);
    let expected = points(&pcap(&frames(&packets)), 0);
    let whole = |packet: &Packet| {
        let mut bytes = Vec::new();
        PacketBuilder::ipv6([1; 16], [2; 16], 64).udp(2368, 2368).write(&mut bytes, packet).unwrap();
        bytes
    };
    let fragments = |(number, packet): (usize, &Packet)| -> Vec<Vec<u8>> {
        let whole = whole(packet);
        let parts = whole[40..].chunks(800).enumerate();
        parts
            .map(|(index, part)| {
                let offset = IpFragOffset::try_new(100 * index as u16).unwrap();
                let fragment = Ipv6FragmentHeader::new(IpNumber::UDP, offset, index == 0, number as u32);
                let header = Ipv6Header {
                    payload_length: 8 + part.len() as u16,
                    next_header: IpNumber::IPV6_FRAGMENTATION_HEADER,
                    ..Ipv6Header::from_slice(&whole).unwrap().0
                };
                [&header.to_bytes()[..], &fragment.to_bytes(), part].concat()
            })
            .collect()
    };
    let whole: Vec<Vec<u8>> = packets.iter().map(whole).collect();
    let fragments: Vec<Vec<u8>> = packets.iter().enumerate().flat_map(fragments).collect();
    for frames in [whole, fragments] {
        let mut capture = pcap(&frames);
        capture[20] = 229;
        assert_eq!(points(&capture, 0), expected);
    }
}

/// The fragments of a packet in the frame, of `size` units of eight bytes.
fn fragments(number: usize, frame: &[u8], size: usize) -> Vec<Vec<u8>> {
    let header = Ipv4Header::from_slice(ip(frame)).unwrap().0;
    let parts = ip(frame)[20..].chunks(8 * size);
    let last = parts.len() - 1;
    parts
        .enumerate()
        .map(|(index, part)| {
            let mut header = header.clone();
            header.identification = number as u16;
            header.more_fragments = index < last;
            header.fragment_offset = IpFragOffset::try_new((size * index) as u16).unwrap();
            header.total_len = 20 + part.len() as u16;
            header.header_checksum = header.calc_header_checksum();
            [&frame[..14], &header.to_bytes(), part].concat()
        })
        .collect()
}

#[test]
fn a_lost_fragment_loses_its_packet_alone() {
    let frames = frames(&packets(COUNT + TURN_PACKETS));
    let mut parts: Vec<Vec<u8>> =
        frames.iter().enumerate().flat_map(|(number, frame)| fragments(number, frame, 70)).collect();
    assert_eq!(parts.len(), 3 * frames.len());
    parts.remove(3 * 20 + 1);
    let scan = read(&pcap(&parts), 0).unwrap();
    assert_eq!(scan.points_m, points(&pcap(&frames), 0));
    let warnings: Vec<String> = scan.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(warnings[0], "2 IP fragments left out: the other fragments are missing");
    assert!(warnings[1].starts_with("1 gap: "), "{warnings:?}");
}

#[test]
fn a_cut_capture_gives_what_is_whole_before_the_cut() {
    let frames = frames(&packets(COUNT));
    for capture in
        [pcap(&frames), pcapng(Endianness::Big, &frames, 0), pcapng(Endianness::Little, &frames, 50)]
    {
        let (found, warning) = warned(&capture[..capture.len() - 5], 0);
        assert_eq!(found, points(&capture, 0));
        assert_eq!(warning, "the capture ends inside packet 116; what comes before is read");
        let early = fault(&capture[..5000], 0);
        assert!(
            early.starts_with("a.pcap: expected a longer capture: its 3 data packets hold no"),
            "{early}"
        );
        assert!(early.ends_with("; the capture ends inside packet 4; what comes before is read"), "{early}");
    }
}

#[test]
fn damage_is_named() {
    let capture = pcap(&frames(&packets(COUNT)));
    assert!(fault(&capture[..20], 0).contains("not a valid pcap file: it ends inside its header"));
    assert!(fault(b"not a capture, but long enough for one", 0).contains("magic number"));
    let mut huge = capture;
    huge[24 + 8..24 + 12].copy_from_slice(&u32::MAX.to_le_bytes());
    let found = fault(&huge, 0);
    assert!(found.contains("none of its 0 packets is one; the capture ends inside packet 1;"), "{found}");
    let mut bent = pcapng(Endianness::Little, &frames(&packets(200)), 0);
    assert!(fault(&bent[..9], 0).contains("not a valid pcapng file: it ends inside its header"));
    let length = bent.len() - 1280 + 4;
    bent[length..length + 4].copy_from_slice(&8_u32.to_le_bytes());
    assert_eq!(warned(&bent, 1).1, "the capture is damaged at packet 200; what comes before is read");
}

#[test]
fn packets_that_the_tool_cut_are_told() {
    let mut frames = frames(&packets(COUNT + 1));
    let cut = |frames: &[Vec<u8>], from: usize| {
        let mut writer = PcapWriter::new(Vec::new()).unwrap();
        for (index, frame) in frames.iter().enumerate() {
            let kept = if index >= from { &frame[..96] } else { frame };
            writer.write_packet(&PcapPacket::new(Duration::ZERO, frame.len() as u32, kept)).unwrap();
        }
        writer.into_writer()
    };
    let (found, warning) = warned(&cut(&frames, COUNT), 0);
    assert_eq!(found, points(&pcap(&frames), 0));
    assert_eq!(warning, "1 packet left out: cut at 96 of 1248 bytes (snaplen)");
    frames.pop();
    let none = fault(&cut(&frames, 0), 0);
    assert!(none.ends_with(
        "none of its 116 packets is one; 116 packets left out: cut at 96 of 1248 bytes (snaplen)"
    ));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn fragments_of_any_size_and_order_give_the_same_points(size in 2..160_usize, turn in 0..100_usize, twice in any::<bool>()) {
        let whole = frames(&packets(COUNT));
        let parts = whole.iter().enumerate().flat_map(|(number, frame)| {
            let mut parts = fragments(number, frame, size);
            let length = parts.len();
            parts.rotate_left(turn % length);
            if twice && length > 1 {
                let first = parts[0].clone();
                parts.insert(1, first);
            }
            parts
        });
        let capture = pcap(&parts.collect::<Vec<_>>());
        prop_assert_eq!(points(&capture, 0), points(&pcap(&whole), 0));
    }
}
