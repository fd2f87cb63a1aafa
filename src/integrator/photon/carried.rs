//! What photons and camera paths of one pass bring together, where a dispersive surface may have ended the secondary wavelengths of
//! either.
//!
//! All paths of a pass have the same wavelengths, whose densities stay as they were drawn: where only the hero is left, its value
//! stands for all and counts as many times as there are wavelengths, once, whether the photon met dispersion, the camera path, or both.

use crate::spectrum::{LANES, SampledSpectrum};

/// A sum of spectral values, of which some are good for the hero only.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Carried {
    /// Of photons with all wavelengths.
    all: SampledSpectrum,
    /// At the hero's wavelength, of photons that have no other.
    hero: f32,
}

impl Carried {
    /// Adds what a photon brings.
    #[inline]
    pub fn add(&mut self, value: SampledSpectrum, hero_only: bool) {
        if hero_only {
            self.hero += value.0[0];
        } else {
            self.all += value;
        }
    }

    /// The sum times `factor`.
    #[inline]
    #[must_use]
    pub fn scaled(self, factor: f32) -> Self {
        Self {
            all: self.all * factor,
            hero: self.hero * factor,
        }
    }

    /// The sum as a path sees it, of which only the hero may be left.
    #[inline]
    pub fn seen(&self, factor: SampledSpectrum, hero_only: bool) -> SampledSpectrum {
        let hero = alone(self.hero * factor.0[0]);
        hero + carried(self.all * factor, hero_only)
    }
}

/// A value, as a path brings it of which only the hero may be left.
#[inline]
pub(super) fn carried(value: SampledSpectrum, hero_only: bool) -> SampledSpectrum {
    if hero_only { alone(value.0[0]) } else { value }
}

/// The value of a hero that stands for all wavelengths.
#[inline]
fn alone(hero: f32) -> SampledSpectrum {
    SampledSpectrum([LANES as f32 * hero, 0.0, 0.0, 0.0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lone_hero_counts_once_for_all() {
        let value = SampledSpectrum([1.0, 2.0, 3.0, 4.0]);
        let half = SampledSpectrum([0.5; 4]);
        let mut sum = Carried::default();
        sum.add(value, false);
        sum.add(value, true);
        assert_eq!(sum.seen(half, false).0, [2.5, 1.0, 1.5, 2.0]);
        assert_eq!(sum.seen(half, true).0, [4.0, 0.0, 0.0, 0.0]);
        assert_eq!(sum.scaled(2.0).seen(half, true).0, [8.0, 0.0, 0.0, 0.0]);
    }
}
