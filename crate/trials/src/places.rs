//! Start, waypoints and goal in a scenario file.

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
    let numbers = Numbers { names: ["x", "y", "heading"], required: 3 };
    let [x, y, heading_rad] = deserializer.deserialize_any(numbers)?.map(Option::unwrap_or_default);
    Ok(StartPose { position_m: DVec2::new(x, y), heading_rad })
}

/// Reads `[x, y]` or `{ x, y }`, metres; a third number, if there is one, is the final heading, radians.
pub(crate) fn goal<'de, D: Deserializer<'de>>(deserializer: D) -> Result<(DVec2, Option<f64>), D::Error> {
    let numbers = Numbers { names: ["x", "y", "heading"], required: 2 };
    let [x, y, heading_rad] = deserializer.deserialize_any(numbers)?;
    Ok((DVec2::new(x.unwrap_or_default(), y.unwrap_or_default()), heading_rad))
}

/// Reads a list of places, each as `[x, y]` or `{ x, y }`, metres.
pub(crate) fn waypoints<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<DVec2>, D::Error> {
    #[derive(serde::Deserialize)]
    #[serde(transparent)]
    struct Place(#[serde(deserialize_with = "place")] DVec2);
    let places: Vec<Place> = serde::Deserialize::deserialize(deserializer)?;
    Ok(places.into_iter().map(|place| place.0).collect())
}

fn place<'de, D: Deserializer<'de>>(deserializer: D) -> Result<DVec2, D::Error> {
    let numbers = Numbers { names: ["x", "y"], required: 2 };
    Ok(DVec2::from_array(deserializer.deserialize_any(numbers)?.map(Option::unwrap_or_default)))
}

/// Finite numbers, in order or by name; the first ones are required.
struct Numbers<const N: usize> {
    names: [&'static str; N],
    required: usize,
}

impl<const N: usize> Numbers<N> {
    fn finite<E: Error>(&self, index: usize, value: f64) -> Result<f64, E> {
        if value.is_finite() {
            Ok(value)
        } else {
            Err(E::custom(format_args!("{} = {value}: expected a finite number", self.names[index])))
        }
    }
}

impl<'de, const N: usize> Visitor<'de> for Numbers<N> {
    type Value = [Option<f64>; N];

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let at_least = if self.required < N { format!("{} or ", self.required) } else { String::new() };
        write!(f, "{at_least}{N} numbers: {}", self.names.join(", "))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Self::Value, A::Error> {
        let mut values = [None; N];
        for (index, slot) in values.iter_mut().enumerate() {
            match items.next_element()? {
                Some(value) => *slot = Some(self.finite(index, value)?),
                None if index < self.required => return Err(A::Error::invalid_length(index, &self)),
                None => return Ok(values),
            }
        }
        if items.next_element::<f64>()?.is_some() {
            return Err(A::Error::invalid_length(N + 1, &self));
        }
        Ok(values)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Self::Value, A::Error> {
        let mut values = [None; N];
        while let Some(key) = entries.next_key::<String>()? {
            let Some(index) = self.names.iter().position(|name| *name == key) else {
                return Err(A::Error::custom(format_args!(
                    "unknown key `{key}`: expected {}",
                    self.names.join(", ")
                )));
            };
            values[index] = Some(self.finite(index, entries.next_value()?)?);
        }
        match (0..self.required).find(|&index| values[index].is_none()) {
            Some(missing) => Err(A::Error::missing_field(self.names[missing])),
            None => Ok(values),
        }
    }
}
