//! The valid ground filter.

use crate::cloud::{Cloud, SPACING_M};

/// Whether each point of the map is valid: no neighbour within `radius_m` stands above it at more than
/// `slope_rad`.
///
/// Neighbours are those within the radius as seen from above. On steep ground they are further away in space,
/// but the ground between is as steep.
#[must_use]
pub fn valid_ground(cloud: &Cloud, radius_m: f64, slope_rad: f64) -> Vec<bool> {
    let steepest = libm::tan(slope_rad);
    let reach = (radius_m / SPACING_M + 1e-9).floor() as i64;
    let mut neighbours = Vec::new();
    for row in -reach..=reach {
        for column in -reach..=reach {
            let distance_m = SPACING_M * ((row * row + column * column) as f64).sqrt();
            if distance_m > 0.0 && distance_m <= radius_m + 1e-9 {
                neighbours.push((column, row, distance_m * steepest));
            }
        }
    }
    let columns = cloud.columns();
    let rises = |index: usize, height_m: f64| {
        let (column, row) = ((index % columns) as i64, (index / columns) as i64);
        neighbours.iter().any(|&(across, up, most_m)| {
            cloud
                .height_m(column + across, row + up)
                .is_some_and(|neighbour_m| neighbour_m - height_m > most_m)
        })
    };
    cloud.heights_m().iter().enumerate().map(|(index, &height_m)| !rises(index, height_m)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::field;
    use proptest::prelude::*;

    fn kept(height_m: impl Fn(glam::DVec2) -> f64) -> Vec<bool> {
        valid_ground(&Cloud::new(&field(4.0, height_m)).unwrap(), 0.3, 0.4)
    }

    #[test]
    fn the_foot_of_a_step_goes_and_its_edge_stays() {
        // Level up to x = 2, then up half a metre by x = 2.2.
        let kept = kept(|place| if place.x < 2.1 { 0.0 } else { 0.5 });
        let row = &kept[20 * 41..21 * 41];
        for (column, &kept) in row.iter().enumerate() {
            // The face spans columns 20 to 22; points up to 0.3 m before it have steep neighbours.
            assert_eq!(kept, !(18..22).contains(&column), "column {column}");
        }
    }

    proptest! {
        #[test]
        fn a_plane_stays_up_to_the_slope_and_goes_above_it(slope in 0.0..0.8f64, turn in 0.0..core::f64::consts::TAU) {
            prop_assume!((slope - 0.4).abs() > 0.02);
            let (sin, cos) = libm::sincos(turn);
            let gradient = glam::DVec2::new(cos, sin) * libm::tan(slope);
            let kept = kept(|place| gradient.dot(place));
            // In the middle, away from the border: some neighbour lies within 10° of straight up the slope.
            let expected = slope < 0.4;
            let steep = libm::atan(libm::tan(slope) * libm::cos(0.18)) > 0.4;
            if expected || steep {
                prop_assert_eq!(kept[20 * 41 + 20], expected);
            }
        }
    }
}
