//! The node as a whole: its threads, from their start to their end.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use mapless_parameters::ConfigError;
use mapless_recording::Head;
use mapless_robot::supervisor::Supervisor;
use ros2_client::NodeName;

use crate::config::{MountSource, NodeConfig};
use crate::hub::Hub;
use crate::lidar::{Lidar, LidarError};
use crate::memory;
use crate::mount::{self, MountError};
use crate::navigation::Navigation;
use crate::parameters::Parameters;
use crate::picture::Picture;
use crate::planning::Planning;
use crate::receiving::Receiving;
use crate::recorder::Recorder;
use crate::recording::record;
use crate::ros::{
    ActionServer, Alive, Entities, Heartbeat, ParameterServices, Presence, RosError, Spin, making,
    published_qos,
};
use crate::senses::Senses;
use crate::service::Service;
use crate::supervising::{CommandPublisher, supervise};
use crate::surfaces::Surfaces;

/// How often it is looked whether the node is to end.
const LOOK_EVERY: Duration = Duration::from_millis(20);
/// The last commands need this long to leave.
const LINGER: Duration = Duration::from_millis(100);

/// Why the node could not begin or go on.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The middleware.
    #[error(transparent)]
    Ros(#[from] RosError),
    /// A value of the configuration.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The LiDAR's packets cannot be taken.
    #[error(transparent)]
    Lidar(#[from] LidarError),
    /// The sensor's mount is not known.
    #[error(transparent)]
    Mount(#[from] MountError),
    /// The sensor cannot serve where tf says that it is.
    #[error("tf: {0}")]
    Sensor(String),
    /// Signals cannot be heard.
    #[error("signals: {0}")]
    Signals(#[from] std::io::Error),
    /// The middleware ended by itself: the node must be started anew.
    #[error("a thread of the middleware ended, as when the process was suspended: start the node anew")]
    MiddlewareEnded,
    /// A thread ended in a panic.
    #[error("the thread {0} panicked")]
    Panicked(&'static str),
}

/// Runs the node until SIGTERM or SIGINT. Its last commands are zero.
///
/// # Errors
/// [`RunError`] if it cannot begin, if one of its threads panicked, or if the middleware ended.
pub fn run(config: &NodeConfig) -> Result<(), RunError> {
    let signal = Arc::new(AtomicUsize::new(0));
    for number in [signal_hook::consts::SIGTERM, signal_hook::consts::SIGINT] {
        signal_hook::flag::register_usize(number, Arc::clone(&signal), 1)?;
    }
    memory::limit();
    let mut entities = Entities::join(config)?;
    let mounted;
    let config = match config.sensor_mount.source {
        MountSource::File => config,
        MountSource::Tf => {
            let is_ending = || signal.load(Ordering::Relaxed) != 0;
            let mount = mount::wait(config, &mut entities, is_ending)?;
            mounted = config.mounted(&mount).map_err(RunError::Sensor)?;
            log::info!("the sensor's mount by tf: {}", mounted.drive.planner.sensor.offset_m());
            &mounted
        }
    };
    let mut hub = Hub::new(config.use_sim_time);
    let recording = config.recording.as_ref().map(|recording| {
        let (recorder, waiting) = Recorder::new();
        hub.recorder = Some(recorder);
        let head =
            Head { began_ns: hub.began_ns(), config: config.drive.clone(), topics: config.recorded_topics() };
        (recording, head, waiting)
    });
    let hub = hub;
    let service = Service::default();
    let supervisor = Supervisor::new(config.drive.supervisor)?;
    let senses = Senses::new(config.drive.senses()?);

    let lidar = match &config.velodyne {
        Some(velodyne) => Some(Lidar::listen(velodyne, entities.waker()?, &config.drive.frames.scan)?),
        None => None,
    };
    let spin = Spin::start(&mut entities.node)?;
    let commands = CommandPublisher::new(config, &mut entities)?;
    let decisions =
        entities.publisher(&config.topics.decision, "geometry_msgs/TwistStamped", published_qos())?;
    let picture = Picture::new(config, &mut entities)?;
    let surfaces = match config.visualise {
        true => Some(Surfaces::new(config, &mut entities)?),
        false => None,
    };
    let planning = Planning::new(&config.drive, decisions, picture, surfaces)?;
    let name = NodeName::new(&config.namespace, &config.node_name).map_err(making("naming the node"))?;
    let receiving = Receiving {
        hub: &hub,
        config,
        incoming: entities.subscribe(config)?,
        actions: ActionServer::new(&config.topics.navigate_to_pose, &mut entities)?,
        parameters: Parameters::of(config),
        parameter_services: ParameterServices::new(&name, &mut entities)?,
        diagnostics: entities.publisher(
            &config.topics.diagnostics,
            "diagnostic_msgs/DiagnosticArray",
            published_qos(),
        )?,
        presence: Presence::on(&config.topics.cmd_vel, &name, commands.gid())?,
        heartbeat: Heartbeat::new(&config.topics.heartbeat, &mut entities)?,
        senses,
        navigation: Navigation::new(Duration::from_secs_f64(config.drive.navigation.timeout_s)),
        diagnosed: Duration::ZERO,
        fed_back: Duration::ZERO,
        entities: &mut entities,
    };
    let alive = Alive::watch();
    log::info!("{}/{} has begun in domain {}", config.namespace, config.node_name, config.domain_id);

    let ended = std::thread::scope(|scope| {
        let recording = recording.map(|(config, head, waiting)| {
            let hub = &hub;
            scope.spawn(move || record(hub, config, &head, waiting))
        });
        let mut threads = vec![
            ("supervisor", scope.spawn(|| supervise(&hub, supervisor, &commands, &service))),
            ("planner", scope.spawn(|| planning.run(&hub))),
            ("middleware", scope.spawn(|| receiving.run())),
        ];
        threads.extend(lidar.map(|lidar| ("LiDAR", scope.spawn(|| lidar.run(&hub)))));
        let mut is_whole = true;
        while signal.load(Ordering::Relaxed) == 0
            && is_whole
            && !threads.iter().any(|(_, thread)| thread.is_finished())
        {
            std::thread::sleep(LOOK_EVERY);
            is_whole = alive.is_whole();
        }
        hub.end();
        // Whatever became of it, the robot was driven.
        if recording.is_some_and(|recording| recording.join().is_err()) {
            log::error!("the recording panicked");
        }
        let joined = threads.into_iter();
        let joined = joined.map(|(name, thread)| thread.join().map_err(|_| RunError::Panicked(name)));
        joined.collect::<Result<(), RunError>>()?;
        if is_whole { Ok(()) } else { Err(RunError::MiddlewareEnded) }
    });
    std::thread::sleep(LINGER);
    drop(commands);
    spin.end(entities.node);
    ended
}
