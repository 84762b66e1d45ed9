//! Shaded relief: elevation as colour, light from the north-west.

use glam::{DVec2, DVec3};
use mapless_world::HeightField;

use crate::{FigureError, page};

/// Slopes are drawn this much steeper, since gentle ones matter to a robot.
const EXAGGERATION: f64 = 1.3;
/// Share of white in the colours, so that path and marks stand out on paper too.
const PALENESS: f64 = 0.5;

/// The relief of the whole field as an RGB PNG of about `size` pixels, north up.
pub(crate) fn png(field: &HeightField, size: DVec2) -> Result<Vec<u8>, FigureError> {
    let pixels = size.round().max(DVec2::ONE);
    let (width, height) = (pixels.x as u32, pixels.y as u32);
    let extent = field.extent_m();
    let pixel_m = extent / pixels;
    let (low, high) = field.height_range_m();
    let (low, range) = (f64::from(low), f64::from(high - low).max(1e-9));
    let light = DVec3::new(-1.0, 1.0, 1.4).normalize();
    // Across a whole cell, so that the patches between coarse samples do not show as facets.
    let reach_m = field.cell_m().max(pixel_m.max_element());
    let height_m = |at: DVec2| field.height_m(at.clamp(DVec2::ZERO, extent)).unwrap_or(low);

    let mut rgb = Vec::with_capacity(3 * width as usize * height as usize);
    for row in (0..height).rev() {
        for column in 0..width {
            let at = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5) * pixel_m;
            let slope = |aside: DVec2| (height_m(at + aside) - height_m(at - aside)) / (2.0 * reach_m);
            let (east, north) = (slope(DVec2::X * reach_m), slope(DVec2::Y * reach_m));
            let normal = DVec3::new(-EXAGGERATION * east, -EXAGGERATION * north, 1.0).normalize();
            // 1 where the ground is level.
            let light = normal.dot(light).max(0.0) / light.z;
            let colour = tint((height_m(at) - low) / range);
            rgb.extend(colour.map(|channel| shade(channel, light).round() as u8));
        }
    }

    page::png(width, height, &rgb)
}

/// Colour of the share `height` of the elevation range: a perceptually even map that also reads in grey and
/// with colour-blind eyes. Channels from 0 to 255.
pub(crate) fn tint(height: f64) -> [f64; 3] {
    let (r, g, b) = colorous::CIVIDIS.eval_continuous(height.clamp(0.0, 1.0)).as_tuple();
    [r, g, b].map(|channel| f64::from(channel) * (1.0 - PALENESS) + 255.0 * PALENESS)
}

/// Darkens a channel in shadow and lightens it in the sun, less than the light itself changes.
fn shade(channel: f64, light: f64) -> f64 {
    if light < 1.0 {
        channel * (0.5 + 0.5 * light)
    } else {
        channel + (255.0 - channel) * (light - 1.0).min(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A hill in the middle: brighter towards the north-west than towards the south-east.
    #[test]
    fn light_comes_from_the_north_west_and_north_is_up() {
        let height = |index: usize| {
            let at = DVec2::new((index % 41) as f64, (index / 41) as f64) * 0.5 - 10.0;
            libm::exp(-at.length_squared() / 30.0) as f32 * 3.0
        };
        let field = HeightField::new(41, 41, 0.5, (0..41 * 41).map(height).collect()).unwrap();
        let bytes = png(&field, DVec2::new(100.0, 100.0)).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut rgb = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut rgb).unwrap();
        let green = |column: usize, row: usize| f64::from(rgb[3 * (row * 100 + column) + 1]);
        assert!(green(35, 35) > green(65, 65) + 30.0);
    }
}
