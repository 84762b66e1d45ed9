//! Start, waypoints and goal as a scenario file writes them.

use std::fmt;

use glam::DVec2;
use serde::de::{Deserializer, Error, MapAccess, SeqAccess, Visitor};

/// Where the robot starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StartPose {
    /// Position seen from above, metres.
    pub position_m: DVec2,
    /// Heading, anticlockwise from east.
    pub heading_rad: f64,
}

/// Reads `[x, y, heading]` or `{ x, y, heading }`; metres and radians.
pub(crate) fn start<'de, D: Deserializer<'de>>(deserializer: D) -> Result<StartPose, D::Error> {
    let [x, y, heading_rad] = deserializer.deserialize_any(Numbers(["x", "y", "heading"]))?;
    Ok(StartPose { position_m: DVec2::new(x, y), heading_rad })
}

/// Reads `[x, y]` or `{ x, y }`, metres.
pub(crate) fn goal<'de, D: Deserializer<'de>>(deserializer: D) -> Result<DVec2, D::Error> {
    let [x, y] = deserializer.deserialize_any(Numbers(["x", "y"]))?;
    Ok(DVec2::new(x, y))
}

/// Reads a list of places, each as [`goal`] does.
pub(crate) fn waypoints<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<DVec2>, D::Error> {
    #[derive(serde::Deserialize)]
    #[serde(transparent)]
    struct Place(#[serde(deserialize_with = "goal")] DVec2);
    let places: Vec<Place> = serde::Deserialize::deserialize(deserializer)?;
    Ok(places.into_iter().map(|place| place.0).collect())
}

/// `N` finite numbers, in order or by name.
struct Numbers<const N: usize>([&'static str; N]);

impl<const N: usize> Numbers<N> {
    fn finite<E: Error>(&self, index: usize, value: f64) -> Result<f64, E> {
        if value.is_finite() {
            Ok(value)
        } else {
            Err(E::custom(format_args!("{} = {value}: expected a finite number", self.0[index])))
        }
    }
}

impl<'de, const N: usize> Visitor<'de> for Numbers<N> {
    type Value = [f64; N];

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{N} numbers: {}", self.0.join(", "))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Self::Value, A::Error> {
        let mut values = [0.0; N];
        for (index, slot) in values.iter_mut().enumerate() {
            let value = items.next_element()?.ok_or_else(|| A::Error::invalid_length(index, &self))?;
            *slot = self.finite(index, value)?;
        }
        if items.next_element::<f64>()?.is_some() {
            return Err(A::Error::invalid_length(N + 1, &self));
        }
        Ok(values)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Self::Value, A::Error> {
        let mut values = [None; N];
        while let Some(key) = entries.next_key::<String>()? {
            let Some(index) = self.0.iter().position(|name| *name == key) else {
                return Err(A::Error::custom(format_args!(
                    "unknown key `{key}`: expected {}",
                    self.0.join(", ")
                )));
            };
            values[index] = Some(self.finite(index, entries.next_value()?)?);
        }
        let mut numbers = [0.0; N];
        for (index, (number, value)) in numbers.iter_mut().zip(values).enumerate() {
            *number = value.ok_or_else(|| A::Error::missing_field(self.0[index]))?;
        }
        Ok(numbers)
    }
}
