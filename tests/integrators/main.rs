//! Integrators against one another: `path` in all its ways against the oracle `kajiya`, and the oracle against closed forms. That
//! these tests can fail is shown by mistakes made on purpose.

#[path = "../common/mod.rs"]
mod common;

mod bdpt;
mod covering;
mod faults;
mod kajiya;
mod lamps;
mod path;
mod stage;
mod strategies;
mod surfaces;
mod together;
