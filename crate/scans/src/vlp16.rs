//! The data packets of a VLP-16 (Velodyne, *VLP-16 User Manual*, 63-9243, chapters 6 to 9).
//!
//! A packet has twelve blocks of two firing sequences of the sixteen lasers, and at its end says which
//! returns it holds and of which sensor. A block gives the azimuth of its first firing alone; the others are
//! interpolated.

use glam::Vec3;

use crate::error::ScanFault;

/// Length of a data packet: 12 blocks, a time stamp of four bytes, return mode and product.
pub(crate) const PACKET_BYTES: usize = BLOCKS * BLOCK_BYTES + 6;
/// What each block begins with.
pub(crate) const BLOCK_FLAG: [u8; 2] = [0xff, 0xee];
/// A whole turn in the sensor's unit, hundredths of a degree.
pub(crate) const TURN: f64 = 36_000.0;

const BLOCKS: usize = 12;
const BLOCK_BYTES: usize = 100;
const LASERS: usize = 16;
const RETURN_BYTES: usize = 3;

const STRONGEST: u8 = 0x37;
const LAST: u8 = 0x38;
const DUAL: u8 = 0x39;
const VLP16: u8 = 0x22;

const DISTANCE_UNIT_M: f64 = 0.002;
/// Time between two lasers, two firing sequences and two blocks, microseconds.
const LASER_US: f64 = 2.304;
const SEQUENCE_US: f64 = 55.296;
const BLOCK_US: f64 = 2.0 * SEQUENCE_US;

/// Elevation of each laser in degrees, in the order they fire.
const ELEVATION_DEG: [f64; LASERS] =
    [-15.0, 1.0, -13.0, 3.0, -11.0, 5.0, -9.0, 7.0, -7.0, 9.0, -5.0, 11.0, -3.0, 13.0, -1.0, 15.0];
/// How far above the sensor's origin each laser's beam crosses the vertical axis, millimetres.
const VERTICAL_OFFSET_MM: [f64; LASERS] =
    [11.2, -0.7, 9.7, -2.2, 8.1, -3.7, 6.6, -5.1, 5.1, -6.6, 3.7, -8.1, 2.2, -9.7, 0.7, -11.2];

/// One firing sequence: each laser once.
pub(crate) struct Firing {
    /// Azimuth as the first laser fires, clockwise from forward, hundredths of a degree, below [`TURN`].
    pub(crate) azimuth: f64,
    /// How far the head turns during a block, hundredths of a degree.
    turn_per_block: f64,
    /// Distances in units of 2 mm; 0 is no return.
    distances: [u16; LASERS],
}

impl Firing {
    /// The returns in the project's sensor frame, metres: Velodyne's azimuth turns clockwise, ours
    /// anticlockwise.
    pub(crate) fn points_m(&self) -> impl Iterator<Item = Vec3> {
        self.distances.iter().enumerate().filter(|(_, distance)| **distance > 0).map(|(laser, &distance)| {
            let turned = self.turn_per_block * LASER_US * laser as f64 / BLOCK_US;
            let (sin_a, cos_a) = libm::sincos(((self.azimuth + turned) * 0.01).to_radians());
            let (sin_e, cos_e) = libm::sincos(ELEVATION_DEG[laser].to_radians());
            let range_m = f64::from(distance) * DISTANCE_UNIT_M;
            Vec3::new(
                (range_m * cos_e * cos_a) as f32,
                (-range_m * cos_e * sin_a) as f32,
                (range_m * sin_e + 1e-3 * VERTICAL_OFFSET_MM[laser]) as f32,
            )
        })
    }
}

/// The firings of a data packet, in the order of time; `number` is its place in the capture, from 1.
pub(crate) fn firings(packet: &[u8; PACKET_BYTES], number: usize) -> Result<Vec<Firing>, ScanFault> {
    let [mode, product] = [packet[PACKET_BYTES - 2], packet[PACKET_BYTES - 1]];
    if product != VLP16 {
        let place = format!("packet {number}, product");
        return Err(ScanFault::value(place, format!("0x{product:02x}"), "0x22, a VLP-16"));
    }
    let returns = match mode {
        STRONGEST | LAST => 1,
        DUAL => 2,
        _ => {
            let place = format!("packet {number}, return mode");
            let expected = "0x37 (strongest), 0x38 (last) or 0x39 (dual)";
            return Err(ScanFault::value(place, format!("0x{mode:02x}"), expected));
        }
    };
    let azimuths = azimuths(packet, number)?;
    let mut firings = Vec::with_capacity(2 * BLOCKS);
    // With two returns a beam, two blocks hold the same firings: the last return, then the strongest.
    for first in (0..BLOCKS).step_by(returns) {
        // The last block of the packet turns as far as the one before it.
        let from = first.min(BLOCKS - 1 - returns);
        let turn_per_block = (azimuths[from + returns] - azimuths[from]).rem_euclid(TURN);
        for sequence in 0..2 {
            let azimuth = azimuths[first] + turn_per_block * sequence as f64 * SEQUENCE_US / BLOCK_US;
            let mut firing = Firing {
                azimuth: azimuth.rem_euclid(TURN),
                turn_per_block,
                distances: distances(packet, first, sequence),
            };
            if returns == 1 {
                firings.push(firing);
                continue;
            }
            let last = firing.distances;
            let strongest = distances(packet, first + 1, sequence);
            firing.distances = strongest;
            // A beam with one return tells it twice.
            for (laser, distance) in firing.distances.iter_mut().enumerate() {
                if *distance == last[laser] {
                    *distance = 0;
                }
            }
            firings.push(Firing { distances: last, ..firing });
            firings.push(firing);
        }
    }
    Ok(firings)
}

/// The azimuths of the blocks, hundredths of a degree.
fn azimuths(packet: &[u8; PACKET_BYTES], number: usize) -> Result<[f64; BLOCKS], ScanFault> {
    let mut azimuths = [0.0; BLOCKS];
    for (block, azimuth) in azimuths.iter_mut().enumerate() {
        let place = |what: &str| format!("packet {number}, block {}, {what}", block + 1);
        let head = &packet[block * BLOCK_BYTES..];
        if head[..2] != BLOCK_FLAG {
            let value = format!("0x{:02x}{:02x}", head[0], head[1]);
            return Err(ScanFault::value(place("flag"), value, "0xffee"));
        }
        *azimuth = f64::from(u16::from_le_bytes([head[2], head[3]]));
        if *azimuth >= TURN {
            return Err(ScanFault::value(place("azimuth"), *azimuth, "hundredths of a degree below 36000"));
        }
    }
    Ok(azimuths)
}

fn distances(packet: &[u8; PACKET_BYTES], block: usize, sequence: usize) -> [u16; LASERS] {
    let first = block * BLOCK_BYTES + 4 + sequence * LASERS * RETURN_BYTES;
    std::array::from_fn(|laser| {
        let at = first + laser * RETURN_BYTES;
        u16::from_le_bytes([packet[at], packet[at + 1]])
    })
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A packet whose first block looks to `azimuth`, each next one 0.4° further, with `distance` in every
    /// return.
    pub(crate) fn packet(
        azimuth: u16,
        mode: u8,
        distance: impl Fn(usize, usize) -> u16,
    ) -> [u8; PACKET_BYTES] {
        let mut packet = [0; PACKET_BYTES];
        let returns = if mode == DUAL { 2 } else { 1 };
        for block in 0..BLOCKS {
            let head = block * BLOCK_BYTES;
            packet[head..head + 2].copy_from_slice(&BLOCK_FLAG);
            let azimuth = (azimuth + 40 * (block / returns) as u16) % 36_000;
            packet[head + 2..head + 4].copy_from_slice(&azimuth.to_le_bytes());
            for beam in 0..2 * LASERS {
                let at = head + 4 + beam * RETURN_BYTES;
                packet[at..at + 2].copy_from_slice(&distance(block, beam).to_le_bytes());
            }
        }
        packet[PACKET_BYTES - 2..].copy_from_slice(&[mode, VLP16]);
        packet
    }

    #[test]
    fn the_frame_is_forward_left_up_and_the_azimuth_clockwise() {
        for (azimuth, forward, left) in
            [(0, 1.0, 0.0), (9000, 0.0, -1.0), (18_000, -1.0, 0.0), (27_000, 0.0, 1.0)]
        {
            let packet =
                packet(azimuth, STRONGEST, |block, beam| if (block, beam) == (0, 0) { 1000 } else { 0 });
            let points: Vec<Vec3> = firings(&packet, 1).unwrap().iter().flat_map(Firing::points_m).collect();
            let (sin, cos) = libm::sincos((-15_f64).to_radians());
            let expected = Vec3::new(
                (2.0 * cos * forward) as f32,
                (2.0 * cos * left) as f32,
                (2.0 * sin + 0.0112) as f32,
            );
            assert_eq!(points.len(), 1);
            assert!(points[0].distance(expected) < 1e-6, "{azimuth}: {} {expected}", points[0]);
        }
    }

    #[test]
    fn azimuths_are_interpolated_between_blocks_and_past_the_last() {
        let firings = firings(&packet(35_980, STRONGEST, |_, _| 500), 1).unwrap();
        assert_eq!(firings.len(), 24);
        for (index, firing) in firings.iter().enumerate() {
            let expected = (35_980.0 + 20.0 * index as f64).rem_euclid(TURN);
            assert!((firing.azimuth - expected).abs() < 1e-9, "{index}: {} {expected}", firing.azimuth);
            assert_eq!(firing.points_m().count(), LASERS);
        }
        // The last laser of a sequence fires 34.56 µs after the first, in 110.592 µs for 0.4°.
        let last = firings[2].points_m().last().unwrap();
        let turned = libm::atan2(f64::from(-last.y), f64::from(last.x)).to_degrees();
        assert!((turned - (0.2 + 0.125)).abs() < 1e-4, "{turned}");
    }

    #[test]
    fn two_returns_are_told_apart_and_a_single_one_counts_once() {
        // Blocks in pairs: the last return at 3 m, and from laser 8 on the strongest at 2 m.
        let packet =
            packet(0, DUAL, |block, beam| if block % 2 == 1 && beam % LASERS >= 8 { 1000 } else { 1500 });
        let firings = firings(&packet, 1).unwrap();
        assert_eq!(firings.len(), 24);
        let azimuths: Vec<f64> = firings.iter().map(|firing| firing.azimuth).collect();
        assert_eq!(azimuths[..6], [0.0, 0.0, 20.0, 20.0, 40.0, 40.0]);
        assert!((azimuths[23] - 220.0).abs() < 1e-9);
        let counts: Vec<usize> = firings.iter().map(|firing| firing.points_m().count()).collect();
        assert_eq!(counts, [16, 8].repeat(12));
    }

    #[test]
    fn faults_name_packet_and_block() {
        let fault = |at: usize, byte: u8| {
            let mut packet = packet(0, STRONGEST, |_, _| 500);
            packet[at] = byte;
            firings(&packet, 7).err().unwrap().to_string()
        };
        assert_eq!(fault(1205, 0x24), "packet 7, product = 0x24: expected 0x22, a VLP-16");
        assert!(fault(1204, 0).starts_with("packet 7, return mode = 0x00: expected 0x37 (strongest)"));
        assert_eq!(fault(201, 0), "packet 7, block 3, flag = 0xff00: expected 0xffee");
        assert!(fault(103, 0xff).starts_with("packet 7, block 2, azimuth = 65320: expected"));
    }

    proptest! {
        #[test]
        fn any_packet_gives_finite_points_or_a_fault(
            bytes in prop::collection::vec(any::<u8>(), PACKET_BYTES), mode in STRONGEST..=DUAL, valid in any::<bool>(),
        ) {
            let mut packet: [u8; PACKET_BYTES] = bytes.try_into().unwrap();
            if valid {
                for block in 0..BLOCKS {
                    packet[block * BLOCK_BYTES..][..2].copy_from_slice(&BLOCK_FLAG);
                    packet[block * BLOCK_BYTES + 3] %= 140;
                }
                packet[PACKET_BYTES - 2..].copy_from_slice(&[mode, VLP16]);
            }
            match firings(&packet, 1) {
                Ok(firings) => for point in firings.iter().flat_map(Firing::points_m) {
                    prop_assert!(point.is_finite() && point.length() < 132.0);
                },
                Err(fault) => prop_assert!(!valid, "{}", fault),
            }
        }
    }
}
