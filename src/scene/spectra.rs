//! Spectra as typed to spectra as sampled: what a number means depends on where it stands.

use crate::desc::{SpectrumDesc, SpectrumValue};
use crate::spectrum::{ColorMode, CompiledSpectrum, Outside, Spectrum, SpectrumRole};

/// Makes what a description says ready for rendering in one colour mode.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpectrumCompiler {
    pub mode: ColorMode,
}

impl SpectrumCompiler {
    /// A reflectance.
    pub fn albedo(self, desc: &SpectrumDesc) -> CompiledSpectrum {
        spectrum(&desc.value, Spectrum::rgb_albedo, Outside::Constant).compile(self.mode, SpectrumRole::Reflectance)
    }

    /// The real or imaginary part of a metal's index, or a coefficient of a medium: in rgb mode each channel has its own, as seen under
    /// the white.
    pub fn unbounded(self, desc: &SpectrumDesc) -> CompiledSpectrum {
        spectrum(&desc.value, Spectrum::rgb_unbounded, Outside::Constant).compile(self.mode, SpectrumRole::Reflectance)
    }

    /// A coefficient of absorption that is known as linear sRGB.
    pub fn absorption_of_rgb(self, rgb: [f32; 3]) -> CompiledSpectrum {
        Spectrum::rgb_unbounded(rgb).compile(self.mode, SpectrumRole::Reflectance)
    }

    /// The index of refraction of a dielectric.
    pub fn glass_index(self, desc: &SpectrumDesc) -> CompiledSpectrum {
        spectrum(&desc.value, Spectrum::rgb_unbounded, Outside::Constant).compile(self.mode, SpectrumRole::Ior)
    }

    /// The emission of a light, scaled as in pbrt-v4 to unit luminance (for an rgb value: to that of its rgb); `None` is D65.
    pub fn emission(self, desc: Option<&SpectrumDesc>) -> CompiledSpectrum {
        let spectrum = match desc {
            Some(desc) => spectrum(&desc.value, Spectrum::rgb_illuminant, Outside::Zero),
            None => Spectrum::illuminant_d65(),
        };
        let photometric = spectrum.photometric();
        let scale = if photometric > 0.0 { 1.0 / photometric } else { 0.0 };
        spectrum.compile(self.mode, SpectrumRole::Emission).scaled(scale)
    }
}

fn spectrum(value: &SpectrumValue, rgb: fn([f32; 3]) -> Spectrum, outside: Outside) -> Spectrum {
    match value {
        SpectrumValue::Constant(value) => Spectrum::constant(*value),
        SpectrumValue::Rgb(value, space) => rgb(*value).in_space(*space),
        // The parser knows the names; one that is not there is black.
        SpectrumValue::Named(name) => Spectrum::named(name).unwrap_or_else(|| Spectrum::constant(0.0)),
        SpectrumValue::Samples(samples) => Spectrum::tabulated(samples.clone(), outside),
        SpectrumValue::Blackbody(kelvin) => Spectrum::blackbody(*kelvin),
    }
}
