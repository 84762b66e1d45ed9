//! A planner allocates nothing after its first steps: a step that allocates can be late.

#![allow(unsafe_code, reason = "an allocator that counts is one by nature")]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use core::time::Duration;

use glam::DVec2;
use mapless::config::FollowingLaw;
use mapless::{Goal, Planner, PlannerConfig, Pose, RobotModel, SensorModel, Status};
use mapless_world::{Caster, DriveCommand, HeightField, Lidar, Robot, RobotConfig, Scan, SensorConfig};

thread_local! {
    /// Allocations of this thread; the test harness has threads of its own.
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

struct Counting;

impl Counting {
    fn count() {
        ALLOCATIONS.set(ALLOCATIONS.get() + 1);
    }
}

// SAFETY: everything is passed on to the system's allocator; the counter itself allocates nothing.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        Self::count();
        // SAFETY: the caller keeps the promises that this function asks for.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        Self::count();
        // SAFETY: as above.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Hills, 40 m square.
fn hills() -> HeightField {
    let height = |column: usize, row: usize| {
        let (x, y) = (column as f64 * 0.2, row as f64 * 0.2);
        (0.8 * libm::sin(x / 4.0) * libm::cos(y / 5.0) + 0.1 * libm::sin(1.7 * x + y)) as f32
    };
    let heights = (0..200).flat_map(|row| (0..200).map(move |column| height(column, row)));
    HeightField::new(200, 200, 0.2, heights.collect()).unwrap()
}

/// Drives for this many steps over the hills; returns the allocations of each step.
fn drive(ticks: u64, sensor: SensorConfig, config: PlannerConfig) -> Vec<usize> {
    let caster = Caster::new(hills());
    let sensor = Lidar::new(sensor).unwrap();
    let mut husky = Robot::new(RobotConfig::default(), caster.field(), DVec2::splat(8.0), 0.7).unwrap();
    let mut planner = Planner::new(config).unwrap();
    planner.set_goal(Goal::at(DVec2::splat(33.0)));
    let mut scan = Scan::default();
    let mut allocations = Vec::new();
    for tick in 0..ticks {
        let state = *husky.state();
        let pose = Pose::from_roll_pitch_yaw(
            husky.position(),
            state.attitude.roll_rad,
            state.attitude.pitch_rad,
            state.yaw_rad,
        );
        let sensor_pose = sensor.config().pose_on(state.position, state.yaw_rad, &state.attitude);
        sensor.scan(&caster, &sensor_pose, 1, tick, &mut scan);
        let before = ALLOCATIONS.get();
        let step = planner.step(&scan.points, &pose, Duration::from_millis(100));
        let during = ALLOCATIONS.get() - before;
        assert!(matches!(step.status, Status::Driving | Status::Searching), "{:?}", step.status);
        let command =
            DriveCommand { speed_m_s: step.command.linear_m_s, turn_rate_rad_s: step.command.angular_rad_s };
        allocations.push(during);
        for _ in 0..10 {
            husky.step(command, 0.01, caster.field()).unwrap();
        }
    }
    allocations
}

fn assert_frugal(allocations: &[usize]) {
    let (first, rest) = allocations.split_at(20);
    assert!(first[0] > 0, "the counter counts");
    assert!(rest.iter().all(|&count| count == 0), "{allocations:?}");
}

#[test]
fn a_step_allocates_nothing_after_the_first_ones() {
    for following in [FollowingLaw::Pid, FollowingLaw::RecedingHorizon] {
        let mut config = PlannerConfig::for_robot(SensorModel::default(), RobotModel::husky());
        config.controller.following = following;
        assert_frugal(&drive(120, SensorConfig::default(), config));
    }
}

#[test]
fn nor_does_one_with_a_tilted_sensor_of_many_rings() {
    let (lowest_elevation_rad, highest_elevation_rad, pitch_rad) = (-0.785, 0.785, -0.26);
    let sensor = SensorConfig {
        rings: 64,
        columns: 720,
        lowest_elevation_rad,
        highest_elevation_rad,
        pitch_rad,
        ..SensorConfig::default()
    };
    let mut model = SensorModel::default();
    (model.rings, model.columns, model.pitch_rad) = (64, 720, pitch_rad);
    (model.lowest_elevation_rad, model.highest_elevation_rad) = (lowest_elevation_rad, highest_elevation_rad);
    assert_frugal(&drive(120, sensor, PlannerConfig::for_robot(model, RobotModel::husky())));
}
