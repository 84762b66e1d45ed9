//! What stands at the begin of a recording: the metadata record `mapless`.

use std::collections::BTreeMap;

use mapless_robot::drive_config::DriveConfig;
use mcap::records::Metadata;

use crate::error::Fault;
use crate::topics::{Role, TopicNames};

/// The record's name.
pub(crate) const NAME: &str = "mapless";
/// What this program writes and reads.
const FORMAT: &str = "1";

/// What a recording needs besides its entries to be complete in itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Head {
    /// When the monotonic clock of the entries began, on the system's clock, nanoseconds.
    pub began_ns: u64,
    /// The configuration of the drive.
    pub config: DriveConfig,
    /// Absolute names of the topics that the messages came on.
    pub topics: TopicNames,
}

impl Head {
    pub(crate) fn to_metadata(&self) -> Result<Metadata, Fault> {
        let fail = |error: serde_json::Error| Fault::Head { name: "config", error: error.to_string() };
        let mut entries = BTreeMap::from([
            ("format".to_owned(), FORMAT.to_owned()),
            ("version".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
            ("began_ns".to_owned(), self.began_ns.to_string()),
            ("config".to_owned(), serde_json::to_string(&self.config).map_err(fail)?),
        ]);
        for (role, topic) in &self.topics {
            entries.insert(format!("topic.{}", role.name()), topic.clone());
        }
        Ok(Metadata { name: NAME.to_owned(), metadata: entries })
    }

    pub(crate) fn from_metadata(entries: &BTreeMap<String, String>) -> Result<Self, Fault> {
        let get = |name: &'static str| {
            let missing =
                || Fault::Head { name, error: "missing: expected a recording of mapless-node".to_owned() };
            entries.get(name).ok_or_else(missing)
        };
        let fail = |name: &'static str, error: String| Fault::Head { name, error };
        let format = get("format")?;
        if format != FORMAT {
            return Err(fail("format", format!("{format:?}: expected {FORMAT:?}, which this program reads")));
        }
        let began = get("began_ns")?;
        let began_ns = began
            .parse()
            .map_err(|error| fail("began_ns", format!("{began:?}: {error}: expected nanoseconds")))?;
        let config = serde_json::from_str(get("config")?)
            .map_err(|error| fail("config", format!("{error}: expected a configuration of this version")))?;
        let topics = Role::INPUTS.into_iter().filter_map(|role| {
            entries.get(&format!("topic.{}", role.name())).map(|topic| (role, topic.clone()))
        });
        Ok(Self { began_ns, config, topics: topics.collect() })
    }
}
