//! `mapless perceive` through the real binary: exit codes, JSON, tables and pictures.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::Duration;

use serde_json::{Value, json};
use tempfile::TempDir;

/// A folder with scans.
struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        fs::write(self.path(name), bytes).unwrap();
    }

    /// `mapless perceive` on the scan `name`, from within the folder.
    fn perceive(&self, name: &str, options: &[&str]) -> Output {
        perceive(self.0.path(), name, options)
    }

    /// The JSON of a scan that can be read.
    fn json(&self, name: &str, options: &[&str]) -> Value {
        let output = self.perceive(name, &[&["--json"], options].concat());
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        assert!(output.stderr.is_empty(), "{output:?}");
        serde_json::from_slice(&output.stdout).unwrap()
    }

    /// A scan that cannot be read: code 1, nothing on stdout, a message that begins with the file.
    fn refuses(&self, name: &str, options: &[&str], message: &str) {
        let output = self.perceive(name, &[&["--json"], options].concat());
        let found = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{found}");
        assert!(output.stdout.is_empty(), "{output:?}");
        assert!(found.starts_with(&format!("error: {message}")), "expected {message}, found {found}");
        assert!(!found.contains("panicked"), "{found}");
    }
}

fn perceive(folder: &Path, name: &str, options: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mapless"));
    command.args([&["perceive", name], options].concat()).current_dir(folder).output().unwrap()
}

/// Directions of the beams of a VLP-16 that looks five times into each degree: azimuth and elevation.
fn beams() -> impl Iterator<Item = (f64, f64)> {
    (0..1800).flat_map(|column| {
        (0..16).map(move |ring| {
            (-PI + f64::from(column) * TAU / 1800.0, (-15.0 + 2.0 * f64::from(ring)).to_radians())
        })
    })
}

/// Level ground 0.8 m below the sensor, unless `range_m` of azimuth and elevation gives another range.
fn scan(range_m: impl Fn(f64, f64) -> Option<f64>) -> String {
    let mut text = String::from("x,y,z\n");
    for (azimuth, elevation) in beams() {
        let (sin_a, cos_a) = libm::sincos(azimuth);
        let (sin_e, cos_e) = libm::sincos(elevation);
        let ground_m = (elevation < 0.0).then(|| 0.8 / -sin_e).filter(|range_m| *range_m < 100.0);
        if let Some(range_m) = range_m(azimuth, elevation).or(ground_m) {
            let (x, y, z) = (range_m * cos_e * cos_a, range_m * cos_e * sin_a, range_m * sin_e);
            writeln!(text, "{x:.4},{y:.4},{z:.4}").unwrap();
        }
    }
    text
}

/// Level ground with a wall on the left, from 45° to 135°, 4 m away.
fn walled() -> String {
    scan(|azimuth, elevation| {
        let before_ground = elevation > -0.2;
        (before_ground && (45.0..135.0).contains(&azimuth.to_degrees())).then_some(4.0)
    })
}

/// Fails unless the object has every name of a perception report, and every number in its range.
fn assert_sound(result: &Value) {
    let number = |value: &Value| value.as_f64().unwrap_or_else(|| panic!("{value} is no number"));
    let profile = result["profile"].as_array().unwrap();
    assert_eq!(profile.len(), 360);
    for (column, entry) in profile.iter().enumerate() {
        let expected = -PI + column as f64 * PI / 180.0;
        assert!((number(&entry["azimuth_rad"]) - expected).abs() < 1e-12);
        match entry["kind"].as_str().unwrap() {
            "ground" => assert!(number(&entry["elevation_rad"]).abs() <= PI / 12.0 + 1e-12),
            "unknown" | "wall" => assert!(entry["elevation_rad"].is_null()),
            kind => panic!("{kind}"),
        }
    }
    let mut around = 0.0;
    for segment in result["segments"].as_array().unwrap() {
        let extent = number(&segment["extent_rad"]);
        around += extent;
        let turned = number(&segment["begin_rad"]) + extent - number(&segment["end_rad"]);
        assert!((turned / TAU - (turned / TAU).round()).abs() < 1e-9);
        assert!((number(&segment["width_m"]) - 7.0 * extent).abs() < 1e-9);
        let has_ground = match segment["verdict"].as_str().unwrap() {
            "valid" | "too_narrow" | "too_steep" => true,
            "unknown" | "wall" => false,
            verdict => panic!("{verdict}"),
        };
        for name in ["elevation_rad", "height_m"] {
            assert_eq!(segment[name].as_f64().is_some_and(f64::is_finite), has_ground, "{segment}");
        }
    }
    assert!((around - TAU).abs() < 1e-9, "the segments close the circle: {around}");
    for subgoal in result["subgoals"].as_array().unwrap() {
        for name in ["azimuth_rad", "elevation_rad", "bearing_rad"] {
            assert!(number(&subgoal[name]).is_finite());
        }
        let position = subgoal["position_m"].as_array().unwrap();
        assert!(position.len() == 3 && position.iter().all(|value| number(value).is_finite()));
        match subgoal["refusal"].as_str() {
            None => {
                let cost = subgoal["cost"].as_object().unwrap();
                let terms: f64 =
                    cost.iter().filter(|(name, _)| *name != "total").map(|(_, term)| number(term)).sum();
                assert_eq!(cost.len(), 6);
                assert!((terms - number(&cost["total"])).abs() < 1e-9);
            }
            Some("tilt" | "unseen") => assert!(subgoal["cost"].is_null()),
            Some(refusal) => panic!("{refusal}"),
        }
    }
    for name in ["returns", "occupied_cells", "inducing_inputs"] {
        assert!(result[name].as_u64().unwrap() > 0, "{name}");
    }
    assert!((1e-6..=1e-2).contains(&number(&result["jitter"])));
    assert!(number(&result["command"]["linear_m_s"]).is_finite());
    assert!(number(&result["command"]["angular_rad_s"]).is_finite());
}

#[test]
fn a_wall_on_the_left_is_a_wall_on_the_left() {
    let folder = Folder::new();
    folder.write("yard.csv", walled());
    for preset in ["default", "paper"] {
        let result = folder.json("yard.csv", &["--planner", preset]);
        assert_sound(&result);
        assert_eq!((result["status"].as_str(), result["reason"].as_str()), (Some("driving"), None));
        for (column, entry) in result["profile"].as_array().unwrap().iter().enumerate() {
            let azimuth_deg = column as i32 - 180;
            // The kernel reaches a few degrees beyond the corners.
            if (50..130).contains(&azimuth_deg) {
                assert_eq!(entry["kind"], "wall", "{preset}, {azimuth_deg}°");
            } else if !(35..145).contains(&azimuth_deg) {
                assert_eq!(entry["kind"], "ground", "{preset}, {azimuth_deg}°");
            }
        }
        let chosen = &result["subgoals"][result["chosen"].as_u64().unwrap() as usize];
        assert!(chosen["bearing_rad"].as_f64().unwrap().abs() < 0.5, "towards the goal ahead: {chosen}");
        assert!(chosen["refusal"].is_null());
    }
}

#[test]
fn the_same_points_give_the_same_result_from_every_format() {
    let folder = Folder::new();
    let text = walled();
    folder.write("yard.csv", &text);
    let rows = text.lines().skip(1);
    folder.write("yard.xyz", rows.clone().map(|row| row.replace(',', "\t") + "\n").collect::<String>());
    let count = rows.clone().count() + 1;
    let header = |data: &str| {
        format!(
            "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {count}\nHEIGHT 1\n\
             VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {count}\nDATA {data}\n"
        )
    };
    let points: String = rows.clone().map(|row| row.replace(',', " ") + "\n").collect();
    folder.write("ascii.pcd", header("ascii") + "nan nan nan\n" + &points);
    let mut binary = header("binary").into_bytes();
    binary.extend([f32::NAN; 3].iter().flat_map(|value| value.to_le_bytes()));
    let values = rows.clone().flat_map(|row| row.split(',')).map(|value| value.parse::<f32>().unwrap());
    binary.extend(values.flat_map(f32::to_le_bytes));
    folder.write("binary.pcd", binary);
    let veloview = rows.clone().map(|row| {
        let [x, y, z] = row.split(',').collect::<Vec<_>>()[..] else { panic!("{row}") };
        let right = y.strip_prefix('-').map_or_else(|| format!("-{y}"), str::to_owned);
        format!("7,{right},{x},{z}\n")
    });
    let names = "\"intensity\",\"Points_m_XYZ:0\",\"Points_m_XYZ:1\",\"Points_m_XYZ:2\"\n";
    folder.write("veloview.csv", names.to_owned() + &veloview.collect::<String>());
    folder.write("yard.pts", format!("{}\n{points}", count - 1));
    folder.write("yard.asc", format!("//X Y Z\n{points}"));
    let vertices = "property float x\nproperty float y\nproperty float z\nend_header\n";
    folder.write(
        "yard.ply",
        format!("ply\nformat ascii 1.0\nelement vertex {}\n{vertices}{points}", count - 1),
    );
    let numbers =
        |row: &str| row.split(',').map(|value| value.parse().unwrap()).chain([0.5]).collect::<Vec<f32>>();
    folder.write("yard.bin", rows.clone().flat_map(numbers).flat_map(f32::to_le_bytes).collect::<Vec<u8>>());

    let expected = folder.json("yard.csv", &[]);
    let others = ["yard.xyz", "veloview.csv", "yard.pts", "yard.asc", "yard.ply", "yard.bin"];
    for name in others.into_iter().chain(["ascii.pcd", "binary.pcd"]) {
        assert_eq!(folder.json(name, &[]), expected, "{name}");
    }
}

#[test]
fn a_scan_without_returns_or_none_within_reach_has_a_named_result() {
    let folder = Folder::new();
    folder.write("empty.csv", "x,y,z\n");
    folder.write("far.csv", scan(|_, _| Some(30.0)));
    let empty = folder.json("empty.csv", &["--out", "pictures"]);
    assert_eq!(empty["status"], "stopped");
    assert_eq!(empty["reason"], "the scan has no returns");
    let output = folder.perceive("far.csv", &["--json"]);
    let said = "no return within 7 m, the nearest is 30.0 m away: are the points in millimetres, or in another \
                frame than the sensor's?";
    assert_eq!(String::from_utf8(output.stderr).unwrap(), format!("warning: far.csv: {said}\n"));
    let far: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(far["warnings"][0], said);
    assert_eq!((far["status"].as_str(), far["occupied_cells"].as_u64()), (Some("searching"), Some(0)));
    for result in [&empty, &far] {
        let profile = result["profile"].as_array().unwrap();
        assert!(profile.len() == 360 && profile.iter().all(|column| column["kind"] == "unknown"));
        assert!(result["chosen"].is_null());
    }
    let table = String::from_utf8(folder.perceive("empty.csv", &[]).stdout).unwrap();
    assert!(table.contains("stopped: the scan has no returns"), "{table}");
    assert!(fs::read_to_string(folder.path("pictures/variance_image.svg")).unwrap().ends_with("</svg>\n"));
}

#[test]
fn the_tables_name_units_segments_and_subgoals() {
    let folder = Folder::new();
    folder.write("yard.csv", walled());
    let text = String::from_utf8(folder.perceive("yard.csv", &["--planner", "paper"]).stdout).unwrap();
    for needle in [
        "yard.csv, planner paper\ndriving to the subgoal at ",
        "within 7 m",
        "columns of 1°",
        "width m",
        "wall",
        "azimuth °",
        "steepness",
        "chosen",
    ] {
        assert!(text.contains(needle), "not in the tables: {needle}\n{text}");
    }
}

#[test]
fn out_draws_segments_subgoals_and_the_three_surfaces() {
    let folder = Folder::new();
    folder.write("a&b.csv", walled());
    let result = folder.json("a&b.csv", &["--out", "new/pictures"]);
    let file = |name: &str| fs::read_to_string(folder.path("new/pictures").join(name)).unwrap();
    let image = file("variance_image.svg");
    assert!(image.starts_with("<svg ") && image.ends_with("</svg>\n"));
    assert!(image.contains("a&amp;b.csv, planner default"));
    let candidates =
        result["subgoals"].as_array().unwrap().iter().filter(|subgoal| subgoal["refusal"].is_null()).count();
    // One more in the legend.
    assert_eq!(image.matches(r#"r="6""#).count(), candidates + 1);
    assert_eq!(image.matches("<image").count(), 1);
    assert_eq!(file("occupancy_surface.svg").matches("<image").count(), 3);
}

#[test]
fn what_cannot_be_read_is_refused_by_file_and_place() {
    let folder = Folder::new();
    folder.refuses("none.csv", &[], "none.csv: cannot be read: ");
    folder.refuses(".", &[], ".: extension \"\": expected .pcap, .pcapng, .pcd");
    folder.write("empty.pcd", "");
    folder.refuses("empty.pcd", &[], "empty.pcd: cannot be read: the file is empty");
    folder.write("bad.csv", "x,y,z\n1,2,3\n1,high,3\n");
    folder.refuses("bad.csv", &[], "bad.csv: line 3, column 2 (y) = high: expected a number of metres");
    folder.write("cut.bin", [0; 30]);
    folder.refuses("cut.bin", &[], "cut.bin: length in bytes = 30: expected a multiple of 16");
    folder.write("survey.las", "LASF");
    folder.refuses("survey.las", &[], "survey.las: extension \"las\": expected ");
    folder.write("bad.pcap", [7; 100]);
    folder.refuses("bad.pcap", &[], "bad.pcap: not a valid pcap file: ");
    folder.write("good.csv", "1 2 3\n");
    folder.refuses("good.csv", &["--revolution", "1"], "good.csv: revolution = 1: expected 0");
    folder.refuses("good.csv", &["--revolution", "-1"], "unexpected argument");
    folder.refuses("good.csv", &["--planner", "best"], "invalid value 'best'");
    folder.refuses("good.csv", &["--out", "good.csv/below"], "--out: good.csv/below: ");
}

/// 116 packets of a VLP-16 on level ground, from each of the addresses in turn.
fn capture(addresses: &[[u8; 4]]) -> Vec<u8> {
    let mut writer = pcap_file::pcap::PcapWriter::new(Vec::new()).unwrap();
    for number in 0..116_u32 {
        let mut packet = Vec::new();
        for block in 0..12 {
            let azimuth = (480 * number + 40 * block) % 36_000;
            packet.extend([0xff, 0xee]);
            packet.extend((azimuth as u16).to_le_bytes());
            for laser in (0..16).chain(0..16) {
                // The even lasers look down from -15°, in steps of 2°; units are 2 mm.
                let elevation = (-15.0 + f64::from(laser)).to_radians();
                let down = laser % 2 == 0 && laser < 14;
                let distance = if down { 0.8 / -libm::sin(elevation) / 0.002 } else { 0.0 };
                packet.extend((distance as u16).to_le_bytes());
                packet.push(9);
            }
        }
        packet.extend((1327 * number).to_le_bytes());
        packet.extend([0x37, 0x22]);
        for address in addresses {
            let mut frame = Vec::new();
            let builder = etherparse::PacketBuilder::ethernet2([1; 6], [2; 6]).ipv4(*address, [255; 4], 64);
            builder.udp(2368, 2368).write(&mut frame, &packet).unwrap();
            let packet = pcap_file::pcap::PcapPacket::new(Duration::ZERO, frame.len() as u32, &frame);
            writer.write_packet(&packet).unwrap();
        }
    }
    writer.into_writer()
}

#[test]
fn what_a_reader_leaves_out_is_told_on_stderr_and_in_json() {
    let folder = Folder::new();
    let whole = capture(&[[10, 0, 0, 7]]);
    folder.write("whole.pcap", &whole);
    folder.write("cut.pcap", &whole[..whole.len() - 1]);
    let expected = folder.json("whole.pcap", &[]);
    assert_eq!((&expected["warnings"], &expected["returns"]), (&json!([]), &json!(1800 * 7)));
    let output = folder.perceive("cut.pcap", &["--json"]);
    let mut result: Value = serde_json::from_slice(&output.stdout).unwrap();
    let warning = "the capture ends inside packet 116; what comes before is read";
    assert_eq!(result["warnings"], json!([warning]));
    assert_eq!(String::from_utf8_lossy(&output.stderr), format!("warning: cut.pcap: {warning}\n"));
    result["warnings"] = json!([]);
    assert_eq!(result, expected);
    let table = folder.perceive("cut.pcap", &[]);
    assert_eq!(String::from_utf8_lossy(&table.stderr), format!("warning: cut.pcap: {warning}\n"));
    assert!(String::from_utf8_lossy(&table.stdout).starts_with("cut.pcap, revolution 0, planner default\n"));
}

#[test]
fn source_chooses_one_of_several_sensors() {
    let folder = Folder::new();
    folder.write("one.pcap", capture(&[[10, 0, 0, 7]]));
    folder.write("two.pcap", capture(&[[10, 0, 0, 7], [10, 0, 0, 8]]));
    let both = "10.0.0.7:2368 (VLP-16, 116 packets), 10.0.0.8:2368 (VLP-16, 116 packets)";
    let named =
        |source: &str| format!("two.pcap: source = {source}: expected one of the capture's sensors: {both}");
    folder.refuses("two.pcap", &[], &named("none"));
    folder.refuses("two.pcap", &["--source", "10.0.0.9"], &named("10.0.0.9"));
    folder.refuses("two.pcap", &["--source", "sensor"], "invalid value 'sensor' for '--source <ADDRESS>'");
    let output = folder.perceive("two.pcap", &["--json", "--source", "10.0.0.8:2368"]);
    let result: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(result["profile"], folder.json("one.pcap", &[])["profile"]);
    assert_eq!(result["warnings"], json!(["116 data packets left out: from 10.0.0.7:2368, product 0x22"]));
}

#[test]
#[ignore = "reads the data that MAPLESS_DATA names"]
fn real_captures_go_through_perception_on_every_revolution() {
    let captures = Path::new(&std::env::var_os("MAPLESS_DATA").unwrap()).join("data/vlp16");
    for (name, whole) in [("vlp16_gps_bsd3.pcap", 3), ("vlp16_single_apache2.pcap", 10)] {
        for (revolution, preset) in (0..whole).flat_map(|k: usize| [(k, "default"), (k, "paper")]) {
            let options = ["--json", "--revolution", &revolution.to_string(), "--planner", preset];
            let output = perceive(&captures, name, &options);
            assert_eq!(output.status.code(), Some(0), "{name}, {revolution}, {preset}: {output:?}");
            let result: Value = serde_json::from_slice(&output.stdout).unwrap();
            assert_sound(&result);
            assert!(result["reason"].is_null() && result["returns"].as_u64().unwrap() > 10_000);
        }
        let beyond = perceive(&captures, name, &["--revolution", &whole.to_string()]);
        let message = String::from_utf8_lossy(&beyond.stderr);
        let expected = format!("expected 0 to {}: the capture has {whole} whole revolutions", whole - 1);
        assert!(beyond.status.code() == Some(1) && message.contains(&expected), "{message}");
    }
}
