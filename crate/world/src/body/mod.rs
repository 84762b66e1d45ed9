//! The robot's body, and what it touches.

mod part;

use crate::attitude::world_from_body;
use crate::ground::Ground;
use crate::height_field::HeightField;
use crate::objects::Solid;
use crate::robot::RobotState;
use crate::robot_config::RobotConfig;
use glam::{DMat3, DVec2, DVec3};
use part::Part;

/// What the body does to end a drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactKind {
    /// The body runs into an object.
    Collision,
    /// The belly or a bumper is on the ground or on a low object.
    HighCentred,
    /// A wheel is against more than it climbs.
    Step,
}

/// Where the body touches what it should not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// What it does there.
    pub kind: ContactKind,
    /// World position of the contact, metres.
    pub place_m: DVec3,
    /// Index of the object, unless it is the ground.
    pub object: Option<usize>,
}

/// The shape of a robot with a sensor on a mast: a deck between the axles, an overhang with a bumper at each
/// end, four wheels and the mast.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    config: RobotConfig,
    deck: Part,
    overhangs: [Part; 2],
    wheels: [Part; 4],
    mast: Part,
}

/// Side of the mast and of the sensor on it, and what the sensor has above its centre, metres; a VLP-16 is
/// 0.103 m wide and 0.072 m high.
const MAST_SIDE_M: f64 = 0.1;
const ABOVE_SENSOR_M: f64 = 0.04;
/// The ground under the body is checked at this spacing, metres.
const SPACING_M: f64 = 0.06;
/// How far ahead of its contact a wheel meets a step, in radii.
const WHEEL_REACH: f64 = 0.9;

impl Body {
    /// The body of a robot with its sensor at `mast_top_m` in the robot frame, metres.
    #[must_use]
    pub fn new(config: &RobotConfig, mast_top_m: DVec3) -> Self {
        let between = |x: [f64; 2], y: [f64; 2], z: [f64; 2]| {
            let (low, high) = (DVec3::new(x[0], y[0], z[0]), DVec3::new(x[1], y[1], z[1]));
            Part { centre_m: (low + high) / 2.0, half_m: (high - low).max(DVec3::ZERO) / 2.0 }
        };
        let (axle_m, end_m, side_m) = (config.wheelbase_m / 2.0, config.length_m / 2.0, config.width_m / 2.0);
        let inside_m = (config.track_m - side_m).max(0.0);
        let top_m = config.height_m;
        let overhang_z = [config.overhang_clearance_m.min(top_m), top_m];
        let (radius_m, wheel_m) = (config.wheel_radius_m, side_m - config.track_m / 2.0);
        let wheel = |ahead: f64, aside: f64| {
            let (x, y) = (ahead * axle_m, aside * config.track_m / 2.0);
            let z = [config.max_step_m.min(2.0 * radius_m), 2.0 * radius_m];
            between([x - radius_m, x + radius_m], [y - wheel_m, y + wheel_m], z)
        };
        let half_mast_m = MAST_SIDE_M / 2.0;
        Self {
            config: config.clone(),
            deck: between(
                [-axle_m, axle_m],
                [-inside_m, inside_m],
                [config.ground_clearance_m.min(top_m), top_m],
            ),
            overhangs: [
                between([axle_m, end_m], [-side_m, side_m], overhang_z),
                between([-end_m, -axle_m], [-side_m, side_m], overhang_z),
            ],
            wheels: [wheel(1.0, 1.0), wheel(1.0, -1.0), wheel(-1.0, 1.0), wheel(-1.0, -1.0)],
            mast: between(
                [mast_top_m.x - half_mast_m, mast_top_m.x + half_mast_m],
                [mast_top_m.y - half_mast_m, mast_top_m.y + half_mast_m],
                [top_m.min(mast_top_m.z), top_m.max(mast_top_m.z + ABOVE_SENSOR_M)],
            ),
        }
    }

    /// Height of its highest point over the ground between its wheels, metres.
    #[must_use]
    pub fn height_m(&self) -> f64 {
        self.parts().map(|part| part.centre_m.z + part.half_m.z).fold(0.0, f64::max)
    }

    /// The same body, `beside_m` larger to all sides and `below_m` lower under deck and overhangs: for plans
    /// that keep away from things.
    #[must_use]
    pub fn with_margin(mut self, beside_m: f64, below_m: f64) -> Self {
        let beside = DVec3::new(beside_m, beside_m, 0.0);
        let [ahead, behind] = &mut self.overhangs;
        for part in [&mut self.deck, ahead, behind] {
            part.half_m.z += below_m / 2.0;
            part.centre_m.z -= below_m / 2.0;
        }
        let [ahead, behind] = &mut self.overhangs;
        for part in [&mut self.deck, &mut self.mast, ahead, behind].into_iter().chain(&mut self.wheels) {
            part.half_m += beside;
        }
        self
    }

    /// The state of a robot whose wheels are not in the ground.
    ///
    /// [`attitude_on`](crate::attitude_on) lays a plane through the middle of four contacts. On warped ground
    /// two of them are above it, and a robot without suspension rests on these: it is raised until none is
    /// above.
    #[must_use]
    pub fn on_wheels(&self, state: &RobotState, footing: &impl Ground) -> RobotState {
        let (origin_m, rotation) = placed(state);
        let raised_m = self.wheels.iter().filter_map(|wheel| {
            let below_m = origin_m + rotation * wheel.centre_m.truncate().extend(0.0);
            Some(footing.height_m(below_m.truncate())? - below_m.z)
        });
        let mut raised = *state;
        raised.attitude.height_m += raised_m.fold(0.0, f64::max);
        raised
    }

    /// Whether a solid lies clear of the body of a robot in this state.
    #[must_use]
    pub fn is_clear_of(&self, state: &RobotState, solid: &Solid) -> bool {
        let (origin_m, rotation) = placed(state);
        self.parts().all(|part| part.touches(origin_m, &rotation, solid).is_none())
    }

    /// The first solid that the body of a robot in this state touches, if any.
    #[must_use]
    pub fn contact_with(&self, solids: &[Solid], state: &RobotState) -> Option<Contact> {
        let (origin_m, rotation) = placed(state);
        for solid in solids {
            for part in self.parts() {
                let Some(place_m) = part.touches(origin_m, &rotation, solid) else { continue };
                // What is lower than the deck can be stood on or climbed; the rest is run into.
                let is_low = solid.is_grounded && solid.top_m() < origin_m.z + self.config.height_m;
                let kind = match part {
                    part if *part == self.deck && is_low => ContactKind::HighCentred,
                    part if self.wheels.contains(part) && is_low => ContactKind::Step,
                    _ => ContactKind::Collision,
                };
                return Some(Contact { kind, place_m, object: Some(solid.object) });
            }
        }
        None
    }

    /// Where the ground touches more than the wheels of a robot in this state, if anywhere: belly and bumpers
    /// with the ground itself, and wheels with a step of `footing`.
    #[must_use]
    pub fn contact_with_ground(
        &self,
        field: &HeightField,
        footing: &impl Ground,
        state: &RobotState,
    ) -> Option<Contact> {
        let (origin_m, rotation) = placed(state);
        self.underside(origin_m, &rotation, field).or_else(|| self.step(state, origin_m, &rotation, footing))
    }

    fn parts(&self) -> impl Iterator<Item = &Part> {
        self.overhangs.iter().chain(&self.wheels).chain([&self.deck, &self.mast])
    }

    /// The ground where it is higher than the underside.
    fn underside(&self, origin_m: DVec3, rotation: &DMat3, field: &HeightField) -> Option<Contact> {
        for part in [&self.deck, &self.overhangs[0], &self.overhangs[1]] {
            let corner_m = part.centre_m - part.half_m;
            let counts =
                [part.half_m.x, part.half_m.y].map(|half_m| (2.0 * half_m / SPACING_M).ceil().max(1.0));
            for i in 0..=counts[0] as usize {
                for j in 0..=counts[1] as usize {
                    let along = DVec2::new(i as f64 / counts[0], j as f64 / counts[1]);
                    let under_m = corner_m + (2.0 * part.half_m.truncate() * along).extend(0.0);
                    let under_m = origin_m + *rotation * under_m;
                    if let Some(ground_m) = field.height_m(under_m.truncate()).filter(|&z_m| z_m > under_m.z)
                    {
                        let place_m = under_m.truncate().extend(ground_m);
                        return Some(Contact { kind: ContactKind::HighCentred, place_m, object: None });
                    }
                }
            }
        }
        None
    }

    /// A rise within a wheel's radius, in the direction in which the wheel rolls, that is higher than it
    /// climbs.
    fn step(
        &self,
        state: &RobotState,
        origin_m: DVec3,
        rotation: &DMat3,
        footing: &impl Ground,
    ) -> Option<Contact> {
        let (sin, cos) = libm::sincos(state.yaw_rad);
        let ahead = DVec2::new(cos, sin) * (WHEEL_REACH * self.config.wheel_radius_m);
        self.wheels.iter().find_map(|wheel| {
            let rolls_m_s = state.speed_m_s - state.turn_rate_rad_s * wheel.centre_m.y;
            if rolls_m_s == 0.0 {
                return None;
            }
            let below_m = origin_m + *rotation * wheel.centre_m.truncate().extend(0.0);
            let before_m = below_m.truncate() + ahead * rolls_m_s.signum();
            let (here_m, there_m) = (footing.height_m(below_m.truncate())?, footing.height_m(before_m)?);
            let is_step = there_m - here_m > self.config.max_step_m;
            is_step.then_some(Contact {
                kind: ContactKind::Step,
                place_m: before_m.extend(there_m),
                object: None,
            })
        })
    }
}

fn placed(state: &RobotState) -> (DVec3, DMat3) {
    (state.position.extend(state.attitude.height_m), world_from_body(state.yaw_rad, &state.attitude))
}

#[cfg(test)]
mod tests;
