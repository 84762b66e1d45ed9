//! Round numbers for axes, contours and scale bars.

/// The largest of 1, 2 and 5 times a power of ten that is not above `most`, which must be positive.
pub fn nice_step(most: f64) -> f64 {
    // Negative powers of ten are not exact; dividing by positive ones gives the decimal number exactly.
    let exponent = libm::log10(most).floor();
    let scaled = |digit: f64| {
        let power = libm::pow(10.0, exponent.abs());
        if exponent < 0.0 { digit / power } else { digit * power }
    };
    [5.0, 2.0].map(scaled).into_iter().find(|&step| step <= most).unwrap_or_else(|| scaled(1.0))
}

/// The multiples of `step` from `low` to `high`.
pub fn ticks(low: f64, high: f64, step: f64) -> impl Iterator<Item = f64> {
    let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
    // Dividing by the reciprocal of a step below one keeps 3 × 0.1 from being 0.30000000000000004.
    let per_metre = (1.0 / step).round();
    (first..=last).map(move |count| if step < 1.0 { count as f64 / per_metre } else { count as f64 * step })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round_and_not_above_what_is_asked() {
        for (most, step) in
            [(9.9, 5.0), (2.0, 2.0), (0.99, 0.5), (0.03, 0.02), (0.0125, 0.01), (140.0, 100.0)]
        {
            assert_eq!(nice_step(most).to_string(), step.to_string(), "at most {most}");
        }
    }

    #[test]
    fn ticks_are_written_as_one_would_write_them() {
        let written =
            |low, high, step| ticks(low, high, step).map(|tick| tick.to_string()).collect::<Vec<_>>();
        assert_eq!(written(-0.15, 0.31, 0.1), ["-0.1", "0", "0.1", "0.2", "0.3"]);
        assert_eq!(written(3.0, 12.0, 5.0), ["5", "10"]);
        assert_eq!(written(0.01, 0.04, 0.05), [""; 0]);
    }
}
