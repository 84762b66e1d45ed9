//! Where reading may begin in a file.

use std::collections::BTreeMap;
use std::io::ErrorKind;

use mcap::records::{Channel, Footer, Record, op};
use mcap::{MAGIC, McapError};

use super::source::Source;
use crate::error::Fault;
use crate::topics::{Role, Roles, TopicNames};

/// Opcode and length of a record.
const RECORD_HEAD: u64 = 9;
/// Footer and magic: the last bytes of a whole file.
const TAIL: u64 = RECORD_HEAD + 20 + MAGIC.len() as u64;
/// A longer summary is not read; the file is gone through instead, record by record.
const LONGEST_SUMMARY: u64 = 64 << 20;
/// Messages outside chunks are divided into sections of about this many bytes.
const SECTION: u64 = 1 << 20;
/// Read at once while going through a file, bytes.
const BLOCK: u64 = 16 << 10;
/// What is read of a chunk or a message: a head and the times.
const TIMES: u64 = RECORD_HEAD + 16;

/// Where the sections of a file begin, and until when it goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Index {
    /// Bytes at which whole records begin, the first 0: a chunk each, with what follows it.
    pub(crate) sections: Vec<u64>,
    /// The last byte and one.
    pub(crate) end: u64,
    /// The newest message's log time, nanoseconds, as far as chunks tell.
    pub(crate) until_ns: u64,
}

impl Index {
    /// From the file's own summary, or, where it has none, from the heads of its records.
    ///
    /// # Errors
    /// No MCAP file, or one whose summary has no topic for scan, odometry or IMU.
    pub(crate) fn of(source: &impl Source, topics: &TopicNames) -> Result<Self, Fault> {
        let mut magic = [0; MAGIC.len()];
        if fill(source, 0, &mut magic)? < magic.len() || magic != *MAGIC {
            return Err(McapError::BadMagic.into());
        }
        if let Some(summary) = Summary::of(source)?
            && let Some(index) = Self::from_summary(source, summary, topics)?
        {
            return Ok(index);
        }
        Self::from_heads(source)
    }

    /// `None` if the summary does not tell of chunks.
    fn from_summary(
        source: &impl Source,
        summary: Summary,
        topics: &TopicNames,
    ) -> Result<Option<Self>, Fault> {
        let mut roles = Roles::new(topics.clone());
        for (channel, schema) in &summary.channels {
            roles.take(channel, schema)?;
        }
        let mut begins = summary.chunks;
        if begins.is_empty() {
            return Ok(None);
        }
        for role in Role::SENSORS {
            if !roles.found().contains_key(&role) {
                return Err(Fault::Needed { role: role.name(), schema: role.schema() });
            }
        }
        begins.sort_unstable();
        // What stands before the first chunk is a section of its own.
        let sections = std::iter::once(0).chain(begins).collect();
        Ok(Some(Self { sections, end: source.length(), until_ns: summary.until_ns }))
    }

    fn from_heads(source: &impl Source) -> Result<Self, Fault> {
        let end = source.length();
        let (mut sections, mut until_ns) = (vec![0], 0);
        let (mut block, mut begin) = (Vec::new(), 0);
        let mut at = MAGIC.len() as u64;
        while at <= end.saturating_sub(RECORD_HEAD) {
            let within = at - begin;
            if block.is_empty() || within + TIMES + RECORD_HEAD > block.len() as u64 {
                begin = at;
                block.resize(BLOCK as usize, 0);
                let read = fill(source, at, &mut block)?;
                block.truncate(read);
            }
            let record = &block[(at - begin) as usize..];
            if record.len() < RECORD_HEAD as usize {
                break;
            }
            let time_ns = |offset: usize| {
                let bytes = record.get(offset..offset + 8).and_then(|bytes| bytes.try_into().ok());
                bytes.map_or(0, u64::from_le_bytes)
            };
            let section = sections.last().copied().unwrap_or(0);
            match record[0] {
                op::CHUNK => {
                    sections.push(at);
                    until_ns = until_ns.max(time_ns(RECORD_HEAD as usize + 8));
                }
                op::MESSAGE => {
                    if at - section >= SECTION {
                        sections.push(at);
                    }
                    until_ns = until_ns.max(time_ns(RECORD_HEAD as usize + 6));
                }
                op::DATA_END => break,
                _ => {}
            }
            at = at.saturating_add(RECORD_HEAD).saturating_add(length_of(record));
        }
        Ok(Self { sections, end, until_ns })
    }

    /// The bytes of a section.
    pub(crate) fn section(&self, number: usize) -> Option<[u64; 2]> {
        let begin = *self.sections.get(number)?;
        Some([begin, self.sections.get(number + 1).copied().unwrap_or(self.end)])
    }
}

/// What a file that was ended says of itself.
#[derive(Debug, Default)]
pub(super) struct Summary {
    /// Each with the type of its messages.
    pub(super) channels: Vec<(Channel, String)>,
    /// Messages of each channel, where they were counted.
    pub(super) messages: BTreeMap<u16, u64>,
    /// Bytes at which chunks begin.
    pub(super) chunks: Vec<u64>,
    /// The newest message's log time, nanoseconds.
    until_ns: u64,
}

impl Summary {
    /// `None` if the file has none, or a broken one.
    pub(super) fn of(source: &impl Source) -> Result<Option<Self>, Fault> {
        let Some(bytes) = summary(source)? else { return Ok(None) };
        let (mut schemas, mut summary) = (BTreeMap::new(), Self::default());
        let mut rest = &*bytes;
        while let Some((head, body)) = rest.split_at_checked(RECORD_HEAD as usize) {
            let length = usize::try_from(length_of(head)).unwrap_or(usize::MAX);
            let Some((record, after)) = body.split_at_checked(length) else { return Ok(None) };
            match mcap::parse_record(head[0], record)? {
                Record::Schema { header, .. } => {
                    schemas.insert(header.id, header.name);
                }
                Record::Channel(channel) => {
                    let schema = schemas.get(&channel.schema_id).cloned().unwrap_or_default();
                    summary.channels.push((channel, schema));
                }
                Record::ChunkIndex(chunk) => {
                    summary.chunks.push(chunk.chunk_start_offset);
                    summary.until_ns = summary.until_ns.max(chunk.message_end_time);
                }
                Record::Statistics(statistics) => summary.messages = statistics.channel_message_counts,
                _ => {}
            }
            rest = after;
        }
        Ok(Some(summary))
    }
}

/// The bytes of the summary of a file that was ended; `None` without one.
fn summary(source: &impl Source) -> Result<Option<Vec<u8>>, Fault> {
    let Some(at) = source.length().checked_sub(TAIL) else { return Ok(None) };
    let mut tail = [0; TAIL as usize];
    if fill(source, at, &mut tail)? < tail.len() || tail[0] != op::FOOTER || !tail.ends_with(MAGIC) {
        return Ok(None);
    }
    let body = &tail[RECORD_HEAD as usize..tail.len() - MAGIC.len()];
    let Ok(Record::Footer(Footer { summary_start, .. })) = mcap::parse_record(op::FOOTER, body) else {
        return Ok(None);
    };
    let length = at.saturating_sub(summary_start);
    if summary_start == 0 || length == 0 || length > LONGEST_SUMMARY {
        return Ok(None);
    }
    let mut bytes = vec![0; length as usize];
    Ok((fill(source, summary_start, &mut bytes)? == bytes.len()).then_some(bytes))
}

/// The length of the record that begins so.
fn length_of(head: &[u8]) -> u64 {
    head[1..RECORD_HEAD as usize].try_into().map_or(0, u64::from_le_bytes)
}

/// Reads until `into` is full or the file ends; how much that was.
fn fill(source: &impl Source, at: u64, into: &mut [u8]) -> std::io::Result<usize> {
    let mut filled = 0;
    while filled < into.len() {
        match source.read_at(at + filled as u64, &mut into[filled..]) {
            Ok(0) => break,
            Ok(read) => filled += read,
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(filled)
}
