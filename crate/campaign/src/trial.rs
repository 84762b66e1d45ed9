//! Runs one trial of a campaign; every failure becomes its result.

use std::any::Any;
use std::fmt::Write as _;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use mapless_trials::{Metrics, Trial};

use crate::journal::{Entry, Timing, TrialResult};
use crate::navigators;
use crate::plan::{Route, TrialSpec};

/// Columns of a trajectory: one row for each planning period, and one for the final state.
const TRAJECTORY_HEADER: &str = "time_s,x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad,speed_m_s,turn_rate_rad_s\n";

/// The outcome of a run.
pub(crate) struct Finished {
    pub(crate) entry: Entry,
    /// As CSV, if it is kept.
    pub(crate) trajectory: Option<String>,
}

/// Runs the trial. An error or a panic in it becomes its result.
pub(crate) fn run(spec: &TrialSpec, route: &Route) -> Finished {
    let began = Instant::now();
    let mut times = Vec::new();
    let mut trajectory = spec.keeps_trajectory.then(|| TRAJECTORY_HEADER.to_owned());
    let outcome = guarded(|| drive(spec, route, &mut times, trajectory.as_mut()));
    let timing = Timing::of(began.elapsed(), times);
    let result = match outcome {
        Ok(result) => result,
        Err(error) => TrialResult { id: spec.id.clone(), error: Some(error), ..TrialResult::default() },
    };
    Finished { entry: Entry { result, timing }, trajectory }
}

/// The result of `work`, with a panic as an error.
fn guarded<T>(work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| Err(format!("panic: {}", message(&*panic))))
}

fn message(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("without a message")
}

fn drive(
    spec: &TrialSpec,
    route: &Route,
    times: &mut Vec<Duration>,
    mut trajectory: Option<&mut String>,
) -> Result<TrialResult, String> {
    let config = spec.config.as_ref().as_ref().map_err(Clone::clone)?;
    let (own, field) = (&route.loaded.scenario, &route.loaded.terrain.field);
    let mut scenario = own.clone();
    if let Some(condition) = &spec.reality {
        let reality = own.reality.with_section(&condition.section).map_err(|fault| fault.to_string())?;
        scenario.reality = reality;
    }
    let scenario = &scenario;
    let navigator = navigators::navigator(&spec.planner, spec.truth, field, scenario, config, spec.seed)?;
    let mut trial = Trial::with_navigator(field.clone(), scenario, navigator, spec.seed)
        .map_err(|error| error.to_string())?;
    let outcome = loop {
        if let Some(text) = &mut trajectory {
            write_state(text, &trial);
        }
        trial.look();
        let began = Instant::now();
        trial.plan();
        times.push(began.elapsed());
        if let Some(outcome) = trial.act() {
            break outcome;
        }
    };
    if let Some(text) = &mut trajectory {
        write_state(text, &trial);
    }
    let metrics = trial.metrics();
    finite(&metrics)?;
    Ok(TrialResult {
        id: spec.id.clone(),
        outcome: Some(outcome),
        stop_reason: trial.end_reason(),
        error: None,
        metrics: Some(metrics),
        ride: Some(trial.ride()),
        sim_time_s: Some(trial.time_s()),
        ticks: Some(trial.ticks()),
        digest: Some(trial.digest()),
    })
}

fn write_state<N: mapless_trials::Navigator>(text: &mut String, trial: &Trial<N>) {
    let values: String = trial.motion().iter().map(|value| format!(",{value:.6}")).collect();
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{:.3}{values}", trial.time_s());
}

/// JSON has no word for a value that is not finite.
fn finite(metrics: &Metrics) -> Result<(), String> {
    if metrics.values().iter().all(|value| value.is_finite()) {
        Ok(())
    } else {
        Err(format!("metrics that are no numbers: {metrics:?}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_an_error_with_its_message() {
        let shown = std::panic::take_hook();
        std::panic::set_hook(Box::new(|_| {}));
        let results = [
            guarded::<()>(|| panic!("at tick {}", 3)),
            guarded::<()>(|| panic!("plainly")),
            guarded::<()>(|| std::panic::panic_any(7)),
        ];
        std::panic::set_hook(shown);
        let errors = results.map(Result::unwrap_err);
        assert_eq!(errors, ["panic: at tick 3", "panic: plainly", "panic: without a message"]);
        assert_eq!(guarded(|| Ok(1)), Ok(1));
    }

    #[test]
    fn metrics_must_be_numbers() {
        assert!(finite(&Metrics::default()).is_ok());
        let error = finite(&Metrics { distance_m: f64::NAN, ..Metrics::default() }).unwrap_err();
        assert!(error.contains("NaN"), "{error}");
    }
}
