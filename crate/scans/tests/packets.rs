//! Packets as they arrive, against the points that another decoder reads from them.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::collections::BTreeMap;
use std::path::Path;

use etherparse::SlicedPacket;
use etherparse::TransportSlice;
use glam::{DVec3, Vec3};
use mapless_scans::{PacketReceiver, Revolution};
use pcap_file::pcap::PcapReader;

const STAMP_US: f64 = 1e6;

/// The packets of `packets_reference.py`, which says what they hold.
fn packets(product: u8, mode: u8) -> Vec<Vec<u8>> {
    let returns = if mode == 0x39 { 2 } else { 1 };
    let packet_us = (55.296 * 24.0 / returns as f64) as u32;
    let packet = |number: usize| {
        let mut packet = Vec::new();
        for block in 0..12 {
            let group = (number * 12 + block) / returns;
            packet.extend(0xeeff_u16.to_le_bytes());
            packet.extend(((35_900 + 400 * group) as u32 % 36_000).to_le_bytes()[..2].to_vec());
            for beam in 0..32 {
                let second = if beam % 3 > 0 { block % returns } else { 0 };
                let seed = group * 32 + beam + second * 7;
                let distance = if seed.is_multiple_of(5) { 0 } else { 250 + seed * 7919 % 1750 };
                packet.extend((distance as u16).to_le_bytes());
                packet.push(beam as u8);
            }
        }
        packet.extend((STAMP_US as u32 + number as u32 * packet_us).to_le_bytes());
        packet.extend([mode, product]);
        packet
    };
    (0..24).map(packet).collect()
}

/// Every return with its time on the sensor's clock, microseconds.
fn timed(revolution: &Revolution) -> Vec<(Vec3, f64)> {
    let times = revolution.since_end_s.iter().map(|since_s| revolution.end_us + 1e6 * since_s);
    revolution.points_m.iter().copied().zip(times).collect()
}

/// The distance to the nearest return that was fired within 1 µs; the returns are in the order of time.
fn missed_m(returns: &[(Vec3, f64)], place_m: DVec3, time_us: f64) -> f64 {
    let begin = returns.partition_point(|(_, at_us)| *at_us < time_us - 1.0);
    let near = returns[begin..].iter().take_while(|(_, at_us)| *at_us <= time_us + 1.0);
    near.map(|(point_m, _)| point_m.as_dvec3().distance(place_m)).fold(f64::INFINITY, f64::min)
}

#[test]
fn points_and_times_are_those_of_another_decoder() {
    let mut rows: BTreeMap<(u8, u8), Vec<(DVec3, f64)>> = BTreeMap::new();
    for line in include_str!("packets_reference.csv").lines() {
        let numbers: Vec<f64> = line.split(',').map(|number| number.parse().unwrap()).collect();
        let [product, mode, x, y, z, time_us] = numbers[..] else { panic!("{line}") };
        rows.entry((product as u8, mode as u8)).or_default().push((DVec3::new(x, y, z), STAMP_US + time_us));
    }
    assert_eq!(rows.len(), 6, "two models, three modes");
    for ((product, mode), rows) in rows {
        let mut receiver = PacketReceiver::new();
        let revolutions: Vec<Revolution> =
            packets(product, mode).iter().filter_map(|packet| receiver.take(packet).unwrap()).collect();
        let mut returns: Vec<(Vec3, f64)> = revolutions.iter().flat_map(timed).collect();
        returns.sort_by(|a, b| a.1.total_cmp(&b.1));
        let (begin_us, end_us) = (returns[0].1, returns.last().unwrap().1);
        let mut compared = 0;
        for (place_m, time_us) in rows.iter().filter(|(_, time_us)| (begin_us..end_us).contains(time_us)) {
            let missed_m = missed_m(&returns, *place_m, *time_us);
            assert!(
                missed_m <= 1e-3,
                "0x{product:02x}, 0x{mode:02x}: {place_m} after {time_us} µs: {missed_m} m"
            );
            compared += 1;
        }
        assert!(compared > 25, "{compared}");
    }
}

#[test]
#[ignore = "reads the data that MAPLESS_DATA names"]
fn captures_have_the_points_and_times_of_another_decoder() {
    let folder = Path::new(&std::env::var_os("MAPLESS_DATA").unwrap()).join("data/vlp16");
    let mut rows: BTreeMap<&str, Vec<(DVec3, f64)>> = BTreeMap::new();
    for line in include_str!("captures_reference.csv").lines() {
        let (name, numbers) = line.split_once(',').unwrap();
        let numbers: Vec<f64> = numbers.split(',').map(|number| number.parse().unwrap()).collect();
        let [x, y, z, time_us] = numbers[..] else { panic!("{line}") };
        rows.entry(name).or_default().push((DVec3::new(x, y, z), time_us));
    }
    assert_eq!(rows.len(), 2, "two captures");
    for (name, rows) in rows {
        let returns = returns(&folder.join(format!("{name}.pcap")));
        let (begin_us, end_us) = (returns[0].1, returns.last().unwrap().1);
        let mut compared = 0;
        for (place_m, time_us) in rows.iter().filter(|(_, time_us)| (begin_us..end_us).contains(time_us)) {
            // The other decoder rounds azimuths to 0.01°.
            let rounded_m = place_m.length() * 0.005_f64.to_radians();
            let missed_m = missed_m(&returns, *place_m, *time_us);
            assert!(missed_m <= 1e-3 + rounded_m, "{name}: {place_m} at {time_us} µs: {missed_m} m");
            compared += 1;
        }
        assert!(compared > returns.len() / 510, "{name}: {compared} of {}", returns.len());
    }
}

/// Every return of a capture with its time on the sensor's clock, microseconds, in the order of time.
fn returns(capture: &Path) -> Vec<(Vec3, f64)> {
    let mut reader = PcapReader::new(std::fs::File::open(capture).unwrap()).unwrap();
    let mut receiver = PacketReceiver::new();
    let mut returns = Vec::new();
    while let Some(frame) = reader.next_packet() {
        let frame = frame.unwrap();
        // Position packets of one capture say a wrong length.
        let Ok(sliced) = SlicedPacket::from_ethernet(&frame.data) else { continue };
        let Some(TransportSlice::Udp(udp)) = sliced.transport else { continue };
        if let Some(revolution) = receiver.take(udp.payload()).unwrap() {
            returns.extend(timed(&revolution));
        }
    }
    returns.sort_by(|a, b| a.1.total_cmp(&b.1));
    returns
}
