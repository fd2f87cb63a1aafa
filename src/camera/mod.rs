//! Cameras: from a point of the film, of the lens and of time to a ray, and from a point of the scene back to the film.

mod aperture;
mod importance;
mod pose;

pub use importance::{CameraConnection, CameraDensity, CameraRay, RasterDomain};

use self::aperture::Aperture;
use self::pose::{CameraFrame, Pose};
use crate::desc::{ApertureDesc, MeasureDesc};
use crate::geometry::{Ray, RayCone};
use crate::math::{AnimatedTransform, Vec2, Vec3};

/// How a camera maps the film onto the scene. In camera space it looks along +z, x is to the right of the picture, y is up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Through a point (or a lens around it).
    Perspective {
        /// The angle, in degrees and in (0, 180), that the span -1 to 1 of the screen window covers.
        fov: f64,
        /// Rays start on the plane at this depth; 0 at the eye or the lens.
        near_clip: f64,
    },
    /// Parallel; the screen window is in scene units.
    Orthographic,
}

/// What a camera is made of.
#[derive(Clone, Debug)]
pub struct CameraSpec {
    /// Its projection.
    pub projection: Projection,
    /// `[x_min, x_max, y_min, y_max]` of the picture on the screen plane.
    pub screen_window: [f64; 4],
    /// Pixels of the whole picture.
    pub resolution: [u32; 2],
    /// Radius of a thin lens; 0 for a pinhole.
    pub lens_radius: f64,
    /// Distance of the plane that the lens images sharply.
    pub focal_distance: f64,
    /// The shape of the lens.
    pub aperture: ApertureDesc,
    /// What a pixel measures.
    pub measure: MeasureDesc,
    /// Scene times at which the shutter opens and closes, in [0, 1] after clamping: outside it everything stands still.
    pub shutter: [f64; 2],
    /// Where the camera is.
    pub world_from_camera: AnimatedTransform,
}

/// A camera of a picture.
#[derive(Clone, Debug)]
pub struct Camera {
    perspective: bool,
    /// Screen plane position of the raster origin, and its change by one pixel right and one down.
    screen_origin: Vec2,
    screen_per_pixel: Vec2,
    near_clip: f32,
    lens_radius: f32,
    focal_distance: f32,
    aperture: Aperture,
    /// The pixel's area on the screen plane, if a pixel is an irradiance.
    irradiance_area: Option<f32>,
    shutter: [f32; 2],
    world_from_camera: AnimatedTransform,
    /// The transforms, where nothing moves.
    fixed: Option<Pose>,
}

/// The numbers that choose a camera ray.
#[derive(Clone, Copy, Debug)]
pub struct CameraSample {
    /// Position on the film in pixels: origin at the top left corner of the picture, y down.
    pub film: Vec2,
    /// Chooses the point of the lens.
    pub lens: Vec2,
    /// Chooses the time within the shutter's opening.
    pub time: f32,
}

impl Camera {
    /// Builds a camera.
    pub fn new(spec: &CameraSpec) -> Self {
        let [x_min, x_max, y_min, y_max] = spec.screen_window;
        let [width, height] = spec.resolution.map(f64::from);
        let (perspective, scale, near_clip) = match spec.projection {
            Projection::Perspective { fov, near_clip } => (true, (0.5 * fov.to_radians()).tan(), near_clip),
            Projection::Orthographic => (false, 1.0, 0.0),
        };
        let per_pixel = [scale * (x_max - x_min) / width, -scale * (y_max - y_min) / height];
        let is_static = spec.world_from_camera.is_static();
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
            shutter: spec.shutter.map(|t| t as f32),
            fixed: is_static.then(|| Pose::new(&spec.world_from_camera.at(0.0))),
            world_from_camera: spec.world_from_camera.clone(),
        }
    }

    /// The ray of a sample, with a direction of unit length.
    #[inline]
    pub fn sample_ray(&self, sample: &CameraSample) -> Ray {
        self.sample_ray_at(sample, self.scene_time(sample.time))
    }

    /// The same at a scene time, whatever the time of the sample.
    #[inline]
    pub fn sample_ray_at(&self, sample: &CameraSample, time: f32) -> Ray {
        let (origin, direction) = self.local_ray(sample);
        // On to the near plane (`direction` has the depth 1).
        let origin = origin + direction * self.near_clip;
        let frame = match &self.fixed {
            Some(pose) => pose.frame,
            None => CameraFrame::new(&self.world_from_camera.at(time)),
        };
        Ray::new(frame.point(origin), frame.vector(direction).normalize(), time)
    }

    /// What the radiance along the ray of a sample counts for a pixel, besides the filter's weight: 1 if the pixel is a mean of
    /// radiance, as in pbrt and Mitsuba.
    ///
    /// If it is an irradiance, the expectation over film, lens and time of this weight times the radiance L is
    ///
    /// - perspective: the integral of L cos θ over the solid angle of the pixel, as the screen at distance 1 subtends it: the
    ///   irradiance that comes through the pixel onto the plane of the eye or, on average, of the lens. The solid angle element is
    ///   cos³ θ times that of the screen, so the weight is the pixel's area there times cos⁴ θ;
    /// - orthographic: the integral of L cos θ over the area of the pixel, in units of camera space; the weight is that area times
    ///   cos θ, which is 1 without a lens.
    ///
    /// θ is the angle between the ray and the camera's axis. A filter that is wider than the pixel is scaled to the same integral.
    #[inline]
    pub fn importance(&self, sample: &CameraSample) -> f32 {
        if self.irradiance_area.is_none() {
            return 1.0;
        }
        self.importance_along(self.local_ray(sample).1)
    }

    /// The same for a direction of camera space whose depth is 1.
    #[inline]
    fn importance_along(&self, direction: Vec3) -> f32 {
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
    #[inline]
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
    fn lens_point(&self, u: Vec2) -> Vec2 {
        self.aperture.sample(u) * self.lens_radius
    }

    /// The area of a pixel on the screen plane.
    #[inline]
    fn pixel_area(&self) -> f32 {
        (self.screen_per_pixel.x * self.screen_per_pixel.y).abs()
    }

    /// How wide the ray through the point `film` (see [`CameraSample::film`]) is, if it stands for a square of `scale` pixels a
    /// side. The lens does not matter: what is out of focus is filtered by its rays.
    #[inline]
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

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn spec(projection: Projection) -> CameraSpec {
        CameraSpec {
            projection,
            screen_window: [-2.0, 2.0, -1.0, 1.0],
            resolution: [200, 100],
            lens_radius: 0.0,
            focal_distance: 5.0,
            aperture: ApertureDesc::Round,
            measure: MeasureDesc::Radiance,
            shutter: [0.25, 0.75],
            world_from_camera: AnimatedTransform::identity(),
        }
    }

    fn sample(x: f32, y: f32) -> CameraSample {
        CameraSample {
            film: Vec2::new(x, y),
            lens: Vec2::new(0.9, 0.3),
            time: 0.5,
        }
    }

    #[test]
    fn fov_is_the_angle_of_the_shorter_side() {
        let camera = Camera::new(&spec(Projection::Perspective {
            fov: 90.0,
            near_clip: 0.0,
        }));
        let top = camera.sample_ray(&sample(100.0, 0.0)).direction;
        assert_relative_eq!(top.y / top.z, 1.0, epsilon = 1e-6);
        let left = camera.sample_ray(&sample(0.0, 50.0));
        assert_relative_eq!(left.direction.x / left.direction.z, -2.0, epsilon = 1e-6);
        assert_eq!((left.time, left.origin), (0.5, Vec3::ZERO));
    }

    #[test]
    fn the_lens_keeps_the_plane_of_focus_sharp() {
        for projection in [
            Projection::Perspective {
                fov: 40.0,
                near_clip: 0.0,
            },
            Projection::Orthographic,
        ] {
            let pinhole = Camera::new(&spec(projection)).sample_ray(&sample(30.0, 80.0));
            let lens = CameraSpec {
                lens_radius: 0.5,
                ..spec(projection)
            };
            let ray = Camera::new(&lens).sample_ray(&sample(30.0, 80.0));
            assert!((ray.origin - pinhole.origin).length() > 0.1);
            let at_focus = |ray: &Ray| ray.origin + ray.direction * ((5.0 - ray.origin.z) / ray.direction.z);
            assert!((at_focus(&ray) - at_focus(&pinhole)).length() < 1e-5);
        }
    }

    #[test]
    fn rays_start_on_the_near_plane() {
        let camera = Camera::new(&spec(Projection::Perspective {
            fov: 60.0,
            near_clip: 3.0,
        }));
        let ray = camera.sample_ray(&sample(10.0, 20.0));
        assert_relative_eq!(ray.origin.z, 3.0, epsilon = 1e-6);
        assert!(ray.origin.normalize().cross(ray.direction).length() < 1e-6);
    }
}
