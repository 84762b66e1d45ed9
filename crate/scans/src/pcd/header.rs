//! The header of a PCD file.

use crate::cloud_warning::CloudWarning;
use crate::error::ScanFault;
use crate::pcd::damaged;
use crate::values::{AXES, Number, shortened};
use crate::viewpoint::Viewpoint;

pub(super) struct Header {
    pub(super) points: usize,
    pub(super) viewpoint: Viewpoint,
    pub(super) layout: Layout,
    pub(super) xyz: [Axis; 3],
    /// Size of a point in bytes.
    pub(super) record_bytes: usize,
    /// Number of values of a point as text.
    pub(super) values: usize,
    /// Number of lines up to the data.
    pub(super) lines: usize,
}

/// How the points are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Layout {
    Ascii,
    Binary,
    Compressed,
}

/// Where a coordinate stands in a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    pub(super) number: Number,
    /// Bytes before it.
    pub(super) start: usize,
    /// Values before it.
    pub(super) values: usize,
}

struct Field {
    name: String,
    kind: char,
    size: usize,
    count: usize,
}

/// The entries by their names.
#[derive(Default)]
struct Entries(Vec<(String, Vec<String>)>);

impl Header {
    /// The header and the data after it.
    pub(super) fn read<'a>(
        bytes: &'a [u8],
        warnings: &mut Vec<CloudWarning>,
    ) -> Result<(Self, &'a [u8]), ScanFault> {
        let mut entries = Entries::default();
        let mut rest = bytes;
        let mut lines = 0;
        while entries.find("DATA").is_none() {
            if rest.is_empty() {
                return Err(damaged("it has no DATA entry"));
            }
            let end = rest.iter().position(|&byte| byte == b'\n').map_or(rest.len(), |end| end + 1);
            let (line, after) = rest.split_at(end);
            rest = after;
            lines += 1;
            let line = String::from_utf8_lossy(line);
            let mut words = line.split('#').next().unwrap_or_default().split_whitespace().map(str::to_owned);
            if let Some(name) = words.next() {
                entries.0.push((name.to_ascii_uppercase(), words.collect()));
            }
        }
        Ok((Self::new(&entries, lines, warnings)?, rest))
    }

    fn new(entries: &Entries, lines: usize, warnings: &mut Vec<CloudWarning>) -> Result<Self, ScanFault> {
        let fields = entries.fields()?;
        let (mut found, mut record_bytes, mut values) = ([None; 3], Some(0_usize), 0_usize);
        for field in &fields {
            let axis = AXES.iter().position(|axis| field.name.eq_ignore_ascii_case(axis));
            if let (Some(axis), Some(start)) = (axis, record_bytes) {
                found[axis] = found[axis].or(Some(Axis { number: field.number()?, start, values }));
            }
            let bytes = field.size.checked_mul(field.count);
            record_bytes = record_bytes.and_then(|sum| sum.checked_add(bytes?));
            values = values.saturating_add(field.count);
        }
        let record_bytes =
            record_bytes.ok_or_else(|| damaged("its SIZE and COUNT make a point too large to read"))?;
        let [Some(x), Some(y), Some(z)] = found else {
            let names: Vec<&str> = fields.iter().map(|field| field.name.as_str()).collect();
            return Err(ScanFault::value("FIELDS", shortened(&names.join(" ")), "x, y and z among them"));
        };
        let viewpoint = match entries.find("VIEWPOINT") {
            Some(_) => Viewpoint::new(&entries.numbers("VIEWPOINT")?, warnings)?,
            None => Viewpoint::NONE,
        };
        let points = entries.points(warnings)?;
        Ok(Self { points, viewpoint, layout: entries.layout()?, xyz: [x, y, z], record_bytes, values, lines })
    }
}

impl Entries {
    fn find(&self, name: &str) -> Option<&[String]> {
        self.0.iter().rev().find_map(|(found, values)| (found == name).then_some(values.as_slice()))
    }

    fn numbers<T: core::str::FromStr>(&self, name: &str) -> Result<Vec<T>, ScanFault> {
        let values = self.find(name).unwrap_or_default().iter();
        values
            .map(|value| value.parse().map_err(|_| ScanFault::value(name, shortened(value), "numbers")))
            .collect()
    }

    fn fields(&self) -> Result<Vec<Field>, ScanFault> {
        let names = self.find("FIELDS").or_else(|| self.find("COLUMNS")).unwrap_or_default();
        let sizes = self.numbers("SIZE")?;
        let kinds = self.find("TYPE").unwrap_or_default();
        let counts = match self.find("COUNT") {
            Some(_) => self.numbers("COUNT")?,
            None => vec![1; names.len()],
        };
        for (entry, found) in [("SIZE", sizes.len()), ("TYPE", kinds.len()), ("COUNT", counts.len())] {
            if found != names.len() {
                let expected = format!("{}, one for each of the FIELDS", names.len());
                return Err(ScanFault::value(format!("number of values of {entry}"), found, expected));
            }
        }
        let fields = names.iter().zip(kinds).zip(sizes.into_iter().zip(counts));
        Ok(fields
            .map(|((name, kind), (size, count))| Field {
                name: name.clone(),
                kind: kind.chars().next().unwrap_or_default().to_ascii_uppercase(),
                size,
                count,
            })
            .collect())
    }

    /// The number of points.
    fn points(&self, warnings: &mut Vec<CloudWarning>) -> Result<usize, ScanFault> {
        let number = |name: &str| Ok(self.numbers::<usize>(name)?.first().copied());
        let (points, width, height) = (number("POINTS")?, number("WIDTH")?, number("HEIGHT")?);
        let product = width.and_then(|width| width.checked_mul(height.unwrap_or(1)));
        match (points, product) {
            (Some(points), Some(product)) if points != product => {
                let place = "WIDTH × HEIGHT".to_owned();
                warnings.push(CloudWarning::Count { place, said: product, read: points });
            }
            _ => {}
        }
        points.or(product).ok_or_else(|| damaged("it has neither POINTS nor WIDTH"))
    }

    fn layout(&self) -> Result<Layout, ScanFault> {
        let value = self.find("DATA").unwrap_or_default().join(" ");
        match value.to_ascii_lowercase().as_str() {
            "ascii" => Ok(Layout::Ascii),
            "binary" => Ok(Layout::Binary),
            "binary_compressed" => Ok(Layout::Compressed),
            _ => Err(ScanFault::value("DATA", shortened(&value), "ascii, binary or binary_compressed")),
        }
    }
}

impl Field {
    /// The type of a coordinate.
    fn number(&self) -> Result<Number, ScanFault> {
        let number = match (self.kind, self.size) {
            ('I', 1) => Number::I8,
            ('U', 1) => Number::U8,
            ('I', 2) => Number::I16,
            ('U', 2) => Number::U16,
            ('I', 4) => Number::I32,
            ('U', 4) => Number::U32,
            ('I', 8) => Number::I64,
            ('U', 8) => Number::U64,
            ('F', 4) => Number::F32,
            ('F', 8) => Number::F64,
            _ => return Err(self.refused("a number of type I or U, or of type F and 4 or 8 bytes")),
        };
        if self.count == 1 { Ok(number) } else { Err(self.refused("one number")) }
    }

    fn refused(&self, expected: &str) -> ScanFault {
        let Self { name, kind, size, count } = self;
        ScanFault::value(format!("field {name}"), format!("{kind} of {size} bytes × {count}"), expected)
    }
}
