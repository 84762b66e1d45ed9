//! Python environments of our own, with pinned requirements.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use xshell::{Shell, cmd};

/// An environment to set up.
pub(crate) struct Environment<'a> {
    /// Its folder.
    pub(crate) folder: &'a Path,
    /// Its requirements, for pip.
    pub(crate) requirements: &'a str,
    /// Programs to try, the best first.
    pub(crate) pythons: &'a [&'a str],
    /// Whether a version, as (3, 11), is suitable.
    pub(crate) fits: fn((u32, u32)) -> bool,
    /// The message if none of them is: what is missing, and what to install.
    pub(crate) missing: &'a str,
}

impl Environment<'_> {
    /// Installs it, unless it is there with these very requirements; returns its Python.
    pub(crate) fn set_up(&self, sh: &Shell) -> anyhow::Result<PathBuf> {
        let Self { folder, requirements, .. } = *self;
        let python = folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
        let wanted = sh.read_file(requirements)?;
        let installed = folder.join("installed-requirements.txt");
        if sh.read_file(&installed).is_ok_and(|installed| installed == wanted) {
            return Ok(python);
        }
        let fits = |name: &&&str| {
            let printed = cmd!(sh, "{name} --version").quiet().ignore_stderr().read();
            printed.ok().and_then(|printed| version(&printed)).is_some_and(self.fits)
        };
        let Some(system) = self.pythons.iter().find(fits) else { bail!("{}", self.missing) };
        sh.remove_path(folder)?;
        let shown = folder.display();
        cmd!(sh, "{system} -m venv {folder}").run().with_context(|| {
            format!("{system} could not make an environment in {shown}; its module venv may be a package of its own")
        })?;
        println!("Installing what {requirements} names into {shown}, once.");
        cmd!(sh, "{python} -m pip install --quiet --disable-pip-version-check --requirement {requirements}")
            .run()
            .with_context(|| {
                format!(
                    "pip could not install {requirements}; it needs the network and the Python Package Index"
                )
            })?;
        sh.write_file(&installed, wanted)?;
        Ok(python)
    }
}

/// Major and minor version in `Python 3.11.7`.
fn version(printed: &str) -> Option<(u32, u32)> {
    let mut numbers = printed.trim().strip_prefix("Python ")?.split('.');
    Some((numbers.next()?.parse().ok()?, numbers.next()?.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_read_as_python_prints_them() {
        assert_eq!(version("Python 3.11.7\n"), Some((3, 11)));
        assert_eq!(version("Python 2.7.18"), Some((2, 7)));
        assert_eq!(version("3.11"), None);
    }
}
