//! Logarithm and exponential for eight numbers at once, from additions, multiplications and bit patterns
//! only: the same bits on every target, and vectorised by the compiler where `libm` is a call for each
//! number.

/// Numbers handled together: two AVX2 registers, four of wasm.
pub(crate) const LANES: usize = 8;

/// Added to a small whole number, leaves it in the low bits of the sum.
const SHIFT: f64 = 6_755_399_441_055_744.0;
/// 2⁵², whose bit pattern carries a whole number in its low bits.
const TWO_52: f64 = 4_503_599_627_370_496.0;
/// ln 2 in two parts, as in fdlibm: the first has trailing zeros, so that its small multiples are exact.
const LN_2_HIGH: f64 = f64::from_bits(0x3fe6_2e42_fee0_0000);
const LN_2_LOW: f64 = f64::from_bits(0x3dea_39ef_3579_3c76);
/// Half of the mantissa's range, so that the reduced number lies between √½ and √2.
const SQRT_HALF_BITS: u64 = 0x3fe6_a09e_667f_3bcd;

/// ln x of normal positive numbers, within 2 units in the last place (fdlibm's `log`, by Sun Microsystems).
#[inline(always)]
pub(crate) fn ln(x: [f64; LANES]) -> [f64; LANES] {
    let mut out = [0.0; LANES];
    for lane in 0..LANES {
        let bits = x[lane].to_bits();
        // x = 2ᵏ (1 + f): the exponent above √½'s, kept in the low bits of 2⁵² with an offset that makes it
        // positive.
        let above = bits.wrapping_sub(SQRT_HALF_BITS).wrapping_add(1024 << 52) >> 52;
        let k = f64::from_bits(above | TWO_52.to_bits()) - (TWO_52 + 1024.0);
        let f = f64::from_bits(bits.wrapping_sub(above.wrapping_sub(1024) << 52)) - 1.0;
        let s = f / (2.0 + f);
        let z = s * s;
        let w = z * z;
        let even =
            w * (0.399_999_999_994_094_2 + w * (0.222_221_984_321_497_84 + w * 0.153_138_376_992_093_73));
        let odd = z
            * (0.666_666_666_666_673_5
                + w * (0.285_714_287_436_623_9
                    + w * (0.181_835_721_616_180_5 + w * 0.147_981_986_051_165_86)));
        let half_square = 0.5 * f * f;
        out[lane] = k * LN_2_HIGH - ((half_square - (s * (half_square + (odd + even)) + k * LN_2_LOW)) - f);
    }
    out
}

/// eˣ for x ≤ 0, within 2 units in the last place; below -700 it stays at e⁻⁷⁰⁰, which is 10⁻³⁰⁴.
#[inline(always)]
pub(crate) fn exp_of_negative(x: [f64; LANES]) -> [f64; LANES] {
    let mut out = [0.0; LANES];
    for lane in 0..LANES {
        let x = if x[lane] > -700.0 { x[lane] } else { -700.0 };
        let shifted = x * core::f64::consts::LOG2_E + SHIFT;
        let k = shifted - SHIFT;
        let r = (x - k * LN_2_HIGH) - k * LN_2_LOW;
        // Taylor's series to r¹³, in pairs so that they do not wait for each other; |r| ≤ ln 2 / 2 makes the
        // rest less than 4e-18.
        let pair = |k: usize| INVERSE_FACTORIALS[k] + r * INVERSE_FACTORIALS[k + 1];
        let square = r * r;
        let fourth = square * square;
        let quad = |k: usize| pair(k) + square * pair(k + 2);
        let sum = quad(2) + fourth * (quad(6) + fourth * quad(10));
        let value = 1.0 + (r + square * sum);
        out[lane] = f64::from_bits(value.to_bits().wrapping_add(shifted.to_bits() << 52));
    }
    out
}

/// 1/0!, 1/1!, …, 1/13!.
const INVERSE_FACTORIALS: [f64; 14] = [
    1.0,
    1.0,
    1.0 / 2.0,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 720.0,
    1.0 / 5_040.0,
    1.0 / 40_320.0,
    1.0 / 362_880.0,
    1.0 / 3_628_800.0,
    1.0 / 39_916_800.0,
    1.0 / 479_001_600.0,
    1.0 / 6_227_020_800.0,
];

/// The largest whole number not above a finite `value`. (`f64::floor` is a call where the processor's own is
/// not assumed.)
pub(crate) fn floor(value: f64) -> i32 {
    let towards_zero = value as i32;
    towards_zero.saturating_sub(i32::from(value < f64::from(towards_zero)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn they_agree_with_libm(exponent in -690.0..690.0_f64, near_one in 0.6..1.7_f64) {
            for x in [libm::exp(exponent), near_one, 1.0] {
                let (ours, theirs) = (ln([x; LANES])[3], libm::log(x));
                prop_assert!((ours - theirs).abs() <= 5e-16 * theirs.abs(), "ln {x} = {ours}, not {theirs}");
            }
            for x in [-exponent.abs(), -near_one, 0.0] {
                let (ours, theirs) = (exp_of_negative([x; LANES])[5], libm::exp(x));
                prop_assert!((ours - theirs).abs() <= 5e-16 * theirs, "exp {x} = {ours}, not {theirs}");
            }
        }
    }

    #[test]
    fn a_very_negative_power_stays_positive_and_tiny() {
        let value = exp_of_negative([-1e9; LANES])[0];
        assert!(value > 0.0 && value < 1e-300);
    }

    #[test]
    fn floor_agrees_with_the_standard_library() {
        for value in [0.0, -0.0, 0.5, -0.5, 3.0, -3.0, 2.999_999, -2.000_001, 1e9, -1e9, 1e300, -1e300] {
            assert_eq!(floor(value), f64::floor(value) as i32, "{value}");
        }
    }
}
