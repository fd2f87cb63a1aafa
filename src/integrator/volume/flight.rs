//! Flights through media: how far a path goes, and what that does to its throughput.
//!
//! One wavelength of a path, the decider, says where it collides. All of them are carried on, each with its own transmittance, and are
//! weighed by multiple importance sampling over who might have been the decider (Wilkie et al. 2014, "Hero Wavelength Spectral
//! Sampling"; Miller, Georgiev and Jarosz 2019, "A null-scattering path integral formulation of light transport"): a path's value is
//! divided by the mean density over all of them.

use crate::medium::{Coefficients, HomogeneousMedium};
use crate::spectrum::{ColorMode, SampledSpectrum, Wavelengths};

/// Who decides on the flights of a path, and how likely these were had it been another.
#[derive(Clone, Copy, Debug)]
pub(in crate::integrator) struct Chances {
    /// The lane that decides.
    decider: u8,
    /// So many lanes, the first ones, might have been it.
    candidates: u8,
    /// The density of the path's flights if each lane had decided, relative to the mean of the candidates'.
    relative: SampledSpectrum,
    /// The mean probability of having flown as far as from the last scattering event.
    passed: f32,
}

impl Chances {
    /// Of a path that begins. `u` in [0, 1) chooses among red, green and blue; of wavelengths, any may be the hero, which decides.
    pub fn start(color: ColorMode, lambda: &Wavelengths, u: f32) -> Self {
        let (decider, candidates) = match color {
            ColorMode::Rgb => ((3.0 * u) as u8, 3),
            ColorMode::Spectral if lambda.secondary_terminated() => (0, 1),
            ColorMode::Spectral => (0, 4),
        };
        Self {
            decider,
            candidates,
            relative: SampledSpectrum::ONE,
            passed: 1.0,
        }
    }

    /// What happens next has the density `densities` by who decides: their mean, which is to be divided by.
    #[inline]
    fn meet(&mut self, densities: SampledSpectrum) -> f32 {
        let mean = self.mean(densities);
        if mean > 0.0 {
            self.relative = self.relative * densities * (1.0 / mean);
        }
        mean
    }

    /// The mean of the densities by who decides, of something that may happen next.
    #[inline]
    pub fn mean(&self, densities: SampledSpectrum) -> f32 {
        let candidates = usize::from(self.candidates);
        let joint = self.relative * densities;
        joint.0[..candidates].iter().sum::<f32>() / candidates as f32
    }

    /// Passes `distance` of a medium, which may be infinite, without a collision: what is left of light that goes there in each lane, and
    /// the mean probability of passing.
    #[inline]
    pub fn pass(&mut self, medium: &HomogeneousMedium, at: &Coefficients, distance: f32) -> (SampledSpectrum, f32) {
        let transmittance = at.transmittance(distance);
        // Where there are no collisions light is only absorbed.
        let mean = if medium.phase.is_some() {
            self.meet(transmittance)
        } else {
            1.0
        };
        self.passed *= mean;
        (transmittance, mean)
    }

    /// The mean probability of having passed the media since the last scattering event.
    #[inline]
    pub fn passed(&self) -> f32 {
        self.passed
    }

    /// A scattering event has taken place.
    #[inline]
    pub fn scattered(&mut self) {
        self.passed = 1.0;
    }
}

/// A path on its way from one scattering event to the next.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flight {
    pub chances: Chances,
    /// The optical depth, by the decider, that is left to the next collision; none before it is drawn. It holds across boundaries of
    /// media, so that one number does for a flight.
    left: Option<f32>,
}

/// A collision that scatters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Collision {
    /// The distance.
    pub t: f32,
    /// Of the throughput.
    pub factor: SampledSpectrum,
    /// Its density by distance: the mean by who might decide.
    pub density: f32,
}

/// Where a flight through one medium has ended.
pub(super) enum Arrival {
    /// At the end of it; the factor of the throughput.
    Through(SampledSpectrum),
    /// In a collision that scatters.
    Collision(Collision),
}

impl Flight {
    pub fn start(chances: Chances) -> Self {
        Self { chances, left: None }
    }

    /// The path from its next scattering event on.
    pub fn scattered(mut self) -> Self {
        self.chances.scattered();
        self.left = None;
        self
    }

    /// Flies through `medium`, which ends at `distance` (which may be infinite). `u` in [0, 1) says how far, if that has not been drawn.
    #[inline]
    pub fn fly(&mut self, medium: &HomogeneousMedium, at: &Coefficients, distance: f32, u: f32) -> Arrival {
        let chances = &mut self.chances;
        if medium.phase.is_some() {
            let left = *self.left.get_or_insert_with(|| -(-u).ln_1p());
            let sigma = at.sigma_t.0[usize::from(chances.decider)];
            if left < sigma * distance.min(f32::MAX) {
                let t = left / sigma;
                let transmittance = at.transmittance(t);
                let mean = chances.meet(at.sigma_t * transmittance);
                return Arrival::Collision(Collision {
                    t,
                    factor: at.sigma_s * transmittance * mean.recip(),
                    density: mean,
                });
            }
            self.left = Some(left - sigma * distance.min(f32::MAX));
        }
        let (transmittance, mean) = chances.pass(medium, at, distance);
        Arrival::Through(if mean > 0.0 {
            transmittance * mean.recip()
        } else {
            SampledSpectrum::ZERO
        })
    }
}
