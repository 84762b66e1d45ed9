//! What the page records and shows of a tick.

use glam::DVec2;
use js_sys::{Float32Array, Uint8Array};
use mapless::{Navigator as _, Status, StopReason};
use mapless_world::SensorPose;
use wasm_bindgen::prelude::wasm_bindgen;

use super::Session;
use crate::encode;

#[wasm_bindgen]
impl Session {
    /// What the record of a run keeps of a tick, read between [`Session::plan`] and [`Session::act`]: tick, time; x, y, z,
    /// roll, pitch, yaw; speed, turn rate; the commanded speed and turn rate; the subgoal's x and y, NaN without one; what
    /// the planner does (0 driving, 1 arrived, 2 looking, 3 stopped, 4 going back); the six metrics so far, in the order
    /// of [`mapless_trials::Metrics`].
    pub fn row(&self) -> Vec<f64> {
        let (trial, step) = (&self.now.trial, self.now.trial.step());
        let subgoal_m = trial.navigator().subgoal_m().unwrap_or(DVec2::NAN);
        let activity = match step.status {
            Status::Driving => 0.0,
            Status::Arrived => 1.0,
            Status::Searching => 2.0,
            Status::Stopped(_) => 3.0,
            Status::Backtracking => 4.0,
        };
        let mut values = vec![trial.ticks() as f64, trial.time_s()];
        values.extend(trial.motion());
        values.extend([
            step.command.linear_m_s,
            step.command.angular_rad_s,
            subgoal_m.x,
            subgoal_m.y,
            activity,
        ]);
        values.extend(trial.metrics().values());
        values
    }

    /// Tick, time; x, y, z, roll, pitch, yaw; speed, turn rate; the commanded speed and turn rate; variance threshold; the
    /// six metrics in the order of [`mapless_trials::Metrics`]; how many waypoints the robot has been to.
    pub fn status(&self) -> Vec<f64> {
        let trial = &self.now.trial;
        let command = trial.step().command;
        let mut values = vec![trial.ticks() as f64, trial.time_s()];
        values.extend(trial.motion());
        values.extend([
            command.linear_m_s,
            command.angular_rad_s,
            trial.planner_config().perception.variance_threshold,
        ]);
        values.extend(trial.metrics().values());
        values.push(trial.waypoints_passed() as f64);
        values
    }

    /// How the trial ended, or `running`.
    pub fn outcome(&self) -> String {
        self.now.trial.outcome().map_or("running", |outcome| outcome.name()).to_owned()
    }

    /// What the planner does: `driving`, `arrived`, `retreating`, `looking` or `stopped`.
    pub fn activity(&self) -> String {
        match self.now.trial.step().status {
            Status::Driving => "driving",
            Status::Arrived => "arrived",
            Status::Backtracking => "retreating",
            Status::Searching => "looking",
            Status::Stopped(_) => "stopped",
        }
        .to_owned()
    }

    /// Why the planner stopped, where it did.
    pub fn stop_reason(&self) -> Option<String> {
        self.now.trial.stop_reason().map(|reason: StopReason| reason.to_string())
    }

    /// Digest of the trajectory so far.
    pub fn digest(&self) -> String {
        self.now.trial.digest()
    }

    /// The last scan's returns in the world frame, x, y, z of each, as many as `out` holds. Returns how many points.
    pub fn points(&mut self, out: &Float32Array) -> usize {
        let SensorPose { position, world_from_sensor } = self.now.scanned_from;
        let fit = out.length() as usize / 3;
        self.scratch.clear();
        for point in self.now.trial.scan().points.iter().take(fit) {
            let world = position + world_from_sensor * point.as_dvec3();
            self.scratch.extend(world.as_vec3().to_array());
        }
        self.send(out);
        self.scratch.len() / 3
    }

    /// Where the last scan was taken: the sensor's world position, then the world directions of its x, y and z axes.
    pub fn world_from_sensor(&self) -> Vec<f64> {
        let SensorPose { position, world_from_sensor } = self.now.scanned_from;
        let axes = world_from_sensor.to_cols_array();
        position.to_array().into_iter().chain(axes).collect()
    }

    /// Both surfaces that the Gaussian process predicts, column by column from straight behind over the right, lowest row
    /// first, as much as each `out` holds: the reconstructed occupancy in metres, and the variance as a share of the signal
    /// variance. Predicted only now, since a step needs no more than the variance's edge. Where there is no posterior, nothing
    /// was observed: 0 and 1.
    pub fn surfaces(&mut self, occupancy_out: &Float32Array, variance_out: &Float32Array) {
        let sizes = [occupancy_out, variance_out].map(|out| out.length() as usize);
        self.scratch.clear();
        self.scratch.resize(sizes[0], 0.0);
        let mut variance = vec![1.0; sizes[1]];
        if let Ok(surface) = self.now.trial.predicted_surface() {
            narrow(&surface.mean_m, &mut self.scratch);
            narrow(&surface.relative_variance, &mut variance);
        }
        self.send(occupancy_out);
        variance_out.copy_from(&variance);
    }

    /// The observed occupancy surface in metres, column by column from straight behind over the right, lowest ring first, NaN
    /// where there was no return within its radius; as much as `out` holds.
    pub fn observed(&mut self, out: &Float32Array) {
        self.scratch.clear();
        self.scratch.resize(out.length() as usize, f32::NAN);
        let observed = self.now.trial.step().observed;
        for cell in observed.cells() {
            if let Some(place) = self.scratch.get_mut(cell.column * observed.rings() + cell.ring) {
                *place = cell.occupancy_m as f32;
            }
        }
        self.send(out);
    }

    /// Elevation of the skyline in each column, NaN where there is none; as much as `out` holds.
    pub fn profile(&mut self, out: &Float32Array) {
        self.scratch.clear();
        let profile = self.now.trial.step().profile;
        self.scratch.extend(profile.iter().take(out.length() as usize).map(encode::column_elevation_rad));
        self.send(out);
    }

    fn send(&self, out: &Float32Array) {
        out.subarray(0, self.scratch.len() as u32).copy_from(&self.scratch);
    }

    /// What each column shows: 0 ground, 1 unknown, 2 wall; as much as `out` holds.
    pub fn kinds(&self, out: &Uint8Array) {
        let profile = self.now.trial.step().profile;
        let kinds: Vec<u8> = profile.iter().take(out.length() as usize).map(encode::column_kind).collect();
        out.subarray(0, kinds.len() as u32).copy_from(&kinds);
    }

    /// Six numbers for each segment: begin and end azimuth (the end beyond π where the segment crosses it), elevation,
    /// height, width; verdict (0 valid, 1 too narrow, 2 too steep, 3 unknown, 4 wall). What is unknown is NaN.
    pub fn segments(&self) -> Vec<f64> {
        self.now.trial.step().segments.iter().flat_map(encode::segment).collect()
    }

    /// The way to the chosen subgoal, from where the robot stands: world x, y and whether in reverse (0 or 1) for each place.
    /// Empty without one, and where subgoals are judged by the paper's height alone.
    pub fn way(&self) -> Vec<f64> {
        let places = self.now.trial.step().path.iter();
        places
            .flat_map(|one| [one.position_m.x, one.position_m.y, f64::from(u8::from(one.reverse))])
            .collect()
    }

    /// Eighteen numbers for each subgoal: azimuth and elevation in the sensor frame; world x, y, z; chosen (0 or 1); refusal
    /// (0 none, 1 tilt, 2 unseen); index of its segment (-1 for a place that is not on the skyline); the forecast's reach, mean risk, largest
    /// roll and pitch, and why it ends (0 whole, 1 tilt, 2 unseen), NaN without one; the weighted costs of direction,
    /// distance, steepness, commitment, dead_end. The goal itself, once in sight, is a subgoal without cost: NaN.
    pub fn subgoals(&self) -> Vec<f64> {
        let step = self.now.trial.step();
        let numbered = step.subgoals.iter().enumerate();
        numbered.flat_map(|(index, one)| encode::subgoal(one, step.chosen == Some(index))).collect()
    }
}

/// Copies as many values as fit, in single precision.
fn narrow(from: &[f64], to: &mut [f32]) {
    for (to, &from) in to.iter_mut().zip(from) {
        *to = from as f32;
    }
}
