//! The thread that follows who is on the network.

use std::thread::JoinHandle;

use ros2_client::Node;

use super::{RosError, making};

/// The spin task of a node, on a thread of its own. The node must be dropped before it is joined.
pub(crate) struct Spin {
    thread: JoinHandle<()>,
}

impl Spin {
    /// Starts it.
    pub(crate) fn start(node: &mut Node) -> Result<Self, RosError> {
        let spinner = node.spinner().map_err(making("making the spin task"))?;
        let spin = move || {
            if let Err(error) = futures::executor::block_on(spinner.spin()) {
                log::error!("the spin task ended: {error}");
            }
        };
        let thread = std::thread::Builder::new().name("spin".to_owned()).spawn(spin);
        Ok(Self { thread: thread.map_err(making("starting the spin task"))? })
    }

    /// Ends it with its node.
    pub(crate) fn end(self, node: Node) {
        drop(node);
        if self.thread.join().is_err() {
            log::error!("the spin task panicked");
        }
    }
}
