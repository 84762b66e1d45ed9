//! Several sensors, several models, and what is no data packet.

use super::*;

const OTHER: [u8; 4] = [192, 168, 1, 202];

/// Two sensors that look to different sides, their packets in turn.
fn two(product: u8) -> Vec<u8> {
    let mut others = packets(116);
    for (number, packet) in others.iter_mut().enumerate() {
        *packet = super::packet(((480 * number + 9_000) % 36_000) as u16, 0x37, |_, _| 700);
        packet[1200..1204].copy_from_slice(&(1327 * number as u32).to_le_bytes());
        packet[1205] = product;
    }
    let pairs = packets(116).into_iter().zip(others);
    let frames: Vec<Vec<u8>> =
        pairs.flat_map(|(one, other)| [frame(ADDRESS, 2368, &one), frame(OTHER, 2369, &other)]).collect();
    pcap(&frames)
}

fn from(capture: &[u8], source: &str) -> Result<Scan, String> {
    let source = Some(source.parse().unwrap());
    let choice = ScanChoice { source, ..ScanChoice::default() };
    read_scan_bytes("a.pcap", capture, choice).map_err(|error| error.to_string())
}

#[test]
fn of_two_sensors_one_must_be_chosen() {
    let capture = two(0x28);
    let both = "192.168.1.201:2368 (VLP-16, 116 packets), 192.168.1.202:2369 (VLP-32C, 116 packets)";
    let expected = format!("expected one of the capture's sensors: {both}");
    assert_eq!(fault(&capture, 0), format!("a.pcap: source = none: {expected}"));
    for source in ["192.168.1.203", "192.168.1.202:2368", "fe80::1"] {
        assert_eq!(from(&capture, source).unwrap_err(), format!("a.pcap: source = {source}: {expected}"));
    }
    for source in ["192.168.1.201", "192.168.1.201:2368"] {
        let scan = from(&capture, source).unwrap();
        assert_eq!(scan.points_m, points(&pcap(&frames(&packets(116))), 0));
        let warnings: Vec<String> = scan.warnings.iter().map(ToString::to_string).collect();
        assert_eq!(warnings, ["116 data packets left out: from 192.168.1.202:2369, product 0x28"]);
    }
    let wide = from(&two(0x22), "192.168.1.202").unwrap().points_m;
    assert!(wide.len() == 1800 * 16 && wide.iter().all(|point| point.length() < 1.5));
}

#[test]
fn a_model_that_is_not_read_is_left_out_beside_one_that_is() {
    let (found, warning) = warned(&two(0x21), 0);
    assert_eq!(found, points(&pcap(&frames(&packets(116))), 0));
    assert_eq!(warning, "116 data packets left out: from 192.168.1.202:2369, product 0x21");
    let mut only = packets(116);
    for packet in &mut only {
        packet[1205] = 0x21;
    }
    assert_eq!(
        fault(&pcap(&frames(&only)), 0),
        "a.pcap: packet 1, product = 0x21: expected 0x22 (VLP-16), 0x24 (Puck Hi-Res) or 0x28 (VLP-32C)"
    );
}

#[test]
fn position_packets_are_passed_over_and_others_counted() {
    let data = frames(&packets(116));
    let expected = points(&pcap(&data), 0);
    let mut position = frame(ADDRESS, 8308, &[0; 512]);
    assert_eq!(points(&pcap(&[&[position.clone()], &data[..]].concat()), 0), expected);
    // The sensor's own header names 1234 bytes.
    position[16..18].copy_from_slice(&1234_u16.to_be_bytes());
    assert_eq!(points(&pcap(&[&[position.clone()], &data[..]].concat()), 0), expected);
    let others = [frame(ADDRESS, 53, &[7; 40]), frame(ADDRESS, 2368, &[0; 1206]), vec![1, 2, 3], position];
    let (found, warning) = warned(&pcap(&[&others, &data[..]].concat()), 0);
    assert_eq!(found, expected);
    assert_eq!(warning, "3 packets left out: not from a Velodyne sensor");
    assert_eq!(
        fault(&pcap(&others), 0),
        "a.pcap: expected data packets of a Velodyne sensor, 1206 bytes over UDP: none of its 4 packets is one; \
         3 packets left out: not from a Velodyne sensor"
    );
}

#[test]
fn two_returns_of_a_puck_hi_res_and_a_vlp_32c_are_read() {
    for (product, lasers, returns) in [(0x24_u8, 16, 1), (0x28, 32, 1), (0x24, 16, 2), (0x28, 32, 2)] {
        let mode = [0x37, 0x39][returns - 1];
        // A packet of the VLP-32C takes half the time.
        let packet_us = 663.552 * f64::from(32 / lasers) / returns as f64;
        let packet = |number: usize| {
            let azimuth = 480 / returns * number % 36_000;
            let distance = |block: usize, _| 1000 + (block % returns) as u16;
            let mut packet = super::packet(azimuth as u16, mode, distance);
            packet[1200..1204].copy_from_slice(&((packet_us * number as f64) as u32).to_le_bytes());
            packet[1205] = product;
            packet
        };
        let packets: Vec<Packet> = (0..116 * returns).map(packet).collect();
        let points = points(&pcap(&frames(&packets)), 0);
        let blocks = 900;
        assert_eq!(points.len(), blocks * 32 * returns, "{product:x} {returns}");
    }
}
