//! Every check and test, the fast ones first.

use std::env;
use std::fmt::Write as _;
use std::net::{Ipv4Addr, TcpListener};
use std::path::PathBuf;
use std::time::{Duration, Instant};

use anyhow::{Context as _, anyhow};
use clap::ValueEnum;
use xshell::{Cmd, Shell, cmd};

use crate::browser::Browser;
use crate::count::{Count, Runner, count};
use crate::python::Environment;
use crate::robot::Peer;
use crate::{page, physics, setup, static_programs};

/// A part of the tests that can run alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Part {
    /// Formatting, lints and types, of Rust and TypeScript.
    Lint,
    /// Rust tests on this machine.
    Native,
    /// Two routes as static programs for x86-64.
    Static,
    /// Rust tests as wasm in a headless browser.
    Wasm,
    /// Unit and browser tests of the page.
    Page,
    /// The answers to inputs that people have, from the data that `MAPLESS_DATA` names or ../shared; the
    /// native tests have them, too.
    Reports,
    /// A recording and two routes with the command line for AArch64, by qemu-aarch64 or by an emulator; only
    /// on request, as it takes long, and without qemu needs Python and installs Unicorn and Qiling under
    /// target/.
    Aarch64,
    /// Campaigns on a local Ray cluster; only on request, as it needs Python 3.10 or newer and installs Ray
    /// under target/.
    Ray,
    /// The physics engine on ground whose answers are known, two routes in it and in our own world, and the
    /// node for robots in it over DDS; only on request, as it needs Python 3.11 or newer and installs MuJoCo
    /// under target/.
    Physics,
    /// The node for robots with a robot of rclpy of Jazzy, which needs Python 3.11 and a C++ compiler and is
    /// installed under target/. Where it cannot be installed, all tests together pass it over and say so;
    /// the native tests have the node over DDS without ROS.
    Robot,
    /// The same with a robot of rclpy of Kilted, installed likewise; only on request.
    Kilted,
    /// The node for robots with a robot of Cyclone DDS, a second vendor; only on request, as it needs Python
    /// 3.11 and installs Cyclone DDS under target/.
    Cyclone,
}

impl Part {
    /// The name on the command line.
    fn name(self) -> String {
        format!("{self:?}").to_lowercase()
    }
}

/// One step: its heading, the parts it belongs to (at least one), and its function.
struct Stage {
    title: &'static str,
    parts: &'static [Part],
    run: fn(&Shell) -> anyhow::Result<Count>,
}

impl Stage {
    /// Whether it belongs to a part, or to all of them: those that are not on request.
    fn belongs_to(&self, part: Option<Part>) -> bool {
        let on_request =
            [Part::Aarch64, Part::Ray, Part::Reports, Part::Physics, Part::Kilted, Part::Cyclone];
        part.map_or(!self.parts.iter().all(|part| on_request.contains(part)), |part| {
            self.parts.contains(&part)
        })
    }
}

const STAGES: &[Stage] = &[
    Stage { title: "format", parts: &[Part::Lint], run: format },
    Stage { title: "clippy", parts: &[Part::Lint], run: clippy },
    Stage { title: "clippy for wasm", parts: &[Part::Lint], run: clippy_wasm },
    Stage { title: "documentation", parts: &[Part::Lint], run: documentation },
    Stage { title: "package", parts: &[Part::Lint], run: package },
    // The page's types include those of the wasm bindings, which the build makes.
    Stage { title: "build of the page", parts: &[Part::Lint, Part::Page], run: build_page },
    Stage { title: "lint and types of the page", parts: &[Part::Lint], run: check_page },
    Stage { title: "native tests", parts: &[Part::Native], run: test_native },
    Stage { title: "static programs", parts: &[Part::Static], run: static_programs::test },
    Stage { title: "programs for AArch64", parts: &[Part::Aarch64], run: static_programs::test_aarch64 },
    Stage { title: "reports", parts: &[Part::Reports], run: test_reports },
    Stage { title: "wasm tests", parts: &[Part::Wasm], run: test_wasm },
    Stage { title: "unit tests of the page", parts: &[Part::Page], run: test_page_units },
    // The browser tests compare the page with the command line; those on Ray run it.
    Stage { title: "build of the command line", parts: &[Part::Page, Part::Ray], run: build_command_line },
    Stage { title: "campaigns on Ray", parts: &[Part::Ray], run: test_ray },
    Stage { title: "physics engine", parts: &[Part::Physics], run: physics::test },
    Stage { title: "node in the physics engine", parts: &[Part::Physics], run: physics::over_ros::test },
    Stage { title: "node with rclpy", parts: &[Part::Robot], run: |sh| Peer::Jazzy.test_where_possible(sh) },
    Stage { title: "node with rclpy of Kilted", parts: &[Part::Kilted], run: |sh| Peer::Kilted.test(sh) },
    Stage { title: "node with Cyclone DDS", parts: &[Part::Cyclone], run: |sh| Peer::Cyclone.test(sh) },
    Stage { title: "browser tests of the page", parts: &[Part::Page], run: test_page },
];

/// Runs the stages of `part`, or all of them, up to the first that fails.
pub(crate) fn run(sh: &Shell, part: Option<Part>) -> anyhow::Result<()> {
    set_up(sh, part)?;
    let mut times = Vec::new();
    let mut sum = Count::default();
    for stage in STAGES.iter().filter(|stage| stage.belongs_to(part)) {
        println!("\n=== {} ===", stage.title);
        let start = Instant::now();
        sum += (stage.run)(sh).map_err(|error| {
            let part = part.unwrap_or(stage.parts[0]).name();
            anyhow!("{} failed: {error:#}\nTo run this part alone: cargo xtask test {part}", stage.title)
        })?;
        let time = start.elapsed();
        println!("=== {}: {:.1} s ===", stage.title, time.as_secs_f64());
        times.push((part.unwrap_or(stage.parts[0]), stage.title, time));
    }
    print!("\n{}", summary(&times));
    if sum.skipped > 0 {
        println!("{} skipped", sum.skipped);
    }
    println!("\n{} passed, {} failed", sum.passed, sum.failed);
    Ok(())
}

/// How long each part took, with its stages, and all of them.
fn summary(times: &[(Part, &str, Duration)]) -> String {
    let seconds = |part: Option<Part>| -> f64 {
        let stages = times.iter().filter(|stage| part.is_none_or(|part| stage.0 == part));
        stages.map(|(_, _, time)| time.as_secs_f64()).sum()
    };
    let mut text = String::new();
    // A String takes whatever is written to it.
    for part in Part::value_variants() {
        let mut stages = times.iter().filter(|stage| stage.0 == *part).peekable();
        if stages.peek().is_some() {
            let _ = writeln!(text, "{:8.1} s  {}", seconds(Some(*part)), part.name());
        }
        for (_, title, time) in stages {
            let _ = writeln!(text, "{:16.1} s  {title}", time.as_secs_f64());
        }
    }
    let _ = writeln!(text, "{:8.1} s  in all", seconds(None));
    text
}

/// Sets up everything for the stages of `part`, so that a missing program shows before anything runs.
fn set_up(sh: &Shell, part: Option<Part>) -> anyhow::Result<()> {
    let wants = |any: &[Part]| part.is_none_or(|part| any.contains(&part));
    if wants(&[Part::Lint]) {
        setup::lint_tools(sh)?;
    }
    if part == Some(Part::Ray) {
        ray(sh)?;
    }
    if part == Some(Part::Physics) {
        physics::python(sh)?;
    }
    for (of, peer) in
        [(Part::Robot, Peer::Jazzy), (Part::Kilted, Peer::Kilted), (Part::Cyclone, Peer::Cyclone)]
    {
        if part == Some(of) {
            peer.set_up(sh)?;
        }
    }
    if wants(&[Part::Lint, Part::Page]) {
        setup::npm_packages(sh)?;
    }
    if wants(&[Part::Wasm, Part::Page]) {
        Browser::set_up(sh)?;
    }
    if wants(&[Part::Lint, Part::Wasm, Part::Page]) {
        setup::wasm_target(sh)?;
        setup::wasm_bindgen(sh)?;
    }
    Ok(())
}

fn format(sh: &Shell) -> anyhow::Result<Count> {
    check(cmd!(sh, "cargo fmt --all --check"))?;
    // A workspace of its own.
    check(cmd!(sh, "cargo fmt --manifest-path tests/fuzz/Cargo.toml --check"))
}

fn clippy(sh: &Shell) -> anyhow::Result<Count> {
    check(cmd!(sh, "cargo clippy --workspace --all-targets -- --deny warnings"))
}

fn clippy_wasm(sh: &Shell) -> anyhow::Result<Count> {
    // With every crate of the workspace that they are made of.
    let target = "wasm32-unknown-unknown";
    let modules = page::package_flags();
    check(cmd!(sh, "cargo clippy --target {target} {modules...} --all-targets -- --deny warnings"))?;
    check(cmd!(sh, "cargo clippy --target {target} --package mapless-bench -- --deny warnings"))
}

fn documentation(sh: &Shell) -> anyhow::Result<Count> {
    check(cmd!(sh, "cargo doc --workspace --no-deps").env("RUSTDOCFLAGS", "--deny warnings"))
}

/// Packs the crates that are published, and builds what is packed as somebody else's machine would.
fn package(sh: &Shell) -> anyhow::Result<Count> {
    // What is not committed is packed, too, and all that it needs is there: the stages before have built it.
    check(cmd!(sh, "cargo package --package mapless-parameters --package mapless --allow-dirty --offline"))
}

fn build_page(sh: &Shell) -> anyhow::Result<Count> {
    // The type files are in the repository, for checks of the page without a build of the modules.
    let files = page::MODULES.map(|module| format!("web/src/wasm/{module}.d.ts"));
    let types = || files.clone().map(|file| sh.read_file(file).ok());
    let kept = types();
    page::build(sh)?;
    anyhow::ensure!(
        types() == kept,
        "{} were out of date; the build wrote them anew: commit them",
        files.join(", ")
    );
    Ok(Count::default())
}

fn check_page(sh: &Shell) -> anyhow::Result<Count> {
    let npm = setup::NPM;
    check(cmd!(sh, "{npm} run check"))
}

fn test_native(sh: &Shell) -> anyhow::Result<Count> {
    // The same property-test cases every time, so that a run fails for a change and never by chance. `cargo
    // test` by itself draws new ones.
    let mut test = cmd!(sh, "cargo test --workspace").env("PROPTEST_RNG_SEED", "1");
    if let Some(data) = data(sh) {
        test = test.env("MAPLESS_DATA", data).args(["--", "--include-ignored"]);
    }
    count(test, Runner::Cargo)
}

fn test_reports(sh: &Shell) -> anyhow::Result<Count> {
    let data = data(sh).context("no data: expected the folder that MAPLESS_DATA names, or ../shared")?;
    let test = cmd!(sh, "cargo test --package mapless-cli --test reports -- --include-ignored");
    count(test.env("MAPLESS_DATA", data), Runner::Cargo)
}

/// Recorded scans, elevation models and gpflow's values that are not in the repository; without them the
/// tests that read them count as skipped.
fn data(sh: &Shell) -> Option<PathBuf> {
    let root = sh.current_dir();
    let named = env::var_os("MAPLESS_DATA").map(|named| root.join(named));
    named.or_else(|| Some(root.parent()?.join("shared"))).filter(|folder| folder.is_dir())
}

fn test_wasm(sh: &Shell) -> anyhow::Result<Count> {
    let browser = Browser::set_up(sh)?;
    let capabilities = sh.current_dir().join("target/webdriver.json");
    sh.write_file(&capabilities, browser.webdriver_json())?;
    let runner = setup::wasm_bindgen(sh)?.join("wasm-bindgen-test-runner");
    // As the page's modules are built, with which it shares all libraries; a whole trial takes longer than
    // the runner's 20 seconds.
    let test =
        cmd!(sh, "cargo test --profile page --package mapless-wasm --package mapless-wasm-replay --target wasm32-unknown-unknown --tests")
            .env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUNNER", runner)
            .env("CHROMEDRIVER", &browser.driver)
            .env("WASM_BINDGEN_TEST_WEBDRIVER_JSON", &capabilities)
            .env("WASM_BINDGEN_TEST_DRIVER_TIMEOUT", "300")
            .env("WASM_BINDGEN_TEST_TIMEOUT", "7200");
    count(test, Runner::Cargo)
}

fn test_page_units(sh: &Shell) -> anyhow::Result<Count> {
    let npm = setup::NPM;
    count(cmd!(sh, "{npm} test"), Runner::Node)
}

fn build_command_line(sh: &Shell) -> anyhow::Result<Count> {
    // The very program that the native tests have built for this one. Optimisation changes no bits of a
    // result.
    check(cmd!(sh, "cargo test --workspace --test command_line --no-run"))
}

fn test_page(sh: &Shell) -> anyhow::Result<Count> {
    let browser = Browser::set_up(sh)?;
    let npm = setup::NPM;
    let test = cmd!(sh, "{npm} run test:page")
        .env("CHROME", &browser.chrome)
        .env("MAPLESS_PAGE_PORT", free_port()?.to_string());
    count(test, Runner::Playwright)
}

/// A port that no other server on this machine has.
fn free_port() -> anyhow::Result<u16> {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).context("no port is free")?;
    Ok(listener.local_addr()?.port())
}

fn test_ray(sh: &Shell) -> anyhow::Result<Count> {
    let python = ray(sh)?;
    let program = setup::target_dir(sh).join("debug/mapless").with_extension(env::consts::EXE_EXTENSION);
    count(cmd!(sh, "{python} crate/campaign/ray/test_run.py {program}"), Runner::Playwright)
}

/// Installs Ray; returns the Python that has it.
fn ray(sh: &Shell) -> anyhow::Result<PathBuf> {
    let environment = Environment {
        folder: &setup::target_dir(sh).join("ray-venv"),
        requirements: "crate/campaign/ray/requirements.txt",
        pythons: &["python3", "python3.13", "python3.12", "python3.11", "python3.10", "python"],
        fits: |version| version >= (3, 10),
        missing: "The tests on Ray need Python 3.10 or newer with pip, and none is on PATH. Install one, for example with \
            `sudo apt-get install python3 python3-venv`, or run the other parts alone: cargo xtask test native, and so on.",
    };
    environment.set_up(sh)
}

/// Runs a check that counts no tests.
fn check(command: Cmd<'_>) -> anyhow::Result<Count> {
    command.run()?;
    Ok(Count::default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_summary_has_the_sum_of_each_part_that_ran() {
        let times = [
            (Part::Lint, "format", Duration::from_millis(1500)),
            (Part::Lint, "clippy", Duration::from_secs(40)),
            (Part::Page, "browser tests of the page", Duration::from_secs(100)),
        ];
        let expected = "    41.5 s  lint\n             1.5 s  format\n            40.0 s  clippy\n   \
            100.0 s  page\n           100.0 s  browser tests of the page\n   141.5 s  in all\n";
        assert_eq!(summary(&times), expected);
    }

    #[test]
    fn a_stage_of_two_parts_runs_with_either_and_those_on_request_only_when_asked_for() {
        let titles = |part| -> Vec<&str> {
            STAGES.iter().filter(|stage| stage.belongs_to(part)).map(|stage| stage.title).collect()
        };
        assert!(titles(Some(Part::Lint)).contains(&"build of the page"));
        assert!(titles(Some(Part::Page)).contains(&"build of the page"));
        assert!(titles(None).contains(&"build of the command line"));
        assert!(!titles(None).contains(&"campaigns on Ray") && !titles(None).contains(&"reports"));
        assert!(!titles(None).contains(&"physics engine"));
        assert_eq!(titles(Some(Part::Physics)), ["physics engine", "node in the physics engine"]);
        assert!(titles(None).contains(&"node with rclpy"));
        assert_eq!(titles(Some(Part::Robot)), ["node with rclpy"]);
        assert_eq!(titles(Some(Part::Kilted)), ["node with rclpy of Kilted"]);
        assert!(!titles(None).contains(&"node with rclpy of Kilted"));
        assert!(!titles(None).contains(&"node with Cyclone DDS"));
        assert_eq!(titles(Some(Part::Cyclone)), ["node with Cyclone DDS"]);
        assert_eq!(titles(Some(Part::Reports)), ["reports"]);
        assert!(titles(Some(Part::Ray)).contains(&"campaigns on Ray"));
    }
}
