//! Photon mapping.

mod kd_tree;

#[doc(hidden)]
pub use kd_tree::{KdTree, Nearest};
