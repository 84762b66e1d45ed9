//! The plane through the ground around a place, by least squares.

use glam::{DVec2, DVec3};
use nalgebra::{Matrix2, Vector2};

/// A plane whose slope has a larger standard deviation than this is refused.
const LARGEST_SLOPE_DEVIATION: f64 = 0.08;
/// Fewest points of a plane.
const FEWEST_POINTS: usize = 5;
/// Smallest roughness: sensor noise and averaging within a cell.
const LEAST_ROUGHNESS_M: f64 = 0.02;

/// A plane through ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Height at the place asked for, metres.
    pub height_m: f64,
    /// (dz/dx, dz/dy).
    pub gradient: DVec2,
    /// Standard deviation of the gradient in its least certain direction.
    pub gradient_deviation: f64,
}

impl Plane {
    /// The least-squares plane through `points_m`, with its height at `place_m`; `None` if they leave the
    /// slope too uncertain. Over `wheels_m`, the distance between wheels, roughness becomes tilt.
    pub fn fit(place_m: DVec2, points_m: &[DVec3], wheels_m: f64) -> Option<Self> {
        let mut moments = Moments::default();
        for point_m in points_m {
            moments.add(point_m.truncate() - place_m, point_m.z);
        }
        moments.plane(wheels_m)
    }
}

/// Sums over points, about the place asked for and the height of the first of them.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Moments {
    count: usize,
    datum_m: f64,
    sum: DVec3,
    xx: f64,
    xy: f64,
    yy: f64,
    xz: f64,
    yz: f64,
    zz: f64,
    nearest_squared: f64,
}

impl Moments {
    pub(crate) fn add(&mut self, from_place_m: DVec2, height_m: f64) {
        let squared = from_place_m.length_squared();
        if self.count == 0 {
            self.datum_m = height_m;
            self.nearest_squared = squared;
        }
        self.nearest_squared = self.nearest_squared.min(squared);
        self.count += 1;
        let d = from_place_m.extend(height_m - self.datum_m);
        self.sum += d;
        self.xx += d.x * d.x;
        self.xy += d.x * d.y;
        self.yy += d.y * d.y;
        self.xz += d.x * d.z;
        self.yz += d.y * d.z;
        self.zz += d.z * d.z;
    }

    /// Distance of the place from the points: from the nearest one, or from their mean.
    pub(crate) fn distance_m(&self) -> f64 {
        let middle = self.sum.truncate() / (self.count as f64).max(1.0);
        middle.length().max(self.nearest_squared.sqrt())
    }

    /// The plane with its height at the place, for this distance between wheels.
    pub(crate) fn plane(&self, wheels_m: f64) -> Option<Plane> {
        if self.count < FEWEST_POINTS {
            return None;
        }
        let count = self.count as f64;
        let centroid = self.sum / count;
        let about_centroid = |sum: f64, a: f64, b: f64| sum - a * b * count;
        let xx = about_centroid(self.xx, centroid.x, centroid.x);
        let xy = about_centroid(self.xy, centroid.x, centroid.y);
        let yy = about_centroid(self.yy, centroid.y, centroid.y);
        let xz = about_centroid(self.xz, centroid.x, centroid.z);
        let yz = about_centroid(self.yz, centroid.y, centroid.z);
        let zz = about_centroid(self.zz, centroid.z, centroid.z);
        let spread = Matrix2::new(xx, xy, xy, yy);
        let least_spread = spread.symmetric_eigenvalues().min();
        // Points in a line, such as those of a single ring, do not constrain the slope across it.
        let least_variance = LEAST_ROUGHNESS_M * LEAST_ROUGHNESS_M;
        if least_spread * LARGEST_SLOPE_DEVIATION * LARGEST_SLOPE_DEVIATION < least_variance {
            return None;
        }
        let solved = spread.cholesky()?.solve(&Vector2::new(xz, yz));
        let gradient = DVec2::new(solved.x, solved.y);
        let unexplained = (zz - gradient.x * xz - gradient.y * yz).max(0.0) / (count - 2.0);
        // Residuals lift single wheels.
        let rough_m = (unexplained - least_variance).max(0.0).sqrt();
        let standard_error = (unexplained.max(least_variance) / least_spread).sqrt();
        Some(Plane {
            height_m: self.datum_m + centroid.z - gradient.dot(centroid.truncate()),
            gradient,
            gradient_deviation: libm::hypot(standard_error, rough_m / wheels_m),
        })
    }
}
