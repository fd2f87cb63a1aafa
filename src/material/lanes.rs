//! Lobes for the eight lanes of a packet, as kernels evaluate and sample them: by the functions that single ones are made of.

use super::lobe::{LaneSample, LaneValue};
use super::{Conductor, Distribution, LocalValue, Microfacets};
use crate::math::{Lanes, Vec2, Vec3};
use crate::spectrum::{SampledSpectrum, SpectrumLanes};

/// A conductor that reflects once, and what its reflection is multiplied by.
#[derive(Clone, Copy, Debug)]
pub struct TintedConductor {
    pub(super) conductor: Conductor,
    pub(super) tint: SampledSpectrum,
}

impl TintedConductor {
    /// How its facets are distributed; `None` if it is smooth.
    #[inline]
    pub fn distribution(&self) -> Option<Distribution> {
        self.conductor.facets().map(Microfacets::distribution)
    }

    /// Whether it matters which way the tangent points.
    #[inline]
    pub fn is_anisotropic(&self) -> bool {
        self.conductor.facets().is_some_and(|facets| !facets.is_isotropic())
    }
}

/// A [`TintedConductor`] in each lane.
#[derive(Clone, Debug, Default)]
pub struct ConductorLanes {
    eta: SpectrumLanes,
    k: SpectrumLanes,
    tint: SpectrumLanes,
    alpha_x: Lanes,
    alpha_y: Lanes,
    separable: [bool; crate::math::LANES],
}

impl ConductorLanes {
    /// Puts a conductor into a lane.
    #[inline]
    pub fn set(&mut self, lane: usize, conductor: &TintedConductor) {
        let (eta, k) = conductor.conductor.index();
        self.eta.set(lane, eta);
        self.k.set(lane, k);
        self.tint.set(lane, conductor.tint);
        if let Some(facets) = conductor.conductor.facets() {
            [self.alpha_x[lane], self.alpha_y[lane]] = facets.alpha();
            self.separable[lane] = facets.is_separable();
        }
    }

    #[inline(always)]
    fn conductor(&self, lane: usize) -> Conductor {
        Conductor::new(self.eta.get(lane), self.k.get(lane), None)
    }

    #[inline(always)]
    fn facets(&self, lane: usize, distribution: Distribution) -> Microfacets {
        let alpha = [self.alpha_x[lane], self.alpha_y[lane]];
        Microfacets::of(distribution, alpha, self.separable[lane])
    }

    /// [`Tinted::eval`](super::Tinted::eval) of a lane whose facets have this distribution.
    #[inline(always)]
    pub fn eval(&self, lane: usize, distribution: Distribution, wo: Vec3, wi: Vec3) -> LaneValue {
        let facets = self.facets(lane, distribution);
        let LaneValue { value, exists } = self.conductor(lane).eval_once(&facets, wo, wi);
        LaneValue {
            value: self.tinted(lane, value),
            exists,
        }
    }

    /// [`Tinted::sample_f`](super::Tinted::sample_f) of a lane whose facets have this distribution.
    #[inline(always)]
    pub fn sample(&self, lane: usize, distribution: Distribution, wo: Vec3, u: Vec2) -> LaneSample {
        let facets = self.facets(lane, distribution);
        let LaneSample { wi, value, exists } = self.conductor(lane).sample_once(&facets, wo, u);
        LaneSample {
            wi,
            value: self.tinted(lane, value),
            exists,
        }
    }

    /// The direction that a smooth one in a lane reflects `wo` in, and how much of it.
    #[inline(always)]
    pub fn mirror(&self, lane: usize, wo: Vec3) -> (Vec3, SampledSpectrum) {
        let (wi, value) = self.conductor(lane).mirror(wo);
        (wi, value * self.tint.get(lane))
    }

    #[inline(always)]
    fn tinted(&self, lane: usize, value: LocalValue) -> LocalValue {
        LocalValue {
            f: value.f * self.tint.get(lane),
            pdf: value.pdf,
        }
    }
}
