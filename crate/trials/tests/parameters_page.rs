//! docs/PARAMETERS.md says what the configurations say.
//!
//! After a change of a parameter,
//! `MAPLESS_RECORD_PARAMETERS=1 cargo test -p mapless-trials --test parameters_page` writes it anew.

use mapless::PlannerConfig;
use mapless_parameters::{Check, Kind, Value};
use mapless_trials::RealityConfig;
use mapless_trials::parameters::{Valued, groups};
use mapless_world::{RobotConfig, SensorConfig};

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/PARAMETERS.md");

const INTRODUCTION: &str = "# Parameters

Every parameter that a scenario file, a link to the page or a program that uses `mapless` may set. The table's name is its section
in a scenario file, as in `[planner.decision]`; in Rust it is the path of fields, as in `config.decision`. *Range* is what makes
sense; *must be* is what is checked. *Paper* is the value that the paper gives. The `paper` preset keeps learning `fixed` unless
it is asked for otherwise.

`[planner.robot]` and `[planner.sensor]` follow `[robot]` and `[sensor]` of a scenario, unless they are set, in width, wheelbase,
track and tilt limits, and in how far forward and how high the sensor sits.

This page is written from the code: see `crate/trials/tests/parameters_page.rs`.
";

/// Numbers with few digits, as people write them.
fn rounded(number: f64) -> String {
    format!("{}", (1e4 * number).round() / 1e4)
}

fn shown(value: Value) -> String {
    match value {
        Value::Number(number) => rounded(number),
        Value::Pair([first, second]) => format!("{}, {}", rounded(first), rounded(second)),
        other => other.to_string(),
    }
}

fn range(kind: Kind) -> String {
    match kind {
        Kind::Number(low, high) => format!("{} to {}", rounded(low), rounded(high)),
        Kind::Pair(low, high) => format!("two, {} to {}", rounded(low), rounded(high)),
        Kind::Whole(low, high) => format!("{low} to {high}, whole"),
        Kind::Switch => "true, false".to_owned(),
        Kind::Choice(words) => words.join(", "),
    }
}

fn must_be(check: Check) -> String {
    match check {
        Check::ByType => String::new(),
        Check::Within(low, high) => format!("{} to {}", rounded(low), rounded(high)),
        Check::UpTo(most) => format!("above 0, at most {}", rounded(most)),
        other => other.to_string(),
    }
}

fn page() -> String {
    let mut page = INTRODUCTION.to_owned();
    let (sensor, robot) = (SensorConfig::default(), RobotConfig::default());
    for group in groups(&PlannerConfig::default(), &sensor, &robot, &RealityConfig::default()) {
        page += &format!("\n## `{}`: {}\n\n", group.table, group.title);
        page += "| key | unit | default | paper | range | must be | what it does |\n|---|---|---|---|---|---|---|\n";
        for Valued { parameter, value } in group.parameters {
            let cells = [
                format!("`{}`", parameter.name),
                parameter.unit.to_owned(),
                shown(value),
                parameter.paper.map(shown).unwrap_or_default(),
                range(parameter.kind),
                must_be(parameter.check),
                parameter.text.replace('|', "\\|"),
            ];
            page += &format!("| {} |\n", cells.join(" | "));
        }
    }
    page
}

#[test]
fn the_page_of_parameters_is_that_of_the_code() {
    let page = page();
    if std::env::var_os("MAPLESS_RECORD_PARAMETERS").is_some() {
        std::fs::write(PAGE, &page).unwrap();
    }
    let found = std::fs::read_to_string(PAGE).unwrap_or_default();
    let stale = found.lines().zip(page.lines()).find(|(found, page)| found != page);
    assert!(
        found == page,
        "docs/PARAMETERS.md is stale ({stale:?}): write it anew with MAPLESS_RECORD_PARAMETERS=1, as this test says"
    );
}
