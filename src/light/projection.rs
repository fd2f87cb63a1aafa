//! A light at a point that throws a picture, like a slide projector.

use super::delta::towards_point;
use super::image::EmissionImage;
use super::{EmissionSample, LightBounds, LightSample, Place};
use crate::math::{Vec2, Vec3};
use crate::sampling::{Cell, CellDistribution, SolidAnglePdf};
use crate::spectrum::{SampledSpectrum, Wavelengths};

/// Pixels are intensities; the picture is on a screen before +z of its place, its upper edge towards +y, its right one towards +x.
#[derive(Clone, Debug)]
pub struct ProjectionLight {
    place: Place,
    screen: Screen,
    image: Box<EmissionImage>,
    /// Of pixels by their power; `None` if all are black.
    distribution: Option<CellDistribution>,
}

/// The picture at distance 1.
#[derive(Clone, Copy, Debug)]
struct Screen {
    /// Half of its width and height.
    half: Vec2,
    size: [usize; 2],
}

impl Screen {
    /// `fov` in radians is the angle of the shorter side.
    fn new(size: [usize; 2], fov: f32) -> Self {
        let aspect = size[0] as f32 / size[1] as f32;
        let sides = if aspect > 1.0 {
            Vec2::new(aspect, 1.0)
        } else {
            Vec2::new(1.0, 1.0 / aspect)
        };
        Self {
            half: sides * (0.5 * fov).tan(),
            size,
        }
    }

    /// The pixel in the direction `w`; `None` beside the picture and behind it.
    fn pixel(&self, w: Vec3) -> Option<[usize; 2]> {
        if w.z <= 0.0 {
            return None;
        }
        let at = Vec2::new(w.x, -w.y) / w.z;
        let unit = 0.5 * (at / self.half + 1.0);
        let inside = unit.cmpge(Vec2::ZERO).all() && unit.cmple(Vec2::ONE).all();
        inside.then(|| [0, 1].map(|i| ((unit[i] * self.size[i] as f32) as usize).min(self.size[i] - 1)))
    }

    /// The direction of a point of a pixel.
    fn direction(&self, cell: &Cell) -> Vec3 {
        let unit = (Vec2::new(cell.x as f32, cell.y as f32) + cell.offset) / self.in_pixels();
        let at = (2.0 * unit - 1.0) * self.half;
        Vec3::new(at.x, -at.y, 1.0).normalize()
    }

    /// The density, at the direction `w` before the screen, of a point uniform over a pixel's area: dω = cos³θ dA at distance 1.
    fn pixel_pdf(&self, w: Vec3) -> f32 {
        let pixel = 2.0 * self.half / self.in_pixels();
        1.0 / (pixel.x * pixel.y * w.z * w.z * w.z)
    }

    fn in_pixels(&self) -> Vec2 {
        Vec2::new(self.size[0] as f32, self.size[1] as f32)
    }

    /// The solid angle of a pixel.
    fn solid_angle(&self, x: usize, y: usize) -> f32 {
        let edge = |axis: usize, i: usize| {
            let half = f64::from(self.half[axis]);
            half * (2.0 * i as f64 / self.size[axis] as f64 - 1.0)
        };
        // From the middle to a corner.
        let to = |x: f64, y: f64| (x * y / (1.0 + x * x + y * y).sqrt()).atan();
        let (x0, x1, y0, y1) = (edge(0, x), edge(0, x + 1), edge(1, y), edge(1, y + 1));
        (to(x1, y1) - to(x0, y1) - to(x1, y0) + to(x0, y0)) as f32
    }
}

impl ProjectionLight {
    /// With the intensities of `image` (W·sr⁻¹·nm⁻¹); `fov`, in radians, is the angle of its shorter side.
    pub fn new(place: Place, image: EmissionImage, fov: f32) -> Self {
        let size = image.size();
        let screen = Screen::new(size, fov);
        let power = |i: usize| {
            let (x, y) = (i % size[0], i / size[0]);
            image.luminance(x, y) * screen.solid_angle(x, y)
        };
        let powers: Vec<f32> = (0..size[0] * size[1]).map(power).collect();
        Self {
            place,
            screen,
            distribution: CellDistribution::new(&powers, size[0]),
            image: Box::new(image),
        }
    }

    /// This light, `factor` times as bright.
    #[must_use]
    pub fn scaled(mut self, factor: f32) -> Self {
        self.image = Box::new(self.image.scaled(factor));
        self
    }

    pub(super) fn place(&self) -> &Place {
        &self.place
    }

    pub(super) fn sample_li(&self, p: Vec3, time: f32, lambda: &Wavelengths) -> Option<LightSample> {
        let pose = self.place.at(time);
        towards_point(p, pose.position, |w| {
            let pixel = self.screen.pixel(pose.local_direction(w));
            pixel.map_or(SampledSpectrum::ZERO, |[x, y]| self.image.sample(x, y, lambda))
        })
    }

    pub(super) fn sample_le(&self, time: f32, u: Vec2, lambda: &Wavelengths) -> Option<EmissionSample> {
        let (cell, probability) = self.distribution.as_ref()?.sample(u);
        let pose = self.place.at(time);
        let local = self.screen.direction(&cell);
        let w = pose.world_direction(local);
        let pdf = probability * self.screen.pixel_pdf(local) * pose.stretch(w);
        let intensity = self.image.sample(cell.x, cell.y, lambda);
        EmissionSample::from_point(pose.position, w, intensity, SolidAnglePdf(pdf))
    }

    /// Density of a direction of [`Self::sample_le`].
    pub(super) fn pdf_le(&self, w: Vec3, time: f32) -> SolidAnglePdf {
        let pose = self.place.at(time);
        let local = pose.local_direction(w);
        SolidAnglePdf(match (&self.distribution, self.screen.pixel(local)) {
            (Some(distribution), Some([x, y])) => {
                distribution.probability(x, y) * self.screen.pixel_pdf(local) * pose.stretch(w)
            }
            _ => 0.0,
        })
    }

    pub(super) fn bounds(&self) -> LightBounds {
        let all_around = LightBounds::omnidirectional(self.place.bounds(), self.image.mean_luminance());
        if !self.place.is_static() {
            return all_around;
        }
        let corner = self.screen.half.extend(1.0).normalize();
        LightBounds {
            axis: self.place.at(0.0).axis(),
            cos_normals: corner.z,
            cos_emission: 1.0,
            ..all_around
        }
    }

    /// See [`Light::power`](super::Light::power).
    pub fn power(&self) -> f32 {
        self.image.sum(|x, y| self.screen.solid_angle(x, y))
    }
}
