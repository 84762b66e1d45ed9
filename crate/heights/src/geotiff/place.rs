//! Spacing, units, and which way is up: the tags and keys of GeoTIFF.

use super::tags::{Directory, File, Tag};
use crate::samples::FirstRow;
use crate::spacing::{WAY_OUT, square};
use crate::{Fault, Import};

const MODEL_TYPE: u64 = 1024;
const GEOGRAPHIC_TYPE: u64 = 2048;
const PROJECTED_TYPE: u64 = 3072;
const LINEAR_UNITS: u64 = 3076;
const LINEAR_UNIT_SIZE: u64 = 3077;
const VERTICAL_UNITS: u64 = 4099;
/// The model type for degrees of longitude and latitude.
const GEOGRAPHIC: u64 = 2;
/// A unit that the file defines by its size.
const USER_DEFINED: u64 = 32767;
/// The tag in which a key's numbers with fractions stand.
const DOUBLE_PARAMS: u64 = 34736;

/// Units of length by their EPSG code, their name, and how many metres they are.
const UNITS: [(u64, &str, f64); 8] = [
    (9001, "metre", 1.0),
    (9002, "foot", 0.3048),
    (9003, "US survey foot", 1200.0 / 3937.0),
    (9005, "Clarke's foot", 0.304_797_265_4),
    (9036, "kilometre", 1000.0),
    (9094, "Gold Coast foot", 6_378_300.0 / 20_926_201.0),
    (9095, "British foot of 1936", 0.304_800_749_1),
    (9096, "yard", 0.9144),
];

/// How long a unit is that is given by a name.
pub(super) fn metres_of(name: &str) -> Option<f64> {
    let plain = name.trim().to_ascii_lowercase().replace(['_', '-'], " ");
    match plain.as_str() {
        "m" | "metre" | "metres" | "meter" | "meters" => Some(1.0),
        "ft" | "foot" | "feet" | "international foot" | "international feet" => Some(0.3048),
        "us ft" | "ftus" | "us survey foot" | "us survey feet" | "foot us" | "survey foot" => {
            Some(1200.0 / 3937.0)
        }
        "mm" | "millimetre" | "millimeter" => Some(0.001),
        "cm" | "centimetre" | "centimeter" => Some(0.01),
        "km" | "kilometre" | "kilometer" => Some(1000.0),
        _ => None,
    }
}

pub(super) struct Place {
    pub(super) cell_m: f64,
    pub(super) first_row: FirstRow,
    /// The units of the grid and of heights, where the file says them.
    linear: Option<Unit>,
    vertical: Option<Unit>,
}

#[derive(Clone)]
struct Unit {
    name: String,
    metres: f64,
}

impl Place {
    /// How long the unit of heights is. Without one of their own, they are in the unit of the grid.
    pub(super) fn metres_of_heights(&self, warnings: &mut Vec<String>) -> f64 {
        let (unit, why) = match (&self.vertical, &self.linear) {
            (Some(unit), _) => (unit, "VerticalUnits"),
            (None, Some(unit)) => (unit, "the unit of the grid, as the file has no VerticalUnits"),
            (None, None) => return 1.0,
        };
        if !unit.is_metre() {
            let Unit { name, metres } = unit;
            warnings
                .push(format!("heights are in units of {metres:.7} m ({name}; {why}): converted to metres"));
        }
        unit.metres
    }
}

impl Unit {
    fn is_metre(&self) -> bool {
        (self.metres - 1.0).abs() < 1e-12
    }
}

/// The numbers of the `GeoKeyDirectory`.
struct Keys {
    /// Key, the tag that holds its value, how many values there are, and the value or its index.
    entries: Vec<[u64; 4]>,
    doubles: Vec<f64>,
}

impl Keys {
    fn read(file: &mut File, image: &Directory) -> Result<Self, Fault> {
        let numbers = file.numbers(image, Tag::GeoKeyDirectoryTag)?;
        // The first four numbers are the directory's own header.
        let entries = numbers.as_chunks().0.iter().skip(1).copied().collect();
        let doubles = file.doubles(image, Tag::GeoDoubleParamsTag)?.unwrap_or_default();
        Ok(Self { entries, doubles })
    }

    fn entry(&self, key: u64) -> Option<&[u64; 4]> {
        self.entries.iter().find(|entry| entry[0] == key)
    }

    /// A key's whole number.
    fn number(&self, key: u64) -> Option<u64> {
        self.entry(key).filter(|entry| entry[1] == 0).map(|entry| entry[3])
    }

    fn double(&self, key: u64) -> Option<f64> {
        let entry = self.entry(key).filter(|entry| entry[1] == DOUBLE_PARAMS)?;
        self.doubles.get(usize::try_from(entry[3]).ok()?).copied()
    }

    fn is_geographic(&self) -> bool {
        match self.number(MODEL_TYPE) {
            Some(model) => model == GEOGRAPHIC,
            None => self.entry(GEOGRAPHIC_TYPE).is_some() && self.entry(PROJECTED_TYPE).is_none(),
        }
    }

    fn unit(&self, key: u64, name: &str) -> Result<Option<Unit>, Fault> {
        let Some(code) = self.number(key) else { return Ok(None) };
        if code == USER_DEFINED && key == LINEAR_UNITS {
            let size = self.double(LINEAR_UNIT_SIZE).filter(|metres| (1e-6..1e6).contains(metres));
            let Some(metres) = size else {
                let expected = "the length of the file's own unit in metres";
                return Err(Fault::value("ProjLinearUnitSizeGeoKey", "absent", expected));
            };
            return Ok(Some(Unit { name: "the file's own unit".to_owned(), metres }));
        }
        match UNITS.iter().find(|(known, ..)| *known == code) {
            Some((_, name, metres)) => Ok(Some(Unit { name: (*name).to_owned(), metres: *metres })),
            None => Err(Fault::value(name, code, "metres or feet (EPSG 9001 to 9003)")),
        }
    }
}

pub(super) fn read(
    file: &mut File,
    image: &Directory,
    import: &Import,
    warnings: &mut Vec<String>,
) -> Result<Place, Fault> {
    let keys = Keys::read(file, image)?;
    let is_geographic = keys.is_geographic();
    let linear = if is_geographic { None } else { keys.unit(LINEAR_UNITS, "ProjLinearUnitsGeoKey")? };
    let vertical = keys.unit(VERTICAL_UNITS, "VerticalUnitsGeoKey")?;
    let axes = Axes::read(file, image, warnings)?;
    let first_row = axes.as_ref().map_or(FirstRow::North, |axes| axes.first_row);
    let cell_m = match (import.cell_m, axes) {
        (Some(cell_m), _) => cell_m,
        (None, _) if is_geographic => {
            let expected = format!("a projected grid in metres; {WAY_OUT}");
            return Err(Fault::value("GTModelTypeGeoKey", "geographic (degrees)", expected));
        }
        (None, None) => {
            return Err(Fault::value("ModelPixelScale", "absent", format!("the size of a pixel; {WAY_OUT}")));
        }
        (None, Some(axes)) => {
            let unit = linear.clone().unwrap_or(Unit { name: "metre".to_owned(), metres: 1.0 });
            if !unit.is_metre() {
                let Unit { name, metres } = &unit;
                warnings
                    .push(format!("the spacing is in units of {metres:.7} m ({name}): converted to metres"));
            }
            square(axes.tag, axes.east, axes.north, unit.metres)?
        }
    };
    Ok(Place { cell_m, first_row, linear, vertical })
}

/// How pixels lie on the ground.
struct Axes {
    tag: &'static str,
    /// Sides of a pixel, in the file's unit.
    east: f64,
    north: f64,
    first_row: FirstRow,
}

impl Axes {
    fn read(file: &mut File, image: &Directory, warnings: &mut Vec<String>) -> Result<Option<Self>, Fault> {
        if let Some(scale) = file.doubles(image, Tag::ModelPixelScaleTag)? {
            let [east, north, ..] = scale.as_slice() else {
                return Err(Fault::value("ModelPixelScale", format!("{scale:?}"), "two or three numbers"));
            };
            if *north < 0.0 {
                let sign = "ModelPixelScale is negative northwards: the first row is read as the northern \
                            one, as GDAL does";
                warnings.push(sign.to_owned());
            }
            let tag = "ModelPixelScale";
            return Ok(Some(Self { tag, east: *east, north: north.abs(), first_row: FirstRow::North }));
        }
        let Some(matrix) = file.doubles(image, Tag::ModelTransformationTag)? else { return Ok(None) };
        let tag = "ModelTransformation";
        let fault = |expected: &str| Fault::value(tag, format!("{matrix:?}"), expected);
        let &[east, across, _, _, along, north, ..] = matrix.as_slice() else {
            return Err(fault("16 numbers"));
        };
        if across.abs().max(along.abs()) > 1e-6 * east.abs() {
            return Err(fault("rows that run east; gdalwarp turns a grid that is rotated"));
        }
        if east < 0.0 {
            return Err(fault("columns from west to east; gdalwarp turns a grid that is mirrored"));
        }
        let first_row = if north > 0.0 { FirstRow::South } else { FirstRow::North };
        Ok(Some(Self { tag, east, north: north.abs(), first_row }))
    }
}
