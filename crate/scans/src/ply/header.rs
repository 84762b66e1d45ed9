//! The header of a PLY file.

use crate::error::ScanFault;
use crate::ply::damaged;
use crate::values::{Number, shortened};

pub(super) struct Header {
    pub(super) layout: Layout,
    pub(super) elements: Vec<Element>,
    /// Number of lines up to the data.
    pub(super) lines: usize,
}

/// How the elements are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Layout {
    Ascii,
    Binary { big_endian: bool },
}

pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: usize,
    pub(super) properties: Vec<Property>,
}

pub(super) struct Property {
    pub(super) name: String,
    pub(super) number: Number,
    /// Type of the number of values if it is a list.
    pub(super) list: Option<Number>,
}

impl Header {
    /// The header and the data after it.
    pub(super) fn read(bytes: &[u8]) -> Result<(Self, &[u8]), ScanFault> {
        let mut header = Self { layout: Layout::Ascii, elements: Vec::new(), lines: 0 };
        let (mut rest, mut layout) = (bytes, None);
        loop {
            if rest.is_empty() {
                return Err(damaged("it ends before end_header"));
            }
            let line = line(&mut rest);
            header.lines += 1;
            let words: Vec<&str> = line.split_whitespace().collect();
            if header.lines == 1 && words != ["ply"] {
                return Err(ScanFault::value("line 1", shortened(&line), "ply"));
            }
            match words[..] {
                ["end_header"] => break,
                ["format", format, _] => layout = layout.or(Layout::named(format)),
                ["element", name, count] if count.parse::<usize>().is_ok() => {
                    let (name, count) = (name.to_owned(), count.parse().unwrap_or(0));
                    header.elements.push(Element { name, count, properties: Vec::new() });
                }
                ["property", ..] => {
                    let property = Property::read(&words[1..]);
                    let (Some(property), Some(element)) = (property, header.elements.last_mut()) else {
                        return Err(header.refused(&line));
                    };
                    element.properties.push(property);
                }
                [] | ["ply" | "comment" | "obj_info", ..] => {}
                _ => return Err(header.refused(&line)),
            }
        }
        let formats = "one of ascii, binary_little_endian and binary_big_endian";
        header.layout =
            layout.ok_or_else(|| damaged(format!("its header has no known format: expected {formats}")))?;
        Ok((header, rest))
    }

    fn refused(&self, line: &str) -> ScanFault {
        let expected = "an element, a property of it, a comment or end_header";
        ScanFault::value(format!("line {}", self.lines), shortened(line), expected)
    }
}

/// Takes a line from the bytes; it ends as on any system.
fn line(rest: &mut &[u8]) -> String {
    let end = rest.iter().position(|byte| [b'\n', b'\r'].contains(byte)).unwrap_or(rest.len());
    let (line, after) = rest.split_at(end);
    *rest = after.strip_prefix(b"\r\n").or_else(|| after.get(1..)).unwrap_or_default();
    String::from_utf8_lossy(line).into_owned()
}

impl Layout {
    fn named(format: &str) -> Option<Self> {
        match format {
            "ascii" => Some(Self::Ascii),
            "binary_little_endian" => Some(Self::Binary { big_endian: false }),
            "binary_big_endian" => Some(Self::Binary { big_endian: true }),
            _ => None,
        }
    }
}

impl Property {
    /// From the words after `property`.
    fn read(words: &[&str]) -> Option<Self> {
        let (list, words) = match words {
            ["list", count, words @ ..] => (Some(number(count)?), words),
            words => (None, words),
        };
        let [kind, name, ..] = words else { return None };
        Some(Self { name: (*name).to_owned(), number: number(kind)?, list })
    }

    /// Least size in bytes.
    pub(super) fn least_bytes(&self) -> usize {
        self.list.unwrap_or(self.number).size()
    }
}

fn number(name: &str) -> Option<Number> {
    Some(match name {
        "char" | "int8" => Number::I8,
        "uchar" | "uint8" => Number::U8,
        "short" | "int16" => Number::I16,
        "ushort" | "uint16" => Number::U16,
        "int" | "int32" => Number::I32,
        "uint" | "uint32" => Number::U32,
        "int64" | "long" => Number::I64,
        "uint64" | "ulong" => Number::U64,
        "float" | "float32" => Number::F32,
        "double" | "float64" => Number::F64,
        _ => return None,
    })
}
