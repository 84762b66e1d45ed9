//! No comment is wider than rustfmt's `max_width`, which rustfmt itself leaves as it is.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::{Path, PathBuf};

/// `max_width` of `rustfmt.toml`.
const MAX_WIDTH: usize = 110;

/// Adds the Rust files below a folder, without those that a build has written.
fn add_rust_files(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && !path.ends_with("target") && !path.ends_with("node_modules") {
            add_rust_files(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
}

/// Whether a line is too wide because of a comment: one of its own, or one behind code. Slashes within
/// quotation marks are no comment, and neither is a wide string.
fn has_wide_comment(line: &str) -> bool {
    let is_in_code = |at: usize| line[..at].matches('"').count().is_multiple_of(2);
    line.chars().count() > MAX_WIDTH
        && (line.trim_start().starts_with("//") || line.match_indices(" // ").any(|(at, _)| is_in_code(at)))
}

/// `FILE:LINE` of every wide comment in a file.
fn wide_comments(file: &str, text: &str) -> Vec<String> {
    let numbered = (1..).zip(text.lines()).filter(|(_, line)| has_wide_comment(line));
    numbered.map(|(number, _)| format!("{file}:{number}")).collect()
}

#[test]
fn no_comment_of_the_repository_is_wide() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let width = format!("max_width = {MAX_WIDTH}\n");
    assert!(fs::read_to_string(root.join("rustfmt.toml")).unwrap().contains(&width), "another width");
    let mut files = Vec::new();
    for folder in ["crate", "tests"] {
        add_rust_files(&root.join(folder), &mut files);
    }
    assert!(files.len() > 200, "{files:?}");
    files.sort();
    let found: Vec<String> = (files.iter())
        .flat_map(|file| {
            let name = file.strip_prefix(&root).unwrap().display().to_string();
            wide_comments(&name, &fs::read_to_string(file).unwrap())
        })
        .collect();
    assert!(found.is_empty(), "comments of more than {MAX_WIDTH} columns:\n{}", found.join("\n"));
}

#[test]
fn a_wide_comment_is_named_with_its_line_and_a_wide_string_is_not() {
    let letters = "ä".repeat(MAX_WIDTH - 3);
    let text = [
        format!("// {letters}"),
        format!("    /// {letters}"),
        format!("let a = 1; // {letters}"),
        format!("let a = \"{letters}\";"),
        format!("let a = \"http://a // {letters}\";"),
    ];
    assert_eq!(wide_comments("a.rs", &text.join("\n")), ["a.rs:2", "a.rs:3"]);
}
