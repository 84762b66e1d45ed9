//! How an object walks.

use glam::DVec2;
use mapless_parameters::{Check, ConfigError, Value};

/// A walk from the object's place along points and back again, over and over.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Walk {
    /// The points after its own place, seen from above, metres.
    pub path: Vec<[f64; 2]>,
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// It stands until the robot is this near to its place, metres; from the beginning when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub starts_within_m: Option<f64>,
}

impl Walk {
    pub(super) fn validate(&self, place: &str) -> Result<(), ConfigError> {
        let check = |check: Check, name, value: f64| check.require(place, name, Value::Number(value));
        check(Check::Within(0.001, 10.0), "walk.speed_m_s", self.speed_m_s)?;
        let count = self.path.len();
        ConfigError::require((1..=100).contains(&count), place, "walk.path", count, "1 to 100 points")?;
        let coordinates = self.path.iter().flatten();
        coordinates
            .copied()
            .try_for_each(|coordinate| check(Check::Within(0.0, 1e6), "walk.path", coordinate))?;
        check(Check::Positive, "walk.starts_within_m", self.starts_within_m.unwrap_or(1.0))
    }

    /// The place after `walked_m` metres from `begin_m` on, there and back.
    pub(super) fn place_m(&self, begin_m: DVec2, walked_m: f64) -> DVec2 {
        let points = || core::iter::once(begin_m).chain(self.path.iter().map(|&point| DVec2::from(point)));
        let legs = || points().zip(points().skip(1));
        let length_m: f64 = legs().map(|(from, to)| from.distance(to)).sum();
        if length_m <= 0.0 {
            return begin_m;
        }
        let round_m = walked_m % (2.0 * length_m);
        let mut left_m = if round_m <= length_m { round_m } else { 2.0 * length_m - round_m };
        for (from, to) in legs() {
            let leg_m = from.distance(to);
            if left_m <= leg_m {
                return if leg_m > 0.0 { from.lerp(to, left_m / leg_m) } else { from };
            }
            left_m -= leg_m;
        }
        points().last().unwrap_or(begin_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn goes_along_its_points_and_back() {
        let walk = Walk { path: vec![[3.0, 0.0], [3.0, 4.0]], speed_m_s: 1.0, starts_within_m: None };
        let place = |walked_m| walk.place_m(DVec2::ZERO, walked_m);
        assert_eq!(place(0.0), DVec2::ZERO);
        assert_eq!(place(2.0), DVec2::new(2.0, 0.0));
        assert_eq!(place(5.0), DVec2::new(3.0, 2.0));
        assert_eq!(place(7.0), DVec2::new(3.0, 4.0));
        assert_eq!(place(9.0), DVec2::new(3.0, 2.0));
        assert_eq!(place(14.0), DVec2::ZERO);
        assert_eq!(place(16.0), DVec2::new(2.0, 0.0));
    }

    #[test]
    fn values_are_checked() {
        let walk = Walk { path: Vec::new(), speed_m_s: 1.0, starts_within_m: None };
        assert_eq!(walk.validate("objects[1]").unwrap_err().name, "walk.path");
        let walk = Walk { path: vec![[1.0, 1.0]], speed_m_s: -1.0, starts_within_m: None };
        assert_eq!(walk.validate("objects[1]").unwrap_err().name, "walk.speed_m_s");
    }
}
