//! Randomness without state: a value depends only on its counters, so a run can be resumed at any tick and beams can be
//! drawn in any order.

use std::f64::consts::TAU;

/// The odd constant of the Weyl sequence of `SplitMix64`.
const WEYL: u64 = 0x9e37_79b9_7f4a_7c15;

/// The output function of `SplitMix64` (Steele, Lea and Flood, 2014): every bit of the result depends on every bit of `x`.
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

/// A standard normal number, by the method of Box and Muller.
pub fn gaussian(key: u64) -> f64 {
    let radius = (-2.0 * libm::log(uniform(key))).sqrt();
    radius * libm::cos(TAU * uniform(mix(key.wrapping_add(WEYL))))
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
