//! Random numbers and what is made of them, against what they promise.

#[path = "../common/mod.rs"]
mod common;

mod points;
mod samplers;
mod warps;
