//! A light at a point that throws a picture, like a slide projector.

use super::delta::towards_point;
use super::image::EmissionImage;
use super::{LightBounds, LightSample, Place};
use crate::math::{Vec2, Vec3};
use crate::spectrum::{SampledSpectrum, Wavelengths};

/// Pixels are intensities; the picture is on a screen before +z of its place, its upper edge towards +y, its right one towards +x.
#[derive(Clone, Debug)]
pub struct ProjectionLight {
    place: Place,
    screen: Screen,
    image: Box<EmissionImage>,
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
        Self {
            place,
            screen: Screen::new(image.size(), fov),
            image: Box::new(image),
        }
    }

    /// This light, `factor` times as bright.
    #[must_use]
    pub fn scaled(mut self, factor: f32) -> Self {
        self.image = Box::new(self.image.scaled(factor));
        self
    }

    pub(super) fn sample_li(&self, p: Vec3, time: f32, lambda: &Wavelengths) -> Option<LightSample> {
        let pose = self.place.at(time);
        towards_point(p, pose.position, |w| {
            let pixel = self.screen.pixel(pose.local_direction(w));
            pixel.map_or(SampledSpectrum::ZERO, |[x, y]| self.image.sample(x, y, lambda))
        })
    }

    pub(super) fn bounds(&self) -> LightBounds {
        let [width, height] = self.image.size();
        let intensity = self.image.sum(|_, _| 1.0) / (width * height) as f32;
        let all_around = LightBounds::omnidirectional(self.place.bounds(), intensity);
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
