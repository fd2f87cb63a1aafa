//! Random numbers and what is made of them: samplers, warps, discrete distributions, densities and their measures.

mod cells;
pub mod distribution;
mod halton;
pub mod hash;
mod measure;
pub mod mis;
mod permutation;
mod sampler;
mod sobol;
mod sphere_map;
mod stratified;
mod stream_lanes;
pub mod warp;
mod windowed;
mod zsobol;

pub use cells::{Cell, CellDistribution};
pub use distribution::{AliasTable, PiecewiseConstant1D};
pub use measure::{AreaPdf, SolidAnglePdf};
pub use mis::{balance_heuristic, power_heuristic};
pub use sampler::{SampleStream, Sampler, SamplerKind};
pub use sphere_map::SphereMap;
pub use stratified::Strata;
pub use stream_lanes::StreamLanes;
pub use windowed::WindowedDistribution;

/// The largest number below one.
pub(crate) const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;
