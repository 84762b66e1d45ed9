//! The page of the comparison.

use std::collections::BTreeMap;
use std::fmt::{self, Write as _};

use super::{Driven, Drives, Simulator};

/// What is compared with what: the same sensing, moved by the physics engine and by our kinematics.
const PAIRS: [(Simulator, Simulator); 2] =
    [(Simulator::Field, Simulator::MujocoField), (Simulator::Ideal, Simulator::Mujoco)];

/// The drives of each task, by name, in the order of tasks.
type ByTask<'a> = Vec<(&'a str, BTreeMap<Simulator, &'a Driven>)>;

/// The page, in Markdown.
pub(super) fn page(drives: &Drives) -> Result<String, fmt::Error> {
    let tasks = by_task(drives);
    let mut text = String::from("# Agreement with a physics engine\n\n");
    writeln!(
        text,
        "Written by `cargo xtask physics`: preset `default` on {} tasks, each once. `ideal` and `field` are our own kinematic world; in \
         `mujoco` and `mujoco-field` MuJoCo moves the robot, with exact sensing and pose, or with sensing, pose and dead time of commands \
         as in `field`.\n",
        tasks.len()
    )?;
    simulators(&mut text, &tasks)?;
    for pair in PAIRS {
        agreement(&mut text, &tasks, pair)?;
    }
    writeln!(text, "\n## By task\n")?;
    writeln!(
        text,
        "Outcome, path, largest |roll| and |pitch| below 5 Hz. Limits are 30° of roll and 45° of pitch. [What the model is, and \
         why they differ](../design/physics.md).\n"
    )?;
    by_task_table(&mut text, &tasks)?;
    failures(&mut text, &tasks)?;
    Ok(text)
}

fn by_task(drives: &Drives) -> ByTask<'_> {
    let mut tasks: ByTask<'_> = Vec::new();
    for (job, driven) in drives {
        let name = job.task.name.as_str();
        match tasks.last_mut().filter(|(last, _)| *last == name) {
            Some((_, by_simulator)) => {
                by_simulator.insert(job.simulator, driven);
            }
            None => tasks.push((name, BTreeMap::from([(job.simulator, driven)]))),
        }
    }
    tasks
}

fn has_reached(driven: &Driven) -> bool {
    driven.outcome == "reached"
}

/// The table of what each simulator does to the robot.
fn simulators(text: &mut String, tasks: &ByTask<'_>) -> fmt::Result {
    writeln!(
        text,
        "| | reached | path | time | turned | slid aside | roll off the plane | pitch off the plane | body touched |"
    )?;
    writeln!(text, "|---|---:|---:|---:|---:|---:|---:|---:|---:|")?;
    for simulator in Simulator::ALL {
        let drives: Vec<&Driven> = tasks.iter().filter_map(|(_, by)| by.get(&simulator).copied()).collect();
        let sum = |value: fn(&Driven) -> f64| drives.iter().map(|driven| value(driven)).sum::<f64>();
        let middle = |value: fn(&Driven) -> f64| median(drives.iter().map(|driven| value(driven)).collect());
        writeln!(
            text,
            "| `{}` | {} of {} | {:.0} m | {:.0} s | {:.2} | {:.1} m | {:.1}° | {:.1}° | {:.0} s |",
            simulator.name(),
            drives.iter().filter(|driven| has_reached(driven)).count(),
            drives.len(),
            sum(|driven| driven.path_m),
            sum(|driven| driven.time_s),
            middle(|driven| driven.turn_ratio),
            100.0 * sum(|driven| driven.aside_m) / sum(|driven| driven.path_m),
            middle(|driven| driven.off_plane_roll_rad.to_degrees()),
            middle(|driven| driven.off_plane_pitch_rad.to_degrees()),
            sum(|driven| driven.body_touched_s),
        )?;
    }
    writeln!(
        text,
        "\nPath, time and touch are sums over the tasks; *turned* is the turn over the commanded one, *off the plane* what 99 % of a drive \
         do not exceed beside a body on four rigid contacts: medians over the tasks. *Slid aside* is for 100 m of path."
    )
}

/// Sentences on where two of them agree.
fn agreement(text: &mut String, tasks: &ByTask<'_>, (own, physics): (Simulator, Simulator)) -> fmt::Result {
    let pairs: Vec<(&str, &Driven, &Driven)> =
        tasks.iter().filter_map(|(name, by)| Some((*name, *by.get(&own)?, *by.get(&physics)?))).collect();
    let alike = pairs.iter().filter(|(_, own, physics)| own.outcome == physics.outcome).count();
    let both: Vec<&(&str, &Driven, &Driven)> =
        pairs.iter().filter(|(_, own, physics)| has_reached(own) && has_reached(physics)).collect();
    write!(
        text,
        "\n**`{}` and `{}`** end alike in {alike} of {} tasks",
        own.name(),
        physics.name(),
        pairs.len()
    )?;
    let others: Vec<String> = pairs
        .iter()
        .filter(|(_, own, physics)| own.outcome != physics.outcome)
        .map(|(name, own, physics)| format!("{name}: {}, {}", own.outcome, physics.outcome))
        .collect();
    if !others.is_empty() {
        write!(text, " (others: {})", others.join("; "))?;
    }
    if both.is_empty() {
        return writeln!(text, ".");
    }
    let differences = |value: fn(&Driven) -> f64| -> Vec<f64> {
        both.iter().map(|(_, own, physics)| value(physics) - value(own)).collect()
    };
    let ratios: Vec<f64> = both.iter().map(|(_, own, physics)| physics.path_m / own.path_m).collect();
    let degrees = |value| {
        let signed: Vec<f64> = differences(value).into_iter().map(f64::to_degrees).collect();
        let most = signed.iter().fold(0.0_f64, |most, other| most.max(other.abs()));
        format!("{:+.1}° (at most {most:.1}°)", median(signed))
    };
    let near = ratios.iter().filter(|ratio| (**ratio - 1.0).abs() <= 0.05).count();
    writeln!(
        text,
        ". In the {} that both reach, the physics engine's path is {:.3} of ours (median; within 5 % in {near}, {:.2} to {:.2}), its largest \
         roll differs by {}, its largest pitch by {}.",
        both.len(),
        median(ratios.clone()),
        ratios.iter().copied().fold(f64::INFINITY, f64::min),
        ratios.iter().copied().fold(0.0, f64::max),
        degrees(|driven| driven.max_abs_roll_rad),
        degrees(|driven| driven.max_abs_pitch_rad),
    )
}

fn by_task_table(text: &mut String, tasks: &ByTask<'_>) -> fmt::Result {
    writeln!(
        text,
        "| task | {} |",
        Simulator::ALL.map(|simulator| format!("`{}`", simulator.name())).join(" | ")
    )?;
    writeln!(text, "|---|{}", "---|".repeat(Simulator::ALL.len()))?;
    for (name, by) in tasks {
        let cells = Simulator::ALL
            .map(|simulator| by.get(&simulator).map_or_else(String::new, |driven| cell(driven)));
        writeln!(text, "| {name} | {} |", cells.join(" | "))?;
    }
    Ok(())
}

fn cell(driven: &Driven) -> String {
    let Driven { outcome, path_m, max_abs_roll_rad, max_abs_pitch_rad, .. } = driven;
    let outcome = if has_reached(driven) { outcome.clone() } else { format!("**{outcome}**") };
    format!(
        "{outcome}, {path_m:.1} m, {:.1}°, {:.1}°",
        max_abs_roll_rad.to_degrees(),
        max_abs_pitch_rad.to_degrees()
    )
}

/// The list of drives that did not reach.
fn failures(text: &mut String, tasks: &ByTask<'_>) -> fmt::Result {
    writeln!(text, "\n## Drives that did not reach\n")?;
    let mut any = false;
    for (name, by) in tasks {
        for (simulator, driven) in by.iter().filter(|(_, driven)| !has_reached(driven)) {
            any = true;
            let reason = driven.reason.as_ref().map_or_else(String::new, |reason| format!(": {reason}"));
            writeln!(
                text,
                "- {name}, `{}`: {} after {:.0} s, {:.1} m before the goal; body touched for {:.1} s{reason}.",
                simulator.name(),
                driven.outcome,
                driven.time_s,
                driven.distance_to_goal_m,
                driven.body_touched_s,
            )?;
        }
    }
    if any { Ok(()) } else { writeln!(text, "None.") }
}

/// The middle value, or the mean of the middle two; 0 of none.
pub(super) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    let middle = values.len() / 2;
    match (values.get(middle.wrapping_sub(1)), values.get(middle)) {
        (Some(low), Some(high)) if values.len().is_multiple_of(2) => (low + high) / 2.0,
        (_, Some(high)) => *high,
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Job, tasks::Task};
    use super::*;

    fn driven(outcome: &str, path_m: f64, roll_rad: f64) -> Driven {
        Driven {
            outcome: outcome.to_owned(),
            reason: (outcome != "reached").then(|| "the body ran into rock 2".to_owned()),
            time_s: 50.0,
            path_m,
            max_abs_roll_rad: roll_rad,
            max_abs_pitch_rad: 0.1,
            distance_to_goal_m: 0.4,
            turn_ratio: 0.9,
            aside_m: 1.0,
            off_plane_roll_rad: 0.02,
            off_plane_pitch_rad: 0.03,
            body_touched_s: 0.5,
        }
    }

    fn drives() -> Drives {
        let mut drives = Drives::new();
        for (group, name) in [(0, "ht"), (2, "hard-35-0001"), (1, "moderate-35-0001")] {
            for simulator in Simulator::ALL {
                let crashes = name.starts_with("hard") && simulator == Simulator::MujocoField;
                let is_physical = matches!(simulator, Simulator::Mujoco | Simulator::MujocoField);
                let outcome = if crashes { "collision" } else { "reached" };
                let path_m = if is_physical { 41.0 } else { 40.0 };
                let task = Task::named(group, name);
                drives.insert(
                    Job { task, simulator },
                    driven(outcome, path_m, if is_physical { 0.3 } else { 0.2 }),
                );
            }
        }
        drives
    }

    #[test]
    fn the_page_has_every_task_in_order_and_says_where_they_agree() {
        let page = page(&drives()).unwrap();
        let place = |text: &str| page.find(text).unwrap_or_else(|| panic!("{text}\n{page}"));
        assert!(place("| ht |") < place("| moderate-35-0001 |"));
        assert!(place("| moderate-35-0001 |") < place("| hard-35-0001 |"));
        place("| `mujoco-field` | 2 of 3 | 123 m | 150 s | 0.90 | 2.4 m | 1.1° | 1.7° | 2 s |");
        place(
            "**`field` and `mujoco-field`** end alike in 2 of 3 tasks (others: hard-35-0001: reached, collision). In the 2 that both",
        );
        place(
            "path is 1.025 of ours (median; within 5 % in 2, 1.02 to 1.02), its largest roll differs by +5.7° (at most 5.7°)",
        );
        place("**`ideal` and `mujoco`** end alike in 3 of 3 tasks. In the 3 that both reach");
        place(
            "| reached, 40.0 m, 11.5°, 5.7° | reached, 41.0 m, 17.2°, 5.7° | **collision**, 41.0 m, 17.2°, 5.7° |",
        );
        place(
            "- hard-35-0001, `mujoco-field`: collision after 50 s, 0.4 m before the goal; body touched for 0.5 s: the body ran into rock 2.",
        );
        assert!(
            page.starts_with("# Agreement with a physics engine\n\nWritten by"),
            "the index shows its beginning"
        );
    }

    #[test]
    fn a_page_of_nothing_that_failed_says_so() {
        let mut drives = drives();
        drives.retain(|_, driven| has_reached(driven));
        assert!(page(&drives).unwrap().ends_with("## Drives that did not reach\n\nNone.\n"));
    }

    #[test]
    fn the_median_is_in_the_middle() {
        assert!((median(vec![3.0, 1.0, 2.0]) - 2.0).abs() < 1e-12);
        assert!((median(vec![4.0, 1.0, 2.0, 3.0]) - 2.5).abs() < 1e-12);
        assert!((median(vec![5.0]) - 5.0).abs() < 1e-12);
        assert!(median(Vec::new()).abs() < 1e-12);
    }
}
