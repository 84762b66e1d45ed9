//! Negative obstacles: ground that should have been seen and was not.
//!
//! A cliff shows in a scan only as missing returns, and a plane through the ground before it continues over
//! it. But ground that went on would have been seen while the robot came nearer.

use core::f64::consts::TAU;
use core::time::Duration;

use glam::{DMat3, DVec2, DVec3};

use super::ElevationWindow;
use crate::pose::FrameChange;
use crate::sensor_model::SensorModel;
use crate::terrain::plane::Plane;

/// Distance between kept views, as a multiple of the sensor's height, and their number: near the robot, where
/// ground goes out of sight, the rings of a VLP-16 are twice that apart.
const SPACING_HEIGHTS: f64 = 0.3125;
pub(super) const MOST_VIEWS: usize = 256;
/// A ring has swept over a place that was in this many views.
const FEWEST_VIEWS: usize = 3;
/// Ground is surely in view up to this distance, as a multiple of the sensor's height, this far inside the
/// field of view, and at no smaller angle of incidence than this.
const SURELY_SEEN_HEIGHTS: f64 = 5.625;
const INSIDE_RAD: f64 = 0.02;
const LEAST_INCIDENCE: f64 = 0.1;
/// Ground that rises by this slope hides the ground behind it, even a ramp's level end.
const RISING_SLOPE: f64 = 0.1;

/// Within this distance of the robot, as a multiple of the sensor's height, ground in view was seen under all
/// wheels, or does not exist.
const BY_NOW_SEEN_HEIGHTS: f64 = 2.5;

/// Points tested to each side of a place, their spacing, and the share of them without returns that makes a
/// hole. A small rise hides fewer.
const HOLE_LOOKS: i32 = 3;
const HOLE_LOOK_M: f64 = 0.1;
const HOLE_SHARE: f64 = 0.5;

/// Returns within this distance of a place show a drop if one lies this much lower than another and the line
/// through both has this slope. At 1.15 a robot exceeds a limit with every heading: its square is tan² 45° +
/// tan² 30°.
pub(super) const DROP_RADIUS_M: f64 = 0.7;
const LEAST_DROP_M: f64 = 0.3;
const DROP_SLOPE: f64 = 1.2;

/// The pose of the sensor at a scan.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    taken: Duration,
    sensor_m: DVec3,
    world_from_sensor: DMat3,
}

impl ElevationWindow {
    /// Records the sensor's pose at a scan.
    pub(crate) fn looked_from(&mut self, sensor_m: DVec3, world_from_sensor: DMat3) {
        let spacing_m = SPACING_HEIGHTS * self.sensor.height_m;
        let (now, memory) = (self.now, self.memory);
        self.views.retain(|view| now - view.taken <= memory);
        if self.views.iter().any(|view| (view.sensor_m - sensor_m).length() < spacing_m) {
            return;
        }
        if self.views.len() == MOST_VIEWS {
            self.views.pop_front();
        }
        self.views.push_back(View { taken: now, sensor_m, world_from_sensor });
    }

    /// Whether ground at a place near the robot, continued from the robot's side, would have been seen.
    pub(super) fn would_be_seen(&self, place_m: DVec2, here_m: DVec2) -> bool {
        let before = |from_place: DVec2| from_place.dot(here_m - place_m) > 0.0;
        let plane = || {
            self.footprint_radii_m()
                .into_iter()
                .find_map(|radius_m| self.moments_near(place_m, radius_m, before).plane(self.footprint_m))
        };
        (place_m - here_m).length() < BY_NOW_SEEN_HEIGHTS * self.sensor.height_m
            && plane().is_some_and(|plane| self.was_in_view(place_m, &plane))
    }

    /// Whether most of the ground at a place or beside it has no returns.
    pub(super) fn lacks_returns_beside(&self, place_m: DVec2) -> bool {
        // Possible places of its wheels.
        let sides = [-self.footprint_m, 0.0, self.footprint_m];
        sides.into_iter().any(|y| sides.into_iter().any(|x| self.lacks_returns(place_m + DVec2::new(x, y))))
    }

    /// Whether most of the ground around a place has no returns.
    fn lacks_returns(&self, place_m: DVec2) -> bool {
        let looks = (-HOLE_LOOKS..=HOLE_LOOKS)
            .flat_map(|y| (-HOLE_LOOKS..=HOLE_LOOKS).map(move |x| DVec2::new(f64::from(x), f64::from(y))));
        let (mut unseen, mut count) = (0, 0);
        for look in looks {
            count += 1;
            unseen += u32::from(self.height_m(place_m + look * HOLE_LOOK_M, DVec2::ZERO).is_none());
        }
        f64::from(unseen) >= HOLE_SHARE * f64::from(count)
    }

    /// Whether the ground around a place drops along the unit vector `away`: between two returns it is
    /// somewhere as steep as the line through both.
    pub(super) fn has_drop(&self, place_m: DVec2, away: DVec2) -> bool {
        let near = || self.cells_near(place_m, DROP_RADIUS_M).map(|cell| cell.mean_m);
        let lowest_m = near().map(|mean_m| mean_m.z).fold(f64::INFINITY, f64::min);
        near().filter(|high_m| high_m.z - lowest_m > LEAST_DROP_M).any(|high_m| {
            near().map(|low_m| high_m - low_m).any(|drop_m| {
                let across_m = drop_m.truncate();
                drop_m.z > LEAST_DROP_M
                    && drop_m.z > DROP_SLOPE * across_m.length()
                    && across_m.dot(away) < 0.0
            })
        })
    }

    /// Whether ground with this plane at a place was in view before it was too near.
    fn was_in_view(&self, place_m: DVec2, plane: &Plane) -> bool {
        let point_m = place_m.extend(plane.height_m);
        self.views.iter().filter(|view| view.holds(point_m, plane, &self.sensor)).count() >= FEWEST_VIEWS
    }
}

impl View {
    pub(super) fn relocalise(&mut self, change: &FrameChange) {
        self.sensor_m = change.point_m(self.sensor_m);
        self.world_from_sensor = change.rotation(&self.world_from_sensor);
    }

    fn holds(&self, point_m: DVec3, plane: &Plane, sensor: &SensorModel) -> bool {
        let away = point_m - self.sensor_m;
        let distance_m = away.length();
        let beam = away / distance_m;
        let normal = (-plane.gradient).extend(1.0).normalize();
        let rises = plane.gradient.dot(beam.truncate().normalize_or_zero()) > RISING_SLOPE;
        let [ahead, left, up] = self.world_from_sensor.to_cols_array_2d().map(DVec3::from_array);
        distance_m < SURELY_SEEN_HEIGHTS * sensor.height_m
            && beam.dot(up) > libm::sin(sensor.lowest_elevation_rad + INSIDE_RAD)
            && (sees_over_its_horizon(sensor)
                || beam.dot(up) < libm::sin(sensor.highest_elevation_rad - INSIDE_RAD))
            && (sensor.horizontal_fov_rad >= TAU
                || libm::atan2(beam.dot(left), beam.dot(ahead)).abs()
                    < 0.5 * sensor.horizontal_fov_rad - INSIDE_RAD)
            && -beam.dot(normal) > LEAST_INCIDENCE
            && !rises
    }
}

/// Whether all ground near the robot is below the highest ring, except for rises.
fn sees_over_its_horizon(sensor: &SensorModel) -> bool {
    sensor.roll_rad == 0.0 && sensor.pitch_rad == 0.0 && sensor.highest_elevation_rad > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::PlannerConfig;
    use crate::testing::{STEP, strewn};

    const AHEAD_M: DVec2 = DVec2::new(2.0, 0.0);

    /// The window of a robot that has driven to the origin from `from_m`, nose up by `pitch_rad`.
    fn come_from(from_m: DVec2, pitch_rad: f64) -> ElevationWindow {
        let mut ground = ElevationWindow::new(&PlannerConfig::default());
        look_on_the_way(&mut ground, from_m, pitch_rad);
        ground
    }

    fn look_on_the_way(ground: &mut ElevationWindow, from_m: DVec2, pitch_rad: f64) {
        let sensor = ground.sensor;
        for step in 0..=60 {
            ground.advance(STEP);
            let at_m = (from_m * (1.0 - f64::from(step) / 60.0)).extend(sensor.height_m);
            ground.looked_from(at_m, DMat3::from_rotation_y(-pitch_rad - sensor.pitch_rad));
        }
    }

    /// As [`come_from`] on a robot with this sensor.
    fn come_with(sensor: SensorModel, from_m: DVec2) -> ElevationWindow {
        let mut ground = ElevationWindow::new(&PlannerConfig { sensor, ..PlannerConfig::default() });
        look_on_the_way(&mut ground, from_m, 0.0);
        ground
    }

    fn strewn_but(is_hidden: impl Fn(DVec2) -> bool) -> ElevationWindow {
        strewn(|place| (!is_hidden(place)).then_some(0.0))
    }

    #[test]
    fn beyond_an_edge_and_in_a_trench_no_return_comes_from_most_of_the_ground() {
        let edge = strewn_but(|place| place.x > 0.3);
        assert!(!edge.lacks_returns(DVec2::ZERO) && edge.lacks_returns(DVec2::new(0.5, 0.0)));
        let trench = strewn_but(|place| place.x.abs() < 0.5);
        assert!(trench.lacks_returns(DVec2::ZERO) && trench.lacks_returns(DVec2::new(-0.25, 0.0)));
    }

    #[test]
    fn what_a_small_rise_hides_is_no_hole() {
        let behind_rises = strewn_but(|place| (place.x - 0.1).abs() < 0.25);
        assert!(!behind_rises.lacks_returns(DVec2::ZERO));
        let far_apart = strewn_but(|place| place.x.rem_euclid(0.5) > 0.1);
        assert!(!far_apart.lacks_returns(DVec2::ZERO), "rings half a metre apart");
    }

    #[test]
    fn a_ledge_drops_off_for_who_stands_above_and_a_hill_does_not() {
        let ledge = strewn(|place| (place.x.abs() > 0.3).then_some(if place.x < 0.0 { 0.0 } else { -1.0 }));
        assert!(ledge.has_drop(DVec2::ZERO, DVec2::X));
        assert!(!ledge.has_drop(DVec2::ZERO, -DVec2::X), "seen from its foot");
        assert!(!ledge.has_drop(DVec2::new(-1.2, 0.0), DVec2::X), "well before it");
        assert!(!strewn(|place| Some(-place.x)).has_drop(DVec2::ZERO, DVec2::X), "45°");
    }

    #[test]
    fn ground_that_went_on_before_a_ledge_would_be_seen_though_its_foot_was() {
        let mut ground = strewn(|place| {
            (!(-0.1..0.6).contains(&place.x)).then_some(if place.x < 0.0 { 0.0 } else { -1.0 })
        });
        for step in 0..=10 {
            ground.looked_from(DVec3::new(-4.0 + 0.25 * f64::from(step), 0.0, 0.8), DMat3::IDENTITY);
        }
        assert!(ground.would_be_seen(DVec2::ZERO, DVec2::new(-1.5, 0.0)));
        assert!(!ground.would_be_seen(DVec2::ZERO, DVec2::new(1.5, 0.0)), "its foot ends there");
    }

    fn sloping(slope: f64) -> Plane {
        Plane { height_m: 0.0, gradient: DVec2::new(slope, 0.0), gradient_deviation: 0.0 }
    }

    #[test]
    fn level_ground_was_seen_from_where_the_robot_came() {
        assert!(come_from(DVec2::new(-3.0, 0.0), 0.0).was_in_view(AHEAD_M, &sloping(0.0)));
    }

    #[test]
    fn no_beam_met_what_was_always_too_near_or_below_the_lowest_one() {
        assert!(!come_from(DVec2::new(-0.8, 0.0), 0.0).was_in_view(AHEAD_M, &sloping(0.0)));
        assert!(!come_from(DVec2::new(-3.0, 0.0), 0.3).was_in_view(AHEAD_M, &sloping(0.0)), "nose up");
    }

    #[test]
    fn slopes_that_fall_away_or_hide_what_follows_say_nothing() {
        let ground = come_from(DVec2::new(-3.0, 0.0), 0.0);
        assert!(ground.was_in_view(AHEAD_M, &sloping(-0.05)));
        assert!(!ground.was_in_view(AHEAD_M, &sloping(-0.3)));
        assert!(!ground.was_in_view(AHEAD_M, &sloping(0.3)));
    }

    #[test]
    fn views_are_forgotten_with_the_ground_seen_from_them() {
        let mut ground = come_from(DVec2::new(-3.0, 0.0), 0.0);
        for _ in 0..=3000 {
            ground.advance(STEP);
            ground.looked_from(DVec3::new(0.0, 0.0, 0.8), DMat3::IDENTITY);
        }
        assert!(!ground.was_in_view(AHEAD_M, &sloping(0.0)));
    }

    #[test]
    fn what_is_in_view_follows_height_tilt_and_field_of_view() {
        let from_m = DVec2::new(-3.0, 0.0);
        let sees = |sensor, place_m| come_with(sensor, from_m).was_in_view(place_m, &sloping(0.0));
        let vlp16 = SensorModel::vlp16();
        // Too far for a low sensor, too near for a high one.
        let (low, high) = (SensorModel { height_m: 0.4, ..vlp16 }, SensorModel { height_m: 1.7, ..vlp16 });
        assert!(sees(vlp16, DVec2::new(2.0, 0.0)) && sees(low, DVec2::new(0.5, 0.0)));
        assert!(!sees(low, DVec2::new(2.4, 0.0)) && !sees(high, DVec2::new(2.0, 0.0)));
        assert!(sees(high, DVec2::new(6.0, 0.0)));
        let nose_down = SensorModel { pitch_rad: -0.26, ..vlp16 };
        assert!(sees(nose_down, DVec2::new(1.2, 0.0)) && !sees(vlp16, DVec2::new(0.4, 0.0)));
        assert!(!sees(nose_down, DVec2::new(-7.0, 0.0)) && sees(vlp16, DVec2::new(-6.5, 0.0)));
        let ahead = SensorModel { horizontal_fov_rad: 2.0, ..vlp16 };
        assert!(sees(ahead, DVec2::new(2.0, 0.0)) && !sees(ahead, DVec2::new(-6.5, 0.0)));
    }

    #[test]
    fn distances_of_a_vlp16_on_a_husky_have_their_bits() {
        let height_m = SensorModel::vlp16().height_m;
        for (heights, metres) in
            [(SPACING_HEIGHTS, 0.25), (SURELY_SEEN_HEIGHTS, 4.5), (BY_NOW_SEEN_HEIGHTS, 2.0_f64)]
        {
            assert_eq!((heights * height_m).to_bits(), metres.to_bits());
        }
        let radii_m = ElevationWindow::new(&PlannerConfig::default()).footprint_radii_m();
        assert_eq!(radii_m.map(f64::to_bits), [0.5, 0.8, 1.2_f64].map(f64::to_bits));
    }
}
