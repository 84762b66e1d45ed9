//! Writing a recording.

use std::collections::BTreeMap;
use std::io::{Seek, Write};

use byteorder::LittleEndian;
use mcap::WriteOptions;
use mcap::records::MessageHeader;
use serde::Serialize;

use crate::entry::{Content, Entry};
use crate::error::{Fault, RecordingError};
use crate::head::Head;
use crate::message::ConfigMessage;
use crate::schema;
use crate::topics::{Role, decision_topic};

/// Says that little-endian CDR follows.
const ENCAPSULATION: [u8; 4] = [0, 1, 0, 0];
/// Bytes of a chunk: what a crash may lose, unless [`Writer::flush`] is called.
const CHUNK: u64 = 1 << 20;

/// Writes a recording. What was flushed is whole, whatever becomes of the process.
pub struct Writer<W: Write + Seek> {
    writer: mcap::Writer<W>,
    began_ns: u64,
    channels: BTreeMap<Role, u16>,
    sequence: u32,
    bytes: u64,
    buffer: Vec<u8>,
}

impl<W: Write + Seek> std::fmt::Debug for Writer<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Writer").field("sequence", &self.sequence).field("bytes", &self.bytes).finish()
    }
}

impl<W: Write + Seek> Writer<W> {
    /// Begins a recording.
    ///
    /// # Errors
    /// [`RecordingError`] if `out` cannot be written.
    pub fn new(out: W, head: &Head) -> Result<Self, RecordingError> {
        Self::begin(out, head).map_err(|fault| RecordingError { messages: 0, byte: 0, fault })
    }

    fn begin(out: W, head: &Head) -> Result<Self, Fault> {
        let options = WriteOptions::new()
            .profile("ros2")
            .library(concat!("mapless ", env!("CARGO_PKG_VERSION")))
            .compression(None)
            .chunk_size(Some(CHUNK))
            // Chunks are written whole, not begun and patched later.
            .disable_seeking(true);
        let mut writer = options.create(out)?;
        writer.write_metadata(&head.to_metadata()?)?;
        let mut channels = BTreeMap::new();
        let inputs = head.topics.iter().map(|(role, topic)| (*role, topic.clone()));
        let decisions = Role::DECISIONS.into_iter().map(|role| (role, decision_topic(role)));
        for (role, topic) in inputs.chain(decisions) {
            let name = role.schema();
            let schema = writer.add_schema(name, "ros2msg", schema::definition(name).as_bytes())?;
            channels.insert(role, writer.add_channel(schema, &topic, "cdr", &BTreeMap::new())?);
        }
        let (began_ns, buffer) = (head.began_ns, Vec::new());
        Ok(Self { writer, began_ns, channels, sequence: 0, bytes: 0, buffer })
    }

    /// Writes an entry. One whose topic is not in the head is left out.
    ///
    /// # Errors
    /// [`RecordingError`] if it cannot be written.
    pub fn write(&mut self, entry: &Entry) -> Result<(), RecordingError> {
        self.put(entry).map_err(|fault| self.error(fault))
    }

    fn put(&mut self, entry: &Entry) -> Result<(), Fault> {
        let Some(&channel_id) = self.channels.get(&entry.content.role()) else { return Ok(()) };
        self.buffer.clear();
        self.buffer.extend(ENCAPSULATION);
        let role = entry.content.role();
        let fail = |error: String| Fault::Message { topic: role.name(), error, expected: role.schema() };
        match &entry.content {
            Content::Scan(message) => self.encode(message),
            Content::Odometry(message) => self.encode(message),
            Content::Imu(message) => self.encode(message),
            Content::EmergencyStop(message) | Content::Reset(message) => self.encode(message),
            Content::GoalPose(message) => self.encode(message),
            Content::Clock(message) => self.encode(message),
            Content::Goal(message) => self.encode(message),
            Content::Tick(message) => self.encode(message),
            Content::Answer(message) => self.encode(message),
            Content::Spoilt(message) => self.encode(message),
            Content::Limits(config) => self.encode(&as_message(config).map_err(fail)?),
            Content::Planner(config) => self.encode(&as_message(config).map_err(fail)?),
            Content::Lost(message) => self.encode(message),
        }
        .map_err(|error| fail(error.to_string()))?;
        let at_ns = u64::try_from(entry.arrival.at.as_nanos()).unwrap_or(u64::MAX);
        let header = MessageHeader {
            channel_id,
            sequence: self.sequence,
            log_time: self.began_ns.saturating_add(at_ns),
            publish_time: u64::try_from(entry.arrival.clock_ns).unwrap_or(0),
        };
        self.writer.write_to_known_channel(&header, &self.buffer)?;
        self.sequence = self.sequence.wrapping_add(1);
        self.bytes += self.buffer.len() as u64;
        Ok(())
    }

    fn encode(&mut self, message: &impl Serialize) -> Result<(), cdr_encoding::Error> {
        cdr_encoding::to_writer::<_, LittleEndian, _>(&mut self.buffer, message)
    }

    /// Bytes of the messages that were written.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Brings everything to the file.
    ///
    /// # Errors
    /// [`RecordingError`] if it cannot be written.
    pub fn flush(&mut self) -> Result<(), RecordingError> {
        let flushed = self.writer.flush();
        flushed.map_err(|error| self.error(error.into()))
    }

    /// Ends the recording with its index.
    ///
    /// # Errors
    /// [`RecordingError`] if it cannot be written.
    pub fn finish(mut self) -> Result<W, RecordingError> {
        match self.writer.finish() {
            Ok(_) => Ok(self.writer.into_inner()),
            Err(error) => Err(self.error(error.into())),
        }
    }

    fn error(&self, fault: Fault) -> RecordingError {
        RecordingError { messages: self.sequence.into(), byte: self.bytes, fault }
    }
}

fn as_message(config: &impl Serialize) -> Result<ConfigMessage, String> {
    let json = serde_json::to_string(config).map_err(|error| error.to_string())?;
    Ok(ConfigMessage { json })
}
