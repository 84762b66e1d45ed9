//! Captures of sensors' packets.

use serde_json::Value;

use super::{Answer, Check, Report, expect};

/// The check of each report, by its name.
pub(crate) const CHECKS: &[(&str, Check)] = &[
    ("pcap-cut-last-packet", |report| good_with(report, "ends inside packet 116")),
    ("pcap-every-packet-twice", |report| good_with(report, "116 packets left out: the same bytes")),
    ("pcap-half-turn-lost", half_a_turn_is_missing),
    ("pcap-ip-fragments", |report| good(report, "scan.pcap")),
    ("pcap-null-loopback", |report| good(report, "scan.pcap")),
    ("pcap-one-bad-block", |report| good_with(report, "packet 21, block 4, flag = 0x0000")),
    ("pcap-puck-hi-res", puck_hi_res_is_read),
    ("pcap-reordered-behind", |report| good_with(report, "2 packets put back in the order")),
    ("pcap-sll2", |report| good(report, "scan.pcap")),
    ("pcap-snaplen-96", |report| refused(report, "scan.pcap", &["cut at 96 of 1248 bytes (snaplen)"])),
    ("pcap-two-vlp16", both_sensors_are_named),
    ("pcapng", |report| good(report, "scan.pcapng")),
    ("real-scanparser-my", |report| {
        refused(report, "my.pcap", &["its 41 data packets hold no whole revolution", "ends inside packet 79"])
    }),
];

/// Everything that was seen and decided, without what was left out.
fn seen(answer: &Answer) -> Value {
    let mut json = answer.json.clone();
    if let Some(object) = json.as_object_mut() {
        object.remove("warnings");
    }
    json
}

/// The same as for the good capture, without a word.
fn good(report: &Report, file: &str) -> Result<(), String> {
    let (answer, right) = (report.perceive(file, &[]), report.perceive_good("good.pcap"));
    expect(right.code == Some(0), &right)?;
    expect(answer.code == Some(0) && answer.json == right.json && answer.stderr.is_empty(), &answer)
}

/// The same as for the good capture, with one warning.
fn good_with(report: &Report, warning: &str) -> Result<(), String> {
    let (answer, right) = (report.perceive("scan.pcap", &[]), report.perceive_good("good.pcap"));
    expect(right.code == Some(0), &right)?;
    let warnings = answer.json["warnings"].as_array().map_or(&[][..], Vec::as_slice);
    let is_told = warnings.len() == 1 && warnings[0].as_str().is_some_and(|text| text.contains(warning));
    expect(answer.code == Some(0) && seen(&answer) == seen(&right) && is_told, &answer)?;
    expect(answer.stderr.starts_with("warning: scan.pcap: ") && answer.stderr.contains(warning), &answer)
}

fn refused(report: &Report, file: &str, words: &[&str]) -> Result<(), String> {
    let answer = report.perceive(file, &[]);
    let names = words.iter().all(|word| answer.stderr.contains(word));
    expect(answer.code == Some(1) && answer.json.is_null() && names, &answer)
}

/// The gap parts the capture into 0.7 turns before it and 0.9 after it.
fn half_a_turn_is_missing(report: &Report) -> Result<(), String> {
    refused(report, "scan.pcap", &["no whole revolution", "1 gap: ", "by the sensor's time stamps"])
}

/// The same packets with two thirds of the elevations: as many returns, and level ground all around.
fn puck_hi_res_is_read(report: &Report) -> Result<(), String> {
    let (answer, right) = (report.perceive("scan.pcap", &[]), report.perceive_good("good.pcap"));
    let counts = [&answer, &right].map(|answer| answer.json["returns"].as_u64());
    expect(answer.code == Some(0) && counts[0].is_some() && counts[0] == counts[1], &answer)?;
    expect(seen(&answer)["profile"] != seen(&right)["profile"], &answer)
}

/// Without a choice both are named; with one, the sensor of the good capture sees the same.
fn both_sensors_are_named(report: &Report) -> Result<(), String> {
    refused(report, "scan.pcap", &["192.168.1.201:2368", "192.168.1.202:2369"])?;
    let right = report.perceive_good("good.pcap");
    let first = report.perceive("scan.pcap", &["--source", "192.168.1.201"]);
    expect(first.code == Some(0) && seen(&first) == seen(&right), &first)?;
    let none = report.perceive("scan.pcap", &["--source", "192.168.1.203"]);
    expect(none.code == Some(1) && none.stderr.contains("source = 192.168.1.203: expected one of"), &none)
}
