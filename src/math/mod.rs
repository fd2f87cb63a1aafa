//! Vectors, frames, transforms, bounds and the offsets that keep rays off the surface they leave.
//!
//! Vectors are glam's. Positions that reach a ray query are `f32`; transforms, and spheres, stay in `f64` from the parser to
//! the hit.

mod bounds;
mod frame;
mod functions;
mod lane_set;
mod lanes;
mod motion;
mod offset;
mod packing;
mod shuffle;
mod vectorize;

pub use bounds::Bounds3;
pub use frame::Frame;
pub use functions::{exp_minus, inverse_erf_of_less_one, ln, scaled_erfc};
pub use glam::{DAffine3, DMat3, DMat4, DQuat, DVec2, DVec3, Mat2, Mat3, Mat4, Quat, Vec2, Vec3, Vec4};
pub use lane_set::LaneSet;
pub use lanes::{LANES, Lanes, Vec2Lanes, Vec3Lanes, VectorLanes};
pub use motion::{AnimatedTransform, Decomposition, transform_point};
pub use offset::{gamma, offset_ray_origin};
pub(crate) use packing::columns;
pub use packing::{Append, Columns, Each, Packing};
pub use shuffle::{Column, Shuffle};
pub use vectorize::{Kernel, Vectorizer};
