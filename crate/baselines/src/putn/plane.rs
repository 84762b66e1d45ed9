//! The plane through the ground around a place, and its traversability.

use glam::{DVec2, DVec3};
use nalgebra::Matrix3;

use crate::cloud::{Cloud, SPACING_M};

/// How planes are fitted and rated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneConfig {
    /// Half the side of the square of ground that a plane is fitted to, metres.
    pub radius_m: f64,
    /// Ground further above or below the place than this does not belong to its plane, metres.
    pub height_m: f64,
    /// Weight of the flatness, per m⁴.
    pub flatness_weight: f64,
    /// Weight of the slope, per degree.
    pub slope_weight: f64,
    /// Weight of the sparsity.
    pub sparsity_weight: f64,
    /// The sparsity rises from 0 to 1 between these shares of the square without ground.
    pub sparse_share: [f64; 2],
    /// Height of the robot's centre above the plane, metres.
    pub centre_height_m: f64,
}

impl Default for PlaneConfig {
    fn default() -> Self {
        Self {
            radius_m: 0.5,
            height_m: 0.35,
            flatness_weight: 1000.0,
            slope_weight: 0.1,
            sparsity_weight: 1.0,
            sparse_share: [0.02, 0.05],
            centre_height_m: 0.7,
        }
    }
}

/// The plane around a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FittedPlane {
    /// The place on the ground, in the world.
    pub place_m: DVec3,
    /// Upward unit normal.
    pub normal: DVec3,
    /// Mean fourth power of the distance of the ground from the plane, m⁴.
    pub flatness_m4: f64,
    /// Inclination of the plane.
    pub slope_rad: f64,
    /// 0 if there is ground everywhere, 1 if much is missing.
    pub sparsity: f64,
}

impl FittedPlane {
    /// The traversability τ, weighted flatness, slope and sparsity: 0 is easy, 1 hardest.
    #[must_use]
    pub fn traversability(&self, config: &PlaneConfig) -> f64 {
        let sum = config.flatness_weight * self.flatness_m4
            + config.slope_weight * self.slope_rad.to_degrees()
            + config.sparsity_weight * self.sparsity;
        sum.min(1.0)
    }
}

/// Fits the plane around a place seen from above; `None` off the map and if there is next to no ground.
#[must_use]
pub fn fit_plane(cloud: &Cloud, plan_m: DVec2, config: &PlaneConfig) -> Option<FittedPlane> {
    let (column, row) = cloud.nearest(plan_m);
    let height_m = cloud.height_m(column, row)?;
    let reach = (config.radius_m / SPACING_M + 1e-9).floor() as i64;
    let square = (-reach..=reach).flat_map(|up| (-reach..=reach).map(move |across| (across, up)));
    // Relative to the place.
    let ground = square.clone().filter_map(|(across, up)| {
        let rise_m = cloud.height_m(column + across, row + up)? - height_m;
        let point = DVec3::new(across as f64 * SPACING_M, up as f64 * SPACING_M, rise_m);
        (rise_m.abs() <= config.height_m).then_some(point)
    });
    let (count, sum) = ground.clone().fold((0, DVec3::ZERO), |(count, sum), point| (count + 1, sum + point));
    let (count, all) = (f64::from(count), square.count() as f64);
    let centre = sum / count;
    let mut moments = Matrix3::<f64>::zeros();
    for point in ground.clone() {
        let d = (point - centre).to_array();
        for (i, j) in [(0, 0), (1, 0), (2, 0), (1, 1), (2, 1), (2, 2)] {
            moments[(i, j)] += d[i] * d[j];
            moments[(j, i)] = moments[(i, j)];
        }
    }
    let eigen = moments.symmetric_eigen();
    let least = eigen.eigenvectors.column(eigen.eigenvalues.imin());
    let normal = DVec3::new(least[0], least[1], least[2]);
    let normal = if normal.z < 0.0 { -normal } else { normal };
    if count < 3.0 || !normal.is_finite() {
        return None;
    }
    let fourth_powers = ground.map(|point| {
        let squared = normal.dot(point - centre) * normal.dot(point - centre);
        squared * squared
    });
    let [none, full] = config.sparse_share;
    Some(FittedPlane {
        place_m: plan_m.extend(height_m),
        normal,
        flatness_m4: fourth_powers.sum::<f64>() / (1.0 + count),
        slope_rad: libm::acos(normal.z.min(1.0)),
        sparsity: ((1.0 - count / all - none) / (full - none)).clamp(0.0, 1.0),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::field;
    use proptest::prelude::*;

    fn plane(height_m: impl Fn(DVec2) -> f64) -> FittedPlane {
        let cloud = Cloud::new(&field(6.0, height_m)).unwrap();
        fit_plane(&cloud, DVec2::splat(3.0), &PlaneConfig::default()).unwrap()
    }

    #[test]
    fn traversability_by_hand() {
        let config = PlaneConfig::default();
        let of = |flatness_m4, slope_deg: f64, sparsity| {
            FittedPlane {
                place_m: DVec3::ZERO,
                normal: DVec3::Z,
                flatness_m4,
                slope_rad: slope_deg.to_radians(),
                sparsity,
            }
            .traversability(&config)
        };
        // 1000 · 0.0001 + 0.1 · 4 + 0.3 = 0.8.
        assert!((of(1e-4, 4.0, 0.3) - 0.8).abs() < 1e-12);
        assert_eq!(of(0.0, 0.0, 0.0), 0.0);
        // Ten degrees have the largest cost.
        assert!((of(0.0, 9.0, 0.0) - 0.9).abs() < 1e-12);
        assert_eq!(of(0.0, 11.0, 0.0), 1.0);
    }

    #[test]
    fn a_ridge_has_the_flatness_of_its_fourth_powers() {
        // z = 0.2 |x - 3|: the mean of 0.2 |x| over eleven columns is 0.6 / 11; sums over them by hand.
        let ridge = plane(|place| 0.2 * (place.x - 3.0).abs());
        let mean: f64 = (0..11).map(|k| 0.02 * f64::from(k - 5).abs()).sum::<f64>() / 11.0;
        let sum: f64 =
            (0..11).map(|k| 0.02 * f64::from(k - 5).abs() - mean).map(|d| 11.0 * d * d * d * d).sum();
        // 0.2 m between samples of the ground: on odd columns the ridge is as high as between two samples.
        assert!((ridge.flatness_m4 - sum / 122.0).abs() < 0.05 * sum / 122.0);
        assert!(ridge.slope_rad < 1e-6);
        assert_eq!(ridge.sparsity, 0.0);
    }

    #[test]
    fn an_edge_is_sparse_and_beyond_the_border_is_nothing() {
        let edge = plane(|place| if place.x < 3.3 { 0.0 } else { -2.0 });
        assert_eq!(edge.sparsity, 1.0);
        assert!(edge.slope_rad < 0.05);
        let cloud = Cloud::new(&field(6.0, |_| 0.0)).unwrap();
        let at = |x, y| fit_plane(&cloud, DVec2::new(x, y), &PlaneConfig::default());
        assert_eq!(at(3.0, 6.2), None);
        assert_eq!(at(3.0, 6.0).unwrap().sparsity, 1.0);
        assert_eq!(at(3.0, 5.0).unwrap().sparsity, 0.0);
    }

    proptest! {
        #[test]
        fn a_plane_is_found_again(slope in 0.0..0.5f64, turn in 0.0..core::f64::consts::TAU) {
            let (sin, cos) = libm::sincos(turn);
            let gradient = DVec2::new(cos, sin) * libm::tan(slope);
            let found = plane(|place| gradient.dot(place));
            // The steepest ones leave the corners out, evenly.
            prop_assert!((found.slope_rad - slope).abs() < 1e-4);
            prop_assert!(found.flatness_m4 < 1e-12);
            prop_assert!(found.normal.truncate().dot(gradient) <= 0.0);
        }
    }
}
