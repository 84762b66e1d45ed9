//! Angles on the circle.

use core::f64::consts::{PI, TAU};

/// Wraps an angle to [-π, π).
///
/// ```
/// use std::f64::consts::PI;
/// assert!((mapless::math::angle::wrap_rad(1.5 * PI) + 0.5 * PI).abs() < 1e-12);
/// assert_eq!(mapless::math::angle::wrap_rad(PI), -PI);
/// ```
pub fn wrap_rad(angle_rad: f64) -> f64 {
    let wrapped = angle_rad - TAU * ((angle_rad + PI) / TAU).floor();
    // Rounding can land exactly on the excluded end.
    if wrapped >= PI { wrapped - TAU } else { wrapped }
}

/// The shortest rotation from `from_rad` to `to_rad`, in [-π, π).
pub fn difference_rad(to_rad: f64, from_rad: f64) -> f64 {
    wrap_rad(to_rad - from_rad)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn wrapping_keeps_the_direction_and_the_range(angle in -1e4..1e4_f64) {
            let wrapped = wrap_rad(angle);
            prop_assert!((-PI..PI).contains(&wrapped));
            prop_assert!((libm::sin(wrapped) - libm::sin(angle)).abs() < 1e-9);
            prop_assert!((libm::cos(wrapped) - libm::cos(angle)).abs() < 1e-9);
        }

        #[test]
        fn difference_undoes_addition(a in -PI..PI, d in -3.1..3.1_f64) {
            prop_assert!((difference_rad(a + d, a) - d).abs() < 1e-12);
        }
    }
}
