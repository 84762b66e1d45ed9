//! Whether a sensor can serve, and whether a scan is of the sensor that is configured.

use core::f64::consts::{PI, TAU};

use glam::{DMat3, DVec3, Vec3};
use mapless::{PlannerConfig, RobotModel, SensorModel};

/// Sensors with fewer rings see too little of the ground, and none has more.
const RINGS: [usize; 2] = [8, 128];
/// The skyline is sought between rings: farther apart, it could be anywhere.
const WIDEST_SPACING_RAD: f64 = 6.5 * PI / 180.0;
/// What is ahead: directions within this angle of forward.
const AHEAD_RAD: f64 = PI / 4.0;
/// Directions that are tried on each ring.
const DIRECTIONS: usize = 360;
/// Sectors of the view in which a scan has returns or has none.
const SECTORS: usize = 36;
/// Fewer sectors with returns are half a scan, or a blocked lens.
const LEAST_SECTORS: f64 = 0.6;
/// Returns this far outside the rings are not of the sensor. Rings are not at their nominal angles.
const OUTSIDE_RAD: f64 = 1.5 * PI / 180.0;
const MOST_OUTSIDE: f64 = 0.05;

/// Why a sensor cannot serve.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SensorError {
    /// Too few rings, or too many.
    #[error("a sensor with {rings} rings cannot serve: expected 8 to 128")]
    Rings {
        /// Its rings.
        rings: usize,
    },
    /// The rings are too far apart.
    #[error("a sensor whose rings are {spacing_deg:.1}° apart cannot serve: expected at most 6.5°")]
    Spacing {
        /// Angle between two rings, degrees.
        spacing_deg: f64,
    },
    /// It sees nothing ahead of the robot.
    #[error("a sensor that is mounted so that nothing ahead of the robot is in its view cannot serve")]
    Ahead,
    /// It sees no ground near the robot.
    #[error(
        "a sensor whose lowest beam ahead is at {lowest_deg:.1}° and {height_m} m up cannot serve: it meets level \
         ground beyond {radius_m} m, where the planner looks for it"
    )]
    Ground {
        /// Elevation of the lowest beam ahead over the robot's x-y plane, degrees.
        lowest_deg: f64,
        /// Height of the sensor, metres.
        height_m: f64,
        /// How far the planner looks, metres.
        radius_m: f64,
    },
}

/// Why a scan is not one of the sensor that is configured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ViewError {
    /// A part of the view has no returns.
    #[error("returns in {sectors} of {all} sectors of the view: half a scan, or a blocked lens")]
    Blocked {
        /// Sectors of 10° with returns.
        sectors: usize,
        /// Sectors in the sensor's field of view.
        all: usize,
    },
    /// Returns come from where the sensor has no rings.
    #[error(
        "{share_percent:.0} % of the returns are outside elevations of {lowest_deg:.1}° to {highest_deg:.1}°: another \
         sensor, or another frame than the sensor's"
    )]
    Outside {
        /// Their share.
        share_percent: f64,
        /// Elevation of the lowest ring, degrees.
        lowest_deg: f64,
        /// Elevation of the highest ring, degrees.
        highest_deg: f64,
    },
}

/// Whether a sensor can serve the planner on this robot.
///
/// # Errors
/// [`SensorError`] says in a sentence why not.
pub fn check_sensor(sensor: &SensorModel, robot: &RobotModel) -> Result<(), SensorError> {
    if !(RINGS[0]..=RINGS[1]).contains(&sensor.rings) {
        return Err(SensorError::Rings { rings: sensor.rings });
    }
    let spacing_rad =
        (sensor.highest_elevation_rad - sensor.lowest_elevation_rad) / (sensor.rings - 1) as f64;
    if spacing_rad > WIDEST_SPACING_RAD {
        return Err(SensorError::Spacing { spacing_deg: spacing_rad.to_degrees() });
    }
    let radius_m = PlannerConfig::for_robot(*sensor, *robot).perception.surface_radius_m;
    let lowest_rad = lowest_ahead_rad(sensor).ok_or(SensorError::Ahead)?;
    // The lowest beam meets level ground at this range, if at all.
    let is_met = -radius_m * libm::sin(lowest_rad) >= sensor.height_m;
    let (lowest_deg, height_m) = (lowest_rad.to_degrees(), sensor.height_m);
    if is_met { Ok(()) } else { Err(SensorError::Ground { lowest_deg, height_m, radius_m }) }
}

/// Elevation over the robot's x-y plane of the lowest beam that looks ahead.
fn lowest_ahead_rad(sensor: &SensorModel) -> Option<f64> {
    let robot_from_sensor = sensor.robot_from_sensor().unwrap_or(DMat3::IDENTITY);
    let elevations = [sensor.lowest_elevation_rad, sensor.highest_elevation_rad];
    let directions = (0..DIRECTIONS).flat_map(|index| {
        let azimuth_rad = TAU * index as f64 / DIRECTIONS as f64 - PI;
        elevations.map(|elevation_rad| (azimuth_rad, elevation_rad))
    });
    directions
        .filter(|(azimuth_rad, _)| azimuth_rad.abs() <= 0.5 * sensor.horizontal_fov_rad)
        .map(|(azimuth_rad, elevation_rad)| {
            let (sin_a, cos_a) = libm::sincos(azimuth_rad);
            let (sin_e, cos_e) = libm::sincos(elevation_rad);
            robot_from_sensor * DVec3::new(cos_e * cos_a, cos_e * sin_a, sin_e)
        })
        .filter(|beam| libm::atan2(beam.y, beam.x).abs() <= AHEAD_RAD)
        .map(|beam| libm::asin(beam.z.clamp(-1.0, 1.0)))
        .reduce(f64::min)
}

/// Whether the returns of a scan, in the sensor's frame, are from where the sensor looks. An empty scan is
/// for the planner to judge.
///
/// # Errors
/// [`ViewError`] says what is missing or too much.
pub fn check_view(points_m: &[Vec3], sensor: &SensorModel) -> Result<(), ViewError> {
    if points_m.is_empty() {
        return Ok(());
    }
    let elevations_rad =
        sensor.lowest_elevation_rad - OUTSIDE_RAD..=sensor.highest_elevation_rad + OUTSIDE_RAD;
    let mut has_returns = [false; SECTORS];
    let mut outside = 0;
    for point_m in points_m.iter().map(|point_m| point_m.as_dvec3()) {
        let azimuth_rad = libm::atan2(point_m.y, point_m.x);
        has_returns[sector_of(azimuth_rad)] = true;
        let plan_m = point_m.truncate().length();
        // Near the sensor, the offset of its lasers tells.
        let is_far = point_m.length() > 1.0;
        outside += usize::from(is_far && !elevations_rad.contains(&libm::atan2(point_m.z, plan_m)));
    }
    let share = outside as f64 / points_m.len() as f64;
    if share > MOST_OUTSIDE {
        return Err(ViewError::Outside {
            share_percent: 100.0 * share,
            lowest_deg: sensor.lowest_elevation_rad.to_degrees(),
            highest_deg: sensor.highest_elevation_rad.to_degrees(),
        });
    }
    let is_in_view = |sector: &usize| {
        let middle_rad = (*sector as f64 + 0.5) * TAU / SECTORS as f64 - PI;
        middle_rad.abs() <= 0.5 * sensor.horizontal_fov_rad
    };
    let in_view: Vec<usize> = (0..SECTORS).filter(is_in_view).collect();
    let sectors = in_view.iter().filter(|sector| has_returns[**sector]).count();
    let is_whole = sectors as f64 >= LEAST_SECTORS * in_view.len() as f64;
    if is_whole { Ok(()) } else { Err(ViewError::Blocked { sectors, all: in_view.len() }) }
}

fn sector_of(azimuth_rad: f64) -> usize {
    let sector = (azimuth_rad + PI) * (SECTORS as f64 / TAU);
    (sector as usize).min(SECTORS - 1)
}
