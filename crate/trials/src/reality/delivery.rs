//! Scans on their way to the planner: some are lost, all may be late.

use std::collections::VecDeque;

use mapless::Pose;
use mapless_world::{Scan, SensingConfig, random};

/// A scan on its way.
#[derive(Clone, Debug)]
struct Sent {
    tick: u64,
    scan: Scan,
    /// What the odometry said when it was taken.
    odometry: Pose,
}

/// Delivers scans.
#[derive(Clone, Debug)]
pub(crate) struct Delivery {
    lost_probability: f64,
    delay_ticks: u64,
    seed: u64,
    under_way: VecDeque<Sent>,
}

impl Delivery {
    /// For a trial with this seed.
    pub(crate) fn new(config: &SensingConfig, seed: u64) -> Self {
        Self {
            lost_probability: config.lost_scan_probability,
            delay_ticks: config.scan_delay_periods as u64,
            // The localisation has another.
            seed: random::key(seed, u64::MAX - 1),
            under_way: VecDeque::new(),
        }
    }

    /// Whether every scan arrives at once.
    pub(crate) fn is_ideal(&self) -> bool {
        self.lost_probability <= 0.0 && self.delay_ticks == 0
    }

    /// Takes the scan of `tick` and gives the one that arrives then, with its tick and odometry. Whoever
    /// looks twice in a tick replaces the scan.
    pub(crate) fn send(&mut self, tick: u64, scan: Scan, odometry: Pose) -> Option<(u64, Scan, Pose)> {
        if self.delay_ticks == 0 {
            return (!self.is_lost(tick)).then_some((tick, scan, odometry));
        }
        // Those that have arrived stay until the next tick.
        let oldest = tick.saturating_sub(self.delay_ticks);
        self.under_way.retain(|sent| sent.tick >= oldest && sent.tick != tick);
        if !self.is_lost(tick) {
            self.under_way.push_back(Sent { tick, scan, odometry });
        }
        let arrived = self.under_way.iter().find(|sent| sent.tick + self.delay_ticks == tick)?;
        Some((arrived.tick, arrived.scan.clone(), arrived.odometry))
    }

    fn is_lost(&self, tick: u64) -> bool {
        self.lost_probability > 0.0 && random::uniform(random::key(self.seed, tick)) <= self.lost_probability
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec3};

    fn arrivals(config: &SensingConfig, ticks: u64) -> Vec<Option<u64>> {
        let mut delivery = Delivery::new(config, 5);
        let arrives = |tick: u64| {
            let scan = Scan { points: vec![Vec3::X * tick as f32], ..Scan::default() };
            let pose = Pose::from_roll_pitch_yaw(DVec3::X * tick as f64, 0.0, 0.0, 0.0);
            // The second look is the one that counts.
            delivery.send(tick, Scan::default(), pose);
            let (sent, scan, pose) = delivery.send(tick, scan, pose)?;
            assert_eq!((scan.points[0].x, pose.position_m.x), (sent as f32, sent as f64));
            Some(sent)
        };
        (0..ticks).map(arrives).collect()
    }

    #[test]
    fn a_late_scan_comes_so_many_periods_later() {
        let late = SensingConfig { scan_delay_periods: 2, ..SensingConfig::default() };
        assert_eq!(arrivals(&late, 5), [None, None, Some(0), Some(1), Some(2)]);
        assert_eq!(arrivals(&SensingConfig::default(), 2), [Some(0), Some(1)]);
    }

    #[test]
    fn lost_scans_are_their_share() {
        let lossy = SensingConfig { lost_scan_probability: 0.2, ..SensingConfig::default() };
        let lost = arrivals(&lossy, 2000).iter().filter(|arrived| arrived.is_none()).count();
        assert!((340..460).contains(&lost), "{lost}");
    }
}
