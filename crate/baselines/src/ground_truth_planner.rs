//! The mapless planner with ground truth in place of perception, to tell where a failure comes from.

use core::time::Duration;
use core::{array, fmt};
use std::str::FromStr;

use glam::{DVec2, Vec3};
use mapless::decision::PerceptionOverride;
use mapless::skyline::profile::Column;
use mapless::terrain::plane::Plane;
use mapless::{ConfigError, Goal, Planner, PlannerConfig, Pose};
use mapless_trials::{Decision, Navigator};
use mapless_world::{Caster, HeightField, SensorPose, Skyline, true_skyline};

use crate::unknown_name::UnknownName;

/// The ground truth that replaces perception.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "snake_case")]
pub enum Truth {
    /// None: the unchanged planner.
    #[default]
    None,
    /// The elevation profile, in place of the Gaussian process's.
    Profile,
    /// The ground, in place of the elevation window.
    Ground,
    /// Both.
    Both,
}

impl Truth {
    const ALL: [Self; 4] = [Self::None, Self::Profile, Self::Ground, Self::Both];
    /// Every name.
    pub const NAMES: [&str; 4] = ["none", "profile", "ground", "both"];

    /// The name in files and tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }

    fn of_profile(self) -> bool {
        matches!(self, Self::Profile | Self::Both)
    }

    fn of_ground(self) -> bool {
        matches!(self, Self::Ground | Self::Both)
    }
}

impl FromStr for Truth {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, UnknownName> {
        let named = Self::ALL.into_iter().zip(Self::NAMES).find(|(_, known)| *known == name);
        named.map(|(truth, _)| truth).ok_or_else(|| UnknownName::new("truth", name, &Self::NAMES))
    }
}

impl fmt::Display for Truth {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Radius of the footprint around a place, and spacing of the samples in it.
const FOOTPRINT_RADIUS_M: f64 = 0.5;
const SAMPLE_M: f64 = 0.2;
/// Samples on a side of the square around a footprint.
const SIDE: usize = 5;

/// The planner with ground truth in place of perception; see [`Truth`].
#[derive(Clone, Debug)]
pub struct GroundTruthPlanner {
    planner: Planner,
    truth: Truth,
    caster: Caster,
}

impl GroundTruthPlanner {
    /// A planner on a known ground.
    ///
    /// # Errors
    /// [`ConfigError`] for a value that makes no sense.
    pub fn new(config: PlannerConfig, truth: Truth, field: HeightField) -> Result<Self, ConfigError> {
        Ok(Self { planner: Planner::new(config)?, truth, caster: Caster::new(field) })
    }

    /// The planner, with the result of its last step.
    #[must_use]
    pub fn planner(&self) -> &Planner {
        &self.planner
    }
}

/// The true plane around a place, by the least squares of the elevation window over the same footprint;
/// `None` near the border.
fn true_plane(field: &HeightField, place_m: DVec2) -> Option<Plane> {
    let offsets: [DVec2; SIDE * SIDE] = array::from_fn(|index| {
        let middle = (SIDE / 2) as f64;
        DVec2::new((index % SIDE) as f64 - middle, (index / SIDE) as f64 - middle) * SAMPLE_M
    });
    let mut points_m = [place_m.extend(0.0); SIDE * SIDE];
    let mut count = 0;
    for offset in offsets.into_iter().filter(|offset| offset.length() <= FOOTPRINT_RADIUS_M) {
        points_m[count] = (place_m + offset).extend(field.height_m(place_m + offset)?);
        count += 1;
    }
    Plane::fit(place_m, &points_m[..count], FOOTPRINT_RADIUS_M)
}

impl Navigator for GroundTruthPlanner {
    fn navigate(&mut self, points_m: &[Vec3], pose: &Pose, goal: &Goal, elapsed: Duration) -> Decision {
        let Self { planner, truth, caster } = self;
        let caster = &*caster;
        let config = planner.config();
        let radius_m = config.perception.surface_radius_m;
        let world_from_sensor = pose.world_from_robot();
        let position = pose.position_m + world_from_sensor * config.sensor.offset_m();
        let between_rad = [config.sensor.lowest_elevation_rad, config.sensor.highest_elevation_rad];
        let sensor = SensorPose { position, world_from_sensor };
        let profile = |azimuth_rad| match true_skyline(caster, &sensor, radius_m, azimuth_rad, between_rad) {
            Skyline::Unknown => Column::Unknown,
            Skyline::Ground { elevation_rad } => Column::Ground { elevation_rad },
            Skyline::Wall => Column::Wall,
        };
        let ground = |place_m| true_plane(caster.field(), place_m);
        let overrides = PerceptionOverride {
            profile: truth.of_profile().then_some(&profile),
            terrain: truth.of_ground().then_some(&ground),
        };
        planner.set_goal(*goal);
        let step = planner.step_with(points_m, pose, elapsed, overrides);
        Decision { activity: step.status.into(), command: step.command }
    }

    fn sight_m(&self) -> f64 {
        self.planner.sight_m()
    }

    fn max_speed_m_s(&self) -> f64 {
        self.planner.max_speed_m_s()
    }

    fn reset(&mut self) {
        Planner::reset(&mut self.planner);
    }

    fn relocalise(&mut self, before: &Pose, after: &Pose) {
        self.planner.relocalise(before, after);
    }

    fn subgoal_m(&self) -> Option<DVec2> {
        self.planner.subgoal_m()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{field, undulating};
    use core::f64::consts::PI;
    use glam::DVec3;
    use mapless::skyline::columns::column_azimuth_rad;
    use mapless_world::{SensorConfig, attitude_on};

    const PERIOD: Duration = Duration::from_millis(100);

    fn pose_on(field: &HeightField, place: DVec2, yaw_rad: f64) -> Pose {
        let attitude = attitude_on(field, place, yaw_rad, &Default::default()).unwrap();
        Pose::from_roll_pitch_yaw(
            place.extend(attitude.height_m),
            attitude.roll_rad,
            attitude.pitch_rad,
            yaw_rad,
        )
    }

    #[test]
    fn the_profile_is_the_true_skyline() {
        let field = field(30.0, |place| 4.0 * undulating(place));
        let (place, yaw_rad) = (DVec2::new(14.0, 16.0), 0.7);
        let pose = pose_on(&field, place, yaw_rad);
        let mut navigator =
            GroundTruthPlanner::new(PlannerConfig::default(), Truth::Profile, field.clone()).unwrap();
        navigator.navigate(&[Vec3::new(3.0, 0.0, -0.8)], &pose, &Goal::at(DVec2::new(29.0, 29.0)), PERIOD);

        let attitude = attitude_on(&field, place, yaw_rad, &Default::default()).unwrap();
        let sensor = SensorConfig::default().pose_on(place, yaw_rad, &attitude);
        let caster = Caster::new(field);
        let profile = navigator.planner().last_step().profile;
        let mut kinds = [0; 3];
        for (column, perceived) in profile.iter().enumerate() {
            match (
                perceived,
                true_skyline(&caster, &sensor, 7.0, column_azimuth_rad(column), [-PI / 12.0, PI / 12.0]),
            ) {
                (Column::Ground { elevation_rad: perceived }, Skyline::Ground { elevation_rad }) => {
                    assert!((perceived - elevation_rad).abs() < 1e-5, "column {column}");
                    kinds[0] += 1;
                }
                (Column::Unknown, Skyline::Unknown) => kinds[1] += 1,
                (Column::Wall, Skyline::Wall) => kinds[2] += 1,
                (perceived, truth) => panic!("column {column}: {perceived:?} is {truth:?}"),
            }
        }
        assert!(kinds[0] > 100 && kinds[1] > 100, "{kinds:?}");
    }

    #[test]
    fn the_ground_is_the_true_plane_also_where_nothing_was_seen() {
        let ground = |place: DVec2| 0.2 * place.x - 0.1 * place.y;
        let field = field(30.0, ground);
        let place = DVec2::new(12.3, 7.7);
        let plane = true_plane(&field, place).unwrap();
        assert!((plane.gradient - DVec2::new(0.2, -0.1)).length() < 1e-5);
        assert!((plane.height_m - ground(place)).abs() < 1e-5);
        assert_eq!(true_plane(&field, DVec2::new(0.1, 5.0)), None);

        // One return is too little for a forecast of any subgoal, unless the ground is overridden.
        let pose = pose_on(&field, DVec2::splat(15.0), 0.0);
        let reach_m = |truth| {
            let mut navigator =
                GroundTruthPlanner::new(PlannerConfig::default(), truth, field.clone()).unwrap();
            navigator.navigate(
                &[Vec3::new(3.0, 0.0, -0.8)],
                &pose,
                &Goal::at(DVec2::new(29.0, 15.0)),
                PERIOD,
            );
            let subgoals = navigator.planner().last_step().subgoals;
            subgoals.iter().filter_map(|subgoal| subgoal.forecast).map(|f| f.reach_m).fold(0.0, f64::max)
        };
        assert!(reach_m(Truth::Both) > 6.9);
        assert!(reach_m(Truth::Profile) < 1.0);
    }

    #[test]
    fn without_truth_it_is_the_planner() {
        let field = field(20.0, |_| 0.0);
        let pose = Pose::from_roll_pitch_yaw(DVec3::new(10.0, 10.0, 0.0), 0.0, 0.0, 0.0);
        let scan: Vec<Vec3> = (0..360)
            .flat_map(|degree| [3.0, 4.0, 5.0, 6.0].map(|range| (f64::from(degree).to_radians(), range)))
            .map(|(azimuth, range)| {
                let (sin, cos) = libm::sincos(azimuth);
                DVec3::new(range * cos, range * sin, -0.8).as_vec3()
            })
            .collect();
        let goal = Goal::at(DVec2::new(19.0, 14.0));
        let mut planner = Planner::new(PlannerConfig::default()).unwrap();
        let mut navigator = GroundTruthPlanner::new(PlannerConfig::default(), Truth::None, field).unwrap();
        let expected = planner.navigate(&scan, &pose, &goal, PERIOD);
        assert_eq!(navigator.navigate(&scan, &pose, &goal, PERIOD), expected);
        assert_eq!(navigator.subgoal_m(), planner.subgoal_m());
        assert!(planner.subgoal_m().is_some());
    }
}
