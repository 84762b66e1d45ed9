//! From the motion of the wheels to that of the body: slip on slopes and in turns, and the limit of friction.

use crate::attitude::Attitude;
use crate::motion_config::MotionConfig;
use glam::DVec2;

const GRAVITY_M_S2: f64 = 9.81;

/// Motion of the body over the ground.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct BodyMotion {
    /// Speed forward and to the left, along the body, in m/s.
    pub(crate) velocity_m_s: DVec2,
    /// Rate of the heading, in rad/s.
    pub(crate) turn_rate_rad_s: f64,
}

/// The motion that follows `before` within `dt_s`, on ground of this attitude, when the wheels would drive a
/// body that does not slip by `wheels`.
pub(crate) fn body_motion(
    config: &MotionConfig,
    wheels: BodyMotion,
    attitude: &Attitude,
    before: BodyMotion,
    dt_s: f64,
) -> BodyMotion {
    let (sin_pitch, cos_pitch) = libm::sincos(attitude.pitch_rad);
    let (sin_roll, cos_roll) = libm::sincos(attitude.roll_rad);
    let (tan_pitch, tan_roll) = (sin_pitch / cos_pitch, sin_roll / cos_roll);
    // On a side slope the lower wheels carry more and skid less, so the same wheel speeds turn more.
    let turn_rate_rad_s =
        wheels.turn_rate_rad_s * config.turn_ratio * (1.0 + config.side_slope_turn * tan_roll.abs());
    // A wheel that drives up slips back, one that drives down slips on: both downhill.
    let ahead = wheels.velocity_m_s.x - config.slope_slip * tan_pitch * wheels.velocity_m_s.x.abs();
    // In a turn every wheel skids at |ω| r, with r half the diagonal between the wheels. Friction acts
    // against the skid, so that a pull of tan(roll) from the side is balanced by a drift of |ω| r tan(roll) /
    // μ.
    let pull =
        config.side_slip * wheels.velocity_m_s.x.abs() + config.turn_slide_m_rad * turn_rate_rad_s.abs();
    let wanted = DVec2::new(ahead, -pull * tan_roll);
    let downhill = DVec2::new(-sin_pitch, -sin_roll * cos_pitch) * GRAVITY_M_S2;
    let most = config.friction * GRAVITY_M_S2 * cos_pitch * cos_roll;
    let velocity_m_s = if config.may_slide() && dt_s > 0.0 {
        held(before.velocity_m_s, wanted, downhill, most, dt_s)
    } else {
        wanted
    };
    BodyMotion { velocity_m_s, turn_rate_rad_s }
}

/// Coulomb friction: the ground gives what acceleration it takes to reach `wanted` against gravity, but not
/// more than `most`; what is missing leaves the wheels spinning or the body sliding `downhill`.
fn held(velocity: DVec2, wanted: DVec2, downhill: DVec2, most: f64, dt_s: f64) -> DVec2 {
    let needed = (wanted - velocity) / dt_s - downhill;
    if needed.length() <= most { wanted } else { velocity + (needed.normalize() * most + downhill) * dt_s }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::height_field::HeightField;
    use crate::robot::{DriveCommand, Robot};
    use crate::robot_config::RobotConfig;
    use std::f64::consts::{FRAC_PI_2, PI};

    const DEGREE: f64 = PI / 180.0;
    const IDEAL: fn() -> MotionConfig = MotionConfig::default;

    /// Ground that rises to the east at `slope_rad`.
    fn slope(slope_rad: f64) -> HeightField {
        let rise_m = 0.5 * libm::tan(slope_rad);
        let heights = (0..201 * 201).map(|i| (f64::from(i % 201) * rise_m) as f32).collect();
        HeightField::new(201, 201, 0.5, heights).unwrap()
    }

    /// A robot in the middle of a slope, after so many seconds of a command and one more second of it; with
    /// the motion in that second, towards its heading of then and to its left, in metres over the ground.
    fn driven(
        motion: MotionConfig,
        slope_rad: f64,
        yaw_rad: f64,
        speed_m_s: f64,
        turn_rate_rad_s: f64,
        seconds: f64,
    ) -> (Robot, f64, f64) {
        let ground = slope(slope_rad);
        let mut robot = Robot::new(RobotConfig::default(), &ground, DVec2::splat(50.0), yaw_rad).unwrap();
        robot = robot.with_motion(motion);
        let mut drive = |seconds: f64| {
            let command = DriveCommand { speed_m_s, turn_rate_rad_s };
            for _ in 0..(seconds / 0.01).round() as usize {
                robot.step(command, 0.01, &ground).unwrap();
            }
            robot.clone()
        };
        let before = drive(seconds);
        let after = drive(1.0);
        let way = after.position() - before.position();
        let frame = crate::attitude::world_from_body(before.state().yaw_rad, &before.state().attitude);
        (after, way.dot(frame.x_axis), way.dot(frame.y_axis))
    }

    fn close(found: f64, expected: f64, within: f64) {
        assert!((found - expected).abs() < within, "{found} is not {expected}");
    }

    #[test]
    fn a_slope_takes_speed_upward_and_gives_it_downward() {
        let motion = MotionConfig { slope_slip: 0.2, ..IDEAL() };
        let tan = libm::tan(0.4);
        for (yaw_rad, speed_m_s, expected_m) in [
            (0.0, 0.5, 0.5 * (1.0 - 0.2 * tan)),
            (PI, 0.5, 0.5 * (1.0 + 0.2 * tan)),
            (PI, -0.5, -0.5 * (1.0 - 0.2 * tan)),
        ] {
            close(driven(motion.clone(), 0.4, yaw_rad, speed_m_s, 0.0, 2.0).1, expected_m, 1e-4);
            close(driven(IDEAL(), 0.4, yaw_rad, speed_m_s, 0.0, 2.0).1, speed_m_s, 1e-4);
        }
    }

    #[test]
    fn along_a_side_slope_the_robot_slides_downhill() {
        let motion = MotionConfig { side_slip: 0.1, ..IDEAL() };
        // To the north the slope's foot is on the left, to the south on the right.
        close(driven(motion.clone(), 0.4, FRAC_PI_2, 0.5, 0.0, 2.0).2, 0.05 * libm::tan(0.4), 1e-4);
        close(driven(motion, 0.4, -FRAC_PI_2, 0.5, 0.0, 2.0).2, -0.05 * libm::tan(0.4), 1e-4);
        close(driven(IDEAL(), 0.4, FRAC_PI_2, 0.5, 0.0, 2.0).2, 0.0, 1e-4);
    }

    #[test]
    fn a_turn_at_27_degrees_slides_a_fifth_of_a_metre_each_radian() {
        let motion = MotionConfig { turn_slide_m_rad: 0.4, ..IDEAL() };
        let turned = |motion: MotionConfig| {
            let ground = slope(27.0 * DEGREE);
            let mut robot =
                Robot::new(RobotConfig::default(), &ground, DVec2::splat(50.0), 60.0 * DEGREE).unwrap();
            robot = robot.with_motion(motion);
            while robot.state().yaw_rad < 120.0 * DEGREE {
                let command = DriveCommand { speed_m_s: 0.0, turn_rate_rad_s: 0.4 };
                robot.step(command, 0.01, &ground).unwrap();
            }
            robot.position() - DVec2::splat(50.0).extend(robot.position().z)
        };
        let slid = turned(motion);
        close(slid.x / (60.0 * DEGREE), -0.2, 0.04);
        assert!(slid.y.abs() < 0.01, "downhill and not along the slope: {slid}");
        close(turned(IDEAL()).x, 0.0, 1e-9);
    }

    #[test]
    fn a_robot_turns_faster_on_a_side_slope_and_by_its_ratio_anywhere() {
        let turn_rate = |motion, slope_rad| {
            let (robot, ..) = driven(motion, slope_rad, FRAC_PI_2, 0.0, 0.1, 0.0);
            robot.state().turn_rate_rad_s
        };
        let motion = MotionConfig { side_slope_turn: 0.75, ..IDEAL() };
        close(turn_rate(motion.clone(), 25.0 * DEGREE) / 0.1, 1.35, 0.02);
        close(turn_rate(motion, 0.0), 0.1, 1e-12);
        close(turn_rate(MotionConfig { turn_ratio: 0.8, ..IDEAL() }, 0.0), 0.08, 1e-12);
    }

    #[test]
    fn friction_ends_a_climb_at_the_slope_of_its_tangent() {
        let wet_grass = || MotionConfig { friction: 0.4, ..IDEAL() };
        // As in the physics engine: 20° but not 30°.
        close(driven(wet_grass(), 20.0 * DEGREE, 0.0, 0.5, 0.0, 3.0).1, 0.5, 1e-3);
        let (robot, ahead_m, _) = driven(wet_grass(), 30.0 * DEGREE, 0.0, 0.5, 0.0, 1.0);
        assert!(ahead_m < 0.0, "it slides back while its wheels turn: {ahead_m}");
        close(robot.wheels().speed_m_s, 0.5, 1e-12);
        close(
            driven(MotionConfig { friction: 0.9, ..IDEAL() }, 38.0 * DEGREE, 0.0, 0.5, 0.0, 3.0).1,
            0.5,
            1e-3,
        );
        // Across the slope it slides aside, and at rest it does not hold.
        assert!(driven(wet_grass(), 30.0 * DEGREE, FRAC_PI_2, 0.3, 0.0, 1.0).2 > 0.1);
        assert!(driven(wet_grass(), 30.0 * DEGREE, 0.0, 0.0, 0.0, 0.0).1 < -0.1);
        close(driven(wet_grass(), 15.0 * DEGREE, 0.0, 0.0, 0.0, 0.0).1, 0.0, 1e-12);
    }

    #[test]
    fn what_slides_accelerates_by_gravity_less_friction() {
        let motion = MotionConfig { friction: 0.3, ..IDEAL() };
        let slope_rad = 30.0 * DEGREE;
        let (robot, ..) = driven(motion, slope_rad, 0.0, 0.0, 0.0, 0.0);
        let net_m_s2 = 9.81 * (libm::sin(slope_rad) - 0.3 * libm::cos(slope_rad));
        close(robot.state().speed_m_s, -net_m_s2, 0.01);
    }

    #[test]
    fn a_load_slows_the_acceleration() {
        let speed = |payload: f64| {
            let (robot, ..) = driven(MotionConfig { payload, ..IDEAL() }, 0.0, 0.0, 1.0, 0.0, 0.0);
            robot.state().speed_m_s
        };
        close(speed(0.0), 1.0, 1e-9);
        close(speed(1.0), 0.5, 1e-9);
    }
}
