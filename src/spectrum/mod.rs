//! Wavelengths and what depends on them: sampled values, spectra as scenes describe them and as rendering samples them, and
//! the CIE 1931 observer.
//!
//! Radiometry is that of pbrt-v4: a path carries four wavelengths ([`Wavelengths`]), the film turns its radiance into XYZ,
//! rgb colours become spectra by the sigmoid polynomials of Jakob and Hanika (2019). In rgb mode ([`ColorMode::Rgb`]) the
//! same code runs with the lanes R, G, B and a zero.

pub mod cie;
mod color_space;
mod compiled;
mod description;
mod lanes;
mod named;
mod rgb;
mod rgb2spec;
mod rgb_emission;
mod sampled;
mod sensors;
mod table;
#[expect(dead_code, reason = "the table of sRGB is made by the build script")]
mod table_builder;
mod wavelengths;

pub use color_space::ColorSpace;
pub use compiled::CompiledSpectrum;
pub use description::{Outside, Spectrum};
pub use lanes::SpectrumLanes;
pub use named::named_spectra;
pub use rgb::{RgbKind, RgbSampler};
pub use rgb_emission::{EmissionPixel, RgbEmission};
pub use sampled::{LANES, SampledSpectrum};
pub use sensors::{ResponseTable, color_checker, daylight, sensor_curves, sensor_names};
pub use wavelengths::{LAMBDA_D, LAMBDA_MAX, LAMBDA_MIN, Wavelengths};

/// What the four lanes of a path are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorMode {
    /// Four wavelengths, drawn anew for each path.
    #[default]
    Spectral,
    /// Linear sRGB and a zero.
    Rgb,
}

/// What a spectrum stands for, which decides how rgb mode projects it (see [`Spectrum::compile`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpectrumRole {
    /// A factor that light is multiplied by: reflectance, transmittance, a coefficient of a medium; also eta and k of a
    /// metal, whose colour comes from their change over wavelength.
    Reflectance,
    /// Radiance, intensity or irradiance.
    Emission,
    /// The refractive index of a dielectric.
    Ior,
}
