//! The ray query backends: that they agree with an f64 judge and with each other, that closed meshes let nothing out, and that
//! the contract of [`lucerna::accel::Accel`] holds.

mod agreement;
mod rays;
mod rng;
mod worlds;
