//! What the planner decided, for RViz, Foxglove and Lichtblick.

use mapless::{Pose, Step};
use mapless_robot::frames::FrameChange;
use ros2_client::Publisher;

use crate::config::NodeConfig;
use crate::messages::{
    ColorRgba, Header, Marker, MarkerArray, Path, Point, Pose as PoseMessage, PoseStamped, Quaternion, Time,
    Vector3,
};
use crate::ros::{Entities, RosError, published_qos};

const CHOSEN: ColorRgba = ColorRgba { r: 0.1, g: 0.8, b: 0.2, a: 1.0 };
const CANDIDATE: ColorRgba = ColorRgba { r: 0.2, g: 0.5, b: 1.0, a: 0.9 };
const REFUSED: ColorRgba = ColorRgba { r: 0.9, g: 0.2, b: 0.1, a: 0.5 };
const SUBGOAL_M: f64 = 0.25;

/// The publishers of path and subgoals.
pub(crate) struct Picture {
    path: Publisher<Path>,
    subgoals: Publisher<MarkerArray>,
    frame_id: String,
}

impl Picture {
    pub(crate) fn new(config: &NodeConfig, entities: &mut Entities) -> Result<Self, RosError> {
        let (topics, qos) = (&config.topics, published_qos());
        Ok(Self {
            path: entities.publisher(&topics.path, "nav_msgs/Path", qos.clone())?,
            subgoals: entities.publisher(&topics.subgoals, "visualization_msgs/MarkerArray", qos)?,
            frame_id: config.drive.frames.odom.clone(),
        })
    }

    /// Publishes what a step decided, in the odometry's frame: `poses` are the robot's in the estimator's
    /// frame and in the odometry's.
    pub(crate) fn publish(&self, step: &Step<'_>, [believed, told]: [Pose; 2], stamp: Time) {
        let change = FrameChange::new(believed, told);
        let header = Header { stamp, frame_id: self.frame_id.clone() };
        let poses = step.path.iter().map(|point| {
            let position = Point::from(change.place_m(point.position_m).extend(told.position_m.z));
            let pose = PoseMessage { position, orientation: Quaternion::default() };
            PoseStamped { header: header.clone(), pose }
        });
        let path = Path { header: header.clone(), poses: poses.collect() };
        if let Err(error) = self.path.publish(path) {
            log::warn!("the path could not be published: {error}");
        }
        let side = SUBGOAL_M;
        let marker = Marker {
            header,
            ns: "subgoals".to_owned(),
            r#type: Marker::SPHERE_LIST,
            scale: Vector3 { x: side, y: side, z: side },
            color: CANDIDATE,
            points: step.subgoals.iter().map(|subgoal| change.point_m(subgoal.position_m).into()).collect(),
            colors: (0..step.subgoals.len()).map(|index| colour(step, index)).collect(),
            ..Marker::default()
        };
        if let Err(error) = self.subgoals.publish(MarkerArray { markers: vec![marker] }) {
            log::warn!("the subgoals could not be published: {error}");
        }
    }
}

fn colour(step: &Step<'_>, index: usize) -> ColorRgba {
    match step.chosen {
        Some(chosen) if chosen == index => CHOSEN,
        _ if step.subgoals[index].refusal.is_some() => REFUSED,
        _ => CANDIDATE,
    }
}
