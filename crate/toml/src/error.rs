//! Errors in a document, with their place.

use std::fmt::{self, Display};
use std::ops::Range;

/// An error in a document, with its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    message: String,
    /// Bytes of the document.
    span: Option<Range<usize>>,
    place: Option<Place>,
}

/// Begin of a fault: line and column count from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Place {
    line: usize,
    column: usize,
    /// The text of the line.
    text: String,
    /// Number of characters at fault.
    length: usize,
}

impl Error {
    /// The message, without the place.
    pub fn message(&self) -> &str {
        &self.message
    }

    /// The line of the fault, counted from 1, if known.
    pub fn line(&self) -> Option<usize> {
        self.place.as_ref().map(|place| place.line)
    }

    /// Sets the place of the fault, unless it is known.
    pub(crate) fn at(mut self, span: Range<usize>) -> Self {
        self.span.get_or_insert(span);
        self
    }

    /// Finds the line in the document.
    pub(crate) fn within(mut self, text: &str) -> Self {
        let Some(Range { start, end }) = self.span else { return self };
        let Some(before) = text.get(..start) else { return self };
        let begin = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = text[begin..].lines().next().unwrap_or_default();
        let inside = text.get(start..end.min(begin + line.len())).unwrap_or_default();
        self.place = Some(Place {
            line: before.bytes().filter(|&byte| byte == b'\n').count() + 1,
            column: before[begin..].chars().count() + 1,
            text: line.to_owned(),
            length: inside.chars().count().max(1),
        });
        self
    }
}

impl From<toml::de::Error> for Error {
    fn from(error: toml::de::Error) -> Self {
        Self { message: error.message().to_owned(), span: error.span(), place: None }
    }
}

impl serde::de::Error for Error {
    fn custom<T: Display>(message: T) -> Self {
        Self { message: message.to_string(), span: None, place: None }
    }
}

impl Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(Place { line, column, text, length }) = &self.place {
            let number = line.to_string();
            let (gutter, indent, marks) =
                (" ".repeat(number.len()), " ".repeat(column - 1), "^".repeat(*length));
            writeln!(f, "TOML parse error at line {line}, column {column}")?;
            writeln!(f, "{gutter} |")?;
            writeln!(f, "{number} | {text}")?;
            writeln!(f, "{gutter} | {indent}{marks}")?;
        }
        f.write_str(&self.message)
    }
}

impl std::error::Error for Error {}
