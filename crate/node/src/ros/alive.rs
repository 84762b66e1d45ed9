//! Whether the middleware's own threads live.

use std::fs;

/// How RustDDS names its threads.
const PREFIX: &str = "RustDDS";

/// Watches the threads that RustDDS has started. They end for good when a poll is interrupted, as by SIGSTOP
/// and SIGCONT (RustDDS 0.15.1); from then on nothing is received, and what is published is lost silently.
pub(crate) struct Alive {
    threads: usize,
}

impl Alive {
    /// Watches those that run now.
    pub(crate) fn watch() -> Self {
        Self { threads: running() }
    }

    /// Whether all of them still run.
    pub(crate) fn is_whole(&self) -> bool {
        running() >= self.threads
    }
}

/// Threads of RustDDS in this process; 0 where the system does not tell.
fn running() -> usize {
    let Ok(threads) = fs::read_dir("/proc/self/task") else { return 0 };
    let names = threads.flatten().filter_map(|thread| fs::read_to_string(thread.path().join("comm")).ok());
    names.filter(|name| name.starts_with(PREFIX)).count()
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;
    use std::sync::mpsc::channel;

    #[test]
    fn a_thread_that_ended_is_noticed() {
        let (end, ended) = channel::<()>();
        let (begin, begun) = channel::<()>();
        let thread = std::thread::Builder::new().name("RustDDS test".to_owned()).spawn(move || {
            begin.send(()).unwrap();
            let _ = ended.recv();
        });
        begun.recv().unwrap();
        let alive = Alive::watch();
        assert!(alive.threads > 0 && alive.is_whole());
        drop(end);
        thread.unwrap().join().unwrap();
        // The system may list it for a moment longer.
        let is_noticed = (0..200).any(|_| {
            std::thread::sleep(std::time::Duration::from_millis(10));
            !alive.is_whole()
        });
        assert!(is_noticed);
    }
}
