//! `cargo xtask soak`: hours of the drive that the tests have five minutes of.

use xshell::{Shell, cmd};

/// Drives for so many simulated hours, and prints what came of it.
pub(crate) fn run(sh: &Shell, hours: u32) -> anyhow::Result<()> {
    let minutes = (60 * u64::from(hours)).to_string();
    // As the tests build it: optimised, with overflow checks and debug assertions.
    cmd!(sh, "cargo test --package mapless-recording --test recordings soak -- --nocapture")
        .env("MAPLESS_SOAK_MINUTES", minutes)
        .run()?;
    Ok(())
}
