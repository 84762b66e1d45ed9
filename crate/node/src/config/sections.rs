//! Small sections of the file.

use std::net::{IpAddr, Ipv4Addr};
use std::num::NonZeroU16;

use mapless::RobotModel;
use mapless_parameters::{choices, parameters};
pub use mapless_robot::drive_config::{Frames, ImuMount, NavigationConfig};
use serde::{Deserialize, Serialize};

choices! {
    /// A robot whose dimensions are known.
    pub enum RobotPreset {
        /// Clearpath Husky A200.
        Husky = "husky",
        /// Clearpath Jackal J100.
        Jackal = "jackal",
        /// Clearpath Warthog.
        Warthog = "warthog",
    }
}

impl RobotPreset {
    pub(super) fn model(self) -> RobotModel {
        match self {
            Self::Husky => RobotModel::husky(),
            Self::Jackal => RobotModel::jackal(),
            Self::Warthog => RobotModel::warthog(),
        }
    }
}

choices! {
    /// A preset of the planner.
    pub enum PlannerPreset {
        /// The default one.
        Default = "default",
        /// The paper's.
        Paper = "paper",
    }
}

choices! {
    /// Where the sensor's mount is told.
    pub enum MountSource {
        /// In the file.
        File = "file",
        /// On the topics `tf_static` and `tf`, once as the node begins.
        Tf = "tf",
    }
}

parameters! {
    /// Where the sensor's mount is told.
    #[derive(Copy)]
    pub struct SensorMount {
        /// In the file's section `sensor`, or by tf from `frames.base` to `frames.scan`.
        source: MountSource = MountSource::File;
        /// How long the node waits for tf before it ends. systemd gives it 30 s to begin.
        timeout_s: f64 = 20.0, unit "s", range [5.0, 120.0], check Within(1.0, 3600.0);
    }
}

/// The mount of the sensor over the point on the ground between the wheels, as in [`mapless::SensorModel`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Mount {
    /// Metres.
    pub forward_m: f64,
    /// Metres.
    pub left_m: f64,
    /// Metres.
    pub height_m: f64,
    /// Left side up positive.
    pub roll_rad: f64,
    /// Nose-up positive.
    pub pitch_rad: f64,
    /// Anticlockwise positive.
    pub yaw_rad: f64,
}

impl Mount {
    /// The keys of the file's section `sensor` that tell it.
    pub(super) const KEYS: [&str; 6] =
        ["forward_m", "left_m", "height_m", "roll_rad", "pitch_rad", "yaw_rad"];
}

/// A Velodyne sensor that sends its packets to the node, in place of the topic `scan`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Velodyne {
    /// The sensor's address: packets of others are passed over.
    pub from: IpAddr,
    /// The address of this computer at which the node listens.
    #[serde(default = "any_address")]
    pub address: IpAddr,
    /// The port at which it listens.
    #[serde(default = "velodyne_port")]
    pub port: NonZeroU16,
}

fn any_address() -> IpAddr {
    Ipv4Addr::UNSPECIFIED.into()
}

/// Velodyne, *VLP-16 User Manual*, 63-9243: the port of data packets.
fn velodyne_port() -> NonZeroU16 {
    const { NonZeroU16::new(2368).unwrap() }
}
