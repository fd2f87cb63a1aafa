//! The microfacet model written down a second time, in double precision and in terms of facets instead of directions: what a
//! surface reflects and transmits of light that comes from everywhere. No Jacobian of the renderer's f and pdf is in here.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use statrs::function::erf;

/// Fresnel reflectance of a dielectric for a cosine on the side of index 1 of a boundary to index `eta`; 1 beyond the critical
/// angle. From Fresnel's amplitudes by angles, as in textbooks.
pub fn dielectric_reflectance(cos: f64, eta: f64) -> f64 {
    let theta_i = cos.clamp(0.0, 1.0).acos();
    let sin_t = theta_i.sin() / eta;
    if sin_t >= 1.0 {
        return 1.0;
    }
    if theta_i < 1e-4 {
        return ((eta - 1.0) / (eta + 1.0)).powi(2);
    }
    let theta_t = sin_t.asin();
    let s = (theta_i - theta_t).sin() / (theta_i + theta_t).sin();
    let p = (theta_i - theta_t).tan() / (theta_i + theta_t).tan();
    0.5 * (s * s + p * p)
}

/// Fresnel reflectance of a conductor of index n + i k, by complex amplitudes.
pub fn conductor_reflectance(cos: f64, n: f64, k: f64) -> f64 {
    type C = (f64, f64);
    let mul = |a: C, b: C| (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
    let norm = |a: C| a.0 * a.0 + a.1 * a.1;
    let index2 = mul((n, k), (n, k));
    // sqrt(index² - sin²) = index cos_t.
    let (re, im) = (index2.0 - (1.0 - cos * cos), index2.1);
    let modulus = re.hypot(im);
    let root = ((0.5 * (modulus + re)).sqrt(), (0.5 * (modulus - re)).max(0.0).sqrt());
    let s = norm((cos - root.0, -root.1)) / norm((cos + root.0, root.1));
    let c = (index2.0 * cos, index2.1 * cos);
    let p = norm((c.0 - root.0, c.1 - root.1)) / norm((c.0 + root.0, c.1 + root.1));
    0.5 * (s + p)
}

/// How slopes are distributed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    Ggx,
    Beckmann,
}

/// Slopes along x and y.
#[derive(Clone, Copy, Debug)]
pub struct Slopes(pub f64, pub f64, pub Shape);

impl Slopes {
    fn lambda(self, w: DVec3) -> f64 {
        let Self(ax, ay, shape) = self;
        let tan2 = ((ax * w.x).powi(2) + (ay * w.y).powi(2)) / (w.z * w.z);
        match shape {
            Shape::Ggx => 0.5 * ((1.0 + tan2).sqrt() - 1.0),
            Shape::Beckmann if tan2 < 1e-6 => 0.0,
            Shape::Beckmann => {
                let a = 1.0 / tan2.sqrt();
                (-a * a).exp() / (2.0 * a * PI.sqrt()) - 0.5 * erf::erfc(a)
            }
        }
    }

    /// The integral over facets m seen from `wo` (z > 0) of `carried(m, wo . m)`: a direction and the share of light that goes
    /// there, of which masking leaves G2 (of correlated heights).
    ///
    /// f cos dw = share D(m) (wo . m) G2 / cos_o dm, and D(m) cos_m dm is uniform in azimuth and in s = 1 / (1 + r²) of the slope
    /// (ax r cos phi, ay r sin phi); in s = exp(-r²) for Beckmann's.
    fn integrate(self, wo: DVec3, carried: impl Fn(DVec3, f64) -> (DVec3, f64)) -> f64 {
        const STEPS: (usize, usize) = (512, 256);
        let mut sum = 0.0;
        for i in 0..STEPS.0 {
            // The square concentrates steps where s nears 1: at grazing facets.
            let x = (i as f64 + 0.5) / STEPS.0 as f64;
            let (rest, ds) = (x * x, 2.0 * x);
            let r = match self.2 {
                Shape::Ggx => ((1.0 - rest) / rest).sqrt(),
                Shape::Beckmann => (-rest.ln()).sqrt(),
            };
            for j in 0..STEPS.1 {
                let phi = TAU * (j as f64 + 0.5) / STEPS.1 as f64;
                let m = DVec3::new(-self.0 * r * phi.cos(), -self.1 * r * phi.sin(), 1.0).normalize();
                let cos = wo.dot(m);
                if cos <= 0.0 {
                    continue;
                }
                let (wi, share) = carried(m, cos);
                if share > 0.0 {
                    let g2 = 1.0 / (1.0 + self.lambda(wo) + self.lambda(wi));
                    sum += share * g2 * cos / (m.z * wo.z) * ds;
                }
            }
        }
        sum / (STEPS.0 * STEPS.1) as f64
    }

    /// The reflected share of light from everywhere, where `fresnel` is a function of the cosine to a facet.
    pub fn reflected(self, wo: DVec3, fresnel: impl Fn(f64) -> f64) -> f64 {
        self.integrate(wo, |m, cos| {
            let wi = m * (2.0 * cos) - wo;
            (wi, if wi.z > 0.0 { fresnel(cos) } else { 0.0 })
        })
    }

    /// The share that facets of relative index `eta` (far side over that of `wo`) transmit to the other side.
    pub fn transmitted(self, wo: DVec3, eta: f64) -> f64 {
        self.integrate(wo, |m, cos| {
            let cos_t = (1.0 - (1.0 - cos * cos) / (eta * eta)).max(0.0).sqrt();
            let wi = -wo / eta + m * (cos / eta - cos_t);
            let share = 1.0 - dielectric_reflectance(cos, eta);
            (wi, if wi.z < 0.0 { share } else { 0.0 })
        })
    }
}

/// The direction at an angle from +z, in degrees, with an azimuth in degrees.
pub fn direction(theta: f64, phi: f64) -> DVec3 {
    let (sin, cos) = (theta * PI / 180.0).sin_cos();
    let (sin_phi, cos_phi) = (phi * PI / 180.0).sin_cos();
    DVec3::new(sin * cos_phi, sin * sin_phi, cos)
}
