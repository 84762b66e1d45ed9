//! The `mapless` command.
fn main() {}
