//! The parameters of sensor and robot.

use super::Kind::{Number, Whole};
use super::{Group, given, open};

pub(super) const GROUPS: &[Group] = &[
    Group {
        table: "sensor",
        title: "Sensor",
        parameters: &[
            open("range_noise_m", "m", Number(0.0, 0.5), "Standard deviation of each range."),
            open("dropout_probability", "", Number(0.0, 1.0), "Share of returns that are lost at random."),
            open("columns", "", Whole(90, 3600), "Azimuths in one revolution; a VLP-16 at 10 Hz has 1800."),
            open("min_range_m", "m", Number(0.0, 5.0), "Nothing nearer is reported."),
            open("max_range_m", "m", Number(5.0, 200.0), "Nothing farther is reported."),
            open("height_m", "m", Number(0.2, 3.0), "Height of the sensor above the ground."),
            open(
                "forward_m",
                "m",
                Number(-1.0, 1.0),
                "Distance of the sensor ahead of the middle of the wheels.",
            ),
        ],
    },
    Group {
        table: "robot",
        title: "Robot",
        parameters: &[
            given(
                "roll_limit_rad",
                "rad",
                Number(0.1, 1.2),
                "0.524",
                "Beyond this |roll| the run has failed.",
            ),
            given(
                "pitch_limit_rad",
                "rad",
                Number(0.1, 1.2),
                "0.785",
                "Beyond this |pitch| the run has failed.",
            ),
            open("max_speed_m_s", "m/s", Number(0.1, 3.0), "Largest speed."),
            open("max_turn_rate_rad_s", "rad/s", Number(0.1, 3.0), "Largest turn rate."),
            open("max_acceleration_m_s2", "m/s²", Number(0.1, 5.0), "Largest change of speed."),
            open("max_turn_acceleration_rad_s2", "rad/s²", Number(0.1, 10.0), "Largest change of turn rate."),
            open("wheelbase_m", "m", Number(0.2, 1.5), "Distance between front and rear axle."),
            open("track_m", "m", Number(0.2, 0.68), "Distance between left and right wheels."),
            open("wheel_radius_m", "m", Number(0.05, 0.5), "Radius of the wheels."),
            open("width_m", "m", Number(0.58, 1.5), "Overall width over the wheels."),
        ],
    },
];
