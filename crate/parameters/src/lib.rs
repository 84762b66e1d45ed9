//! Configuration structs that are declared once.
//!
//! [`parameters!`] takes one entry for each parameter and makes the struct from it, its defaults, its checks
//! and the description that people read. [`choices!`] does the same for a parameter that is one of a few
//! words.
//!
//! ```
//! mapless_parameters::choices! {
//!     /// What a drive is for.
//!     pub enum Purpose {
//!         /// As soon as possible.
//!         Haste = "haste",
//!         /// As smoothly as possible.
//!         Comfort = "comfort",
//!     }
//! }
//!
//! mapless_parameters::parameters! {
//!     /// How fast to drive.
//!     pub struct Pace {
//!         /// What the drive is for.
//!         purpose: Purpose = Purpose::Haste;
//!         /// Speed limit.
//!         max_speed_m_s: f64 = 1.2, paper 0.8, unit "m/s", range [0.1, 3.0], check Positive;
//!     }
//! }
//!
//! assert_eq!(Pace::PARAMETERS[1].text, "Speed limit.");
//! assert_eq!(Pace::default().with_paper_values().max_speed_m_s, 0.8);
//! let error = Pace { max_speed_m_s: -1.0, ..Pace::default() }.validate("pace").unwrap_err();
//! assert_eq!(error.to_string(), "pace.max_speed_m_s = -1: expected a positive number");
//! ```
//!
//! # An entry
//!
//! ```text
//! /// What it does, in plain words: the field's documentation and the description shown to people.
//! name: type = default, paper value, unit "m", range [0.5, 3.0], check Positive;
//! ```
//!
//! The type is `f64`, `usize`, `u32`, `u64`, `[f64; 2]`, `bool` or an enum of [`choices!`]. After the default
//! every part is optional, in this order:
//!
//! - `paper`: the value that the paper gives, where it gives one.
//! - `unit`: none for shares, counts and choices.
//! - `range`: the values that make sense to people, as for a slider. Numbers and pairs need one.
//! - `check`: what a value must hold to mean anything, one of [`Check`].
//!
//! Structs inside the struct stand in `tables { name: Type; }` behind it; with `= value` where they do not
//! begin with their own defaults. `relations name;` names a method `fn name(&self, place: &str) -> Result<(),
//! ConfigError>` that checks what relates several parameters.
//!
//! With the feature `serde` of the crate that declares the struct, it is read and written by serde, and a key
//! that is no parameter is an error.

mod check;
mod error;
mod macros;
mod parameter;
mod value;

pub use check::Check;
pub use error::ConfigError;
pub use parameter::{Kind, Parameter};
pub use value::Value;

/// Checks the `values` of a struct's `parameters`; `place` is its table.
///
/// # Errors
/// The first value that its check refuses.
pub fn check_all(place: &str, parameters: &[Parameter], values: &[Value]) -> Result<(), ConfigError> {
    for (parameter, &value) in parameters.iter().zip(values) {
        parameter.check.require(place, parameter.name, value)?;
    }
    Ok(())
}

/// The path of the table `name` inside the table `place`.
#[must_use]
pub fn inside(place: &str, name: &str) -> String {
    [place, ".", name].concat()
}
