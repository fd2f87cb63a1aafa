//! Which light a shading point samples.

use super::{Light, LightId};
use crate::math::Bounds3;
use crate::sampling::AliasTable;

/// Chooses one of a scene's lights, with a known probability.
#[derive(Clone, Debug)]
pub struct LightSampler {
    /// `None` without a light that emits.
    table: Option<AliasTable>,
}

/// A light, chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledLight {
    /// Which.
    pub light: LightId,
    /// Its probability, positive.
    pub pmf: f32,
}

impl LightSampler {
    /// All lights alike.
    pub fn uniform(lights: &[Light]) -> Self {
        Self {
            table: AliasTable::new(&vec![1.0; lights.len()]),
        }
    }

    /// In proportion to [`Light::power`].
    pub fn power(lights: &[Light], scene_bounds: &Bounds3) -> Self {
        let weights: Vec<f32> = lights.iter().map(|light| light.power(scene_bounds)).collect();
        Self {
            table: AliasTable::new(&weights),
        }
    }

    /// Chooses by `u` in [0, 1); `None` if nothing emits.
    #[inline]
    pub fn sample(&self, u: f32) -> Option<SampledLight> {
        let (index, pmf, _) = self.table.as_ref()?.sample(u);
        Some(SampledLight {
            light: LightId(index as u32),
            pmf,
        })
    }

    /// The probability of `light`.
    #[inline]
    pub fn pmf(&self, light: LightId) -> f32 {
        self.table.as_ref().map_or(0.0, |table| table.pmf(light.index()))
    }
}
