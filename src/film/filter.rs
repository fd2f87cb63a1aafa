//! Pixel filters, sampled in proportion to their value, so that a camera sample belongs to one pixel.

use crate::desc::FilterKind;
use crate::math::{Kernel, LANES, Lanes, Vec2, Vec2Lanes, VectorLanes, Vectorizer};
use crate::sampling::{PiecewiseConstant1D, warp};

impl FilterKind {
    /// The value of the filter of support `radius` at the distance `x` from the pixel's centre; 0 outside.
    pub fn evaluate(&self, x: f64, radius: f64) -> f64 {
        let x = x.abs();
        if x > radius {
            return 0.0;
        }
        match *self {
            Self::Box => 1.0,
            Self::Triangle => radius - x,
            Self::Gaussian { sigma } => gaussian(x, sigma) - gaussian(radius, sigma),
            Self::Mitchell { b, c } => mitchell(2.0 * x / radius, b, c),
            Self::LanczosSinc { tau } => sinc(x) * sinc(x / tau),
            Self::BlackmanHarris => {
                let phase = std::f64::consts::PI * (1.0 + x / radius);
                0.35875 - 0.48829 * phase.cos() + 0.14128 * (2.0 * phase).cos() - 0.01168 * (3.0 * phase).cos()
            }
        }
    }
}

fn gaussian(x: f64, sigma: f64) -> f64 {
    (-x * x / (2.0 * sigma * sigma)).exp()
}

/// The piecewise cubic of Mitchell and Netravali on [0, 2].
fn mitchell(x: f64, b: f64, c: f64) -> f64 {
    let (x2, x3) = (x * x, x * x * x);
    if x <= 1.0 {
        ((12.0 - 9.0 * b - 6.0 * c) * x3 + (-18.0 + 12.0 * b + 6.0 * c) * x2 + (6.0 - 2.0 * b)) / 6.0
    } else {
        ((-b - 6.0 * c) * x3 + (6.0 * b + 30.0 * c) * x2 + (-12.0 * b - 48.0 * c) * x + (8.0 * b + 24.0 * c)) / 6.0
    }
}

/// sin(pi x) / (pi x).
fn sinc(x: f64) -> f64 {
    let px = std::f64::consts::PI * x;
    if px.abs() < 1e-5 { 1.0 } else { px.sin() / px }
}

/// A point of a filter's support.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterSample {
    /// Offset from the pixel's centre, in pixels.
    pub offset: Vec2,
    /// The filter's value over the density of the sample and the filter's integral: its mean is 1; negative in negative lobes.
    pub weight: f32,
}

/// [`FilterSample`]s of eight pixels.
#[derive(Clone, Copy, Debug, Default)]
pub struct FilterLanes {
    /// The pixel's centre and [`FilterSample::offset`] from there.
    pub film: Vec2Lanes,
    /// See [`FilterSample::weight`].
    pub weight: Lanes,
}

/// A separable pixel filter.
#[derive(Clone, Debug)]
pub struct PixelFilter {
    kind: FilterKind,
    axes: [FilterAxis; 2],
}

/// One factor, ready to be sampled.
#[derive(Clone, Debug)]
struct FilterAxis {
    radius: f64,
    integral: f64,
    /// What a Gaussian is lowered by, to be 0 at the radius.
    lowered: f64,
    /// A bound of the magnitude of the value over the integral.
    peak: f64,
    /// For filters without a closed-form inverse: proposals in proportion to |value|, nearly.
    table: Option<PiecewiseConstant1D>,
}

/// Cells of a table for each pixel of the filter's diameter.
const CELLS_PER_PIXEL: f64 = 128.0;

impl PixelFilter {
    /// With a support of `radius` pixels in x and y (positive). `None` if the filter is zero everywhere or integrates to zero.
    pub fn new(kind: FilterKind, radius: [f64; 2]) -> Option<Self> {
        let [x, y] = radius;
        Some(Self {
            kind,
            axes: [FilterAxis::new(kind, x)?, FilterAxis::new(kind, y)?],
        })
    }

    /// Half the width of the support, in pixels.
    pub fn radius(&self) -> Vec2 {
        Vec2::new(self.axes[0].radius as f32, self.axes[1].radius as f32)
    }

    /// The same in double precision, for columns and for rows.
    pub(super) fn radii(&self) -> [f64; 2] {
        [self.axes[0].radius, self.axes[1].radius]
    }

    /// A bound of the magnitude of [`PixelFilter::evaluate`].
    pub(super) fn peak(&self) -> f64 {
        self.axes[0].peak * self.axes[1].peak
    }

    /// The filter over its integral, per pixel area, at an offset from the pixel's centre: 1 in the whole pixel for a box of radius
    /// 1/2. It integrates to 1, as the mean of [`FilterSample::weight`] is 1. 0 outside of the support.
    #[inline]
    pub fn evaluate(&self, offset: Vec2) -> f32 {
        let [x, y] = self.axes.each_ref();
        (x.evaluate(self.kind, f64::from(offset.x)) * y.evaluate(self.kind, f64::from(offset.y))) as f32
    }

    /// The factor of [`PixelFilter::evaluate`] for the offset `x` along an axis, 0 for columns and 1 for rows.
    #[inline]
    pub(super) fn evaluate_axis(&self, axis: usize, x: f64) -> f64 {
        self.axes[axis].evaluate(self.kind, x)
    }

    /// Samples an offset.
    #[inline]
    pub fn sample(&self, u: Vec2) -> FilterSample {
        let (x, wx) = self.axes[0].sample(self.kind, u.x);
        let (y, wy) = self.axes[1].sample(self.kind, u.y);
        FilterSample {
            offset: Vec2::new(x, y),
            weight: wx * wy,
        }
    }

    /// [`Self::sample`] of eight pixels, which `pixel` tells: the same bits, several times faster for a box and a triangle.
    #[inline]
    pub fn sample_lanes(
        &self,
        vectorizer: Vectorizer,
        pixel: impl Fn(usize) -> [u32; 2],
        u: [&Lanes; 2],
    ) -> FilterLanes {
        let filter = self;
        match self.kind {
            FilterKind::Box => return vectorizer.run(SamplePlain::<false, _> { filter, pixel, u }),
            FilterKind::Triangle => return vectorizer.run(SamplePlain::<true, _> { filter, pixel, u }),
            _ => {}
        }
        let mut lanes = FilterLanes::default();
        let [u_x, u_y] = u;
        for (i, (&x, &y)) in u_x.iter().zip(u_y).enumerate() {
            let FilterSample { offset, weight } = self.sample(Vec2::new(x, y));
            lanes.film.set(i, center(pixel(i)) + offset);
            lanes.weight[i] = weight;
        }
        lanes
    }
}

#[inline(always)]
fn center([x, y]: [u32; 2]) -> Vec2 {
    Vec2::new(x as f32 + 0.5, y as f32 + 0.5)
}

/// [`PixelFilter::sample_lanes`] of a box or a triangle, whose weights are 1.
struct SamplePlain<'a, const IS_TRIANGLE: bool, P> {
    filter: &'a PixelFilter,
    pixel: P,
    u: [&'a Lanes; 2],
}

impl<const IS_TRIANGLE: bool, P: Fn(usize) -> [u32; 2]> Kernel for SamplePlain<'_, IS_TRIANGLE, P> {
    type Output = FilterLanes;

    #[inline(always)]
    fn call(self) -> FilterLanes {
        let [x, y] = &self.filter.axes;
        let (radius_x, radius_y) = (x.radius as f32, y.radius as f32);
        let mut lanes = FilterLanes::default();
        for i in 0..LANES {
            let x = plain_offset(IS_TRIANGLE, radius_x, self.u[0][i]);
            let y = plain_offset(IS_TRIANGLE, radius_y, self.u[1][i]);
            lanes.film.set(i, center((self.pixel)(i)) + Vec2::new(x, y));
            lanes.weight[i] = 1.0;
        }
        lanes
    }
}

impl FilterAxis {
    fn new(kind: FilterKind, radius: f64) -> Option<Self> {
        let cells = (2.0 * radius * CELLS_PER_PIXEL).ceil().max(64.0) as usize;
        let width = 2.0 * radius / cells as f64;
        let center = |cell: usize| -radius + (cell as f64 + 0.5) * width;
        let integral: f64 = (0..cells).map(|cell| simpson(kind, center(cell), width, radius)).sum();
        if !integral.is_finite() || integral.abs() < 1e-9 * radius {
            return None;
        }
        // The largest value in a cell, so that the density is positive wherever the filter is not zero.
        let largest = |cell: usize| {
            let (left, right) = (center(cell) - 0.5 * width, center(cell) + 0.5 * width);
            [left, center(cell), right]
                .map(|x| kind.evaluate(x.clamp(-radius, radius), radius).abs())
                .into_iter()
                .fold(0.0, f64::max)
        };
        // Filters are smooth: between the points that were looked at they do not rise to twice that.
        let peak = 2.0 * (0..cells).map(largest).fold(0.0, f64::max) / integral.abs();
        let table = match kind {
            FilterKind::Box | FilterKind::Triangle => None,
            _ => {
                let values: Vec<f32> = (0..cells).map(|cell| largest(cell) as f32).collect();
                Some(PiecewiseConstant1D::new(&values, -radius as f32, radius as f32)?)
            }
        };
        Some(Self {
            radius,
            integral,
            lowered: match kind {
                FilterKind::Gaussian { sigma } => gaussian(radius, sigma),
                _ => 0.0,
            },
            peak,
            table,
        })
    }

    /// The filter's value over its integral.
    #[inline]
    fn evaluate(&self, kind: FilterKind, x: f64) -> f64 {
        let value = match kind {
            FilterKind::Gaussian { sigma } if x.abs() <= self.radius => gaussian(x, sigma) - self.lowered,
            _ => kind.evaluate(x, self.radius),
        };
        value / self.integral
    }

    /// An offset, and the filter's value over its integral and the density.
    #[inline]
    fn sample(&self, kind: FilterKind, u: f32) -> (f32, f32) {
        match (&self.table, kind) {
            (Some(table), _) => {
                let (x, pdf, _) = table.sample(u);
                let value = self.evaluate(kind, f64::from(x));
                (x, (value / f64::from(pdf)) as f32)
            }
            (None, _) => (plain_offset(kind == FilterKind::Triangle, self.radius as f32, u), 1.0),
        }
    }
}

/// An offset of a triangle, or else of a box.
#[inline(always)]
fn plain_offset(is_triangle: bool, radius: f32, u: f32) -> f32 {
    if is_triangle {
        warp::sample_tent(u, radius)
    } else {
        (2.0 * u - 1.0) * radius
    }
}

/// The integral over one cell by Simpson's rule.
fn simpson(kind: FilterKind, center: f64, width: f64, radius: f64) -> f64 {
    let at = |x: f64| kind.evaluate(x.clamp(-radius, radius), radius);
    width / 6.0 * (at(center - 0.5 * width) + 4.0 * at(center) + at(center + 0.5 * width))
}

#[cfg(test)]
mod tests {
    use super::*;

    const KINDS: [FilterKind; 6] = [
        FilterKind::Box,
        FilterKind::Triangle,
        FilterKind::Gaussian { sigma: 0.5 },
        FilterKind::Mitchell {
            b: 1.0 / 3.0,
            c: 1.0 / 3.0,
        },
        FilterKind::LanczosSinc { tau: 3.0 },
        FilterKind::BlackmanHarris,
    ];

    /// Weighted samples must reproduce the moments of the filter itself.
    #[test]
    fn samples_integrate_the_filter() {
        for kind in KINDS {
            let radius = 1.75;
            let filter = PixelFilter::new(kind, [radius, 0.5]).unwrap();
            let count = 200_000;
            let (mut estimate, mut weights) = ([0.0_f64; 2], 0.0_f64);
            for i in 0..count {
                let sample = filter.sample(Vec2::new((i as f32 + 0.5) / count as f32, 0.37));
                let (wx, x) = (
                    f64::from(filter.axes[0].sample(kind, (i as f32 + 0.5) / count as f32).1),
                    f64::from(sample.offset.x),
                );
                weights += wx;
                estimate[0] += wx * x * x;
                estimate[1] += wx * x.powi(4);
            }
            let steps = 100_000;
            let (mut integral, mut moments) = (0.0, [0.0_f64; 2]);
            for i in 0..steps {
                let x = radius * (2.0 * (f64::from(i) + 0.5) / f64::from(steps) - 1.0);
                let f = kind.evaluate(x, radius);
                integral += f;
                moments[0] += f * x * x;
                moments[1] += f * x.powi(4);
            }
            assert!(
                (weights / f64::from(count) - 1.0).abs() < 1e-3,
                "{kind:?}: mean weight {}",
                weights / f64::from(count)
            );
            for i in 0..2 {
                let (got, expected) = (estimate[i] / f64::from(count), moments[i] / integral);
                assert!(
                    (got - expected).abs() < 2e-3,
                    "{kind:?}: moment {i} is {got}, expected {expected}"
                );
            }
        }
    }

    #[test]
    fn mitchell_is_continuous_and_ends_at_zero() {
        let kind = FilterKind::Mitchell {
            b: 1.0 / 3.0,
            c: 1.0 / 3.0,
        };
        assert!((kind.evaluate(1.0 - 1e-9, 2.0) - kind.evaluate(1.0 + 1e-9, 2.0)).abs() < 1e-8);
        assert!(kind.evaluate(2.0, 2.0).abs() < 1e-12);
        assert!(kind.evaluate(1.5, 2.0) < 0.0);
    }

    #[test]
    fn a_filter_that_cancels_is_refused() {
        assert!(PixelFilter::new(FilterKind::Gaussian { sigma: 1e300 }, [1.0, 1.0]).is_none());
    }
}
