//! What systemd is told: `Type=notify` with `WatchdogSec=1`.

use std::sync::atomic::{AtomicBool, Ordering};

use sd_notify::NotifyState;

/// The service that this process is, if systemd runs it.
#[derive(Debug, Default)]
pub(crate) struct Service {
    is_ready: AtomicBool,
}

impl Service {
    /// Feeds the watchdog; called after a command was published, and never else. The first time, the service
    /// is ready.
    pub(crate) fn fed(&self) {
        if !self.is_ready.swap(true, Ordering::Relaxed) {
            tell(&[NotifyState::Ready]);
        }
        tell(&[NotifyState::Watchdog]);
    }

    /// The service is ending.
    pub(crate) fn stopping(&self) {
        tell(&[NotifyState::Stopping]);
    }
}

fn tell(states: &[NotifyState<'_>]) {
    // Without systemd there is nobody to tell, and that is no error.
    if let Err(error) = sd_notify::notify(false, states) {
        log::warn!("systemd could not be told: {error}");
    }
}
