//! What can be wrong with a recording.

/// What is wrong, and where.
#[derive(Debug, thiserror::Error)]
#[error("after message {messages} (byte {byte}): {fault}")]
pub struct RecordingError {
    /// Messages that were read before, of all topics.
    pub messages: u64,
    /// Bytes of the file that were read by then; the fault stands before.
    pub byte: u64,
    /// What is wrong.
    pub fault: Fault,
}

/// What is wrong.
#[derive(Debug, thiserror::Error)]
pub enum Fault {
    /// The file could not be read.
    #[error(transparent)]
    Io(#[from] std::io::Error),
    /// It is no MCAP file, or a broken one.
    #[error("{0}: expected an MCAP file")]
    Mcap(mcap::McapError),
    /// A message cannot be decoded.
    #[error("{topic}: {error}: expected {expected} in CDR")]
    Message {
        /// Its topic.
        topic: &'static str,
        /// What the decoder says.
        error: String,
        /// Its type.
        expected: &'static str,
    },
    /// A topic has another type or encoding.
    #[error("topic {topic} is {found}: expected {expected} in cdr")]
    Type {
        /// The topic.
        topic: String,
        /// Its type and encoding.
        found: String,
        /// The type that its role has.
        expected: &'static str,
    },
    /// Two topics could be the same.
    #[error("{first} and {second} are both {schema}: expected one to be named, as --topic {role}={first}")]
    Ambiguous {
        /// What they could be.
        role: &'static str,
        /// The type of both.
        schema: &'static str,
        /// A topic.
        first: String,
        /// Another topic.
        second: String,
    },
    /// A topic that was named is not there.
    #[error("topic {topic} for {role} is not in the file")]
    NoTopic {
        /// What it was to be.
        role: &'static str,
        /// Its name.
        topic: String,
    },
    /// A topic that is needed is not there.
    #[error("no topic of type {schema}: expected one for {role}")]
    Needed {
        /// What it is for.
        role: &'static str,
        /// Its type.
        schema: &'static str,
    },
    /// Nothing would be decided.
    #[error("no goal: expected one on the topic goal_pose, or as --goal X,Y")]
    NoGoal,
    /// The head of the recording.
    #[error("metadata {name}: {error}")]
    Head {
        /// The entry.
        name: &'static str,
        /// What is wrong with it.
        error: String,
    },
    /// A value of the configuration.
    #[error(transparent)]
    Config(#[from] mapless_parameters::ConfigError),
    /// A setting that is to replace one of the configuration.
    #[error("--set {setting}: {error}")]
    Setting {
        /// The setting.
        setting: String,
        /// What is wrong with it.
        error: String,
    },
}

impl From<mcap::McapError> for Fault {
    fn from(error: mcap::McapError) -> Self {
        match error {
            mcap::McapError::Io(error) => Self::Io(error),
            error => Self::Mcap(error),
        }
    }
}
