//! The two declarations. The crate's page describes how they are written.

/// Declares a configuration struct with its parameters: see [the crate](crate).
///
/// The struct has, besides `Default`:
///
/// - `PARAMETERS: &[Parameter]`, what people are told about each parameter, without those of inner tables;
/// - `values(&self)`, their values in the same order;
/// - `validate(&self, place: &str) -> Result<(), ConfigError>`, which checks everything, inner tables
///   included;
/// - `visit(&self, place: &str, see: &mut dyn FnMut(&str, &'static Parameter, Value))`, which shows every
///   parameter with its table and value, inner tables included;
/// - `with_paper_values(self)`, the same with every value that the paper gives.
#[macro_export]
macro_rules! parameters {
    (
        $(#[$meta:meta])*
        pub struct $name:ident {
            $(
                $(#[doc = $text:literal])+
                $field:ident: $type:tt = $default:expr
                $(, paper $paper:expr)?
                $(, unit $unit:literal)?
                $(, range [$low:expr, $high:expr])?
                $(, check $check:expr)?;
            )*
        }
        $(tables {
            $(
                $(#[doc = $table_text:literal])+
                $table:ident: $table_type:ident $(= $table_default:expr)?;
            )*
        })?
        $(relations $relations:ident;)?
    ) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
        pub struct $name {
            $(
                $(#[doc = $text])+
                ///
                $(#[doc = concat!("Unit: ", $unit, ".")])?
                #[doc = concat!("Default: `", stringify!($default), "`.")]
                $(#[doc = concat!("Paper: `", stringify!($paper), "`.")])?
                pub $field: $type,
            )*
            $($(
                $(#[doc = $table_text])+
                pub $table: $table_type,
            )*)?
        }

        impl Default for $name {
            fn default() -> Self {
                Self {
                    $($field: $default,)*
                    $($($table: $crate::__or_default!($($table_default)?),)*)?
                }
            }
        }

        impl $name {
            /// The description of each parameter, in the order of the fields. Those of inner tables are with
            /// these.
            pub const PARAMETERS: &'static [$crate::Parameter] = &[$(
                $crate::Parameter {
                    name: stringify!($field),
                    unit: concat!($($unit)?),
                    kind: $crate::__kind!($type $(, $low, $high)?),
                    check: { #[allow(unused_imports)] use $crate::Check::*; $crate::__check!($($check)?) },
                    text: concat!($($text),+).trim_ascii_start(),
                    paper: $crate::__paper!($type $(, $paper)?),
                },
            )*];

            /// The values of [`Self::PARAMETERS`], in the same order.
            #[must_use]
            #[cold]
            pub fn values(&self) -> [$crate::Value; Self::PARAMETERS.len()] {
                [$($crate::__value!($type, self.$field)),*]
            }

            /// Checks every value; `place` is the table it stands in, for messages.
            ///
            /// # Errors
            /// [`ConfigError`]($crate::ConfigError) with the first value that makes no sense, its place and
            /// what was expected.
            #[cold]
            pub fn validate(&self, place: &str) -> Result<(), $crate::ConfigError> {
                $crate::check_all(place, Self::PARAMETERS, &self.values())?;
                $($(self.$table.validate(&$crate::inside(place, stringify!($table)))?;)*)?
                $(self.$relations(place)?;)?
                Ok(())
            }

            /// Shows every parameter with its table and value, those of inner tables included; `place` is the
            /// table that this stands in.
            #[cold]
            pub fn visit(
                &self,
                place: &str,
                see: &mut dyn FnMut(&str, &'static $crate::Parameter, $crate::Value),
            ) {
                for (parameter, value) in Self::PARAMETERS.iter().zip(self.values()) {
                    see(place, parameter, value);
                }
                $($(self.$table.visit(&$crate::inside(place, stringify!($table)), see);)*)?
            }

            /// The same with every value that the paper gives.
            #[must_use]
            #[allow(unused_mut, reason = "the paper may give none")]
            #[cold]
            pub fn with_paper_values(mut self) -> Self {
                $($(self.$field = $paper;)?)*
                $($(self.$table = self.$table.with_paper_values();)*)?
                self
            }
        }
    };
}

/// Declares an enum whose values people write as words: see [the crate](crate).
#[macro_export]
macro_rules! choices {
    (
        $(#[$meta:meta])*
        pub enum $name:ident {
            $($(#[$variant_meta:meta])* $variant:ident = $word:literal),+ $(,)?
        }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        pub enum $name {
            $(
                $(#[$variant_meta])*
                #[cfg_attr(feature = "serde", serde(rename = $word))]
                $variant,
            )+
        }

        impl $name {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];
            /// Their words, in the same order.
            pub const WORDS: &'static [&'static str] = &[$($word),+];

            /// The word for it in files and on the command line.
            #[must_use]
            pub const fn word(self) -> &'static str {
                match self {
                    $(Self::$variant => $word,)+
                }
            }
        }
    };
}

/// The given value, or the type's own default.
#[doc(hidden)]
#[macro_export]
macro_rules! __or_default {
    () => {
        Default::default()
    };
    ($value:expr) => {
        $value
    };
}

#[doc(hidden)]
#[macro_export]
macro_rules! __check {
    () => {
        ByType
    };
    ($check:expr) => {
        $check
    };
}

/// The [`Kind`](crate::Kind) of a type with its range.
#[doc(hidden)]
#[macro_export]
macro_rules! __kind {
    (f64, $low:expr, $high:expr) => {
        $crate::Kind::Number($low, $high)
    };
    ([f64; 2], $low:expr, $high:expr) => {
        $crate::Kind::Pair($low, $high)
    };
    (bool) => {
        $crate::Kind::Switch
    };
    ($choice:ident) => {
        $crate::Kind::Choice($choice::WORDS)
    };
    ($whole:ident, $low:expr, $high:expr) => {
        $crate::Kind::Whole($low, $high)
    };
}

/// The [`Value`](crate::Value) of a typed one.
#[doc(hidden)]
#[macro_export]
macro_rules! __value {
    (f64, $value:expr) => {
        $crate::Value::Number($value)
    };
    ([f64; 2], $value:expr) => {
        $crate::Value::Pair($value)
    };
    (bool, $value:expr) => {
        $crate::Value::Switch($value)
    };
    (usize, $value:expr) => {
        $crate::Value::Whole($value as u64)
    };
    (u32, $value:expr) => {
        $crate::Value::Whole($value as u64)
    };
    (u64, $value:expr) => {
        $crate::Value::Whole($value)
    };
    ($choice:ident, $value:expr) => {
        $crate::Value::Word($value.word())
    };
}

#[doc(hidden)]
#[macro_export]
macro_rules! __paper {
    ($type:tt) => {
        None
    };
    ($type:tt, $value:expr) => {
        Some($crate::__value!($type, $value))
    };
}
