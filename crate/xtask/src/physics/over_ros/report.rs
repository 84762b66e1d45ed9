//! The page of the drives over ROS.

use std::fmt::{self, Write as _};

use super::super::report::median;
use super::{Driven, Drives, Job, ROUTES};

/// Without links: a summary elsewhere begins with it.
const INTRODUCTION: &str = "\
Written by `cargo xtask physics --over-ros`. The program `mapless-node` drives a Husky in MuJoCo over DDS on the loopback, in simulated time. It \
gets what a Clearpath A200 tells: `/clock`, clouds of a VLP-16 with the time of each point, swept along the motion; odometry of the wheels alone, \
in two dimensions, whatever they slip; an IMU with the biases and noises of an Xsens MTi-30; the emergency stop. It gets no true pose. Its goal \
comes by `NavigateToPose`, in the odometry's frame. Commands reach the wheels 0.1 s late, and sensing is as in the preset `field`. MuJoCo's true \
pose judges.
";
const LINKS: &str = "\
[What the robot tells, and what is left to chance](../design/physics.md#how-does-the-node-itself-drive). [The node's \
file](../../crate/physics/over_ros.yaml).
";

/// The page, in Markdown.
pub(super) fn page(drives: &Drives) -> Result<String, fmt::Error> {
    let mut text = format!("# The node in a physics engine, over ROS 2\n\n{INTRODUCTION}\n");
    by_route(&mut text, drives)?;
    writeln!(
        text,
        "\nMedian, and the most. *From the goal* is in truth, when the node says that it has arrived: within 0.5 m by its own estimate. *Off* is \
         how far odometry and estimate are from the truth at the end, seen from above, and in the heading; in percent of the path.\n"
    )?;
    writeln!(text, "## By drive\n\n{LINKS}")?;
    by_drive(&mut text, drives)?;
    failures(&mut text, drives)?;
    Ok(text)
}

/// The drives of each route.
fn routes(drives: &Drives) -> impl Iterator<Item = (&'static str, Vec<&Driven>)> {
    ROUTES.iter().enumerate().filter_map(|(index, name)| {
        let of_route: Vec<&Driven> =
            drives.iter().filter(|(job, _)| job.index == index).map(|(_, driven)| driven).collect();
        (!of_route.is_empty()).then_some((*name, of_route))
    })
}

fn by_route(text: &mut String, drives: &Drives) -> fmt::Result {
    writeln!(
        text,
        "| route | reached | path | time | roll | pitch | from the goal | odometry off | its heading | estimate off | its heading |"
    )?;
    writeln!(text, "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|")?;
    for (name, driven) in routes(drives) {
        let column =
            |value: fn(&Driven) -> f64| -> Vec<f64> { driven.iter().map(|driven| value(driven)).collect() };
        let metres = |value: fn(&Driven) -> f64| both(column(value), 2, " m");
        let degrees = |value: fn(&Driven) -> f64| {
            both(column(value).into_iter().map(|rad| rad.abs().to_degrees()).collect(), 1, "°")
        };
        let drift = |value: fn(&Driven) -> f64| {
            let shares = driven.iter().map(|driven| 100.0 * value(driven) / driven.path_m).collect();
            format!("{} ({})", metres(value), both(shares, 1, " %"))
        };
        writeln!(
            text,
            "| {name} | {} of {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |",
            driven.iter().filter(|driven| driven.has_reached()).count(),
            driven.len(),
            both(column(|driven| driven.path_m), 1, " m"),
            both(column(|driven| driven.time_s), 0, " s"),
            degrees(|driven| driven.max_abs_roll_rad),
            degrees(|driven| driven.max_abs_pitch_rad),
            metres(|driven| driven.distance_to_goal_m),
            drift(|driven| driven.odometry_off_m),
            degrees(|driven| driven.odometry_off_rad),
            drift(|driven| driven.estimate_off_m),
            degrees(|driven| driven.estimate_off_rad),
        )?;
    }
    Ok(())
}

/// Median and largest of some values, rounded.
fn both(values: Vec<f64>, digits: usize, unit: &str) -> String {
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    format!("{:.digits$}, {most:.digits$}{unit}", median(values))
}

fn by_drive(text: &mut String, drives: &Drives) -> fmt::Result {
    writeln!(
        text,
        "| route, seed | outcome | recoveries | path | time | roll | pitch | from the goal | odometry off | estimate off |"
    )?;
    writeln!(text, "|---|---|---:|---:|---:|---:|---:|---:|---:|---:|")?;
    for (job, driven) in drives {
        let outcome =
            if driven.has_reached() { driven.outcome.clone() } else { format!("**{}**", driven.outcome) };
        writeln!(
            text,
            "| {}, {} | {outcome} | {} | {:.1} m | {:.0} s | {:.1}° | {:.1}° | {:.2} m | {:.2} m, {:.1}° | {:.2} m, {:.1}° |",
            job.route(),
            job.seed,
            driven.recoveries,
            driven.path_m,
            driven.time_s,
            driven.max_abs_roll_rad.to_degrees(),
            driven.max_abs_pitch_rad.to_degrees(),
            driven.distance_to_goal_m,
            driven.odometry_off_m,
            driven.odometry_off_rad.to_degrees(),
            driven.estimate_off_m,
            driven.estimate_off_rad.to_degrees(),
        )?;
    }
    let most = |value: fn(&Driven) -> f64| drives.values().map(value).fold(0.0, f64::max);
    writeln!(
        text,
        "\n*Recoveries*: times that the planner began to backtrack or to search. The estimate is the node's own estimator on the same \
         messages. What the node said of the distance to its goal differed from it by \
         at most {:.2} m. Scans that the planner did not answer: {}.",
        most(|driven| driven.feedback_off_m),
        drives.values().map(|driven| driven.unanswered).sum::<u64>(),
    )
}

fn failures(text: &mut String, drives: &Drives) -> fmt::Result {
    writeln!(text, "\n## Drives that did not reach\n")?;
    let failed: Vec<(&Job, &Driven)> = drives.iter().filter(|(_, driven)| !driven.has_reached()).collect();
    for (job, driven) in &failed {
        let reason = driven.reason.as_ref().map_or_else(String::new, |reason| format!(": {reason}"));
        writeln!(
            text,
            "- {} with seed {}: {} after {:.0} s, {:.1} m before the goal{reason}.",
            job.route(),
            job.seed,
            driven.outcome,
            driven.time_s,
            driven.distance_to_goal_m,
        )?;
    }
    if failed.is_empty() { writeln!(text, "None.") } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn driven(outcome: &str, path_m: f64, odometry_off_m: f64) -> Driven {
        Driven {
            outcome: outcome.to_owned(),
            reason: (outcome != "reached").then(|| "9000: the robot is tilted too far".to_owned()),
            time_s: 60.0,
            took_s: 30.0,
            path_m,
            max_abs_roll_rad: 0.1,
            max_abs_pitch_rad: 0.2,
            distance_to_goal_m: 0.4,
            odometry_off_m,
            odometry_off_rad: -0.5,
            estimate_off_m: 0.3,
            estimate_off_rad: 0.01,
            feedback_off_m: 0.02,
            recoveries: 2,
            unanswered: 1,
        }
    }

    #[test]
    fn the_page_has_medians_and_the_most_of_each_route_and_names_what_failed() {
        let mut drives = Drives::new();
        for (index, seed, outcome, path_m, off_m) in [
            (0, 1, "reached", 30.0, 3.0),
            (0, 2, "reached", 40.0, 8.0),
            (0, 3, "aborted", 20.0, 1.0),
            (2, 1, "reached", 50.0, 5.0),
        ] {
            drives.insert(Job { index, seed, domain: 61, goal: &[] }, driven(outcome, path_m, off_m));
        }
        let page = page(&drives).unwrap();
        for expected in [
            "| ht | 2 of 3 | 30.0, 40.0 m | 60, 60 s | 5.7, 5.7° | 11.5, 11.5° | 0.40, 0.40 m | \
             3.00, 8.00 m (10.0, 20.0 %) | 28.6, 28.6° | ",
            "| vta | 1 of 1 |",
            "| ht, 3 | **aborted** | 2 | 20.0 m |",
            "by at most 0.02 m. Scans that the planner did not answer: 4.",
            "- ht with seed 3: aborted after 60 s, 0.4 m before the goal: 9000: the robot is tilted too far.",
        ] {
            assert!(page.contains(expected), "{expected}\n{page}");
        }
        assert!(!page.contains("| gsb |"));
    }
}
