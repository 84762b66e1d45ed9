//! One input that must keep coming.

use core::time::Duration;

use super::input::Message;
use super::reason::Defect;

/// How the clock of a sender is followed: the share of a change of delay that each message brings in.
const CLOCK_SHARE: i64 = 64;

/// The messages of one sensor, and when the last good one came.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stream {
    limit_s: f64,
    frozen_s: f64,
    future_s: f64,
    /// The last good message, and the stamp of the last that could be read.
    last: Option<Message>,
    seen_ns: Option<i64>,
    /// When it came, or what was taken for it.
    fresh: Option<Duration>,
    /// When the content last changed, or could not tell.
    changed: Duration,
    /// The content stood still while the robot moved, and still does.
    is_frozen: bool,
    /// How far stamps are ahead of the robot's clock, nanoseconds: the usual delay and the sender's lie.
    ahead_ns: i64,
    /// What was wrong with the last message.
    defect: Defect,
}

impl Stream {
    /// A stream of which nothing came.
    pub(crate) fn new([limit_s, frozen_s, future_s]: [f64; 3]) -> Self {
        let (changed, defect) = (Duration::ZERO, Defect::Stale);
        Self {
            limit_s,
            frozen_s,
            future_s,
            last: None,
            seen_ns: None,
            fresh: None,
            changed,
            is_frozen: false,
            ahead_ns: 0,
            defect,
        }
    }

    /// Takes a message; when it came, if it is a good one. `is_moving`: its content should change. `settles`:
    /// the robot stands without a goal, so its stamps may be anything new.
    pub(crate) fn take(
        &mut self,
        now: Duration,
        message: Message,
        is_moving: bool,
        settles: bool,
    ) -> Option<Duration> {
        let arrived = message.arrived.min(now);
        if let Err(defect) = self.check(&message, settles) {
            self.defect = defect;
            return None;
        }
        if self.last.is_none_or(|last| last.fingerprint != message.fingerprint) {
            (self.changed, self.is_frozen) = (arrived, false);
        } else if is_moving {
            self.is_frozen |= arrived.saturating_sub(self.changed).as_secs_f64() > self.frozen_s;
        } else {
            self.changed = arrived;
        }
        (self.last, self.fresh, self.defect) = (Some(message), Some(arrived), Defect::Stale);
        self.fresh
    }

    fn check(&mut self, message: &Message, settles: bool) -> Result<(), Defect> {
        if !message.is_well_formed {
            return Err(Defect::Malformed);
        }
        if self.seen_ns.replace(message.stamp_ns) == Some(message.stamp_ns) {
            return Err(Defect::Frozen);
        }
        let ahead_ns = message.stamp_ns.saturating_sub(message.clock_ns);
        let Some(last) = self.last.filter(|_| !settles) else {
            self.ahead_ns = ahead_ns;
            return Ok(());
        };
        let jump_ns = ahead_ns.saturating_sub(self.ahead_ns);
        let jump_s = jump_ns as f64 * 1e-9;
        if jump_s > self.future_s {
            return Err(Defect::Future);
        }
        if message.stamp_ns < last.stamp_ns || -jump_s > self.limit_s {
            return Err(Defect::Stale);
        }
        self.ahead_ns = self.ahead_ns.saturating_add(jump_ns / CLOCK_SHARE);
        Ok(())
    }

    /// What is wrong, once no good message came for longer than the limit.
    pub(crate) fn defect(&self, now: Duration) -> Option<Defect> {
        if self.fresh.is_none_or(|fresh| seconds_since(now, fresh) > self.limit_s) {
            return Some(self.defect);
        }
        self.is_frozen.then_some(Defect::Frozen)
    }

    /// Forgets when the last good message came: time went back. The same message again is still none.
    pub(crate) fn forget(&mut self) {
        (self.fresh, self.defect) = (None, Defect::Stale);
    }
}

/// Seconds from `then` to `now`; 0 if that is to come.
pub(crate) fn seconds_since(now: Duration, then: Duration) -> f64 {
    now.saturating_sub(then).as_secs_f64()
}
