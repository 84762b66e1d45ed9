//! A data packet (Velodyne, *VLP-16 User Manual*, 63-9243, chapters 6 to 9).
//!
//! A packet has twelve blocks of 32 returns: two firing sequences of sixteen lasers or one of 32. Then come
//! the time stamp, the return mode and the product. A block has the azimuth of its first firing alone; the
//! others follow from how far the packet turns.

use glam::Vec3;

use crate::capture::model::{MOST_LASERS, Model};
use crate::error::ScanFault;

/// Length of a data packet: 12 blocks, a time stamp of four bytes, return mode and product.
pub(crate) const PACKET_BYTES: usize = BLOCKS * BLOCK_BYTES + 6;
/// A whole turn in the sensor's unit, hundredths of a degree.
pub(crate) const TURN: f64 = 36_000.0;

/// The first bytes of each block.
const BLOCK_FLAG: [u8; 2] = [0xff, 0xee];
pub(crate) const BLOCKS: usize = 12;
/// With fewer flagged blocks it is no data packet.
pub(crate) const LEAST_FLAGGED: usize = BLOCKS / 2 + 1;
const BLOCK_BYTES: usize = 100;
const RETURN_BYTES: usize = 3;
const RETURNS: usize = 32;

const STRONGEST: u8 = 0x37;
const LAST: u8 = 0x38;
const DUAL: u8 = 0x39;

/// Time between two firings of a sequence and between two sequences, microseconds.
const FIRING_US: f64 = 2.304;
const SEQUENCE_US: f64 = 55.296;

pub(crate) type Packet = [u8; PACKET_BYTES];

/// Whether a UDP payload is a data packet of any model. A damaged packet is still one: most of its blocks
/// have their flag.
pub(crate) fn data_packet(payload: &[u8]) -> Option<&Packet> {
    let packet: &Packet = payload.try_into().ok()?;
    (flagged_blocks(packet) >= LEAST_FLAGGED).then_some(packet)
}

/// Blocks of a packet that have their flag.
pub(crate) fn flagged_blocks(packet: &Packet) -> usize {
    (0..BLOCKS).filter(|block| packet[block * BLOCK_BYTES..].starts_with(&BLOCK_FLAG)).count()
}

/// The number of the model that sent a packet.
pub(crate) fn product(packet: &Packet) -> u8 {
    packet[PACKET_BYTES - 1]
}

/// When the first firing of a packet happened, microseconds after the hour.
pub(crate) fn stamp_us(packet: &Packet) -> u32 {
    let at = BLOCKS * BLOCK_BYTES;
    u32::from_le_bytes([packet[at], packet[at + 1], packet[at + 2], packet[at + 3]])
}

/// What a packet holds.
#[derive(Debug)]
pub(crate) struct Sweep {
    /// In the order of time.
    pub(crate) firings: Vec<Firing>,
    /// How long it took, microseconds.
    pub(crate) duration_us: f64,
    /// Azimuth of its first firing, hundredths of a degree.
    pub(crate) begin: f64,
    /// How far it turned, hundredths of a degree.
    pub(crate) turned: f64,
    /// Blocks that are left out.
    pub(crate) bad_blocks: Vec<ScanFault>,
}

/// One firing sequence: each laser once.
#[derive(Debug)]
pub(crate) struct Firing {
    /// Azimuth as the first laser fires, clockwise from forward, hundredths of a degree, below [`TURN`].
    pub(crate) azimuth: f64,
    /// When the first laser fires, microseconds after the packet's stamp.
    pub(crate) begins_us: f64,
    model: &'static Model,
    /// How far the head turns in a microsecond, hundredths of a degree.
    turn_per_us: f64,
    /// Distances in the unit of the model; 0 is no return.
    distances: [u16; MOST_LASERS],
}

impl Firing {
    /// The returns: in the project's sensor frame, metres, and how long after the first laser each was fired,
    /// microseconds. Velodyne's azimuth turns clockwise, ours anticlockwise.
    pub(crate) fn returns(&self) -> impl Iterator<Item = (Vec3, f64)> {
        let lasers = self.model.lasers.iter().zip(self.distances).enumerate();
        lasers.filter(|(_, (_, distance))| *distance > 0).map(|(index, (laser, distance))| {
            let fired_us = FIRING_US * (index / self.model.lasers_at_once) as f64;
            let azimuth = self.azimuth + self.turn_per_us * fired_us;
            let (sin_a, cos_a) = libm::sincos((azimuth * 0.01 + laser.azimuth_deg).to_radians());
            let (sin_e, cos_e) = libm::sincos(laser.elevation_deg.to_radians());
            let range_m = f64::from(distance) * self.model.distance_unit_m;
            let point_m = Vec3::new(
                (range_m * cos_e * cos_a) as f32,
                (-range_m * cos_e * sin_a) as f32,
                (range_m * sin_e + 1e-3 * laser.above_mm) as f32,
            );
            (point_m, fired_us)
        })
    }

    /// The places of the returns.
    pub(crate) fn points_m(&self) -> impl Iterator<Item = Vec3> {
        self.returns().map(|(point_m, _)| point_m)
    }
}

/// How far it is from one azimuth to another, the shorter way round.
pub(crate) fn turn_between(from: f64, to: f64) -> f64 {
    (to - from + 0.5 * TURN).rem_euclid(TURN) - 0.5 * TURN
}

/// Reads a packet of a sensor of this model; `number` is its place in the capture, from 1.
pub(crate) fn sweep(packet: &Packet, model: &'static Model, number: usize) -> Result<Sweep, ScanFault> {
    let returns = match packet[PACKET_BYTES - 2] {
        STRONGEST | LAST => 1,
        DUAL => 2,
        mode => {
            let place = format!("packet {number}, return mode");
            let expected = "0x37 (strongest), 0x38 (last) or 0x39 (dual)";
            return Err(ScanFault::value(place, format!("0x{mode:02x}"), expected));
        }
    };
    let sequences = RETURNS / model.lasers.len();
    let block_us = SEQUENCE_US * sequences as f64;
    let mut bad_blocks = Vec::new();
    let azimuths: [Option<f64>; BLOCKS] = std::array::from_fn(|block| {
        azimuth(packet, block, number).map_err(|fault| bad_blocks.push(fault)).ok()
    });
    // With two returns a beam, two blocks hold the same firings: the last return, then the strongest.
    let good: Vec<(usize, f64)> = azimuths
        .chunks(returns)
        .enumerate()
        .filter_map(|(index, pair)| Some((index, pair.iter().flatten().next().copied()?)))
        .collect();
    let ([first, .., last], Some(turn)) = (good.as_slice(), turn_per_block(&good)) else {
        let expected = "at least two with flag and azimuth";
        return Err(ScanFault::value(format!("packet {number}, good blocks"), good.len(), expected));
    };
    let mut firings = Vec::with_capacity(RETURNS * BLOCKS / model.lasers.len());
    for &(index, begin) in &good {
        for sequence in 0..sequences {
            let azimuth = begin + turn * sequence as f64 / sequences as f64;
            let firing = |distances: [u16; MOST_LASERS]| Firing {
                azimuth: azimuth.rem_euclid(TURN),
                begins_us: block_us * index as f64 + SEQUENCE_US * sequence as f64,
                model,
                turn_per_us: turn / block_us,
                distances,
            };
            let distances = |block: usize| {
                azimuths[block].map(|_| distances(packet, block, sequence * model.lasers.len(), model))
            };
            let first = distances(index * returns);
            let mut second = if returns == 2 { distances(index * returns + 1) } else { None };
            // A beam with one return reports it twice.
            for (distance, last) in second.iter_mut().flatten().zip(first.iter().flatten()) {
                if distance == last {
                    *distance = 0;
                }
            }
            firings.extend(first.map(firing));
            firings.extend(second.map(firing));
        }
    }
    let groups = BLOCKS / returns;
    let begin = first.1 - turn * first.0 as f64;
    let end = last.1 + turn * (groups - last.0) as f64;
    Ok(Sweep {
        firings,
        duration_us: block_us * groups as f64,
        begin,
        turned: turn_between(begin, end),
        bad_blocks,
    })
}

/// How far the head turns from one group of blocks to the next, hundredths of a degree: the mean over the
/// packet, because the encoder's azimuths jitter, but for the least turn and the most, because the azimuth
/// of a sensor with a limited view jumps.
fn turn_per_block(good: &[(usize, f64)]) -> Option<f64> {
    let turn = |pair: &[(usize, f64)]| turn_between(pair[0].1, pair[1].1) / (pair[1].0 - pair[0].0) as f64;
    let mut turns: Vec<f64> = good.windows(2).map(turn).collect();
    turns.sort_by(f64::total_cmp);
    let kept = if turns.len() > 3 { &turns[1..turns.len() - 1] } else { &turns };
    (!kept.is_empty()).then(|| kept.iter().sum::<f64>() / kept.len() as f64)
}

/// The azimuth of a block, hundredths of a degree.
fn azimuth(packet: &Packet, block: usize, number: usize) -> Result<f64, ScanFault> {
    let place = |what: &str| format!("packet {number}, block {}, {what}", block + 1);
    let head = &packet[block * BLOCK_BYTES..];
    if head[..2] != BLOCK_FLAG {
        let value = format!("0x{:02x}{:02x}", head[0], head[1]);
        return Err(ScanFault::value(place("flag"), value, "0xffee"));
    }
    let azimuth = f64::from(u16::from_le_bytes([head[2], head[3]]));
    if azimuth >= TURN {
        return Err(ScanFault::value(place("azimuth"), azimuth, "hundredths of a degree below 36000"));
    }
    Ok(azimuth)
}

/// The distances of a firing sequence whose first return in the block is `first`.
fn distances(packet: &Packet, block: usize, first: usize, model: &Model) -> [u16; MOST_LASERS] {
    let mut distances = [0; MOST_LASERS];
    for (index, distance) in distances.iter_mut().enumerate().take(model.lasers.len()) {
        let at = block * BLOCK_BYTES + 4 + (first + index) * RETURN_BYTES;
        *distance = u16::from_le_bytes([packet[at], packet[at + 1]]);
    }
    distances
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::capture::model::MODELS;
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
            for beam in 0..RETURNS {
                let at = head + 4 + beam * RETURN_BYTES;
                packet[at..at + 2].copy_from_slice(&distance(block, beam).to_le_bytes());
            }
        }
        packet[PACKET_BYTES - 2..].copy_from_slice(&[mode, MODELS[0].product]);
        packet
    }

    fn firings(packet: &Packet) -> Vec<Firing> {
        sweep(packet, &MODELS[0], 1).unwrap().firings
    }

    #[test]
    fn the_frame_is_forward_left_up_and_the_azimuth_clockwise() {
        for (azimuth, forward, left) in
            [(0, 1.0, 0.0), (9000, 0.0, -1.0), (18_000, -1.0, 0.0), (27_000, 0.0, 1.0)]
        {
            let packet =
                packet(azimuth, STRONGEST, |block, beam| if (block, beam) == (0, 0) { 1000 } else { 0 });
            let points: Vec<Vec3> = firings(&packet).iter().flat_map(Firing::points_m).collect();
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
        let firings = firings(&packet(35_980, STRONGEST, |_, _| 500));
        assert_eq!(firings.len(), 24);
        for (index, firing) in firings.iter().enumerate() {
            let expected = (35_980.0 + 20.0 * index as f64).rem_euclid(TURN);
            assert!((firing.azimuth - expected).abs() < 1e-9, "{index}: {} {expected}", firing.azimuth);
            assert_eq!(firing.points_m().count(), 16);
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
            packet(0, DUAL, |block, beam| if block % 2 == 1 && beam % 16 >= 8 { 1000 } else { 1500 });
        let firings = firings(&packet);
        assert_eq!(firings.len(), 24);
        let azimuths: Vec<f64> = firings.iter().map(|firing| firing.azimuth).collect();
        assert_eq!(azimuths[..6], [0.0, 0.0, 20.0, 20.0, 40.0, 40.0]);
        assert!((azimuths[23] - 220.0).abs() < 1e-9);
        let counts: Vec<usize> = firings.iter().map(|firing| firing.points_m().count()).collect();
        assert_eq!(counts, [16, 8].repeat(12));
    }

    #[test]
    fn a_bad_block_is_left_out_and_the_others_turn_as_far_as_they_did() {
        let whole = packet(35_900, STRONGEST, |block, _| 500 + block as u16);
        for block in 0..BLOCKS {
            let mut bent = whole;
            bent[block * BLOCK_BYTES] = 0;
            let bent = sweep(&bent, &MODELS[0], 7).unwrap();
            let expected = format!("packet 7, block {}, flag = 0x00ee: expected 0xffee", block + 1);
            assert_eq!(bent.bad_blocks.iter().map(ToString::to_string).collect::<Vec<_>>(), [expected]);
            let mut rest = firings(&whole);
            rest.drain(2 * block..2 * block + 2);
            let azimuths =
                |firings: &[Firing]| -> Vec<f64> { firings.iter().map(|firing| firing.azimuth).collect() };
            let differences = azimuths(&rest).into_iter().zip(azimuths(&bent.firings));
            assert_eq!(bent.firings.len(), 22);
            assert!(differences.into_iter().all(|(a, b)| (a - b).abs() < 1e-9), "{block}");
            assert_eq!((bent.begin.rem_euclid(TURN), bent.turned), (35_900.0, 480.0));
        }
    }

    #[test]
    fn of_two_returns_the_good_block_counts() {
        let mut packet = packet(0, DUAL, |block, _| if block % 2 == 1 { 1000 } else { 1500 });
        packet[2 * BLOCK_BYTES] = 0;
        packet[5 * BLOCK_BYTES + 3] = 0xff;
        let sweep = sweep(&packet, &MODELS[0], 1).unwrap();
        assert_eq!((sweep.firings.len(), sweep.bad_blocks.len()), (20, 2));
        let distances: Vec<u16> = sweep.firings.iter().map(|firing| firing.distances[0]).collect();
        assert_eq!(distances[..8], [1500, 1000, 1500, 1000, 1000, 1000, 1500, 1500]);
    }

    #[test]
    fn faults_name_packet_and_place() {
        let fault = |mode: u8, good: usize| {
            let mut packet = packet(0, STRONGEST, |_, _| 500);
            packet[PACKET_BYTES - 2] = mode;
            for block in good..BLOCKS {
                packet[block * BLOCK_BYTES + 3] = 0xff;
            }
            sweep(&packet, &MODELS[0], 7).err().unwrap().to_string()
        };
        assert!(fault(0, 12).starts_with("packet 7, return mode = 0x00: expected 0x37 (strongest)"));
        assert!(fault(LAST, 1).starts_with("packet 7, good blocks = 1: expected at least two"));
    }

    /// Points as velodyne-decoder 3.0.0 (PyPI) gives them, for lasers that all measure 10 m.
    #[test]
    fn the_other_models_have_their_own_angles() {
        let firing = |product: u8, distance: u16| {
            let model = MODELS.iter().find(|model| model.product == product).unwrap();
            let firings = sweep(&packet(0, STRONGEST, |_, _| distance), model, 1).unwrap().firings;
            (firings.len(), firings[0].points_m().collect::<Vec<Vec3>>())
        };
        let (count, hi_res) = firing(0x24, 5000);
        assert_eq!((count, hi_res.len()), (24, 16));
        let elevation = |point: &Vec3| libm::atan2(f64::from(point.z), f64::from(point.x)).to_degrees();
        assert!((elevation(&hi_res[0]) + 10.0).abs() < 0.05 && (elevation(&hi_res[15]) - 10.0).abs() < 0.05);
        let (count, wide) = firing(0x28, 2500);
        assert_eq!((count, wide.len()), (12, 32));
        let azimuth = |point: &Vec3| libm::atan2(f64::from(-point.y), f64::from(point.x)).to_degrees();
        for (laser, azimuth_deg, elevation_deg) in [(0, 1.4, -25.0), (1, -4.2, -1.0), (29, -1.4, 15.0)] {
            // All fire within 0.4°.
            let turned = azimuth(&wide[laser]) - azimuth_deg;
            assert!((0.0..0.4).contains(&(turned + 1e-4)), "{laser}: {turned}");
            let climb = libm::asin(f64::from(wide[laser].z / wide[laser].length())).to_degrees();
            assert!((climb - elevation_deg).abs() < 1e-3, "{laser}: {climb}");
        }
    }

    proptest! {
        #[test]
        fn any_packet_gives_finite_points_or_a_fault(
            bytes in prop::collection::vec(any::<u8>(), PACKET_BYTES), mode in STRONGEST..=DUAL, valid in any::<bool>(),
            model in 0..MODELS.len(),
        ) {
            let mut packet: Packet = bytes.try_into().unwrap();
            if valid {
                for block in 0..BLOCKS {
                    packet[block * BLOCK_BYTES..][..2].copy_from_slice(&BLOCK_FLAG);
                    packet[block * BLOCK_BYTES + 3] %= 140;
                }
                packet[PACKET_BYTES - 2] = mode;
            }
            match sweep(&packet, &MODELS[model], 1) {
                Ok(sweep) => for point in sweep.firings.iter().flat_map(Firing::points_m) {
                    prop_assert!(point.is_finite() && point.length() < 264.0);
                },
                Err(fault) => prop_assert!(!valid, "{}", fault),
            }
        }
    }
}
