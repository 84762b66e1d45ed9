//! Static programs for Linux, built without a C toolchain: what they need of musl comes with Rust, and so
//! does their linker.

use std::path::Path;

use anyhow::{Context as _, ensure};
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

/// The recording that the tests keep, and its digest.
const KEPT: &str = "crate/recording/tests/kept";

/// `command`, which builds for `target`, with the linker for it.
pub(crate) fn linked<'a>(command: Cmd<'a>, target: &str) -> Cmd<'a> {
    command.args(["--target", target]).env(linker_variable(target), "rust-lld")
}

fn linker_variable(target: &str) -> String {
    format!("CARGO_TARGET_{}_LINKER", target.to_uppercase().replace('-', "_"))
}

/// Drives two routes in the field as static programs for x86-64: their digests are those of every other
/// target.
pub(crate) fn test(sh: &Shell) -> anyhow::Result<Count> {
    if OWN != Some(X86_64) {
        println!("{X86_64}: skipped, as its programs cannot run here");
        return Ok(Count { skipped: 1, ..Count::default() });
    }
    setup::target(sh, X86_64)?;
    let test = cmd!(sh, "cargo test --package mapless-tests --test digests in_the_field");
    count(linked(test, X86_64), Runner::Cargo)
}

/// Replays the kept recording and drives two routes with the command line for AArch64, and compares the
/// digests. It has no threads, which Cargo's test programs have: with them the emulator is many times slower.
pub(crate) fn test_aarch64(sh: &Shell) -> anyhow::Result<Count> {
    setup::target(sh, AARCH64)?;
    linked(cmd!(sh, "cargo build --release --package mapless-cli"), AARCH64).run()?;
    let program = std::path::absolute(setup::target_dir(sh).join(AARCH64).join("release/mapless"))?;
    let digests = sh.read_file("tests/digests.toml")?;
    let mut cases =
        vec![("replay", format!("{KEPT}/drive.mcap"), sh.read_file(format!("{KEPT}/drive.digest"))?)];
    for route in ["gsb", "ht"] {
        let digest = digests.lines().find_map(|line| line.strip_prefix(&format!("{route} = ")));
        let digest = digest.with_context(|| format!("tests/digests.toml has no {route}"))?;
        cases.push(("run", format!("terrains/scenarios/{route}.toml"), digest.replace('"', "")));
    }
    let mut sum = Count::default();
    for (what, file, digest) in &cases {
        let digest = digest.trim();
        let printed = command(sh, AARCH64, &program)?.args([what, file.as_str()]).read()?;
        ensure!(
            printed.lines().any(|line| line.starts_with("digest") && line.ends_with(digest)),
            "{what} {file} for AArch64: expected the digest {digest}, and it printed\n{printed}"
        );
        println!("{what} {file}: the digest is that of every other target");
        sum.passed += 1;
    }
    Ok(sum)
}

/// Runs a program for `target`: itself on such a machine; by qemu, or by an emulator in an environment of our
/// own, for AArch64 elsewhere.
pub(crate) fn command<'a>(sh: &'a Shell, target: &str, program: &Path) -> anyhow::Result<Cmd<'a>> {
    if OWN == Some(target) {
        return Ok(cmd!(sh, "{program}"));
    }
    ensure!(target == AARCH64, "programs for {target} run on such a machine alone");
    let qemu = QEMU
        .into_iter()
        .find(|qemu| cmd!(sh, "{qemu} --version").quiet().ignore_stdout().ignore_stderr().run().is_ok());
    if let Some(qemu) = qemu {
        return Ok(cmd!(sh, "{qemu} {program}"));
    }
    let environment = Environment {
        folder: &setup::target_dir(sh).join("aarch64-venv"),
        requirements: "tests/aarch64/requirements.txt",
        pythons: &["python3", "python3.12", "python3.11", "python"],
        fits: |version| version >= (3, 8),
        missing: "Programs for AArch64 need qemu-aarch64, or Python 3.8 or newer with pip for an emulator, and neither is on \
            PATH. Install one, for example with `sudo apt-get install qemu-user`.",
    };
    let python = environment.set_up(sh)?;
    Ok(cmd!(sh, "{python} tests/aarch64/emulate.py {program}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cargo_reads_the_linker_by_the_target_s_name() {
        assert_eq!(linker_variable(X86_64), "CARGO_TARGET_X86_64_UNKNOWN_LINUX_MUSL_LINKER");
    }
}
