//! Faults that are put into a replay by hand, to see what the supervisor makes of them.

use core::fmt::{self, Display};
use core::str::FromStr;
use core::time::Duration;
use std::borrow::Cow;

use mapless::Command;
use mapless::glam::DQuat;
use mapless_robot::messages::{Bool, Quaternion};
use mapless_robot::supervisor::{Inputs, Outcome, Proposal};

use crate::entry::{Content, Entry};

/// How far a robot leans that is said to lean, radians: more than any limit on roll.
const LEAN_RAD: f64 = 1.3;
/// How far an odometry jumps, metres.
const JUMP_M: f64 = 3.0;

/// What goes wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaultKind {
    /// No scan comes.
    NoScan,
    /// No odometry comes.
    NoOdometry,
    /// No message of the IMU comes.
    NoImu,
    /// The IMU's orientation is not a number.
    ImuNotFinite,
    /// The IMU says that the robot leans to its right.
    Tilt,
    /// The odometry is 3 m off.
    PoseJump,
    /// The emergency stop is pressed.
    EmergencyStop,
    /// The emergency stop tells nothing.
    EmergencyStopSilent,
    /// The planner does not answer.
    PlannerSilent,
    /// The planner panics.
    PlannerPanic,
    /// The planner's speed is not a number.
    PlannerNotFinite,
    /// Nobody takes the commands.
    PeerLost,
    /// Commands are not published.
    PublishFailed,
    /// Somebody else publishes commands.
    OtherPublisher,
    /// The process is suspended.
    Suspended,
}

impl FaultKind {
    /// Every kind, with its name.
    pub const ALL: [(Self, &str); 15] = [
        (Self::NoScan, "no_scan"),
        (Self::NoOdometry, "no_odometry"),
        (Self::NoImu, "no_imu"),
        (Self::ImuNotFinite, "imu_not_finite"),
        (Self::Tilt, "tilt"),
        (Self::PoseJump, "pose_jump"),
        (Self::EmergencyStop, "emergency_stop"),
        (Self::EmergencyStopSilent, "emergency_stop_silent"),
        (Self::PlannerSilent, "planner_silent"),
        (Self::PlannerPanic, "planner_panic"),
        (Self::PlannerNotFinite, "planner_not_finite"),
        (Self::PeerLost, "peer_lost"),
        (Self::PublishFailed, "publish_failed"),
        (Self::OtherPublisher, "other_publisher"),
        (Self::Suspended, "suspended"),
    ];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::ALL[self as usize].1
    }
}

/// A fault that is put into a replay. As text it is `no_scan@1.5+0.4`: kind, begin and length in seconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InjectedFault {
    /// What goes wrong.
    pub kind: FaultKind,
    /// From when on, since the recording's begin.
    pub from: Duration,
    /// Until when, exclusive.
    pub until: Duration,
}

impl Display for InjectedFault {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (from_s, length_s) = (self.from.as_secs_f64(), (self.until - self.from).as_secs_f64());
        write!(formatter, "{}@{from_s}+{length_s}", self.kind.name())
    }
}

impl FromStr for InjectedFault {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let fail = || {
            let names = FaultKind::ALL.map(|(_, name)| name).join(", ");
            format!(
                "{text:?}: expected KIND@BEGIN+LENGTH in seconds, as no_scan@1.5+0.4, with one of {names}"
            )
        };
        let time = |text: &str| {
            let seconds = text.parse().map_err(|_| fail())?;
            Duration::try_from_secs_f64(seconds).map_err(|_| fail())
        };
        let (name, times) = text.split_once('@').ok_or_else(fail)?;
        let (from, length) = times.split_once('+').ok_or_else(fail)?;
        let (kind, _) = FaultKind::ALL.into_iter().find(|(_, known)| *known == name).ok_or_else(fail)?;
        let from = time(from)?;
        let until = from.checked_add(time(length)?).ok_or_else(fail)?;
        Ok(Self { kind, from, until })
    }
}

/// Faults that spoil messages on their way to the senses, and ticks of the supervisor.
#[derive(Clone, Debug, Default)]
pub struct Faults(pub Vec<InjectedFault>);

impl Faults {
    fn at(&self, at: Duration) -> impl Iterator<Item = FaultKind> {
        self.0.iter().filter(move |fault| fault.from <= at && at < fault.until).map(|fault| fault.kind)
    }

    /// What becomes of a message; `None` if it does not come.
    pub fn message<'a>(&self, entry: &'a Entry) -> Option<Cow<'a, Entry>> {
        let mut entry = Cow::Borrowed(entry);
        for kind in self.at(entry.arrival.at) {
            match (kind, &entry.content) {
                (FaultKind::NoScan, Content::Scan(_))
                | (FaultKind::NoOdometry, Content::Odometry(_))
                | (FaultKind::NoImu, Content::Imu(_))
                | (FaultKind::EmergencyStopSilent, Content::EmergencyStop(_)) => return None,
                (FaultKind::ImuNotFinite | FaultKind::Tilt, Content::Imu(imu)) => {
                    let mut imu = imu.clone();
                    imu.orientation = match kind {
                        FaultKind::Tilt => {
                            let turn = DQuat::from_rotation_x(LEAN_RAD);
                            let DQuat { x, y, z, w } = imu.orientation.to_glam() * turn;
                            Quaternion { x, y, z, w }
                        }
                        _ => Quaternion { w: f64::NAN, ..imu.orientation },
                    };
                    entry.to_mut().content = Content::Imu(imu);
                }
                (FaultKind::PoseJump, Content::Odometry(odometry)) => {
                    let mut odometry = odometry.clone();
                    odometry.pose.pose.position.x += JUMP_M;
                    entry.to_mut().content = Content::Odometry(odometry);
                }
                (FaultKind::EmergencyStop, Content::EmergencyStop(_)) => {
                    entry.to_mut().content = Content::EmergencyStop(Bool { data: true });
                }
                _ => {}
            }
        }
        Some(entry)
    }

    /// What the supervisor is told at a tick, and what the planner proposed; whether the tick comes.
    pub fn tick(&self, at: Duration, inputs: &mut Inputs, proposal: &mut Option<Proposal>) -> bool {
        let mut comes = true;
        for kind in self.at(at) {
            let outcome = proposal.as_mut().map(|proposal| &mut proposal.outcome);
            match kind {
                FaultKind::EmergencyStop => inputs.hear_emergency_stop(true),
                FaultKind::PlannerSilent => *proposal = None,
                FaultKind::PlannerPanic => outcome.into_iter().for_each(|it| *it = Outcome::Panicked),
                FaultKind::PlannerNotFinite => {
                    let command = Command { linear_m_s: f64::NAN, ..Command::STOP };
                    outcome.into_iter().for_each(|it| *it = Outcome::Command(command));
                }
                FaultKind::PeerLost => inputs.has_peer = false,
                FaultKind::PublishFailed => inputs.publish_failed = true,
                FaultKind::OtherPublisher => inputs.other_publishers = 1,
                FaultKind::Suspended => comes = false,
                _ => {}
            }
        }
        comes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_is_listed_in_its_order_and_a_fault_is_read_as_it_is_written() {
        for (index, (kind, name)) in FaultKind::ALL.into_iter().enumerate() {
            assert_eq!((kind as usize, kind.name()), (index, name));
            let text = format!("{name}@1.5+0.25");
            let fault: InjectedFault = text.parse().unwrap();
            assert_eq!((fault.kind, fault.to_string()), (kind, text));
        }
    }

    #[test]
    fn what_is_no_fault_is_refused_with_what_was_expected() {
        let huge = format!("no_scan@{0}+{0}", u64::MAX / 2 + 1);
        for text in [
            "",
            "no_scan",
            "no_scan@1",
            "no_sonar@1+1",
            "no_scan@-1+1",
            "no_scan@1+inf",
            "no_scan@x+1",
            &huge,
        ] {
            let error = text.parse::<InjectedFault>().unwrap_err();
            assert!(error.contains("no_scan@1.5+0.4") && error.contains("suspended"), "{error}");
        }
    }
}
