//! The licences of what is linked into a program.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use anyhow::Context as _;
use serde::Deserialize;
use xshell::{Shell, cmd};

/// How files with a licence or a notice begin.
const FILES: [&str; 5] = ["license", "licence", "copying", "notice", "copyright"];

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
}

#[derive(Deserialize)]
struct Package {
    name: String,
    version: String,
    license: Option<String>,
    repository: Option<String>,
    manifest_path: String,
    source: Option<String>,
}

/// The crates of others that `package` links on `target` with `features`: each with its licence, and every
/// text of a licence that comes with one of them.
pub(crate) fn of(sh: &Shell, package: &str, target: &str, features: &str) -> anyhow::Result<String> {
    // Macros run in the compiler, and are not linked.
    let tree = cmd!(
        sh,
        "cargo tree --package {package} --target {target} --edges normal,no-proc-macro --prefix none"
    )
    .args(["--no-default-features", "--features", features, "--format", "{p}"])
    .quiet()
    .read()?;
    let metadata = cmd!(sh, "cargo metadata --format-version 1 --filter-platform {target}").quiet().read()?;
    let metadata: Metadata = serde_json::from_str(&metadata).context("cargo metadata")?;
    let is_linked = |package: &&Package| {
        let told = format!("{} v{}", package.name, package.version);
        package.source.is_some()
            && tree.lines().any(|line| line == told || line.starts_with(&format!("{told} ")))
    };
    let mut linked: Vec<&Package> = metadata.packages.iter().filter(is_linked).collect();
    linked.sort_by_key(|package| (&package.name, &package.version));
    let mut texts: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut list = String::new();
    for package in linked {
        let name = format!("{} {}", package.name, package.version);
        let licence = package.license.as_deref().unwrap_or("see its text below");
        let repository = package.repository.as_deref().unwrap_or("crates.io");
        // Writing to a string cannot fail.
        let _ = writeln!(list, "{name}: {licence} ({repository})");
        for text in licences(Path::new(&package.manifest_path))? {
            texts.entry(text).or_default().push(name.clone());
        }
    }
    let mut all = format!("This program is linked with these crates:\n\n{list}");
    for (text, names) in texts {
        let _ = write!(all, "\n{}\nOf {}:\n\n{}\n", "=".repeat(80), names.join(", "), text.trim_end());
    }
    Ok(all)
}

/// The texts of licences beside a manifest.
fn licences(manifest: &Path) -> anyhow::Result<Vec<String>> {
    let folder = manifest.parent().context("a manifest has a folder")?;
    let mut texts = Vec::new();
    for entry in fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().to_lowercase();
        if entry.path().is_file() && FILES.iter().any(|begin| name.starts_with(begin)) {
            texts.push(String::from_utf8_lossy(&fs::read(entry.path())?).replace('\r', ""));
        }
    }
    Ok(texts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_notices_of_the_node_name_its_middleware_and_hold_its_licence() {
        let sh = Shell::new().unwrap();
        sh.change_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
        let notices = of(&sh, "mapless-node", "x86_64-unknown-linux-gnu", "jazzy").unwrap();
        assert!(notices.contains("\nrustdds 0.15.1: Apache-2.0") && notices.contains("\nserde 1."));
        assert!(notices.contains("Apache License") && notices.contains("Permission is hereby granted"));
        assert!(
            !notices.contains("\nmapless ") && !notices.contains("\nproptest "),
            "its own and its tests' are not"
        );
    }
}
