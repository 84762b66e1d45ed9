//! A node that joins the others.

use ros2_client::{Context, ContextOptions, Node, NodeName, NodeOptions};

use crate::error::making;

/// The namespace of the sample files.
pub const NAMESPACE: &str = "/a200_0000";

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
