//! The tables and the figure.

use std::fmt::Write as _;

use super::COSTS;
use super::measured::{Measured, Times, Trial};
use super::runner::Side;
use mapless_figures::plot::{Line, Plot, Scale};

/// A comparison with a peer: description, our benchmark, the peer's, its name, and the target ratio.
const AGAINST_PEERS: &[(&str, &str, &str, &str, f64)] = &[
    (
        "posterior, mean and variance on 360 × 30, n = 1823, m = 200",
        "posterior-200",
        "posterior-200",
        "gpflow",
        12.0,
    ),
    ("the same, m = 400", "posterior-400", "posterior-400", "gpflow", 12.0),
    ("bound and all gradients, n = 1823, m = 200", "bound-200", "bound-200", "gpflow", 6.0),
    (
        "what a tick needs of 1823 cells (ours: the whole step; gpflow: 360 × 30, m = 400)",
        "tick-level",
        "posterior-400",
        "gpflow",
        60.0,
    ),
    (
        "scan of 28 800 rays, 1000 × 1000 heights, hills",
        "scan-rugged-1000",
        "scan-rugged-1000",
        "Embree",
        1.0,
    ),
    ("the same, with 100 objects", "scan-objects-1000", "scan-objects-1000", "Embree", 1.0),
    ("the same, level ground", "scan-level-1000", "scan-level-1000", "Embree", 1.0),
    ("hills, both as wasm in Node", "scan-rugged-1000", "scan-rugged-1000", "Jolt", 1.0),
    ("level ground, both as wasm in Node", "scan-level-1000", "scan-level-1000", "Jolt", 1.0),
];

/// Scans without and with objects.
const AMONG_OBJECTS: &[(&str, &str, &str)] = &[
    ("the whole scan", "scan-rugged-1000", "scan-objects-1000"),
    ("as far as the planner looks, as in a trial", "scan-near-1000", "scan-near-objects-1000"),
];
/// Largest allowed time of a scan with 100 objects, as a multiple of one without.
const MOST_WITH_OBJECTS: f64 = 1.3;
/// Largest allowed time of a trial in `field`, as a multiple of one in an ideal world.
const MOST_IN_FIELD: f64 = 1.5;

/// Benchmarks that run as wasm, with their headings.
const AS_WASM: &[(&str, &str)] = &[
    ("drive", "planner step along drives"),
    ("tick-full", "planner step, 28 800 returns within 7 m, 5760 cells"),
    ("tick-level", "planner step, 1823 cells"),
    ("posterior-200", "posterior, m = 200"),
    ("posterior-400", "posterior, m = 400"),
    ("bound-200", "bound and gradients, m = 200"),
    ("scan-rugged-1000", "scan, hills"),
    ("scan-objects-1000", "scan, hills with 100 objects"),
    ("scan-level-1000", "scan, level ground"),
];

/// Largest allowed time of wasm, as a multiple of the native time.
const MOST_WASM: f64 = 3.0;
/// Largest allowed 99th percentile of the planner's steps, milliseconds.
const MOST_STEP_MS: [(Side, f64); 2] = [(Side::Native, 10.0), (Side::Chromium, 30.0)];
/// A trial must run this many times faster than real time.
const TIMES_REAL_TIME: f64 = 10.0;

fn verdict(met: bool) -> &'static str {
    if met { "met" } else { "**missed**" }
}

/// The whole report as Markdown.
pub(crate) fn report(measured: &Measured) -> anyhow::Result<String> {
    let mut text = format!(
        "# Benchmarks\n\n\
         Written by `cargo xtask bench --rounds {}`.\n\n{}.\n\n\
         Everyone runs on one thread, in double precision (Embree and Jolt in single), on the same inputs, which `crate/bench` makes by rule: the \
         1823 occupied cells that five rings and a part of the sixth see of undulating level ground, inducing inputs by farthest point, and the default preset's \
         hyperparameters (variance 1 m², length-scales 0.15 and 0.04 rad, alpha 10, noise 3 m²). gpflow is compiled by `tf.function`. \
         lightgp (0.1.2) is no peer: its sparse process knows the squared-exponential kernel alone, with one length-scale, in single \
         precision, and chooses the inducing inputs itself. \
         All are asked in turn, round by round, because the machine is not theirs alone; times are *fastest / median*, \
         and a target counts as met by the ratio of the fastest.\n",
        measured.rounds, measured.machine
    );
    against_peers(&mut text, measured)?;
    objects(&mut text, measured)?;
    wasm(&mut text, measured)?;
    steps(&mut text, measured)?;
    trials(&mut text, measured)?;
    peak(&mut text, measured)?;
    costs(&mut text, measured)?;
    text.push_str(&measured.memory.section());
    agreements(&mut text, measured)?;
    Ok(text)
}

fn against_peers(text: &mut String, measured: &Measured) -> anyhow::Result<()> {
    text.push_str(
        "\n## Against the peers\n\n| work | mapless, ms | peer, ms | times as fast | target | |\n|---|---:|---:|---:|---:|---|\n",
    );
    for &(heading, work, theirs, peer, target) in AGAINST_PEERS {
        let (side, peer_side) =
            if peer == "Jolt" { (Side::Node, Side::Jolt) } else { (Side::Native, Side::Peer) };
        let (ours, theirs) = (measured.times(work, side)?, measured.times(theirs, peer_side)?);
        let ratio = theirs.fastest / ours.fastest;
        writeln!(
            text,
            "| {heading} | {} | {peer} {} | {ratio:.1} / {:.1} | {target} | {} |",
            pair(ours),
            pair(theirs),
            theirs.median / ours.median,
            verdict(ratio >= target)
        )?;
    }
    writeln!(
        text,
        "\nEmbree has the objects as triangles. Jolt is an engine with a shape of its own for height fields, in its npm package's default build. \
         Its binding casts one ray a call from JavaScript; those calls alone, with rays that meet nothing, take {} ms.",
        pair(measured.times("calls", Side::Jolt)?)
    )?;
    Ok(())
}

/// What objects cost.
fn objects(text: &mut String, measured: &Measured) -> anyhow::Result<()> {
    write!(
        text,
        "\n## A scan with 100 objects\n\nTwenty posts, boxes, rocks, walls and gates each, 2.5 to 30 m from the sensor on the hills. A scan with them may \
         take {MOST_WITH_OBJECTS} times as long as one without.\n\n\
         | scan | where | without, ms | with, ms | with / without | |\n|---|---|---:|---:|---:|---|\n"
    )?;
    for (heading, without, with) in AMONG_OBJECTS {
        for side in [Side::Native, Side::Node, Side::Chromium] {
            let (without, with) = (measured.times(without, side)?, measured.times(with, side)?);
            let ratio = with.fastest / without.fastest;
            writeln!(
                text,
                "| {heading} | {side:?} | {} | {} | {ratio:.2} / {:.2} | {} |",
                pair(without),
                pair(with),
                with.median / without.median,
                verdict(ratio <= MOST_WITH_OBJECTS)
            )?;
        }
    }
    Ok(())
}

fn wasm(text: &mut String, measured: &Measured) -> anyhow::Result<()> {
    write!(
        text,
        "\n## Native, Node and Chromium\n\nThe drives go over all five terrains, with scans of 28 800 beams of which {:.0} return on average and which fill \
         up to {:.0} cells. Every round goes through the same repetitions; a time is the median over them, each the fastest over the rounds. \
         wasm may take {MOST_WASM} times as long for the planner's step.\n\n\
         | work | native, ms | Node, ms | Chromium, ms | Node / native | Chromium / native | |\n|---|---:|---:|---:|---:|---:|---|\n",
        measured.number("drive", "mean_returns")?,
        measured.number("drive", "most_cells")?,
    )?;
    for &(work, heading) in AS_WASM {
        let [native, node, chromium] =
            [Side::Native, Side::Node, Side::Chromium].map(|side| measured.quiet_times(work, side));
        let (native, node, chromium) = (native?.median, node?.median, chromium?.median);
        let slowest = node.max(chromium) / native;
        let met = if work == "drive" { verdict(slowest <= MOST_WASM) } else { "" };
        writeln!(
            text,
            "| {heading} | {} | {} | {} | {:.2} | {:.2} | {met} |",
            significant(native),
            significant(node),
            significant(chromium),
            node / native,
            chromium / native,
        )?;
    }
    Ok(())
}

fn steps(text: &mut String, measured: &Measured) -> anyhow::Result<()> {
    text.push_str(
        "\n## A planner step on a full scan\n\nNothing is thinned out. The slowest of all steps are those that something else on the machine interrupted; \
         the steps' own times, each the fastest over the rounds, leave most of that out. The target is judged for both.\n\n\
         | scans | where | median of all, ms | p99 of all, ms | p99 of the steps' own, ms | at most | all | own |\n|---|---|---:|---:|---:|---:|---|---|\n",
    );
    for (work, heading) in &AS_WASM[..2] {
        for (side, most) in MOST_STEP_MS {
            let (all, own) = (measured.times(work, side)?, measured.quiet_times(work, side)?);
            writeln!(
                text,
                "| {heading} | {side:?} | {:.2} | {:.2} | {:.2} | {most} | {} | {} |",
                all.median,
                all.p99,
                own.p99,
                verdict(all.p99 <= most),
                verdict(own.p99 <= most)
            )?;
        }
    }
    Ok(())
}

fn trials(text: &mut String, measured: &Measured) -> anyhow::Result<()> {
    write!(
        text,
        "\n## Whole trials\n\nScans, planner and motion with the preset `default`, natively on one thread, in an ideal world and in that of the reality \
         preset `field`, once each; processor time, the making of the ground included, in which other load on the machine counts little. At least {TIMES_REAL_TIME} times as fast as \
         real time in both, and `field` may take {MOST_IN_FIELD} times as long.\n\n\
         | scenario | simulated, s | computed, s | times real time | `field`: simulated, s | computed, s | times real time | `field` / ideal | |\n\
         |---|---:|---:|---:|---:|---:|---:|---:|---|\n"
    )?;
    for Trial { scenario, ideal, field } in &measured.trials {
        let (ideal_speed, field_speed) = (ideal.speed(), field.speed());
        let ratio = field.computed_s / ideal.computed_s;
        writeln!(
            text,
            "| {scenario} | {:.1} | {:.2} | {ideal_speed:.1} | {:.1} | {:.2} | {field_speed:.1} | {ratio:.2} | {} |",
            ideal.simulated_s,
            ideal.computed_s,
            field.simulated_s,
            field.computed_s,
            verdict(ideal_speed.min(field_speed) >= TIMES_REAL_TIME && ratio <= MOST_IN_FIELD)
        )?;
    }
    Ok(())
}

fn peak(text: &mut String, measured: &Measured) -> anyhow::Result<()> {
    let per_second = |work: &str| -> anyhow::Result<f64> {
        Ok(measured.number(work, "operations")? / measured.times(work, Side::Native)?.fastest * 1e-6)
    };
    let (peak, bound) = (per_second("peak")?, per_second("bound-200")?);
    write!(
        text,
        "\n## Share of the peak\n\nMultiplications followed by additions, unfused and in the widest registers, reach {peak:.1} Gflop/s on one thread. \
         The dense algebra of the bound with its gradients (n = 1823, m = 200: {:.0} Mflop, the kernel's not counted) runs at {bound:.1} Gflop/s, \
         {:.0} % of that.\n",
        measured.number("bound-200", "operations")? * 1e-6,
        100.0 * bound / peak
    )?;
    Ok(())
}

fn costs(text: &mut String, measured: &Measured) -> anyhow::Result<()> {
    text.push_str("\n## How the cost grows\n\n![Cost over size](bench.svg)\n\n| what | fastest time, ms, by size (n with m = 200, m with n = 1823) |\n|---|---|\n");
    for line in cost_lines(measured)? {
        let points: Vec<String> =
            line.points.iter().map(|(size, ms)| format!("{size}: {}", significant(*ms))).collect();
        writeln!(text, "| {} | {} |", line.name, points.join(", "))?;
    }
    Ok(())
}

fn agreements(text: &mut String, measured: &Measured) -> anyhow::Result<()> {
    text.push_str(
        "\n## Agreement\n\nDifferences from gpflow are relative to the largest value. The bilinear patch of a cell and its two triangles differ by at most \
         a quarter of the patch's twist, so Embree's and Jolt's ranges must lie between ours from that much and a millimetre lower and higher, or to solids larger \
         and smaller by a millimetre. wasm gives the native bits.\n\n\
         | what | difference | allowed |\n|---|---:|---:|\n",
    );
    for agreement in &measured.agreements {
        writeln!(text, "| {} | {:.1e} | {:.0e} |", agreement.what, agreement.difference, agreement.allowed)?;
    }
    Ok(())
}

/// The growth of the cost.
pub(crate) fn figure(measured: &Measured) -> anyhow::Result<String> {
    let lines = cost_lines(measured)?;
    let plot = Plot {
        x_label: "n (m = 200), m (n = 1823), beams or samples of terrain".to_owned(),
        y_label: "fastest time, ms".to_owned(),
        lines,
        mark_x: None,
        scale: Scale::Logarithmic,
    };
    Ok(plot.svg())
}

fn cost_lines(measured: &Measured) -> anyhow::Result<Vec<Line>> {
    let line = |&(name, works): &(&str, &[(&str, f64)])| {
        let point = |&(work, size): &(&str, f64)| Ok((size, measured.times(work, Side::Native)?.fastest));
        Ok(Line { name: name.to_owned(), points: works.iter().map(point).collect::<anyhow::Result<_>>()? })
    };
    COSTS.iter().map(line).collect()
}

fn pair(times: Times) -> String {
    format!("{} / {}", significant(times.fastest), significant(times.median))
}

/// Three significant digits.
fn significant(value: f64) -> String {
    let decimals = (2.0 - libm::log10(value.abs()).floor()).clamp(0.0, 6.0) as usize;
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::WORKS;
    use crate::bench::agreement::Agreement;
    use crate::bench::measured::Drive;

    /// Ours take 1 ms natively and 2 ms as wasm, the peers 24 ms.
    fn measured() -> Measured {
        let mut measured = Measured { machine: "A machine".to_owned(), rounds: 3, ..Measured::default() };
        let costs = COSTS.iter().flat_map(|(_, works)| *works).map(|&(work, _)| (work, &[Side::Native][..]));
        for (work, sides) in WORKS.iter().map(|&(work, _, sides)| (work, sides)).chain(costs) {
            for side in sides {
                let ms = match side {
                    Side::Native => 1.0,
                    Side::Peer => 24.0,
                    Side::Node | Side::Chromium => 2.0,
                    Side::Jolt => 1.0,
                };
                measured.times.insert((work.to_owned(), *side), vec![ms; 6]);
            }
        }
        let values = r#"{"operations": [5e6], "mean_returns": [23020], "most_cells": [3269]}"#;
        for work in ["peak", "bound-200", "drive"] {
            measured.values.insert(work.to_owned(), serde_json::from_str(values).unwrap());
        }
        measured.agreements.push(Agreement { what: "mean".to_owned(), difference: 2e-9, allowed: 1e-6 });
        let ideal = Drive { simulated_s: 48.0, computed_s: 4.0 };
        let field = Drive { computed_s: 8.0, ..ideal };
        measured.trials.push(Trial { scenario: "ht", ideal, field });
        measured
    }

    #[test]
    fn the_report_says_what_was_met_and_missed() {
        let report = report(&measured()).unwrap();
        for part in [
            "--rounds 3",
            "A machine.",
            "| bound and all gradients, n = 1823, m = 200 | 1.00 / 1.00 | gpflow 24.0 / 24.0 | 24.0 / 24.0 | 6 | met |",
            "| 24.0 / 24.0 | 60 | **missed** |",
            "| planner step along drives | 1.00 | 2.00 | 2.00 | 2.00 | 2.00 | met |",
            "| planner step along drives | Chromium | 2.00 | 2.00 | 2.00 | 30 | met | met |",
            "| hills, both as wasm in Node | 2.00 / 2.00 | Jolt 1.00 / 1.00 | 0.5 / 0.5 | 1 | **missed** |",
            "| the whole scan | Node | 2.00 / 2.00 | 2.00 / 2.00 | 1.00 / 1.00 | met |",
            "| ht | 48.0 | 4.00 | 12.0 | 48.0 | 8.00 | 6.0 | 2.00 | **missed** |",
            "100 % of that",
            "| mean | 2.0e-9 | 1e-6 |",
            "| posterior over m | 50: 1.00, 100: 1.00,",
        ] {
            assert!(report.contains(part), "{part}\n{report}");
        }
    }

    #[test]
    fn the_figure_has_every_line() {
        let svg = figure(&measured()).unwrap();
        for (name, _) in COSTS {
            assert!(svg.contains(name), "{name}");
        }
    }

    #[test]
    fn what_was_not_measured_is_missed() {
        let mut measured = measured();
        measured.times.remove(&("drive".to_owned(), Side::Chromium));
        assert_eq!(report(&measured).unwrap_err().to_string(), "Chromium was not asked for drive");
    }

    #[test]
    fn three_digits_count() {
        assert_eq!(
            [significant(1234.5), significant(12.345), significant(0.012_345)],
            ["1234", "12.3", "0.0123"]
        );
    }
}
