//! The intersection of a ray with one bilinear patch.

use super::GridRay;
use crate::height_field::HeightField;

/// The first parameter in `begin..=exit` at which the ray is on or below the patch of `cell`.
///
/// The clearance of the ray above the patch is a quadratic `a s² + b s + c` of the distance `s` since
/// `begin`. A ray that has slipped below the ground by a rounding error at the edge of two cells meets it at
/// `begin`, so the surface has no cracks.
pub(super) fn first_meeting(
    field: &HeightField,
    ray: &GridRay,
    cell: [u32; 2],
    begin: f64,
    exit: f64,
) -> Option<f64> {
    let patch = field.patch(cell[0] as usize, cell[1] as usize);
    let [u, v] = ray.within(cell, begin);
    let [du, dv] = ray.step;
    let c = ray.z_m + ray.z_step * begin - patch.height(u, v);
    if c <= 0.0 {
        return Some(begin);
    }
    let b = ray.z_step - patch.along_u * du - patch.along_v * dv - patch.twist * (u * dv + v * du);
    let a = -patch.twist * du * dv;
    let s = first_positive_root(a, b, c)?;
    (s <= exit - begin).then_some(begin + s)
}

/// The smallest positive root of `a s² + b s + c` for `c > 0`, without cancellation and for any `a`, zero
/// included.
fn first_positive_root(a: f64, b: f64, c: f64) -> Option<f64> {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    if b < 0.0 {
        Some(2.0 * c / (root - b))
    } else if a < 0.0 {
        Some((b + root) / (-2.0 * a))
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::first_positive_root;
    use proptest::prelude::*;

    #[test]
    fn degenerate_quadratics() {
        assert_eq!(first_positive_root(0.0, -2.0, 1.0), Some(0.5));
        assert_eq!(first_positive_root(0.0, 0.0, 1.0), None);
        assert_eq!(first_positive_root(0.0, 1.0, 1.0), None);
        assert_eq!(first_positive_root(1.0, -2.0, 1.0), Some(1.0));
        assert_eq!(first_positive_root(1.0, 2.0, 1.0), None);
        let nearly_linear = first_positive_root(1e-18, -2.0, 1.0).unwrap();
        assert!((nearly_linear - 0.5).abs() < 1e-15);
    }

    proptest! {
        #[test]
        fn finds_the_smaller_of_two_positive_roots(first in 0.01..10.0f64, gap in 0.0..10.0f64, a in 0.01..5.0f64) {
            let second = first + gap;
            // A double root may vanish by rounding; a real gap must not.
            prop_assume!(gap > 1e-6);
            let found = first_positive_root(a, -a * (first + second), a * first * second).unwrap();
            prop_assert!((found - first).abs() < 1e-7, "{found} {first}");
        }

        #[test]
        fn finds_the_positive_one_of_two_signs(positive in 0.01..10.0f64, negative in 0.01..10.0f64, a in 0.01..5.0f64) {
            let found = first_positive_root(-a, a * (positive - negative), a * positive * negative).unwrap();
            prop_assert!((found - positive).abs() < 1e-9);
        }
    }
}
