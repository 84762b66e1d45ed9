//! Keys that had another name or place before.

use std::borrow::Cow;
use std::cell::OnceCell;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::Error;

type Table<'a> = DeTable<'a>;
type Key<'a> = Spanned<Cow<'a, str>>;
type Item<'a> = Spanned<DeValue<'a>>;

/// A key, or a table with all that is in it, that had another path before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rename {
    /// The dotted path it had.
    pub old: &'static str,
    /// The dotted path it has.
    pub new: &'static str,
    /// What its number is divided by, where the unit changed too.
    pub divisor: Option<f64>,
}

impl Rename {
    /// Another path for the same value.
    #[must_use]
    pub const fn new(old: &'static str, new: &'static str) -> Self {
        Self { old, new, divisor: None }
    }

    /// The number in its new unit, as TOML.
    #[must_use]
    pub fn scaled(&self, number: f64) -> Option<String> {
        self.divisor.map(|divisor| format!("{:?}", number / divisor))
    }
}

/// Moves what stands at an old path to its new one. The places in the text go with it, so that messages name the line as it
/// stands. `scaled` holds one cell for each of `renames`: the texts of numbers in another unit.
pub(crate) fn apply<'a>(
    table: &mut Table<'a>,
    renames: &[Rename],
    scaled: &'a [OnceCell<String>],
) -> Result<(), Error> {
    for (rename, scaled) in renames.iter().zip(scaled) {
        let Some((key, mut item)) = take(table, rename.old) else { continue };
        if let Some(number) = number(&item).and_then(|number| rename.scaled(number)) {
            let text = scaled.get_or_init(|| number);
            item = Spanned::new(item.span(), DeValue::parse(text)?.into_inner());
        }
        put(table, rename, rename.new, &key, item)?;
    }
    Ok(())
}

fn number(item: &Item<'_>) -> Option<f64> {
    match item.get_ref() {
        DeValue::Integer(number) => number.as_str().parse().ok(),
        DeValue::Float(number) => number.as_str().parse().ok(),
        _ => None,
    }
}

/// Removes what stands at `path`.
fn take<'a>(table: &mut Table<'a>, path: &str) -> Option<(Key<'a>, Item<'a>)> {
    let Some((first, rest)) = path.split_once('.') else { return table.remove_entry(path) };
    match table.get_mut(first)?.get_mut() {
        DeValue::Table(inner) => take(inner, rest),
        _ => None,
    }
}

/// Puts `item` at `path`; a table joins the one that is there.
fn put<'a>(
    table: &mut Table<'a>,
    rename: &Rename,
    path: &str,
    key: &Key<'a>,
    item: Item<'a>,
) -> Result<(), Error> {
    let (first, rest) = path.split_once('.').map_or((path, None), |(first, rest)| (first, Some(rest)));
    let named = |name: &str| Spanned::new(key.span(), Cow::Owned(name.to_owned()));
    if let Some(rest) = rest {
        if !table.contains_key(first) {
            let empty = Spanned::new(item.span(), DeValue::Table(Table::new()));
            table.insert(named(first), empty);
        }
        return match table.get_mut(first).map(Spanned::get_mut) {
            Some(DeValue::Table(inner)) => put(inner, rename, rest, key, item),
            // The reader says that a table is expected there.
            _ => Ok(()),
        };
    }
    let Some(there) = table.get_mut(first) else {
        table.insert(named(first), item);
        return Ok(());
    };
    match (there.get_mut(), item.into_inner()) {
        (DeValue::Table(there), DeValue::Table(item)) => {
            for (key, value) in item {
                let name = key.get_ref().as_ref();
                if there.contains_key(name) {
                    return Err(both(&[rename.old, ".", name], &[rename.new, ".", name], key.span()));
                }
                there.insert(key, value);
            }
            Ok(())
        }
        _ => Err(both(&[rename.old], &[rename.new], key.span())),
    }
}

fn both(old: &[&str], new: &[&str], span: Range<usize>) -> Error {
    let (old, new) = (old.concat(), new.concat());
    let message = ["`", &old, "` is now `", &new, "`, and both are given: expected one of them"].concat();
    <Error as serde::de::Error>::custom(message).at(span)
}
