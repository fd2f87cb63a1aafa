//! Wavelengths and what depends on them.
mod sampled;
mod wavelengths;
pub use sampled::{LANES, SampledSpectrum};
pub use wavelengths::{LAMBDA_D, LAMBDA_MAX, LAMBDA_MIN, Wavelengths};
