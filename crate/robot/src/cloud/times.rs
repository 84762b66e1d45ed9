//! Times of single points, of any name, type and unit.

use super::error::CloudWarning;

/// Names of fields of times, in lower case: Velodyne and many others, Ouster, Hesai and RoboSense, Livox.
pub(crate) const NAMES: [&str; 8] =
    ["time", "t", "timestamp", "time_stamp", "offset_time", "time_offset", "point_time", "timeoffset"];

/// Units of time in seconds, and how long a sweep takes: the spreads of these units do not overlap.
const UNITS_S: [f64; 4] = [1.0, 1e-3, 1e-6, 1e-9];
const SWEEP_S: [f64; 2] = [0.002, 1.5];
/// Times that are farther from the stamp are no offsets from it.
const FARTHEST_S: f64 = 2.0;

/// Seconds since the stamp of the cloud, from the values of the field `name`. Offsets from the stamp and
/// times of the stamp's clock are told apart by their size.
pub(crate) fn since_stamp_s(
    name: &str,
    values: &[f64],
    stamp_ns: i64,
    warnings: &mut Vec<CloudWarning>,
) -> Option<Vec<f64>> {
    let finite = || values.iter().copied().filter(|value| value.is_finite());
    let (least, most) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    let spread = most - least;
    let is_sweep = |unit_s: &f64| (SWEEP_S[0]..SWEEP_S[1]).contains(&(spread * unit_s));
    let unit_s = UNITS_S.into_iter().find(is_sweep);
    let Some(unit_s) = unit_s.filter(|_| finite().count() == values.len()) else {
        if !values.is_empty() {
            warnings.push(CloudWarning::Times { name: name.to_owned(), spread });
        }
        return None;
    };
    // From the first one on, so that times since 1970 keep their digits.
    let first_s = least * unit_s;
    let begin_s = if first_s.abs() <= FARTHEST_S {
        first_s
    } else {
        let ahead_s = first_s - stamp_ns as f64 * 1e-9;
        if ahead_s.abs() <= FARTHEST_S {
            ahead_s
        } else {
            warnings.push(CloudWarning::OtherClock { name: name.to_owned(), ahead_s });
            0.0
        }
    };
    Some(values.iter().map(|value| begin_s + (value - least) * unit_s).collect())
}
