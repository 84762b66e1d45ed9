//! The node as a process.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Child, Command};

use anyhow::Context as _;
use mapless_node::config::NodeConfig;

/// What the node is told; see the file.
const CONFIG: &str = include_str!("../../over_ros.yaml");
const DOMAIN: &str = "domain_id: 0";
/// Lines of the node's log that an error shows.
const SHOWN_LINES: usize = 12;

/// A running node; it ends with this.
pub(crate) struct NodeProcess {
    child: Child,
    folder: tempfile::TempDir,
    /// What it was told.
    pub(crate) config: NodeConfig,
}

impl NodeProcess {
    /// Starts `program` in a domain.
    ///
    /// # Errors
    /// A program that cannot be started.
    pub(crate) fn start(program: &Path, domain_id: u16) -> anyhow::Result<Self> {
        let folder = tempfile::tempdir().context("a folder for the node's file")?;
        let file = folder.path().join("robot.yaml");
        let text = CONFIG.replace(DOMAIN, &format!("domain_id: {domain_id}"));
        let config = NodeConfig::parse(&file, &text)?;
        std::fs::write(&file, &text).with_context(|| file.display().to_string())?;
        let log = log_in(folder.path());
        let log = File::create(&log).with_context(|| log.display().to_string())?;
        let child = Command::new(program)
            .arg(&file)
            .stderr(log)
            .spawn()
            .with_context(|| program.display().to_string())?;
        Ok(Self { child, folder, config })
    }

    /// The last lines of its log.
    pub(crate) fn log(&self) -> String {
        let text = std::fs::read_to_string(log_in(self.folder.path())).unwrap_or_default();
        let lines: Vec<&str> = text.lines().collect();
        lines[lines.len().saturating_sub(SHOWN_LINES)..].join("\n")
    }
}

impl Drop for NodeProcess {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn log_in(folder: &Path) -> PathBuf {
    folder.join("log")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_node_s_file_is_in_order_and_in_the_domain_of_the_drive() {
        let text = CONFIG.replace(DOMAIN, "domain_id: 61");
        let config = NodeConfig::parse(Path::new("over_ros.yaml"), &text).unwrap();
        assert_eq!((config.domain_id, config.namespace.as_str()), (61, mapless_peer::NAMESPACE));
        assert!(config.use_sim_time);
    }
}
