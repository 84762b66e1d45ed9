//! Recordings of drives, and their replay.
//!
//! A recording is an MCAP file of the profile `ros2` (messages in CDR, schemas `ros2msg`, not compressed),
//! complete in itself: the messages as the node got them, the configuration, and every decision. Its entries
//! stand in the order in which they took effect, so a replay in that order makes the same decisions, to the
//! bit, natively and in a browser.
//!
//! - [`Writer`] writes a recording, [`Reader`] reads one, or a `rosbag2` MCAP of a robot, compressed or not,
//!   up to where the file ends.
//! - [`replay()`] drives estimator, motion compensation, supervisor and planner with it, and tells where
//!   their decisions differ from those that were recorded, or what they decide when something fails that did
//!   not fail on the robot ([`InjectedFault`]).
//! - [`Player`] goes to any moment of a recording and tells what was seen and decided there; [`choices`]
//!   tells beforehand which topics must be named.
//!
//! The crate opens no file, reads no clock and starts no thread. It builds natively and for
//! wasm32-unknown-unknown.

mod compression;
mod entry;
mod error;
mod head;
mod message;
mod player;
mod reader;
mod replay;
mod schema;
mod topics;
mod writer;

pub use entry::{Content, Entry};
pub use error::{Fault, RecordingError};
pub use head::Head;
pub use message::{AnswerMessage, GoalMessage, LostMessage, SpoiltMessage, TickMessage};
pub use player::{Candidate, Choice, Found, Player, Source, choices};
pub use reader::Reader;
pub use replay::{Difference, FaultKind, Faults, InjectedFault, Moment, News, Options, Report, Seen, replay};
pub use topics::{Role, TopicNames};
pub use writer::Writer;
