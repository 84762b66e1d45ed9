//! The final files of a campaign.

use std::path::{Path, PathBuf};

use mapless_trials::{Metrics, Ride};
use rayon::prelude::*;

use crate::columns;
use crate::error::CampaignError;
use crate::file::Benchmark;
use crate::files::{remove_unfinished, write_atomically};
use crate::journal::{Entries, Timing, TrialResult};
use crate::plan::{Plan, Route, TrialSpec};
use crate::row::TrialRow;

/// `campaign.json`: the parts of a campaign, for its report.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// Name of the campaign.
    pub name: String,
    /// Its file, as named when it ran.
    pub file: String,
    /// Its identity.
    pub hash: String,
    /// Planners in the campaign file's order.
    pub planners: Vec<String>,
    /// Routes by name.
    pub routes: Vec<ManifestRoute>,
    /// Seeds in the campaign file's order.
    pub seeds: Vec<u64>,
    /// The conditions beside the scenarios' own `[reality]`, in the campaign file's order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub realities: Vec<ManifestReality>,
    /// Whose rules the report applies too.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub benchmark: Option<Benchmark>,
}

/// A route and its file.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ManifestRoute {
    /// Name of the route.
    pub name: String,
    /// Its scenario file, as named when the campaign ran.
    pub file: String,
}

/// A condition and what it sets.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ManifestReality {
    /// Its name.
    pub name: String,
    /// `key=value` of everything that it sets in `[reality]`, separated by spaces.
    pub sets: String,
}

impl ManifestReality {
    /// The preset of `[reality]` that it is; `None` if it sets anything else.
    pub(crate) fn preset(&self) -> Option<&str> {
        let word = self.sets.strip_prefix("preset=\"")?.strip_suffix('"')?;
        (!word.contains(' ')).then_some(word)
    }
}

/// One row of `timing.csv`.
#[derive(serde::Serialize)]
struct TimingRow<'a> {
    id: &'a str,
    wall_s: f64,
    planner_p50_ms: f64,
    planner_p99_ms: f64,
    planner_max_ms: f64,
}

/// Writes the final files; `entries` must hold every trial of the plan. The oracle searches `jobs` paths at a
/// time.
pub(crate) fn write(plan: &Plan, entries: &Entries, folder: &Path, jobs: usize) -> Result<(), CampaignError> {
    let done = plan.trials.iter().filter_map(|spec| Some((spec, entries.get(&spec.id)?)));
    let threads = jobs.min(plan.routes.len());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| CampaignError::write(folder, error))?;
    let oracle_lengths_m: Vec<Option<f64>> =
        pool.install(|| plan.routes.par_iter().map(Route::oracle_length_m).collect());
    let rows: Vec<TrialRow> = (done.clone())
        .map(|(spec, entry)| row(plan, spec, oracle_lengths_m[spec.route], &entry.result))
        .collect();
    let timings: Vec<TimingRow<'_>> = done.map(|(spec, entry)| timing_row(&spec.id, entry.timing)).collect();
    // Every trial has run, so no process writes trajectories any more.
    remove_unfinished(&folder.join("trajectories"))?;
    let path = |name: &str| folder.join(name);
    let manifest = Manifest {
        name: plan.campaign.name.clone(),
        file: plan.file.clone(),
        hash: plan.hash.clone(),
        planners: plan.campaign.planners.clone(),
        routes: plan
            .routes
            .iter()
            .map(|r| ManifestRoute { name: r.name.clone(), file: r.file.clone() })
            .collect(),
        seeds: plan.campaign.seeds.clone(),
        realities: plan
            .campaign
            .realities
            .iter()
            .map(|condition| ManifestReality { name: condition.name.clone(), sets: condition.sets() })
            .collect(),
        benchmark: plan.campaign.benchmark,
    };
    let json = serde_json::to_string_pretty(&manifest)
        .map_err(|e| CampaignError::write(&path("campaign.json"), e))?;
    write_atomically(&path("campaign.json"), (json + "\n").as_bytes())?;
    let parquet = columns::parquet(&rows).map_err(|e| CampaignError::write(&path("trials.parquet"), e))?;
    write_atomically(&path("trials.parquet"), &parquet)?;
    write_atomically(&path("timing.csv"), &csv(&path("timing.csv"), &timings)?)?;
    // The last file, because readers of a campaign begin with it.
    write_atomically(&path("trials.csv"), &csv(&path("trials.csv"), &rows)?)
}

fn csv<T: serde::Serialize>(path: &Path, rows: &[T]) -> Result<Vec<u8>, CampaignError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row).map_err(|error| CampaignError::write(path, error))?;
    }
    writer.into_inner().map_err(|error| CampaignError::write(path, error))
}

fn row(plan: &Plan, spec: &TrialSpec, oracle_length_m: Option<f64>, result: &TrialResult) -> TrialRow {
    let route = &plan.routes[spec.route];
    let metric = |value: fn(&Metrics) -> f64| result.metrics.as_ref().map(value);
    let ride = |value: fn(&Ride) -> f64| result.ride.as_ref().map(value);
    let json = spec.config.as_ref().as_ref().ok().and_then(|config| serde_json::to_string(config).ok());
    TrialRow {
        id: spec.id.clone(),
        campaign: plan.hash.clone(),
        planner: spec.planner.clone(),
        route: route.name.clone(),
        truth: spec.truth.name().to_owned(),
        parameters: spec.parameters.clone(),
        reality: spec.reality.as_ref().map_or_else(String::new, |reality| reality.name.clone()),
        seed: spec.seed,
        outcome: result.outcome.map_or("error", mapless_trials::Outcome::name).to_owned(),
        stop_reason: result.stop_reason.clone(),
        error: result.error.clone(),
        distance_m: metric(|m| m.distance_m),
        max_abs_roll_rad: metric(|m| m.max_abs_roll_rad),
        max_abs_pitch_rad: metric(|m| m.max_abs_pitch_rad),
        mean_vibration_rad_s: metric(|m| m.mean_vibration_rad_s),
        mean_elevation_rate_cm_s: metric(|m| m.mean_elevation_rate_cm_s),
        curvature_change_rad_m: metric(|m| m.curvature_change_rad_m),
        mean_abs_roll_rad: ride(|r| r.mean_abs_roll_rad),
        mean_abs_pitch_rad: ride(|r| r.mean_abs_pitch_rad),
        longest_standstill_s: ride(|r| r.longest_standstill_s),
        sim_time_s: result.sim_time_s,
        ticks: result.ticks,
        straight_m: route.straight_m(),
        oracle_length_m,
        digest: result.digest.clone(),
        configuration: json.unwrap_or_default(),
    }
}

fn timing_row(id: &str, timing: Timing) -> TimingRow<'_> {
    let Timing { wall_s, planner_p50_ms, planner_p99_ms, planner_max_ms } = timing;
    TimingRow { id, wall_s, planner_p50_ms, planner_p99_ms, planner_max_ms }
}

/// The file of trial `id`'s trajectory.
pub(crate) fn trajectory_path(folder: &Path, id: &str) -> PathBuf {
    folder.join("trajectories").join(format!("{id}.csv"))
}

pub(crate) fn write_trajectory(folder: &Path, id: &str, text: &str) -> Result<(), CampaignError> {
    let path = trajectory_path(folder, id);
    let trajectories = folder.join("trajectories");
    std::fs::create_dir_all(&trajectories).map_err(|error| CampaignError::write(&trajectories, error))?;
    write_atomically(&path, text.as_bytes())
}

impl Manifest {
    /// Reads a finished campaign.
    ///
    /// # Errors
    /// [`CampaignError`] when the campaign has not finished or its files are not as they were written.
    pub fn read(folder: &Path) -> Result<(Self, Vec<TrialRow>), CampaignError> {
        let path = folder.join("trials.csv");
        let file = std::fs::File::open(&path).map_err(|error| {
            CampaignError::read(&path, format_args!("{error}: expected a campaign that has finished"))
        })?;
        let rows = csv::Reader::from_reader(file).deserialize().collect::<Result<Vec<TrialRow>, _>>();
        let rows = rows.map_err(|error| CampaignError::content(&path, error))?;
        let path = folder.join("campaign.json");
        let text = std::fs::read_to_string(&path).map_err(|error| CampaignError::read(&path, error))?;
        let manifest: Self =
            serde_json::from_str(&text).map_err(|error| CampaignError::content(&path, error))?;
        Ok((manifest, rows))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn a_campaign_from_before_these_columns_and_benchmarks_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let expected = testing::row("default", "a", "none", 1, "reached");
        let written = csv(Path::new("trials.csv"), &[&expected]).unwrap();
        let mut old = csv::Writer::from_writer(Vec::new());
        let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(&*written);
        let lines: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
        let is_new =
            |name: &str| name.starts_with("mean_abs_") || ["longest_standstill_s", "reality"].contains(&name);
        assert_eq!(lines[0].iter().filter(|name| is_new(name)).count(), 4);
        for line in &lines {
            old.write_record(
                line.iter().zip(&lines[0]).filter(|(_, name)| !is_new(name)).map(|(value, _)| value),
            )
            .unwrap();
        }
        std::fs::write(folder.path().join("trials.csv"), old.into_inner().unwrap()).unwrap();
        let manifest = testing::results(&["default"], &["a"], Vec::new()).manifest;
        let json = serde_json::to_string(&manifest).unwrap();
        assert!(!json.contains("benchmark") && !json.contains("realities"), "{json}");
        std::fs::write(folder.path().join("campaign.json"), json).unwrap();
        assert_eq!(Manifest::read(folder.path()).unwrap(), (manifest, vec![expected]));
    }
}
