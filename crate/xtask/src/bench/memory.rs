//! Memory of the command line and of the page.

use std::process::{Command, Stdio};
use std::time::Duration;

use anyhow::{Context as _, ensure};
use xshell::{Shell, cmd};

use crate::browser::Browser;
use crate::{page, setup};

const SCENARIO: &str = "terrains/scenarios/cht-ab.toml";
const PLAYED_S: u32 = 20;

/// Bytes in use.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Memory {
    /// Peak memory of `mapless run`; known on Linux alone.
    pub(crate) command_line: Option<u64>,
    /// JavaScript and wasm of the page and its worker, while it plays.
    pub(crate) page: u64,
}

/// Runs a scenario on the command line, and plays the page.
pub(crate) fn measure(sh: &Shell) -> anyhow::Result<Memory> {
    page::build(sh)?;
    let chrome = Browser::set_up(sh)?.chrome;
    let seconds = PLAYED_S.to_string();
    let printed = cmd!(sh, "node crate/bench/page_memory.mjs {chrome} dist {seconds}").read()?;
    let page = printed.trim().parse().with_context(|| format!("memory of the page: got {printed:?}"))?;
    Ok(Memory { command_line: command_line(sh)?, page })
}

fn command_line(sh: &Shell) -> anyhow::Result<Option<u64>> {
    cmd!(sh, "cargo build --release --package mapless-cli").run()?;
    let program =
        setup::target_dir(sh).join("release/mapless").with_extension(std::env::consts::EXE_EXTENSION);
    let mut run = Command::new(program);
    run.current_dir(sh.current_dir()).args(["run", SCENARIO]).stdout(Stdio::null()).stderr(Stdio::null());
    let mut run = run.spawn()?;
    let mut most = None;
    loop {
        let status = std::fs::read_to_string(format!("/proc/{}/status", run.id()));
        most = status.ok().and_then(|status| most_bytes(&status)).max(most);
        if let Some(status) = run.try_wait()? {
            ensure!(status.success(), "mapless run {SCENARIO} ended with {status}");
            return Ok(most);
        }
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// The peak of resident memory in the text of `/proc/PID/status`.
fn most_bytes(status: &str) -> Option<u64> {
    let (_, after) = status.split_once("VmHWM:")?;
    let kilobytes: u64 = after.split_whitespace().next()?.parse().ok()?;
    Some(1024 * kilobytes)
}

impl Memory {
    /// The section of the report.
    pub(crate) fn section(&self) -> String {
        let megabytes = |bytes: u64| format!("{:.0} MB", bytes as f64 * 1e-6);
        let command_line = self.command_line.map_or_else(|| "not told by this system".to_owned(), megabytes);
        format!(
            "\n## Memory\n\n| what | memory |\n|---|---:|\n\
             | `mapless run {SCENARIO}`, the most at a time | {command_line} |\n\
             | the page after {PLAYED_S} s of play: JavaScript and wasm, worker included, graphics not | {} |\n",
            megabytes(self.page)
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_peak_is_read() {
        assert_eq!(most_bytes("VmPeak:\t 9 kB\nVmHWM:\t  2048 kB\nVmRSS: 1 kB\n"), Some(2_097_152));
        assert_eq!(most_bytes("Name: x\n"), None);
    }
}
