//! What light does to a picture: pixel filters, the sensor's response, and exact sums.

mod filter;
mod sensor;
mod splats;
mod sums;

pub use crate::desc::{FilterKind, PixelRect};
pub use filter::{FilterSample, PixelFilter};
pub use sensor::{Sensor, SensorSpec};
pub use splats::Splat;
pub(crate) use sums::lock;
pub use sums::{Film, TILE_SIZE, TileSums};
