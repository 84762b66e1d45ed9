//! Files that are cut, broken, compressed, or none.

use std::io::Cursor;

use mapless_recording::{Entry, Reader, RecordingError};
use mcap::records::Record;
use proptest::prelude::*;

use crate::drive::{Plan, drive};
use crate::{SHORT, file};

fn read(bytes: &[u8]) -> Result<(Vec<Entry>, bool), RecordingError> {
    let mut reader = Reader::new(bytes, Default::default())?;
    let mut entries = Vec::new();
    while let Some(entry) = reader.next_entry()? {
        entries.push(entry);
    }
    Ok((entries, reader.is_cut()))
}

#[test]
fn what_was_written_is_read() {
    let (head, entries) = drive(Plan { changed_s: 1.7, ..SHORT });
    let bytes = file(&(head.clone(), entries.clone()));
    let (found, is_cut) = read(&bytes).unwrap();
    // NaN of a heading differs from itself.
    assert_eq!(format!("{found:?}"), format!("{entries:?}"));
    assert!(!is_cut);
    let mut reader = Reader::new(&*bytes, Default::default()).unwrap();
    reader.next_entry().unwrap();
    assert_eq!(reader.head(), Some(&head));
}

#[test]
fn a_file_cut_at_any_byte_is_read_up_to_the_cut() {
    let (head, entries) = drive(Plan { seconds: 0.8, ..SHORT });
    let bytes = file(&(head, entries.clone()));
    let ends = message_ends(&bytes);
    assert_eq!(ends.len(), entries.len());
    let check = |cut: usize| {
        let (found, is_cut) = read(&bytes[..cut]).unwrap();
        let whole = ends.iter().filter(|end| **end <= cut).count();
        assert_eq!(format!("{found:?}"), format!("{:?}", &entries[..whole]), "cut at {cut}");
        assert!(is_cut, "cut at {cut}");
    };
    for end in &ends {
        check(end - 1);
        check(*end);
    }
    let mut runner = proptest::test_runner::TestRunner::new(ProptestConfig::with_cases(300));
    let checked = |cut| {
        check(cut);
        Ok(())
    };
    runner.run(&(1..bytes.len()), checked).unwrap();
}

/// Where each message of an uncompressed file ends.
fn message_ends(bytes: &[u8]) -> Vec<usize> {
    const MAGIC: usize = 8;
    const HEADER: usize = 9;
    let mut ends = Vec::new();
    let mut at = MAGIC;
    while at + HEADER <= bytes.len() {
        let (opcode, length) =
            (bytes[at], u64::from_le_bytes(bytes[at + 1..at + HEADER].try_into().unwrap()));
        match opcode {
            // A chunk: its messages follow its header of times, sizes, checksum and no compression.
            0x06 => at += HEADER + 8 + 8 + 8 + 4 + 4 + 8,
            0x05 => {
                at += HEADER + length as usize;
                ends.push(at);
            }
            // The data ends.
            0x0f => break,
            _ => at += HEADER + length as usize,
        }
    }
    ends
}

#[test]
fn a_recording_has_the_profile_that_ros_reads() {
    let bytes = file(&drive(Plan { seconds: 0.3, ..SHORT }));
    let mut found = Vec::new();
    for record in mcap::read::LinearReader::new(&bytes).unwrap() {
        match record.unwrap() {
            Record::Header(header) => found.push(format!("profile {}", header.profile)),
            Record::Schema { header, data } => {
                assert!(header.encoding == "ros2msg" && !data.is_empty());
            }
            Record::Channel(channel) => assert_eq!(channel.message_encoding, "cdr"),
            Record::Chunk { header, .. } => assert_eq!(header.compression, ""),
            _ => {}
        }
    }
    assert_eq!(found, ["profile ros2"]);
}

#[test]
fn what_is_no_recording_is_refused_with_its_place() {
    let refusal = |bytes: &[u8]| read(bytes).unwrap_err().to_string();
    assert!(refusal(b"").contains("expected an MCAP file"));
    assert!(refusal(b"PK\x03\x04 something else").contains("expected an MCAP file"));
    let mut bytes = file(&drive(Plan { seconds: 0.6, ..SHORT }));
    let end = message_ends(&bytes)[20];
    bytes[end - 1] ^= 0xff;
    // The checksum of the chunk says so at its end, if not the decoder at once.
    let error = read(&bytes).unwrap_err();
    assert!(error.messages >= 20 && error.to_string().contains("(byte "), "{error}");
}

#[test]
fn a_record_that_claims_more_than_its_chunk_is_an_error_or_a_cut() {
    let bytes = file(&drive(Plan { seconds: 0.6, ..SHORT }));
    let ends = message_ends(&bytes);
    for pair in ends.windows(2).rev().take(5) {
        let mut bytes = bytes.clone();
        // The second byte of the length of the record that begins here: the file is long enough for it.
        bytes[pair[0] + 2] += 8;
        assert!(read(&bytes).map_or(true, |(_, is_cut)| is_cut), "it is taken for whole");
    }
}

proptest! {
    #[test]
    fn no_bytes_make_the_reader_panic(mut noise in prop::collection::vec((0_usize..60_000, any::<u8>()), 1..8)) {
        use std::sync::LazyLock;
        static FILE: LazyLock<Vec<u8>> = LazyLock::new(|| file(&drive(Plan { seconds: 0.5, ..SHORT })));
        let mut bytes = FILE.clone();
        for (at, value) in noise.drain(..) {
            let at = at % bytes.len();
            bytes[at] = value;
        }
        let _ = read(&bytes);
    }
}

#[test]
fn an_empty_recording_is_one() {
    let (head, _) = drive(Plan { seconds: 0.02, ..SHORT });
    let writer = mapless_recording::Writer::new(Cursor::new(Vec::new()), &head).unwrap();
    let bytes = writer.finish().unwrap().into_inner();
    assert_eq!(read(&bytes).unwrap(), (vec![], false));
}
