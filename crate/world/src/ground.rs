//! What wheels stand on.

use crate::height_field::HeightField;
use crate::objects::Solid;
use glam::DVec2;

/// Something with a height above each place.
pub trait Ground {
    /// World height above a place seen from above, metres; `None` off the terrain.
    fn height_m(&self, place_m: DVec2) -> Option<f64>;
}

impl Ground for HeightField {
    fn height_m(&self, place_m: DVec2) -> Option<f64> {
        Self::height_m(self, place_m)
    }
}

/// Ground with solids on it: a wheel stands on the top of what stands on the ground.
#[derive(Clone, Copy, Debug)]
pub struct Footing<'a> {
    /// The ground.
    pub field: &'a HeightField,
    /// What stands on it.
    pub solids: &'a [Solid],
}

impl Ground for Footing<'_> {
    fn height_m(&self, place_m: DVec2) -> Option<f64> {
        let ground_m = self.field.height_m(place_m)?;
        let tops =
            self.solids.iter().filter(|solid| solid.is_grounded).filter_map(|solid| solid.top_at_m(place_m));
        Some(tops.fold(ground_m, f64::max))
    }
}
