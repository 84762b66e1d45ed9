//! The page: the wasm core with its bindings, then everything bundled into `dist/`.

use std::path::PathBuf;
use std::{env, process};

use anyhow::Context as _;
use xshell::{Shell, cmd};

use crate::setup;

/// Prints the size of a file in bytes: raw, gzip, brotli. Node has both compressors built in.
const MEASURE: &str = "import { readFileSync } from 'node:fs'; import { gzipSync, brotliCompressSync } from 'node:zlib'; \
    const raw = readFileSync(process.argv[1]); \
    console.log(raw.length, gzipSync(raw, { level: 9 }).length, brotliCompressSync(raw).length);";

/// Builds the page into `dist/`, for any static host.
pub(crate) fn build(sh: &Shell) -> anyhow::Result<()> {
    setup::npm_packages(sh)?;
    bindings(sh)?;
    let npm = setup::NPM;
    cmd!(sh, "{npm} run build").run()?;
    Ok(())
}

/// Builds the page and serves it until interrupted.
pub(crate) fn demo(sh: &Shell, port: u16) -> anyhow::Result<()> {
    build(sh)?;
    let port = port.to_string();
    let vite = "node_modules/vite/bin/vite.js";
    let command = cmd!(sh, "node {vite} preview --host 127.0.0.1 --port {port}");
    become_command(command.into())
}

/// The wasm modules with bindings; the page opens with the first.
pub(crate) const MODULES: [&str; 5] = [
    "mapless_wasm",
    "mapless_wasm_baselines",
    "mapless_wasm_heights",
    "mapless_wasm_replay",
    "mapless_wasm_verti_bench",
];

/// `--package` for each module's crate.
pub(crate) fn package_flags() -> [String; MODULES.len()] {
    MODULES.map(|module| format!("--package={}", module.replace('_', "-")))
}

/// Builds the wasm modules and their JavaScript bindings into `web/src/wasm/`, and reports the size of the
/// first: the page opens with it, and loads the others on demand.
fn bindings(sh: &Shell) -> anyhow::Result<()> {
    setup::wasm_target(sh)?;
    let wasm_bindgen = setup::wasm_bindgen(sh)?.join("wasm-bindgen");
    // Messages of panics name source files; the prefix of the packages' folder on this machine is cut off.
    let home = env::home_dir().context("the home folder")?.join(".cargo");
    let cargo_home = env::var_os("CARGO_HOME").map_or(home, PathBuf::from);
    let flags = ["--remap-path-prefix".to_owned(), format!("{}=cargo", cargo_home.display())];
    let flags = format!("target.wasm32-unknown-unknown.rustflags={flags:?}");
    let mut packages: Vec<String> = package_flags().into();
    packages.push("--package=mapless-planner-template".to_owned());
    cmd!(sh, "cargo build --config {flags} --profile page {packages...} --target wasm32-unknown-unknown")
        .run()?;
    let built = setup::target_dir(sh).join("wasm32-unknown-unknown/page");
    // Without its names the file is 7 % smaller (brotli); wasm-opt would take another 1.5 %, and no time off
    // a step.
    let strip = ["--remove-name-section", "--remove-producers-section"];
    for module in MODULES {
        let module = built.join(format!("{module}.wasm"));
        cmd!(sh, "{wasm_bindgen} --target web {strip...} --out-dir web/src/wasm {module}").run()?;
    }
    // Exports plain functions, so it needs no bindings.
    sh.copy_file(built.join("mapless_planner_template.wasm"), "web/src/wasm/planner_template.wasm")?;
    report_size(sh, "web/src/wasm/mapless_wasm_bg.wasm")
}

/// Prints the size of the wasm file, and writes it to `target/wasm-size.json`.
fn report_size(sh: &Shell, wasm: &str) -> anyhow::Result<()> {
    let sizes = cmd!(sh, "node --input-type=module --eval {MEASURE} {wasm}").quiet().read()?;
    let sizes: Vec<u64> =
        sizes.split(' ').map(str::parse).collect::<Result<_, _>>().context("size of the wasm")?;
    let &[raw, gzip, brotli] = sizes.as_slice() else { anyhow::bail!("size of the wasm: got {sizes:?}") };
    println!("wasm: {raw} bytes, {gzip} gzip, {brotli} brotli");
    let json = format!("{{\"raw_bytes\": {raw}, \"gzip_bytes\": {gzip}, \"brotli_bytes\": {brotli}}}\n");
    sh.write_file("target/wasm-size.json", json)?;
    Ok(())
}

/// Replaces this process, so that ending it ends the server.
#[cfg(unix)]
fn become_command(mut command: process::Command) -> anyhow::Result<()> {
    use std::os::unix::process::CommandExt as _;
    Err(command.exec()).context("vite did not start")
}

/// Runs the server as a child: only Unix can replace a process.
#[cfg(not(unix))]
fn become_command(mut command: process::Command) -> anyhow::Result<()> {
    let status = command.status().context("vite did not start")?;
    anyhow::ensure!(status.success(), "vite ended with {status}");
    Ok(())
}
