//! Benchmarks of scans, and of the planner's step on them.

use core::time::Duration;

use glam::{DVec2, DVec3, Vec3};
use mapless::Pose;
use mapless::{Goal, Planner, PlannerConfig, Status};
use mapless_world::{
    Caster, HeightField, Lidar, Objects, Scan, Scene, SensorConfig, SensorPose, Shape, Solid,
};

use crate::BenchError;
use crate::data::{directions, full_scan, level_field, level_scan, objects, rugged_field, sensor_pose};
use crate::work::{Values, Work};

/// What single precision and triangles in place of round shapes may change, metres.
const PRECISION_M: f64 = 1e-3;

/// A solid larger by `growth_m` on every side.
fn grown(solid: &Solid, growth_m: f64) -> Solid {
    let shape = match solid.shape {
        Shape::Cuboid { half_m, sin_cos_yaw } => Shape::Cuboid { half_m: half_m + growth_m, sin_cos_yaw },
        Shape::Cylinder { radius_m, half_height_m } => {
            Shape::Cylinder { radius_m: radius_m + growth_m, half_height_m: half_height_m + growth_m }
        }
        Shape::Ball { radius_m } => Shape::Ball { radius_m: radius_m + growth_m },
    };
    Solid { shape, ..*solid }
}

/// The sensor without noise, with this many columns.
fn exact_sensor(columns: usize) -> Result<Lidar, BenchError> {
    Ok(Lidar::new(SensorConfig { columns, range_noise_m: 0.0, ..SensorConfig::default() })?)
}

/// One revolution of 28 800 beams.
pub(crate) struct Scanning {
    caster: Caster,
    objects: Objects,
    sensor: Lidar,
    pose: SensorPose,
    sight_m: f64,
    scan: Scan,
}

impl Scanning {
    fn over(field: HeightField) -> Result<Self, BenchError> {
        let caster = Caster::new(field);
        let pose = sensor_pose(&caster);
        Ok(Self {
            caster,
            objects: Objects::default(),
            sensor: exact_sensor(1800)?,
            pose,
            sight_m: f64::INFINITY,
            scan: Scan::default(),
        })
    }

    /// On hills of `samples` × `samples` heights.
    pub(crate) fn rugged(samples: usize) -> Result<Self, BenchError> {
        Self::over(rugged_field(samples)?)
    }

    /// On level ground of `samples` × `samples` heights.
    pub(crate) fn level(samples: usize) -> Result<Self, BenchError> {
        Self::over(level_field(samples)?)
    }

    /// With a hundred objects.
    pub(crate) fn among_objects(mut self) -> Self {
        self.objects = objects(&self.caster);
        self
    }

    /// Only as far as the planner looks, as in a trial.
    pub(crate) fn within_sight(mut self) -> Result<Self, BenchError> {
        self.sight_m = Planner::new(PlannerConfig::default())?.sight_m();
        Ok(self)
    }

    /// Ranges to the bare ground as seen from `rise_m` higher, or to the solids larger by `growth_m` on every
    /// side, whichever is nearer.
    fn ranges_m(&self, rise_m: f64, growth_m: f64) -> Vec<f64> {
        let pose = SensorPose { position: self.pose.position + DVec3::Z * rise_m, ..self.pose };
        let mut scan = Scan::default();
        self.sensor.scan(&self.caster, &pose, 0, 0, &mut scan);
        let solids: Vec<Solid> = self.objects.solids().iter().map(|solid| grown(solid, growth_m)).collect();
        let config = self.sensor.config();
        let directions = directions(config);
        let nearer = |(ground_m, direction): (f32, DVec3)| {
            let hit = |solid: &Solid| solid.cast(self.pose.position, direction, config.max_range_m);
            solids.iter().filter_map(hit).fold(f64::from(ground_m), f64::min)
        };
        scan.ranges_m.into_iter().zip(directions).map(nearer).collect()
    }

    /// The largest height difference between a cell's bilinear patch and two triangles on the same corners: a
    /// quarter of its twist.
    fn triangle_difference_m(&self) -> f64 {
        let field = self.caster.field();
        let rows: Vec<&[f32]> = field.heights_m().chunks_exact(field.columns()).collect();
        let mut most = 0.0_f64;
        for pair in rows.windows(2) {
            for (south, north) in pair[0].windows(2).zip(pair[1].windows(2)) {
                let twist =
                    f64::from(south[0]) - f64::from(south[1]) - f64::from(north[0]) + f64::from(north[1]);
                most = most.max(0.25 * twist.abs());
            }
        }
        most
    }
}

impl Work for Scanning {
    fn run(&mut self) -> Result<(), BenchError> {
        let scene = Scene { caster: &self.caster, solids: self.objects.solids() };
        self.sensor.scan_within(self.sight_m, &scene, &self.pose, 0, 0, &mut self.scan);
        Ok(())
    }

    /// The ranges, and bounds on them for triangulated ground: the ranges from a sensor lower and higher by
    /// the largest height difference, with a millimetre for single precision; and to solids a millimetre
    /// larger and smaller, for round ones made of triangles.
    fn values(&mut self) -> Values {
        let slack_m = self.triangle_difference_m() + PRECISION_M;
        Values::from([
            ("range_m", self.scan.ranges_m.iter().copied().map(f64::from).collect()),
            ("nearest_m", self.ranges_m(-slack_m, PRECISION_M)),
            ("farthest_m", self.ranges_m(slack_m, -PRECISION_M)),
        ])
    }
}

/// A planner's step on one scan, over and over.
pub(crate) struct Tick {
    planner: Planner,
    points_m: Vec<Vec3>,
    pose: Pose,
}

impl Tick {
    fn new(points_m: Vec<Vec3>, position_m: DVec3) -> Result<Self, BenchError> {
        let pose = Pose::from_roll_pitch_yaw(position_m, 0.0, 0.0, 0.0);
        let goal_m = position_m.truncate() + DVec2::new(50.0, 0.0);
        let mut planner = Planner::new(PlannerConfig::default())?;
        planner.set_goal(Goal::at(goal_m));
        Ok(Self { planner, points_m, pose })
    }

    /// On level ground with 1823 occupied cells.
    pub(crate) fn on_level_scan() -> Result<Self, BenchError> {
        Self::new(level_scan(), DVec3::ZERO)
    }

    /// Inside a round wall, with all 28 800 beams within 7 m and all 5760 cells occupied.
    pub(crate) fn on_full_scan() -> Result<Self, BenchError> {
        Self::new(full_scan(), DVec3::ZERO)
    }

    /// On a scan of hills with this many columns.
    pub(crate) fn on_rugged_ground(columns: usize) -> Result<Self, BenchError> {
        let caster = Caster::new(rugged_field(1000)?);
        let mut scan = Scan::default();
        let pose = sensor_pose(&caster);
        let sensor = exact_sensor(columns)?;
        sensor.scan(&caster, &pose, 0, 0, &mut scan);
        Self::new(scan.points, pose.position - DVec3::Z * sensor.config().height_m)
    }
}

impl Work for Tick {
    fn run(&mut self) -> Result<(), BenchError> {
        match self.planner.step(&self.points_m, &self.pose, Duration::from_millis(100)).status {
            // In the pit there is no candidate; perception runs completely all the same.
            Status::Stopped(mapless::StopReason::NoSubgoal) => Ok(()),
            Status::Stopped(reason) => Err(BenchError::Stopped(reason)),
            Status::Driving | Status::Arrived | Status::Backtracking | Status::Searching => Ok(()),
        }
    }

    fn values(&mut self) -> Values {
        let step = self.planner.last_step();
        Values::from([
            ("returns", vec![self.points_m.len() as f64]),
            ("cells", vec![step.observed.cells().len() as f64]),
            ("columns", vec![step.profile.len() as f64]),
            ("command", vec![step.command.linear_m_s, step.command.angular_rad_s]),
        ])
    }
}
