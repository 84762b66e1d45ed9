//! What systemd is told: `Type=notify` with `WatchdogSec=1`.

use std::sync::atomic::{AtomicBool, Ordering};

/// The service that this process is, if systemd runs it.
#[derive(Debug, Default)]
pub(crate) struct Service {
    is_ready: AtomicBool,
}

impl Service {
    /// Feeds the watchdog; called after a command was published and the node heard itself, and never else.
    /// The first time, the service is ready.
    pub(crate) fn fed(&self) {
        if !self.is_ready.swap(true, Ordering::Relaxed) {
            tell(Told::Ready);
        }
        tell(Told::Watchdog);
    }

    /// The service is ending.
    pub(crate) fn stopping(&self) {
        tell(Told::Stopping);
    }
}

enum Told {
    Ready,
    Watchdog,
    Stopping,
}

#[cfg(unix)]
fn tell(what: Told) {
    let state = match what {
        Told::Ready => sd_notify::NotifyState::Ready,
        Told::Watchdog => sd_notify::NotifyState::Watchdog,
        Told::Stopping => sd_notify::NotifyState::Stopping,
    };
    // Without systemd there is nobody to tell, and that is no error.
    if let Err(error) = sd_notify::notify(false, &[state]) {
        log::warn!("systemd could not be told: {error}");
    }
}

#[cfg(not(unix))]
fn tell(_: Told) {}
