//! Participating media: what fills the space between surfaces, absorbs, scatters and emits.
//!
//! Coefficients are in 1 / scene units. Phase functions are densities by solid angle: light is scattered from `wi` to `wo`, both
//! leaving the point, in proportion to them, and they integrate to 1.

mod phase;

use crate::spectrum::{CompiledSpectrum, SampledSpectrum, Wavelengths};

pub use phase::HenyeyGreenstein;

/// Which medium of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MediumId(pub u32);

impl MediumId {
    /// As an index.
    #[inline]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A medium that is the same everywhere.
#[derive(Clone, Debug)]
pub struct HomogeneousMedium {
    /// What it takes from light.
    pub extinction: Extinction,
    /// The radiance that an opaque amount of it emits, were it not to scatter: emission along a ray is `sigma_a` times this.
    pub le: Option<CompiledSpectrum>,
    /// Where light is scattered to; none if it is only absorbed.
    pub phase: Option<HenyeyGreenstein>,
}

/// The two coefficients of a medium.
#[derive(Clone, Debug)]
pub enum Extinction {
    /// Each by itself.
    Parts {
        /// Of absorption.
        sigma_a: CompiledSpectrum,
        /// Of scattering.
        sigma_s: CompiledSpectrum,
    },
    /// Their sum, and how it is shared out.
    Whole {
        /// Of extinction.
        sigma_t: CompiledSpectrum,
        /// The part of scattering, in [0, 1].
        albedo: CompiledSpectrum,
    },
}

impl Extinction {
    /// Of absorption and of scattering, at the wavelengths of a path.
    #[inline]
    fn sample(&self, lambda: &Wavelengths) -> [SampledSpectrum; 2] {
        match self {
            Self::Parts { sigma_a, sigma_s } => [sigma_a.sample(lambda), sigma_s.sample(lambda)],
            Self::Whole { sigma_t, albedo } => {
                let (sigma_t, albedo) = (sigma_t.sample(lambda), albedo.sample(lambda));
                [sigma_t * albedo.map(|a| 1.0 - a), sigma_t * albedo]
            }
        }
    }

    /// Whether there is scattering at any wavelength.
    pub fn scatters(&self) -> bool {
        match self {
            Self::Parts { sigma_s, .. } => !sigma_s.is_black(),
            Self::Whole { sigma_t, albedo } => !sigma_t.is_black() && !albedo.is_black(),
        }
    }
}

impl HomogeneousMedium {
    /// What it does at the wavelengths of a path.
    #[inline]
    pub fn at(&self, lambda: &Wavelengths) -> Coefficients {
        let [sigma_a, sigma_s] = self.extinction.sample(lambda);
        Coefficients {
            sigma_a,
            sigma_s,
            sigma_t: sigma_a + sigma_s,
            le: self.le.as_ref().map_or(SampledSpectrum::ZERO, |le| le.sample(lambda)),
        }
    }
}

/// A medium at a few wavelengths.
#[derive(Clone, Copy, Debug)]
pub struct Coefficients {
    /// Of absorption.
    pub sigma_a: SampledSpectrum,
    /// Of scattering.
    pub sigma_s: SampledSpectrum,
    /// Of both: extinction.
    pub sigma_t: SampledSpectrum,
    /// See [`HomogeneousMedium::le`].
    pub le: SampledSpectrum,
}

impl Coefficients {
    /// What is left of light after `distance`, which may be infinite.
    #[inline]
    pub fn transmittance(&self, distance: f32) -> SampledSpectrum {
        // Of an infinite distance nothing would be left of 0 times it.
        self.sigma_t.map(|sigma| (-sigma * distance.min(f32::MAX)).exp())
    }

    /// The radiance that `distance` of it, which may be infinite, sends along a ray by its own emission.
    #[inline]
    pub fn emission(&self, distance: f32) -> SampledSpectrum {
        let opacity = self.sigma_t.map(|sigma| -(-sigma * distance.min(f32::MAX)).exp_m1());
        (self.le * self.sigma_a).safe_div(self.sigma_t) * opacity
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::{ColorMode, Spectrum, SpectrumRole};

    fn medium(sigma_a: f32, sigma_s: f32, le: f32) -> HomogeneousMedium {
        let spectrum = |value| Spectrum::constant(value).compile(ColorMode::Spectral, SpectrumRole::Reflectance);
        HomogeneousMedium {
            extinction: Extinction::Parts {
                sigma_a: spectrum(sigma_a),
                sigma_s: spectrum(sigma_s),
            },
            le: Some(spectrum(le)),
            phase: Some(HenyeyGreenstein { g: 0.0 }),
        }
    }

    #[test]
    fn transmittance_and_emission_are_those_of_beer_and_lambert() {
        let lambda = Wavelengths::sample_visible(0.3);
        let at = medium(0.5, 1.5, 3.0).at(&lambda);
        for lane in 0..4 {
            approx::assert_relative_eq!(at.transmittance(0.7).0[lane], (-1.4_f32).exp(), max_relative = 1e-6);
            let emitted = 0.5 * 3.0 / 2.0 * (1.0 - (-1.4_f32).exp());
            approx::assert_relative_eq!(at.emission(0.7).0[lane], emitted, max_relative = 1e-6);
            // Thin: the digits of 1 - exp(-x) are kept.
            approx::assert_relative_eq!(at.emission(1e-9).0[lane], 1.5e-9, max_relative = 1e-6);
        }
    }

    #[test]
    fn the_albedo_is_the_part_that_is_scattered() {
        let spectrum = |value| Spectrum::constant(value).compile(ColorMode::Spectral, SpectrumRole::Reflectance);
        let whole = |sigma_t, albedo| Extinction::Whole {
            sigma_t: spectrum(sigma_t),
            albedo: spectrum(albedo),
        };
        let lambda = Wavelengths::sample_visible(0.3);
        assert_eq!(whole(2.0, 0.75).sample(&lambda).map(|s| s.0), [[0.5; 4], [1.5; 4]]);
        assert!(whole(2.0, 0.75).scatters() && !whole(2.0, 0.0).scatters() && !whole(0.0, 1.0).scatters());
    }

    #[test]
    fn infinite_distances_leave_nothing_of_what_is_absorbed_and_all_of_the_rest() {
        let lambda = Wavelengths::sample_visible(0.3);
        let opaque = medium(1e-3, 0.0, 2.0).at(&lambda);
        assert_eq!(opaque.transmittance(f32::INFINITY).0, [0.0; 4]);
        assert_eq!(opaque.emission(f32::INFINITY).0, [2.0; 4]);
        let nothing = medium(0.0, 0.0, 2.0).at(&lambda);
        assert_eq!(nothing.transmittance(f32::INFINITY).0, [1.0; 4]);
        assert_eq!(nothing.emission(f32::INFINITY).0, [0.0; 4]);
    }
}
