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

/// Noise of one seed, quick where places come one after the other: it remembers the lattice cell of the last
/// one.
#[derive(Debug)]
pub struct GradientNoise {
    seed: u64,
    /// Column and row of the cell.
    cell: Option<[i64; 2]>,
    /// Gradients at its south-western, south-eastern, north-western and north-eastern corner.
    gradients: [[f64; 2]; 4],
}

impl GradientNoise {
    /// With nothing remembered.
    pub fn new(seed: u64) -> Self {
        Self { seed, cell: None, gradients: [[0.0; 2]; 4] }
    }

    /// Noise in [-1, 1] with a period of about 1, zero at whole coordinates.
    pub fn at(&mut self, at: DVec2) -> f64 {
        let corner = at.floor();
        let DVec2 { x: u, y: v } = at - corner;
        self.enter([corner.x as i64, corner.y as i64]);
        let [south_west, south_east, north_west, north_east] = self.gradients;
        let slope = |[gx, gy]: [f64; 2], east: f64, north: f64| gx * (u - east) + gy * (v - north);
        let fade = |x: f64| x * x * x * (x * (x * 6.0 - 15.0) + 10.0);
        let (east, north) = (fade(u), fade(v));
        let mix = |west: f64, other: f64| west + (other - west) * east;
        let south_value = mix(slope(south_west, 0.0, 0.0), slope(south_east, 1.0, 0.0));
        let north_value = mix(slope(north_west, 0.0, 1.0), slope(north_east, 1.0, 1.0));
        // Unit gradients give at most 1/sqrt(2), in the middle of a cell.
        (south_value + (north_value - south_value) * north) * std::f64::consts::SQRT_2
    }

    fn enter(&mut self, cell: [i64; 2]) {
        if self.cell == Some(cell) {
            return;
        }
        self.cell = Some(cell);
        self.gradients = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[i, j]| {
            let place = random::key(self.seed, random::key((cell[0] + i) as u64, (cell[1] + j) as u64));
            GRADIENTS[(place >> 60) as usize]
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn bounded_and_continuous(seed in any::<u64>(), x in -1000.0..1000.0f64, y in -1000.0..1000.0f64) {
            let mut noise = GradientNoise::new(seed);
            let here = noise.at(DVec2::new(x, y));
            prop_assert!(here.abs() <= 1.0);
            let step = 1e-6;
            let there = noise.at(DVec2::new(x + step, y - step));
            prop_assert!((here - there).abs() < 1e-5);
        }
    }

    #[test]
    fn varies_and_follows_its_seed() {
        let values = |seed| {
            let mut noise = GradientNoise::new(seed);
            (0..400).map(|i| noise.at(DVec2::new(f64::from(i) * 0.37, 0.41))).collect::<Vec<_>>()
        };
        let one = values(1);
        let deviation = (one.iter().map(|value| value * value).sum::<f64>() / 400.0).sqrt();
        assert!((0.15..0.6).contains(&deviation), "{deviation}");
        assert_eq!(one, values(1));
        assert_ne!(one, values(2));
    }
}
