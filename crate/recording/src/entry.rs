//! What a recording consists of.

use mapless::PlannerConfig;
use mapless_robot::messages::{Bool, Clock, Imu, Odometry, PointCloud2, PoseStamped};
use mapless_robot::senses::Arrival;
use mapless_robot::supervisor::SupervisorConfig;

use crate::message::{AnswerMessage, GoalMessage, LostMessage, SpoiltMessage, TickMessage};
use crate::topics::Role;

/// Something that took effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// When; the monotonic clock begins with the recording.
    pub arrival: Arrival,
    /// What.
    pub content: Content,
}

/// Messages that came, and decisions.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// A scan.
    Scan(PointCloud2),
    /// Odometry.
    Odometry(Box<Odometry>),
    /// A message of the IMU.
    Imu(Box<Imu>),
    /// Whether the emergency stop is pressed.
    EmergencyStop(Bool),
    /// Whether a latched stop is taken back.
    Reset(Bool),
    /// A goal as it was asked for by topic.
    GoalPose(PoseStamped),
    /// The simulation's clock.
    Clock(Clock),
    /// The goal in service changed.
    Goal(GoalMessage),
    /// A tick of the supervisor.
    Tick(TickMessage),
    /// An answer of the planner.
    Answer(AnswerMessage),
    /// A scan was spoilt on its way.
    Spoilt(SpoiltMessage),
    /// The supervisor has other limits from now on.
    Limits(Box<SupervisorConfig>),
    /// The planner begins anew with this configuration.
    Planner(Box<PlannerConfig>),
    /// Entries were lost.
    Lost(LostMessage),
}

impl Content {
    /// The topic that it belongs to.
    #[must_use]
    pub fn role(&self) -> Role {
        match self {
            Self::Scan(_) => Role::Scan,
            Self::Odometry(_) => Role::Odometry,
            Self::Imu(_) => Role::Imu,
            Self::EmergencyStop(_) => Role::EmergencyStop,
            Self::Reset(_) => Role::Reset,
            Self::GoalPose(_) => Role::GoalPose,
            Self::Clock(_) => Role::Clock,
            Self::Goal(_) => Role::Goal,
            Self::Tick(_) => Role::Tick,
            Self::Answer(_) => Role::Answer,
            Self::Spoilt(_) => Role::Spoilt,
            Self::Limits(_) => Role::Limits,
            Self::Planner(_) => Role::Planner,
            Self::Lost(_) => Role::Lost,
        }
    }

    /// Its length in memory beyond the struct itself, bytes, about.
    #[must_use]
    pub fn bytes(&self) -> usize {
        match self {
            Self::Scan(cloud) => cloud.data.len(),
            _ => 0,
        }
    }
}
