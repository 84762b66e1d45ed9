//! A YAML file with the line of every value.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use serde::de::{DeserializeOwned, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::{Number, Value};
use serde_saphyr::Spanned;

/// What is wrong with a file, and where.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}{}: {message}", line.map_or_else(String::new, |line| format!(":{line}")))]
pub struct ConfigFileError {
    /// The file.
    pub file: String,
    /// The line, from 1; `None` for what the file leaves out.
    pub line: Option<u64>,
    /// What is wrong, and what was expected.
    pub message: String,
}

/// The text of a file, and its values with their lines.
pub(super) struct YamlFile<'a> {
    file: String,
    text: &'a str,
    tree: Tree,
}

impl<'a> YamlFile<'a> {
    /// Parses `text`, which stands in `file`.
    pub(super) fn parse(file: &Path, text: &'a str) -> Result<Self, ConfigFileError> {
        let file = file.display().to_string();
        let tree = read(&file, text)?;
        Ok(Self { file, text, tree })
    }

    /// The file as a struct, which refuses unknown keys and values of another type.
    pub(super) fn read<T: DeserializeOwned>(&self) -> Result<T, ConfigFileError> {
        read(&self.file, self.text)
    }

    /// What stands at a path of keys.
    pub(super) fn value(&self, path: &[&str]) -> Option<&Value> {
        self.tree.at(path).map(|tree| &tree.value)
    }

    /// An error about what stands at a path of keys, or about what should stand there.
    pub(super) fn error(&self, path: &[&str], message: impl ToString) -> ConfigFileError {
        // A value that is absent has the line of what should hold it.
        let line = (1..=path.len()).rev().find_map(|keys| self.tree.line(&path[..keys]));
        ConfigFileError { file: self.file.clone(), line, message: message.to_string() }
    }
}

fn read<T: DeserializeOwned>(file: &str, text: &str) -> Result<T, ConfigFileError> {
    serde_saphyr::from_str(text).map_err(|error| {
        let error = error.without_snippet();
        let line = error.location().map(|location| location.line());
        ConfigFileError { file: file.to_owned(), line, message: in_its_line(&error.to_string(), text, line) }
    })
}

/// The message of the YAML library with what the line holds in place of its number.
fn in_its_line(message: &str, text: &str, line: Option<u64>) -> String {
    let message = message.rsplit_once(" at line ").map_or(message, |(message, _)| message);
    let shown = line.and_then(|line| text.lines().nth(usize::try_from(line).ok()?.checked_sub(1)?));
    shown.map_or_else(|| message.to_owned(), |shown| format!("{message} in \"{}\"", shown.trim()))
}

/// A value and, if it is a table, the lines of its entries.
#[derive(Default)]
struct Tree {
    value: Value,
    entries: BTreeMap<String, (u64, Tree)>,
}

impl Tree {
    fn at(&self, path: &[&str]) -> Option<&Self> {
        path.iter().try_fold(self, |tree, &key| tree.entries.get(key).map(|(_, entry)| entry))
    }

    fn line(&self, path: &[&str]) -> Option<u64> {
        let (last, holders) = path.split_last()?;
        self.at(holders)?.entries.get(*last).map(|(line, _)| *line)
    }
}

impl From<Value> for Tree {
    fn from(value: Value) -> Self {
        Self { value, entries: BTreeMap::new() }
    }
}

impl<'de> Deserialize<'de> for Tree {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(TreeVisitor)
    }
}

struct TreeVisitor;

impl<'de> Visitor<'de> for TreeVisitor {
    type Value = Tree;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value")
    }

    fn visit_bool<E>(self, value: bool) -> Result<Tree, E> {
        Ok(Value::Bool(value).into())
    }

    fn visit_i64<E>(self, value: i64) -> Result<Tree, E> {
        Ok(Value::from(value).into())
    }

    fn visit_u64<E>(self, value: u64) -> Result<Tree, E> {
        Ok(Value::from(value).into())
    }

    fn visit_f64<E: serde::de::Error>(self, value: f64) -> Result<Tree, E> {
        let number = Number::from_f64(value).ok_or_else(|| E::custom("a number that is not finite"))?;
        Ok(Value::Number(number).into())
    }

    fn visit_str<E>(self, value: &str) -> Result<Tree, E> {
        Ok(Value::String(value.to_owned()).into())
    }

    fn visit_unit<E>(self) -> Result<Tree, E> {
        Ok(Tree::default())
    }

    fn visit_none<E>(self) -> Result<Tree, E> {
        Ok(Tree::default())
    }

    fn visit_some<D: Deserializer<'de>>(self, deserializer: D) -> Result<Tree, D::Error> {
        Tree::deserialize(deserializer)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut access: A) -> Result<Tree, A::Error> {
        let mut items = Vec::new();
        while let Some(item) = access.next_element::<Tree>()? {
            items.push(item.value);
        }
        Ok(Value::Array(items).into())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut access: A) -> Result<Tree, A::Error> {
        let (mut table, mut entries) = (serde_json::Map::new(), BTreeMap::new());
        while let Some((key, entry)) = access.next_entry::<Spanned<String>, Tree>()? {
            table.insert(key.value.clone(), entry.value.clone());
            entries.insert(key.value, (key.referenced.line(), entry));
        }
        Ok(Tree { value: Value::Object(table), entries })
    }
}
