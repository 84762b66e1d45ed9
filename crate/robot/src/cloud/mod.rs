//! Clouds of any layout (`sensor_msgs/PointCloud2`) as returns in the sensor's frame.
//!
//! [`read`] finds `x`, `y` and `z` by name, of any datatype, order and endianness, in organised clouds and
//! others, and the times of points where a field has them. What is no return is left out: NaN, and the zeros
//! of drivers that mark missing returns so. Rings are not needed: the planner sorts returns by direction.
//!
//! [`check_sensor`] says whether a sensor can serve at all, and [`check_view`] whether a scan looks like one
//! of the sensor that is configured.

mod error;
mod field;
mod sensor;
mod times;

use glam::{DVec3, Vec3};

pub use error::{CloudError, CloudWarning};
pub use field::Field;
pub use sensor::{SensorError, ViewError, check_sensor, check_view};

use field::Reader;

/// A cloud as its message holds it.
#[derive(Clone, Debug)]
pub struct PointCloud<'a> {
    /// Rows; 1 for a cloud that is not organised.
    pub height: u32,
    /// Points in a row.
    pub width: u32,
    /// What a point consists of.
    pub fields: &'a [Field],
    /// Whether numbers have their highest byte first.
    pub is_big_endian: bool,
    /// Length of a point, bytes.
    pub point_step: u32,
    /// Length of a row, bytes.
    pub row_step: u32,
    /// The points, row by row.
    pub data: &'a [u8],
    /// The stamp of the header, nanoseconds.
    pub stamp_ns: i64,
}

/// The returns of a cloud.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Returns {
    /// In the sensor's frame, metres, in the order of the cloud.
    pub points_m: Vec<Vec3>,
    /// When each was measured, seconds since the cloud's stamp; `None` for a cloud without times.
    pub since_stamp_s: Option<Vec<f64>>,
    /// What was left out or taken for granted.
    pub warnings: Vec<CloudWarning>,
}

/// Reads a cloud. One without a return is no error.
///
/// # Errors
/// [`CloudError`] names the part of the message, its value and what was expected.
pub fn read(cloud: &PointCloud<'_>) -> Result<Returns, CloudError> {
    let mut warnings = Vec::new();
    let (height, width) = (cloud.height as usize, cloud.width as usize);
    let point_step = cloud.point_step as usize;
    if point_step == 0 {
        return Err(CloudError::PointStep);
    }
    let find = |name: &str| cloud.fields.iter().find(|field| field.name.eq_ignore_ascii_case(name));
    let reader = |field: &Field| Reader::new(field, point_step, cloud.is_big_endian);
    let axis = |name: &'static str| {
        let names = || cloud.fields.iter().map(|field| field.name.clone()).collect();
        reader(find(name).ok_or_else(|| CloudError::NoField { name, found: names() })?)
    };
    let axes = [axis("x")?, axis("y")?, axis("z")?];
    let time = times::NAMES.into_iter().find_map(find);
    let time_reader = time.map(reader).transpose()?;
    let row_step = row_step(cloud, &mut warnings)?;

    let (mut points_m, mut times) = (Vec::with_capacity(height * width), Vec::new());
    for row in cloud.data.chunks(row_step.max(1)).take(height) {
        for point in row.chunks_exact(point_step).take(width) {
            let [x, y, z] = axes.map(|axis| axis.read(point));
            let point_m = DVec3::new(x, y, z).as_vec3();
            if point_m.is_finite() && point_m != Vec3::ZERO {
                points_m.push(point_m);
                times.extend(time_reader.map(|time| time.read(point)));
            }
        }
    }
    let since_stamp_s =
        time.and_then(|time| times::since_stamp_s(&time.name, &times, cloud.stamp_ns, &mut warnings));
    Ok(Returns { points_m, since_stamp_s, warnings })
}

/// The length of a row, once the data is known to hold every point.
fn row_step(cloud: &PointCloud<'_>, warnings: &mut Vec<CloudWarning>) -> Result<usize, CloudError> {
    let (height, width, point_step) =
        (cloud.height as usize, cloud.width as usize, cloud.point_step as usize);
    let size = CloudError::Size { height, width };
    let points = width.checked_mul(point_step).ok_or(size.clone())?;
    let mut row_step = cloud.row_step as usize;
    if height <= 1 && row_step != points {
        warnings.push(CloudWarning::RowStep { row_step, points });
        row_step = points;
    }
    if row_step < points {
        return Err(CloudError::RowStep { row_step, least: points, width, point_step });
    }
    let before = height.saturating_sub(1).checked_mul(row_step);
    let least = before.and_then(|before| before.checked_add(points)).ok_or(size)?;
    let least = if height == 0 { 0 } else { least };
    let bytes = cloud.data.len();
    if bytes < least {
        return Err(CloudError::Data { bytes, least, height, width });
    }
    // The last row may be filled up like the others.
    let extra = bytes.saturating_sub(least.max(height.saturating_mul(row_step)));
    if extra > 0 {
        warnings.push(CloudWarning::ExtraData { bytes: extra });
    }
    Ok(row_step)
}
