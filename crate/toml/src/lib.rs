//! Reads TOML into structs.
//!
//! The `toml` crate parses the text. Its own way from there into structs lets every struct be written as a
//! list, a string or a date too, and compiles all of that once for each struct: a third of the page's wasm.
//! Here a struct is a table. Messages are those of the `toml` crate, with line, column and the line itself.
//!
//! ```
//! #[derive(serde::Deserialize)]
//! #[serde(deny_unknown_fields)]
//! struct Hill {
//!     height_m: f64,
//! }
//! let hill: Hill = mapless_toml::from_str("height_m = 3").unwrap();
//! assert_eq!(hill.height_m, 3.0);
//! let error = mapless_toml::from_str::<Hill>("height = 3").err().unwrap().to_string();
//! assert!(error.starts_with("TOML parse error at line 1, column 1") && error.contains("unknown field `height`"));
//! ```

mod error;
mod located;
mod rename;
mod value;

#[cfg(test)]
mod tests;

pub use error::Error;
pub use located::Located;
pub use rename::Rename;

use std::cell::OnceCell;

use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::DeTable;

/// Reads a whole document.
///
/// # Errors
/// What is wrong and where: not TOML, a wrong key, a missing one, or a value of the wrong kind.
pub fn from_str<T: DeserializeOwned>(text: &str) -> Result<T, Error> {
    from_str_renamed(text, &[])
}

/// As [`from_str`], with keys that had other names before: see [`Rename`].
///
/// # Errors
/// As [`from_str`]; a value that is given under both its names.
pub fn from_str_renamed<T: DeserializeOwned>(text: &str, renames: &[Rename]) -> Result<T, Error> {
    let scaled: Vec<OnceCell<String>> = renames.iter().map(|_| OnceCell::new()).collect();
    let table = renamed(text, renames, &scaled);
    table.and_then(|table| value::read(&table)).map_err(|error| error.within(text))
}

fn renamed<'a>(
    text: &'a str,
    renames: &[Rename],
    scaled: &'a [OnceCell<String>],
) -> Result<Spanned<DeTable<'a>>, Error> {
    let mut table = DeTable::parse(text)?;
    rename::apply(table.get_mut(), renames, scaled)?;
    Ok(table)
}
