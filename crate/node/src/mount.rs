//! The sensor's mount by tf: the way from the robot's frame to the sensor's, taken once as the node begins.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use mapless::glam::{DAffine3, DQuat, DVec3, EulerRot};

use crate::config::{Mount, NodeConfig};
use crate::messages::{self, Time, TransformStamped};
use crate::ros::{Entities, RosError};
use ros2_client::Subscription;

/// A transform on the topic `tf` that is older does not hold.
const FRESH_S: f64 = 1.0;
/// No tree of frames is deeper.
const DEEPEST: usize = 64;
const WAIT: Duration = Duration::from_millis(50);

/// Why the mount is not known.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MountError {
    /// No transforms lead from one frame to the other.
    #[error("tf: no transforms lead from frame {base:?} to {sensor:?}; known are {known}")]
    Missing {
        /// The robot's frame.
        base: String,
        /// The sensor's frame.
        sensor: String,
        /// What is known.
        known: String,
    },
    /// A transform on the way is old.
    #[error("tf: the transform from {parent:?} to {child:?} is {age_s:.1} s old: expected at most 1 s")]
    Stale {
        /// Its parent.
        parent: String,
        /// Its child.
        child: String,
        /// Its age, seconds.
        age_s: f64,
    },
    /// A transform is no rigid motion.
    #[error("tf: the transform from {parent:?} to {child:?} is no turn and shift in finite numbers")]
    Invalid {
        /// Its parent.
        parent: String,
        /// Its child.
        child: String,
    },
    /// The middleware.
    #[error("{0}")]
    Ros(String),
}

impl From<RosError> for MountError {
    fn from(error: RosError) -> Self {
        Self::Ros(error.to_string())
    }
}

/// Waits until tf tells the mount, as long as the configuration says or until `is_ending`.
///
/// # Errors
/// [`MountError`], the last one when time is up.
pub(crate) fn wait(
    config: &NodeConfig,
    entities: &mut Entities,
    is_ending: impl Fn() -> bool,
) -> Result<Mount, MountError> {
    let (moving, fixed) = entities.subscribe_tf(config)?;
    let clock = entities.subscribe_clock(config)?;
    // What is simulated is as old as the simulation's clock says; before that is heard, nothing is.
    let mut simulated = Time::default();
    let end = Instant::now() + Duration::from_secs_f64(config.sensor_mount.timeout_s);
    let (mut tree, base, sensor) = (Tree::default(), &config.drive.frames.base, &config.drive.frames.scan);
    log::info!("waiting for tf from {base} to {sensor}");
    loop {
        for (subscription, is_fixed) in [(&moving, false), (&fixed, true)] {
            loop {
                match subscription.take() {
                    Ok(Some((message, _))) => {
                        for transform in &message.transforms {
                            tree.take(transform, is_fixed);
                        }
                    }
                    Ok(None) => break,
                    Err(error) => log::warn!("tf: {error}"),
                }
            }
        }
        while let Some(Ok(Some((message, _)))) = clock.as_ref().map(Subscription::take) {
            simulated = message.clock;
        }
        let now = if config.use_sim_time { simulated } else { messages::now() };
        match tree.find(base, sensor, now) {
            Ok(way) => return Ok(mount(way, config.drive.estimator.base_height_m)),
            Err(error) if Instant::now() > end || is_ending() => return Err(error),
            Err(_) => entities.wait(WAIT),
        }
    }
}

/// The mount over the ground between the wheels. ROS counts pitch nose-down positive.
fn mount(base_from_sensor: DAffine3, base_height_m: f64) -> Mount {
    let (_, turn, shift_m) = base_from_sensor.to_scale_rotation_translation();
    let (yaw_rad, pitch_rad, roll_rad) = turn.to_euler(EulerRot::ZYX);
    Mount {
        forward_m: shift_m.x,
        left_m: shift_m.y,
        height_m: base_height_m + shift_m.z,
        roll_rad,
        pitch_rad: -pitch_rad,
        yaw_rad,
    }
}

/// The way to a frame from its parent.
struct Link {
    parent: String,
    transform: DAffine3,
    is_rigid: bool,
    /// `None` for one that holds for good.
    stamp: Option<Time>,
}

/// Frames by their parents.
#[derive(Default)]
struct Tree {
    links: BTreeMap<String, Link>,
}

impl Tree {
    fn take(&mut self, told: &TransformStamped, is_fixed: bool) {
        let rotation = told.transform.rotation;
        let turn = DQuat::from_xyzw(rotation.x, rotation.y, rotation.z, rotation.w);
        let shift_m = DVec3::from(told.transform.translation);
        let link = Link {
            parent: told.header.frame_id.clone(),
            transform: DAffine3::from_rotation_translation(turn.normalize(), shift_m),
            is_rigid: (turn.length() - 1.0).abs() < 0.01 && shift_m.is_finite(),
            stamp: (!is_fixed).then_some(told.header.stamp),
        };
        self.links.insert(told.child_frame_id.clone(), link);
    }

    /// The frames from one up to its root, each with the way from the first to it.
    fn ancestors(&self, frame: &str, now: Time) -> Result<Vec<(String, DAffine3)>, MountError> {
        let mut found = vec![(frame.to_owned(), DAffine3::IDENTITY)];
        while let Some((child, way)) = found.last().cloned()
            && let Some(link) = self.links.get(&child)
            && found.len() < DEEPEST
        {
            let parent = link.parent.clone();
            if !link.is_rigid {
                return Err(MountError::Invalid { parent, child });
            }
            if let Some(stamp) = link.stamp {
                let age_s = 1e-9 * (now.nanoseconds() - stamp.nanoseconds()) as f64;
                if age_s > FRESH_S {
                    return Err(MountError::Stale { parent, child, age_s });
                }
            }
            found.push((parent, link.transform * way));
        }
        Ok(found)
    }

    /// From the coordinates of one frame to those of another.
    fn find(&self, base: &str, sensor: &str, now: Time) -> Result<DAffine3, MountError> {
        let (of_base, of_sensor) = (self.ancestors(base, now), self.ancestors(sensor, now)?);
        let of_base = of_base?;
        let met = of_sensor.iter().find_map(|(frame, from_sensor)| {
            let (_, from_base) = of_base.iter().find(|(other, _)| other == frame)?;
            Some(from_base.inverse() * *from_sensor)
        });
        met.ok_or_else(|| {
            let known = self.links.iter().map(|(child, link)| format!("{} to {child}", link.parent));
            let known: Vec<String> = known.collect();
            let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
            MountError::Missing { base: base.to_owned(), sensor: sensor.to_owned(), known }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::messages::{Header, Quaternion, Transform, Vector3};
    use core::f64::consts::FRAC_PI_2;

    const NOW: Time = Time { sec: 100, nanosec: 0 };

    fn told(parent: &str, child: &str, shift_m: [f64; 3], turn: DQuat, sec: i32) -> TransformStamped {
        let [x, y, z] = shift_m;
        let rotation = Quaternion { x: turn.x, y: turn.y, z: turn.z, w: turn.w };
        TransformStamped {
            header: Header { stamp: Time { sec, nanosec: 0 }, frame_id: parent.to_owned() },
            child_frame_id: child.to_owned(),
            transform: Transform { translation: Vector3 { x, y, z }, rotation },
        }
    }

    /// A sensor on a plate that faces left and looks 0.2 rad down.
    fn tree() -> Tree {
        let mut tree = Tree::default();
        tree.take(&told("base_link", "chassis", [0.0, 0.0, 0.1], DQuat::IDENTITY, 0), true);
        tree.take(&told("chassis", "plate", [0.3, 0.0, 0.2], DQuat::from_rotation_z(FRAC_PI_2), 0), true);
        tree.take(&told("plate", "lidar", [0.1, 0.0, 0.4], DQuat::from_rotation_y(0.2), 0), true);
        tree.take(&told("chassis", "imu", [0.0; 3], DQuat::IDENTITY, 0), true);
        tree
    }

    #[test]
    fn the_mount_is_the_way_over_several_frames_with_pitch_nose_up() {
        let mount = mount(tree().find("base_link", "lidar", NOW).unwrap(), 0.165);
        let expected = [0.3, 0.1, 0.865, 0.0, -0.2, FRAC_PI_2];
        let Mount { forward_m, left_m, height_m, roll_rad, pitch_rad, yaw_rad } = mount;
        for (found, expected) in
            [forward_m, left_m, height_m, roll_rad, pitch_rad, yaw_rad].iter().zip(expected)
        {
            assert!((found - expected).abs() < 1e-12, "{mount:?}");
        }
        // Between branches, too.
        let way = tree().find("imu", "plate", NOW).unwrap();
        assert!((way.translation - DVec3::new(0.3, 0.0, 0.2)).length() < 1e-12);
    }

    #[test]
    fn what_is_missing_stale_or_no_motion_is_named() {
        let error = |tree: &Tree| tree.find("base_link", "lidar", NOW).unwrap_err().to_string();
        assert_eq!(
            error(&Tree::default()),
            "tf: no transforms lead from frame \"base_link\" to \"lidar\"; known are none"
        );
        let mut cut = tree();
        cut.links.remove("plate");
        assert!(error(&cut).ends_with("known are base_link to chassis, chassis to imu, plate to lidar"));
        let mut moving = tree();
        moving.take(&told("chassis", "plate", [0.0; 3], DQuat::IDENTITY, 95), false);
        assert_eq!(
            error(&moving),
            "tf: the transform from \"chassis\" to \"plate\" is 5.0 s old: expected at most 1 s"
        );
        moving.take(&told("chassis", "plate", [0.0; 3], DQuat::IDENTITY, 100), false);
        assert!(moving.find("base_link", "lidar", NOW).is_ok());
        moving.take(&told("chassis", "plate", [f64::NAN, 0.0, 0.0], DQuat::IDENTITY, 100), false);
        assert!(error(&moving).ends_with("is no turn and shift in finite numbers"));
        moving.take(&told("chassis", "plate", [0.0; 3], DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0), 100), false);
        assert!(error(&moving).ends_with("is no turn and shift in finite numbers"));
        // A circle has an end.
        let mut circle = Tree::default();
        circle.take(&told("a", "b", [0.0; 3], DQuat::IDENTITY, 0), true);
        circle.take(&told("b", "a", [0.0; 3], DQuat::IDENTITY, 0), true);
        assert!(circle.find("a", "c", NOW).is_err());
    }
}
