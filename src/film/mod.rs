//! What light does to a picture: pixel filters, the sensor's response, and exact sums.

mod filter;
mod sensor;
mod sums;

pub use filter::{FilterKind, FilterSample, PixelFilter};
pub use sensor::Sensor;
pub(crate) use sums::lock;
pub use sums::{Film, PixelRect, TILE_SIZE, TileSums};
