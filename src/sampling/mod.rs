//! Random numbers and what is made of them: samplers, warps, discrete distributions, densities and their measures.

pub mod distribution;
pub mod hash;
mod measure;
pub mod mis;
mod sampler;
mod sobol;
pub mod warp;

pub use distribution::{AliasTable, PiecewiseConstant1D};
pub use measure::{AreaPdf, SolidAnglePdf};
pub use mis::{balance_heuristic, power_heuristic};
pub use sampler::{SampleStream, Sampler, SamplerKind};

/// The largest number below one.
pub(crate) const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;
