//! No crate has a circle of modules: see [`circles::circles`] for the rule.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod circles;
mod source;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use circles::circles;

/// The root file of every library, program, test and example of the workspace.
fn roots() -> Vec<PathBuf> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--no-deps", "--format-version", "1"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let packages = metadata["packages"].as_array().unwrap();
    let targets = packages.iter().flat_map(|package| package["targets"].as_array().unwrap());
    targets.map(|target| PathBuf::from(target["src_path"].as_str().unwrap())).collect()
}

#[test]
fn no_crate_of_the_workspace_has_a_circle() {
    let roots = roots();
    assert!(roots.len() > 20, "{roots:?}");
    let mut found = String::new();
    for root in roots {
        for circle in circles(&root) {
            found += &format!("{}: {circle}", root.display());
        }
    }
    assert!(found.is_empty(), "\n{found}");
}

/// The circles of a crate made of these files, in a folder called `name`.
fn circles_of(name: &str, files: &[(&str, &str)]) -> Vec<String> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("modules").join(name);
    // An earlier run may have left another crate.
    let _ = fs::remove_dir_all(&folder);
    for (file, text) in files {
        let path = folder.join(file);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    circles(&folder.join("lib.rs"))
}

#[test]
fn a_circle_is_named_with_its_files_and_lines() {
    let found = circles_of(
        "plain",
        &[
            ("lib.rs", "mod a;\nmod b;\nmod c;\nmod d;\n"),
            ("a.rs", "use crate::b::Second;\npub struct First(Second);\n"),
            ("b.rs", "\npub struct Second(super::c::Third);\n"),
            ("c.rs", "pub struct Third;\nfn f() {\n    assert!(crate::a::First::is_it());\n}\n"),
            ("d.rs", "use crate::a::First;\n"),
        ],
    );
    let expected = "a circle of a.rs, b.rs, c.rs\n  a.rs:1 uses b.rs: crate::b::Second\n  \
        b.rs:2 uses c.rs: super::c::Third\n  c.rs:3 uses a.rs: crate::a::First::is_it\n";
    assert_eq!(found, [expected]);
}

#[test]
fn rooms_come_back_to_each_other_through_different_files() {
    let found = circles_of(
        "rooms",
        &[
            ("lib.rs", "mod a;\nmod b;\n"),
            ("a/mod.rs", "mod x;\npub mod y;\n"),
            ("a/x.rs", "use crate::b::z::Last;\n"),
            ("a/y.rs", "pub struct Good;\n"),
            ("b.rs", "pub mod z;\nuse crate::a::{self, y};\nfn f() -> y::Good { y::Good }\n"),
            ("b/z.rs", "pub struct Last;\n"),
        ],
    );
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].starts_with("a circle of a/mod.rs, b.rs\n"), "{found:?}");
    assert!(found[0].contains("  a/x.rs:1 uses b/z.rs: crate::b::z::Last\n"), "{found:?}");
    assert!(found[0].contains("  b.rs:2 uses a/y.rs: crate::a::y\n"), "{found:?}");
}

#[test]
fn a_reexport_does_not_hide_a_circle() {
    let found = circles_of(
        "reexport",
        &[
            ("lib.rs", "mod a;\nmod b;\npub use a::First as Renamed;\n"),
            ("a.rs", "pub struct First(crate::b::Second);\n"),
            ("b.rs", "use crate::Renamed;\npub struct Second(Renamed);\n"),
        ],
    );
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains("  b.rs:1 uses a.rs: crate::Renamed\n"), "{found:?}");
}

#[test]
fn what_the_root_defines_makes_a_circle_with_what_the_root_uses() {
    let found = circles_of(
        "root",
        &[
            ("lib.rs", "mod a;\npub struct Ours;\npub fn f() { a::g() }\n"),
            ("a.rs", "pub fn g() -> crate::Ours { crate::Ours }\n"),
        ],
    );
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].starts_with("a circle of lib.rs, a.rs\n"), "{found:?}");
}

#[test]
fn a_module_with_its_submodules_and_tests_are_no_circle() {
    let found = circles_of(
        "family",
        &[
            ("lib.rs", "mod a;\nmod b;\npub use a::First;\n"),
            ("a.rs", "mod x;\npub struct First(x::Part);\n"),
            ("a/x.rs", "use super::First;\npub struct Part;\nimpl From<First> for Part {}\n"),
            (
                "b.rs",
                "use crate::First;\npub struct B(First);\n#[cfg(test)]\nmod tests {\n    use crate::b::B;\n}\n",
            ),
        ],
    );
    assert_eq!(found, Vec::<String>::new());
    let only_in_tests = [
        ("lib.rs", "mod a;\nmod b;\n"),
        ("a.rs", "pub struct A;\n#[cfg(test)]\nmod tests;\n#[cfg(test)]\nuse crate::b::B;\n"),
        ("a/tests.rs", "use crate::b::B;\n"),
        ("b.rs", "use crate::a::A;\npub struct B(A);\n"),
    ];
    assert_eq!(circles_of("tests", &only_in_tests), Vec::<String>::new());
}
