//! Lights: what they emit, and how a direction towards one is sampled. Each kind is a file.

mod area;
mod bounds;
mod bvh;
mod coordinates;
mod delta;
mod emission;
mod emitter;
mod environment;
mod goniometric;
mod image;
mod lanes;
mod moving;
mod patch;
mod place;
mod portal;
mod projection;
mod sampler;
mod sky;
mod spot;

pub use area::AreaLight;
pub use bounds::LightBounds;
pub use coordinates::Coordinates;
pub use delta::{DistantLight, PointLight};
pub use emission::{EmissionDensity, EmissionOrigin, EmissionSample};
pub use emitter::EmitterShape;
pub use environment::EnvironmentLight;
pub use goniometric::GoniometricLight;
pub use image::EmissionImage;
pub use lanes::{ChosenLight, LightLanes, LightSampleLanes};
pub use moving::{MovingEmitter, Side};
pub use patch::PatchEmitter;
pub use place::{Place, facing};
pub use portal::{Behind, Portal, PortalEnvironment};
pub use projection::ProjectionLight;
pub use sampler::{LightSampler, SampledLight};
pub use sky::ImageEnvironment;
pub use spot::SpotLight;

use crate::geometry::SurfaceInteraction;
use crate::math::{Bounds3, Vec2, Vec3};
use crate::sampling::SolidAnglePdf;
use crate::spectrum::{SampledSpectrum, Wavelengths};
use lanes::PlainLight;

/// A light of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LightId(pub u32);

impl LightId {
    /// As an index into a slice.
    #[inline]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// Something that emits.
#[derive(Clone, Debug)]
pub enum Light {
    /// A triangle or a sphere.
    Area(AreaLight),
    /// A point.
    Point(PointLight),
    /// A cone from a point.
    Spot(SpotLight),
    /// A point with an image of intensities.
    Goniometric(GoniometricLight),
    /// A picture thrown from a point.
    Projection(ProjectionLight),
    /// A direction.
    Distant(DistantLight),
    /// All around the scene.
    Environment(EnvironmentLight),
}

/// Where a light was sampled.
#[derive(Clone, Copy, Debug)]
pub enum LightEnd {
    /// At a point of a surface (with its error and its normal) or, with both zero, in space.
    Point {
        /// The point.
        p: Vec3,
        /// See [`SurfaceInteraction::error`].
        error: f32,
        /// Geometric normal.
        ng: Vec3,
    },
    /// Infinitely far away.
    Infinity,
}

/// How likely a sampled point of a light, or a direction that light leaves it in, was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightDensity<M = SolidAnglePdf> {
    /// A BSDF sample could have found it as well.
    Continuous(M),
    /// Only a light sample can find it.
    Delta,
}

/// A direction towards a light.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// Radiance that arrives if nothing is in the way; of a [`LightDensity::Delta`] light, irradiance at normal incidence.
    pub li: SampledSpectrum,
    /// Unit direction towards the light.
    pub wi: Vec3,
    /// Where the shadow ray ends.
    pub end: LightEnd,
    /// With respect to solid angle at the reference point.
    pub density: LightDensity,
}

impl Light {
    /// Samples a direction from the point `p` at `time` towards the light. `None` carries nothing.
    #[inline]
    pub fn sample_li(&self, p: Vec3, time: f32, u: Vec2, lambda: &Wavelengths) -> Option<LightSample> {
        match self {
            Self::Area(light) => light.sample_li(p, time, u, lambda),
            Self::Point(light) => light.sample_li(p, time, lambda),
            Self::Spot(light) => light.sample_li(p, time, lambda),
            Self::Goniometric(light) => light.sample_li(p, time, lambda),
            Self::Projection(light) => light.sample_li(p, time, lambda),
            Self::Distant(light) => Some(light.sample_li(time, lambda)),
            Self::Environment(light) => light.sample_li(p, time, u, lambda),
        }
    }

    /// As a surface at rest that is alike all over, if it is one.
    #[inline]
    fn plain(&self) -> Option<PlainLight> {
        match self {
            Self::Area(light) => light.plain(),
            _ => None,
        }
    }

    /// What such a light sends out; 0 of others.
    #[inline]
    fn plain_radiance(&self, lambda: &Wavelengths) -> SampledSpectrum {
        match self {
            Self::Area(light) => light.constant_radiance(lambda),
            _ => SampledSpectrum::ZERO,
        }
    }

    /// The same, if that is known without wavelengths.
    fn known_radiance(&self) -> Option<SampledSpectrum> {
        match self {
            Self::Area(light) => light.known_radiance(),
            _ => None,
        }
    }

    /// Radiance emitted at a surface point of the light in direction `w`; 0 for a light that has no surface.
    #[inline]
    pub fn le(&self, si: &SurfaceInteraction, w: Vec3, lambda: &Wavelengths) -> SampledSpectrum {
        match self {
            Self::Area(light) => light.le(si.ng, si.uv, w, lambda),
            _ => SampledSpectrum::ZERO,
        }
    }

    /// Density with which [`Light::sample_li`] from `p` gives the direction to the surface point `si` of the light.
    #[inline]
    pub fn pdf_li(&self, p: Vec3, si: &SurfaceInteraction) -> SolidAnglePdf {
        match self {
            Self::Area(light) => light.pdf_li(p, si.p, si.ng, si.time),
            _ => SolidAnglePdf(0.0),
        }
    }

    /// The point at which all of it is at `time`; `None` for a light with extent, or infinitely far away.
    pub fn position(&self, time: f32) -> Option<Vec3> {
        let place = match self {
            Self::Point(light) => light.place(),
            Self::Spot(light) => light.place(),
            Self::Goniometric(light) => light.place(),
            Self::Projection(light) => light.place(),
            Self::Area(_) | Self::Distant(_) | Self::Environment(_) => return None,
        };
        Some(place.at(time).position)
    }

    /// Whether only [`Light::sample_li`] finds it: one without extent, or that rays pass.
    pub fn is_delta(&self) -> bool {
        match self {
            Self::Area(light) => light.is_delta(),
            Self::Environment(_) => false,
            Self::Point(_) | Self::Spot(_) | Self::Goniometric(_) | Self::Projection(_) | Self::Distant(_) => true,
        }
    }

    /// Whether only [`Light::sample_le`] finds it: it shines along the normals of a surface, which a given point is on with no
    /// probability.
    pub fn is_along_normals(&self) -> bool {
        matches!(self, Self::Area(light) if light.is_along_normals())
    }

    /// Where and where to it emits, for a hierarchy over lights; `None` if it is infinitely far away.
    pub fn bounds(&self) -> Option<LightBounds> {
        match self {
            Self::Area(light) => Some(light.bounds()),
            Self::Point(light) => Some(light.bounds()),
            Self::Spot(light) => Some(light.bounds()),
            Self::Goniometric(light) => Some(light.bounds()),
            Self::Projection(light) => Some(light.bounds()),
            Self::Distant(_) | Self::Environment(_) => None,
        }
    }

    /// Emitted power weighed by the luminous efficiency of its spectrum, to choose lights by; `bounds` are those of the scene.
    pub fn power(&self, bounds: &Bounds3) -> f32 {
        match self {
            Self::Area(light) => light.power(),
            Self::Point(light) => light.power(),
            Self::Spot(light) => light.power(),
            Self::Goniometric(light) => light.power(),
            Self::Projection(light) => light.power(),
            Self::Distant(light) => light.power(bounds),
            Self::Environment(light) => light.power(bounds),
        }
    }
}
