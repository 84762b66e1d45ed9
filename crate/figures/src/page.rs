//! What the pictures share: the page, images in it, and the bar that explains colours.

use std::fmt::{self, Write as _};

use base64::Engine as _;
use glam::DVec2;

use crate::FigureError;
use crate::scale::{nice_step, ticks};

/// Colour of lines and words.
pub const INK: &str = "#1c1c1c";

/// Begins a white page of `size` pixels with a title and a line below it, `left` from the edge. The caller
/// ends it with `</svg>`.
pub fn begin(svg: &mut String, size: DVec2, left: f64, title: &str, subtitle: &str) -> fmt::Result {
    let (width, height) = (size.x, size.y);
    writeln!(
        svg,
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0} {height:.0}" width="{width:.0}" height="{height:.0}" font-family="Helvetica, Arial, 'DejaVu Sans', sans-serif" font-size="13" fill="{INK}">"#
    )?;
    writeln!(svg, r##"<rect width="100%" height="100%" fill="#fff"/>"##)?;
    writeln!(
        svg,
        r##"<text x="{left}" y="26" font-size="18" font-weight="bold">{}</text><text x="{left}" y="47" fill="#555">{}</text>"##,
        escape(title),
        escape(subtitle)
    )
}

/// Places a PNG on the page, stretched to `size`.
pub fn embed(svg: &mut String, place: DVec2, size: DVec2, png: &[u8]) -> fmt::Result {
    writeln!(
        svg,
        r#"<image x="{}" y="{}" width="{:.2}" height="{:.2}" preserveAspectRatio="none" href="data:image/png;base64,{}"/>"#,
        place.x,
        place.y,
        size.x,
        size.y,
        base64::engine::general_purpose::STANDARD.encode(png)
    )
}

/// Encodes rows of RGB pixels, the first at the top.
pub fn png(width: u32, height: u32, rgb: &[u8]) -> Result<Vec<u8>, FigureError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header()?.write_image_data(rgb)?;
    Ok(bytes)
}

/// A vertical bar of colours with its ticks at the right.
pub struct ColourBar<'a> {
    /// Of its gradient; unique in the picture.
    pub id: &'a str,
    /// Stands beside it.
    pub label: &'a str,
    /// Its upper left corner.
    pub place: DVec2,
    /// In pixels of the page.
    pub height: f64,
    /// What its lower and its upper end stand for.
    pub range: (f64, f64),
    /// About as many ticks.
    pub ticks: f64,
}

impl ColourBar<'_> {
    const WIDTH: f64 = 16.0;

    /// Draws it; `colour` takes the share of the range, from 0 to 1.
    pub fn draw(&self, svg: &mut String, colour: impl Fn(f64) -> [u8; 3]) -> fmt::Result {
        let Self { id, label, place, height, range: (low, high), .. } = *self;
        let bottom = place.y + height;
        write!(svg, r#"<linearGradient id="{id}" x1="0" y1="1" x2="0" y2="0">"#)?;
        for percent in (0..=100).step_by(5) {
            let stop = css(colour(f64::from(percent) / 100.0));
            write!(svg, r#"<stop offset="{percent}%" stop-color="{stop}"/>"#)?;
        }
        writeln!(svg, "</linearGradient>")?;
        writeln!(
            svg,
            r#"<rect x="{:.1}" y="{}" width="{}" height="{height:.1}" fill="url(#{id})" stroke="{INK}"/>"#,
            place.x,
            place.y,
            Self::WIDTH
        )?;
        writeln!(
            svg,
            r#"<text transform="translate({:.1} {:.1}) rotate(-90)" text-anchor="middle">{label}</text>"#,
            place.x + Self::WIDTH + 50.0,
            (place.y + bottom) / 2.0
        )?;
        if high - low < 0.01 {
            return Ok(());
        }
        for value in ticks(low, high, nice_step((high - low) / self.ticks)) {
            let y = bottom - (value - low) / (high - low) * height;
            writeln!(
                svg,
                r#"<path stroke="{INK}" d="M{:.1} {y:.1}h5"/><text x="{:.1}" y="{:.1}">{value}</text>"#,
                place.x + Self::WIDTH,
                place.x + Self::WIDTH + 9.0,
                y + 4.5
            )?;
        }
        Ok(())
    }
}

/// A colour as SVG writes it.
pub fn css([r, g, b]: [u8; 3]) -> String {
    format!("rgb({r} {g} {b})")
}

/// Text as SVG writes it.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
