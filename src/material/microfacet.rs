//! Distributions of microfacet normals, anisotropic GGX and Beckmann, with Smith's masking (Walter et al. 2007; Heitz 2014).

use std::f32::consts::PI;

use super::{SPECULAR_ALPHA, beckmann};
use crate::math::{Vec2, Vec3, exp_minus};
use crate::sampling::warp;

/// The shapes of distributions there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Distribution {
    /// Ellipsoids, with long tails (Trowbridge and Reitz 1975); pbrt's.
    #[default]
    Ggx,
    /// Gaussian slopes (Beckmann and Spizzichino 1963).
    Beckmann,
}

/// Microfacets of a given distribution and roughness; all directions are local.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Microfacets {
    distribution: Distribution,
    alpha_x: f32,
    alpha_y: f32,
    /// Whether masking and shadowing are independent.
    separable: bool,
}

impl Microfacets {
    /// Below this both ways a surface counts as smooth, as in pbrt-v4.
    const SMOOTH: f32 = 1e-3;
    /// A surface rough in one direction only keeps at least this in the other.
    const LEAST_ALPHA: f32 = 1e-4;

    /// With slopes `alpha_x` and `alpha_y` (not negative) along the two tangents; `None` if it is effectively smooth.
    #[inline]
    pub fn new(distribution: Distribution, alpha_x: f32, alpha_y: f32) -> Option<Self> {
        if alpha_x.max(alpha_y) < Self::SMOOTH {
            return None;
        }
        Some(Self {
            distribution,
            alpha_x: alpha_x.max(Self::LEAST_ALPHA),
            alpha_y: alpha_y.max(Self::LEAST_ALPHA),
            separable: false,
        })
    }

    /// With slopes that [`Self::new`] has given.
    #[inline(always)]
    pub(super) fn of(distribution: Distribution, [alpha_x, alpha_y]: [f32; 2], separable: bool) -> Self {
        Self {
            distribution,
            alpha_x,
            alpha_y,
            separable,
        }
    }

    /// How they are distributed.
    #[inline]
    pub fn distribution(&self) -> Distribution {
        self.distribution
    }

    /// See [`Self::with_separable_masking`].
    #[inline]
    pub fn is_separable(&self) -> bool {
        self.separable
    }

    /// These facets, masked and shadowed independently as in Mitsuba, or not: then by their heights, as in pbrt-v4.
    #[must_use]
    pub fn with_separable_masking(self, separable: bool) -> Self {
        Self { separable, ..self }
    }

    /// [`Microfacets::new`] for GGX.
    #[inline]
    pub fn ggx(alpha_x: f32, alpha_y: f32) -> Option<Self> {
        Self::new(Distribution::Ggx, alpha_x, alpha_y)
    }

    /// [`Microfacets::ggx`], where less than a slope of 0.002 is that much.
    pub fn never_smooth(alpha_x: f32, alpha_y: f32) -> Self {
        Self {
            distribution: Distribution::Ggx,
            alpha_x: alpha_x.max(2.0 * Self::SMOOTH),
            alpha_y: alpha_y.max(2.0 * Self::SMOOTH),
            separable: false,
        }
    }

    /// Whether it is the same along both tangents.
    #[inline]
    pub fn is_isotropic(&self) -> bool {
        self.alpha_x == self.alpha_y
    }

    /// The slope for pbrt-v4's perceptual roughness.
    #[inline]
    pub fn alpha_from_roughness(roughness: f32) -> f32 {
        roughness.sqrt()
    }

    /// See [`super::Bsdf::is_specular`].
    pub fn is_specular(&self) -> bool {
        self.alpha_x.max(self.alpha_y) <= SPECULAR_ALPHA
    }

    /// The slopes along the two tangents.
    pub fn alpha(&self) -> [f32; 2] {
        [self.alpha_x, self.alpha_y]
    }

    /// Density of microfacet area by solid angle of its normal `m`, which has z >= 0.
    #[inline(always)]
    pub fn d(&self, m: Vec3) -> f32 {
        let (x, y) = (m.x / self.alpha_x, m.y / self.alpha_y);
        match self.distribution {
            // Heitz 2014, equation 85, without dividing by a cosine that may be 0.
            Distribution::Ggx => {
                let e = x * x + y * y + m.z * m.z;
                1.0 / (PI * self.alpha_x * self.alpha_y * e * e)
            }
            Distribution::Beckmann => {
                let z2 = m.z * m.z;
                let slope2 = (x * x + y * y) / z2;
                // Also where a grazing normal makes the slope infinite.
                if slope2 < 80.0 {
                    exp_minus(slope2) / (PI * self.alpha_x * self.alpha_y * z2 * z2)
                } else {
                    0.0
                }
            }
        }
    }

    /// Smith's Lambda, of a direction that goes up or down. It is one formula: Lambda(-w) = -1 - Lambda(w).
    #[inline(always)]
    pub(super) fn signed_lambda(&self, w: Vec3) -> f32 {
        let (x, y) = (self.alpha_x * w.x, self.alpha_y * w.y);
        let across2 = x * x + y * y;
        match self.distribution {
            Distribution::Ggx => {
                let lambda = 0.5 * ((1.0 + across2 / (w.z * w.z)).sqrt().copysign(w.z) - 1.0);
                if w.z == 0.0 { f32::INFINITY } else { lambda }
            }
            // Straight up and down are infinite.
            Distribution::Beckmann => beckmann::lambda(w.z / across2.sqrt()),
        }
    }

    /// Smith's Lambda, the same for either side.
    #[inline(always)]
    pub fn lambda(&self, w: Vec3) -> f32 {
        match self.distribution {
            Distribution::Ggx => {
                let z2 = w.z * w.z;
                let (x, y) = (self.alpha_x * w.x, self.alpha_y * w.y);
                let lambda = 0.5 * ((1.0 + (x * x + y * y) / z2).sqrt() - 1.0);
                if z2 == 0.0 { f32::INFINITY } else { lambda }
            }
            Distribution::Beckmann => self.signed_lambda(Vec3::new(w.x, w.y, w.z.abs())),
        }
    }

    /// Fraction of microfacets not masked from `w`.
    #[inline(always)]
    pub fn g1(&self, w: Vec3) -> f32 {
        1.0 / (1.0 + self.lambda(w))
    }

    /// Fraction masked neither from `wo` nor from `wi`, with correlated heights or independently.
    #[inline(always)]
    pub fn g(&self, wo: Vec3, wi: Vec3) -> f32 {
        let (lambda_o, lambda_i) = (self.lambda(wo), self.lambda(wi));
        let separate = (1.0 / (1.0 + lambda_o)) * (1.0 / (1.0 + lambda_i));
        let correlated = 1.0 / (1.0 + lambda_o + lambda_i);
        if self.separable { separate } else { correlated }
    }

    /// Density of the normals visible from `w`, by solid angle (Heitz 2014, equation 16).
    #[inline(always)]
    pub fn visible_normal_pdf(&self, w: Vec3, m: Vec3) -> f32 {
        let pdf = self.g1(w) / w.z.abs() * self.d(m) * w.dot(m).abs();
        if w.z == 0.0 { 0.0 } else { pdf }
    }

    /// Samples a normal visible from `w` (in its upper or lower hemisphere alike; the normal has z >= 0) with density
    /// [`Microfacets::visible_normal_pdf`].
    #[inline]
    pub fn sample_visible_normal(&self, w: Vec3, u: Vec2) -> Vec3 {
        self.visible_normal(w, u)
    }

    /// [`Microfacets::sample_visible_normal`] for kernels.
    #[inline(always)]
    pub(super) fn visible_normal(&self, w: Vec3, u: Vec2) -> Vec3 {
        let wh = self.stretched(if w.z < 0.0 { -w } else { w });
        self.unstretched(match self.distribution {
            Distribution::Ggx => ggx_normal(wh, u),
            Distribution::Beckmann => (-beckmann::sample_visible_slope(wh, u)).extend(1.0),
        })
    }

    /// Samples a normal with z >= 0 that faces `w`, which may look at the facets from below their horizon; the density is
    /// proportional to D(m) (w . m).
    pub(super) fn sample_normal_seen_from(&self, w: Vec3, u: Vec2) -> Vec3 {
        if w.z >= 0.0 {
            return self.sample_visible_normal(w, u);
        }
        let wh = self.stretched(w);
        self.unstretched(match self.distribution {
            Distribution::Ggx => ggx_normal(wh, u),
            Distribution::Beckmann => (-beckmann::sample_visible_slope_from_below(wh, u)).extend(1.0),
        })
    }

    /// A direction in the configuration of roughness 1: where the surface of GGX is a hemisphere.
    #[inline(always)]
    fn stretched(&self, w: Vec3) -> Vec3 {
        Vec3::new(self.alpha_x * w.x, self.alpha_y * w.y, w.z).normalize()
    }

    /// The unit normal that is `m`, not normalised, in that configuration.
    #[inline(always)]
    fn unstretched(&self, m: Vec3) -> Vec3 {
        Vec3::new(self.alpha_x * m.x, self.alpha_y * m.y, m.z.max(0.0)).normalize_or(Vec3::Z)
    }
}

/// A normal of GGX of roughness 1, not normalised, that `w` sees. By spherical caps (Dupuy and Benyoub 2023): a point of the cap above
/// -w.z is where light from `w` is reflected to.
#[inline(always)]
fn ggx_normal(w: Vec3, u: Vec2) -> Vec3 {
    let (sin_phi, cos_phi) = warp::sin_cos_of_turn(u.x);
    let z = (1.0 - u.y) * (1.0 + w.z) - w.z;
    let r = (1.0 - z * z).max(0.0).sqrt();
    Vec3::new(r * cos_phi, r * sin_phi, z) + w
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums `g` over a fine grid of the upper hemisphere.
    fn integrate(g: impl Fn(Vec3) -> f32) -> f64 {
        let (rows, columns) = (2000, 400);
        let mut sum = 0.0;
        for i in 0..rows {
            // Squared, as narrow distributions need their steps near the pole.
            let s = (f64::from(i) + 0.5) / f64::from(rows);
            let theta = s * s * std::f64::consts::FRAC_PI_2;
            let d_theta = 2.0 * s * std::f64::consts::FRAC_PI_2 / f64::from(rows);
            for j in 0..columns {
                let phi = (f64::from(j) + 0.5) / f64::from(columns) * std::f64::consts::TAU;
                let m = Vec3::new(
                    (theta.sin() * phi.cos()) as f32,
                    (theta.sin() * phi.sin()) as f32,
                    theta.cos() as f32,
                );
                sum += f64::from(g(m)) * theta.sin() * d_theta * std::f64::consts::TAU / f64::from(columns);
            }
        }
        sum
    }

    fn both<const N: usize>(slopes: [(f32, f32); N]) -> impl Iterator<Item = (Distribution, (f32, f32))> {
        [Distribution::Ggx, Distribution::Beckmann]
            .into_iter()
            .flat_map(move |d| slopes.map(|s| (d, s)))
    }

    #[test]
    fn projected_microfacet_area_is_one() {
        for (distribution, (ax, ay)) in both([(0.1, 0.1), (0.5, 0.2), (1.0, 0.7)]) {
            let facets = Microfacets::new(distribution, ax, ay).unwrap();
            let area = integrate(|m| facets.d(m) * m.z);
            assert!((area - 1.0).abs() < 1e-3, "{facets:?}: {area}");
        }
    }

    #[test]
    fn visible_normals_integrate_to_one_from_every_direction() {
        for (distribution, (ax, ay)) in both([(0.3, 0.3), (0.6, 0.2)]) {
            let facets = Microfacets::new(distribution, ax, ay).unwrap();
            for w in [
                Vec3::Z,
                Vec3::new(0.6, 0.0, 0.8),
                Vec3::new(0.0, -0.95, 0.312),
                Vec3::new(0.7, 0.7, 0.14),
            ] {
                let w = w.normalize();
                let sum = integrate(|m| {
                    if w.dot(m) > 0.0 {
                        facets.visible_normal_pdf(w, m)
                    } else {
                        0.0
                    }
                });
                assert!((sum - 1.0).abs() < 2e-3, "{facets:?}, w {w}: {sum}");
            }
        }
    }

    #[test]
    fn lambda_continues_below_the_horizon() {
        for (distribution, (ax, ay)) in both([(0.3, 0.3), (0.6, 0.2)]) {
            let facets = Microfacets::new(distribution, ax, ay).unwrap();
            for w in [Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.5, -0.8, 0.2), Vec3::Z] {
                let w = w.normalize();
                let (up, down) = (facets.signed_lambda(w), facets.signed_lambda(-w));
                assert!((up - facets.lambda(w)).abs() <= 1e-6 * up);
                assert!(
                    (down + 1.0 + up).abs() < 1e-5 * (1.0 + up),
                    "{facets:?}, {w}: {up} and {down}"
                );
                // The area of facets seen from below, z (1 + Lambda), by quadrature.
                let seen = integrate(|m| facets.d(m) * (-w).dot(m).max(0.0));
                let expected = f64::from(-w.z * (1.0 + down));
                assert!((seen - expected).abs() < 1e-3, "{facets:?}, {w}: {seen} and {expected}");
            }
        }
    }
}
