//! Files that are written once and never overwritten.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use anyhow::Context as _;

/// Writes a file, unless it is there already; a file with other contents is an error, never overwritten.
pub(crate) fn write_new(path: &Path, text: &str) -> anyhow::Result<()> {
    let context = || format!("--out: {}", path.display());
    match fs::read(path) {
        Ok(bytes) if bytes == text.as_bytes() => Ok(()),
        Ok(_) => {
            anyhow::bail!(
                "{}: expected no file, or the generated one: this one has other contents",
                context()
            )
        }
        Err(error) if error.kind() == ErrorKind::NotFound => fs::write(path, text).with_context(context),
        Err(error) => Err(error).with_context(context),
    }
}
