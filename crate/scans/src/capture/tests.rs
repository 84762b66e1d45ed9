//! Captures that the tests write themselves.

mod containers;
mod order;
mod sensors;

use etherparse::PacketBuilder;
use glam::Vec3;
use pcap_file::pcap::{PcapHeader, PcapPacket, PcapWriter};
use pcap_file::{DataLink, Endianness};
use proptest::prelude::*;
use std::time::Duration;

use crate::capture::packet::tests::packet;
use crate::{Scan, ScanChoice, read_scan_bytes};

type Packet = [u8; 1206];

/// A whole turn is 75 packets; the first passing comes after 37.5.
const TURN_PACKETS: usize = 75;
const ADDRESS: [u8; 4] = [192, 168, 1, 201];
const PACKET_US: usize = 1327;

/// Ten revolutions a second from straight ahead on, each packet 4.8° and all distances 3 m plus 2 mm for each
/// packet before it. The clock begins shortly before the hour.
fn packets(count: usize) -> Vec<Packet> {
    let packet = |number: usize| {
        let azimuth = 480 * number % 36_000;
        let mut packet = packet(azimuth as u16, 0x37, |_, _| 1500 + number as u16);
        let stamp = ((3_599_950_000 + PACKET_US * number) % 3_600_000_000) as u32;
        packet[1200..1204].copy_from_slice(&stamp.to_le_bytes());
        packet
    };
    (0..count).map(packet).collect()
}

/// A payload on an Ethernet.
fn frame(source: [u8; 4], port: u16, payload: &[u8]) -> Vec<u8> {
    let mut frame = Vec::new();
    let builder = PacketBuilder::ethernet2([1; 6], [2; 6]).ipv4(source, [255; 4], 64).udp(port, 2368);
    builder.write(&mut frame, payload).unwrap();
    frame
}

fn frames<'a>(packets: impl IntoIterator<Item = &'a Packet>) -> Vec<Vec<u8>> {
    packets.into_iter().map(|packet| frame(ADDRESS, 2368, packet)).collect()
}

fn pcap_of(header: PcapHeader, frames: &[Vec<u8>]) -> Vec<u8> {
    let mut writer = PcapWriter::with_header(Vec::new(), header).unwrap();
    for frame in frames {
        let packet = PcapPacket::new(Duration::ZERO, frame.len() as u32, frame);
        writer.write_packet(&packet).unwrap();
    }
    writer.into_writer()
}

/// A little-endian capture of Ethernet frames.
fn pcap(frames: &[Vec<u8>]) -> Vec<u8> {
    let header =
        PcapHeader { endianness: Endianness::Little, datalink: DataLink::ETHERNET, ..Default::default() };
    pcap_of(header, frames)
}

fn read(capture: &[u8], revolution: usize) -> Result<Scan, String> {
    read_scan_bytes("a.pcap", capture, ScanChoice::of_revolution(revolution))
        .map_err(|error| error.to_string())
}

/// The points of a capture that is read without a warning.
fn points(capture: &[u8], revolution: usize) -> Vec<Vec3> {
    let scan = read(capture, revolution).unwrap();
    assert_eq!(scan.warnings, []);
    scan.points_m
}

/// The points of a capture, and its only warning.
fn warned(capture: &[u8], revolution: usize) -> (Vec<Vec3>, String) {
    let scan = read(capture, revolution).unwrap();
    assert_eq!(scan.warnings.len(), 1, "{:?}", scan.warnings);
    (scan.points_m, scan.warnings[0].to_string())
}

fn fault(capture: &[u8], revolution: usize) -> String {
    read(capture, revolution).unwrap_err()
}

#[test]
fn a_revolution_begins_behind_and_holds_every_firing_once() {
    let capture = pcap(&frames(&packets(37 + 3 * TURN_PACKETS + 2)));
    for revolution in 0..3 {
        let points = points(&capture, revolution);
        assert_eq!(points.len(), 1800 * 16);
        let (first, last) = (points[0], points[points.len() - 1]);
        assert!(first.x < 0.0 && (-1e-6..0.02).contains(&first.y), "{first}");
        assert!(last.x < 0.0 && (-0.02..0.0).contains(&last.y), "{last}");
        let nearest = points.iter().map(|point| point.length()).fold(f32::INFINITY, f32::min);
        let expected = 3.0 + 0.002 * (37 + TURN_PACKETS * revolution) as f32;
        assert!((nearest - expected).abs() < 0.012, "{nearest} {expected}");
    }
    assert_eq!(
        fault(&capture, 3),
        "a.pcap: revolution = 3: expected 0 to 2: the capture has 3 whole revolutions"
    );
}

#[test]
fn a_short_capture_has_no_whole_revolution() {
    let capture = |count: usize| pcap(&frames(&packets(count)));
    assert_eq!(
        fault(&capture(100), 0),
        "a.pcap: expected a longer capture: its 100 data packets hold no whole revolution"
    );
    assert_eq!(fault(&capture(115), 1), "a.pcap: revolution = 1: expected 0, the only one in the file");
}

#[test]
fn an_azimuth_that_jitters_behind_the_sensor_passes_once() {
    let mut packets = packets(37 + 2 * TURN_PACKETS + 2);
    for (number, bytes) in packets.iter_mut().enumerate() {
        // The last firing of packets 37, 112 and 187 is past 180°; the next packet begins at 179.99°.
        let jitter = if number % TURN_PACKETS == 38 { 22 } else { 0 };
        let azimuth = (36_000 + 480 * number - 219 - jitter) % 36_000;
        let stamp: [u8; 4] = std::array::from_fn(|index| bytes[1200 + index]);
        *bytes = packet(azimuth as u16, 0x37, |_, _| 1500);
        bytes[1200..1204].copy_from_slice(&stamp);
    }
    let capture = pcap(&frames(&packets));
    let counts = [0, 1].map(|revolution| read(&capture, revolution).unwrap().points_m.len());
    assert!(counts.iter().all(|count| *count == 1800 * 16), "{counts:?}");
    assert!(fault(&capture, 2).contains("expected 0 to 1"));
}

proptest! {
    #[test]
    fn any_bytes_give_points_or_a_fault(bytes in prop::collection::vec(any::<u8>(), 0..2000), ng in any::<bool>()) {
        drop(read(&bytes, 0));
        let header = if ng { containers::pcapng(Endianness::Little, &[], 0) } else { pcap(&[]) };
        drop(read(&[header, bytes].concat(), 0));
    }

    #[test]
    fn damage_anywhere_gives_points_or_a_fault(
        damage in prop::collection::vec((0..150_000_usize, any::<u8>()), 1..20), end in 0..200_000_usize, ng in any::<bool>(),
    ) {
        let frames = frames(&packets(116));
        let mut bytes = if ng { containers::pcapng(Endianness::Big, &frames, 1) } else { pcap(&frames) };
        for (at, byte) in damage {
            let at = at % bytes.len();
            bytes[at] = byte;
        }
        bytes.truncate(end);
        if let Ok(scan) = read(&bytes, 0) {
            prop_assert!(scan.points_m.iter().all(|point| point.is_finite()));
        }
    }
}
