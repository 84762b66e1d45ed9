//! Packets of a Velodyne sensor as they arrive: revolution by revolution, each return with its time.

use glam::Vec3;

use crate::capture::POSITION_BYTES;
use crate::capture::model::{self, MODELS};
use crate::capture::packet::{
    self, BLOCKS, Firing, LEAST_FLAGGED, PACKET_BYTES, Packet, Sweep, flagged_blocks, sweep,
};
use crate::capture::revolutions::{Turns, lost_between};
use crate::error::ScanFault;

/// A sensor's clock begins again with each hour.
const HOUR_US: f64 = 3.6e9;
/// Of the slowest sensor, a revolution with two returns has 7300; more is no revolution.
const MOST_FIRINGS: usize = 20_000;

/// A whole revolution, from behind the sensor round to behind it again.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Revolution {
    /// The returns in the sensor's frame, metres, in the order they were fired.
    pub points_m: Vec<Vec3>,
    /// When each was fired, seconds before the last firing sequence of the revolution began: 0 or less, but
    /// for that sequence itself.
    pub since_end_s: Vec<f64>,
    /// When that sequence began on the sensor's clock, microseconds after the hour.
    pub end_us: f64,
}

/// Puts the packets of one sensor together, as they come over UDP (port 2368). It reads what the reader of
/// captures does: VLP-16, Puck Hi-Res and VLP-32C, with the strongest return, the last one or both.
#[derive(Debug, Default)]
pub struct PacketReceiver {
    packets: usize,
    turns: Turns,
    before: Option<(u32, Sweep)>,
    /// Microseconds from the sensor's hour to the stamp of the last packet, counted on past the next hour.
    clock_us: f64,
    gap: Option<String>,
}

impl PacketReceiver {
    /// A receiver that waits for the first whole revolution.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes the payload of a datagram; the revolution that it ends. Position packets are passed over. A
    /// revolution of which a packet was lost is left out.
    ///
    /// # Errors
    /// [`ScanFault`] says what is wrong with the packet, counted from 1. The revolution under way is then
    /// left out, too.
    pub fn take(&mut self, payload: &[u8]) -> Result<Option<Revolution>, ScanFault> {
        self.packets += 1;
        if payload.len() == POSITION_BYTES {
            return Ok(None);
        }
        let swept = self.read(payload);
        let (stamp_us, mut swept) = match swept {
            Ok(read) => read,
            Err(fault) => {
                self.interrupt();
                return Err(fault);
            }
        };
        if let Some((before_us, turned)) = &self.before {
            let passed_us = (f64::from(stamp_us) - f64::from(*before_us)).rem_euclid(HOUR_US);
            self.clock_us += passed_us;
            let lost = lost_between(turned, &swept, Some(passed_us));
            if let Some(gap) = lost.or_else(|| self.endless()) {
                self.interrupt();
                self.gap = Some(gap);
            }
        }
        if self.before.is_none() {
            self.clock_us = f64::from(stamp_us);
        }
        let mut whole = None;
        for mut firing in std::mem::take(&mut swept.firings) {
            firing.begins_us += self.clock_us;
            whole = self.turns.take(firing).or(whole);
        }
        self.before = Some((stamp_us, swept));
        Ok(whole.as_deref().and_then(revolution))
    }

    /// What was missing between two packets since this was last asked, for people: the revolution under way
    /// was left out.
    pub fn take_gap(&mut self) -> Option<String> {
        self.gap.take()
    }

    /// Why the revolution under way is none, if it has no end.
    fn endless(&self) -> Option<String> {
        let firings = self.turns.firings();
        (firings > MOST_FIRINGS).then(|| format!("{firings} firings without a whole turn"))
    }

    fn read(&self, payload: &[u8]) -> Result<(u32, Sweep), ScanFault> {
        let place = |what: &str| format!("packet {}, {what}", self.packets);
        let packet: &Packet = payload.try_into().map_err(|_| {
            let expected = format!("{PACKET_BYTES} bytes, a data packet of a Velodyne sensor");
            ScanFault::value(place("length"), payload.len(), expected)
        })?;
        let flagged = flagged_blocks(packet);
        if flagged < LEAST_FLAGGED {
            let expected = format!("at least {LEAST_FLAGGED} of {BLOCKS}");
            return Err(ScanFault::value(place("blocks with the flag 0xffee"), flagged, expected));
        }
        let product = packet::product(packet);
        let model = MODELS.iter().find(|model| model.product == product);
        let model = model.ok_or_else(|| {
            ScanFault::value(place("product"), format!("0x{product:02x}"), model::SUPPORTED)
        })?;
        Ok((packet::stamp_us(packet), sweep(packet, model, self.packets)?))
    }

    fn interrupt(&mut self) {
        self.turns.interrupt();
        self.before = None;
    }
}

fn revolution(firings: &[Firing]) -> Option<Revolution> {
    let end_us = firings.last()?.begins_us;
    let mut revolution = Revolution { end_us: end_us.rem_euclid(HOUR_US), ..Revolution::default() };
    for firing in firings {
        for (point_m, after_us) in firing.returns() {
            revolution.points_m.push(point_m);
            revolution.since_end_s.push(1e-6 * (firing.begins_us + after_us - end_us));
        }
    }
    Some(revolution)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capture::packet::tests::packet;
    use proptest::prelude::*;

    /// Ten revolutions a second from straight ahead on; the sensor's clock begins shortly before the hour.
    fn packets(count: usize) -> Vec<[u8; PACKET_BYTES]> {
        let packet = |number: usize| {
            let mut packet = packet((480 * number % 36_000) as u16, 0x37, |_, _| 1500);
            let stamp = ((3_599_950_000 + 1327 * number) % 3_600_000_000) as u32;
            packet[1200..1204].copy_from_slice(&stamp.to_le_bytes());
            packet
        };
        (0..count).map(packet).collect()
    }

    fn revolutions(receiver: &mut PacketReceiver, packets: &[[u8; PACKET_BYTES]]) -> Vec<Revolution> {
        packets.iter().filter_map(|packet| receiver.take(packet).unwrap()).collect()
    }

    #[test]
    fn a_revolution_comes_with_the_time_of_each_return_across_the_hour() {
        let mut receiver = PacketReceiver::new();
        let revolutions = revolutions(&mut receiver, &packets(37 + 2 * 75 + 2));
        assert_eq!((revolutions.len(), receiver.take_gap()), (2, None));
        for (index, revolution) in revolutions.iter().enumerate() {
            assert_eq!(revolution.points_m.len(), 1800 * 16);
            assert_eq!(revolution.since_end_s.len(), 1800 * 16);
            assert!(revolution.since_end_s.windows(2).all(|pair| pair[0] < pair[1] + 1e-6));
            let first_s = revolution.since_end_s[0];
            assert!((first_s + 1799.0 * 55.296e-6).abs() < 1e-5, "{first_s}");
            let expected_us = (3_599_950_000.0 + 1327.0 * (37.5 + 75.0 * (index + 1) as f64)) % HOUR_US;
            assert!((revolution.end_us - expected_us).abs() < 120.0, "{} {expected_us}", revolution.end_us);
        }
    }

    #[test]
    fn a_revolution_with_a_lost_packet_is_left_out_and_position_packets_are_passed_over() {
        let mut packets = packets(37 + 3 * 75 + 2);
        packets.remove(60);
        let mut receiver = PacketReceiver::new();
        assert_eq!(receiver.take(&[0; POSITION_BYTES]), Ok(None));
        let revolutions = revolutions(&mut receiver, &packets);
        assert_eq!(revolutions.len(), 2);
        assert_eq!(receiver.take_gap().unwrap(), "1.3 ms are missing by the sensor's time stamps");
        assert_eq!(receiver.take_gap(), None, "it is told once");
    }

    #[test]
    fn what_is_no_packet_is_named_and_the_next_revolution_is_whole() {
        let mut receiver = PacketReceiver::new();
        let packets = packets(37 + 3 * 75 + 2);
        assert!(revolutions(&mut receiver, &packets[..60]).is_empty());
        let fault = receiver.take(&[1, 2, 3]).unwrap_err().to_string();
        assert_eq!(fault, "packet 61, length = 3: expected 1206 bytes, a data packet of a Velodyne sensor");
        let fault = receiver.take(&[0; PACKET_BYTES]).unwrap_err().to_string();
        assert_eq!(fault, "packet 62, blocks with the flag 0xffee = 0: expected at least 7 of 12");
        let mut other = packets[60];
        other[PACKET_BYTES - 1] = 0x99;
        assert!(receiver.take(&other).unwrap_err().to_string().starts_with("packet 63, product = 0x99"));
        assert_eq!(revolutions(&mut receiver, &packets[60..]).len(), 2);
    }

    #[test]
    fn a_flood_of_one_azimuth_takes_no_more_memory_than_a_revolution() {
        let mut receiver = PacketReceiver::new();
        assert!(revolutions(&mut receiver, &packets(60)).is_empty());
        // A head that stands still, after the first passing.
        let still = packets(60)[59];
        let mut gaps = Vec::new();
        for _ in 0..10_000 {
            drop(receiver.take(&still));
            assert!(receiver.turns.firings() <= MOST_FIRINGS + 24);
            gaps.extend(receiver.take_gap());
        }
        assert!(!gaps.is_empty());
    }

    proptest! {
        #[test]
        fn any_payloads_give_as_many_times_as_points(
            payloads in prop::collection::vec((prop::collection::vec(any::<u8>(), 1206), 0..4_u8), 1..20),
        ) {
            let mut receiver = PacketReceiver::new();
            for (mut payload, kind) in payloads {
                if kind > 0 {
                    for block in 0..12 {
                        payload[100 * block..][..2].copy_from_slice(&[0xff, 0xee]);
                        payload[100 * block + 3] %= 140;
                    }
                    payload[1204..].copy_from_slice(&[0x36 + kind, 0x22]);
                }
                if let Ok(Some(revolution)) = receiver.take(&payload) {
                    prop_assert_eq!(revolution.points_m.len(), revolution.since_end_s.len());
                    prop_assert!(revolution.since_end_s.iter().all(|time_s| time_s.is_finite()));
                }
            }
        }
    }
}
