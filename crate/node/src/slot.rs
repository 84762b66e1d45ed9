//! A mailbox that holds one thing: the newest wins.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// A mailbox between two threads.
#[derive(Debug)]
pub(crate) struct Slot<T> {
    held: Mutex<Option<T>>,
    filled: Condvar,
}

impl<T> Default for Slot<T> {
    fn default() -> Self {
        Self { held: Mutex::new(None), filled: Condvar::new() }
    }
}

impl<T> Slot<T> {
    /// Puts a thing in; what had not been taken is given back.
    pub(crate) fn put(&self, thing: T) -> Option<T> {
        let displaced = lock(&self.held).replace(thing);
        self.filled.notify_one();
        displaced
    }

    /// Takes what is there, waiting for it at most this long.
    pub(crate) fn take(&self, most: Duration) -> Option<T> {
        let held = lock(&self.held);
        let waited = self.filled.wait_timeout_while(held, most, |held| held.is_none());
        waited.unwrap_or_else(PoisonError::into_inner).0.take()
    }
}

/// Locks a mutex that is held for moments only. A panic elsewhere leaves nothing half done behind it.
pub(crate) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_wins_and_is_taken_once() {
        let slot = Slot::default();
        assert_eq!(slot.put(1), None);
        assert_eq!(slot.put(2), Some(1));
        assert_eq!(slot.take(Duration::ZERO), Some(2));
        assert_eq!(slot.take(Duration::from_millis(1)), None);
    }

    #[test]
    fn who_waits_is_woken() {
        let slot = Slot::default();
        std::thread::scope(|scope| {
            scope.spawn(|| slot.put(7));
            assert_eq!(slot.take(Duration::from_secs(60)), Some(7));
        });
    }
}
