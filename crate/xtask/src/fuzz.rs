//! `cargo xtask fuzz`: runs every fuzz target for a while, and writes the result to `docs/FUZZ.md`.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Context as _, bail};
use xshell::{Shell, cmd};

use crate::setup;

const FOLDER: &str = "tests/fuzz";
const REPORT: &str = "docs/FUZZ.md";
/// Memory that a single input may take; the largest terrain takes a few hundred megabytes.
const MOST_MEGABYTES: u32 = 4096;

/// Runs every target for `seconds`; inputs found before are tried again first.
pub(crate) fn run(sh: &Shell, seconds: u32) -> anyhow::Result<()> {
    let cargo_fuzz = setup::cargo_fuzz(sh)?;
    let root = sh.current_dir();
    // A folder of their own: these builds have other flags.
    let own_folder = sh.push_env("CARGO_TARGET_DIR", setup::target_dir(sh).join("fuzz"));
    cmd!(sh, "{cargo_fuzz} build --fuzz-dir {FOLDER} --sanitizer none").run()?;
    let targets = cmd!(sh, "{cargo_fuzz} list --fuzz-dir {FOLDER}").read()?;
    let mut rows = Vec::new();
    for target in targets.lines() {
        let corpus = setup::target_dir(sh).join("fuzz-corpus").join(target);
        sh.create_dir(&corpus)?;
        let seeds = root.join(FOLDER).join("seeds").join(target);
        let seeds = Path::new(&seeds).is_dir().then_some(seeds);
        let limits = [
            format!("-max_total_time={seconds}"),
            format!("-rss_limit_mb={MOST_MEGABYTES}"),
            "-timeout=30".to_owned(),
            "-print_final_stats=1".to_owned(),
        ];
        let output = cmd!(sh, "{cargo_fuzz} run --fuzz-dir {FOLDER} --sanitizer none {target} {corpus} {seeds...} -- {limits...}")
            .ignore_status()
            .output()?;
        let log = String::from_utf8_lossy(&output.stderr);
        if !output.status.success() {
            bail!("{target} found an input that fails; its last words:\n{}", last_lines(&log, 40));
        }
        let executions = statistic(&log, "number_of_executed_units")
            .with_context(|| format!("{target} printed no number of executions"))?;
        println!("{target}: {executions} executions in {seconds} s");
        rows.push((target.to_owned(), executions));
    }
    drop(own_folder);
    let flood = flood(sh, seconds)?;
    println!("{flood}");
    sh.write_file(REPORT, report(seconds, &rows, &flood))?;
    println!("Wrote {REPORT}.");
    Ok(())
}

/// Floods `mapless-node` with damaged RTPS; what its test says of it.
fn flood(sh: &Shell, seconds: u32) -> anyhow::Result<String> {
    let test = "a_flood_moves_no_robot_and_does_not_hide_that_nothing_is_published";
    let printed = cmd!(sh, "cargo test --package mapless-node --test over_dds {test} -- --nocapture")
        .env("MAPLESS_FLOOD_S", seconds.to_string())
        .read()?;
    let found = printed.lines().find(|line| line.contains(" datagrams; "));
    Ok(found.context("the flood printed no number of datagrams")?.to_owned())
}

fn report(seconds: u32, rows: &[(String, u64)], flood: &str) -> String {
    let mut text = format!(
        "# Fuzzing\n\nWritten by `cargo xtask fuzz --seconds {seconds}`.\n\nEach target in `tests/fuzz` ran for {seconds} s under \
         [cargo-fuzz](https://github.com/rust-fuzz/cargo-fuzz), with overflow checks and debug assertions, 30 s and {MOST_MEGABYTES} MB for an \
         input at most. None panicked, hung, or gave a result it must not give.\n\n| target | executions |\n|---|---:|\n"
    );
    for (target, executions) in rows {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "| `{target}` | {executions} |");
    }
    let _ = writeln!(
        text,
        "\n`mapless-node` in a flood of damaged RTPS for as long, started anew whenever it ends or its watchdog is not fed, as systemd does: {flood}. Its \
         code never panicked, and it never moved, or went on without commands that arrive. Where RustDDS panicked, the node ended \
         (`crate/node/tests/over_dds/flood.rs`)."
    );
    text
}

/// A number that libFuzzer prints at its end.
fn statistic(log: &str, name: &str) -> Option<u64> {
    let (_, after) = log.split_once(&format!("stat::{name}:"))?;
    after.lines().next()?.trim().parse().ok()
}

fn last_lines(log: &str, count: usize) -> String {
    let lines: Vec<&str> = log.lines().collect();
    lines[lines.len().saturating_sub(count)..].join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_of_executions_is_read() {
        let log = "Done\nstat::number_of_executed_units: 1234\nstat::average_exec_per_sec:     12\n";
        assert_eq!(statistic(log, "number_of_executed_units"), Some(1234));
        assert_eq!(statistic(log, "peak_rss_mb"), None);
        assert_eq!(last_lines("a\nb\nc", 2), "b\nc");
        assert!(report(5, &[("png".to_owned(), 7)], "3 datagrams; none").contains("| `png` | 7 |"));
    }
}
