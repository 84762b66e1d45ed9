//! Randomness without state: a value depends only on its counters, so a run can be resumed at any tick and
//! beams can be drawn in any order.

use std::f64::consts::PI;
use std::sync::LazyLock;

/// The odd constant of the Weyl sequence of `SplitMix64`.
const WEYL: u64 = 0x9e37_79b9_7f4a_7c15;

/// The output function of `SplitMix64` (Steele, Lea and Flood, 2014): every bit of the result depends on
/// every bit of `x`.
fn mix(x: u64) -> u64 {
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// A key for the pair (a, b).
pub fn key(a: u64, b: u64) -> u64 {
    mix(mix(a.wrapping_add(WEYL)).wrapping_add(b.wrapping_mul(WEYL)))
}

/// A number in (0, 1], never 0 so that its logarithm exists.
pub fn uniform(key: u64) -> f64 {
    ((key >> 11) + 1) as f64 * (1.0 / (1u64 << 53) as f64)
}

/// Layers of equal area that cover the right half of the normal density.
const LAYERS: usize = 256;
/// Where the lowest layer's tail begins, for this number of layers.
const TAIL: f64 = 3.654_152_885_361_009;
/// The right edges of the layers from the lowest up, the first as if its tail were part of the rectangle, and
/// a last one of 0.
static EDGES: LazyLock<[f64; LAYERS + 1]> = LazyLock::new(|| {
    let area = TAIL * density(TAIL) + (PI / 2.0).sqrt() * libm::erfc(TAIL / 2.0f64.sqrt());
    let mut edges = [0.0; LAYERS + 1];
    edges[0] = area / density(TAIL);
    edges[1] = TAIL;
    for layer in 2..LAYERS {
        let below = edges[layer - 1];
        edges[layer] = (-2.0 * libm::log(area / below + density(below))).sqrt();
    }
    edges
});

/// The normal density, scaled to 1 at 0.
fn density(x: f64) -> f64 {
    libm::exp(-0.5 * x * x)
}

/// A standard normal number, by the ziggurat method (Marsaglia and Tsang, 2000): nearly always a point in a
/// rectangle under the density, otherwise one drawn in what the rectangles leave out. The layer and the place
/// in it come from different bits (Doornik, 2005).
pub fn gaussian(key: u64) -> f64 {
    let edges = &*EDGES;
    let mut key = key;
    loop {
        let layer = key as usize % LAYERS;
        let sign_and_share = 2.0 * uniform(key) - 1.0;
        let x = sign_and_share * edges[layer];
        if x.abs() < edges[layer + 1] {
            return x;
        }
        let mut next = || {
            // Backwards, so that these are not the numbers of `key`.
            key = mix(key.wrapping_sub(WEYL));
            uniform(key)
        };
        if layer == 0 {
            loop {
                let beyond = -libm::log(next()) / TAIL;
                if -2.0 * libm::log(next()) > beyond * beyond {
                    return (TAIL + beyond).copysign(x);
                }
            }
        }
        let (low, high) = (density(edges[layer]), density(edges[layer + 1]));
        if low + (high - low) * next() < density(x) {
            return x;
        }
        next();
    }
}

/// Numbers in order, where what is drawn decides what is drawn next.
#[derive(Clone, Debug)]
pub struct Sequence {
    key: u64,
    drawn: u64,
}

impl Sequence {
    /// The sequence of a key.
    pub fn new(key: u64) -> Self {
        Self { key, drawn: 0 }
    }

    /// The next number in (0, 1].
    pub fn share(&mut self) -> f64 {
        self.drawn += 1;
        uniform(key(self.key, self.drawn))
    }

    /// The next number between `low` and `high`.
    pub fn between(&mut self, [low, high]: [f64; 2]) -> f64 {
        low + (high - low) * self.share()
    }

    /// The next whole number from `low` to `high`, both included; `low` when `high` is less.
    pub fn whole(&mut self, [low, high]: [u32; 2]) -> u32 {
        let count = f64::from(high.saturating_sub(low)) + 1.0;
        // The share may be 1.
        low + ((self.share() * count) as u32).min(high.saturating_sub(low))
    }

    /// Whether something of this probability happens.
    pub fn happens(&mut self, probability: f64) -> bool {
        self.share() <= probability
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_and_bounds() {
        let count = 100_000;
        let (mut sum, mut squares, mut uniforms) = (0.0, 0.0, 0.0);
        for beam in 0..count {
            let number = gaussian(key(7, beam));
            sum += number;
            squares += number * number;
            let share = uniform(key(8, beam));
            assert!(share > 0.0 && share <= 1.0);
            uniforms += share;
        }
        let count = count as f64;
        assert!((sum / count).abs() < 0.01, "mean {}", sum / count);
        assert!((squares / count - 1.0).abs() < 0.02, "variance {}", squares / count);
        assert!((uniforms / count - 0.5).abs() < 0.005);
        assert!(gaussian(0).is_finite() && gaussian(u64::MAX).is_finite());
    }

    #[test]
    fn gaussian_numbers_exceed_every_bound_as_often_as_they_should() {
        let count = 2_000_000;
        let numbers: Vec<f64> = (0..count).map(|beam| gaussian(key(9, beam))).collect();
        for bound in [0.01, 0.1, 0.3, 0.7, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, TAIL, 3.8, 4.2] {
            let share = libm::erfc(bound / 2.0f64.sqrt()) / 2.0;
            let expected = share * count as f64;
            let deviation = (expected * (1.0 - share)).sqrt();
            let above = numbers.iter().filter(|number| **number > bound).count() as f64;
            let below = numbers.iter().filter(|number| **number < -bound).count() as f64;
            assert!((above - expected).abs() < 4.0 * deviation, "{bound}: {above} of {expected}");
            assert!((below - expected).abs() < 4.0 * deviation, "-{bound}: {below} of {expected}");
        }
    }

    #[test]
    fn layers_shrink_to_the_peak_and_have_equal_areas() {
        let area = |layer: usize| EDGES[layer] * (density(EDGES[layer + 1]) - density(EDGES[layer]));
        for layer in 1..LAYERS {
            assert!(EDGES[layer + 1] < EDGES[layer]);
            assert!((area(layer) / area(1) - 1.0).abs() < 1e-9, "{layer}: {}", area(layer));
        }
    }

    #[test]
    fn neighbouring_keys_share_nothing() {
        let agreeing = |a: u64, b: u64| (a ^ b).count_zeros();
        for i in 0..1000 {
            assert!((10..=54).contains(&agreeing(key(i, 0), key(i + 1, 0))));
            assert!((10..=54).contains(&agreeing(key(0, i), key(0, i + 1))));
        }
    }

    #[test]
    fn sequences_cover_their_ranges_and_repeat() {
        let draw = |key| {
            let mut sequence = Sequence::new(key);
            (0..1000).map(|_| sequence.whole([3, 6])).collect::<Vec<_>>()
        };
        let numbers = draw(5);
        for number in 3..=6 {
            assert!((200..300).contains(&numbers.iter().filter(|&&n| n == number).count()), "{number}");
        }
        assert_eq!(numbers, draw(5));
        assert_ne!(numbers, draw(6));
        let mut sequence = Sequence::new(1);
        assert!((0..1000).all(|_| (-2.0..=5.0).contains(&sequence.between([-2.0, 5.0]))));
        assert!((200..300).contains(&(0..1000).filter(|_| sequence.happens(0.25)).count()));
        assert_eq!(sequence.whole([4, 2]), 4);
    }
}
