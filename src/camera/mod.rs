//! Cameras: from a point of the film, of the lens and of time to a ray, and from a point of the scene back to the film.

mod aperture;
mod importance;
mod lanes;
mod planar;
mod pose;
mod realistic;
mod spherical;

use std::sync::Arc;

pub use self::importance::{CameraConnection, CameraDensity, CameraRay, RasterDomain};
pub use self::lanes::{CameraLanes, CameraSampleLanes};
pub use self::realistic::{Realistic, RealisticSpec};

use self::planar::Planar;
use self::pose::{CameraFrame, Pose};
use self::spherical::Spherical;
use crate::desc::{ApertureDesc, MeasureDesc};
use crate::geometry::{Ray, RayCone};
use crate::math::{AnimatedTransform, DAffine3, Vec2, Vec3};
use crate::sampling::SphereMap;

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

/// What a camera with a flat screen is made of.
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
    eye: Eye,
    shutter: [f32; 2],
    world_from_camera: AnimatedTransform,
    /// The transforms, where nothing moves.
    fixed: Option<Pose>,
}

/// How film positions become rays, in camera space.
#[derive(Clone, Debug)]
enum Eye {
    Planar(Planar),
    Spherical(Spherical),
    Realistic(Arc<Realistic>),
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
    /// Builds a camera with a flat screen.
    pub fn new(spec: &CameraSpec) -> Self {
        Self::of_eye(Eye::Planar(Planar::new(spec)), spec.shutter, &spec.world_from_camera)
    }

    /// A camera at a point that sees all around, onto `resolution` pixels. The pole of the map is up (+y), its second axis is forward (+z).
    pub fn spherical(
        map: SphereMap,
        resolution: [u32; 2],
        shutter: [f64; 2],
        world_from_camera: &AnimatedTransform,
    ) -> Self {
        Self::of_eye(
            Eye::Spherical(Spherical::new(map, resolution)),
            shutter,
            world_from_camera,
        )
    }

    /// A camera that looks through lenses.
    pub fn realistic(lens: Realistic, shutter: [f64; 2], world_from_camera: &AnimatedTransform) -> Self {
        Self::of_eye(Eye::Realistic(Arc::new(lens)), shutter, world_from_camera)
    }

    fn of_eye(eye: Eye, shutter: [f64; 2], world_from_camera: &AnimatedTransform) -> Self {
        let is_static = world_from_camera.is_static();
        Self {
            eye,
            shutter: shutter.map(|t| t as f32),
            fixed: is_static.then(|| Pose::new(&world_from_camera.at(0.0))),
            world_from_camera: world_from_camera.clone(),
        }
    }

    /// The ray of a sample, with a direction of unit length, and its [importance](Camera::importance). `None` if nothing comes through
    /// the lenses.
    #[inline]
    pub fn generate_ray(&self, sample: &CameraSample) -> Option<(Ray, f32)> {
        self.ray_at(sample, self.scene_time(sample.time))
    }

    /// [`Camera::generate_ray`], at a scene time whatever the time of the sample.
    #[inline]
    pub fn ray_at(&self, sample: &CameraSample, time: f32) -> Option<(Ray, f32)> {
        let (origin, direction, importance) = match &self.eye {
            Eye::Planar(planar) => {
                let (origin, direction) = planar.local_start(sample);
                (origin, direction, planar.importance(sample))
            }
            Eye::Spherical(spherical) => (Vec3::ZERO, spherical.direction(sample.film), 1.0),
            Eye::Realistic(lens) => lens.ray(sample)?,
        };
        let frame = match &self.fixed {
            Some(pose) => pose.frame,
            None => CameraFrame::new(&self.world_from_camera.at(time)),
        };
        let ray = Ray::new(frame.point(origin), frame.vector(direction).normalize(), time);
        Some((ray, importance))
    }

    /// The ray of a sample of a camera that has one for each.
    ///
    /// # Panics
    /// If there is none: see [`Camera::generate_ray`].
    #[inline]
    pub fn sample_ray(&self, sample: &CameraSample) -> Ray {
        let (ray, _) = self.generate_ray(sample).expect("a camera without vignetting");
        ray
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
    ///
    /// Behind lenses a pixel is the irradiance of the film, over that of a lens of the same distance and an area of its square, as in pbrt-v4.
    #[inline]
    pub fn importance(&self, sample: &CameraSample) -> f32 {
        match &self.eye {
            Eye::Planar(planar) => planar.importance(sample),
            Eye::Spherical(_) => 1.0,
            Eye::Realistic(lens) => lens.ray(sample).map_or(0.0, |(_, _, weight)| weight),
        }
    }

    /// How wide the ray through the point `film` (see [`CameraSample::film`]) is, if it stands for a square of `scale` pixels a
    /// side. The lens does not matter: what is out of focus is filtered by its rays.
    #[inline]
    pub fn ray_cone(&self, film: Vec2, scale: f32) -> RayCone {
        match &self.eye {
            Eye::Planar(planar) => planar.ray_cone(film, scale),
            Eye::Spherical(spherical) => spherical.ray_cone(film, scale),
            Eye::Realistic(lens) => lens.ray_cone(scale),
        }
    }

    /// Whether light paths can be connected to it.
    pub fn takes_light_paths(&self) -> bool {
        !matches!(self.eye, Eye::Realistic(_))
    }

    /// Whether it stays where it is.
    pub fn is_static(&self) -> bool {
        self.world_from_camera.is_static()
    }

    /// Where the world is in the camera's space, at a scene time.
    pub fn camera_from_world(&self, time: f32) -> DAffine3 {
        self.with_pose(time, |pose| pose.camera_from_world)
    }

    /// The scene time at which the shutter has been open for the share `u` of its time (see [`CameraSample::time`]).
    #[inline]
    pub fn scene_time(&self, u: f32) -> f32 {
        (self.shutter[0] + u * (self.shutter[1] - self.shutter[0])).clamp(0.0, 1.0)
    }

    /// Connects the point `p` to the camera at scene time `time`; `u_lens` are the numbers of a [`CameraSample`]: they choose
    /// the point of the lens (perspective), the direction (orthographic), or one of several film positions of the same direction
    /// (spherical, near the edges); a pinhole uses none.
    ///
    /// `None` if `p` is behind the camera or before its near plane, if no pixel of `domain` sees it, or if the camera
    /// [takes no light paths](Camera::takes_light_paths).
    #[inline]
    pub fn sample_wi(&self, p: Vec3, time: f32, u_lens: Vec2, domain: &RasterDomain) -> Option<CameraConnection> {
        self.with_pose(time, |pose| match &self.eye {
            Eye::Planar(planar) => planar.sample_wi(pose, p, u_lens, domain),
            Eye::Spherical(spherical) => spherical.sample_wi(pose, p, u_lens, domain),
            Eye::Realistic(_) => None,
        })
    }

    /// What the camera has to do with the ray in the direction `w` (unit length) that meets the point `p`, in front of it, at scene
    /// time `time`. It must be one of its rays: that it crosses the lens, or has the one direction that there is, is not checked,
    /// nor that a pixel sees it.
    ///
    /// `None` if `p` is behind the camera or before its near plane, if `w` goes back to it, or if the camera
    /// [takes no light paths](Camera::takes_light_paths).
    #[inline]
    pub fn pdf_we(&self, p: Vec3, w: Vec3, time: f32) -> Option<CameraRay> {
        self.with_pose(time, |pose| match &self.eye {
            Eye::Planar(planar) => planar.pdf_we(pose, p, w),
            Eye::Spherical(spherical) => spherical.pdf_we(pose, p),
            Eye::Realistic(_) => None,
        })
    }

    #[inline]
    fn with_pose<R>(&self, time: f32, f: impl FnOnce(&Pose) -> R) -> R {
        match &self.fixed {
            Some(pose) => f(pose),
            None => f(&Pose::new(&self.world_from_camera.at(time))),
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
