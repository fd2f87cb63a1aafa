//! Smooth spectra for rgb colours: Jakob and Hanika 2019, "A low-dimensional function space for efficient spectral
//! upsampling".
//!
//! A reflectance is s(p(λ)), p a polynomial of degree two, s(x) = 1/2 + x / (2 √(1 + x²)). The three coefficients are
//! solved for here, per colour, so that the reflectance under the white of the colour space has exactly that colour.

use std::sync::OnceLock;

use glam::{DMat3, DVec3};

use super::cie::{self, ENTRIES, wavelength};
use super::{ColorSpace, SampledSpectrum, Wavelengths};

/// The middle and half width of the visible range: polynomials are in (λ - CENTRE) / HALF_RANGE, from -1 to 1, where single
/// precision is enough even for the steep polynomials of saturated colours.
const CENTRE: f32 = 595.0;
const HALF_RANGE: f32 = 235.0;

/// A reflectance in (0, 1) over wavelength: a sigmoid of a quadratic polynomial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SigmoidPolynomial([f32; 3]);

impl SigmoidPolynomial {
    /// The polynomial's coefficients, that of the square first.
    pub fn coefficients(&self) -> [f32; 3] {
        self.0
    }

    /// The inverse of [`Self::coefficients`].
    #[inline]
    pub fn from_coefficients(coefficients: [f32; 3]) -> Self {
        Self(coefficients)
    }

    /// The value at `lambda` nm.
    #[inline]
    pub fn at(&self, lambda: f32) -> f32 {
        let t = (lambda - CENTRE) * (1.0 / HALF_RANGE);
        let [a, b, c] = self.0;
        let x = (a * t + b) * t + c;
        0.5 + 0.5 * x / (1.0 + x * x).sqrt()
    }

    /// The values at the wavelengths of a path.
    #[inline]
    pub fn sample(&self, wavelengths: &Wavelengths) -> SampledSpectrum {
        SampledSpectrum(wavelengths.lambda.map(|lambda| self.at(lambda)))
    }
}

/// A colour's change by a reflectance, by nm: t of the polynomial, and linear RGB.
type Response = Vec<(f64, DVec3)>;

/// For each nm what a reflectance of 1 there, under the white of a colour space, adds to linear RGB.
pub(super) fn response(space: ColorSpace) -> &'static Response {
    static RESPONSES: [OnceLock<Response>; ColorSpace::ALL.len()] = [const { OnceLock::new() }; ColorSpace::ALL.len()];
    RESPONSES[space as usize].get_or_init(|| {
        let light = space.illuminant();
        let total = cie::integrate_y(|nm| light.at(nm));
        (0..ENTRIES)
            .map(|i| {
                let nm = wavelength(i);
                let xyz = cie::integrate_xyz(|other| if other == nm { light.at(nm) } else { 0.0 });
                let t = f64::from((nm - CENTRE) / HALF_RANGE);
                (t, DVec3::from(space.xyz_to_rgb(xyz)) / total)
            })
            .collect()
    })
}

/// The colour of a polynomial's reflectance and its derivative by the coefficients.
fn colour(response: &[(f64, DVec3)], coefficients: DVec3) -> (DVec3, DMat3) {
    let mut rgb = DVec3::ZERO;
    let mut jacobian = DMat3::ZERO;
    for &(t, response) in response {
        let powers = DVec3::new(t * t, t, 1.0);
        let x = powers.dot(coefficients);
        let inverse_root = 1.0 / (1.0 + x * x).sqrt();
        rgb += response * (0.5 + 0.5 * x * inverse_root);
        let slope = response * (0.5 * inverse_root * inverse_root * inverse_root);
        jacobian.x_axis += slope * powers.x;
        jacobian.y_axis += slope * powers.y;
        jacobian.z_axis += slope;
    }
    (rgb, jacobian)
}

/// How close a solution comes to its colour, in each component.
const TOLERANCE: f64 = 1e-9;

/// The smallest step of the continuation: below it the rest of the way is left.
const SMALLEST_STEP: f64 = 1e-5;

/// The reflectance whose colour under the white of `space` is `rgb`, linear in that space, in [0, 1] and not all components equal.
///
/// Follows the solutions along the line from middle grey, whose polynomial is zero, to the colour: from a close start
/// Newton's method converges, and inside the cube of sRGB there is a solution all along. In a wide space there are colours that no
/// reflectance has: of those the answer is where the solutions end on the way to them.
pub(super) fn solve(space: ColorSpace, rgb: [f32; 3]) -> SigmoidPolynomial {
    let goal = DVec3::from(rgb.map(f64::from));
    SigmoidPolynomial(solve_with(response(space), goal).as_vec3().into())
}

/// [`solve`] for some response.
fn solve_with(response: &[(f64, DVec3)], goal: DVec3) -> DVec3 {
    let grey = DVec3::splat(0.5);
    let (mut done, mut step) = (0.0, 1.0_f64);
    let mut coefficients = DVec3::ZERO;
    while done < 1.0 && step > SMALLEST_STEP {
        let next = (done + step).min(1.0);
        match newton(response, grey.lerp(goal, next), coefficients) {
            Some(solution) => {
                coefficients = solution;
                done = next;
                step *= 2.0;
            }
            None => step *= 0.5,
        }
    }
    coefficients
}

/// The polynomial of a colour that some reflectance has, from the solution for a colour nearby.
pub(super) fn follow(response: &[(f64, DVec3)], goal: DVec3, near: DVec3) -> DVec3 {
    newton(response, goal, near).unwrap_or_else(|| solve_with(response, goal))
}

/// The largest coefficients of [`approach`]: such a reflectance goes from 0 to 1 within some 2 nm.
const STEEPEST: f64 = 100.0;

/// A polynomial whose colour is as near to `goal` as a few steps of Levenberg and Marquardt's method lead from that of a colour nearby:
/// quick also where no reflectance has the colour.
pub(super) fn approach(response: &[(f64, DVec3)], goal: DVec3, near: DVec3) -> DVec3 {
    let mut coefficients = near;
    let (mut rgb, mut jacobian) = colour(response, coefficients);
    let mut damping = 1e-6;
    for _ in 0..16 {
        let residual = goal - rgb;
        if residual.abs().max_element() < 1e-6 {
            break;
        }
        let transposed = jacobian.transpose();
        let square = transposed * jacobian;
        let diagonal = DVec3::new(square.x_axis.x, square.y_axis.y, square.z_axis.z);
        let damped = square + DMat3::from_diagonal(diagonal * damping + 1e-15);
        let step = damped.inverse() * (transposed * residual);
        let next = (coefficients + step).clamp(DVec3::splat(-STEEPEST), DVec3::splat(STEEPEST));
        let (next_rgb, next_jacobian) = colour(response, next);
        if next.is_finite() && (goal - next_rgb).length_squared() < residual.length_squared() {
            (coefficients, rgb, jacobian) = (next, next_rgb, next_jacobian);
            damping *= 0.1;
        } else {
            damping *= 10.0;
        }
    }
    coefficients
}

/// Newton's method for one colour; `None` if it does not converge in a few steps.
fn newton(response: &[(f64, DVec3)], goal: DVec3, start: DVec3) -> Option<DVec3> {
    let mut coefficients = start;
    for _ in 0..12 {
        let (rgb, jacobian) = colour(response, coefficients);
        let residual = goal - rgb;
        if residual.abs().max_element() < TOLERANCE {
            return Some(coefficients);
        }
        coefficients += jacobian.inverse() * residual;
        if !coefficients.is_finite() {
            return None;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The colour, under the white of the space, of the polynomial that is used in the end, in single precision.
    fn round_trip(space: ColorSpace, rgb: [f32; 3]) -> [f64; 3] {
        let polynomial = solve(space, rgb);
        let light = space.illuminant();
        let white = cie::integrate_y(|nm| light.at(nm));
        let xyz = cie::integrate_xyz(|nm| polynomial.at(nm) * light.at(nm));
        space.xyz_to_rgb(xyz).map(|c| c / white)
    }

    #[test]
    fn colours_survive_the_round_trip() {
        // The corners and edges of the cube included: the most saturated colours there are. What is lost is the rounding of
        // coefficients to single precision.
        let levels = [0.0, 0.001, 0.03, 0.2, 0.5, 0.8, 0.97, 1.0];
        let mut worst = (0.0, [0.0; 3]);
        for i in 0..512 {
            let rgb = [levels[i / 64], levels[i / 8 % 8], levels[i % 8]];
            if rgb[0] == rgb[1] && rgb[1] == rgb[2] {
                continue;
            }
            for (a, b) in round_trip(ColorSpace::Srgb, rgb).into_iter().zip(rgb) {
                let error = (a - f64::from(b)).abs();
                if error > worst.0 {
                    worst = (error, rgb);
                }
            }
        }
        assert!(worst.0 < 2e-6, "{worst:?}");
    }

    /// Colours of sRGB stated in the wider spaces, and colours of these beyond it that reflectances have.
    #[test]
    fn wide_spaces_have_solutions() {
        for space in ColorSpace::ALL {
            for srgb in [[0.8, 0.1, 0.05], [0.1, 0.7, 0.2], [0.05, 0.1, 0.8], [0.9, 0.8, 0.1]] {
                let rgb = space.xyz_to_rgb(cie::srgb_to_xyz(srgb)).map(|c| c as f32);
                let found = round_trip(space, rgb);
                let close = found.iter().zip(rgb).all(|(a, b)| (a - f64::from(b)).abs() < 2e-6);
                assert!(close, "{space:?}: {rgb:?} became {found:?}");
            }
        }
        for (space, rgb) in [
            (ColorSpace::DciP3, [0.6, 0.005, 0.005]),
            (ColorSpace::Rec2020, [0.02, 0.3, 0.03]),
        ] {
            let found = round_trip(space, rgb);
            assert!(
                found.iter().zip(rgb).all(|(a, b)| (a - f64::from(b)).abs() < 2e-6),
                "{space:?}: {found:?}"
            );
            let srgb = cie::xyz_to_srgb(space.rgb_to_xyz(found));
            assert!(srgb.iter().any(|&c| c < -0.01), "{space:?}: {srgb:?} is in sRGB");
        }
    }
}
