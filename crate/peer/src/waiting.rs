//! Waiting for what comes over the network.

use std::time::{Duration, Instant};

/// How long to wait before asking again.
const ASK_EVERY: Duration = Duration::from_micros(200);

/// Asks again and again; the answer, if it comes in time.
pub fn until<T>(most: Duration, mut ask: impl FnMut() -> Option<T>) -> Option<T> {
    let end = Instant::now() + most;
    loop {
        match ask() {
            Some(answer) => return Some(answer),
            None if Instant::now() > end => return None,
            None => std::thread::sleep(ASK_EVERY),
        }
    }
}
