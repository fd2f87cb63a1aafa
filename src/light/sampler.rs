//! Which light a point samples.

use super::bvh::LightBvh;
use super::{Light, LightId};
use crate::math::{Bounds3, Vec3};
use crate::sampling::AliasTable;

/// Chooses one of a scene's lights, with a known probability.
#[derive(Clone, Debug)]
pub struct LightSampler(Kind);

#[derive(Clone, Debug)]
enum Kind {
    /// Nothing emits.
    None,
    /// The same for all points.
    Table(AliasTable),
    /// By position and normal.
    Bvh(LightBvh),
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
        Self::table(&vec![1.0; lights.len()])
    }

    /// In proportion to [`Light::power`].
    pub fn power(lights: &[Light], scene_bounds: &Bounds3) -> Self {
        let weights: Vec<f32> = lights.iter().map(|light| light.power(scene_bounds)).collect();
        Self::table(&weights)
    }

    /// Lights that are points only, in proportion to [`Light::power`].
    pub fn points(lights: &[Light], scene_bounds: &Bounds3) -> Self {
        let power = |light: &Light| light.position(0.0).map_or(0.0, |_| light.power(scene_bounds));
        Self::table(&lights.iter().map(power).collect::<Vec<_>>())
    }

    /// Whether it never chooses any.
    pub fn is_empty(&self) -> bool {
        matches!(self.0, Kind::None)
    }

    /// By an estimate of what arrives at the point that is lit, in a time that grows like the logarithm of their number: a
    /// light bounding volume hierarchy (Conty Estevez and Kulla 2018). Each infinite light is as likely as all others together.
    pub fn bvh(lights: &[Light], scene_bounds: &Bounds3) -> Self {
        Self(Kind::Bvh(LightBvh::new(lights, scene_bounds)))
    }

    fn table(weights: &[f32]) -> Self {
        Self(AliasTable::new(weights).map_or(Kind::None, Kind::Table))
    }

    /// Chooses by `u` in [0, 1) a light for the point `p` with the normal `n` (unit length, or zero where there is no surface;
    /// its sign does not matter). `None` if nothing that emits can reach `p`, or, of a hierarchy, nothing in the branch that `u` led
    /// to: the probabilities of all lights and of `None` add up to 1.
    #[inline]
    pub fn sample(&self, p: Vec3, n: Vec3, u: f32) -> Option<SampledLight> {
        match &self.0 {
            Kind::None => None,
            Kind::Table(table) => {
                let (index, pmf, _) = table.sample(u);
                Some(SampledLight {
                    light: LightId(index as u32),
                    pmf,
                })
            }
            Kind::Bvh(tree) => tree.sample(p, n, u),
        }
    }

    /// What [`Self::sample`] always chooses, if there is but one light.
    #[inline]
    pub fn only(&self) -> Option<SampledLight> {
        match &self.0 {
            Kind::Bvh(tree) => tree.only(),
            Kind::None | Kind::Table(_) => None,
        }
    }

    /// The probability with which [`Self::sample`] chooses `light` for the same point and normal.
    #[inline]
    pub fn pmf(&self, p: Vec3, n: Vec3, light: LightId) -> f32 {
        match &self.0 {
            Kind::None => 0.0,
            Kind::Table(table) => table.pmf(light.index()),
            Kind::Bvh(tree) => tree.pmf(p, n, light),
        }
    }
}
