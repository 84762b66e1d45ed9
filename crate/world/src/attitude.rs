//! The attitude of a rigid body on four wheels on the ground.

use crate::ground::Ground;
use crate::robot_config::RobotConfig;
use glam::{DMat3, DVec2, DVec3};

/// Height and tilt of a body that rests on its four wheel contacts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Attitude {
    /// World height of the contact plane below the middle of the body, in metres.
    pub height_m: f64,
    /// Roll in radians, positive with the left side up.
    pub roll_rad: f64,
    /// Pitch in radians, positive nose-up.
    pub pitch_rad: f64,
}

/// The contacts move with the tilt and the tilt with the contacts. On a plane the first iteration is exact;
/// on ground curved at the scale of the wheelbase four iterations leave less than a milliradian.
const ROUNDS: usize = 4;

/// The attitude of a Husky at `position` with heading `yaw_rad`; `None` if a wheel is off the terrain.
///
/// The contact plane is the least-squares plane through the four points of the ground under the wheels.
#[must_use]
pub fn attitude_on(
    footing: &impl Ground,
    position: DVec2,
    yaw_rad: f64,
    config: &RobotConfig,
) -> Option<Attitude> {
    let (sin_yaw, cos_yaw) = libm::sincos(yaw_rad);
    let mut attitude = Attitude::default();
    for _ in 0..ROUNDS {
        let (sin_pitch, cos_pitch) = libm::sincos(attitude.pitch_rad);
        let (sin_roll, cos_roll) = libm::sincos(attitude.roll_rad);
        // Half the wheelbase and half the track as seen from above, x along the heading.
        let ahead = DVec2::new(cos_pitch, 0.0) * (config.wheelbase_m / 2.0);
        let aside = DVec2::new(-sin_pitch * sin_roll, cos_roll) * (config.track_m / 2.0);
        let ground = |offset: DVec2| {
            let turned =
                DVec2::new(offset.x * cos_yaw - offset.y * sin_yaw, offset.x * sin_yaw + offset.y * cos_yaw);
            footing.height_m(position + turned)
        };
        let front_left = ground(ahead + aside)?;
        let front_right = ground(ahead - aside)?;
        let rear_left = ground(aside - ahead)?;
        let rear_right = ground(-ahead - aside)?;
        // The four offsets are ±ahead ± aside, so the normal equations of the plane fall apart into these
        // differences.
        let rise_ahead = (front_left + front_right - rear_left - rear_right) / 4.0;
        let rise_aside = (front_left - front_right + rear_left - rear_right) / 4.0;
        let slope_ahead = rise_ahead / ahead.x;
        let slope_aside = (rise_aside - slope_ahead * aside.x) / aside.y;
        let pitch_rad = libm::atan(slope_ahead);
        attitude = Attitude {
            height_m: (front_left + front_right + rear_left + rear_right) / 4.0,
            roll_rad: libm::atan(slope_aside * libm::cos(pitch_rad)),
            pitch_rad,
        };
    }
    Some(attitude)
}

/// Rotation from the robot frame to the world: yaw, then pitch, then roll.
#[must_use]
pub fn world_from_body(yaw_rad: f64, attitude: &Attitude) -> DMat3 {
    let (sy, cy) = libm::sincos(yaw_rad);
    let (sp, cp) = libm::sincos(attitude.pitch_rad);
    let (sr, cr) = libm::sincos(attitude.roll_rad);
    let turned = |x: f64, y: f64, z: f64| DVec3::new(x * cy - y * sy, x * sy + y * cy, z);
    let forward = turned(cp, 0.0, sp);
    let left = turned(-sp * sr, cr, cp * sr);
    let up = turned(-sp * cr, -sr, cp * cr);
    DMat3::from_cols(forward, left, up)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::height_field::HeightField;
    use proptest::prelude::*;

    fn plane(dzdx: f64, dzdy: f64) -> HeightField {
        let heights = (0..81 * 81)
            .map(|i| (5.0 + (f64::from(i % 81) * dzdx + f64::from(i / 81) * dzdy) * 0.125) as f32)
            .collect();
        HeightField::new(81, 81, 0.125, heights).unwrap()
    }

    #[test]
    fn signs_follow_the_conventions() {
        let config = RobotConfig::default();
        let at = DVec2::new(5.0, 5.0);
        let uphill_east = plane(0.5, 0.0);
        let facing_east = attitude_on(&uphill_east, at, 0.0, &config).unwrap();
        assert!(facing_east.pitch_rad > 0.4 && facing_east.roll_rad.abs() < 1e-5, "nose up: {facing_east:?}");
        let facing_south = attitude_on(&uphill_east, at, -std::f64::consts::FRAC_PI_2, &config).unwrap();
        assert!(
            facing_south.roll_rad > 0.4 && facing_south.pitch_rad.abs() < 1e-5,
            "left side up: {facing_south:?}"
        );
    }

    #[test]
    fn a_wheel_over_the_border_has_no_attitude() {
        let config = RobotConfig::default();
        let field = plane(0.0, 0.0);
        assert!(attitude_on(&field, DVec2::new(0.3, 5.0), 0.0, &config).is_some());
        assert!(attitude_on(&field, DVec2::new(0.2, 5.0), 0.0, &config).is_none());
    }

    proptest! {
        #[test]
        fn on_a_plane_the_body_axes_lie_in_it(
            dzdx in -1.0..1.0f64, dzdy in -1.0..1.0f64, yaw_rad in -3.2..3.2f64,
        ) {
            let attitude = attitude_on(&plane(dzdx, dzdy), DVec2::new(5.0, 5.0), yaw_rad, &RobotConfig::default()).unwrap();
            let rotation = world_from_body(yaw_rad, &attitude);
            let normal = DVec3::new(-dzdx, -dzdy, 1.0).normalize();
            // The samples are f32, so the plane is one to about a micrometre.
            prop_assert!(rotation.z_axis.distance(normal) < 1e-4, "{:?} {normal:?}", rotation.z_axis);
            prop_assert!((attitude.height_m - (5.0 + 5.0 * (dzdx + dzdy))).abs() < 1e-4);
        }

        #[test]
        fn rotation_is_proper_and_keeps_the_heading(
            yaw_rad in -3.2..3.2f64, pitch_rad in -1.5..1.5f64, roll_rad in -1.5..1.5f64,
        ) {
            let rotation = world_from_body(yaw_rad, &Attitude { height_m: 0.0, roll_rad, pitch_rad });
            let identity = rotation.transpose() * rotation;
            prop_assert!((identity - DMat3::IDENTITY).to_cols_array().iter().all(|e| e.abs() < 1e-12));
            prop_assert!((rotation.determinant() - 1.0).abs() < 1e-12);
            let forward = rotation.x_axis;
            prop_assert!((forward.z - libm::sin(pitch_rad)).abs() < 1e-12);
            let heading = libm::atan2(forward.y, forward.x);
            prop_assert!(libm::cos(heading - yaw_rad) > 1.0 - 1e-9);
            prop_assert!(rotation.y_axis.z * roll_rad >= 0.0, "left side up");
        }
    }
}
