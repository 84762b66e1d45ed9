//! The programs of the benchmark, built or installed, and the machine.

use std::path::{Path, PathBuf};
use std::process::Command;

use xshell::{Shell, cmd};

use super::runner::{Runner, Side};
use crate::browser::Browser;
use crate::{python, setup};

const REQUIREMENTS: &str = "crate/bench/requirements.txt";
const JOLT: [&str; 2] = ["crate/bench/jolt/package.json", "crate/bench/jolt/package-lock.json"];

/// Paths of the programs.
pub(crate) struct Environment {
    /// Inputs for the peers, and the wasm module.
    folder: PathBuf,
    native: PathBuf,
    python: PathBuf,
    chrome: PathBuf,
}

/// Builds ours, natively and as wasm, and installs the peers.
pub(crate) fn set_up(sh: &Shell) -> anyhow::Result<Environment> {
    let target = setup::target_dir(sh);
    let python = peers(sh, &target.join("bench-venv"))?;
    setup::npm_packages(sh)?;
    setup::wasm_target(sh)?;
    let wasm_bindgen = setup::wasm_bindgen(sh)?.join("wasm-bindgen");
    let browser = Browser::set_up(sh)?;
    cmd!(sh, "cargo build --release --package mapless-bench").run()?;
    cmd!(sh, "cargo build --release --package mapless-bench --lib --target wasm32-unknown-unknown").run()?;
    let folder = target.join("bench");
    let built = target.join("wasm32-unknown-unknown/release/mapless_bench.wasm");
    cmd!(sh, "{wasm_bindgen} --target web --out-dir {folder} {built}").run()?;
    // Node reads the module as an ES module only with this file.
    sh.write_file(folder.join("package.json"), "{\"type\": \"module\"}\n")?;
    jolt(sh, &folder.join("jolt"))?;
    let native = target.join("release/mapless-bench").with_extension(std::env::consts::EXE_EXTENSION);
    Ok(Environment { folder, native, python, chrome: browser.chrome })
}

/// Installs the peer that is an npm package into a folder of its own, unless this very one is there.
fn jolt(sh: &Shell, folder: &Path) -> anyhow::Result<()> {
    sh.create_dir(folder)?;
    let lock = sh.read_file(JOLT[1])?;
    let installed = folder.join("node_modules/.installed-package-lock.json");
    if sh.read_file(&installed).is_ok_and(|installed| installed == lock) {
        return Ok(());
    }
    for file in JOLT {
        sh.copy_file(file, folder)?;
    }
    let npm = setup::NPM;
    cmd!(sh, "{npm} ci --no-audit --no-fund --prefix {folder}").run()?;
    sh.write_file(&installed, lock)?;
    Ok(())
}

/// Installs the peers into a Python environment of their own; returns its Python.
fn peers(sh: &Shell, venv: &Path) -> anyhow::Result<PathBuf> {
    let environment = python::Environment {
        folder: venv,
        requirements: REQUIREMENTS,
        pythons: &["python3.11", "python3.10", "python3", "python"],
        fits: runs_tensorflow,
        missing: "The peers need Python 3.10 or 3.11, for which tensorflow 2.15 is built, and none is on PATH. Install one, for example \
            with `sudo apt-get install python3.11 python3.11-venv`, or with pyenv.",
    };
    environment.set_up(sh)
}

/// Whether tensorflow 2.15 runs on this version of Python and embreex is built for it.
fn runs_tensorflow(version: (u32, u32)) -> bool {
    matches!(version, (3, 10 | 11))
}

impl Environment {
    /// Starts the five programs; the native one writes the inputs for the peers before it answers.
    pub(crate) fn start(&self, sh: &Shell) -> anyhow::Result<Vec<Runner>> {
        let root = sh.current_dir();
        let command = |program: &std::ffi::OsStr, script: Option<&str>| {
            let mut command = Command::new(program);
            command.current_dir(&root).args(script);
            command
        };
        let mut native = command(self.native.as_os_str(), None);
        native.arg(&self.folder);
        let mut native = Runner::start(Side::Native, native)?;
        native.values("peak")?;
        let mut python = command(self.python.as_os_str(), Some("crate/bench/peers.py"));
        python.arg(&self.folder);
        let mut node = command("node".as_ref(), Some("crate/bench/wasm.mjs"));
        node.arg("node").arg(&self.folder);
        let mut chromium = command("node".as_ref(), Some("crate/bench/wasm.mjs"));
        chromium.arg(&self.chrome).arg(&self.folder);
        let mut jolt = command("node".as_ref(), Some("crate/bench/jolt/peer.mjs"));
        jolt.arg(&self.folder);
        Ok(vec![
            native,
            Runner::start(Side::Peer, python)?,
            Runner::start(Side::Node, node)?,
            Runner::start(Side::Chromium, chromium)?,
            Runner::start(Side::Jolt, jolt)?,
        ])
    }

    /// The machine and the versions of the programs, one sentence.
    pub(crate) fn machine(&self, sh: &Shell, runners: &mut [Runner]) -> anyhow::Result<String> {
        let chrome = &self.chrome;
        let rustc = cmd!(sh, "rustc --version").quiet().read()?;
        let node = cmd!(sh, "node --version").quiet().read()?;
        let chromium = cmd!(sh, "{chrome} --version").quiet().ignore_stderr().read()?;
        let mut peers = Vec::new();
        for runner in runners.iter_mut().filter(|runner| matches!(runner.side, Side::Peer | Side::Jolt)) {
            peers.extend(runner.versions()?.into_iter().map(|(name, version)| format!("{name} {version}")));
        }
        let threads = std::thread::available_parallelism()?;
        let short = |printed: &str, words: usize| {
            printed.split_whitespace().take(words).collect::<Vec<_>>().join(" ")
        };
        Ok(format!(
            "{}, {threads} hardware threads{}, {}; {}, Node {}, {}, {}",
            processor(sh),
            others(sh),
            std::env::consts::OS,
            short(&rustc, 2),
            node.trim_start_matches('v'),
            short(&chromium, 2),
            peers.join(", ")
        ))
    }
}

/// Other load on the machine, as far as Linux reports it.
fn others(sh: &Shell) -> String {
    let average =
        sh.read_file("/proc/loadavg").ok().and_then(|text| text.split(' ').next().map(str::to_owned));
    average.map_or_else(String::new, |average| format!(" under a load of {average} before the first round"))
}

/// The model name of the processor.
fn processor(sh: &Shell) -> String {
    let linux = sh.read_file("/proc/cpuinfo").ok().and_then(|text| model_name(&text));
    let mac = || cmd!(sh, "sysctl -n machdep.cpu.brand_string").quiet().ignore_stderr().read().ok();
    linux.or_else(mac).unwrap_or_else(|| std::env::consts::ARCH.to_owned())
}

/// The first model name in the text of `/proc/cpuinfo`.
fn model_name(cpuinfo: &str) -> Option<String> {
    let line = cpuinfo.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn python_must_be_one_that_tensorflow_is_built_for() {
        assert!(runs_tensorflow((3, 11)) && runs_tensorflow((3, 10)));
        assert!(!runs_tensorflow((3, 12)) && !runs_tensorflow((2, 7)));
    }

    #[test]
    fn the_processor_is_named() {
        let text =
            "processor\t: 0\nmodel name\t: Some CPU @ 2.80GHz\n\nprocessor\t: 1\nmodel name\t: Other\n";
        assert_eq!(model_name(text).as_deref(), Some("Some CPU @ 2.80GHz"));
        assert_eq!(model_name("BogoMIPS: 1"), None);
    }
}
