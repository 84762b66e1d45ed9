//! Static programs for Linux, built without a C toolchain: what they need of musl comes with Rust, and so
//! does their linker.

use anyhow::ensure;
use xshell::{Cmd, Shell, cmd};

use crate::count::{Count, Runner, count};
use crate::python::Environment;
use crate::setup;

/// Their targets.
pub(crate) const AARCH64: &str = "aarch64-unknown-linux-musl";
pub(crate) const X86_64: &str = "x86_64-unknown-linux-musl";
/// That of this machine, if it is one of them.
const OWN: Option<&str> = if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
    Some(X86_64)
} else if cfg!(all(target_os = "linux", target_arch = "aarch64")) {
    Some(AARCH64)
} else {
    None
};
/// Run programs for AArch64 on other processors.
const QEMU: [&str; 2] = ["qemu-aarch64", "qemu-aarch64-static"];

/// `command`, which builds for `target`, with the linker for it.
pub(crate) fn linked<'a>(command: Cmd<'a>, target: &str) -> Cmd<'a> {
    command.args(["--target", target]).env(linker_variable(target), "rust-lld")
}

fn linker_variable(target: &str) -> String {
    format!("CARGO_TARGET_{}_LINKER", target.to_uppercase().replace('-', "_"))
}

/// Drives two routes as static programs for x86-64: their digests are those of every other target.
pub(crate) fn test(sh: &Shell) -> anyhow::Result<Count> {
    if OWN != Some(X86_64) {
        println!("{X86_64}: skipped, as its programs cannot run here");
        return Ok(Count { skipped: 1, ..Count::default() });
    }
    routes(sh, X86_64, &[])
}

/// The same for AArch64, with the kept recording decided again.
pub(crate) fn test_aarch64(sh: &Shell) -> anyhow::Result<Count> {
    let runner = runner(sh, AARCH64)?;
    let recording = cmd!(sh, "cargo test --package mapless-recording --test recordings the_kept_recording");
    let mut sum = tested(sh, recording, AARCH64, &runner)?;
    sum += routes(sh, AARCH64, &runner)?;
    Ok(sum)
}

/// The words before a program for `target` that run it here: none for a program of this machine; qemu or an
/// emulator of our own environment for AArch64.
pub(crate) fn runner(sh: &Shell, target: &str) -> anyhow::Result<Vec<String>> {
    if OWN == Some(target) {
        return Ok(Vec::new());
    }
    ensure!(target == AARCH64, "programs for {target} run on Linux on x86-64 alone");
    let qemu = QEMU
        .into_iter()
        .find(|qemu| cmd!(sh, "{qemu} --version").quiet().ignore_stdout().ignore_stderr().run().is_ok());
    match qemu {
        Some(qemu) => Ok(vec![qemu.to_owned()]),
        None => emulator(sh),
    }
}

/// Drives two routes in the field.
fn routes(sh: &Shell, target: &str, runner: &[String]) -> anyhow::Result<Count> {
    let routes = cmd!(sh, "cargo test --package mapless-tests --test digests in_the_field");
    tested(sh, routes, target, runner)
}

/// Runs `test`, whose programs `runner` runs unless it is empty.
fn tested(sh: &Shell, test: Cmd<'_>, target: &str, runner: &[String]) -> anyhow::Result<Count> {
    setup::target(sh, target)?;
    let mut test = linked(test, target);
    if !runner.is_empty() {
        // Not by its variable, which is divided at spaces.
        test = test.arg("--config").arg(format!("target.{target}.runner={runner:?}"));
    }
    // Under an emulator threads are slow.
    count(test.args(["--", "--test-threads", "1"]), Runner::Cargo)
}

/// The words that run a program for AArch64 without qemu.
fn emulator(sh: &Shell) -> anyhow::Result<Vec<String>> {
    let environment = Environment {
        folder: &setup::target_dir(sh).join("aarch64-venv"),
        requirements: "tests/aarch64/requirements.txt",
        pythons: &["python3", "python3.12", "python3.11", "python"],
        fits: |version| version >= (3, 8),
        missing: "Programs for AArch64 need qemu-aarch64, or Python 3.8 or newer with pip for an emulator, and neither is on \
            PATH. Install one, for example with `sudo apt-get install qemu-user`.",
    };
    let python = std::path::absolute(environment.set_up(sh)?)?;
    let script = sh.current_dir().join("tests/aarch64/emulate.py");
    Ok([python, script].map(|path| path.display().to_string()).into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cargo_reads_the_linker_by_the_target_s_name() {
        assert_eq!(linker_variable(X86_64), "CARGO_TARGET_X86_64_UNKNOWN_LINUX_MUSL_LINKER");
    }
}
