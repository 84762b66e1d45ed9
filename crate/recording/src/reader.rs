//! Reading a recording, or a `rosbag2` MCAP.

use std::collections::BTreeMap;
use std::io::{ErrorKind, Read};

use byteorder::{BigEndian, LittleEndian};
use mapless_robot::senses::Arrival;
use mcap::McapError;
use mcap::records::{MessageHeader, Record};
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use serde::de::DeserializeOwned;

use crate::compression;
use crate::entry::{Content, Entry};
use crate::error::{Fault, RecordingError};
use crate::head::{self, Head};
use crate::message::ConfigMessage;
use crate::topics::{Role, Roles, TopicNames};

/// No record of an MCAP file is longer, bytes: a broken length asks for no more memory.
const LONGEST: usize = 1 << 30;
/// Read at once at most, bytes.
const READ: usize = 1 << 20;
/// How a message begins that says how it is encoded.
const ENCAPSULATION: usize = 4;

/// Reads entries one after the other, in the order of the file.
pub struct Reader<R> {
    file: R,
    mcap: LinearReader,
    known: Known,
    bytes: u64,
    is_cut: bool,
}

/// What is known of a file as far as it was read.
#[derive(Clone, Debug)]
pub(crate) struct Known {
    schemas: BTreeMap<u16, String>,
    roles: Roles,
    head: Option<Head>,
    /// When the clock of the entries begins; the first message's time, without a head.
    began_ns: Option<u64>,
    messages: u64,
}

impl Known {
    /// Nothing but the topics that are named.
    pub(crate) fn new(topics: TopicNames) -> Self {
        let roles = Roles::new(topics);
        Self { schemas: BTreeMap::new(), roles, head: None, began_ns: None, messages: 0 }
    }
}

impl<R> std::fmt::Debug for Reader<R> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Reader").field("messages", &self.known.messages).field("bytes", &self.bytes).finish()
    }
}

impl<R: Read> Reader<R> {
    /// Reads `file`; `topics` names those whose roles do not follow from the file.
    ///
    /// # Errors
    /// [`RecordingError`] if no decompressor can be had.
    pub fn new(file: R, topics: TopicNames) -> Result<Self, RecordingError> {
        Self::with(file, LinearReaderOptions::default(), 0, Known::new(topics))
    }

    /// Reads whole records that begin at byte `begin` of a file; the last ones end the file.
    ///
    /// # Errors
    /// [`RecordingError`] if no decompressor can be had.
    pub(crate) fn of_section(
        section: R,
        begin: u64,
        is_last: bool,
        known: Known,
    ) -> Result<Self, RecordingError> {
        let options =
            LinearReaderOptions::default().with_skip_start_magic(begin > 0).with_skip_end_magic(!is_last);
        Self::with(section, options, begin, known)
    }

    fn with(file: R, options: LinearReaderOptions, bytes: u64, known: Known) -> Result<Self, RecordingError> {
        let options = options.with_record_length_limit(LONGEST).with_validate_chunk_crcs(true);
        let mut mcap = LinearReader::new_with_options(options);
        compression::add_to(&mut mcap).map_err(|error| RecordingError {
            messages: known.messages,
            byte: bytes,
            fault: error.into(),
        })?;
        Ok(Self { file, mcap, known, bytes, is_cut: false })
    }

    /// What stands at the begin of a recording of the node; `None` for other files, and before the first
    /// entry.
    #[must_use]
    pub fn head(&self) -> Option<&Head> {
        self.known.head.as_ref()
    }

    /// The topics of the file that have a role, as far as it was read.
    #[must_use]
    pub fn topics(&self) -> &TopicNames {
        self.known.roles.found()
    }

    /// Whether the file ended before its end was marked.
    #[must_use]
    pub fn is_cut(&self) -> bool {
        self.is_cut
    }

    /// The next entry; `None` at the end of the file. Messages of other topics are passed over.
    ///
    /// # Errors
    /// [`RecordingError`] names the place and what was expected there. A file that ends early is no error.
    pub fn next_entry(&mut self) -> Result<Option<Entry>, RecordingError> {
        self.advance().map_err(|fault| self.error(fault))
    }

    /// The next entry of a section; `None` at its end, whatever is missing in the file.
    ///
    /// # Errors
    /// As [`Self::next_entry`].
    pub(crate) fn next_in_section(&mut self) -> Result<Option<Entry>, RecordingError> {
        self.read().map_err(|fault| self.error(fault))
    }

    /// What is known of the file so far.
    pub(crate) fn known(&self) -> &Known {
        &self.known
    }

    /// When the clock of the entries begins, nanoseconds; 0 before the first message.
    pub(crate) fn began_ns(&self) -> u64 {
        self.known.began_ns.unwrap_or(0)
    }

    /// An error at the place that was read last.
    pub(crate) fn error(&self, fault: Fault) -> RecordingError {
        RecordingError { messages: self.known.messages, byte: self.bytes, fault }
    }

    fn advance(&mut self) -> Result<Option<Entry>, Fault> {
        if let Some(entry) = self.read()? {
            return Ok(Some(entry));
        }
        match self.known.roles.missing().next() {
            Some((role, topic)) if self.known.head.is_none() => {
                Err(Fault::NoTopic { role: role.name(), topic: topic.clone() })
            }
            _ => Ok(None),
        }
    }

    fn read(&mut self) -> Result<Option<Entry>, Fault> {
        loop {
            let (opcode, data) = match self.mcap.next_event() {
                None => break,
                // An empty file is none; what ends within a record was cut.
                Some(Err(McapError::UnexpectedEof)) if self.bytes > 0 => {
                    self.is_cut = true;
                    break;
                }
                Some(Err(error)) => return Err(error.into()),
                Some(Ok(LinearReadEvent::ReadRequest(wanted))) => {
                    let into = self.mcap.insert(wanted.min(READ));
                    let read = read(&mut self.file, into)?;
                    self.mcap.notify_read(read);
                    self.bytes += read as u64;
                    continue;
                }
                Some(Ok(LinearReadEvent::Record { opcode, data })) => (opcode, data),
            };
            match mcap::parse_record(opcode, data)? {
                Record::Schema { header, .. } => {
                    self.known.schemas.insert(header.id, header.name);
                }
                Record::Channel(channel) => {
                    let schema = self.known.schemas.get(&channel.schema_id).map_or("", String::as_str);
                    self.known.roles.take(&channel, schema)?;
                }
                Record::Metadata(metadata) if metadata.name == head::NAME && self.known.head.is_none() => {
                    let head = Head::from_metadata(&metadata.metadata)?;
                    self.known.roles.name(head.topics.clone());
                    self.known.began_ns = Some(head.began_ns);
                    self.known.head = Some(head);
                }
                Record::Message { header, data } => {
                    self.known.messages += 1;
                    let began_ns = *self.known.began_ns.get_or_insert(header.log_time);
                    if let Some(role) = self.known.roles.of(header.channel_id) {
                        return entry(role, &header, &data, began_ns).map(Some);
                    }
                }
                _ => {}
            }
        }
        Ok(None)
    }
}

fn read(file: &mut impl Read, into: &mut [u8]) -> std::io::Result<usize> {
    loop {
        match file.read(into) {
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            read => return read,
        }
    }
}

fn entry(role: Role, header: &MessageHeader, data: &[u8], began_ns: u64) -> Result<Entry, Fault> {
    let content = match role {
        Role::Scan => Content::Scan(decode(role, data)?),
        Role::Odometry => Content::Odometry(Box::new(decode(role, data)?)),
        Role::Imu => Content::Imu(Box::new(decode(role, data)?)),
        Role::EmergencyStop => Content::EmergencyStop(decode(role, data)?),
        Role::Reset => Content::Reset(decode(role, data)?),
        Role::GoalPose => Content::GoalPose(decode(role, data)?),
        Role::Clock => Content::Clock(decode(role, data)?),
        Role::Goal => Content::Goal(decode(role, data)?),
        Role::Tick => Content::Tick(decode(role, data)?),
        Role::Answer => Content::Answer(decode(role, data)?),
        Role::Spoilt => Content::Spoilt(decode(role, data)?),
        Role::Limits => Content::Limits(decode_config(role, data)?),
        Role::Planner => Content::Planner(decode_config(role, data)?),
        Role::Lost => Content::Lost(decode(role, data)?),
    };
    let at = core::time::Duration::from_nanos(header.log_time.saturating_sub(began_ns));
    let clock_ns = i64::try_from(header.publish_time).unwrap_or(i64::MAX);
    Ok(Entry { arrival: Arrival { at, clock_ns }, content })
}

fn decode_config<C: DeserializeOwned>(role: Role, data: &[u8]) -> Result<C, Fault> {
    let ConfigMessage { json } = decode(role, data)?;
    serde_json::from_str(&json).map_err(|error| Fault::Message {
        topic: role.name(),
        error: error.to_string(),
        expected: role.schema(),
    })
}

/// A message in either byte order.
fn decode<M: DeserializeOwned>(role: Role, data: &[u8]) -> Result<M, Fault> {
    let fail = |error: String| Fault::Message { topic: role.name(), error, expected: role.schema() };
    let Some((encapsulation, body)) = data.split_at_checked(ENCAPSULATION) else {
        return Err(fail(format!("{} bytes", data.len())));
    };
    let decoded = match encapsulation[..2] {
        [0, 0] => cdr_encoding::from_bytes::<M, BigEndian>(body),
        [0, 1] => cdr_encoding::from_bytes::<M, LittleEndian>(body),
        _ => return Err(fail(format!("encapsulation {encapsulation:02x?}"))),
    };
    decoded.map(|(message, _)| message).map_err(|error| fail(error.to_string()))
}
