//! `mapless-bench FOLDER` writes the peers' inputs into the folder and then answers requests, a line each,
//! until its input ends.

/// Reads lines, writes lines.
#[cfg(not(target_arch = "wasm32"))]
fn main() -> anyhow::Result<()> {
    use std::io::Write as _;

    use anyhow::Context as _;

    let folder = std::env::args_os().nth(1).context("usage: mapless-bench FOLDER")?;
    mapless_bench::write_inputs(std::path::Path::new(&folder))?;
    let mut bench = mapless_bench::Bench::default();
    let mut answers = std::io::stdout().lock();
    for request in std::io::stdin().lines() {
        writeln!(answers, "{}", bench.answer(&request?))?;
        answers.flush()?;
    }
    Ok(())
}

/// In Node and Chromium the library answers.
#[cfg(target_arch = "wasm32")]
fn main() {}
