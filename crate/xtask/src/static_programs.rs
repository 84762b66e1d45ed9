//! Static programs for Linux, built without a C toolchain: what they need of musl comes with Rust, and so
//! does their linker.

use xshell::{Cmd, Shell, cmd};

use crate::count::{Count, Runner, count};
use crate::setup;

/// Their targets.
pub(crate) const AARCH64: &str = "aarch64-unknown-linux-musl";
pub(crate) const X86_64: &str = "x86_64-unknown-linux-musl";
/// Runs programs for AArch64.
const QEMU: [&str; 2] = ["qemu-aarch64", "qemu-aarch64-static"];

/// `command`, which builds for `target`, with the linker for it.
pub(crate) fn linked<'a>(command: Cmd<'a>, target: &str) -> Cmd<'a> {
    command.args(["--target", target]).env(variable(target, "LINKER"), "rust-lld")
}

fn variable(target: &str, what: &str) -> String {
    format!("CARGO_TARGET_{}_{what}", target.to_uppercase().replace('-', "_"))
}

/// Drives two routes as static programs: their digests are those of every other target. AArch64 needs qemu.
pub(crate) fn test(sh: &Shell) -> anyhow::Result<Count> {
    let qemu = QEMU
        .into_iter()
        .find(|qemu| cmd!(sh, "{qemu} --version").quiet().ignore_stdout().ignore_stderr().run().is_ok());
    let mut sum = Count::default();
    for (target, runner) in [(X86_64, native()), (AARCH64, qemu)] {
        let Some(runner) = runner else {
            println!("{target}: skipped, as its programs cannot run here");
            sum.skipped += 1;
            continue;
        };
        setup::target(sh, target)?;
        let test = cmd!(sh, "cargo test --package mapless-tests --test digests");
        let test = linked(test, target).env(variable(target, "RUNNER"), runner).args(["in_the_field"]);
        sum += count(test, Runner::Cargo)?;
    }
    Ok(sum)
}

/// What runs a program of this very machine, if it is Linux on x86-64.
const fn native() -> Option<&'static str> {
    if cfg!(all(target_os = "linux", target_arch = "x86_64")) { Some("env") } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cargo_reads_the_linker_by_the_target_s_name() {
        assert_eq!(variable(X86_64, "LINKER"), "CARGO_TARGET_X86_64_UNKNOWN_LINUX_MUSL_LINKER");
    }
}
