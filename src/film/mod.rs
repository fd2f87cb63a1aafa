//! What light does to a picture: pixel filters, the sensor's response, and exact sums.

mod bins;
mod filter;
mod gbuffer;
mod layers;
mod sample_lanes;
mod sensor;
mod splats;
mod sums;

pub use crate::desc::{FilterKind, PixelRect};
pub use filter::{FilterLanes, FilterSample, PixelFilter};
pub use gbuffer::{GBUFFER_CHANNELS, SurfaceSample};
pub use layers::LayerSample;
pub use sample_lanes::SampleLanes;
pub use sensor::{LinearSensor, Sensor, SensorSpec};
pub use splats::Splat;
pub(crate) use sums::lock;
pub use sums::{Film, TILE_SIZE, TileSums};
