//! The shape of an aperture stop.

use std::f64::consts::PI;
use std::sync::Arc;

use crate::desc::StopShape;
use crate::image_io::Image;
use crate::math::DVec2;

/// How much of the light a stop lets through, by place: 1 on average over the circle of radius 1.
#[derive(Clone, Debug)]
pub(super) enum Stop {
    Round,
    Gaussian,
    Square,
    /// Corners in turn, and what light is multiplied by inside.
    Polygon(Vec<DVec2>, f64),
    /// Its mean of channels, times the factor.
    Image(Arc<Image>, f64),
}

/// The Gaussian stop is exp(-r²) - 1/e within the circle, 1 - 2/e on average times the factor that makes it 1.
const GAUSSIAN_END: f64 = 0.367_879_441_171_442_33;
const GAUSSIAN_FACTOR: f64 = 1.0 / (1.0 - 2.0 * GAUSSIAN_END);

impl Stop {
    /// A circle.
    pub const ROUND: Self = Self::Round;

    pub fn new(shape: &StopShape) -> Self {
        match shape {
            StopShape::Round => Self::Round,
            StopShape::Gaussian => Self::Gaussian,
            StopShape::Square => Self::Square,
            StopShape::Pentagon => {
                // A corner at the top; pbrt's is of this size.
                let corner = |i: i32| DVec2::from_angle(0.5 * PI + 0.4 * PI * f64::from(i)) * 0.8;
                Self::polygon((0..5).map(corner).collect())
            }
            StopShape::Star => {
                let inner = (0.4 * PI).cos() / (0.2 * PI).cos();
                let corner = |i: i32| {
                    let angle = 0.2 * PI * f64::from(i);
                    DVec2::new(angle.cos(), angle.sin()) * if i % 2 == 1 { 1.0 } else { inner }
                };
                Self::polygon((0..10).map(corner).collect())
            }
            StopShape::Image(image) => {
                let mean = image_values(image).sum::<f64>() / (image.width() * image.height()) as f64;
                Self::Image(Arc::clone(image), 0.25 * PI / mean)
            }
        }
    }

    fn polygon(corners: Vec<DVec2>) -> Self {
        let next = corners.iter().cycle().skip(1);
        let area = 0.5 * corners.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum::<f64>();
        Self::Polygon(corners, PI / area)
    }

    /// At a point of the square around the circle of radius 1.
    pub fn transmittance(&self, p: DVec2) -> f64 {
        match self {
            Self::Round => f64::from(u8::from(p.length_squared() <= 1.0)),
            Self::Gaussian => ((-p.length_squared()).exp() - GAUSSIAN_END).max(0.0) * GAUSSIAN_FACTOR,
            Self::Square => {
                if p.abs().max_element() < 0.5 {
                    PI
                } else {
                    0.0
                }
            }
            Self::Polygon(corners, factor) => {
                if is_inside(corners, p) {
                    *factor
                } else {
                    0.0
                }
            }
            // Its upper edge is up.
            Self::Image(image, factor) => factor * bilinear(image, DVec2::new(0.5 + 0.5 * p.x, 0.5 - 0.5 * p.y)),
        }
    }
}

/// Whether a line from a point to the right crosses an odd number of edges.
fn is_inside(corners: &[DVec2], p: DVec2) -> bool {
    let next = corners.iter().cycle().skip(1);
    let crosses =
        |(a, b): (&DVec2, &DVec2)| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
    corners.iter().zip(next).filter(|&edge| crosses(edge)).count() % 2 == 1
}

/// The mean of the channels of each pixel.
fn image_values(image: &Image) -> impl Iterator<Item = f64> {
    let channels = image.channels().len();
    let mean = move |pixel: &[f32]| pixel.iter().map(|&v| f64::from(v)).sum::<f64>() / channels as f64;
    image.data().chunks_exact(channels).map(mean)
}

/// Between pixels; black outside.
fn bilinear(image: &Image, uv: DVec2) -> f64 {
    let (width, height) = (image.width() as i64, image.height() as i64);
    let channels = image.channels().len();
    let at = |x: i64, y: i64| {
        if !((0..width).contains(&x) && (0..height).contains(&y)) {
            return 0.0;
        }
        let first = (y * width + x) as usize * channels;
        let pixel = &image.data()[first..first + channels];
        pixel.iter().map(|&v| f64::from(v)).sum::<f64>() / channels as f64
    };
    let p = uv * DVec2::new(width as f64, height as f64) - 0.5;
    let corner = p.floor();
    let t = p - corner;
    let (x, y) = (corner.x as i64, corner.y as i64);
    let row = |y: i64| at(x, y) * (1.0 - t.x) + at(x + 1, y) * t.x;
    row(y) * (1.0 - t.y) + row(y + 1) * t.y
}
