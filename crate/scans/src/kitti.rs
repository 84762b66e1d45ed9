//! Scans of the KITTI data set: x, y, z and intensity of each point as little-endian floats, no header.

use glam::DVec3;

use crate::error::ScanFault;
use crate::scan::Scan;
use crate::values::{self, Number};

const RECORD_BYTES: usize = 16;

pub(crate) fn read(bytes: &[u8]) -> Result<Scan, ScanFault> {
    if !bytes.len().is_multiple_of(RECORD_BYTES) {
        let expected = "a multiple of 16: four floats x, y, z and intensity a point, as in KITTI";
        return Err(ScanFault::value("length in bytes", bytes.len(), expected));
    }
    let mut points = Vec::new();
    for (index, record) in bytes.chunks_exact(RECORD_BYTES).enumerate() {
        let values = record.chunks_exact(4).filter_map(|value| Number::F32.read(value, false));
        let [x, y, z, intensity] = values.collect::<Vec<_>>()[..] else { continue };
        // Files of other records than KITTI's have coordinates there.
        if intensity < 0.0 {
            let place = format!("point {}, intensity", index + 1);
            let expected = "0 or more: four floats x, y, z and intensity a point, as in KITTI";
            return Err(ScanFault::value(place, intensity, expected));
        }
        points.extend(values::point(String::new, DVec3::new(x, y, z))?);
    }
    Ok(points.into())
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use proptest::prelude::*;

    fn written(points: &[[f32; 4]]) -> Vec<u8> {
        points.iter().flatten().flat_map(|value| value.to_le_bytes()).collect()
    }

    #[test]
    fn other_records_are_refused() {
        let short = read(&written(&[[1.0; 4]])[..12]).unwrap_err().to_string();
        assert!(short.starts_with("length in bytes = 12: expected a multiple of 16"), "{short}");
        let five = [1.0, -2.0, 0.5, 7.0, 3.0].repeat(4);
        let five: Vec<u8> = five.into_iter().flat_map(f32::to_le_bytes).collect();
        let message = read(&five).unwrap_err().to_string();
        assert!(message.starts_with("point 3, intensity = -2: expected 0 or more"), "{message}");
    }

    #[test]
    fn points_that_are_not_finite_are_beams_without_a_return() {
        let points = [[1.0, 2.0, 3.0, 0.0], [f32::NAN, 2.0, 3.0, 0.0], [0.0, 0.0, 0.0, f32::NAN]];
        assert_eq!(read(&written(&points)), Ok(vec![Vec3::new(1.0, 2.0, 3.0), Vec3::ZERO].into()));
    }

    proptest! {
        #[test]
        fn written_points_read_back_to_the_bit(
            points in prop::collection::vec(prop::array::uniform4(-1e6..1e6_f32), 0..50),
        ) {
            let points: Vec<[f32; 4]> = points.into_iter().map(|[x, y, z, i]| [x, y, z, i.abs()]).collect();
            let expected: Vec<Vec3> = points.iter().map(|&[x, y, z, _]| Vec3::new(x, y, z)).collect();
            prop_assert_eq!(read(&written(&points)).unwrap().points_m, expected);
        }

        #[test]
        fn any_bytes_give_points_or_a_fault(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            if let Ok(scan) = read(&bytes) {
                prop_assert!(scan.points_m.iter().all(|point| point.is_finite()));
            }
        }
    }
}
