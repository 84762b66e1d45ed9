//! Agreement of all sides' results.

use anyhow::{Context as _, ensure};

use super::runner::{Side, Values};

/// Largest difference of gpflow's results from ours, relative to the largest of them.
const TOLERANCE: f64 = 1e-6;
/// Largest difference of the median of a peer's ranges from ours, metres: the roughness of the hills, which
/// differs in every cell.
const RANGE_TOLERANCE_M: f64 = 0.01;

/// A comparison of two sides' results.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Agreement {
    pub(crate) what: String,
    pub(crate) difference: f64,
    pub(crate) allowed: f64,
}

impl Agreement {
    /// Whether the difference is allowed; a difference that is not a number is not.
    pub(crate) fn holds(&self) -> bool {
        self.difference <= self.allowed
    }
}

/// Compares the results of `sides`, ours natively first: with the peer within its tolerance, with wasm to the
/// bit.
pub(crate) fn check(work: &str, sides: &[Side], values: &[Values]) -> anyhow::Result<Vec<Agreement>> {
    let native = values.first().context("no side computed anything")?;
    let mut agreements = Vec::new();
    for (side, values) in sides.iter().zip(values).skip(1) {
        match side {
            Side::Peer if work.starts_with("scan") => {
                agreements.extend(ranges(work, "Embree", native, values)?);
            }
            Side::Jolt => agreements.extend(ranges(work, "Jolt", native, values)?),
            Side::Peer => {
                let names: &[&str] = match work.split_once('-') {
                    Some(("bound", _)) => &["bound", "log_gradient", "inducing_gradient"],
                    _ => &["mean", "variance"],
                };
                for name in names {
                    let difference = relative(native.get(name)?, values.get(name)?)?;
                    agreements.push(Agreement {
                        what: format!("{work}: {name}, gpflow"),
                        difference,
                        allowed: TOLERANCE,
                    });
                }
            }
            Side::Native | Side::Node | Side::Chromium => {
                let difference = if values == native { 0.0 } else { f64::INFINITY };
                agreements.push(Agreement {
                    what: format!("{work}: bits, {side:?}"),
                    difference,
                    allowed: 0.0,
                });
            }
        }
    }
    Ok(agreements)
}

/// The largest difference, relative to the largest of ours.
fn relative(ours: &[Option<f64>], theirs: &[Option<f64>]) -> anyhow::Result<f64> {
    ensure!(ours.len() == theirs.len(), "{} numbers against {}", ours.len(), theirs.len());
    let mut largest = 0.0_f64;
    let mut apart = 0.0_f64;
    for (ours, theirs) in ours.iter().zip(theirs) {
        let (Some(ours), Some(theirs)) = (ours, theirs) else { return Ok(f64::INFINITY) };
        largest = largest.max(ours.abs());
        apart = apart.max((ours - theirs).abs());
    }
    Ok(apart / largest)
}

/// Beams whose range on the triangles lies outside the allowed difference of the surfaces, and the median
/// difference of ranges.
fn ranges(work: &str, peer: &str, ours: &Values, theirs: &Values) -> anyhow::Result<[Agreement; 2]> {
    let [range, nearest, farthest] = ["range_m", "nearest_m", "farthest_m"].map(|name| ours.get(name));
    let (range, nearest, farthest, theirs) = (range?, nearest?, farthest?, theirs.get("range_m")?);
    ensure!(range.len() == theirs.len(), "{} beams against {}", range.len(), theirs.len());
    let far = |range: &Option<f64>| range.unwrap_or(f64::INFINITY);
    let inside = |(theirs, (nearest, farthest)): (&Option<f64>, (&Option<f64>, &Option<f64>))| {
        far(nearest) <= far(theirs) && far(theirs) <= far(farthest)
    };
    let outside = theirs.iter().zip(nearest.iter().zip(farthest)).filter(|beam| !inside(*beam)).count();
    let both =
        range.iter().zip(theirs).filter_map(|(ours, theirs)| Some((ours.as_ref()? - theirs.as_ref()?).abs()));
    let mut differences: Vec<f64> = both.collect();
    differences.sort_by(f64::total_cmp);
    let median = differences.get(differences.len() / 2).context("no beam returns")?;
    Ok([
        Agreement {
            what: format!("{work}: beams of {} outside the bounds, {peer}", theirs.len()),
            difference: outside as f64,
            allowed: 0.0,
        },
        Agreement {
            what: format!("{work}: median difference of ranges, m, {peer}"),
            difference: *median,
            allowed: RANGE_TOLERANCE_M,
        },
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(json: &str) -> Values {
        serde_json::from_str(json).unwrap()
    }

    #[test]
    fn differences_count_relative_to_the_largest() {
        let ours = values(r#"{"mean": [1.0, -4.0], "variance": [1.0, 1.0]}"#);
        let theirs = values(r#"{"mean": [1.0, -4.000001], "variance": [1.0, 1.1]}"#);
        let agreements = check("posterior-200", &[Side::Native, Side::Peer], &[ours, theirs]).unwrap();
        assert!((agreements[0].difference - 2.5e-7).abs() < 1e-12 && agreements[0].holds());
        assert!(!agreements[1].holds());
    }

    #[test]
    fn other_bits_in_wasm_are_told() {
        let sides = [Side::Native, Side::Node];
        let ours = values(r#"{"command": [0.5]}"#);
        let same = check("tick-level", &sides, &[ours.clone(), ours.clone()]).unwrap();
        assert!(same[0].holds());
        let other = values(r#"{"command": [0.5000000000000001]}"#);
        assert!(!check("tick-level", &sides, &[ours, other]).unwrap()[0].holds());
    }

    #[test]
    fn ranges_lie_between_their_bounds() {
        let ours = values(
            r#"{"range_m": [3.0, 5.0, null], "nearest_m": [2.9, 4.0, null], "farthest_m": [3.1, null, null]}"#,
        );
        let outside = |theirs| {
            check("scan-x", &[Side::Native, Side::Peer], &[ours.clone(), values(theirs)]).unwrap()[0]
                .difference
        };
        assert!(outside(r#"{"range_m": [3.0, 9.0, null]}"#) < 0.5);
        assert!(outside(r#"{"range_m": [3.0, null, null]}"#) < 0.5);
        assert!((outside(r#"{"range_m": [3.2, 3.9, 50.0]}"#) - 3.0).abs() < 0.5);
    }

    #[test]
    fn what_is_not_a_number_does_not_agree() {
        let nan = Agreement { what: String::new(), difference: f64::NAN, allowed: 1.0 };
        assert!(!nan.holds());
    }
}
