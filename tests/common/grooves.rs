//! The energy-preserving form of Oren and Nayar's model written down a second time: in angles, in double precision, and with its
//! integrals by quadrature instead of in closed form.

use std::f64::consts::{FRAC_PI_2, PI};

/// V-shaped grooves of a roughness.
#[derive(Clone, Copy, Debug)]
pub struct Grooves(pub f64);

const STEPS: usize = 400;

/// The mean of `g` over a hemisphere of directions weighted with the cosine; it is a function of the polar angle.
fn hemisphere(g: impl Fn(f64) -> f64) -> f64 {
    let step = FRAC_PI_2 / STEPS as f64;
    let at = |i: usize| (i as f64 + 0.5) * step;
    (0..STEPS)
        .map(|i| 2.0 * g(at(i)) * at(i).sin() * at(i).cos() * step)
        .sum()
}

impl Grooves {
    /// What white facets reflect of light from a polar angle after one bounce: pi f (A + B max(0, cos phi) ...) in Fujii's form.
    fn single(self, theta: f64) -> f64 {
        let a = 1.0 / (1.0 + (0.5 - 2.0 / (3.0 * PI)) * self.0);
        let b = a * self.0;
        let (sin, cos) = theta.sin_cos();
        hemisphere(|other| {
            // s = sin sin cos(phi); divided by the larger cosine where it is positive: the mean of a half cosine is 1 / pi.
            let s = sin * other.sin() / PI;
            a + b * (s / cos.max(other.cos()) - s)
        })
    }

    /// The albedo of facets that are grey, for light from the cosine `cos`.
    pub fn albedo(self, cos: f64, albedo: f64) -> f64 {
        let mean = hemisphere(|theta| self.single(theta));
        let single = self.single(cos.clamp(-1.0, 1.0).acos());
        albedo * single + (1.0 - single) * albedo * albedo * mean / (1.0 - albedo * (1.0 - mean))
    }
}
