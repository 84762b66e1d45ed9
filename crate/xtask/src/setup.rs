//! Prerequisites of build and tests on a fresh machine; each part is skipped if it is already there.

use std::env;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use xshell::{Shell, cmd};

/// The name of npm's program.
pub(crate) const NPM: &str = if cfg!(windows) { "npm.cmd" } else { "npm" };

/// The oldest Node that vite runs on (`engines` in `package.json`).
const OLDEST_NODE: (u32, u32) = (20, 19);

/// Cargo's target folder.
pub(crate) fn target_dir(sh: &Shell) -> PathBuf {
    let root = sh.current_dir();
    env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), |named| root.join(named))
}

/// Adds the standard library for wasm to the toolchain.
pub(crate) fn wasm_target(sh: &Shell) -> anyhow::Result<()> {
    target(sh, "wasm32-unknown-unknown")
}

/// Adds the standard library for a target to the toolchain.
pub(crate) fn target(sh: &Shell, name: &str) -> anyhow::Result<()> {
    let libraries = cmd!(sh, "rustc --print target-libdir --target {name}").quiet().read()?;
    if Path::new(&libraries).is_dir() {
        return Ok(());
    }
    cmd!(sh, "rustup target add {name}").run().with_context(|| {
        format!(
            "The target {name} is missing and rustup, which would add it, failed. Without rustup, install the \
             standard library for {name} from where Rust came from."
        )
    })
}

/// Adds rustfmt and clippy to a minimal toolchain.
pub(crate) fn lint_tools(sh: &Shell) -> anyhow::Result<()> {
    for (command, component) in [("fmt", "rustfmt"), ("clippy", "clippy")] {
        if cmd!(sh, "cargo {command} --version").quiet().ignore_stdout().ignore_stderr().run().is_err() {
            cmd!(sh, "rustup component add {component}").run()?;
        }
    }
    Ok(())
}

/// Builds the wasm-bindgen tools of the version in `Cargo.lock` once, and returns their folder.
pub(crate) fn wasm_bindgen(sh: &Shell) -> anyhow::Result<PathBuf> {
    let lock = sh.read_file("Cargo.lock")?;
    let version = locked_version(&lock, "wasm-bindgen").context("Cargo.lock has no wasm-bindgen")?;
    let tools = sh.current_dir().join("target/tools");
    let root = tools.join(format!("wasm-bindgen-{version}"));
    // cargo writes this file last, after both programs are in place.
    if sh.path_exists(root.join(".crates2.json")) {
        return Ok(root.join("bin"));
    }
    println!("Building wasm-bindgen {version} into {}; this takes a few minutes, once.", root.display());
    let build = tools.join("build");
    // Without its default features it has no TLS: the tools talk to this machine only. Less optimisation
    // builds sooner, and the tools run for less than a second.
    cmd!(sh, "cargo install wasm-bindgen-cli --version {version} --no-default-features")
        .args(["--bin", "wasm-bindgen", "--bin", "wasm-bindgen-test-runner"])
        .arg("--root")
        .arg(&root)
        .arg("--target-dir")
        .arg(&build)
        .env("CARGO_PROFILE_RELEASE_OPT_LEVEL", "1")
        .run()?;
    sh.remove_path(build)?;
    Ok(root.join("bin"))
}

/// The version of cargo-fuzz that is built.
const CARGO_FUZZ: &str = "0.13.2";

/// Builds cargo-fuzz once, and returns the program.
pub(crate) fn cargo_fuzz(sh: &Shell) -> anyhow::Result<PathBuf> {
    let tools = sh.current_dir().join("target/tools");
    let root = tools.join(format!("cargo-fuzz-{CARGO_FUZZ}"));
    if !sh.path_exists(root.join(".crates2.json")) {
        let build = tools.join("build");
        cmd!(
            sh,
            "cargo install cargo-fuzz --version {CARGO_FUZZ} --locked --root {root} --target-dir {build}"
        )
        .run()?;
        sh.remove_path(build)?;
    }
    Ok(root.join("bin/cargo-fuzz"))
}

/// Installs the npm packages of `package-lock.json`, unless these very ones are installed.
pub(crate) fn npm_packages(sh: &Shell) -> anyhow::Result<()> {
    let how_to = "Install Node 20.19 or newer, with npm, from https://nodejs.org/ or a package manager.";
    let Ok(node) = cmd!(sh, "node --version").quiet().ignore_stderr().read() else {
        bail!("Node was not found. {how_to}");
    };
    if node_version(&node).is_none_or(|version| version < OLDEST_NODE) {
        bail!("Node is {node}, which is too old. {how_to}");
    }
    let lock = sh.read_file("package-lock.json")?;
    // Kept inside node_modules so that it is removed with them.
    let installed = "node_modules/.installed-package-lock.json";
    if sh.read_file(installed).is_ok_and(|installed| installed == lock) {
        return Ok(());
    }
    cmd!(sh, "{NPM} ci --no-audit --no-fund").run()?;
    sh.write_file(installed, lock)?;
    Ok(())
}

/// The version of `package` in the text of a `Cargo.lock`.
fn locked_version<'a>(lock: &'a str, package: &str) -> Option<&'a str> {
    let name = format!("name = \"{package}\"");
    let (_, after) = lock.split_once(&format!("\n{name}\n"))?;
    after.lines().next()?.strip_prefix("version = \"")?.strip_suffix('"')
}

/// Major and minor version in `v20.20.2`.
fn node_version(printed: &str) -> Option<(u32, u32)> {
    let mut numbers = printed.trim().strip_prefix('v')?.split('.');
    Some((numbers.next()?.parse().ok()?, numbers.next()?.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn locked_version_is_that_of_the_package_and_of_no_longer_name() {
        let lock = "version = 4\n\n[[package]]\nname = \"wasm-bindgen-test\"\nversion = \"0.3.80\"\n\n[[package]]\n\
            name = \"wasm-bindgen\"\nversion = \"0.2.130\"\nsource = \"registry\"\n\n[[package]]\nname = \"xtask\"\n";
        assert_eq!(locked_version(lock, "wasm-bindgen"), Some("0.2.130"));
        assert_eq!(locked_version(lock, "wasm-bindgen-test"), Some("0.3.80"));
        assert_eq!(locked_version(lock, "wasm"), None);
    }

    #[test]
    fn node_version_orders_as_node_counts() {
        assert_eq!(node_version("v20.20.2\n"), Some((20, 20)));
        assert!(node_version("v20.9.0") < Some(OLDEST_NODE));
        assert!(node_version("v22.1.0") > Some(OLDEST_NODE));
        assert_eq!(node_version("20.1.0"), None);
    }
}
