//! Real captures against the points that another decoder reads from them.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::path::Path;

use glam::Vec3;
use mapless_scans::{ScanChoice, ScanFault, read_scan};

/// Points of the second whole revolution as velodyne-decoder 3.1.0 (PyPI) gives them, whose frame is ours.
const GPS: &[[f32; 3]] = &[
    [-1.4590, 0.0497, -0.2246],
    [-0.1957, 0.8790, 0.0751],
    [0.5428, 1.0504, 0.0598],
    [0.5628, 0.1893, 0.0483],
    [0.5977, -0.1039, 0.1098],
    [0.6035, -0.7445, 0.0802],
];
const SINGLE: &[[f32; 3]] = &[
    [-0.5134, 0.1022, 0.0763],
    [0.5687, 0.1845, 0.0097],
    [1.8917, -0.6762, 0.2415],
    [0.3993, -0.5571, 0.0563],
    [0.7538, -3.3234, 0.9019],
    [-0.1131, -0.7036, -0.0824],
    [-1.9533, -1.9015, 0.4251],
];

#[test]
#[ignore = "reads the data that MAPLESS_DATA names"]
fn captures_hold_the_points_that_another_decoder_finds() {
    let folder = Path::new(&std::env::var_os("MAPLESS_DATA").unwrap()).join("data/vlp16");
    for (name, whole, expected) in
        [("vlp16_gps_bsd3.pcap", 3, GPS), ("vlp16_single_apache2.pcap", 10, SINGLE)]
    {
        let path = folder.join(name);
        let points = read_scan(&path, ScanChoice::of_revolution(1)).unwrap().points_m;
        for place in expected.iter().copied().map(Vec3::from_array) {
            let nearest = points.iter().map(|point| point.distance(place)).fold(f32::INFINITY, f32::min);
            // The other decoder interpolates azimuths across packets and tilts the vertical offset.
            assert!(nearest < 0.002, "{name}: {place} is {nearest} m from the nearest point");
        }
        let beyond = read_scan(&path, ScanChoice::of_revolution(whole)).unwrap_err().fault;
        assert_eq!(beyond, ScanFault::Revolution { revolution: whole, whole });
    }
}
