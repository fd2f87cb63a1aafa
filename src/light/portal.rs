//! An environment seen through a portal, a rectangle of the world such as a window, and sampled by what is seen: Bitterli, Novák and
//! Jarosz (2015), "Portal-masked environment map sampling", in the form of pbrt-v4.
//!
//! Directions are drawn in a rectified image of the half space behind the portal, whose axes are the angles of the direction in the
//! planes of the portal's edges: there the portal, from any point, is a rectangle with sides along the axes.

use std::f32::consts::{FRAC_PI_2, PI};

use super::emission::outside;
use super::image::EmissionImage;
use super::{EmissionDensity, EmissionOrigin, EmissionSample};
use crate::math::{Bounds3, Frame, Vec2, Vec3};
use crate::sampling::{AreaPdf, CellDistribution, SolidAnglePdf, WindowedDistribution};
use crate::spectrum::{CompiledSpectrum, SampledSpectrum, Wavelengths};

/// A rectangle that light comes through.
#[derive(Clone, Copy, Debug)]
pub struct Portal {
    corner: Vec3,
    opposite: Vec3,
    frame: Frame,
    area: f32,
}

impl Portal {
    /// With four corners in order. Light comes in through it against the direction (p3 - p0) x (p1 - p0): a point sees it if it is
    /// in that direction. `None` unless it is a rectangle.
    pub fn new(p: [Vec3; 4]) -> Option<Self> {
        const TOLERANCE: f32 = 1e-3;
        let edge = |from: usize, to: usize| (p[to] - p[from]).try_normalize();
        let (p01, p12, p32, p03) = (edge(0, 1)?, edge(1, 2)?, edge(3, 2)?, edge(0, 3)?);
        let parallel = (p01.dot(p32) - 1.0).abs() <= TOLERANCE && (p12.dot(p03) - 1.0).abs() <= TOLERANCE;
        let square = [p01.dot(p12), p12.dot(p32), p32.dot(p03), p03.dot(p01)];
        if !parallel || square.iter().any(|cos| cos.abs() > TOLERANCE) {
            return None;
        }
        let n = p03.cross(p01).normalize();
        Some(Self {
            corner: p[0],
            opposite: p[2],
            frame: Frame {
                s: p03,
                t: n.cross(p03),
                n,
            },
            area: (p[1] - p[0]).length() * (p[3] - p[0]).length(),
        })
    }

    /// The point of the rectified image in the direction `w`; `None` on the side of the scene.
    fn point(&self, w: Vec3) -> Option<Vec2> {
        let w = self.frame.to_local(w);
        (w.z > 0.0).then(|| {
            let angles = Vec2::new(w.x.atan2(w.z), w.y.atan2(w.z));
            ((angles + FRAC_PI_2) / PI).clamp(Vec2::ZERO, Vec2::ONE)
        })
    }

    /// The direction of a point of the rectified image, and the solid angle by area there.
    fn direction(&self, point: Vec2) -> (Vec3, f32) {
        let angles = point * PI - FRAC_PI_2;
        let w = Vec3::new(angles.x.tan(), angles.y.tan(), 1.0).normalize();
        (self.frame.to_world(w), solid_angle(w))
    }

    /// The point of the rectangle at `u` along its edges.
    fn at(&self, u: Vec2) -> Vec3 {
        let diagonal = self.opposite - self.corner;
        let (s, t) = (self.frame.s, self.frame.t);
        self.corner + s * (diagonal.dot(s) * u.x) + t * (diagonal.dot(t) * u.y)
    }

    /// What of the rectified image is seen from `p` through the portal.
    fn window(&self, p: Vec3) -> Option<[Vec2; 2]> {
        let a = self.point((self.corner - p).try_normalize()?)?;
        let b = self.point((self.opposite - p).try_normalize()?)?;
        Some([a.min(b), a.max(b)])
    }
}

/// Solid angle over area of the rectified image, at a direction in the portal's frame.
fn solid_angle(w: Vec3) -> f32 {
    if w.z <= 0.0 {
        return 0.0;
    }
    PI * PI * (1.0 - w.x * w.x) * (1.0 - w.y * w.y) / w.z
}

/// What is behind a portal.
#[derive(Clone, Debug)]
pub enum Behind {
    /// The same radiance from every direction.
    Constant(CompiledSpectrum),
    /// The rectified image.
    Image(EmissionImage),
}

/// An environment behind a portal.
#[derive(Clone, Debug)]
pub struct PortalEnvironment {
    portal: Portal,
    behind: Behind,
    size: [usize; 2],
    /// `None` if all is black.
    distribution: Option<WindowedDistribution>,
    /// Of what goes through any point of the portal: with the cosine there.
    emission: Option<CellDistribution>,
    power: f32,
}

/// Cells along each side of the distribution of a constant environment.
const CONSTANT_CELLS: usize = 64;

impl PortalEnvironment {
    /// `behind` a portal; an image is that of [`PortalEnvironment::rectified`] directions.
    pub fn new(portal: Portal, behind: Behind) -> Self {
        let size = match &behind {
            Behind::Constant(_) => [CONSTANT_CELLS; 2],
            Behind::Image(image) => image.size(),
        };
        let luminance = |x: usize, y: usize| match &behind {
            Behind::Constant(radiance) => radiance.photometric_luminance(),
            Behind::Image(image) => image.luminance(x, y),
        };
        let mut values = Vec::with_capacity(size[0] * size[1]);
        let mut powers = Vec::with_capacity(size[0] * size[1]);
        for y in 0..size[1] {
            for x in 0..size[0] {
                let angles = center(x, y, size) * PI - FRAC_PI_2;
                let w = Vec3::new(angles.x.tan(), angles.y.tan(), 1.0).normalize();
                let value = luminance(x, y) * solid_angle(w);
                values.push(value);
                powers.push(luminance(x, y) * projected_solid_angle([x, y], size) as f32);
            }
        }
        let power: f64 = powers.iter().map(|&power| f64::from(power)).sum();
        Self {
            power: power as f32 * portal.area,
            emission: CellDistribution::new(&powers, size[0]),
            distribution: WindowedDistribution::new(values, size[0]),
            portal,
            behind,
            size,
        }
    }

    /// The directions of the pixels' middles of a rectified image of `side` x `side` pixels, row by row: what its pixels show.
    pub fn rectified(portal: &Portal, side: usize) -> impl Iterator<Item = Vec3> {
        (0..side * side).map(move |i| portal.direction(center(i % side, i / side, [side; 2])).0)
    }

    fn radiance(&self, point: Vec2, lambda: &Wavelengths) -> SampledSpectrum {
        match &self.behind {
            Behind::Constant(radiance) => radiance.sample(lambda),
            Behind::Image(image) => {
                let [x, y] = self.cell(point);
                image.sample(x, y, lambda)
            }
        }
    }

    pub(super) fn le(&self, p: Vec3, w: Vec3, lambda: &Wavelengths) -> SampledSpectrum {
        let point = self.seen(p, w);
        point.map_or(SampledSpectrum::ZERO, |point| self.radiance(point, lambda))
    }

    pub(super) fn pdf_li(&self, p: Vec3, w: Vec3) -> SolidAnglePdf {
        let density = || {
            let (point, window) = (self.portal.point(w)?, self.portal.window(p)?);
            let solid_angle = solid_angle(self.portal.frame.to_local(w));
            let pdf = self.distribution.as_ref()?.pdf(point, window);
            (solid_angle > 0.0).then(|| pdf / solid_angle)
        };
        SolidAnglePdf(density().unwrap_or(0.0))
    }

    /// A direction, its density and its radiance.
    pub(super) fn sample(
        &self,
        p: Vec3,
        u: Vec2,
        lambda: &Wavelengths,
    ) -> Option<(Vec3, SolidAnglePdf, SampledSpectrum)> {
        let window = self.portal.window(p)?;
        let (point, pdf) = self.distribution.as_ref()?.sample(u, window)?;
        let (w, solid_angle) = self.portal.direction(point);
        (solid_angle > 0.0).then(|| (w, SolidAnglePdf(pdf / solid_angle), self.radiance(point, lambda)))
    }

    /// A ray through a point of the portal, uniform by area: by area across the direction that is more, the flatter it passes.
    pub(super) fn sample_le(
        &self,
        u_position: Vec2,
        u_direction: Vec2,
        lambda: &Wavelengths,
        scene: &Bounds3,
    ) -> Option<EmissionSample> {
        let (cell, _) = self.emission.as_ref()?.sample(u_direction);
        let point = (Vec2::new(cell.x as f32, cell.y as f32) + cell.offset) / self.in_cells();
        let (to_sky, _) = self.portal.direction(point);
        let through = self.portal.at(u_position);
        let sample = EmissionSample {
            le: self.radiance(point, lambda),
            origin: EmissionOrigin::Infinity(outside(through, -to_sky, scene)),
            direction: -to_sky,
            density: EmissionDensity::continuous(self.pdf_through(point, to_sky)),
            cos_theta: 1.0,
        };
        sample.checked()
    }

    /// Densities of the ray of [`Self::sample_le`] that comes to `p` from the direction `w`; 0 beside the portal.
    pub(super) fn pdf_le(&self, p: Vec3, w: Vec3) -> (AreaPdf, SolidAnglePdf) {
        match self.seen(p, w) {
            Some(point) => self.pdf_through(point, w),
            None => (AreaPdf(0.0), SolidAnglePdf(0.0)),
        }
    }

    /// Densities of a ray through the portal from the direction `w`, a point of the rectified image.
    fn pdf_through(&self, point: Vec2, w: Vec3) -> (AreaPdf, SolidAnglePdf) {
        let local = self.portal.frame.to_local(w);
        let solid_angle = solid_angle(local);
        let Some(distribution) = self.emission.as_ref().filter(|_| solid_angle > 0.0) else {
            return (AreaPdf(0.0), SolidAnglePdf(0.0));
        };
        let [x, y] = self.cell(point);
        let cells = (self.size[0] * self.size[1]) as f32;
        (
            AreaPdf(1.0 / (self.portal.area * local.z)),
            SolidAnglePdf(distribution.probability(x, y) * cells / solid_angle),
        )
    }

    fn in_cells(&self) -> Vec2 {
        Vec2::new(self.size[0] as f32, self.size[1] as f32)
    }

    /// The cell of a point of the rectified image.
    fn cell(&self, point: Vec2) -> [usize; 2] {
        [0, 1].map(|i| ((point[i] * self.size[i] as f32) as usize).min(self.size[i] - 1))
    }

    /// The point of the rectified image in the direction `w`, if it is seen from `p` through the portal.
    fn seen(&self, p: Vec3, w: Vec3) -> Option<Vec2> {
        let (point, window) = (self.portal.point(w)?, self.portal.window(p)?);
        let inside = point.cmpge(window[0]).all() && point.cmple(window[1]).all();
        inside.then_some(point)
    }

    pub(super) fn power(&self) -> f32 {
        self.power
    }
}

/// The integral of the cosine to the portal's normal over the directions of a pixel. With x and y the tangents of the angles it is
/// that of 1 / (1 + x² + y²)², whose antiderivative is the form factor of a rectangle.
fn projected_solid_angle([x, y]: [usize; 2], size: [usize; 2]) -> f64 {
    let angle = |i: usize, count: usize| (i as f64 / count as f64 - 0.5) * std::f64::consts::PI;
    let corner = |i: usize, k: usize| {
        let (sin_a, cos_a) = angle(i, size[0]).sin_cos();
        let (sin_b, cos_b) = angle(k, size[1]).sin_cos();
        0.5 * (sin_a * (sin_b * cos_a).atan2(cos_b) + sin_b * (sin_a * cos_b).atan2(cos_a))
    };
    corner(x + 1, y + 1) - corner(x, y + 1) - corner(x + 1, y) + corner(x, y)
}

fn center(x: usize, y: usize, size: [usize; 2]) -> Vec2 {
    Vec2::new((x as f32 + 0.5) / size[0] as f32, (y as f32 + 0.5) / size[1] as f32)
}
