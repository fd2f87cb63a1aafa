//! Integrators against one another: `path` in all its ways against the oracle `kajiya`, and the oracle against closed forms. That
//! these tests can fail is shown by mistakes made on purpose.

#[path = "../common/mod.rs"]
mod common;

mod faults;
mod kajiya;
mod path;
mod stage;
