//! Statistics over many trials, for reports and the page.

use std::time::Duration;

/// Mean and sample standard deviation; no deviation for a single value, `None` without values.
#[must_use]
pub fn mean_and_deviation(values: &[f64]) -> Option<(f64, Option<f64>)> {
    let mean = mean(values)?;
    let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
    let deviation = (values.len() > 1).then(|| (squares / (values.len() - 1) as f64).sqrt());
    Some((mean, deviation))
}

/// The mean; `None` without values.
#[must_use]
pub fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// The median; `None` without values.
#[must_use]
pub fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    let upper = *values.get(middle)?;
    Some(if values.len() % 2 == 1 { upper } else { (values[middle - 1] + upper) / 2.0 })
}

/// The nearest-rank percentile of sorted values; `None` without values.
fn percentile<T: Copy>(sorted: &[T], percent: usize) -> Option<T> {
    let rank = (sorted.len() * percent).div_ceil(100).max(1);
    sorted.get(rank - 1).copied()
}

/// Nearest-rank percentiles of measured times, in milliseconds; zeros without values.
#[must_use]
pub fn percentiles_ms<const N: usize>(mut times: Vec<Duration>, percents: [usize; N]) -> [f64; N] {
    times.sort_unstable();
    percents.map(|percent| percentile(&times, percent).map_or(0.0, |time| time.as_secs_f64() * 1e3))
}

/// Standard normal quantile of a two-sided 95 % interval.
const Z: f64 = 1.959_963_984_540_054;

/// Wilson's 95 % interval of the rate of `successes` in `trials` (Wilson 1927,
/// <https://doi.org/10.1080/01621459.1927.10502953>, without continuity correction).
#[must_use]
pub fn wilson(successes: usize, trials: usize) -> (f64, f64) {
    if trials == 0 {
        return (0.0, 1.0);
    }
    let n = trials as f64;
    let rate = successes as f64 / n;
    let centre = rate + Z * Z / (2.0 * n);
    let half = Z * (rate * (1.0 - rate) / n + Z * Z / (4.0 * n * n)).sqrt();
    let scale = 1.0 + Z * Z / n;
    (((centre - half) / scale).max(0.0), ((centre + half) / scale).min(1.0))
}

/// Two-sided sign test: the probability that chance alone divides pairs as unevenly as this, or more. Even
/// pairs do not count.
#[must_use]
pub fn sign_test(lower: usize, higher: usize) -> f64 {
    let pairs = lower + higher;
    let (mut ways, mut tail) = (1.0, 0.0);
    for fewer in 0..=lower.min(higher) {
        tail += ways;
        ways *= (pairs - fewer) as f64 / (fewer + 1) as f64;
    }
    // A shift by this many bits would overflow.
    let all = (0..pairs).fold(1.0, |all, _| 2.0 * all);
    (2.0 * tail / all).min(1.0)
}

/// Success weighted by path length (Anderson et al. 2018, <https://arxiv.org/abs/1807.06757>): the mean over
/// all trials of shortest / driven length, 0 for a failure. Each trial has its driven length, if it
/// succeeded, and its shortest.
#[must_use]
pub fn spl(trials: &[(Option<f64>, f64)]) -> Option<f64> {
    let shares: Vec<f64> = trials
        .iter()
        .map(|&(driven_m, shortest_m)| driven_m.map_or(0.0, |driven_m| shortest_m / driven_m.max(shortest_m)))
        .collect();
    mean(&shares)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: f64, b: f64) {
        assert!((a - b).abs() < 5e-5, "{a} is not {b}");
    }

    #[test]
    fn a_percentile_is_one_of_the_values() {
        let hundreds: Vec<u32> = (1..=200).collect();
        let of = |percent| percentile(&hundreds, percent);
        assert_eq!((of(0), of(50), of(99), of(100)), (Some(1), Some(100), Some(198), Some(200)));
        assert_eq!((percentile(&[7], 50), percentile::<u32>(&[], 50)), (Some(7), None));
    }

    #[test]
    fn percentiles_of_times_are_measured_times() {
        let times = (1..=200).rev().map(Duration::from_millis).collect();
        for (found, expected) in percentiles_ms(times, [50, 99, 100]).into_iter().zip([100.0, 198.0, 200.0]) {
            assert!((found - expected).abs() < 1e-9, "{found} is not {expected}");
        }
        let [of_none] = percentiles_ms(Vec::new(), [50]);
        assert!(of_none.abs() < 1e-9);
    }

    #[test]
    fn wilson_as_published() {
        // Newcombe, Statistics in Medicine 17 (1998), Table I, method 3.
        for (successes, trials, low, high) in [
            (81, 263, 0.2553, 0.3662),
            (15, 148, 0.0624, 0.1605),
            (0, 20, 0.0, 0.1611),
            (1, 29, 0.0061, 0.1718),
        ] {
            let interval = wilson(successes, trials);
            close(interval.0, low);
            close(interval.1, high);
        }
        let (low, high) = wilson(20, 20);
        close(low, 1.0 - 0.1611);
        close(high, 1.0);
        assert_eq!(wilson(0, 0), (0.0, 1.0));
    }

    #[test]
    fn sign_test_by_hand() {
        for (lower, higher, likely) in [
            (0, 0, 1.0),
            (5, 5, 1.0),
            (9, 1, 22.0 / 1024.0),
            (1, 9, 22.0 / 1024.0),
            (0, 5, 0.0625),
            (6, 0, 0.03125),
        ] {
            close(sign_test(lower, higher), likely);
        }
    }

    #[test]
    fn spl_by_hand() {
        // Twice the shortest path, a failure, and a path shorter than the search's grid allows.
        let trials = [(Some(20.0), 10.0), (None, 10.0), (Some(9.0), 10.0)];
        close(spl(&trials).unwrap(), (0.5 + 0.0 + 1.0) / 3.0);
        assert_eq!(spl(&[]), None);
    }

    #[test]
    fn means_and_medians_by_hand() {
        let (mean, deviation) = mean_and_deviation(&[10.0, 14.0]).unwrap();
        close(mean, 12.0);
        close(deviation.unwrap(), 8.0_f64.sqrt());
        assert_eq!(mean_and_deviation(&[3.0]), Some((3.0, None)));
        assert_eq!(mean_and_deviation(&[]), None);
        assert_eq!(median(vec![3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), Some(2.5));
        assert_eq!(median(Vec::new()), None);
    }
}
