//! Packets that come twice, late or not at all.

use super::*;

fn without(packets: &[Packet], lost: impl Fn(usize) -> bool) -> Vec<u8> {
    let kept = packets.iter().enumerate().filter(|(number, _)| !lost(*number)).map(|(_, packet)| packet);
    pcap(&frames(kept))
}

#[test]
fn a_packet_that_comes_twice_counts_once() {
    let packets = packets(116);
    let expected = points(&pcap(&frames(&packets)), 0);
    let twice = pcap(&frames(packets.iter().flat_map(|packet| [packet, packet])));
    let (found, warning) = warned(&twice, 0);
    assert_eq!(found, expected);
    assert_eq!(warning, "116 packets left out: the same bytes as the one before");
}

#[test]
fn late_packets_are_put_in_order_even_across_the_hour() {
    // The hour ends with packet 37, and packet 112 passes behind.
    for swapped in [37, 38, 111, 112, 113] {
        let mut packets = packets(116);
        let expected = points(&pcap(&frames(&packets)), 0);
        packets.swap(swapped, swapped + 1);
        let (found, warning) = warned(&pcap(&frames(&packets)), 0);
        assert_eq!(found, expected, "{swapped}");
        assert_eq!(warning, "1 packet put back in the order of the sensor's clock");
    }
}

#[test]
fn a_revolution_with_a_gap_is_left_out() {
    let packets = packets(37 + 3 * TURN_PACKETS + 2);
    let intact = pcap(&frames(&packets));
    let (found, warning) = warned(&without(&packets, |number| (50..88).contains(&number)), 0);
    assert_eq!(found, points(&intact, 1));
    assert_eq!(
        warning,
        "1 gap: the revolutions there are left out; the first, after packet 50: 50.4 ms are missing by the sensor's \
         time stamps"
    );
    // The packet behind belongs to two revolutions.
    let one = without(&packets, |number| number == 112);
    assert_eq!(warned(&one, 0).0, points(&intact, 2));
    assert!(
        fault(&one, 1).starts_with("a.pcap: revolution = 1: expected 0, the only one in the file; 1 gap: ")
    );
    // Whole turns are lost: the azimuth alone says nothing.
    let turn = without(&packets, |number| (60..60 + TURN_PACKETS).contains(&number));
    assert_eq!(warned(&turn, 0).0, points(&intact, 2));
}

#[test]
fn without_a_clock_the_azimuth_tells_a_gap() {
    let mut packets = packets(37 + 3 * TURN_PACKETS + 2);
    for packet in &mut packets {
        packet[1200..1204].fill(0);
    }
    let intact = pcap(&frames(&packets));
    let (found, warning) = warned(&without(&packets, |number| number == 50), 0);
    assert_eq!(found, points(&intact, 1));
    assert!(warning.ends_with("the first, after packet 50: the azimuth jumps by 4.8°"), "{warning}");
}

#[test]
fn a_clock_that_is_set_parts_what_came_before_from_what_comes_after() {
    let mut packets = packets(37 + 3 * TURN_PACKETS + 2);
    let intact = pcap(&frames(&packets));
    for (number, packet) in packets.iter_mut().enumerate().skip(50) {
        packet[1200..1204].copy_from_slice(&(2_000_000_000 + 1327 * number as u32).to_le_bytes());
    }
    let (found, warning) = warned(&pcap(&frames(&packets)), 0);
    assert_eq!(found, points(&intact, 1));
    assert!(warning.contains("after packet 50: "), "{warning}");
}

#[test]
fn bad_blocks_and_packets_are_left_out_and_counted() {
    let mut packets = packets(116);
    let expected = points(&pcap(&frames(&packets)), 0);
    packets[20][300] = 0;
    packets[21][303] = 0xff;
    let (found, warning) = warned(&pcap(&frames(&packets)), 0);
    assert_eq!(found, expected);
    assert_eq!(warning, "2 blocks left out; the first: packet 21, block 4, flag = 0x00ee: expected 0xffee");
    packets[90][200] = 0;
    assert_eq!(read(&pcap(&frames(&packets)), 0).unwrap().points_m.len(), expected.len() - 32);
    packets[90][1204] = 0;
    let lost = fault(&pcap(&frames(&packets)), 0);
    assert!(
        lost.contains("1 data packet left out; the first: packet 91, return mode = 0x00: expected"),
        "{lost}"
    );
    assert!(lost.contains("1 gap: "), "{lost}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn twice_and_late_packets_change_nothing(
        again in prop::collection::vec(0..116_usize, 0..10), late in prop::collection::vec((0..108_usize, 1..8_usize), 0..10),
    ) {
        let packets = packets(116);
        let expected = points(&pcap(&frames(&packets)), 0);
        let mut order: Vec<usize> = (0..116).collect();
        for (from, by) in late {
            let number = order.remove(from);
            order.insert(from + by, number);
        }
        for number in again {
            let at = order.iter().position(|other| *other == number).unwrap();
            order.insert(at, number);
        }
        let capture = pcap(&frames(order.into_iter().map(|number| &packets[number])));
        prop_assert_eq!(read(&capture, 0).unwrap().points_m, expected);
    }

    #[test]
    fn what_is_called_a_revolution_has_lost_nothing(
        lost in prop::collection::btree_set(0..264_usize, 0..6), has_clock in any::<bool>(),
    ) {
        let mut packets = packets(264);
        for packet in packets.iter_mut().filter(|_| !has_clock) {
            packet[1200..1204].fill(0);
        }
        let intact = pcap(&frames(&packets));
        // A revolution is of packets 37.5, 112.5 and so on to the next of these.
        let whole = (0..3).filter(|k| !lost.iter().any(|lost| (37 + 75 * k..=112 + 75 * k).contains(lost)));
        let whole: Vec<usize> = whole.collect();
        let capture = without(&packets, |number| lost.contains(&number));
        for (index, revolution) in whole.iter().enumerate() {
            prop_assert_eq!(read(&capture, index).unwrap().points_m, points(&intact, *revolution));
        }
        prop_assert!(read(&capture, whole.len()).is_err());
    }
}
