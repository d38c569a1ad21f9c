//! The command line of carom.
fn main() {}
