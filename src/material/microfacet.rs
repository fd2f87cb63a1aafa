//! The anisotropic GGX distribution of microfacet normals with Smith's masking (Walter et al. 2007; Heitz 2014).

use std::f32::consts::PI;

use crate::math::{Vec2, Vec3};

/// A GGX distribution; all directions are local.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ggx {
    alpha_x: f32,
    alpha_y: f32,
}

impl Ggx {
    /// Below this both ways a surface counts as smooth, as in pbrt-v4.
    const SMOOTH: f32 = 1e-3;
    /// A surface rough in one direction only keeps at least this in the other.
    const LEAST_ALPHA: f32 = 1e-4;

    /// With slopes `alpha_x` and `alpha_y` (not negative) along the two tangents; `None` if it is effectively smooth.
    pub fn new(alpha_x: f32, alpha_y: f32) -> Option<Self> {
        if alpha_x.max(alpha_y) < Self::SMOOTH {
            return None;
        }
        Some(Self {
            alpha_x: alpha_x.max(Self::LEAST_ALPHA),
            alpha_y: alpha_y.max(Self::LEAST_ALPHA),
        })
    }

    /// Whether it is the same along both tangents.
    pub fn is_isotropic(&self) -> bool {
        self.alpha_x == self.alpha_y
    }

    /// The slope for pbrt-v4's perceptual roughness.
    pub fn alpha_from_roughness(roughness: f32) -> f32 {
        roughness.sqrt()
    }

    /// Density of microfacet area by solid angle of its normal `m`.
    #[inline]
    pub fn d(&self, m: Vec3) -> f32 {
        // Heitz 2014, equation 85, without dividing by a cosine that may be 0.
        let (x, y) = (m.x / self.alpha_x, m.y / self.alpha_y);
        let e = x * x + y * y + m.z * m.z;
        1.0 / (PI * self.alpha_x * self.alpha_y * e * e)
    }

    /// Smith's Lambda.
    #[inline]
    pub fn lambda(&self, w: Vec3) -> f32 {
        let z2 = w.z * w.z;
        if z2 == 0.0 {
            return f32::INFINITY;
        }
        let (x, y) = (self.alpha_x * w.x, self.alpha_y * w.y);
        0.5 * ((1.0 + (x * x + y * y) / z2).sqrt() - 1.0)
    }

    /// Fraction of microfacets not masked from `w`.
    #[inline]
    pub fn g1(&self, w: Vec3) -> f32 {
        1.0 / (1.0 + self.lambda(w))
    }

    /// Fraction masked neither from `wo` nor from `wi`, with correlated heights.
    #[inline]
    pub fn g(&self, wo: Vec3, wi: Vec3) -> f32 {
        1.0 / (1.0 + self.lambda(wo) + self.lambda(wi))
    }

    /// Density of the normals visible from `w`, by solid angle (Heitz 2014, equation 16).
    #[inline]
    pub fn visible_normal_pdf(&self, w: Vec3, m: Vec3) -> f32 {
        if w.z == 0.0 {
            return 0.0;
        }
        self.g1(w) / w.z.abs() * self.d(m) * w.dot(m).abs()
    }

    /// Samples a normal visible from `w` (in its upper or lower hemisphere alike; the normal has z >= 0) with density
    /// [`Ggx::visible_normal_pdf`], by spherical caps (Dupuy and Benyoub 2023).
    #[inline]
    pub fn sample_visible_normal(&self, w: Vec3, u: Vec2) -> Vec3 {
        let w = if w.z < 0.0 { -w } else { w };
        // To the configuration where the surface is a hemisphere.
        let wh = Vec3::new(self.alpha_x * w.x, self.alpha_y * w.y, w.z).normalize();
        // A point of the spherical cap above -wh.z is where light from wh is reflected to.
        let (sin_phi, cos_phi) = (2.0 * PI * u.x).sin_cos();
        let z = (1.0 - u.y) * (1.0 + wh.z) - wh.z;
        let r = (1.0 - z * z).max(0.0).sqrt();
        let m = Vec3::new(r * cos_phi, r * sin_phi, z) + wh;
        Vec3::new(self.alpha_x * m.x, self.alpha_y * m.y, m.z.max(0.0))
            .try_normalize()
            .unwrap_or(Vec3::Z)
    }
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

    #[test]
    fn projected_microfacet_area_is_one() {
        for (ax, ay) in [(0.1, 0.1), (0.5, 0.2), (1.0, 0.7)] {
            let ggx = Ggx::new(ax, ay).unwrap();
            let area = integrate(|m| ggx.d(m) * m.z);
            assert!((area - 1.0).abs() < 1e-3, "alpha {ax} {ay}: {area}");
        }
    }

    #[test]
    fn visible_normals_integrate_to_one_from_every_direction() {
        for (ax, ay) in [(0.3, 0.3), (0.6, 0.2)] {
            let ggx = Ggx::new(ax, ay).unwrap();
            for w in [
                Vec3::Z,
                Vec3::new(0.6, 0.0, 0.8),
                Vec3::new(0.0, -0.95, 0.312),
                Vec3::new(0.7, 0.7, 0.14),
            ] {
                let w = w.normalize();
                let sum = integrate(|m| {
                    if w.dot(m) > 0.0 {
                        ggx.visible_normal_pdf(w, m)
                    } else {
                        0.0
                    }
                });
                assert!((sum - 1.0).abs() < 2e-3, "alpha {ax} {ay}, w {w}: {sum}");
            }
        }
    }
}
