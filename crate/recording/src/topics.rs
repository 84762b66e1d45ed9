//! Which topic is which.

use std::collections::BTreeMap;

use mcap::records::Channel;

use crate::error::Fault;

/// What a topic of a recording is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// `sensor_msgs/PointCloud2`.
    Scan,
    /// `nav_msgs/Odometry`.
    Odometry,
    /// `sensor_msgs/Imu`.
    Imu,
    /// `std_msgs/Bool`: true while the emergency stop is pressed.
    EmergencyStop,
    /// `std_msgs/Bool`: true resets a latched stop.
    Reset,
    /// `geometry_msgs/PoseStamped`: goals.
    GoalPose,
    /// `rosgraph_msgs/Clock`.
    Clock,
    /// `mapless_msgs/Goal`.
    Goal,
    /// `mapless_msgs/Tick`.
    Tick,
    /// `mapless_msgs/Answer`.
    Answer,
    /// `mapless_msgs/Spoilt`: scans that were spoilt on their way.
    Spoilt,
    /// `mapless_msgs/Config`: limits of the supervisor from now on.
    Limits,
    /// `mapless_msgs/Config`: the configuration of the planner from now on.
    Planner,
    /// `mapless_msgs/Lost`.
    Lost,
}

impl Role {
    /// Those of messages that a robot sends.
    pub const INPUTS: [Self; 7] = [
        Self::Scan,
        Self::Odometry,
        Self::Imu,
        Self::EmergencyStop,
        Self::Reset,
        Self::GoalPose,
        Self::Clock,
    ];
    /// Those without which nothing can be decided.
    pub const SENSORS: [Self; 3] = [Self::Scan, Self::Odometry, Self::Imu];
    /// Those of what was decided, and of what the node knows besides messages.
    pub const DECISIONS: [Self; 7] =
        [Self::Goal, Self::Tick, Self::Answer, Self::Spoilt, Self::Limits, Self::Planner, Self::Lost];

    /// The name by which people choose a topic for it, as in the node's file.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Scan => "scan",
            Self::Odometry => "odometry",
            Self::Imu => "imu",
            Self::EmergencyStop => "emergency_stop",
            Self::Reset => "reset",
            Self::GoalPose => "goal_pose",
            Self::Clock => "clock",
            Self::Goal => "goal",
            Self::Tick => "tick",
            Self::Answer => "answer",
            Self::Spoilt => "spoilt",
            Self::Limits => "limits",
            Self::Planner => "planner",
            Self::Lost => "lost",
        }
    }

    /// The role of a robot's messages that has this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::INPUTS.into_iter().find(|role| role.name() == name)
    }

    /// The type of its messages.
    #[must_use]
    pub fn schema(self) -> &'static str {
        match self {
            Self::Scan => "sensor_msgs/msg/PointCloud2",
            Self::Odometry => "nav_msgs/msg/Odometry",
            Self::Imu => "sensor_msgs/msg/Imu",
            Self::EmergencyStop | Self::Reset => "std_msgs/msg/Bool",
            Self::GoalPose => "geometry_msgs/msg/PoseStamped",
            Self::Clock => "rosgraph_msgs/msg/Clock",
            Self::Goal => "mapless_msgs/msg/Goal",
            Self::Tick => "mapless_msgs/msg/Tick",
            Self::Answer => "mapless_msgs/msg/Answer",
            Self::Spoilt => "mapless_msgs/msg/Spoilt",
            Self::Limits | Self::Planner => "mapless_msgs/msg/Config",
            Self::Lost => "mapless_msgs/msg/Lost",
        }
    }

    /// The end of the topic's name where several topics may have its type; `None` where the type tells.
    fn usual_end(self) -> Option<&'static str> {
        match self {
            Self::EmergencyStop => Some("emergency_stop"),
            Self::Reset => Some("mapless/reset"),
            Self::GoalPose => Some("goal_pose"),
            _ => None,
        }
    }
}

/// Topics by name, for roles whose topics are known.
pub type TopicNames = BTreeMap<Role, String>;

/// The topic that decisions of this kind are recorded on.
pub(crate) fn decision_topic(role: Role) -> String {
    format!("/mapless/recording/{}", role.name())
}

/// Finds the roles of a file's topics: those that are named, others by type.
#[derive(Clone, Debug, Default)]
pub(crate) struct Roles {
    named: TopicNames,
    found: BTreeMap<Role, String>,
    by_channel: BTreeMap<u16, Role>,
}

impl Roles {
    /// With the topics that are named already.
    pub(crate) fn new(named: TopicNames) -> Self {
        Self { named, ..Self::default() }
    }

    /// Names more topics, unless they are named already.
    pub(crate) fn name(&mut self, names: TopicNames) {
        for (role, name) in names {
            self.named.entry(role).or_insert(name);
        }
    }

    /// The role of a channel.
    pub(crate) fn of(&self, channel: u16) -> Option<Role> {
        self.by_channel.get(&channel).copied()
    }

    /// Whether a topic whose messages have the type `schema` has this role, as far as that can be told from
    /// it alone.
    pub(crate) fn may_be(&self, role: Role, topic: &str, schema: &str) -> bool {
        match self.named.get(&role) {
            Some(name) => name == topic,
            None if Role::DECISIONS.contains(&role) => topic == decision_topic(role),
            None => schema == role.schema() && role.usual_end().is_none_or(|end| topic.ends_with(end)),
        }
    }

    /// Takes a channel whose messages have the type `schema`.
    pub(crate) fn take(&mut self, channel: &Channel, schema: &str) -> Result<(), Fault> {
        for role in Role::INPUTS.into_iter().chain(Role::DECISIONS) {
            if !self.may_be(role, &channel.topic, schema) {
                continue;
            }
            if schema != role.schema() || channel.message_encoding != "cdr" {
                return Err(Fault::Type {
                    topic: channel.topic.clone(),
                    found: format!("{schema} in {}", channel.message_encoding),
                    expected: role.schema(),
                });
            }
            match self.found.get(&role) {
                Some(first) if *first != channel.topic => {
                    return Err(Fault::Ambiguous {
                        role: role.name(),
                        schema: role.schema(),
                        first: first.clone(),
                        second: channel.topic.clone(),
                    });
                }
                _ => {
                    self.found.insert(role, channel.topic.clone());
                    self.by_channel.insert(channel.id, role);
                }
            }
        }
        Ok(())
    }

    /// Those that have a topic.
    pub(crate) fn found(&self) -> &BTreeMap<Role, String> {
        &self.found
    }

    /// Those that were named and have no topic in the file.
    pub(crate) fn missing(&self) -> impl Iterator<Item = (&Role, &String)> {
        self.named.iter().filter(|(role, _)| !self.found.contains_key(role))
    }
}
