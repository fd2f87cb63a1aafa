//! The camera as a receiver: where a point of the scene lands on the film, what it counts there, and how likely camera subpaths are.
//!
//! The value of a pixel (without filter) is the integral of W_e(o, w) L(o, w) cos θ over the points o of the plane of the lens, by
//! area, and directions w, by solid angle; θ is the angle at the lens. W_e is the importance (Veach 1997, chapter 4). A camera
//! sample, uniform over the pixel and the numbers of the lens, has a density p(o) p(w | o); it estimates the same integral by its
//! [`Camera::importance`](super::Camera::importance) I times L, so that
//!
//! ```text
//! W_e cos θ = I p(o) p(w | o).
//! ```
//!
//! Seen from the scene, there are two kinds of cameras with a flat screen, as of lights (light paths do not reach cameras behind lenses):
//!
//! - A perspective camera is like an area light, or a point. The lens number chooses o, with p(o) = 1 / area of the lens; the film
//!   position then chooses w: with d = (x, y, 1) the direction in camera space, the solid angle of dx dy is |det M| / |M d|³ dx dy
//!   where M takes camera space to the world, and one pixel is A = dx dy. So p(w | o) = |M d|³ / (A |det M|), which is
//!   1 / (A cos³ θ) if M is a rigid motion, and W_e is 1 / (A A_lens cos⁴ θ).
//! - A spherical camera is like a point too; what a film position means is in `spherical.rs`.
//! - An orthographic camera is like a distant light, or an environment seen through a disk. The lens number chooses w, as all rays
//!   through one point of the lens are parallel: from o = s + l on the plane of the lens to the plane of focus behind s, d = (-l / f, 1).
//!   The film position then chooses o, with p(o) = 1 / (area of the pixel).

use super::planar::Planar;
use crate::math::{Vec2, Vec3};
use crate::sampling::{AreaPdf, SolidAnglePdf};

use super::pose::Pose;

/// The film positions that pixels of a picture see: its raster, grown by how far the pixel filter reaches beyond a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RasterDomain {
    min: Vec2,
    max: Vec2,
}

impl RasterDomain {
    /// For a whole picture of `resolution` pixels and a filter that reaches `filter_radius` pixels from the centre of a pixel.
    pub fn new(resolution: [u32; 2], filter_radius: Vec2) -> Self {
        let beyond = filter_radius - 0.5;
        Self {
            min: -beyond,
            max: Vec2::new(resolution[0] as f32, resolution[1] as f32) + beyond,
        }
    }

    /// The smallest x and y, and the largest.
    pub fn corners(&self) -> [Vec2; 2] {
        [self.min, self.max]
    }

    /// Whether some pixel may see the film position.
    #[inline]
    pub fn contains(&self, film: Vec2) -> bool {
        film.cmpge(self.min).all() && film.cmplt(self.max).all()
    }
}

/// A density, or a delta function in its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CameraDensity<P> {
    /// A density with respect to the measure of `P`.
    Continuous(P),
    /// One point, or one direction.
    Delta,
}

/// What a camera has to do with a ray that leaves it.
///
/// Densities are of camera subpaths where each pixel, and the film beyond the picture as well, has one sample for each unit area of
/// film: they integrate to the number of pixels.
#[derive(Clone, Copy, Debug)]
pub struct CameraRay {
    /// Film position (see [`super::CameraSample::film`]); may be outside of the picture.
    pub film: Vec2,
    /// Importance W_e, by area of the plane of the lens and solid angle; where a density is [`CameraDensity::Delta`], the factor of
    /// that delta function.
    pub we: f32,
    /// What a camera sample on this ray counts besides the filter: [`Camera::importance`](super::Camera::importance).
    pub importance: f32,
    /// Density p(o) by area of the point where the ray crosses the plane of the lens. Delta for a perspective camera without a lens.
    pub position: CameraDensity<AreaPdf>,
    /// Density p(w | o) by solid angle. Delta for an orthographic camera without a lens.
    pub direction: CameraDensity<SolidAnglePdf>,
    /// Density by area with which camera rays of the same lens numbers arrive at the point of the ray that was asked for, on a
    /// surface that faces the ray; on another it is this times |cos| of the angle between its normal and the ray.
    ///
    /// It is all that weights need, for any camera: the ratio of the densities of the camera subpath of this one vertex and of
    /// the connection that [`Camera::sample_wi`](super::Camera::sample_wi) makes to the lens.
    pub arrival: AreaPdf,
}

/// A connection of a point to the camera.
#[derive(Clone, Copy, Debug)]
pub struct CameraConnection {
    /// The ray from the camera to the point.
    pub ray: CameraRay,
    /// Unit direction from the point to the camera.
    pub wi: Vec3,
    /// Where the shadow ray ends: camera rays start here, on the near plane.
    pub end: Vec3,
    /// The point of the plane of the lens.
    pub lens: Vec3,
    /// Unit normal of that plane, towards the scene.
    pub normal: Vec3,
    /// Density of `wi` by solid angle at the point. Delta for a camera without a lens.
    pub density: CameraDensity<SolidAnglePdf>,
}

impl CameraConnection {
    /// W_e over the density of the connection: light that leaves the point with throughput `beta` (radiance over the density of its
    /// path) and is scattered by `f` counts beta f |cos| times this at [`CameraRay::film`], for each unit area of film. The cosine
    /// is that at the point; those at the lens and distances are included. For all cameras it is `importance` times `arrival`.
    #[inline]
    pub fn weight(&self) -> f32 {
        self.ray.importance * self.ray.arrival.0
    }
}

/// A ray in camera space: crosses the plane of the lens at `origin`, goes in `direction` (the depth of which is 1), and is
/// followed to `depth`.
struct LocalRay {
    origin: Vec2,
    direction: Vec2,
    depth: f32,
}

impl Planar {
    /// See [`super::Camera::sample_wi`].
    #[inline]
    pub fn sample_wi(&self, pose: &Pose, p: Vec3, u_lens: Vec2, domain: &RasterDomain) -> Option<CameraConnection> {
        let local = pose.camera_from_world.transform_point3(p.as_dvec3());
        if !self.sees_depth(local.z) {
            return None;
        }
        let lens = self.lens_point(u_lens);
        let across = local.truncate();
        let (origin, direction) = if self.perspective {
            (lens, ((across - lens.as_dvec2()) / local.z).as_vec2())
        } else {
            let direction = self.parallel_direction(lens);
            ((across - direction.as_dvec2() * local.z).as_vec2(), direction)
        };
        let local = LocalRay {
            origin,
            direction,
            depth: local.z as f32,
        };
        let film = self.film_of(&local);
        domain.contains(film).then(|| self.connection(pose, &local, film))
    }

    /// See [`super::Camera::pdf_we`].
    #[inline]
    pub fn pdf_we(&self, pose: &Pose, p: Vec3, w: Vec3) -> Option<CameraRay> {
        let local = pose.camera_from_world.transform_point3(p.as_dvec3());
        let direction = pose.camera_from_world.transform_vector3(w.as_dvec3());
        if !(self.sees_depth(local.z) && direction.z > 0.0) {
            return None;
        }
        let slope = direction.truncate() / direction.z;
        let local = LocalRay {
            origin: (local.truncate() - slope * local.z).as_vec2(),
            direction: slope.as_vec2(),
            depth: local.z as f32,
        };
        Some(self.camera_ray(pose, &local, self.film_of(&local)))
    }

    /// Whether camera rays pass this depth.
    #[inline]
    fn sees_depth(&self, z: f64) -> bool {
        z > f64::from(self.near_clip)
    }

    /// The direction, but for its depth of 1, of the rays of an orthographic camera through a point of the lens.
    #[inline]
    fn parallel_direction(&self, lens: Vec2) -> Vec2 {
        if self.lens_radius > 0.0 {
            -lens / self.focal_distance
        } else {
            Vec2::ZERO
        }
    }

    /// The film position whose rays meet at the point in focus of this one.
    #[inline]
    fn film_of(&self, ray: &LocalRay) -> Vec2 {
        let has_lens = self.lens_radius > 0.0;
        let screen = match (self.perspective, has_lens) {
            (true, false) => ray.direction,
            (true, true) => ray.direction + ray.origin / self.focal_distance,
            (false, false) => ray.origin,
            (false, true) => ray.origin + ray.direction * self.focal_distance,
        };
        (screen - self.screen_origin) / self.screen_per_pixel
    }

    fn connection(&self, pose: &Pose, local: &LocalRay, film: Vec2) -> CameraConnection {
        let ray = self.camera_ray(pose, local, film);
        let direction = local.direction.extend(1.0);
        let lens = local.origin.extend(0.0);
        let stretched = pose.frame.vector(direction);
        let wi = -stretched.normalize();
        let density = match (self.perspective, ray.position, ray.direction) {
            (true, CameraDensity::Continuous(position), _) => {
                let distance_squared = stretched.length_squared() * local.depth * local.depth;
                CameraDensity::Continuous(position.to_solid_angle(distance_squared, pose.normal.dot(wi)))
            }
            (true, CameraDensity::Delta, _) => CameraDensity::Delta,
            (false, _, direction) => direction,
        };
        CameraConnection {
            ray,
            wi,
            end: pose.frame.point(lens + direction * self.near_clip),
            lens: pose.frame.point(lens),
            normal: pose.normal,
            density,
        }
    }

    /// The densities of the module's head.
    fn camera_ray(&self, pose: &Pose, ray: &LocalRay, film: Vec2) -> CameraRay {
        let direction = ray.direction.extend(1.0);
        let length = pose.frame.vector(direction).length();
        let cos = pose.volume / (pose.area * length);
        let pixel_area = self.pixel_area();
        // From the plane at depth 1 to solid angle.
        let per_solid_angle = length * length * length / pose.volume;
        let lens_area = self.aperture.area() * self.lens_radius * self.lens_radius;
        let (position, direction_density, arrival);
        if self.perspective {
            let p_w = SolidAnglePdf(per_solid_angle / pixel_area);
            position = self.with_lens(AreaPdf(1.0 / (lens_area * pose.area)));
            direction_density = CameraDensity::Continuous(p_w);
            arrival = p_w.to_area((length * ray.depth).powi(2), 1.0);
        } else {
            let p_a = 1.0 / (pixel_area * pose.area);
            position = CameraDensity::Continuous(AreaPdf(p_a));
            let directions = lens_area / (self.focal_distance * self.focal_distance);
            direction_density = self.with_lens(SolidAnglePdf(per_solid_angle / directions));
            arrival = AreaPdf(p_a / cos);
        }
        let p_a = if let CameraDensity::Continuous(AreaPdf(p)) = position {
            p
        } else {
            1.0
        };
        let p_w = if let CameraDensity::Continuous(SolidAnglePdf(p)) = direction_density {
            p
        } else {
            1.0
        };
        let importance = self.importance_along(direction);
        CameraRay {
            film,
            we: importance * p_a * p_w / cos,
            importance,
            position,
            direction: direction_density,
            arrival,
        }
    }

    #[inline]
    fn with_lens<P>(&self, density: P) -> CameraDensity<P> {
        if self.lens_radius > 0.0 {
            CameraDensity::Continuous(density)
        } else {
            CameraDensity::Delta
        }
    }
}
