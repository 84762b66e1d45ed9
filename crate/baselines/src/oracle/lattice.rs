//! The graph that the oracle searches.

use super::motions::{Motion, drives, heading_rad};
use super::safe_poses::SafePoses;
use super::{OracleError, PlanPose};
use glam::DVec2;
use mapless::math::angle::difference_rad;
use mapless::terrain::headings::HEADINGS;

/// Attitudes are checked at this spacing along a motion.
const CHECK_M: f64 = 0.125;
const CHECK_RAD: f64 = 0.1;
/// Cost of turning on the spot to the next heading, metres; other angles in proportion.
const TURN_COST_M: f64 = 0.1;
/// Costs are whole micrometres, because the search needs an exact order.
const MICROMETRES: f64 = 1e6;
/// The most places of a lattice: a square of 700 m at 0.5 m.
const MAX_PLACES: usize = 2_000_000;

/// A place and one of the lattice's headings, or the start with the robot's own heading.
#[derive(Clone, Copy, Debug, Eq, Hash, PartialEq)]
pub(super) struct Node {
    column: i32,
    row: i32,
    heading: u8,
}

/// The robot's own heading at the start.
const AS_PUT: u8 = HEADINGS as u8;

impl Node {
    pub(super) const START: Self = Self { column: 0, row: 0, heading: AS_PUT };

    fn is_at_same_place(self, other: Self) -> bool {
        (self.column, self.row) == (other.column, other.row)
    }
}

/// The goal, which is a place on the lattice's first axis.
#[derive(Clone, Copy)]
pub(super) struct Goal {
    column: i32,
    cell_m: f64,
}

impl Goal {
    /// The straight distance, rounded down.
    pub(super) fn estimate(self, node: Node) -> u64 {
        let away = DVec2::new(f64::from(node.column - self.column), f64::from(node.row));
        (away.length() * self.cell_m * MICROMETRES).floor() as u64
    }

    pub(super) fn is_at(self, node: Node) -> bool {
        node.column == self.column && node.row == 0
    }
}

/// Whether a place with a heading is safe, as far as known.
#[derive(Clone, Copy)]
enum Verdict {
    Unknown,
    Safe,
    Unsafe,
}

/// Places and headings, and the motions between them.
pub(super) struct Lattice<'a> {
    safe_poses: &'a SafePoses<'a>,
    start: PlanPose,
    /// From one place to the next along the first axis, in the world frame.
    cell: DVec2,
    axis_rad: f64,
    goal: Goal,
    drives: Vec<Vec<Motion>>,
    costs: Vec<Vec<u64>>,
    /// South-western place of the box around the terrain, in the lattice's frame, and the box's size.
    first: (i32, i32),
    size: (usize, usize),
    verdicts: Vec<Verdict>,
}

impl<'a> Lattice<'a> {
    /// `goal_m` is at least half a `cell_m` away.
    pub(super) fn new(
        safe_poses: &'a SafePoses<'a>,
        start: PlanPose,
        goal_m: DVec2,
        cell_m: f64,
    ) -> Result<Self, OracleError> {
        let path = goal_m - start.position_m;
        let count = (path.length() / cell_m).round().max(1.0);
        let cell = path / count;
        let cell_m = cell.length();
        let extent_m = safe_poses.extent_m();
        let corners =
            [DVec2::ZERO, DVec2::new(extent_m.x, 0.0), DVec2::new(0.0, extent_m.y), extent_m].map(|corner| {
                (corner - start.position_m).rotate(DVec2::new(cell.x, -cell.y)) / (cell_m * cell_m)
            });
        let low = corners.iter().fold(DVec2::INFINITY, |low, &corner| low.min(corner)).ceil();
        let high = corners.iter().fold(DVec2::NEG_INFINITY, |high, &corner| high.max(corner)).floor();
        let places = (high.x - low.x + 1.0) * (high.y - low.y + 1.0);
        if places > MAX_PLACES as f64 {
            return Err(OracleError::TooLarge { places, cell_m, most: MAX_PLACES });
        }
        let size = ((high.x - low.x + 1.0) as usize, (high.y - low.y + 1.0) as usize);
        let drives = drives(CHECK_M / cell_m);
        let cost = |motion: &Motion| (motion.length() * cell_m * MICROMETRES).ceil() as u64;
        Ok(Self {
            safe_poses,
            start,
            cell,
            axis_rad: libm::atan2(cell.y, cell.x),
            goal: Goal { column: count as i32, cell_m },
            costs: drives.iter().map(|motions| motions.iter().map(cost).collect()).collect(),
            drives,
            first: (low.x as i32, low.y as i32),
            size,
            verdicts: vec![Verdict::Unknown; size.0 * size.1 * HEADINGS],
        })
    }

    pub(super) fn goal(&self) -> Goal {
        self.goal
    }

    /// The successors of a node by one safe motion, and their costs.
    pub(super) fn successors(&mut self, node: Node) -> Vec<(Node, u64)> {
        let mut found = Vec::with_capacity(HEADINGS);
        let count = HEADINGS as u8;
        if node.heading == AS_PUT {
            found.extend((0..count).filter_map(|heading| self.turn(node, heading)));
            return found;
        }
        found.extend([1, count - 1].iter().filter_map(|by| self.turn(node, (node.heading + by) % count)));
        for index in 0..self.drives[usize::from(node.heading)].len() {
            found.extend(self.drive(node, index));
        }
        found
    }

    fn drive(&mut self, node: Node, index: usize) -> Option<(Node, u64)> {
        let from = usize::from(node.heading);
        let motion = &self.drives[from][index];
        let [columns, rows] = motion.step.to_array();
        let end = Node { column: node.column + columns, row: node.row + rows, heading: motion.heading };
        // Most unsafe motions end on ground that is already known to be unsafe.
        if !self.is_safe(end) {
            return None;
        }
        let (motion, origin_m) = (&self.drives[from][index], self.position_m(node));
        let (_, along) = motion.poses.split_last()?;
        let safe = along.iter().all(|&(offset, yaw_rad)| {
            self.safe_poses.is_safe(origin_m + self.cell.rotate(offset), self.axis_rad + yaw_rad)
        });
        safe.then_some((end, self.costs[from][index]))
    }

    fn turn(&mut self, node: Node, heading: u8) -> Option<(Node, u64)> {
        let end = Node { heading, ..node };
        let position_m = self.position_m(node);
        let safe = self.is_safe(end)
            && self.turn_rad(node, end).all(|yaw_rad| self.safe_poses.is_safe(position_m, yaw_rad));
        let angle_rad = difference_rad(self.yaw_rad(end), self.yaw_rad(node)).abs();
        let share = angle_rad * HEADINGS as f64 / std::f64::consts::TAU;
        safe.then_some((end, (TURN_COST_M * share * MICROMETRES).ceil() as u64))
    }

    /// The headings on the shorter turn from one to another, the last one included.
    fn turn_rad(&self, from: Node, to: Node) -> impl Iterator<Item = f64> + use<> {
        let begin_rad = self.yaw_rad(from);
        let angle_rad = difference_rad(self.yaw_rad(to), begin_rad);
        let pieces = (angle_rad.abs() / CHECK_RAD).ceil().max(1.0);
        (1..=pieces as u32).map(move |i| begin_rad + angle_rad * f64::from(i) / pieces)
    }

    fn is_safe(&mut self, node: Node) -> bool {
        let (columns, rows) = self.size;
        let column = usize::try_from(node.column - self.first.0).ok().filter(|&column| column < columns);
        let row = usize::try_from(node.row - self.first.1).ok().filter(|&row| row < rows);
        let (Some(column), Some(row)) = (column, row) else { return false };
        let index = (row * columns + column) * HEADINGS + usize::from(node.heading);
        match self.verdicts[index] {
            Verdict::Safe => true,
            Verdict::Unsafe => false,
            Verdict::Unknown => {
                let safe = self.safe_poses.is_safe(self.position_m(node), self.yaw_rad(node));
                self.verdicts[index] = if safe { Verdict::Safe } else { Verdict::Unsafe };
                safe
            }
        }
    }

    fn position_m(&self, node: Node) -> DVec2 {
        self.start.position_m + self.cell.rotate(DVec2::new(f64::from(node.column), f64::from(node.row)))
    }

    fn yaw_rad(&self, node: Node) -> f64 {
        if node.heading == AS_PUT { self.start.yaw_rad } else { self.axis_rad + heading_rad(node.heading) }
    }

    /// All poses along a path, as checked.
    pub(super) fn poses(&self, nodes: &[Node]) -> Vec<PlanPose> {
        let mut poses = vec![self.start];
        for pair in nodes.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            let origin_m = self.position_m(from);
            if from.is_at_same_place(to) {
                let turned = self.turn_rad(from, to);
                poses.extend(turned.map(|yaw_rad| PlanPose { position_m: origin_m, yaw_rad }));
                continue;
            }
            let step = [to.column - from.column, to.row - from.row];
            let motions = &self.drives[usize::from(from.heading)];
            let motion =
                motions.iter().find(|motion| motion.step.to_array() == step && motion.heading == to.heading);
            poses.extend(motion.iter().flat_map(|motion| &motion.poses).map(|&(offset, yaw_rad)| PlanPose {
                position_m: origin_m + self.cell.rotate(offset),
                yaw_rad: self.axis_rad + yaw_rad,
            }));
        }
        poses
    }
}
