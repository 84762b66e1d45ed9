//! A LiDAR with rings of beams, one revolution per scan. The default is a Velodyne VLP-16: 16 rings from -15°
//! to +15°.

use crate::attitude::{Attitude, world_from_body};
use crate::caster::{Caster, Fan};
use crate::objects::{NearSolids, Solid};
use crate::random;
use crate::returns::is_noticed;
use crate::sensing_config::SensingConfig;
use crate::sensor_pose::SensorPose;
use glam::{DVec2, DVec3, Vec3};
use mapless_parameters::{ConfigError, parameters};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

parameters! {
    /// Rings, mounting, resolution and noise of the sensor.
    pub struct SensorConfig {
        /// Time between two scans; 0.1 s at 10 Hz.
        period_s: f64 = 0.1, paper 0.1, unit "s", range [0.05, 0.5], check Within(0.001, 10.0);
        /// Rings, evenly spaced from the lowest to the highest.
        rings: usize = 16, range [2, 128], check Within(2.0, 1024.0);
        /// Elevation of the lowest ring above the sensor's x-y plane; negative when it looks down.
        lowest_elevation_rad: f64 = -15.0 * (PI / 180.0), unit "rad", range [-1.5, 0.2], check Within(-FRAC_PI_2, FRAC_PI_2);
        /// Elevation of the highest ring.
        highest_elevation_rad: f64 = 15.0 * (PI / 180.0), unit "rad", range [-0.2, 1.5], check Within(-FRAC_PI_2, FRAC_PI_2);
        /// Azimuths in one revolution; a VLP-16 at 10 Hz has 1800.
        columns: usize = 1800, range [90, 3600], check Within(1.0, 36_000.0);
        /// Horizontal field of view, half of it to each side of the sensor's x axis; 2π for a full turn.
        horizontal_fov_rad: f64 = TAU, unit "rad", range [0.5, TAU], check Within(0.01, TAU);
        /// Standard deviation of each range.
        range_noise_m: f64 = 0.02, unit "m", range [0.0, 0.5], check Within(0.0, 1.0);
        /// Share of returns that are lost at random.
        dropout_probability: f64 = 0.0, range [0.0, 1.0], check Within(0.0, 1.0);
        /// Nothing nearer is reported.
        min_range_m: f64 = 0.5, unit "m", range [0.0, 4.9], check NotNegative;
        /// Nothing farther is reported.
        max_range_m: f64 = 100.0, unit "m", range [5.0, 200.0], check Within(1.0, 1000.0);
        /// Height of the sensor above the contact plane along the body's z.
        height_m: f64 = 0.8, unit "m", range [0.2, 3.0], check Within(0.05, 5.0);
        /// Distance of the sensor ahead of the middle of the wheels along the body's x.
        forward_m: f64 = 0.0, unit "m", range [-1.0, 1.0], check Within(-5.0, 5.0);
        /// Distance of the sensor to the left of the middle of the wheels along the body's y.
        left_m: f64 = 0.0, unit "m", range [-1.0, 1.0], check Within(-5.0, 5.0);
        /// Roll of the mount, left side up positive; π for a sensor upside down. The mount is turned by yaw,
        /// pitch, roll.
        roll_rad: f64 = 0.0, unit "rad", range [-PI, PI], check Within(-PI, PI);
        /// Pitch of the mount, nose-up positive.
        pitch_rad: f64 = 0.0, unit "rad", range [-1.5, 1.5], check Within(-FRAC_PI_2, FRAC_PI_2);
        /// Yaw of the mount, anticlockwise positive.
        yaw_rad: f64 = 0.0, unit "rad", range [-PI, PI], check Within(-PI, PI);
    }
    relations check_order;
}

impl SensorConfig {
    fn check_order(&self, place: &str) -> Result<(), ConfigError> {
        let rises = self.lowest_elevation_rad < self.highest_elevation_rad;
        let value = self.lowest_elevation_rad;
        ConfigError::require(rises, place, "lowest_elevation_rad", value, "less than highest_elevation_rad")?;
        let grows = self.min_range_m < self.max_range_m;
        ConfigError::require(grows, place, "min_range_m", self.min_range_m, "less than max_range_m")
    }

    /// Elevation of a ring in the sensor frame, in radians; ring 0 is the lowest.
    #[must_use]
    pub fn ring_elevation_rad(&self, ring: usize) -> f64 {
        let steps = (self.rings - 1) as f64;
        let half_step = (self.highest_elevation_rad - self.lowest_elevation_rad) / (2.0 * steps);
        // Counted from the middle, so that a sensor that looks as far up as down has its rings in pairs, to
        // the last bit.
        let middle = (self.lowest_elevation_rad + self.highest_elevation_rad) / 2.0;
        (2.0 * ring as f64 - steps) * half_step + middle
    }

    /// Place of the sensor in the robot frame, metres.
    #[must_use]
    pub fn place_on_robot_m(&self) -> DVec3 {
        DVec3::new(self.forward_m, self.left_m, self.height_m)
    }

    /// Pose of the sensor on a robot that stands at `position` with heading `yaw_rad`.
    #[must_use]
    pub fn pose_on(&self, position: DVec2, yaw_rad: f64, attitude: &Attitude) -> SensorPose {
        let world_from_robot = world_from_body(yaw_rad, attitude);
        let mount = world_from_robot * self.place_on_robot_m();
        let turned = Attitude { height_m: 0.0, roll_rad: self.roll_rad, pitch_rad: self.pitch_rad };
        let is_turned = [self.roll_rad, self.pitch_rad, self.yaw_rad].iter().any(|&angle| angle != 0.0);
        let world_from_sensor = if is_turned {
            world_from_robot * world_from_body(self.yaw_rad, &turned)
        } else {
            world_from_robot
        };
        SensorPose { position: position.extend(attitude.height_m) + mount, world_from_sensor }
    }
}

/// One revolution.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scan {
    /// Range of every beam in metres, NaN without a return: beam `column * rings + ring`. The azimuth of
    /// column k of a full turn is `-pi + k * 2 pi / columns`, the elevation that of
    /// [`SensorConfig::ring_elevation_rad`].
    pub ranges_m: Vec<f32>,
    /// The returns in the sensor frame, in metres, in the order of their beams.
    pub points: Vec<Vec3>,
}

/// What a sensor looks at.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// The ground.
    pub caster: &'a Caster,
    /// What stands on it.
    pub solids: &'a [Solid],
}

impl<'a> Scene<'a> {
    /// Ground with nothing on it.
    #[must_use]
    pub fn bare(caster: &'a Caster) -> Self {
        Self { caster, solids: &[] }
    }
}

/// The sensor: its configuration and the directions of its beams.
#[derive(Clone, Debug)]
pub struct Lidar {
    config: SensorConfig,
    sensing: SensingConfig,
    /// (sine, cosine) of each column's azimuth.
    azimuths: Vec<(f64, f64)>,
    /// (sine, cosine) of each ring's elevation.
    elevations: Vec<(f64, f64)>,
}

/// Stray returns are nearer than this.
const STRAY_RANGE_M: f64 = 7.0;
/// No noise in a lifetime is this many standard deviations.
const NOISE_DEVIATIONS: f64 = 12.0;

impl Lidar {
    /// Prepares a sensor.
    ///
    /// # Errors
    /// [`ConfigError`] when the configuration is not valid.
    pub fn new(config: SensorConfig) -> Result<Self, ConfigError> {
        config.validate("sensor")?;
        let azimuths = (0..config.columns)
            .map(|column| -PI + column as f64 * (TAU / config.columns as f64))
            .filter(|azimuth_rad| azimuth_rad.abs() <= config.horizontal_fov_rad / 2.0)
            .map(libm::sincos)
            .collect();
        let elevations =
            (0..config.rings).map(|ring| libm::sincos(config.ring_elevation_rad(ring))).collect();
        Ok(Self { config, sensing: SensingConfig::default(), azimuths, elevations })
    }

    /// The same sensor in the field.
    ///
    /// # Errors
    /// [`ConfigError`] when the configuration is not valid.
    pub fn in_the_field(self, sensing: SensingConfig) -> Result<Self, ConfigError> {
        sensing.validate("reality.sensing")?;
        Ok(Self { sensing, ..self })
    }

    /// Where the sensor truly is on a robot that stands at `position` with heading `yaw_rad`: its mount may
    /// be off from that of the configuration.
    #[must_use]
    pub fn true_pose_on(&self, position: DVec2, yaw_rad: f64, attitude: &Attitude) -> SensorPose {
        let told = self.config.pose_on(position, yaw_rad, attitude);
        let SensingConfig { mount_roll_rad, mount_pitch_rad, mount_height_m, .. } = self.sensing;
        if [mount_roll_rad, mount_pitch_rad, mount_height_m].iter().all(|&off| off == 0.0) {
            return told;
        }
        let robot_up = world_from_body(yaw_rad, attitude).z_axis;
        let off = Attitude { height_m: 0.0, roll_rad: mount_roll_rad, pitch_rad: mount_pitch_rad };
        SensorPose {
            position: told.position + robot_up * mount_height_m,
            world_from_sensor: told.world_from_sensor * world_from_body(0.0, &off),
        }
    }

    /// The configuration.
    #[must_use]
    pub fn config(&self) -> &SensorConfig {
        &self.config
    }

    /// Takes one revolution of bare ground from a fixed pose into `scan`, which is reused without allocation.
    ///
    /// Noise and drop-outs depend only on `seed`, `tick` and the beam. A return whose range, noise included,
    /// lies outside the sensor's limits is not reported.
    pub fn scan(&self, caster: &Caster, pose: &SensorPose, seed: u64, tick: u64, scan: &mut Scan) {
        self.scan_within(f64::INFINITY, &Scene::bare(caster), pose, seed, tick, scan);
    }

    /// As [`Lidar::scan`], with what stands on the ground, and faster: every return within `sight_m` is the
    /// same, those much farther are left out.
    pub fn scan_within(
        &self,
        sight_m: f64,
        scene: &Scene<'_>,
        pose: &SensorPose,
        seed: u64,
        tick: u64,
        scan: &mut Scan,
    ) {
        self.scan_along(sight_m, scene, |_| *pose, seed, tick, scan);
    }

    /// As [`Lidar::scan_within`], from a moving sensor: each column is fired from the pose for the share of
    /// the revolution that has passed then, from above 0 to 1, and its points are in the frame of that pose.
    pub fn scan_along(
        &self,
        sight_m: f64,
        scene: &Scene<'_>,
        fired_from: impl Fn(f64) -> SensorPose,
        seed: u64,
        tick: u64,
        scan: &mut Scan,
    ) {
        let (config, sensing) = (&self.config, &self.sensing);
        // Noise may bring a return nearer.
        let sight_m = sight_m + NOISE_DEVIATIONS * config.range_noise_m;
        let sight_m = if sensing.stray_probability > 0.0 { sight_m.max(STRAY_RANGE_M) } else { sight_m };
        let reach_m = config.max_range_m.min(sight_m);
        let beams = self.azimuths.len() * self.elevations.len();
        scan.ranges_m.clear();
        scan.points.clear();
        scan.ranges_m.reserve(beams);
        scan.points.reserve(beams);
        let scan_key = random::key(seed, tick);
        let mut near = NearSolids::new(scene.solids, &fired_from(1.0), reach_m);
        for (column, &(sin_azimuth, cos_azimuth)) in self.azimuths.iter().enumerate() {
            if self.is_blocked(sin_azimuth, cos_azimuth) {
                scan.ranges_m.resize((column + 1) * self.elevations.len(), f32::NAN);
                continue;
            }
            let pose = fired_from((column + 1) as f64 / self.azimuths.len() as f64);
            let mut fan = Fan::new(scene.caster, &pose, sin_azimuth, cos_azimuth);
            near.turn_to(&pose, &fan);
            for &(sin_elevation, cos_elevation) in &self.elevations {
                let solid_m = near.cast(&pose, &fan, sin_elevation, cos_elevation, reach_m);
                let ground_m = fan.cast(sin_elevation, cos_elevation, solid_m.unwrap_or(reach_m));
                let true_range_m = ground_m.or(solid_m);
                let beam_key = random::key(scan_key, scan.ranges_m.len() as u64);
                let beam =
                    DVec3::new(cos_elevation * cos_azimuth, cos_elevation * sin_azimuth, sin_elevation);
                let true_range_m = true_range_m.filter(|&range_m| {
                    let (origin, along) = (pose.position, pose.world_from_sensor * beam);
                    sensing.weakest_return <= 0.0
                        || is_noticed(
                            sensing,
                            scene.caster.field(),
                            origin,
                            along,
                            range_m,
                            random::key(beam_key, 4),
                        )
                });
                let true_range_m = self.stray(true_range_m, beam_key).or(true_range_m);
                match true_range_m.and_then(|range_m| self.measure(range_m, beam_key)) {
                    Some(range_m) => {
                        scan.ranges_m.push(range_m as f32);
                        scan.points.push((beam * range_m).as_vec3());
                    }
                    None => scan.ranges_m.push(f32::NAN),
                }
            }
        }
    }

    /// Whether something before the lens takes the returns of the column at the azimuth with this sine and
    /// cosine.
    fn is_blocked(&self, sin_azimuth: f64, cos_azimuth: f64) -> bool {
        let SensingConfig { blocked_azimuth_rad, blocked_width_rad, .. } = self.sensing;
        if blocked_width_rad <= 0.0 {
            return false;
        }
        let (sin, cos) = libm::sincos(blocked_azimuth_rad);
        cos * cos_azimuth + sin * sin_azimuth >= libm::cos(blocked_width_rad / 2.0)
    }

    /// Range of a stray return, if the beam has one.
    fn stray(&self, true_range_m: Option<f64>, beam_key: u64) -> Option<f64> {
        let (config, stray_probability) = (&self.config, self.sensing.stray_probability);
        let is_stray =
            stray_probability > 0.0 && random::uniform(random::key(beam_key, 2)) <= stray_probability;
        is_stray.then(|| {
            let end_m = true_range_m.unwrap_or(STRAY_RANGE_M).min(STRAY_RANGE_M);
            let share = random::uniform(random::key(beam_key, 3));
            config.min_range_m + share * (end_m - config.min_range_m).max(0.0)
        })
    }

    /// Adds the returns on the robot itself, whose outline is so long and wide.
    pub fn add_self_returns(&self, outline_m: DVec2, seed: u64, tick: u64, points_m: &mut Vec<Vec3>) {
        let config = &self.config;
        let scan_key = random::key(seed, tick);
        let mount = Attitude { height_m: 0.0, roll_rad: config.roll_rad, pitch_rad: config.pitch_rad };
        let sensor_from_robot = world_from_body(config.yaw_rad, &mount).transpose();
        let mount_m = config.place_on_robot_m();
        for index in 0..self.sensing.self_returns {
            // Beams have the keys from 0.
            let mut places = random::Sequence::new(random::key(scan_key, u64::MAX - index as u64));
            let mut between = |half_m: f64| places.between([-half_m, half_m]);
            let (x, y) = (between(0.5 * outline_m.x), between(0.5 * outline_m.y));
            let place_m = DVec3::new(x, y, places.share() * config.height_m);
            points_m.push((sensor_from_robot * (place_m - mount_m)).as_vec3());
        }
    }

    /// Adds a point at the origin for every beam without a return, if the driver does so.
    pub fn add_zeros(&self, scan: &mut Scan) {
        if self.sensing.zeros {
            let lost = scan.ranges_m.iter().filter(|range_m| range_m.is_nan()).count();
            scan.points.resize(scan.points.len() + lost, Vec3::ZERO);
        }
    }

    fn measure(&self, true_range_m: f64, beam_key: u64) -> Option<f64> {
        let config = &self.config;
        if config.dropout_probability > 0.0
            && random::uniform(random::key(beam_key, 1)) <= config.dropout_probability
        {
            return None;
        }
        let mut range_m = true_range_m;
        if config.range_noise_m > 0.0 {
            range_m += config.range_noise_m * random::gaussian(beam_key);
        }
        (config.min_range_m..=config.max_range_m).contains(&range_m).then_some(range_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{HeightField, Object, Objects};

    const RING_COUNT: usize = 16;

    fn flat() -> Caster {
        Caster::new(HeightField::new(401, 401, 0.25, vec![1.0; 401 * 401]).unwrap())
    }

    fn take(caster: &Caster, config: SensorConfig, seed: u64, tick: u64) -> Scan {
        take_within(f64::INFINITY, caster, config, seed, tick)
    }

    fn take_within(sight_m: f64, caster: &Caster, config: SensorConfig, seed: u64, tick: u64) -> Scan {
        let level = Attitude { height_m: 1.0, ..Attitude::default() };
        let pose = config.pose_on(DVec2::splat(50.0), 0.4, &level);
        let mut scan = Scan::default();
        let scene = Scene::bare(caster);
        Lidar::new(config).unwrap().scan_within(sight_m, &scene, &pose, seed, tick, &mut scan);
        scan
    }

    #[test]
    fn level_ground_gives_the_ranges_of_trigonometry() {
        let scan = take(&flat(), SensorConfig { range_noise_m: 0.0, ..SensorConfig::default() }, 0, 0);
        assert_eq!(scan.ranges_m.len(), 28_800);
        for (beam, range_m) in scan.ranges_m.iter().enumerate() {
            let expected = 0.8 / -libm::sin(SensorConfig::default().ring_elevation_rad(beam % RING_COUNT));
            if beam % RING_COUNT < 8 {
                assert!((f64::from(*range_m) - expected).abs() < 1e-5, "{range_m} {expected}");
            } else {
                assert!(range_m.is_nan());
            }
        }
        // Rings -15° to -7° return inside 7 m, as the paper's occupancy surface expects.
        let inside = scan.ranges_m[..RING_COUNT].iter().filter(|range_m| **range_m < 7.0).count();
        assert_eq!(inside, 5);
        assert!(scan.points.iter().all(|point| (point.z + 0.8).abs() < 1e-4));
        // Column 0 looks straight back.
        assert!(scan.points[0].x < -2.0 && scan.points[0].y.abs() < 1e-6);
    }

    #[test]
    fn noise_has_the_asked_deviation_and_depends_on_seed_tick_and_beam_alone() {
        let caster = flat();
        let noisy = SensorConfig { range_noise_m: 0.05, ..SensorConfig::default() };
        let truth = take(&caster, SensorConfig { range_noise_m: 0.0, ..SensorConfig::default() }, 0, 0);
        let scan = take(&caster, noisy.clone(), 3, 5);
        assert_eq!(scan.points, take(&caster, noisy.clone(), 3, 5).points);
        assert_ne!(scan.points, take(&caster, noisy.clone(), 4, 5).points);
        assert_ne!(scan.points, take(&caster, noisy.clone(), 3, 6).points);
        let errors: Vec<f64> = scan
            .ranges_m
            .iter()
            .zip(&truth.ranges_m)
            .filter(|(noisy, _)| !noisy.is_nan())
            .map(|(noisy, truth)| f64::from(noisy - truth))
            .collect();
        let count = errors.len() as f64;
        let mean = errors.iter().sum::<f64>() / count;
        let deviation = (errors.iter().map(|error| error * error).sum::<f64>() / count).sqrt();
        assert!(mean.abs() < 0.002 && (deviation - 0.05).abs() < 0.002, "{mean} {deviation}");
        // Beams that other settings remove leave the noise of the rest unchanged.
        let short = take(&caster, SensorConfig { max_range_m: 5.0, ..noisy }, 3, 5);
        for (short, long) in short.ranges_m.iter().zip(&scan.ranges_m) {
            assert!(short.is_nan() || short.to_bits() == long.to_bits());
        }
    }

    #[test]
    fn within_sight_every_return_is_the_same() {
        let noisy = SensorConfig { range_noise_m: 0.05, ..SensorConfig::default() };
        let caster = flat();
        let far = take(&caster, noisy.clone(), 3, 5);
        let near = take_within(4.0, &caster, noisy, 3, 5);
        for (near, far) in near.ranges_m.iter().zip(&far.ranges_m) {
            assert!(near.to_bits() == far.to_bits() || near.is_nan() && *far > 4.0, "{near} {far}");
        }
        assert!(near.points.len() < far.points.len());
    }

    #[test]
    fn every_beam_meets_the_first_of_ground_and_objects() {
        let caster = flat();
        let places = [[53.0, 50.0], [50.0, 47.0], [44.0, 52.0], [58.0, 57.0], [49.0, 50.6]];
        let objects = places.iter().enumerate().map(|(index, &at)| match index % 3 {
            0 => Object::Post { at, radius_m: 0.1, height_m: 2.0, walk: None },
            1 => Object::Box { at, size_m: [1.0, 0.4, 0.6], yaw_rad: 0.7, raised_m: 0.3, walk: None },
            _ => Object::Rock { at, radius_m: 0.5, sunk_m: 0.2 },
        });
        let objects = Objects::new(objects.collect(), caster.field());
        let config = SensorConfig { range_noise_m: 0.0, min_range_m: 0.0, ..SensorConfig::default() };
        let attitude = Attitude { height_m: 1.0, roll_rad: 0.2, pitch_rad: -0.1 };
        let pose = config.pose_on(DVec2::splat(50.0), 0.4, &attitude);
        let lidar = Lidar::new(config.clone()).unwrap();
        let scene = Scene { caster: &caster, solids: objects.solids() };
        let mut scan = Scan::default();
        lidar.scan_within(12.0, &scene, &pose, 0, 0, &mut scan);
        let mut on_objects = 0;
        for (beam, &range_m) in scan.ranges_m.iter().enumerate() {
            let azimuth_rad = -PI + (beam / RING_COUNT) as f64 * (TAU / config.columns as f64);
            let (sin_azimuth, cos_azimuth) = libm::sincos(azimuth_rad);
            let (sin, cos) = libm::sincos(config.ring_elevation_rad(beam % RING_COUNT));
            let direction = pose.world_from_sensor * DVec3::new(cos * cos_azimuth, cos * sin_azimuth, sin);
            let hits = objects.solids().iter().filter_map(|solid| solid.cast(pose.position, direction, 12.0));
            let solid_m = hits.fold(f64::INFINITY, f64::min);
            let ground_m = caster.cast(pose.position, direction, 12.0).unwrap_or(f64::INFINITY);
            let expected_m = solid_m.min(ground_m);
            on_objects += usize::from(solid_m < ground_m);
            let is_same = (f64::from(range_m) - expected_m).abs() < 1e-5;
            assert!(
                is_same || range_m.is_nan() && expected_m.is_infinite(),
                "{beam}: {range_m} {solid_m} {ground_m} {direction} {}",
                pose.position
            );
        }
        assert!(on_objects > 1000, "{on_objects}");
    }

    #[test]
    fn dropouts_take_their_share() {
        let caster = flat();
        let all = take(&caster, SensorConfig::default(), 1, 1).points.len() as f64;
        let config = SensorConfig { dropout_probability: 0.3, ..SensorConfig::default() };
        let kept = take(&caster, config, 1, 1).points.len() as f64;
        assert!((kept / all - 0.7).abs() < 0.02, "{kept} of {all}");
        let config = SensorConfig { dropout_probability: 1.0, ..SensorConfig::default() };
        assert!(take(&caster, config, 1, 1).points.is_empty());
    }

    #[test]
    fn range_limits_cut_near_and_far() {
        let config = SensorConfig { min_range_m: 4.0, max_range_m: 10.0, ..SensorConfig::default() };
        let scan = take(&flat(), config, 1, 1);
        assert!(!scan.points.is_empty());
        assert!(scan.points.iter().all(|point| (4.0..=10.0).contains(&point.length())));
    }

    #[test]
    fn a_second_scan_allocates_nothing() {
        let caster = flat();
        let config = SensorConfig::default();
        let pose =
            config.pose_on(DVec2::splat(50.0), 0.0, &Attitude { height_m: 1.0, ..Attitude::default() });
        let sensor = Lidar::new(config).unwrap();
        let mut scan = Scan::default();
        sensor.scan(&caster, &pose, 0, 0, &mut scan);
        let before = (scan.ranges_m.as_ptr(), scan.points.as_ptr(), scan.points.capacity());
        sensor.scan(&caster, &pose, 0, 1, &mut scan);
        assert_eq!(before, (scan.ranges_m.as_ptr(), scan.points.as_ptr(), scan.points.capacity()));
    }

    #[test]
    fn a_pitched_sensor_leans_back() {
        let config = SensorConfig { forward_m: 0.1, ..SensorConfig::default() };
        let attitude = Attitude { height_m: 2.0, roll_rad: 0.0, pitch_rad: 0.3 };
        let pose = config.pose_on(DVec2::new(5.0, 6.0), 0.0, &attitude);
        let (sin, cos) = libm::sincos(0.3);
        let expected = DVec3::new(5.0 + 0.1 * cos - 0.8 * sin, 6.0, 2.0 + 0.1 * sin + 0.8 * cos);
        assert!(pose.position.distance(expected) < 1e-12);
        assert!((pose.world_from_sensor * DVec3::X).z > 0.29, "nose up");
    }

    #[test]
    fn configuration_is_checked() {
        for (bad, field) in [
            (SensorConfig { columns: 0, ..SensorConfig::default() }, "columns"),
            (SensorConfig { range_noise_m: f64::NAN, ..SensorConfig::default() }, "range_noise_m"),
            (SensorConfig { dropout_probability: 1.1, ..SensorConfig::default() }, "dropout_probability"),
            (SensorConfig { min_range_m: 200.0, ..SensorConfig::default() }, "min_range_m"),
            (SensorConfig { height_m: -1.0, ..SensorConfig::default() }, "height_m"),
        ] {
            assert_eq!(Lidar::new(bad).unwrap_err().name, field);
        }
        assert!(mapless_toml::from_str::<SensorConfig>("noise = 1").is_err());
    }

    #[test]
    fn rings_of_a_vlp16_are_two_degrees_apart_to_the_last_bit() {
        for ring in 0..16 {
            let elevation = (2.0 * ring as f64 - 15.0) * (PI / 180.0);
            assert_eq!(SensorConfig::default().ring_elevation_rad(ring).to_bits(), elevation.to_bits());
        }
    }

    #[test]
    fn a_scan_has_the_beams_of_its_sensor() {
        let exact = SensorConfig { range_noise_m: 0.0, columns: 360, ..SensorConfig::default() };
        let wide = SensorConfig {
            rings: 32,
            lowest_elevation_rad: -PI / 4.0,
            highest_elevation_rad: PI / 4.0,
            horizontal_fov_rad: PI / 2.0,
            ..exact
        };
        let scan = take(&flat(), wide, 0, 0);
        assert_eq!(scan.ranges_m.len(), 91 * 32);
        assert!((scan.ranges_m[0] - 0.8 * 2.0_f32.sqrt()).abs() < 1e-4);
        assert!(scan.points.iter().all(|point| point.y.abs() < point.x * 1.0001));
    }

    #[test]
    fn a_turned_mount_turns_the_points_and_not_the_ground() {
        let exact = SensorConfig { range_noise_m: 0.0, left_m: 0.2, ..SensorConfig::default() };
        for mount in [
            SensorConfig { pitch_rad: -0.26, ..exact.clone() },
            SensorConfig { roll_rad: PI, yaw_rad: 2.0, ..exact.clone() },
        ] {
            let level = Attitude { height_m: 1.0, ..Attitude::default() };
            let pose = mount.pose_on(DVec2::splat(50.0), 0.4, &level);
            let scan = take(&flat(), mount, 0, 0);
            assert!(scan.points.len() > 5000);
            for point in &scan.points {
                let world = pose.position + pose.world_from_sensor * point.as_dvec3();
                assert!((world.z - 1.0).abs() < 1e-4, "{world}");
            }
        }
    }
}
