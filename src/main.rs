//! The `lucerna` command.

fn main() {}
