//! Clouds of floats.

use super::{Header, PointCloud2, PointField};

const FLOAT32: u8 = 7;
const FLOAT_BYTES: u32 = 4;

/// A cloud of points of the same number of floats each, in rows of the same length.
#[must_use]
pub fn cloud_of_floats<const N: usize>(
    header: Header,
    fields: [&str; N],
    rows: usize,
    points: &[[f32; N]],
) -> PointCloud2 {
    let field = |(index, name): (usize, &str)| PointField {
        name: name.to_owned(),
        offset: FLOAT_BYTES * index as u32,
        datatype: FLOAT32,
        count: 1,
    };
    let (point_step, width) = (FLOAT_BYTES * N as u32, (points.len() / rows) as u32);
    let data: Vec<u8> = points.as_flattened().iter().flat_map(|number| number.to_le_bytes()).collect();
    PointCloud2 {
        header,
        height: rows as u32,
        width,
        fields: fields.into_iter().enumerate().map(field).collect(),
        is_bigendian: false,
        point_step,
        row_step: point_step * width,
        data: data.into(),
        is_dense: true,
    }
}
