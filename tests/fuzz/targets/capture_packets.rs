//! Data packets of sensors in a sound capture: in any order, with any damage.

#![no_main]

use arbitrary::Arbitrary;
use libfuzzer_sys::fuzz_target;
use mapless_scans::{ScanChoice, read_scan_bytes};

#[derive(Arbitrary, Debug)]
struct Packet {
    sender: bool,
    fragment: Option<u8>,
    azimuth: u16,
    advance: i8,
    stamp_us: u32,
    mode: u8,
    product: u8,
    damage: Vec<(u16, u8)>,
    repeats: u8,
}

/// A raw IPv4 packet.
fn ip(packet: &Packet, number: u16) -> Vec<u8> {
    let mut payload = vec![9, 64, 9, 64, 4, 190, 0, 0];
    for block in 0..12 {
        payload.extend([0xff, 0xee]);
        let azimuth = i32::from(packet.azimuth) + block * i32::from(packet.advance);
        payload.extend((azimuth.rem_euclid(36_000) as u16).to_le_bytes());
        payload.extend([200, 10, 3].repeat(32));
    }
    payload.extend(packet.stamp_us.to_le_bytes());
    payload.extend([0x37 + packet.mode % 4, 0x22 + packet.product % 8]);
    for (at, byte) in &packet.damage {
        let at = 8 + usize::from(*at) % (payload.len() - 8);
        payload[at] = *byte;
    }
    // Flags and offset of a fragment.
    let part = packet.fragment.map_or([0, 0], |fragment| [fragment & 0x3f, fragment.rotate_left(3)]);
    let [a, b] = (payload.len() as u16 + 20).to_be_bytes();
    let [c, d] = number.to_be_bytes();
    let head = [
        0x45,
        0,
        a,
        b,
        c,
        d,
        part[0],
        part[1],
        64,
        17,
        0,
        0,
        10,
        0,
        0,
        packet.sender.into(),
        255,
        255,
        255,
        255,
    ];
    [&head[..], &payload].concat()
}

fuzz_target!(|packets: Vec<Packet>| {
    let mut capture =
        vec![0xd4, 0xc3, 0xb2, 0xa1, 2, 0, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 101, 0, 0, 0];
    for (number, packet) in packets.iter().enumerate() {
        let mut packet = Packet { damage: packet.damage.clone(), ..*packet };
        // Turns on, as a sensor does.
        for _ in 0..=packet.repeats {
            let bytes = ip(&packet, number as u16);
            let length = (bytes.len() as u32).to_le_bytes();
            capture.extend([[0; 4], [0; 4], length, length].concat());
            capture.extend(bytes);
            packet.azimuth = packet.azimuth.wrapping_add(480) % 36_000;
            packet.stamp_us = packet.stamp_us.wrapping_add(1327);
        }
    }
    for revolution in 0..2 {
        for source in [None, "10.0.0.0".parse().ok()] {
            if let Ok(scan) = read_scan_bytes("scan.pcap", &capture, ScanChoice { revolution, source }) {
                assert!(scan.points_m.iter().all(|point| point.is_finite()));
            }
        }
    }
});
