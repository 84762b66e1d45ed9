//! The toml crate is the measure: the same values, and the same messages.

use std::collections::BTreeMap;
use std::fmt::Debug;

use proptest::prelude::*;
use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::{Located, Rename, from_str, from_str_renamed};

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Document {
    name: String,
    seed: u64,
    shift: Option<i32>,
    #[serde(default)]
    flat: bool,
    #[serde(default)]
    tilt: [f64; 2],
    mode: Option<Mode>,
    #[serde(default)]
    hill: Vec<Hill>,
    height: Option<OneOrMany>,
    rest: Option<BTreeMap<String, f64>>,
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
enum Mode {
    Once,
    EveryScan,
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Hill {
    height_m: f64,
    #[serde(default)]
    radius_m: f64,
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(untagged)]
enum OneOrMany {
    One(f64),
    Many(Vec<f64>),
}

/// What the toml crate makes of a text, its message without the last line's end.
fn theirs<T: DeserializeOwned>(text: &str) -> Result<T, String> {
    toml::from_str(text).map_err(|error| error.to_string().trim_end().to_owned())
}

fn ours<T: DeserializeOwned>(text: &str) -> Result<T, String> {
    from_str(text).map_err(|error| error.to_string())
}

#[track_caller]
fn same<T: DeserializeOwned + Debug + PartialEq>(text: &str) {
    assert_eq!(ours::<T>(text), theirs::<T>(text), "{text}");
}

const GOOD: &str = "name = \"ü\"\nseed = 0x_1f\nshift = -3\nflat = true\ntilt = [1, 2.5e-3]\nmode = \"every_scan\"\n\
    height = [1, 2.0]\n[[hill]]\nheight_m = 3\n[[hill]]\nheight_m = inf\nradius_m = 0.1\n[rest]\na.b = 1\n";

#[test]
fn a_document_reads_as_with_the_toml_crate() {
    same::<Document>(&GOOD.replace("a.b", "\"a.b\""));
    same::<toml::Table>(GOOD);
}

#[test]
fn messages_are_those_of_the_toml_crate() {
    let change = |from: &str, to: &str| {
        assert!(GOOD.contains(from), "{from}");
        same::<Document>(&GOOD.replace("a.b", "a").replace(from, to));
    };
    change("seed = 0x_1f", "seed = 1.5");
    change("seed = 0x1f".replace("0x", "0x_").as_str(), "seed = -1");
    change("shift = -3", "shift = 3000000000");
    change("flat = true", "flat = \"ja\"");
    change("radius_m = 0.1", "radius = 0.1");
    change("tilt = [1, 2.5e-3]", "tilt = [1]");
    change("tilt = [1, 2.5e-3]", "tilt = [1, \"ü\"]");
    change("mode = \"every_scan\"", "mode = \"never\"");
    change("height = [1, 2.0]", "height = false");
    change("name = \"ü\"", "");
    change("name = \"ü\"", "name = \"ü");
    change("flat = true", "seed = 2");
    change("a.b = 1", "a = \"x\"");
    change("[[hill]]\nheight_m = 3\n", "[[hill]]\nradius_m = 3\n");
}

#[test]
fn a_struct_is_a_table() {
    let text = "name = \"a\"\nseed = 1\nhill = [[1.0, 2.0]]\n";
    let error = ours::<Document>(text).unwrap_err();
    assert!(error.contains("line 3, column 9") && error.contains("expected struct Hill"), "{error}");
}

#[test]
fn a_located_table_knows_its_header() {
    #[derive(Deserialize)]
    struct Hills {
        hill: Vec<Located<Hill>>,
    }
    let text = "[[hill]]\nheight_m = 1\n\n[[hill]]\nheight_m = 2\n";
    let hills = from_str::<Hills>(text).unwrap().hill;
    let found: Vec<_> = hills.iter().map(|hill| (hill.begin, hill.value.height_m)).collect();
    assert_eq!(found, [(0, 1.0), (23, 2.0)]);
}

/// The toml crate's words for an integer that it cannot read, whatever the reason; ours give the reason.
const OVERFLOWED: &str = "integer number overflowed";

#[test]
fn an_integer_that_cannot_be_read_is_told_with_its_reason() {
    for (seed, reason) in [
        ("0x#1f", "integer: expected digits"),
        ("99999999999999999999999999999999999999999", "99: expected one of 64 bits"),
    ] {
        let text = GOOD.replace("0x_1f", seed);
        let (ours, theirs) =
            (ours::<toml::Table>(&text).unwrap_err(), theirs::<toml::Table>(&text).unwrap_err());
        assert!(theirs.ends_with(OVERFLOWED) && ours.ends_with(reason), "{theirs} {ours}");
        assert!(ours.contains("line 2, column 8"), "{ours}");
    }
}

/// A message without the line that underlines its place: the toml crate counts bytes there, we characters.
fn without_carets(message: String) -> String {
    message.lines().filter(|line| !line.ends_with('^')).collect::<Vec<_>>().join("\n")
}

proptest! {
    /// A byte of a good document changed, left out or doubled: the same value or the same fault as with the
    /// toml crate.
    #[test]
    fn damaged_documents_are_judged_alike(at in 0..GOOD.len(), byte in 0x09..0x7f_u8, how in 0..3) {
        let mut bytes = GOOD.as_bytes().to_vec();
        match how {
            0 => bytes[at] = byte,
            1 => { bytes.remove(at); }
            _ => bytes.insert(at, byte),
        }
        if let Ok(text) = String::from_utf8(bytes) {
            let (ours_read, theirs_read) = (ours::<toml::Table>(&text), theirs::<toml::Table>(&text));
            if !matches!(&theirs_read, Err(words) if words.ends_with(OVERFLOWED)) {
                prop_assert_eq!(ours_read.map_err(without_carets), theirs_read.map_err(without_carets));
            }
            prop_assert_eq!(ours::<Document>(&text).is_ok(), theirs::<Document>(&text).is_ok(), "{}", text);
        }
    }
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Renamed {
    deep: BTreeMap<String, Inner>,
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
#[derive(Default)]
struct Inner {
    wait_s: f64,
    size_m: f64,
}

const RENAMES: &[Rename] = &[
    Rename { divisor: Some(10.0), ..Rename::new("deep.old.wait_ticks", "deep.new.wait_s") },
    Rename::new("size_m", "deep.new.size_m"),
    Rename::new("deep.old", "deep.new"),
];

fn renamed(text: &str) -> Result<Inner, String> {
    let read: Result<Renamed, _> = from_str_renamed(text, RENAMES);
    read.map(|mut read| read.deep.remove("new").unwrap()).map_err(|error| error.to_string())
}

#[test]
fn old_keys_give_the_values_of_the_new_ones() {
    let expected = Ok(Inner { wait_s: 0.3, size_m: 2.0 });
    for text in [
        "[deep.new]\nwait_s = 0.3\nsize_m = 2",
        "[deep.old]\nwait_ticks = 3\nsize_m = 2",
        "deep.old = { wait_ticks = 3.0 }\nsize_m = 2",
        "size_m = 2\ndeep.old.wait_ticks = 3",
        "[deep.old]\nwait_ticks = 3\n[deep.new]\nsize_m = 2",
    ] {
        assert_eq!(renamed(text), expected, "{text}");
    }
}

#[test]
fn what_is_wrong_with_an_old_key_is_named_where_it_stands() {
    for (text, needles) in [
        (
            "[deep.new]\nwait_s = 1\n[deep.old]\nwait_ticks = 3",
            ["line 4, column 1", "`deep.old.wait_ticks` is now `deep.new.wait_s`, and both are given"],
        ),
        (
            "[deep.old]\nsize_m = 3\n[deep.new]\nsize_m = 3",
            ["line 2, column 1", "`deep.old.size_m` is now `deep.new.size_m`, and both are given"],
        ),
        ("[deep.old]\nwait_ticks = true", ["line 2, column 14", "invalid type: boolean"]),
        (
            "[deep.old]\nheight_m = 3",
            ["line 2, column 1", "unknown field `height_m`, expected `wait_s` or `size_m`"],
        ),
    ] {
        let error = renamed(text).unwrap_err();
        for needle in needles {
            assert!(error.contains(needle), "not in the message: {needle}\n{error}");
        }
    }
}
