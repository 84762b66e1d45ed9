//! Captures of a Velodyne sensor: from the packets of a file to the returns of a whole revolution.
//!
//! A data packet is a UDP payload of 1206 bytes that begins with the flag of a block, on any port. The
//! sensor's position packets are passed over; what else is left out is told in a warning.

mod container;
mod datagrams;
mod link;
mod model;
mod packet;
mod revolutions;
mod sensors;

use std::collections::BTreeMap;

use glam::Vec3;

use crate::error::ScanFault;
use crate::scan::{ScanChoice, ScanWarning};
use container::{Frame, frames};
use datagrams::{Arrival, Datagrams};
use link::{Content, content};
use revolutions::revolutions;
use sensors::Sensors;

/// Length of a Velodyne position packet.
const POSITION_BYTES: usize = 512;

/// The points of one whole revolution.
pub(crate) fn read(
    capture: &[u8],
    choice: ScanChoice,
    warnings: &mut Vec<ScanWarning>,
) -> Result<Vec<Vec3>, ScanFault> {
    let frames = frames(capture, warnings)?;
    let sensors = sensors(&frames, warnings)?;
    let sensor = sensors.choose(choice.source, warnings)?;
    let found = revolutions(&sensor, choice.revolution, warnings);
    let (revolution, whole) = (choice.revolution, found.whole);
    match found.wanted {
        Some(points) => Ok(points),
        None if whole == 0 => Err(ScanFault::NoRevolution { data_packets: sensor.packets.len() }),
        None => Err(ScanFault::Revolution { revolution, whole }),
    }
}

/// Sorts the data packets out of all others, and counts those.
fn sensors<'a>(frames: &[Frame<'a>], warnings: &mut Vec<ScanWarning>) -> Result<Sensors<'a>, ScanFault> {
    let mut sensors = Sensors::default();
    let mut datagrams = Datagrams::default();
    let mut links: BTreeMap<u32, usize> = BTreeMap::new();
    let (mut cut, mut longest_cut, mut others) = (0, (0, 0), 0);
    for frame in frames {
        let arrival = match content(frame.link, frame.bytes) {
            Content::Packet(sliced) => datagrams.take(frame.number, &sliced),
            Content::Nothing => Arrival::Other,
            Content::UnknownLink => {
                *links.entry(frame.link).or_default() += 1;
                continue;
            }
        };
        let is_known = match arrival {
            Arrival::Datagram { source, payload } => {
                payload.len() == POSITION_BYTES || sensors.keep(frame.number, source, payload)
            }
            Arrival::Fragment => true,
            Arrival::Other => false,
        };
        if is_known {
            continue;
        }
        if frame.bytes.len() < frame.wire_bytes {
            cut += 1;
            longest_cut = longest_cut.max((frame.wire_bytes, frame.bytes.len()));
        } else {
            others += 1;
        }
    }
    if sensors.is_empty()
        && let Some(link) = links.keys().next()
    {
        return Err(ScanFault::value("link type", link, link::SUPPORTED));
    }
    let links = links.into_iter().map(|(link, packets)| ScanWarning::UnknownLink { link, packets });
    warnings.extend(links);
    if cut > 0 {
        let (wire_bytes, captured_bytes) = longest_cut;
        warnings.push(ScanWarning::Snaplen { packets: cut, captured_bytes, wire_bytes });
    }
    let fragments = datagrams.fragments_left();
    if fragments > 0 {
        warnings.push(ScanWarning::Fragments { packets: fragments });
    }
    if others > 0 {
        warnings.push(ScanWarning::OtherPackets { packets: others });
    }
    if sensors.is_empty() { Err(ScanFault::NoDataPacket { packets: frames.len() }) } else { Ok(sensors) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vlp16::tests::packet;
    use etherparse::PacketBuilder;
    use proptest::prelude::*;

    const HEADER: [u8; 24] =
        [0xd4, 0xc3, 0xb2, 0xa1, 2, 0, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff, 0, 0, 1, 0, 0, 0];

    fn add(capture: &mut Vec<u8>, payload: &[u8]) {
        let mut frame = Vec::new();
        PacketBuilder::ethernet2([1; 6], [2; 6])
            .ipv4([192, 168, 1, 201], [255; 4], 64)
            .udp(2368, 2368)
            .write(&mut frame, payload)
            .unwrap();
        let length = (frame.len() as u32).to_le_bytes();
        capture.extend([[0; 4], [0; 4], length, length].concat());
        capture.extend(frame);
    }

    /// Ten revolutions a second from `from` on, each packet 4.8° and all distances 3 m plus the number of the
    /// packet.
    fn capture(from: u16, packets: u16) -> Vec<u8> {
        let mut capture = HEADER.to_vec();
        for number in 0..packets {
            let azimuth = (u32::from(from) + 480 * u32::from(number)) % 36_000;
            add(&mut capture, &packet(azimuth as u16, 0x37, |_, _| 1500 + number));
        }
        capture
    }

    fn fault(bytes: &[u8], revolution: usize) -> String {
        read(bytes, revolution).unwrap_err().to_string()
    }

    #[test]
    fn a_revolution_begins_behind_and_holds_every_firing_once() {
        // A turn is 75 packets; the first passing comes after 37.5 packets.
        let capture = capture(0, 37 + 3 * 75 + 2);
        for revolution in 0..3 {
            let points = read(&capture, revolution).unwrap().points_m;
            assert_eq!(points.len(), 1800 * 16);
            let (first, last) = (points[0], points[points.len() - 1]);
            assert!(first.x < 0.0 && (-1e-6..0.02).contains(&first.y), "{first}");
            assert!(last.x < 0.0 && (-0.02..0.0).contains(&last.y), "{last}");
            let nearest = points.iter().map(|point| point.length()).fold(f32::INFINITY, f32::min);
            let expected = 3.0 + 0.002 * (37 + 75 * revolution) as f32;
            assert!((nearest - expected).abs() < 0.012, "{nearest} {expected}");
        }
        assert_eq!(
            fault(&capture, 3),
            "revolution = 3: expected 0 to 2: the capture has 3 whole revolutions"
        );
    }

    #[test]
    fn a_short_capture_has_no_whole_revolution() {
        assert_eq!(
            fault(&capture(0, 100), 0),
            "revolution = 0: expected a longer capture: this one has no whole revolution"
        );
        assert_eq!(fault(&capture(0, 115), 1), "revolution = 1: expected 0, the only one in the file");
    }

    #[test]
    fn other_packets_are_passed_over() {
        let plain = capture(0, 150);
        let mut mixed = HEADER.to_vec();
        add(&mut mixed, &[0; 512]);
        add(&mut mixed, &[0; PACKET_BYTES]);
        mixed.extend([[0; 4], [0; 4], [3, 0, 0, 0], [3, 0, 0, 0]].concat());
        mixed.extend([1, 2, 3]);
        mixed.extend(&plain[24..]);
        assert_eq!(read(&mixed, 0), read(&plain, 0));
        mixed.truncate(24 + 2 * 16 + 512 + PACKET_BYTES + 2 * 42);
        assert!(fault(&mixed, 0).contains("none of its 2 packets is a VLP-16 data packet"));
    }

    #[test]
    fn a_cut_capture_gives_what_is_whole_before_the_cut() {
        let whole = capture(0, 150);
        let cut = read(&whole[..whole.len() - 1], 0).unwrap();
        assert_eq!(cut.points_m, read(&whole, 0).unwrap().points_m);
        assert_eq!(
            cut.warnings[0].to_string(),
            "the capture ends inside packet 150; the 149 before it are read"
        );
    }

    #[test]
    fn damage_is_named() {
        let whole = capture(0, 150);
        assert!(fault(&whole[..20], 0).contains("ends inside its header"));
        assert!(fault(&whole[..5000], 0).contains("expected a longer capture"));
        assert!(fault(b"not a capture, but long enough for one", 0).contains("magic number"));
        let mut link = whole.clone();
        link[20] = 105;
        assert!(fault(&link, 0).starts_with("link type = 105: expected 1 (Ethernet)"));
        let mut huge = whole.clone();
        huge[24 + 8..24 + 12].copy_from_slice(&u32::MAX.to_le_bytes());
        assert!(fault(&huge, 0).contains("none of its 1 packets"));
        let mut bent = whole;
        bent[24 + 16 + 42 + 100] = 0;
        assert!(fault(&bent, 0).starts_with("packet 1, block 2, flag = 0x00ee"));
    }

    proptest! {
        #[test]
        fn any_bytes_after_the_header_give_points_or_a_fault(
            bytes in prop::collection::vec(any::<u8>(), 0..2000),
        ) {
            drop(read(&[&HEADER, bytes.as_slice()].concat(), 0));
            drop(read(&bytes, 0));
        }

        #[test]
        fn damage_anywhere_gives_points_or_a_fault(
            at in prop::collection::vec((0..60_000_usize, any::<u8>()), 1..20), end in 0..200_000_usize,
        ) {
            let mut bytes = capture(0, 130);
            for (at, byte) in at {
                bytes[at] = byte;
            }
            bytes.truncate(end);
            drop(read(&bytes, 0));
        }
    }
}
