//! The rays of eight camera samples, computed together.

use super::aperture::Aperture;
use super::planar::Planar;
use super::pose::CameraFrame;
use super::{Camera, CameraSample, Eye};
use crate::geometry::{Ray, RayCone};
use crate::math::{Kernel, LANES, Lanes, Vec2Lanes, Vec3Lanes, VectorLanes, Vectorizer};

/// [`Camera::generate_ray`] and [`Camera::ray_cone`] of eight samples, all of importance 1.
#[derive(Clone, Copy, Debug, Default)]
pub struct CameraLanes {
    origin: Vec3Lanes,
    direction: Vec3Lanes,
    width: Lanes,
    spread: Lanes,
}

impl CameraLanes {
    /// The ray of a lane, at a scene time.
    #[inline(always)]
    pub fn ray(&self, lane: usize, time: f32) -> Ray {
        Ray::new(self.origin.get(lane), self.direction.get(lane), time)
    }

    /// How wide it is.
    #[inline(always)]
    pub fn cone(&self, lane: usize) -> RayCone {
        RayCone {
            width: self.width[lane],
            spread: self.spread[lane],
        }
    }
}

impl Camera {
    /// The rays of the samples with these film positions and lens numbers, each of which stands for a square of `scale` pixels a side: the
    /// same bits as one by one, several times faster. `None` of other cameras than the commonest: perspective, at rest, with a
    /// pinhole or a round lens, of which a pixel is a mean of radiance.
    #[inline]
    pub fn rays(&self, vectorizer: Vectorizer, film: &Vec2Lanes, lens: &Vec2Lanes, scale: f32) -> Option<CameraLanes> {
        let (Eye::Planar(planar), Some(pose)) = (&self.eye, &self.fixed) else {
            return None;
        };
        let is_round = matches!(planar.aperture, Aperture::Round);
        if !planar.perspective || planar.irradiance_area.is_some() || !(is_round || planar.lens_radius == 0.0) {
            return None;
        }
        let frame = &pose.frame;
        Some(if planar.lens_radius > 0.0 {
            vectorizer.run(Rays::<true> {
                planar,
                frame,
                film,
                lens,
                scale,
            })
        } else {
            vectorizer.run(Rays::<false> {
                planar,
                frame,
                film,
                lens,
                scale,
            })
        })
    }
}

/// See [`Camera::rays`].
struct Rays<'a, const HAS_LENS: bool> {
    planar: &'a Planar,
    frame: &'a CameraFrame,
    film: &'a Vec2Lanes,
    lens: &'a Vec2Lanes,
    scale: f32,
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
        let mut rays = CameraLanes::default();
        for i in 0..LANES {
            let sample = CameraSample {
                film: self.film.get(i),
                lens: self.lens.get(i),
                time: 0.0,
            };
            let (origin, direction) = planar.local_start(&sample);
            rays.origin.set(i, self.frame.point(origin));
            rays.direction.set(i, self.frame.vector(direction).normalize());
            let cone = planar.ray_cone(sample.film, self.scale);
            rays.width[i] = cone.width;
            rays.spread[i] = cone.spread;
        }
        rays
    }
}
