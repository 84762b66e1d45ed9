//! Safe poses of a robot on known ground.

use super::{OracleConfig, OracleError, PlanPose};
use glam::DVec2;
use mapless_parameters::{Check, ConfigError, Value};
use mapless_world::{HeightField, RobotConfig, attitude_on};
use std::f64::consts::TAU;

/// Headings checked before a place counts as too steep, or as safe with every heading.
const CHECKED_HEADINGS: u32 = 16;
/// Attitudes are checked at this spacing along the straight line, metres.
const STRAIGHT_STEP_M: f64 = 0.125;

/// The ground, and the tilt allowed on it.
pub(crate) struct SafePoses<'a> {
    field: &'a HeightField,
    robot: &'a RobotConfig,
    max_roll_rad: f64,
    max_pitch_rad: f64,
    /// For each cell of the ground whether the robot is safe anywhere in it with every heading, because no
    /// ground within reach of its wheels is steep. It spares most of the attitudes.
    gentle: Vec<bool>,
}

impl<'a> SafePoses<'a> {
    pub(crate) fn new(
        field: &'a HeightField,
        robot: &'a RobotConfig,
        config: &OracleConfig,
    ) -> Result<Self, OracleError> {
        robot.validate("robot")?;
        let place = "oracle";
        Check::Within(0.1, 10.0).require(place, "cell_m", Value::Number(config.cell_m))?;
        Check::NotNegative.require(place, "margin_rad", Value::Number(config.margin_rad))?;
        let least_rad = robot.roll_limit_rad.min(robot.pitch_limit_rad);
        let is_inside = config.margin_rad < least_rad;
        let expected = "less than the robot's tilt limits";
        ConfigError::require(is_inside, place, "margin_rad", config.margin_rad, expected)?;
        let max_roll_rad = robot.roll_limit_rad - config.margin_rad;
        let max_pitch_rad = robot.pitch_limit_rad - config.margin_rad;
        let gentle = gentle_cells(field, robot, safe_gradient(max_roll_rad, max_pitch_rad));
        Ok(Self { field, robot, max_roll_rad, max_pitch_rad, gentle })
    }

    pub(crate) fn extent_m(&self) -> DVec2 {
        self.field.extent_m()
    }

    /// Whether the robot is safe at a pose: wheels on the terrain, roll and pitch within the allowed.
    pub(super) fn is_safe(&self, position_m: DVec2, yaw_rad: f64) -> bool {
        if self.is_gentle(position_m) {
            return true;
        }
        attitude_on(self.field, position_m, yaw_rad, self.robot).is_some_and(|attitude| {
            attitude.roll_rad.abs() <= self.max_roll_rad && attitude.pitch_rad.abs() <= self.max_pitch_rad
        })
    }

    fn is_gentle(&self, position_m: DVec2) -> bool {
        let grid = position_m / self.field.cell_m();
        let columns = self.field.columns() - 1;
        if !(grid.x >= 0.0 && grid.y >= 0.0) {
            return false;
        }
        let (column, row) = (grid.x as usize, grid.y as usize);
        column < columns && self.gentle.get(row * columns + column).copied().unwrap_or(false)
    }

    pub(super) fn check_start(&self, start: PlanPose) -> Result<(), OracleError> {
        let PlanPose { position_m, yaw_rad } = start;
        if !yaw_rad.is_finite() || attitude_on(self.field, position_m, yaw_rad, self.robot).is_none() {
            return Err(self.off_terrain("start", position_m));
        }
        if self.is_safe(position_m, yaw_rad) { Ok(()) } else { Err(self.too_steep("start", position_m)) }
    }

    pub(super) fn check_goal(&self, goal_m: DVec2) -> Result<(), OracleError> {
        if !self.field.contains(goal_m) {
            return Err(self.off_terrain("goal", goal_m));
        }
        if headings_rad().any(|yaw_rad| self.is_safe(goal_m, yaw_rad)) {
            Ok(())
        } else {
            Err(self.too_steep("goal", goal_m))
        }
    }

    /// Whether the robot is safe at a place with every heading.
    pub(crate) fn every_heading_is_safe(&self, position_m: DVec2) -> bool {
        headings_rad().all(|yaw_rad| self.is_safe(position_m, yaw_rad))
    }

    /// Whether the straight line is safe for a robot that faces along it.
    pub(crate) fn straight_is_safe(&self, start_m: DVec2, goal_m: DVec2) -> bool {
        let path = goal_m - start_m;
        let yaw_rad = libm::atan2(path.y, path.x);
        let pieces = (path.length() / STRAIGHT_STEP_M).ceil().max(1.0);
        (0..=pieces as u32).all(|i| self.is_safe(start_m + path * (f64::from(i) / pieces), yaw_rad))
    }

    fn off_terrain(&self, what: &'static str, place_m: DVec2) -> OracleError {
        OracleError::OffTerrain { what, place_m, extent_m: self.extent_m() }
    }

    fn too_steep(&self, what: &'static str, place_m: DVec2) -> OracleError {
        let (roll_rad, pitch_rad) = (self.max_roll_rad, self.max_pitch_rad);
        OracleError::NotStandable { what, place_m, roll_rad, pitch_rad }
    }
}

fn headings_rad() -> impl Iterator<Item = f64> {
    (0..CHECKED_HEADINGS).map(|index| f64::from(index) * (TAU / f64::from(CHECKED_HEADINGS)))
}

/// A gradient g such that a robot on ground nowhere steeper stays within the limits with every heading.
///
/// In [`attitude_on`] two wheels on one side are `2 ahead` apart and two on one axle `2 aside`, so that the
/// slope ahead is at most g and the slope aside at most g (√(1 + (g r)²) + g r) for tan(roll) ≤ r. That is at
/// most r for the g found here.
fn safe_gradient(max_roll_rad: f64, max_pitch_rad: f64) -> f64 {
    let r = libm::tan(max_roll_rad);
    let holds = |g: f64| g * ((1.0 + g * g * r * r).sqrt() + g * r) <= r;
    let (mut low, mut high) = (0.0, r.min(libm::tan(max_pitch_rad)));
    for _ in 0..40 {
        let middle = (low + high) / 2.0;
        if holds(middle) { low = middle } else { high = middle }
    }
    low
}

/// For each cell whether the ground is at most as steep as `gradient` wherever a wheel of a robot in the cell
/// may be.
fn gentle_cells(field: &HeightField, robot: &RobotConfig, gradient: f64) -> Vec<bool> {
    let (columns, rows) = (field.columns() - 1, field.rows() - 1);
    let heights_m = field.heights_m();
    let most_m2 = (gradient * field.cell_m()) * (gradient * field.cell_m());
    let mut gentle = Vec::with_capacity(columns * rows);
    for row in 0..rows {
        for column in 0..columns {
            let corner = |c: usize, r: usize| f64::from(heights_m[(row + r) * field.columns() + column + c]);
            let square = |a: f64, b: f64| ((b - a) * (b - a)).max(0.0);
            // Each component of a bilinear patch's gradient is greatest at an edge.
            let east = square(corner(0, 0), corner(1, 0)).max(square(corner(0, 1), corner(1, 1)));
            let north = square(corner(0, 0), corner(0, 1)).max(square(corner(1, 0), corner(1, 1)));
            gentle.push(east + north <= most_m2);
        }
    }
    let reach_m = DVec2::new(robot.wheelbase_m, robot.track_m).length() / 2.0;
    let reach = (reach_m / field.cell_m()).ceil() as usize;
    for row in 0..rows {
        shrink(&mut gentle, row * columns, 1, columns, reach);
    }
    for column in 0..columns {
        shrink(&mut gentle, column, columns, rows, reach);
    }
    gentle
}

/// Keeps, along one line of cells, those at least `reach` cells from both ends and from every steep one.
fn shrink(gentle: &mut [bool], first: usize, stride: usize, count: usize, reach: usize) {
    let at = |index: usize| first + index * stride;
    let was: Vec<bool> = (0..count).map(|index| gentle[at(index)]).collect();
    let mut pass = |order: &mut dyn Iterator<Item = usize>| {
        let mut run = 0;
        for index in order {
            run = if was[index] { run + 1 } else { 0 };
            gentle[at(index)] &= run > reach;
        }
    };
    pass(&mut (0..count));
    pass(&mut (0..count).rev());
}
