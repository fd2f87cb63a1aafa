//! Cameras whose film is a plane: perspective and orthographic ones, with a pinhole or a thin lens.

use super::aperture::Aperture;
use super::{CameraSample, CameraSpec, Projection};
use crate::desc::MeasureDesc;
use crate::geometry::RayCone;
use crate::math::{Vec2, Vec3};

/// The film, the lens and what is between them, in camera space.
#[derive(Clone, Debug)]
pub(super) struct Planar {
    pub perspective: bool,
    /// Screen plane position of the raster origin, and its change by one pixel right and one down.
    pub screen_origin: Vec2,
    pub screen_per_pixel: Vec2,
    pub near_clip: f32,
    pub lens_radius: f32,
    pub focal_distance: f32,
    pub aperture: Aperture,
    /// The pixel's area on the screen plane, if a pixel is an irradiance.
    pub irradiance_area: Option<f32>,
}

impl Planar {
    pub fn new(spec: &CameraSpec) -> Self {
        let [x_min, x_max, y_min, y_max] = spec.screen_window;
        let [width, height] = spec.resolution.map(f64::from);
        let (perspective, scale, near_clip) = match spec.projection {
            Projection::Perspective { fov, near_clip } => (true, (0.5 * fov.to_radians()).tan(), near_clip),
            Projection::Orthographic => (false, 1.0, 0.0),
        };
        let per_pixel = [scale * (x_max - x_min) / width, -scale * (y_max - y_min) / height];
        Self {
            perspective,
            screen_origin: Vec2::new((scale * x_min) as f32, (scale * y_max) as f32),
            screen_per_pixel: Vec2::new(per_pixel[0] as f32, per_pixel[1] as f32),
            near_clip: near_clip as f32,
            lens_radius: spec.lens_radius as f32,
            focal_distance: spec.focal_distance as f32,
            aperture: Aperture::new(spec.aperture),
            irradiance_area: match spec.measure {
                MeasureDesc::Radiance => None,
                MeasureDesc::Irradiance => Some((per_pixel[0] * per_pixel[1]).abs() as f32),
            },
        }
    }

    /// Where the ray of a sample starts, on the near plane, and its direction, with z = 1.
    #[inline(always)]
    pub fn local_start(&self, sample: &CameraSample) -> (Vec3, Vec3) {
        let (origin, direction) = self.local_ray(sample);
        (origin + direction * self.near_clip, direction)
    }

    /// See [`super::Camera::importance`].
    #[inline]
    pub fn importance(&self, sample: &CameraSample) -> f32 {
        if self.irradiance_area.is_none() {
            return 1.0;
        }
        self.importance_along(self.local_ray(sample).1)
    }

    /// The same for a direction of camera space whose depth is 1.
    #[inline]
    pub fn importance_along(&self, direction: Vec3) -> f32 {
        let Some(area) = self.irradiance_area else {
            return 1.0;
        };
        let cos_squared = 1.0 / direction.length_squared();
        if self.perspective {
            area * cos_squared * cos_squared
        } else {
            area * cos_squared.sqrt()
        }
    }

    /// Origin, on the lens, and direction, with z = 1, in camera space.
    #[inline(always)]
    fn local_ray(&self, sample: &CameraSample) -> (Vec3, Vec3) {
        let screen = self.screen_origin + sample.film * self.screen_per_pixel;
        let (mut origin, mut direction) = if self.perspective {
            (Vec3::ZERO, screen.extend(1.0))
        } else {
            (screen.extend(0.0), Vec3::Z)
        };
        if self.lens_radius > 0.0 {
            let focus = origin + direction * self.focal_distance;
            origin += self.lens_point(sample.lens).extend(0.0);
            direction = (focus - origin) / self.focal_distance;
        }
        (origin, direction)
    }

    /// The point of the lens that the numbers `u` choose.
    #[inline]
    pub fn lens_point(&self, u: Vec2) -> Vec2 {
        self.aperture.sample(u) * self.lens_radius
    }

    /// The area of a pixel on the screen plane.
    #[inline]
    pub fn pixel_area(&self) -> f32 {
        (self.screen_per_pixel.x * self.screen_per_pixel.y).abs()
    }

    /// See [`super::Camera::ray_cone`].
    #[inline(always)]
    pub fn ray_cone(&self, film: Vec2, scale: f32) -> RayCone {
        let pixel = scale * self.pixel_area().sqrt();
        if !self.perspective {
            return RayCone {
                width: pixel,
                spread: 0.0,
            };
        }
        // A pixel's solid angle is its area on the plane at distance 1 times the cube of the cosine.
        let screen = self.screen_origin + film * self.screen_per_pixel;
        let cos = 1.0 / (1.0 + screen.length_squared()).sqrt();
        let spread = pixel * cos * cos.sqrt();
        RayCone {
            width: spread * self.near_clip / cos,
            spread,
        }
    }
}
