//! mapless against its peers and against real time, written to `docs/BENCHMARKS.md`.
//!
//! Five programs hold the benchmarks ready: ours natively, in Node and in Chromium, and the peers' in Python
//! and in Node.
//! They are asked in turn, a few repetitions at a time, so that other load on the machine affects all of
//! them.

mod agreement;
mod environment;
mod measured;
mod memory;
mod report;
mod runner;

use xshell::Shell;

use agreement::Agreement;
use measured::{Measured, Trial};
use runner::{Runner, Side};

const REPORT: &str = "docs/BENCHMARKS.md";
const FIGURE: &str = "docs/bench.svg";

const OURS: &[Side] = &[Side::Native, Side::Node, Side::Chromium];
const ALL: &[Side] = &[Side::Native, Side::Peer, Side::Node, Side::Chromium];
const EVERYONE: &[Side] = &[Side::Native, Side::Peer, Side::Node, Side::Chromium, Side::Jolt];
const NATIVE: &[Side] = &[Side::Native];

/// The benchmarks, each with its repetitions in a round and its sides.
const WORKS: &[(&str, usize, &[Side])] = &[
    ("posterior-200", 2, ALL),
    ("posterior-400", 1, ALL),
    ("bound-200", 2, ALL),
    ("scan-rugged-1000", 10, EVERYONE),
    ("scan-objects-1000", 10, ALL),
    ("scan-near-1000", 10, OURS),
    ("scan-near-objects-1000", 10, OURS),
    ("scan-level-1000", 10, EVERYONE),
    ("calls", 10, &[Side::Jolt]),
    ("tick-level", 10, OURS),
    ("tick-full", 10, OURS),
    ("drive", 300, OURS),
    ("peak", 5, NATIVE),
];

/// Growth of the cost: name of the line, and the benchmarks by their size.
pub(crate) const COSTS: &[(&str, &[(&str, f64)])] = &[
    (
        "posterior over n",
        &[
            ("posterior-inputs-8", 720.0),
            ("posterior-inputs-4", 1440.0),
            ("posterior-inputs-2", 2880.0),
            ("posterior-inputs-1", 5760.0),
        ],
    ),
    (
        "posterior over m",
        &[
            ("posterior-50", 50.0),
            ("posterior-100", 100.0),
            ("posterior-200", 200.0),
            ("posterior-400", 400.0),
        ],
    ),
    ("bound over m", &[("bound-50", 50.0), ("bound-100", 100.0), ("bound-200", 200.0), ("bound-400", 400.0)]),
    (
        "planner step over beams",
        &[
            ("tick-columns-450", 7200.0),
            ("tick-columns-900", 14_400.0),
            ("tick-columns-1800", 28_800.0),
            ("tick-columns-3600", 57_600.0),
        ],
    ),
    (
        "scan over samples",
        &[
            ("scan-rugged-125", 15_625.0),
            ("scan-rugged-250", 62_500.0),
            ("scan-rugged-500", 250_000.0),
            ("scan-rugged-1000", 1_000_000.0),
            ("scan-rugged-2000", 4_000_000.0),
        ],
    ),
];

const SCENARIOS: [&str; 10] =
    ["cht-ab", "cht-ac", "cht-ad", "cht-ae", "cht-ba", "cht-bd", "gsb", "ht", "ml", "vta"];

/// Measures everything in `rounds` rounds, and writes the report with its figure.
pub(crate) fn run(sh: &Shell, rounds: u32) -> anyhow::Result<()> {
    let environment = environment::set_up(sh)?;
    let mut runners = environment.start(sh)?;
    let machine = environment.machine(sh, &mut runners)?;
    let mut measured = Measured { machine, rounds, ..Measured::default() };

    for &(work, _, sides) in WORKS.iter().filter(|(work, ..)| *work != "drive") {
        let values = sides.iter().map(|side| runner(&mut runners, *side)?.values(work));
        let values: Vec<_> = values.collect::<anyhow::Result<_>>()?;
        measured.agreements.extend(agreement::check(work, sides, &values)?);
        measured.values.extend(values.into_iter().next().map(|native| (work.to_owned(), native)));
    }
    let costs: Vec<&str> = COSTS.iter().flat_map(|(_, works)| *works).map(|&(work, _)| work).collect();
    let costs = costs.into_iter().filter(|cost| WORKS.iter().all(|(work, ..)| work != cost));
    let works: Vec<(&str, usize, &[Side])> =
        WORKS.iter().copied().chain(costs.map(|work| (work, 1, NATIVE))).collect();
    for round in 1..=rounds {
        for &(work, repetitions, sides) in &works {
            for side in sides {
                let times = runner(&mut runners, *side)?.times(work, repetitions)?;
                measured.times.entry((work.to_owned(), *side)).or_default().extend(times);
            }
        }
        println!("round {round} of {rounds}");
    }
    // The drives are equally far on every side.
    let drives: Vec<_> = OURS
        .iter()
        .map(|side| runner(&mut runners, *side)?.values("drive"))
        .collect::<anyhow::Result<_>>()?;
    measured.agreements.extend(agreement::check("drive", OURS, &drives)?);
    measured.values.extend(drives.into_iter().next().map(|native| ("drive".to_owned(), native)));

    let native = runner(&mut runners, Side::Native)?;
    for scenario in SCENARIOS {
        let trial = Trial::measure(native, scenario)?;
        println!("{scenario}: {:.1} s in {:.1} s", trial.ideal.simulated_s, trial.ideal.computed_s);
        measured.trials.push(trial);
    }
    for runner in runners {
        runner.end()?;
    }

    measured.memory = memory::measure(sh)?;
    let report = report::report(&measured)?;
    println!("\n{report}");
    sh.write_file(REPORT, report)?;
    sh.write_file(FIGURE, report::figure(&measured)?)?;
    println!("{REPORT} and {FIGURE} written");
    let apart: Vec<&Agreement> = measured.agreements.iter().filter(|agreement| !agreement.holds()).collect();
    anyhow::ensure!(apart.is_empty(), "results disagree: {apart:#?}");
    Ok(())
}

fn runner(runners: &mut [Runner], side: Side) -> anyhow::Result<&mut Runner> {
    let found = runners.iter_mut().find(|runner| runner.side == side);
    found.ok_or_else(|| anyhow::anyhow!("no runner for {side:?}"))
}
