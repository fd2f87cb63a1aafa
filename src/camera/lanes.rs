//! The rays of eight camera samples, computed together.

use super::aperture::Aperture;
use super::planar::Planar;
use super::pose::CameraFrame;
use super::{Camera, CameraSample, Eye};
use crate::geometry::{Ray, RayPacket};
use crate::math::{Kernel, LANES, Lanes, Vec2, Vec2Lanes, VectorLanes, Vectorizer};

/// Eight [`CameraSample`]s.
#[derive(Clone, Copy, Debug)]
pub struct CameraSampleLanes<'a> {
    /// See [`CameraSample::film`].
    pub film: &'a Vec2Lanes,
    /// See [`CameraSample::lens`].
    pub lens: [&'a Lanes; 2],
    /// See [`CameraSample::time`].
    pub time: &'a Lanes,
}

/// What there is to know of eight camera rays besides.
#[derive(Clone, Copy, Debug, Default)]
pub struct CameraLanes {
    /// Whether the ray is valid; if not, it takes no part.
    pub is_valid: [bool; LANES],
    /// See [`RayCone::width`](crate::geometry::RayCone::width).
    pub width: Lanes,
    /// See [`RayCone::spread`](crate::geometry::RayCone::spread).
    pub spread: Lanes,
}

impl Camera {
    /// Writes the rays of samples, each of which stands for a square of `scale` pixels a side, to `rays`: [`Camera::generate_ray`], the
    /// same bits as one by one, several times faster. All are of importance 1. `None` of other cameras than the commonest: perspective, at
    /// rest, with a pinhole or a round lens, of which a pixel is a mean of radiance.
    #[inline]
    pub fn generate_rays(
        &self,
        vectorizer: Vectorizer,
        samples: CameraSampleLanes<'_>,
        scale: f32,
        rays: &mut RayPacket,
    ) -> Option<CameraLanes> {
        let (Eye::Planar(planar), Some(pose)) = (&self.eye, &self.fixed) else {
            return None;
        };
        let is_round = matches!(planar.aperture, Aperture::Round);
        if !planar.perspective || planar.irradiance_area.is_some() || !(is_round || planar.lens_radius == 0.0) {
            return None;
        }
        let (camera, frame) = (self, &pose.frame);
        Some(if planar.lens_radius > 0.0 {
            vectorizer.run(Rays::<true> {
                camera,
                planar,
                frame,
                samples,
                scale,
                rays,
            })
        } else {
            vectorizer.run(Rays::<false> {
                camera,
                planar,
                frame,
                samples,
                scale,
                rays,
            })
        })
    }

    /// Whether it asks for the numbers of [`CameraSample::lens`].
    #[inline]
    pub fn has_lens(&self) -> bool {
        match &self.eye {
            Eye::Planar(planar) => planar.lens_radius > 0.0,
            Eye::Spherical(_) => false,
            Eye::Realistic(_) => true,
        }
    }

    /// Whether it asks for [`CameraSample::time`].
    #[inline]
    pub fn has_exposure(&self) -> bool {
        self.shutter[0] != self.shutter[1]
    }
}

/// See [`Camera::generate_rays`].
struct Rays<'a, const HAS_LENS: bool> {
    camera: &'a Camera,
    planar: &'a Planar,
    frame: &'a CameraFrame,
    samples: CameraSampleLanes<'a>,
    scale: f32,
    /// Written at the end, all at once: the compiler cannot know that it is apart from the others.
    rays: &'a mut RayPacket,
}

impl<const HAS_LENS: bool> Kernel for Rays<'_, HAS_LENS> {
    type Output = CameraLanes;

    #[inline(always)]
    fn call(self) -> CameraLanes {
        // What is known is said, so that no branch is left in the loop.
        let planar = &Planar {
            perspective: true,
            lens_radius: if HAS_LENS { self.planar.lens_radius } else { 0.0 },
            aperture: Aperture::Round,
            irradiance_area: None,
            ..*self.planar
        };
        let CameraSampleLanes { film, lens, time } = self.samples;
        let (mut rays, mut lanes) = (RayPacket::EMPTY, CameraLanes::default());
        for i in 0..LANES {
            let sample = CameraSample {
                film: film.get(i),
                lens: Vec2::new(lens[0][i], lens[1][i]),
                time: 0.0,
            };
            let (origin, direction) = planar.local_start(&sample);
            let (origin, direction) = (self.frame.point(origin), self.frame.vector(direction).normalize());
            let ray = Ray::new(origin, direction, self.camera.scene_time(time[i]));
            lanes.is_valid[i] = ray.is_valid();
            rays.set(i, &ray);
            let cone = planar.ray_cone(sample.film, self.scale);
            (lanes.width[i], lanes.spread[i]) = (cone.width, cone.spread);
        }
        *self.rays = rays;
        lanes
    }
}
