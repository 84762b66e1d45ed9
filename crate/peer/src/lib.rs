//! What stands for the robot and for the people around [`mapless_node`] on the network, in tests and in
//! simulations: a node, its topics, and a client of `NavigateToPose`.

mod navigation;
mod topics;

use std::time::{Duration, Instant};

use anyhow::anyhow;
use ros2_client::{Context, ContextOptions, Node, NodeName, NodeOptions};

pub use navigation::{NavigateClient, goal, navigate_client, send};
pub use topics::{publisher, subscription};

/// The namespace of the sample files.
pub const NAMESPACE: &str = "/a200_0000";
/// How long to wait before asking again.
const ASK_EVERY: Duration = Duration::from_micros(200);

/// A node in [`NAMESPACE`], with its spin task on a thread of its own.
///
/// # Errors
/// Those of the middleware.
pub fn join(domain_id: u16, name: &str) -> anyhow::Result<Node> {
    let context =
        Context::with_options(ContextOptions::new().domain_id(domain_id)).map_err(making("the domain"))?;
    let full = NodeName::new(NAMESPACE, name).map_err(making(name))?;
    let options = NodeOptions::new().enable_rosout(false).start_parameter_services(false);
    let mut node = context.new_node(full, options).map_err(making(name))?;
    let spinner = node.spinner().map_err(making(name))?;
    // It ends with its node, and there is nobody to tell how.
    std::thread::spawn(move || futures::executor::block_on(spinner.spin()));
    Ok(node)
}

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

/// Names what an error of the middleware is about.
fn making<E: std::fmt::Display>(what: &str) -> impl FnOnce(E) -> anyhow::Error {
    move |error| anyhow!("{what}: {error}")
}
