//! Safe poses of a robot on known ground.

use super::{OracleConfig, OracleError, PlanPose};
use crate::known_world::KnownWorld;
use glam::DVec2;
use mapless_parameters::{Check, ConfigError, Value};
use mapless_world::{Body, Footing, HeightField, RobotConfig, RobotState, Solid, attitude_on};
use std::f64::consts::TAU;

/// Headings checked before a place counts as too steep, or as safe with every heading.
const CHECKED_HEADINGS: u32 = 16;
/// Attitudes are checked at this spacing along the straight line, metres.
const STRAIGHT_STEP_M: f64 = 0.125;

/// Solids are looked up in squares of this side, metres.
const SQUARE_M: f64 = 2.0;

/// A known world, and what is safe in it.
pub(crate) struct SafePoses<'a> {
    world: &'a KnownWorld,
    /// With the oracle's margins.
    body: Body,
    max_roll_rad: f64,
    max_pitch_rad: f64,
    /// For each cell of the ground whether the robot is safe anywhere in it with every heading, because no
    /// ground within reach of its wheels is steep. It spares most of the attitudes. Solids are looked up
    /// beside.
    gentle: Vec<bool>,
    /// For each square of the terrain, row by row from the south-west, what a robot in it may touch.
    near: Vec<Vec<Solid>>,
    squares: usize,
}

impl<'a> SafePoses<'a> {
    pub(crate) fn new(world: &'a KnownWorld, config: &OracleConfig) -> Result<Self, OracleError> {
        let robot = &world.robot;
        robot.validate("robot")?;
        let place = "oracle";
        Check::Within(0.1, 10.0).require(place, "cell_m", Value::Number(config.cell_m))?;
        for (name, value) in [
            ("margin_rad", config.margin_rad),
            ("clearance_m", config.clearance_m),
            ("ground_clearance_m", config.ground_clearance_m),
        ] {
            Check::NotNegative.require(place, name, Value::Number(value))?;
        }
        let least_rad = robot.roll_limit_rad.min(robot.pitch_limit_rad);
        let is_inside = config.margin_rad < least_rad;
        let expected = "less than the robot's tilt limits";
        ConfigError::require(is_inside, place, "margin_rad", config.margin_rad, expected)?;
        let max_roll_rad = robot.roll_limit_rad - config.margin_rad;
        let max_pitch_rad = robot.pitch_limit_rad - config.margin_rad;
        let outline_m = DVec2::new(robot.length_m, robot.width_m) + 2.0 * config.clearance_m;
        let wheels_m = DVec2::new(robot.wheelbase_m, robot.track_m);
        let gradient = safe_gradient(max_roll_rad, max_pitch_rad);
        let gentle = if world.touches_ground {
            let gradient = gradient.min(clear_gradient(robot, config.ground_clearance_m));
            gentle_cells(&world.field, outline_m, gradient)
        } else {
            gentle_cells(&world.field, wheels_m, gradient)
        };
        let squares = (world.field.extent_m() / SQUARE_M).ceil().max(DVec2::ONE);
        let reach_m = outline_m.length() / 2.0;
        let near_square = |index: usize| {
            let (column, row) = ((index % squares.x as usize) as f64, (index / squares.x as usize) as f64);
            let low_m = DVec2::new(column, row) * SQUARE_M;
            let may_touch = |solid: &&Solid| {
                let centre_m = solid.centre_m.truncate();
                let beside_m = centre_m - centre_m.clamp(low_m, low_m + SQUARE_M);
                beside_m.length() <= solid.bounding_radius_m() + reach_m
            };
            world.solids.iter().filter(may_touch).copied().collect()
        };
        Ok(Self {
            world,
            body: world.body.clone().with_margin(config.clearance_m, config.ground_clearance_m),
            max_roll_rad,
            max_pitch_rad,
            gentle,
            near: (0..squares.x as usize * squares.y as usize).map(near_square).collect(),
            squares: squares.x as usize,
        })
    }

    pub(crate) fn extent_m(&self) -> DVec2 {
        self.world.field.extent_m()
    }

    /// What a robot at a place on the terrain may touch.
    fn near(&self, position_m: DVec2) -> &[Solid] {
        let square = (position_m / SQUARE_M).max(DVec2::ZERO);
        self.near.get(square.y as usize * self.squares + square.x as usize).map_or(&[], Vec::as_slice)
    }

    /// Whether the robot is safe at a pose: wheels on the terrain, roll and pitch within the allowed, the
    /// body clear of everything.
    pub(super) fn is_safe(&self, position_m: DVec2, yaw_rad: f64) -> bool {
        let KnownWorld { field, robot, touches_ground, .. } = self.world;
        let solids = self.near(position_m);
        if solids.is_empty() && self.is_gentle(position_m) {
            return true;
        }
        let footing = Footing { field, solids };
        let Some(attitude) = attitude_on(&footing, position_m, yaw_rad, robot) else { return false };
        if attitude.roll_rad.abs() > self.max_roll_rad || attitude.pitch_rad.abs() > self.max_pitch_rad {
            return false;
        }
        let state =
            RobotState { position: position_m, yaw_rad, speed_m_s: 1.0, turn_rate_rad_s: 0.0, attitude };
        self.body.contact_with(solids, &state).is_none()
            && (!touches_ground || self.body.contact_with_ground(field, &footing, &state).is_none())
    }

    fn is_gentle(&self, position_m: DVec2) -> bool {
        let field = &self.world.field;
        let grid = position_m / field.cell_m();
        let columns = field.columns() - 1;
        if !(grid.x >= 0.0 && grid.y >= 0.0) {
            return false;
        }
        let (column, row) = (grid.x as usize, grid.y as usize);
        column < columns && self.gentle.get(row * columns + column).copied().unwrap_or(false)
    }

    pub(super) fn check_start(&self, start: PlanPose) -> Result<(), OracleError> {
        let PlanPose { position_m, yaw_rad } = start;
        let KnownWorld { field, robot, .. } = self.world;
        if !yaw_rad.is_finite() || attitude_on(field, position_m, yaw_rad, robot).is_none() {
            return Err(self.off_terrain("start", position_m));
        }
        if self.is_safe(position_m, yaw_rad) { Ok(()) } else { Err(self.too_steep("start", position_m)) }
    }

    pub(super) fn check_goal(&self, goal_m: DVec2) -> Result<(), OracleError> {
        if !self.world.field.contains(goal_m) {
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

/// A gradient such that neither belly nor bumpers of a robot touch ground that is nowhere steeper: under the
/// belly there may be a crest, before the bumper a rise while the wheels go down.
fn clear_gradient(robot: &RobotConfig, ground_clearance_m: f64) -> f64 {
    let belly =
        (robot.ground_clearance_m - ground_clearance_m) / (robot.wheelbase_m.max(robot.track_m) / 2.0);
    let overhang_m = (robot.length_m - robot.wheelbase_m) / 2.0;
    let bumper =
        (robot.overhang_clearance_m - ground_clearance_m) / (2.0 * overhang_m).max(f64::MIN_POSITIVE);
    belly.min(bumper).max(0.0)
}

/// For each cell whether the ground is at most as steep as `gradient` wherever a robot in the cell may touch
/// it, whose wheels or body fill this length and width.
fn gentle_cells(field: &HeightField, outline_m: DVec2, gradient: f64) -> Vec<bool> {
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
    let reach_m = outline_m.length() / 2.0;
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
