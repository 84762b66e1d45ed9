//! What GDAL says of a band in its own XML: scale, offset and unit.

use super::place::metres_of;
use super::tags::{self, Directory, File};
use crate::Fault;

/// What the first band's numbers mean.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Metadata {
    pub(super) scale: Option<f64>,
    pub(super) offset: Option<f64>,
    /// How long the unit of heights is.
    pub(super) metres: Option<f64>,
}

pub(super) fn read(file: &mut File, image: &Directory) -> Result<Metadata, Fault> {
    let text = file.text(image, tags::GDAL_METADATA)?;
    text.map_or(Ok(Metadata::default()), |text| Metadata::parse(&text))
}

impl Metadata {
    /// Reads the items `<Item name="SCALE" sample="0" role="scale">0.001</Item>` and their like.
    fn parse(xml: &str) -> Result<Self, Fault> {
        let mut found = Self::default();
        for item in xml.split("<Item").skip(1) {
            let Some((attributes, rest)) = item.split_once('>') else { continue };
            let value = rest.split('<').next().unwrap_or_default().trim();
            let attribute = |name: &str| {
                let (_, rest) = attributes.split_once(&format!(" {name}=\""))?;
                rest.split('"').next()
            };
            if attribute("sample").is_some_and(|sample| sample != "0") {
                continue;
            }
            let place = |role: &str| format!("GDAL_METADATA, {role}");
            let number = |role: &str| match value.parse::<f64>() {
                Ok(number) if number.is_finite() && (role == "offset" || number != 0.0) => Ok(Some(number)),
                _ => Err(Fault::value(place(role), value, "a finite number")),
            };
            match attribute("role") {
                Some("scale") => found.scale = number("scale")?,
                Some("offset") => found.offset = number("offset")?,
                Some("unittype") if !value.is_empty() => {
                    let unknown = || Fault::value(place("unittype"), value, "metres or feet");
                    found.metres = Some(metres_of(value).ok_or_else(unknown)?);
                }
                _ => {}
            }
        }
        Ok(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_band_has_scale_offset_and_unit() {
        let xml = "<GDALMetadata>\n  <Item name=\"OFFSET\" sample=\"0\" role=\"offset\">-10</Item>\n  \
            <Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.001</Item>\n  \
            <Item name=\"SCALE\" sample=\"1\" role=\"scale\">7</Item>\n  \
            <Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">ft</Item>\
            <Item name=\"AREA\">x</Item>\n</GDALMetadata>\n";
        let expected = Metadata { scale: Some(0.001), offset: Some(-10.0), metres: Some(0.3048) };
        assert_eq!(Metadata::parse(xml), Ok(expected));
        assert_eq!(Metadata::parse("<GDALMetadata></GDALMetadata>"), Ok(Metadata::default()));
    }

    #[test]
    fn what_makes_no_height_is_refused() {
        for (role, value) in [("scale", "0"), ("scale", "x"), ("offset", "nan"), ("unittype", "dBZ")] {
            let fault = Metadata::parse(&format!("<Item role=\"{role}\">{value}</Item>")).unwrap_err();
            assert!(
                fault.to_string().starts_with(&format!("GDAL_METADATA, {role} = {value}: expected")),
                "{fault}"
            );
        }
    }
}
