//! A trial that goes on with other equipment.

use mapless_world::{Footing, Robot, RobotState};

use super::{Trial, TrialError};
use crate::navigator::Navigator;

impl<N: Navigator> Trial<N> {
    /// Goes on where it is as `other` is equipped: with its sensor, its robot, what goes wrong for it, and
    /// its navigator with all that this remembers. Ground, objects, route, seed, time, metrics and digest
    /// stay.
    ///
    /// # Errors
    /// [`TrialError`] for another period of the scans, in which time is counted, and for a robot that has no
    /// ground under a wheel here; nothing then changes.
    pub fn equip(&mut self, other: Self) -> Result<(), TrialError> {
        let (ours_s, theirs_s) = (self.period_s(), other.period_s());
        if theirs_s.to_bits() != ours_s.to_bits() {
            return Err(TrialError::Config(format!(
                "sensor.period_s = {theirs_s}: expected {ours_s} under way, in which the run counts its time"
            )));
        }
        let same_robot = other.husky.config() == self.husky.config();
        if !(same_robot && other.husky.motion() == self.husky.motion()) {
            let footing = Footing { field: self.caster.field(), solids: self.objects.solids() };
            let here = *self.husky.state();
            let off_terrain = |_| TrialError::OffTerrain {
                what: "robot",
                place_m: here.position,
                extent_m: self.caster.field().extent_m(),
            };
            let (config, motion) = (other.husky.config().clone(), other.husky.motion().clone());
            let mut robot = Robot::new(config, &footing, here.position, here.yaw_rad)
                .map_err(off_terrain)?
                .with_motion(motion);
            let state = RobotState { attitude: robot.state().attitude, ..here };
            robot.move_to(state, self.husky.wheels(), &footing).map_err(off_terrain)?;
            self.husky = robot;
        }
        self.sensor = other.sensor;
        self.body = other.body;
        self.navigator = other.navigator;
        if !(same_robot && self.reality.is_like(&other.reality)) {
            self.reality = other.reality;
            self.reality.restart(self.seed, &self.husky);
        }
        Ok(())
    }
}
