//! Seeded gradient noise (Perlin, "Improving noise", 2002) with the same bits on every target.

use crate::random;
use glam::DVec2;

/// Sixteen unit gradients, (cosine, sine) of multiples of 22.5°.
const GRADIENTS: [[f64; 2]; 16] = {
    const A: f64 = 0.923_879_532_511_286_7;
    const B: f64 = std::f64::consts::FRAC_1_SQRT_2;
    const C: f64 = 0.382_683_432_365_089_8;
    [
        [1.0, 0.0],
        [A, C],
        [B, B],
        [C, A],
        [0.0, 1.0],
        [-C, A],
        [-B, B],
        [-A, C],
        [-1.0, 0.0],
        [-A, -C],
        [-B, -B],
        [-C, -A],
        [0.0, -1.0],
        [C, -A],
        [B, -B],
        [A, -C],
    ]
};

/// Noise in [-1, 1] with a period of about 1, zero at whole coordinates.
pub(crate) fn gradient_noise(seed: u64, at: DVec2) -> f64 {
    let cell = at.floor();
    let DVec2 { x: u, y: v } = at - cell;
    let (column, row) = (cell.x as i64, cell.y as i64);
    let corner = |i: i64, j: i64| {
        let place = random::key(seed, random::key((column + i) as u64, (row + j) as u64));
        let [gx, gy] = GRADIENTS[(place >> 60) as usize];
        gx * (u - i as f64) + gy * (v - j as f64)
    };
    let fade = |x: f64| x * x * x * (x * (x * 6.0 - 15.0) + 10.0);
    let (east, north) = (fade(u), fade(v));
    let south_value = corner(0, 0) + (corner(1, 0) - corner(0, 0)) * east;
    let north_value = corner(0, 1) + (corner(1, 1) - corner(0, 1)) * east;
    // Unit gradients give at most 1/sqrt(2), in the middle of a cell.
    (south_value + (north_value - south_value) * north) * std::f64::consts::SQRT_2
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn bounded_and_continuous(seed in any::<u64>(), x in -1000.0..1000.0f64, y in -1000.0..1000.0f64) {
            let here = gradient_noise(seed, DVec2::new(x, y));
            prop_assert!(here.abs() <= 1.0);
            let step = 1e-6;
            let there = gradient_noise(seed, DVec2::new(x + step, y - step));
            prop_assert!((here - there).abs() < 1e-5);
        }
    }

    #[test]
    fn varies_and_follows_its_seed() {
        let values = |seed| {
            (0..400).map(|i| gradient_noise(seed, DVec2::new(f64::from(i) * 0.37, 0.41))).collect::<Vec<_>>()
        };
        let one = values(1);
        let deviation = (one.iter().map(|value| value * value).sum::<f64>() / 400.0).sqrt();
        assert!((0.15..0.6).contains(&deviation), "{deviation}");
        assert_eq!(one, values(1));
        assert_ne!(one, values(2));
    }
}
