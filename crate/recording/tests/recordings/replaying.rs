//! A replay decides what was recorded, to the bit, and tells what differs.

use mapless_recording::{Content, News, Options, Report, replay};

use crate::drive::{Plan, drive};
use crate::{SHORT, file};

fn replayed(bytes: &[u8], settings: &[&str]) -> (Report, Vec<News>) {
    let settings = settings.iter().map(|&setting| setting.to_owned()).collect();
    let mut news = Vec::new();
    let options = Options { settings, ..Options::default() };
    let report = replay(bytes, &options, |told| news.push(told.clone())).unwrap();
    (report, news)
}

#[test]
fn a_drive_is_decided_again_to_the_bit() {
    let recorded = drive(Plan { columns: 360, seconds: 6.0, pressed_s: 4.5, ..SHORT });
    let (report, news) = replayed(&file(&recorded), &[]);
    assert_eq!((report.different_ticks, report.different_answers, report.lost), (0, 0, 0), "{news:#?}");
    assert!(report.ticks >= 300 && report.answers > 30 && !report.is_cut, "{report:?}");
    assert_eq!(report.recorded_digest.as_ref(), Some(&report.digest));
    assert!(report.complaints.is_empty(), "{:?}", report.complaints);
    let changes: Vec<&str> = news
        .iter()
        .filter_map(|news| match news {
            News::Change { text, .. } => Some(&**text),
            News::Difference(_) => None,
        })
        .collect();
    let pressed = "Aborted: the emergency stop is pressed";
    assert_eq!(changes, ["Aborted: the emergency stop is silent", "Standby", "Driving", pressed, "Standby"]);
    let fastest_m_s = recorded.1.iter().map(|entry| match &entry.content {
        Content::Tick(tick) => tick.linear_m_s,
        _ => 0.0,
    });
    assert!(fastest_m_s.fold(0.0, f64::max) > 0.3, "the robot drove");
}

#[test]
fn what_is_set_while_it_drives_is_set_in_the_replay() {
    let mut recorded = drive(Plan { changed_s: 1.7, ..SHORT });
    let (same, news) = replayed(&file(&recorded), &[]);
    assert_eq!((same.different_ticks, same.different_answers), (0, 0), "{news:#?}");
    assert_eq!(same.complaints["packets"], (1, "a packet was lost".to_owned()));
    let (set, _) = replayed(&file(&recorded), &["supervisor.max_speed_m_s=0.1"]);
    assert!(set.different_ticks > 0, "what is set for the replay stays set");
    for of in [
        |content: &Content| matches!(content, Content::Limits(_)),
        |content: &Content| matches!(content, Content::Planner(_)),
    ] {
        let at = recorded.1.iter().position(|entry| of(&entry.content)).unwrap();
        let without = recorded.1.remove(at);
        let (other, _) = replayed(&file(&recorded), &[]);
        assert!(other.different_ticks + other.different_answers > 0, "{without:?} does matter");
        recorded.1.insert(at, without);
    }
}

#[test]
fn other_settings_and_other_messages_differ_where_they_matter() {
    let mut recorded = drive(SHORT);
    let bytes = file(&recorded);
    let (same, _) = replayed(&bytes, &[]);
    assert_eq!((same.different_ticks, same.different_answers), (0, 0));
    let (slow, news) = replayed(&bytes, &["supervisor.max_speed_m_s=0.1", "planner.goal_tolerance_m=1.5"]);
    assert!(slow.different_ticks > 0 && slow.different_answers == 0, "the limit is the supervisor's");
    assert_ne!(slow.digest, same.digest);
    assert_eq!(slow.recorded_digest, same.recorded_digest);
    let first = news.iter().find_map(|news| match news {
        News::Difference(difference) => Some(difference),
        News::Change { .. } => None,
    });
    let (name, then, now) = &first.unwrap().fields[0];
    assert!(*name == "command" && then != now, "{first:?}");

    let (other, _) = replayed(&bytes, &["sensor.height_m=0.9"]);
    assert!(other.different_answers > 0);

    // A scan that is missing is told at its answer.
    let last = |content: &Content| matches!(content, Content::Answer(_));
    let answer = recorded.1.iter().rposition(|entry| last(&entry.content)).unwrap();
    let scan = recorded.1[..answer].iter().rposition(|entry| matches!(entry.content, Content::Scan(_)));
    recorded.1.remove(scan.unwrap());
    let (missing, news) = replayed(&file(&recorded), &[]);
    assert!(missing.different_answers >= 1, "{news:?}");
    assert!(format!("{news:?}").contains("no answer: its scan or goal is not in the recording"));
}

#[test]
fn a_setting_that_makes_no_sense_is_refused_with_what_was_expected() {
    let bytes = file(&drive(Plan { seconds: 0.3, ..SHORT }));
    for (setting, expected) in [
        ("planner.speed=1", "--set planner.speed=1: no key speed: expected one of "),
        ("supervisor.scan_s", "--set supervisor.scan_s: expected KEY=VALUE"),
        ("supervisor.scan_s=fast", "--set supervisor.scan_s=fast: "),
        ("supervisor.scan_s=-1", "supervisor.scan_s = -1: expected "),
        ("sensor.rings=4", "--set sensor: "),
    ] {
        let options = Options { settings: vec![setting.to_owned()], ..Options::default() };
        let error = replay(&*bytes, &options, |_| {}).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
}
