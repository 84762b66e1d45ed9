//! What a planner with a map knows of the world.

use glam::DVec2;
use mapless_trials::Scenario;
use mapless_world::{Body, HeightField, Objects, RobotConfig, SensorConfig, Solid};

/// Farther than any solid is large, metres.
const FAR_M: f64 = 1e4;

/// Ground, what stands on it, and the robot that is to cross it. What walks is not known.
#[derive(Clone, Debug)]
pub struct KnownWorld {
    pub(crate) field: HeightField,
    pub(crate) solids: Vec<Solid>,
    pub(crate) robot: RobotConfig,
    pub(crate) body: Body,
    /// Whether belly, bumpers and steps count on bare ground.
    pub(crate) touches_ground: bool,
}

impl KnownWorld {
    /// The world of a scenario on `field`.
    #[must_use]
    pub fn new(field: &HeightField, scenario: &Scenario) -> Self {
        let objects = Objects::new(scenario.objects.clone().unwrap_or_default(), field);
        let touches_ground = scenario.reality.motion.touches_ground;
        Self::of(field, &objects, &scenario.robot, &scenario.sensor, touches_ground)
    }

    /// Ground with nothing on it, where only tilt counts.
    #[must_use]
    pub fn bare(field: &HeightField, robot: &RobotConfig) -> Self {
        Self::of(field, &Objects::default(), robot, &SensorConfig::default(), false)
    }

    pub(crate) fn of(
        field: &HeightField,
        objects: &Objects,
        robot: &RobotConfig,
        sensor: &SensorConfig,
        touches_ground: bool,
    ) -> Self {
        Self {
            field: field.clone(),
            solids: objects.standing().copied().collect(),
            robot: robot.clone(),
            body: Body::new(robot, sensor.place_on_robot_m()),
            touches_ground,
        }
    }

    /// The ground as a map of heights has it: with everything that the robot cannot pass beneath, as high as
    /// it stands.
    #[must_use]
    pub fn surface(&self) -> HeightField {
        if self.solids.is_empty() {
            return self.field.clone();
        }
        let (columns, cell_m) = (self.field.columns(), self.field.cell_m());
        // The nearest sample of the thinnest post is this far from its axis at most.
        let reach_m = cell_m * std::f64::consts::FRAC_1_SQRT_2;
        let height_m = |(index, &ground_m): (usize, &f32)| {
            let place_m = DVec2::new((index % columns) as f64, (index / columns) as f64) * cell_m;
            let top_m = |solid: &Solid| {
                let centre_m = solid.centre_m.truncate();
                if place_m.distance(centre_m) > solid.bounding_radius_m() + reach_m {
                    return None;
                }
                let below_m = solid.nearest(place_m.extend(solid.centre_m.z - FAR_M)).z;
                let nearest_m = solid.nearest(place_m.extend(solid.centre_m.z)).truncate();
                let blocks = below_m - f64::from(ground_m) < self.body.height_m();
                (blocks && place_m.distance(nearest_m) <= reach_m)
                    .then(|| solid.top_at_m(nearest_m).unwrap_or(solid.centre_m.z) as f32)
            };
            self.solids.iter().filter_map(top_m).fold(ground_m, f32::max)
        };
        let heights_m = self.field.heights_m().iter().enumerate().map(height_m).collect();
        HeightField::new(columns, self.field.rows(), cell_m, heights_m).unwrap_or_else(|_| self.field.clone())
    }
}
