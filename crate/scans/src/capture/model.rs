//! The models of sensors that are read. All send the same packets; lasers, angles and units differ.

/// Lasers of the largest model.
pub(crate) const MOST_LASERS: usize = 32;

/// A model of sensor.
#[derive(Debug, PartialEq)]
pub(crate) struct Model {
    pub(crate) name: &'static str,
    /// Its number at the end of a data packet.
    pub(crate) product: u8,
    pub(crate) distance_unit_m: f64,
    /// Lasers that fire at the same time.
    pub(crate) lasers_at_once: usize,
    /// One for each laser, in the order they fire.
    pub(crate) lasers: &'static [Laser],
}

/// How a laser looks out of the sensor.
#[derive(Debug, PartialEq)]
pub(crate) struct Laser {
    pub(crate) elevation_deg: f64,
    /// How far clockwise it looks from the sensor's azimuth.
    pub(crate) azimuth_deg: f64,
    /// How far above the sensor's origin its beam crosses the vertical axis, millimetres.
    pub(crate) above_mm: f64,
}

const fn laser(elevation_deg: f64, azimuth_deg: f64, above_mm: f64) -> Laser {
    Laser { elevation_deg, azimuth_deg, above_mm }
}

/// Velodyne, *VLP-16 User Manual*, 63-9243, chapter 9.
const VLP16: Model = Model {
    name: "VLP-16",
    product: 0x22,
    distance_unit_m: 0.002,
    lasers_at_once: 1,
    lasers: &[
        laser(-15.0, 0.0, 11.2),
        laser(1.0, 0.0, -0.7),
        laser(-13.0, 0.0, 9.7),
        laser(3.0, 0.0, -2.2),
        laser(-11.0, 0.0, 8.1),
        laser(5.0, 0.0, -3.7),
        laser(-9.0, 0.0, 6.6),
        laser(7.0, 0.0, -5.1),
        laser(-7.0, 0.0, 5.1),
        laser(9.0, 0.0, -6.6),
        laser(-5.0, 0.0, 3.7),
        laser(11.0, 0.0, -8.1),
        laser(-3.0, 0.0, 2.2),
        laser(13.0, 0.0, -9.7),
        laser(-1.0, 0.0, 0.7),
        laser(15.0, 0.0, -11.2),
    ],
};

/// Velodyne, *Puck Hi-Res* (VLP-16 Hi-Res): a VLP-16 with two thirds of its elevations.
const PUCK_HI_RES: Model = Model {
    name: "Puck Hi-Res",
    product: 0x24,
    distance_unit_m: 0.002,
    lasers_at_once: 1,
    lasers: &[
        laser(-10.0, 0.0, 7.4),
        laser(0.67, 0.0, -0.9),
        laser(-8.67, 0.0, 6.5),
        laser(2.0, 0.0, -1.8),
        laser(-7.33, 0.0, 5.5),
        laser(3.33, 0.0, -2.7),
        laser(-6.0, 0.0, 4.6),
        laser(4.67, 0.0, -3.7),
        laser(-4.67, 0.0, 3.7),
        laser(6.0, 0.0, -4.6),
        laser(-3.33, 0.0, 2.7),
        laser(7.33, 0.0, -5.5),
        laser(-2.0, 0.0, 1.8),
        laser(8.67, 0.0, -6.5),
        laser(-0.67, 0.0, 0.9),
        laser(10.0, 0.0, -7.4),
    ],
};

/// Velodyne, *VLP-32C User Manual*, 63-9325.
const VLP32C: Model = Model {
    name: "VLP-32C",
    product: 0x28,
    distance_unit_m: 0.004,
    lasers_at_once: 2,
    lasers: &[
        laser(-25.0, 1.4, 0.0),
        laser(-1.0, -4.2, 0.0),
        laser(-1.667, 1.4, 0.0),
        laser(-15.639, -1.4, 0.0),
        laser(-11.31, 1.4, 0.0),
        laser(0.0, -1.4, 0.0),
        laser(-0.667, 4.2, 0.0),
        laser(-8.843, -1.4, 0.0),
        laser(-7.254, 1.4, 0.0),
        laser(0.333, -4.2, 0.0),
        laser(-0.333, 1.4, 0.0),
        laser(-6.148, -1.4, 0.0),
        laser(-5.333, 4.2, 0.0),
        laser(1.333, -1.4, 0.0),
        laser(0.667, 4.2, 0.0),
        laser(-4.0, -1.4, 0.0),
        laser(-4.667, 1.4, 0.0),
        laser(1.667, -4.2, 0.0),
        laser(1.0, 1.4, 0.0),
        laser(-3.667, -4.2, 0.0),
        laser(-3.333, 4.2, 0.0),
        laser(3.333, -1.4, 0.0),
        laser(2.333, 1.4, 0.0),
        laser(-2.667, -1.4, 0.0),
        laser(-3.0, 1.4, 0.0),
        laser(7.0, -1.4, 0.0),
        laser(4.667, 1.4, 0.0),
        laser(-2.333, -4.2, 0.0),
        laser(-2.0, 4.2, 0.0),
        laser(15.0, -1.4, 0.0),
        laser(10.333, 1.4, 0.0),
        laser(-1.333, -1.4, 0.0),
    ],
};

/// The models that are read.
pub(crate) static MODELS: [Model; 3] = [VLP16, PUCK_HI_RES, VLP32C];

/// The models that are read, for messages.
pub(crate) const SUPPORTED: &str = "0x22 (VLP-16), 0x24 (Puck Hi-Res) or 0x28 (VLP-32C)";
