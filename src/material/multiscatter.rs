//! Scattering among microfacets any number of times: a random walk over Smith's surface (Heitz, Hanika, d'Eon, Dachsbacher 2016,
//! "Multiple-Scattering Microfacet BSDFs with the Smith Model"). Nothing is lost: white facets reflect all light, those of glass
//! reflect or transmit it.
//!
//! Samples are walks that leave. Values are estimates by one walk whose numbers are a hash of the directions; the first
//! reflection is exact. The expectation is reciprocal, single values are not.
//!
//! The height of a facet is given by its rank: the fraction of facets that lie lower. A ray that moves from rank c meets the next
//! facet at rank c (1 - u)^(-1 / Lambda), and escapes if that is above 1: with probability c^Lambda. A ray below the surface is followed in the
//! point-mirrored world, where the surface has the same statistics and ranks are counted from the other end.

use super::argument_random::ArgumentRandom;
use super::conductor::reflect;
use super::{Conductor, Microfacets, fresnel_dielectric, refract};
use crate::math::{Vec2, Vec3};
use crate::spectrum::SampledSpectrum;

/// A walk that is still inside after so many facets ends: its share is far below single precision for any roughness up to 1.
const MOST_FACETS: usize = 200;
/// Walks that carry less go on by chance.
const SMALL_WEIGHT: f32 = 0.1;
const LEAST_RANK: f32 = 1e-7;

/// What facets are made of.
#[derive(Clone, Copy, Debug)]
pub(super) enum Substance<'a> {
    Metal(&'a Conductor),
    /// The index of the inside over that of the outside.
    Glass(f32),
}

/// A rough boundary.
#[derive(Clone, Copy, Debug)]
pub(super) struct RoughSurface<'a> {
    pub facets: &'a Microfacets,
    pub substance: Substance<'a>,
}

/// Where light is on its walk.
#[derive(Clone, Copy, Debug)]
struct Walk {
    /// The direction it goes in; point-mirrored if it is below the surface.
    w: Vec3,
    rank: f32,
    below: bool,
}

impl Walk {
    /// Light that comes back along `wo`.
    fn entering(wo: Vec3) -> Self {
        let below = wo.z < 0.0;
        Self {
            w: if below { wo } else { -wo },
            rank: 1.0,
            below,
        }
    }

    /// The probability that there is a next facet, and how ranks grow on the way to it.
    fn hit_probability(&self, facets: &Microfacets) -> (f32, f32) {
        let lambda = facets.signed_lambda(self.w);
        if lambda.abs() < 1e-6 {
            (0.0, lambda)
        } else if lambda > 0.0 {
            (-(lambda * self.rank.ln()).exp_m1(), lambda)
        } else {
            (1.0, lambda)
        }
    }

    /// Moves to the next facet, of those that there may be.
    fn advance(&mut self, (probability, lambda): (f32, f32), u: f32) {
        let rank = self.rank * (1.0 - u * probability).powf(-1.0 / lambda);
        self.rank = rank.clamp(LEAST_RANK, 1.0);
    }

    /// A world direction in the walk's frame, or back.
    fn frame(&self, w: Vec3) -> Vec3 {
        if self.below { -w } else { w }
    }

    fn cross(&mut self, refracted: Vec3) {
        self.w = -refracted;
        self.rank = (1.0 - self.rank).max(LEAST_RANK);
        self.below = !self.below;
    }
}

impl RoughSurface<'_> {
    /// The direction in which a walk from `wo` leaves and what it carries.
    pub fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<(Vec3, SampledSpectrum)> {
        let mut random = ArgumentRandom::of_sample(wo, u_lobe, u);
        let mut walk = Walk::entering(wo);
        let mut weight = SampledSpectrum::ONE;
        for facet in 0..MOST_FACETS {
            let hit = walk.hit_probability(self.facets);
            if random.unit() >= hit.0 {
                return Some((walk.frame(walk.w), weight));
            }
            walk.advance(hit, random.unit());
            let (u, u_lobe) = if facet == 0 {
                (u, u_lobe)
            } else {
                (random.pair(), random.unit())
            };
            self.scatter(&mut walk, &mut weight, u, u_lobe);
            survive(&mut weight, &mut random)?;
        }
        None
    }

    /// An estimate of f(wo, wi) |cos wi| for importance (no scaling of refracted radiance), less what the first facet reflects.
    pub fn estimate(&self, wo: Vec3, wi: Vec3) -> SampledSpectrum {
        let mut random = ArgumentRandom::of_directions(wo, wi);
        let mut walk = Walk::entering(wo);
        let mut weight = SampledSpectrum::ONE;
        let mut sum = SampledSpectrum::ZERO;
        for facet in 0..MOST_FACETS {
            // What the next facet sends to wi counts whether the walk gets there or not: the density of facets seen by light that
            // is about to escape is as large as its chance to meet one is small.
            let hit = walk.hit_probability(self.facets);
            if hit.0 == 0.0 {
                break;
            }
            walk.advance(hit, random.unit());
            let wi = walk.frame(wi);
            if wi.z < 0.0 {
                sum += weight * (hit.0 * self.transmitted(&walk, wi));
            } else if facet > 0 {
                sum += weight * (self.reflected(&walk, wi) * hit.0);
            }
            if random.unit() >= hit.0 {
                break;
            }
            self.scatter(&mut walk, &mut weight, random.pair(), random.unit());
            if survive(&mut weight, &mut random).is_none() {
                break;
            }
        }
        sum
    }

    /// The index across the boundary that light meets from where it is, over that on its side.
    fn eta(&self, walk: &Walk) -> f32 {
        match self.substance {
            Substance::Metal(_) => 1.0,
            Substance::Glass(eta) if walk.below => 1.0 / eta,
            Substance::Glass(eta) => eta,
        }
    }

    /// Sends light on from the facet where it is.
    fn scatter(&self, walk: &mut Walk, weight: &mut SampledSpectrum, u: Vec2, u_lobe: f32) {
        let v = -walk.w;
        let m = self.facets.sample_normal_seen_from(v, u);
        let cos = v.dot(m).max(0.0);
        match self.substance {
            Substance::Metal(metal) => {
                *weight *= metal.fresnel(cos);
                walk.w = reflect(v, m).normalize();
            }
            Substance::Glass(_) => {
                let eta = self.eta(walk);
                match refract(v, m, eta) {
                    Some((w, _)) if u_lobe >= fresnel_dielectric(cos, eta) => walk.cross(w.normalize()),
                    _ => walk.w = reflect(v, m).normalize(),
                }
            }
        }
    }

    /// Density, about `v`, of normals `m` of the facets that light meets there.
    fn normal_density(&self, v: Vec3, m: Vec3) -> f32 {
        let z = if v.z.abs() < 1e-6 { 1e-6 } else { v.z };
        let area = z * (1.0 + self.facets.signed_lambda(Vec3::new(v.x, v.y, z)));
        self.facets.d(m) * v.dot(m).max(0.0) / area
    }

    /// What the facet reflects towards `wi` (above) and is not blocked.
    fn reflected(&self, walk: &Walk, wi: Vec3) -> SampledSpectrum {
        let v = -walk.w;
        let Some(m) = (v + wi).try_normalize().filter(|m| m.z > 0.0) else {
            return SampledSpectrum::ZERO;
        };
        let cos = v.dot(m);
        if cos <= 0.0 {
            return SampledSpectrum::ZERO;
        }
        let fresnel = match self.substance {
            Substance::Metal(metal) => metal.fresnel(cos),
            Substance::Glass(_) => SampledSpectrum::splat(fresnel_dielectric(cos, self.eta(walk))),
        };
        fresnel * (self.normal_density(v, m) / (4.0 * cos) * walk.rank.powf(self.facets.signed_lambda(wi)))
    }

    /// What the facet transmits towards `wi` (below) and is not blocked on the other side.
    fn transmitted(&self, walk: &Walk, wi: Vec3) -> f32 {
        let (v, eta) = (-walk.w, self.eta(walk));
        let Some(m) = (v + wi * eta).try_normalize() else {
            return 0.0;
        };
        let m = if m.z < 0.0 { -m } else { m };
        let (cos_v, cos_i) = (v.dot(m), wi.dot(m));
        if cos_v <= 0.0 || cos_i >= 0.0 {
            return 0.0;
        }
        let jacobian = -cos_i / (cos_i + cos_v / eta).powi(2);
        let open = (1.0 - walk.rank).powf(self.facets.signed_lambda(-wi));
        (1.0 - fresnel_dielectric(cos_v, eta)) * self.normal_density(v, m) * jacobian * open
    }
}

/// Ends walks that carry little with the probability that makes up for it; `None` for the end.
fn survive(weight: &mut SampledSpectrum, random: &mut ArgumentRandom) -> Option<()> {
    let most = weight.max_value();
    if most < SMALL_WEIGHT {
        if random.unit() * SMALL_WEIGHT >= most {
            return None;
        }
        *weight *= SMALL_WEIGHT / most;
    }
    Some(())
}

/// A guess at the share of light that meets more than one facet: for densities, which need not be exact.
pub(super) fn multiple_share(facets: &Microfacets) -> f32 {
    let [x, y] = facets.alpha();
    0.02 + 0.4 * (x * y).min(1.0)
}
