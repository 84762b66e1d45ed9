//! The configuration for another sensor or another robot.

use crate::config::PlannerConfig;
use crate::robot_model::RobotModel;
use crate::sensor_model::SensorModel;
use crate::skyline::beam_grid::{BeamGrid, ROWS_PER_RING};

/// As many rows of beams must meet level ground within r_oc, unless that takes r_oc beyond this multiple of
/// the sensor's height: farther out beams graze the ground.
const FEWEST_ROWS: usize = 4;
const MOST_HEIGHTS: f64 = 9.0;
/// The largest reach of the state lattice, in steps: the time of a search grows with its square.
const MOST_STEPS: f64 = 16.0;

impl PlannerConfig {
    /// The default preset for a sensor and a robot. For a VLP-16 on a Husky it is [`PlannerConfig::default`].
    pub fn for_robot(sensor: SensorModel, robot: RobotModel) -> Self {
        Self::default().fitted_to(sensor, robot)
    }

    /// This configuration, which is for a VLP-16 on a Husky, for another sensor and robot: a sensor higher
    /// up, or with fewer rings, needs a larger r_oc to see the ground, and with it a wider memory and a
    /// coarser lattice.
    #[must_use]
    pub fn fitted_to(mut self, sensor: SensorModel, robot: RobotModel) -> Self {
        (self.sensor, self.robot) = (sensor, robot);
        let grid = BeamGrid::new(&sensor);
        let surface_radius_m = self.perception.surface_radius_m.max(ground_radius_m(&sensor, &grid));
        let farther_m = surface_radius_m - self.perception.surface_radius_m;
        self.perception.surface_radius_m = surface_radius_m;
        self.elevation_window.radius_m += farther_m;
        self.state_lattice.blind_radius_m += farther_m;
        let least_step_m = (10.0 * surface_radius_m / MOST_STEPS).ceil() / 10.0;
        self.state_lattice.step_m = self.state_lattice.step_m.max(least_step_m);
        // The profile steps from row to row.
        self.segments.elevation_tolerance_rad *= grid.coarseness();
        self
    }
}

/// How far out the lowest rows meet level ground, in whole half metres.
fn ground_radius_m(sensor: &SensorModel, grid: &BeamGrid) -> f64 {
    let last_row = ROWS_PER_RING * (FEWEST_ROWS.min(grid.rings()) - 1);
    let downward = -libm::sin(grid.row_elevation_rad(last_row));
    let most_m = MOST_HEIGHTS * sensor.height_m;
    let radius_m = if downward > 0.0 { most_m.min(sensor.height_m / downward) } else { most_m };
    (2.0 * radius_m).ceil() / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vlp16_on_a_husky_has_the_presets_to_the_last_bit() {
        let fitted = PlannerConfig::for_robot(SensorModel::vlp16(), RobotModel::husky());
        assert_eq!(fitted, PlannerConfig::default());
        let paper = PlannerConfig::paper();
        assert_eq!(paper.clone().fitted_to(SensorModel::vlp16(), RobotModel::husky()), paper);
    }

    #[test]
    fn every_sensor_sees_the_ground_within_its_radius() {
        let vlp16 = SensorModel::vlp16();
        let coarse = SensorModel { rings: 8, ..vlp16 };
        let wide =
            SensorModel { rings: 128, lowest_elevation_rad: -0.785, highest_elevation_rad: 0.785, ..vlp16 };
        for (sensor, radius_m, step_m) in [
            (vlp16, 7.0, 0.5),
            (coarse, 7.5, 0.5),
            (wide, 7.0, 0.5),
            (SensorModel { height_m: 0.4, ..vlp16 }, 7.0, 0.5),
            (SensorModel { height_m: 1.7, ..vlp16 }, 11.0, 0.7),
            (SensorModel { pitch_rad: -0.26, ..vlp16 }, 7.0, 0.5),
        ] {
            for robot in [RobotModel::jackal(), RobotModel::husky(), RobotModel::warthog()] {
                let config = PlannerConfig::for_robot(sensor, robot);
                config.validate("planner").unwrap();
                assert!((config.perception.surface_radius_m - radius_m).abs() < 1e-12, "{sensor:?}");
                assert!((config.state_lattice.step_m - step_m).abs() < 1e-12, "{sensor:?}");
                assert!((config.elevation_window.radius_m - radius_m - 2.0).abs() < 1e-12, "{sensor:?}");
            }
        }
    }
}
