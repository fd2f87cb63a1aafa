//! Rays that leave lights: where light subpaths start (Veach 1997, chapter 10; `SampleLe` of pbrt-v4, section 12.1 of its book).
//!
//! A ray has a position and a direction, each with a density of its own. The flux of a light is the mean of le cos θ over both. On
//! a surface positions are measured by its area. Of what comes from infinity they are measured by area across the direction: on a
//! disk behind which the whole scene is, or, behind a portal, on what the portal leaves of it.

use std::f32::consts::{FRAC_1_PI, PI};

use super::{EnvironmentLight, Light, LightDensity, LightEnd, LightSample};
use crate::geometry::{Ray, SurfaceInteraction};
use crate::math::{Bounds3, Frame, Vec2, Vec3, offset_ray_origin};
use crate::sampling::{AreaPdf, SolidAnglePdf, warp};
use crate::spectrum::{SampledSpectrum, Wavelengths};

/// A ray that leaves a light: the start of a light subpath. `le` times `cos_theta` over both densities (without those that are
/// [`LightDensity::Delta`]) has the light's flux as its mean.
#[derive(Clone, Copy, Debug)]
pub struct EmissionSample {
    /// Radiance along the ray, W·m⁻²·sr⁻¹·nm⁻¹. Where the position is a Delta, integrated over positions: intensity. Where the
    /// direction is one, integrated over directions: irradiance at normal incidence. Never black.
    pub le: SampledSpectrum,
    /// Where it starts.
    pub origin: EmissionOrigin,
    /// Unit direction, away from the light.
    pub direction: Vec3,
    /// How likely it was.
    pub density: EmissionDensity,
    /// Absolute cosine between direction and geometric normal at the surface, positive; 1 elsewhere.
    pub cos_theta: f32,
}

/// Where a ray leaves a light.
#[derive(Clone, Copy, Debug)]
pub enum EmissionOrigin {
    /// At a surface.
    Surface {
        /// The point.
        p: Vec3,
        /// See [`SurfaceInteraction::error`].
        error: f32,
        /// Geometric normal.
        ng: Vec3,
    },
    /// At a point in space.
    Point(Vec3),
    /// Infinitely far away: it comes to the scene at this point outside.
    Infinity(Vec3),
}

/// The densities of a ray that leaves a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmissionDensity {
    /// By area of the surface, or, from infinity, by area across the direction. [`LightDensity::Delta`] for a light at a point, and
    /// for a surface that no ray meets.
    pub position: LightDensity<AreaPdf>,
    /// By solid angle, of the direction from that position. [`LightDensity::Delta`] for a distant light.
    pub direction: LightDensity<SolidAnglePdf>,
}

impl EmissionDensity {
    /// Of rays that all leave one point.
    pub(super) fn at_point(direction: SolidAnglePdf) -> Self {
        Self {
            position: LightDensity::Delta,
            direction: LightDensity::Continuous(direction),
        }
    }

    /// Of rays that have a density in both.
    pub(super) fn continuous((position, direction): (AreaPdf, SolidAnglePdf)) -> Self {
        Self {
            position: LightDensity::Continuous(position),
            direction: LightDensity::Continuous(direction),
        }
    }

    /// The product of both, without those that are delta functions.
    pub fn product(&self) -> f64 {
        let position = match self.position {
            LightDensity::Continuous(AreaPdf(pdf)) => f64::from(pdf),
            LightDensity::Delta => 1.0,
        };
        let direction = match self.direction {
            LightDensity::Continuous(SolidAnglePdf(pdf)) => f64::from(pdf),
            LightDensity::Delta => 1.0,
        };
        position * direction
    }

    /// Whether a ray could be drawn with it.
    pub(super) fn is_possible(&self) -> bool {
        let possible = |pdf: f32| pdf > 0.0 && pdf.is_finite();
        let position = match self.position {
            LightDensity::Continuous(AreaPdf(pdf)) => possible(pdf),
            LightDensity::Delta => true,
        };
        position
            && match self.direction {
                LightDensity::Continuous(SolidAnglePdf(pdf)) => possible(pdf),
                LightDensity::Delta => true,
            }
    }
}

impl EmissionSample {
    /// The ray itself, at `time`.
    #[inline]
    pub fn ray(&self, time: f32) -> Ray {
        let origin = match self.origin {
            EmissionOrigin::Surface { p, error, ng } => offset_ray_origin(p, error, ng, self.direction),
            EmissionOrigin::Point(p) | EmissionOrigin::Infinity(p) => p,
        };
        Ray::new(origin, self.direction, time)
    }

    /// This, unless it carries nothing or its densities cannot be divided by.
    pub(super) fn checked(self) -> Option<Self> {
        (self.cos_theta > 0.0 && self.density.is_possible() && !self.le.is_black()).then_some(self)
    }

    /// From a light at a point, with its intensity.
    #[inline]
    pub(super) fn from_point(p: Vec3, direction: Vec3, intensity: SampledSpectrum, pdf: SolidAnglePdf) -> Option<Self> {
        let sample = Self {
            le: intensity,
            origin: EmissionOrigin::Point(p),
            direction,
            density: EmissionDensity::at_point(pdf),
            cos_theta: 1.0,
        };
        sample.checked()
    }

    /// In a direction from infinity, at a point of the disk by `u`.
    pub(super) fn from_disk(
        direction: Vec3,
        u: Vec2,
        scene: &Bounds3,
        le: SampledSpectrum,
        density: LightDensity<SolidAnglePdf>,
    ) -> Option<Self> {
        let at = warp::sample_uniform_disk(u) * scene.radius();
        let frame = Frame::from_normal(direction);
        let through = scene.center() + frame.s * at.x + frame.t * at.y;
        let sample = Self {
            le,
            origin: EmissionOrigin::Infinity(outside(through, direction, scene)),
            direction,
            density: EmissionDensity {
                position: LightDensity::Continuous(disk_pdf(scene)),
                direction: density,
            },
            cos_theta: 1.0,
        };
        sample.checked()
    }
}

/// The point of the line through `p` in `direction` behind which the whole scene is.
pub(super) fn outside(p: Vec3, direction: Vec3, scene: &Bounds3) -> Vec3 {
    /// What rounding may lose of the distance.
    const MARGIN: f32 = 1.0 + 1e-3;
    p - direction * ((p - scene.center()).dot(direction) + scene.radius() * MARGIN)
}

/// Density of a point of the disk that is as wide as the scene; 0 if that has no extent.
pub(super) fn disk_pdf(scene: &Bounds3) -> AreaPdf {
    let radius = scene.radius();
    AreaPdf(if radius > 0.0 {
        FRAC_1_PI / (radius * radius)
    } else {
        0.0
    })
}

/// A direction that leaves a surface of normal `ng`, by its cosine, on the side of the normal or on either (by the first number,
/// which is used again).
pub(super) fn sample_side(ng: Vec3, two_sided: bool, u: Vec2) -> Vec3 {
    let (n, u) = if !two_sided {
        (ng, u)
    } else if u.x < 0.5 {
        (ng, Vec2::new(2.0 * u.x, u.y))
    } else {
        (-ng, Vec2::new(2.0 * u.x - 1.0, u.y))
    };
    Frame::from_normal(n)
        .to_world(warp::sample_cosine_hemisphere(u))
        .normalize()
}

/// The density of [`sample_side`] for `w`.
#[inline]
pub(super) fn side_pdf(ng: Vec3, two_sided: bool, w: Vec3) -> SolidAnglePdf {
    let cos = ng.dot(w);
    if two_sided {
        SolidAnglePdf(cos.abs() / (2.0 * PI))
    } else {
        warp::cosine_hemisphere_pdf(cos)
    }
}

impl Light {
    /// Samples a ray that leaves the light at `time`; `scene` is a box around all that can be hit. `None` carries nothing.
    ///
    /// What comes through a portal does not arrive at surfaces in front of it: where the first surface on the ray is one of those,
    /// [`EnvironmentLight::le`] from there is zero.
    pub fn sample_le(
        &self,
        time: f32,
        u_position: Vec2,
        u_direction: Vec2,
        lambda: &Wavelengths,
        scene: &Bounds3,
    ) -> Option<EmissionSample> {
        match self {
            Self::Area(light) => light.sample_le(time, u_position, u_direction, lambda),
            Self::Point(light) => light.sample_le(time, u_direction, lambda),
            Self::Spot(light) => light.sample_le(time, u_direction, lambda),
            Self::Goniometric(light) => light.sample_le(time, u_direction, lambda),
            Self::Projection(light) => light.sample_le(time, u_direction, lambda),
            Self::Distant(light) => light.sample_le(time, u_position, lambda, scene),
            Self::Environment(light) => light.sample_le(time, u_position, u_direction, lambda, scene),
        }
    }

    /// Densities with which [`Light::sample_le`] gives the ray from the surface point `si` of the light in the unit direction `w`;
    /// 0 for a light that has no surface, see [`EnvironmentLight::pdf_le`].
    #[inline]
    pub fn pdf_le(&self, si: &SurfaceInteraction, w: Vec3) -> (AreaPdf, SolidAnglePdf) {
        match self {
            Self::Area(light) => light.pdf_le(si.p, si.ng, w, si.time),
            _ => (AreaPdf(0.0), SolidAnglePdf(0.0)),
        }
    }

    /// Densities with which [`Light::sample_le`] gives the ray that brings a sample of [`Light::sample_li`] to the point `p` which
    /// it was drawn from, at the same time.
    pub fn emission_density(&self, p: Vec3, sample: &LightSample, time: f32, scene: &Bounds3) -> EmissionDensity {
        let w = -sample.wi;
        match (self, sample.end) {
            (Self::Area(light), LightEnd::Point { p, ng, .. }) => light.emission_density(p, ng, w, time),
            // Not a sample of this light.
            (Self::Area(_), LightEnd::Infinity) => EmissionDensity::continuous((AreaPdf(0.0), SolidAnglePdf(0.0))),
            (Self::Point(_), _) => EmissionDensity::at_point(warp::uniform_sphere_pdf()),
            (Self::Spot(light), _) => EmissionDensity::at_point(light.pdf_le(w, time)),
            (Self::Goniometric(light), _) => EmissionDensity::at_point(light.pdf_le(w, time)),
            (Self::Projection(light), _) => EmissionDensity::at_point(light.pdf_le(w, time)),
            (Self::Distant(_), _) => EmissionDensity {
                position: LightDensity::Continuous(disk_pdf(scene)),
                direction: LightDensity::Delta,
            },
            (Self::Environment(light), _) => EmissionDensity::continuous(light.pdf_le(p, sample.wi, time, scene)),
        }
    }
}

impl EnvironmentLight {
    fn sample_le(
        &self,
        time: f32,
        u_position: Vec2,
        u_direction: Vec2,
        lambda: &Wavelengths,
        scene: &Bounds3,
    ) -> Option<EmissionSample> {
        let (to_sky, pdf, le) = match self {
            Self::Constant(radiance) => {
                let w = warp::sample_uniform_sphere(u_direction);
                (w, warp::uniform_sphere_pdf(), radiance.sample(lambda))
            }
            Self::Image(image) => image.sample(time, u_direction, lambda)?,
            Self::Portal(portal) => return portal.sample_le(u_position, u_direction, lambda, scene),
        };
        EmissionSample::from_disk(-to_sky, u_position, scene, le, LightDensity::Continuous(pdf))
    }

    /// Densities with which [`Light::sample_le`] gives the ray that comes to `p` from the unit direction `w`, that of
    /// [`EnvironmentLight::le`]: of its position by area across the direction, and of the direction.
    pub fn pdf_le(&self, p: Vec3, w: Vec3, time: f32, scene: &Bounds3) -> (AreaPdf, SolidAnglePdf) {
        match self {
            Self::Constant(_) | Self::Image(_) => (disk_pdf(scene), self.pdf_li(p, w, time)),
            Self::Portal(portal) => portal.pdf_le(p, w),
        }
    }
}
