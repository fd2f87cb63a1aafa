//! LDR-FLIP, the difference that a person sees who alternates between two images.
//!
//! Source: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild, *FLIP: A Difference Evaluator for Alternating
//! Images*, HPG 2020, whose constants these are.
//!
//! Two pipelines look at both images. The colour pipeline blurs them as the eye does at the given distance and measures the
//! remaining difference of colour; the feature pipeline finds edges and points that are in one image only. The second amplifies
//! the first. All filters are Gaussians and their derivatives, so each is applied as two one-dimensional ones.

use glam::{DMat3, DVec3, Vec3};
use rayon::prelude::*;
use std::f32::consts::{FRAC_1_SQRT_2, PI};

/// A 0.7 m wide screen of 3840 pixels seen from 0.7 m.
pub const PIXELS_PER_DEGREE: f32 = 67.0;

/// Exponents of the colour difference and of the feature difference.
const COLOUR_EXPONENT: f32 = 0.7;
const FEATURE_EXPONENT: f32 = 0.5;
/// The peak-to-trough width of the eye's edge detector, in degrees.
const FEATURE_WIDTH: f32 = 0.082;

/// The LDR-FLIP error of every pixel, in [0, 1], of linear Rec. 709 colours in rows of `width`; clamped to [0, 1] first, which is
/// what encoding them as sRGB and showing them does. Symmetric in the images.
///
/// # Panics
/// If the images differ in length, or it is not a multiple of `width`.
pub fn error_map(a: &[[f32; 3]], b: &[[f32; 3]], width: usize, pixels_per_degree: f32) -> Vec<f32> {
    assert!(
        a.len() == b.len() && a.len().is_multiple_of(width),
        "images of one size"
    );
    let space = ColourSpace::new();
    let [a, b] = [a, b].map(|pixels| Opponent::new(pixels, width, &space));
    let [colours_a, colours_b] = [&a, &b].map(|image| seen_colours(image, pixels_per_degree, &space));
    let largest = largest_colour_difference(&space);
    let [features_a, features_b] = [&a, &b].map(|image| features(&image.0[0], pixels_per_degree));
    (0..colours_a.len())
        .into_par_iter()
        .map(|i| {
            let colour = redistribute(hyab(colours_a[i], colours_b[i]).powf(COLOUR_EXPONENT), largest);
            let [edge, point] = [0, 1].map(|kind| (features_a[i][kind] - features_b[i][kind]).abs());
            let feature = (FRAC_1_SQRT_2 * edge.max(point)).powf(FEATURE_EXPONENT);
            colour.powf(1.0 - feature)
        })
        .collect()
}

/// Linear Rec. 709 to CIE XYZ over its white, and back.
struct ColourSpace {
    to_xyz: DMat3,
    to_rgb: DMat3,
}

impl ColourSpace {
    fn new() -> Self {
        let rgb_to_xyz = DMat3::from_cols(
            DVec3::new(
                10_135_552.0 / 24_577_794.0,
                2_613_072.0 / 12_288_897.0,
                1_425_312.0 / 73_733_382.0,
            ),
            DVec3::new(
                8_788_810.0 / 24_577_794.0,
                8_788_810.0 / 12_288_897.0,
                8_788_810.0 / 73_733_382.0,
            ),
            DVec3::new(
                4_435_075.0 / 24_577_794.0,
                887_015.0 / 12_288_897.0,
                70_074_185.0 / 73_733_382.0,
            ),
        );
        let white = rgb_to_xyz * DVec3::ONE;
        let to_xyz = DMat3::from_diagonal(white.recip()) * rgb_to_xyz;
        Self {
            to_xyz,
            to_rgb: to_xyz.inverse(),
        }
    }

    /// YCxCz, the linear relative of L*a*b*, of a colour.
    fn opponent(&self, rgb: Vec3) -> Vec3 {
        let xyz = self.to_xyz * rgb.as_dvec3();
        DVec3::new(116.0 * xyz.y - 16.0, 500.0 * (xyz.x - xyz.y), 200.0 * (xyz.y - xyz.z)).as_vec3()
    }

    /// The inverse of [`ColourSpace::opponent`].
    fn rgb(&self, opponent: Vec3) -> Vec3 {
        let [y, cx, cz] = opponent.as_dvec3().to_array();
        let y = (y + 16.0) / 116.0;
        (self.to_rgb * DVec3::new(y + cx / 500.0, y, y - cz / 200.0)).as_vec3()
    }

    /// L*a*b* with the Hunt effect: chroma fades with lightness.
    fn hunt_lab(&self, rgb: Vec3) -> Vec3 {
        const DELTA: f64 = 6.0 / 29.0;
        let f = |t: f64| {
            if t > DELTA.powi(3) {
                t.cbrt()
            } else {
                t / (3.0 * DELTA * DELTA) + 4.0 / 29.0
            }
        };
        let [x, y, z] = (self.to_xyz * rgb.as_dvec3()).to_array().map(f);
        let lightness = 116.0 * y - 16.0;
        let chroma = 0.01 * lightness;
        DVec3::new(lightness, chroma * 500.0 * (x - y), chroma * 200.0 * (y - z)).as_vec3()
    }
}

/// One channel of an image.
struct Plane {
    width: usize,
    data: Vec<f32>,
}

/// An image as the planes Y, Cx and Cz.
struct Opponent([Plane; 3]);

impl Opponent {
    fn new(pixels: &[[f32; 3]], width: usize, space: &ColourSpace) -> Self {
        let opponent: Vec<Vec3> = pixels
            .par_iter()
            .map(|&rgb| space.opponent(Vec3::from_array(rgb).clamp(Vec3::ZERO, Vec3::ONE)))
            .collect();
        Self([0, 1, 2].map(|c| Plane {
            width,
            data: opponent.iter().map(|colour| colour[c]).collect(),
        }))
    }
}

/// What the eye sees of the colours: filtered by its contrast sensitivity, in L*a*b* with the Hunt effect.
fn seen_colours(image: &Opponent, pixels_per_degree: f32, space: &ColourSpace) -> Vec<Vec3> {
    // Terms (a, b) of the sum of a sqrt(pi/b) exp(-pi² x²/b), x in degrees: the Fourier transforms of the sensitivities.
    const ACHROMATIC: &[(f32, f32)] = &[(1.0, 0.0047)];
    const RED_GREEN: &[(f32, f32)] = &[(1.0, 0.0053)];
    const BLUE_YELLOW: &[(f32, f32)] = &[(34.1, 0.04), (13.5, 0.025)];
    const WIDEST: f32 = 0.04;
    // Three standard deviations of the widest, for all.
    let radius = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil();
    let filter = |plane: &Plane, terms: &[(f32, f32)]| {
        let kernels: Vec<Vec<f32>> = terms
            .iter()
            .map(|(_, b)| kernel(radius, |x| (-(PI * x / pixels_per_degree).powi(2) / b).exp()))
            .collect();
        let sums: Vec<f32> = kernels.iter().map(|k| k.iter().sum()).collect();
        // In two dimensions a term's weights add up to its factor times the square of the sum.
        let total = |i: usize| terms[i].0 * (PI / terms[i].1).sqrt() * sums[i] * sums[i];
        let all: f32 = (0..terms.len()).map(total).sum();
        let mut filtered = vec![0.0; plane.data.len()];
        for (i, kernel) in kernels.iter().enumerate() {
            let normalised: Vec<f32> = kernel.iter().map(|w| w / sums[i]).collect();
            let part = convolve(plane, &normalised, &normalised);
            let share = total(i) / all;
            filtered.iter_mut().zip(&part).for_each(|(sum, v)| *sum += share * v);
        }
        filtered
    };
    let [y, cx, cz] = &image.0;
    let (y, cx, cz) = (filter(y, ACHROMATIC), filter(cx, RED_GREEN), filter(cz, BLUE_YELLOW));
    (0..y.len())
        .into_par_iter()
        .map(|i| {
            let rgb = space.rgb(Vec3::new(y[i], cx[i], cz[i]));
            space.hunt_lab(rgb.clamp(Vec3::ZERO, Vec3::ONE))
        })
        .collect()
}

/// The HyAB distance: city-block in lightness, Euclidean in chroma.
fn hyab(a: Vec3, b: Vec3) -> f32 {
    let difference = a - b;
    difference.x.abs() + difference.y.hypot(difference.z)
}

/// The largest difference that can be shown, between green and blue, to the power that differences are raised to.
fn largest_colour_difference(space: &ColourSpace) -> f32 {
    hyab(space.hunt_lab(Vec3::Y), space.hunt_lab(Vec3::Z)).powf(COLOUR_EXPONENT)
}

/// Maps differences to [0, 1]: those up to 0.4 of the largest, where people tell them apart, take the range up to 0.95.
fn redistribute(difference: f32, largest: f32) -> f32 {
    const KNEE: f32 = 0.4;
    const KNEE_ERROR: f32 = 0.95;
    let knee = KNEE * largest;
    if difference < knee {
        KNEE_ERROR / knee * difference
    } else {
        KNEE_ERROR + (difference - knee) / (largest - knee) * (1.0 - KNEE_ERROR)
    }
}

/// How much of an edge and of a point each pixel of the Y plane is: the lengths of the first and second derivatives.
fn features(luma: &Plane, pixels_per_degree: f32) -> Vec<[f32; 2]> {
    let deviation = 0.5 * FEATURE_WIDTH * pixels_per_degree;
    let radius = (3.0 * deviation).ceil();
    let gauss = |x: f32| (-x * x / (2.0 * deviation * deviation)).exp();
    let across = normalise_signs(&kernel(radius, gauss));
    let edge = normalise_signs(&kernel(radius, |x| -x * gauss(x)));
    let point = normalise_signs(&kernel(radius, |x| (x * x / (deviation * deviation) - 1.0) * gauss(x)));
    let normalised = Plane {
        width: luma.width,
        data: luma.data.iter().map(|y| (y + 16.0) / 116.0).collect(),
    };
    let lengths = |derivative: &[f32]| {
        let x = convolve(&normalised, derivative, &across);
        let y = convolve(&normalised, &across, derivative);
        x.into_iter().zip(y).map(|(x, y)| x.hypot(y)).collect::<Vec<_>>()
    };
    lengths(&edge)
        .into_iter()
        .zip(lengths(&point))
        .map(|(e, p)| [e, p])
        .collect()
}

/// The weights at the whole numbers from `-radius` to `radius`.
fn kernel(radius: f32, weight: impl Fn(f32) -> f32) -> Vec<f32> {
    let radius = radius as i32;
    (-radius..=radius).map(|x| weight(x as f32)).collect()
}

/// Scales the positive weights to a sum of 1 and the negative ones to -1. The product with a kernel that has no negative weights
/// and sums to 1 is then normalised so in two dimensions.
fn normalise_signs(kernel: &[f32]) -> Vec<f32> {
    let positive: f32 = kernel.iter().filter(|w| **w > 0.0).sum();
    let negative: f32 = -kernel.iter().filter(|w| **w < 0.0).sum::<f32>();
    kernel
        .iter()
        .map(|&w| if w < 0.0 { w / negative } else { w / positive })
        .collect()
}

/// The plane filtered along rows by `along_x` and along columns by `along_y`, both of odd length; pixels beyond the border are as
/// the nearest one inside.
fn convolve(plane: &Plane, along_x: &[f32], along_y: &[f32]) -> Vec<f32> {
    let (width, height) = (plane.width, plane.data.len() / plane.width);
    let clamped = |i: usize, offset: usize, radius: usize, end: usize| (i + offset).saturating_sub(radius).min(end - 1);
    let mut rows = vec![0.0; plane.data.len()];
    rows.par_chunks_mut(width)
        .zip(plane.data.par_chunks(width))
        .for_each(|(out, row)| {
            for (x, sum) in out.iter_mut().enumerate() {
                let at = |k: usize| row[clamped(x, k, along_x.len() / 2, width)];
                *sum = along_x.iter().enumerate().map(|(k, weight)| weight * at(k)).sum();
            }
        });
    let mut filtered = vec![0.0; plane.data.len()];
    filtered.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
        for (k, weight) in along_y.iter().enumerate() {
            let row = clamped(y, k, along_y.len() / 2, height) * width;
            out.iter_mut()
                .zip(&rows[row..row + width])
                .for_each(|(sum, v)| *sum += weight * v);
        }
    });
    filtered
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: usize = 64;
    const HEIGHT: usize = 48;

    fn picture(colour: impl Fn(i32, i32, i32) -> f32) -> Vec<[f32; 3]> {
        let at = |i: usize| [0, 1, 2].map(|c| colour((i % WIDTH) as i32, (i / WIDTH) as i32, c));
        (0..WIDTH * HEIGHT).map(at).collect()
    }

    /// A disc on a gradient, both of other colours in each channel.
    fn disc(dx: i32) -> Vec<[f32; 3]> {
        picture(move |x, y, c| {
            let inside = (x - 30 - dx).pow(2) + (y - 20).pow(2) < 150;
            let background = (x * (c + 1) + y * (3 - c)) as f32 / 400.0;
            if inside { 0.9 - 0.3 * c as f32 } else { background }
        })
    }

    fn noise(seed: i32) -> Vec<[f32; 3]> {
        picture(move |x, y, c| ((x * 37 + y * 57 + c * 91 + x * y * seed) % 256) as f32 / 255.0)
    }

    fn mean(a: &[[f32; 3]], b: &[[f32; 3]]) -> f32 {
        let errors = error_map(a, b, WIDTH, PIXELS_PER_DEGREE);
        assert!(errors.iter().all(|e| (0.0..=1.0).contains(e)));
        errors.iter().sum::<f32>() / errors.len() as f32
    }

    #[test]
    fn agrees_with_the_authors_program() {
        // Means that flip-evaluator 1.7 gives for these pairs of linear images, at 67 pixels a degree.
        for (name, a, b, expected) in [
            ("moved", disc(0), disc(1), 0.050_007_2),
            (
                "darker",
                disc(0),
                picture(|x, y, c| 0.8 * disc(0)[y as usize * WIDTH + x as usize][c as usize]),
                0.258_051_7,
            ),
            ("noise", noise(1), noise(3), 0.269_589_5),
            ("noisy", disc(0), noise(1), 0.612_224_2),
        ] {
            let found = mean(&a, &b);
            assert!((found - expected).abs() < 1e-5, "{name}: {found}, not {expected}");
        }
    }

    #[test]
    fn the_largest_difference_is_one() {
        // Green against blue is the pair that the scale is made from; a flat image has no features.
        let green = picture(|_, _, c| if c == 1 { 1.0 } else { 0.0 });
        let blue = picture(|_, _, c| if c == 2 { 1.0 } else { 0.0 });
        assert!((mean(&green, &blue) - 1.0).abs() < 1e-5);
    }

    #[test]
    fn is_symmetric_and_zero_for_equal_images() {
        let (a, b) = (disc(0), noise(5));
        assert_eq!(mean(&a, &b), mean(&b, &a));
        assert_eq!(mean(&b, &b), 0.0);
    }

    #[test]
    fn images_smaller_than_the_filters_work() {
        let errors = error_map(&[[0.0; 3]], &[[1.0; 3]], 1, PIXELS_PER_DEGREE);
        assert!(errors.len() == 1 && errors[0] > 0.9, "{errors:?}");
    }

    #[test]
    fn colour_space_inverts() {
        let space = ColourSpace::new();
        for rgb in [Vec3::ZERO, Vec3::ONE, Vec3::new(0.2, 0.7, 0.1)] {
            assert!(space.rgb(space.opponent(rgb)).abs_diff_eq(rgb, 1e-6));
        }
        // White has no chroma and a lightness of 100.
        assert!(space.hunt_lab(Vec3::ONE).abs_diff_eq(Vec3::new(100.0, 0.0, 0.0), 1e-4));
    }
}
