//! Counts of tests, read from the output of the test runners.

use std::io::{self, Read as _, Write as _};
use std::ops::AddAssign;
use std::process::{Command, Stdio};

use anyhow::{Context as _, ensure};
use xshell::Cmd;

/// A test runner, by the closing lines it prints.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Runner {
    /// `cargo test` and `wasm-bindgen-test-runner`: one `test result:` line for each test binary.
    Cargo,
    /// `node --test`: one line for each number, `# pass 3` or `ℹ pass 3`.
    Node,
    /// Playwright, and our tests in Python, which say it as it does: one line for each number, `3 passed
    /// (1.2s)`.
    Playwright,
}

/// Numbers of tests by how they ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Count {
    pub(crate) passed: u64,
    pub(crate) failed: u64,
    /// Tests that the runner left out.
    pub(crate) skipped: u64,
}

impl AddAssign for Count {
    fn add_assign(&mut self, other: Self) {
        self.passed += other.passed;
        self.failed += other.failed;
        self.skipped += other.skipped;
    }
}

impl Runner {
    /// Sums the closing lines in `output`.
    pub(crate) fn count(self, output: &str) -> Count {
        let mut sum = Count::default();
        for line in without_colours(output).lines() {
            match self {
                Self::Cargo => {
                    // A progress line may share the line with the result, so look for it anywhere.
                    let Some((_, result)) = line.split_once("test result: ") else { continue };
                    let numbers = result.split_once(". ").map_or("", |(_, numbers)| numbers);
                    for part in numbers.split("; ") {
                        sum.add_named(part.split_once(' ').map(|(number, name)| (name, number)));
                    }
                }
                Self::Node => {
                    let line = line.strip_prefix("# ").or_else(|| line.strip_prefix("ℹ "));
                    sum.add_named(line.and_then(|line| line.split_once(' ')));
                }
                Self::Playwright => {
                    let line = line.split(" (").next().unwrap_or_default();
                    sum.add_named(line.trim().split_once(' ').map(|(number, name)| (name, number)));
                }
            }
        }
        sum
    }
}

/// Runs a test runner, shows its output as it comes, and counts the tests in it.
pub(crate) fn count(command: Cmd<'_>, runner: Runner) -> anyhow::Result<Count> {
    let shown = command.to_string();
    eprintln!("$ {shown}");
    let mut child = Command::from(command).stdout(Stdio::piped()).spawn().with_context(|| shown.clone())?;
    let mut stdout = child.stdout.take().context("the runner has no output")?;
    let mut output = Vec::new();
    let mut chunk = [0; 4096];
    loop {
        let length = stdout.read(&mut chunk)?;
        if length == 0 {
            break;
        }
        let read = chunk.get(..length).unwrap_or_default();
        io::stdout().write_all(read)?;
        io::stdout().flush()?;
        output.extend_from_slice(read);
    }
    let status = child.wait()?;
    ensure!(status.success(), "`{shown}` ended with {status}");
    let count = runner.count(&String::from_utf8_lossy(&output));
    ensure!(count.failed == 0, "`{shown}` reported {} failed tests, yet ended well", count.failed);
    ensure!(count.passed > 0, "`{shown}` ran no test");
    Ok(count)
}

impl Count {
    /// Adds one number under the name its runner gives it; other names are not about tests.
    fn add_named(&mut self, named: Option<(&str, &str)>) {
        let Some((name, number)) = named else { return };
        let Ok(number) = number.parse::<u64>() else { return };
        match name {
            "passed" | "pass" => self.passed += number,
            // A flaky test failed once, an interrupted one did not end: neither has passed.
            "failed" | "fail" | "cancelled" | "flaky" | "interrupted" | "did not run" => {
                self.failed += number;
            }
            "ignored" | "skipped" | "todo" => self.skipped += number,
            _ => {}
        }
    }
}

/// `text` without the escape sequences that colour a terminal.
fn without_colours(text: &str) -> String {
    let mut pieces = text.split("\u{1b}[");
    let mut plain = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        plain.push_str(
            piece.trim_start_matches(|c: char| c.is_ascii_digit() || c == ';').get(1..).unwrap_or(""),
        );
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(passed: u64, failed: u64, skipped: u64) -> Count {
        Count { passed, failed, skipped }
    }

    #[test]
    fn cargo_results_of_all_binaries_are_summed() {
        let output = "running 2 tests\ntest a ... ok\ntest b ... ok\n\n\
            test result: ok. 2 passed; 0 failed; 0 ignored; 0 measured; 5 filtered out; finished in 0.01s\n\
            test says 7 passed ... ok\n\
            test result: FAILED. 11 passed; 1 failed; 3 ignored; 0 measured; 0 filtered out; finished in 2.00s\n";
        assert_eq!(Runner::Cargo.count(output), count(13, 1, 3));
    }

    #[test]
    fn wasm_runner_result_is_read() {
        let output = "Running headless tests in Chrome on `http://127.0.0.1:40001/`\n\
            test result: ok. 4 passed; 0 failed; 0 ignored; 0 filtered out; finished in 1.20s\n";
        assert_eq!(Runner::Cargo.count(output), count(4, 0, 0));
    }

    #[test]
    fn node_numbers_are_read_in_both_of_its_formats() {
        let tap = "ok 1 - scale\n# tests 6\n# suites 0\n# pass 5\n# fail 1\n# cancelled 0\n# skipped 2\n# todo 0\n\
            # duration_ms 91.2\n";
        assert_eq!(Runner::Node.count(tap), count(5, 1, 2));
        assert_eq!(Runner::Node.count(&tap.replace("# ", "ℹ ")), count(5, 1, 2));
    }

    #[test]
    fn playwright_numbers_are_read_and_a_flaky_test_has_not_passed() {
        let output = "Running 4 tests using 1 worker\n  ok 1 page.spec.ts:3:1 › opens (2.1s)\n\n  1 flaky\n\
            \u{20}   page.spec.ts:9:1 › drives\n  1 skipped\n  2 passed (14.8s)\n";
        assert_eq!(Runner::Playwright.count(output), count(2, 1, 1));
    }

    #[test]
    fn colours_do_not_hide_a_number() {
        let output = "\u{1b}[32m  2 passed\u{1b}[39m\u{1b}[2m (1.1s)\u{1b}[22m\n";
        assert_eq!(Runner::Playwright.count(output), count(2, 0, 0));
    }

    #[test]
    fn output_without_a_result_counts_nothing() {
        for runner in [Runner::Cargo, Runner::Node, Runner::Playwright] {
            assert_eq!(runner.count("no tests to run!\n"), Count::default());
        }
    }
}
