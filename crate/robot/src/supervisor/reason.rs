//! Why the robot was stopped, and what clears each stop.

use super::states::Event;

/// What is wrong with an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Defect {
    /// Nothing comes, or only what was old when it came.
    Stale,
    /// The same message comes again and again, or the same content while the robot moves.
    Frozen,
    /// Messages come that cannot be used.
    Malformed,
    /// Messages come with stamps ahead of their sender's clock.
    Future,
}

/// Why the robot was stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, thiserror::Error)]
pub enum Reason {
    /// The supervisor was started, and not all inputs have come.
    #[error("starting: waiting for every input")]
    Starting,
    /// No good scan.
    #[error("scan: {0:?}")]
    Scan(Defect),
    /// No good odometry.
    #[error("odometry: {0:?}")]
    Odometry(Defect),
    /// No good message of the IMU.
    #[error("IMU: {0:?}")]
    Imu(Defect),
    /// Time went back.
    #[error("time went backwards")]
    TimeBackwards,
    /// The supervisor itself was not called for too long.
    #[error("the process was suspended")]
    Suspended,
    /// The simulation's clock stands still.
    #[error("the clock stands still")]
    ClockLost,
    /// The emergency stop is pressed.
    #[error("the emergency stop is pressed")]
    EmergencyStop,
    /// The emergency stop tells nothing.
    #[error("the emergency stop is silent")]
    EmergencyStopSilent,
    /// The robot leans too much.
    #[error("the robot is tilted beyond its limit")]
    Tilt,
    /// The position or heading jumped.
    #[error("the localisation jumped")]
    Jump,
    /// The wheels turn otherwise than the IMU feels.
    #[error("wheels and IMU disagree")]
    WheelsDisagree,
    /// The planner stopped by itself: it has no subgoal, or sees nothing.
    #[error("the planner has no subgoal")]
    NoSubgoal,
    /// The planner takes too long.
    #[error("the planner is late")]
    PlannerOverrun,
    /// The planner panicked.
    #[error("the planner panicked")]
    PlannerPanic,
    /// The planner gave a command that is not finite.
    #[error("the planner's command is not a number")]
    PlannerNan,
    /// Nobody takes the commands.
    #[error("no peer takes the commands")]
    PeerLost,
    /// A command could not be published.
    #[error("a command could not be published")]
    PublishFailed,
    /// Another node publishes on the topic of the commands.
    #[error("another publisher commands the robot")]
    OtherPublisher,
}

impl Reason {
    /// What a reason to stop does to the state, and so what clears it. Of reasons at one time, the strongest
    /// counts.
    pub fn event(self) -> Event {
        match self {
            Self::Scan(Defect::Future) | Self::Odometry(Defect::Future) | Self::Imu(Defect::Future) => {
                Event::Abort
            }
            Self::Starting | Self::Suspended | Self::ClockLost | Self::NoSubgoal | Self::PlannerOverrun => {
                Event::Pause
            }
            Self::Scan(_) | Self::Odometry(_) | Self::Imu(_) => Event::Pause,
            Self::TimeBackwards | Self::EmergencyStop | Self::EmergencyStopSilent | Self::Jump => {
                Event::Abort
            }
            Self::WheelsDisagree | Self::PeerLost | Self::PublishFailed => Event::Abort,
            Self::Tilt | Self::PlannerPanic | Self::PlannerNan | Self::OtherPublisher => Event::Latch,
        }
    }
}
