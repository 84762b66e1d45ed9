//! What stands for the robot and for the people around [`mapless_node`] on the network, in tests and in
//! simulations: a node, its topics, and a client of `NavigateToPose`.

mod error;
mod navigation;
mod node;
mod topics;
mod waiting;

pub use navigation::{NavigateClient, goal, navigate_client, send};
pub use node::{NAMESPACE, join};
pub use topics::{publisher, subscription};
pub use waiting::until;
