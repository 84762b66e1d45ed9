//! Any moment of a recording, in any order, is as if everything before it had just been replayed.

use core::cell::Cell;
use core::time::Duration;
use std::io::Result;
use std::rc::Rc;

use mapless_recording::{Moment, Options, Player, RecordingError, Source, replay};

use crate::drive::{Plan, drive};
use crate::{SHORT, file};

/// A file that counts what is read of it.
#[derive(Debug)]
struct Counted {
    bytes: Vec<u8>,
    read: Rc<Cell<usize>>,
}

impl Source for Counted {
    fn length(&self) -> u64 {
        self.bytes.length()
    }

    fn read_at(&self, at: u64, into: &mut [u8]) -> Result<usize> {
        let read = self.bytes.read_at(at, into)?;
        self.read.set(self.read.get() + read);
        Ok(read)
    }
}

fn open(bytes: &[u8]) -> core::result::Result<Player<Vec<u8>>, RecordingError> {
    Player::open(bytes.to_vec(), Options::default())
}

fn decided(bytes: &[u8]) -> Player<Vec<u8>> {
    let mut player = open(bytes).unwrap();
    while !player.found().has_ended {
        player.decide_on(50);
    }
    player
}

/// Every number of a moment that the page shows.
fn words(moment: &Moment<'_>) -> String {
    let seen = moment.seen.map(|seen| {
        let step = seen.step.map(|step| {
            (step.status, step.command, step.profile.to_vec(), step.subgoals.to_vec(), step.chosen)
        });
        (seen.scan.arrived, seen.scan.points_m.len(), seen.scan.pose, step)
    });
    format!("{:?} {:?} {:?} {seen:?}", moment.pose, moment.decision, moment.task)
}

#[test]
fn any_moment_is_as_if_everything_before_it_had_just_been_replayed() {
    let bytes = file(&drive(Plan { seconds: 6.0, pressed_s: 4.5, changed_s: 2.7, ..SHORT }));
    let mut player = decided(&bytes);
    let report = player.report().unwrap();
    assert_eq!(report.digest, replay(&*bytes, &Options::default(), |_| {}).unwrap().digest);
    assert_eq!((report.different_ticks, report.different_answers), (0, 0));
    assert!(player.found().scans.len() > 20 && player.found().trail.len() > 40);
    assert_eq!(player.until(), player.found().until);

    let mut forward = decided(&bytes);
    let times: Vec<Duration> = (0..40).map(|index| Duration::from_millis(150 * index)).collect();
    let straight: Vec<String> = times
        .iter()
        .map(|at| {
            forward.go_to(*at).unwrap();
            words(&forward.moment().unwrap())
        })
        .collect();
    assert!(straight.iter().any(|words| words.contains("Driving")));
    for jump in 0..40 {
        let index = 17 * jump % 40;
        player.go_to(times[index]).unwrap();
        assert_eq!(words(&player.moment().unwrap()), straight[index], "{:?}", times[index]);
    }
    let surface = player.ask(|planner| planner.predicted_surface().map(|_| ()));
    assert_eq!(surface, Some(Ok(())));
}

#[test]
fn little_is_read_to_open_a_recording_and_its_end_is_known() {
    let bytes = file(&drive(Plan { columns: 360, seconds: 6.0, ..SHORT }));
    let read = Rc::new(Cell::new(0));
    let source = Counted { bytes: bytes.clone(), read: Rc::clone(&read) };
    let player = Player::open(source, Options::default()).unwrap();
    // A buffer each for what is decided and what is shown, whatever the length.
    let most = 2 * (256 << 10);
    assert!(read.get() < most && 2 * most < bytes.len(), "{} of {} bytes", read.get(), bytes.len());
    assert!((5.8..6.1).contains(&player.until().as_secs_f64()), "{:?}", player.until());
}

#[test]
fn a_cut_recording_plays_up_to_the_cut() {
    let bytes = file(&drive(SHORT));
    let whole = decided(&bytes);
    for share in [0.3, 0.55, 0.8] {
        let cut = (share * bytes.len() as f64) as usize;
        let mut player = decided(&bytes[..cut]);
        let until = player.found().until;
        assert!(player.is_cut() && player.found().fault.is_none(), "{:?}", player.found().fault);
        assert!(until > Duration::ZERO && until < whole.found().until);
        let replayed = replay(&bytes[..cut], &Options::default(), |_| {}).unwrap();
        assert_eq!(player.report().unwrap().digest, replayed.digest);
        player.go_to(until / 2).unwrap();
        assert!(player.moment().is_some());
    }
}

#[test]
fn a_broken_recording_plays_up_to_the_fault_and_names_it() {
    let mut bytes = file(&drive(SHORT));
    let middle = bytes.len() / 2;
    bytes[middle..middle + 64].fill(0xff);
    let mut player = decided(&bytes);
    player.go_to(Duration::MAX).unwrap();
    let fault = player.found().fault.as_ref().unwrap().to_string();
    assert!(fault.starts_with("after message ") && fault.contains("(byte "), "{fault}");
    assert!(player.found().until > Duration::from_millis(300));
}

#[test]
fn what_is_no_recording_is_refused_with_what_was_expected() {
    let refused = |bytes: &[u8]| open(bytes).unwrap_err().to_string();
    assert!(refused(b"a,b\n1,2\n").contains("expected an MCAP file"));
    assert!(refused(b"").contains("expected an MCAP file"));
    let mut other = mcap::Writer::new(std::io::Cursor::new(Vec::new())).unwrap();
    let channel = other.add_channel(0, "/chatter", "json", &std::collections::BTreeMap::new()).unwrap();
    let header =
        mcap::records::MessageHeader { channel_id: channel, sequence: 0, log_time: 1, publish_time: 1 };
    other.write_to_known_channel(&header, b"{}").unwrap();
    other.finish().unwrap();
    let other = other.into_inner().into_inner();
    let expected = "no topic of type sensor_msgs/msg/PointCloud2: expected one for scan";
    assert!(refused(&other).contains(expected), "{}", refused(&other));
    // Without its summary the file is gone through.
    let cut = refused(&other[..other.len() - 40]);
    assert!(cut.contains(expected), "{cut}");
}

#[test]
fn decisions_that_differ_are_found_with_their_times() {
    let recorded = drive(SHORT);
    let bytes = file(&recorded);
    let settings = vec!["supervisor.max_speed_m_s=0.1".to_owned()];
    let mut player = Player::open(bytes, Options { settings, ..Options::default() }).unwrap();
    player.decide_on(usize::MAX);
    let differences = &player.found().differences;
    assert_eq!(differences.len() as u64, player.report().unwrap().different_ticks);
    assert!(differences.iter().all(|difference| difference.whose == "supervisor"));
    assert!(differences.windows(2).all(|pair| pair[0].at <= pair[1].at));
}

#[test]
fn a_record_that_claims_more_bytes_than_there_are_numbers_ends_the_file() {
    // No opcode that means anything, so that its head alone is looked at.
    let bytes = [b"\x89MCAP0\r\n".as_slice(), &[0x80], &[0xff; 8], &[0; 32]].concat();
    let error = Player::open(bytes, Options::default()).unwrap_err().to_string();
    assert!(error.contains("expected"), "{error}");
}
