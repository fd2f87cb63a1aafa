//! The kinds of surfaces whose scattering is computed together, and those that the lanes of a packet are at.

use std::f32::consts::FRAC_1_PI;

use crate::geometry::SurfaceInteraction;
use crate::material::{ConductorLanes, Distribution, LaneSample, LaneValue, LocalValue, Material};
use crate::math::{Frame, LANES, Vec2, Vec3, Vec3Lanes, VectorLanes};
use crate::sampling::warp;
use crate::spectrum::{SampledSpectrum, Wavelengths};

/// A kind of surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Lambertian,
    /// A conductor with facets of this distribution.
    Ggx,
    /// A conductor with facets of this distribution.
    Beckmann,
    /// A smooth conductor.
    Mirror,
}

impl Kind {
    /// How many there are.
    pub const COUNT: usize = Self::Mirror as usize + 1;
}

/// The surfaces of lanes.
#[derive(Debug, Default)]
pub(super) struct KindLanes {
    /// Lane by lane: they are put there one by one, and read long after.
    albedo: [SampledSpectrum; LANES],
    conductors: ConductorLanes,
    /// Of conductors; zero where it does not matter which way it points.
    tangent: Vec3Lanes,
}

impl KindLanes {
    /// Puts a Lambertian surface into a lane.
    #[inline]
    pub fn set_lambertian(&mut self, lane: usize, albedo: SampledSpectrum) -> Kind {
        self.albedo[lane] = albedo;
        Kind::Lambertian
    }

    /// Puts a surface into a lane, if it is of some kind.
    #[inline]
    pub fn set(
        &mut self,
        lane: usize,
        material: &Material,
        surface: impl Fn() -> SurfaceInteraction,
        lambda: &Wavelengths,
    ) -> Option<Kind> {
        if let Some(reflectance) = material.lambertian() {
            let albedo = match reflectance.constant() {
                Some(spectrum) => spectrum.sample(lambda),
                None => reflectance.reflectance_at(&surface(), lambda),
            };
            return Some(self.set_lambertian(lane, albedo));
        }
        let conductor = material.conductor(&surface, lambda)?;
        self.conductors.set(lane, &conductor);
        let is_anisotropic = conductor.is_anisotropic();
        self.tangent
            .set(lane, if is_anisotropic { surface().dpdu } else { Vec3::ZERO });
        Some(match conductor.distribution() {
            None => Kind::Mirror,
            Some(Distribution::Ggx) => Kind::Ggx,
            Some(Distribution::Beckmann) => Kind::Beckmann,
        })
    }
}

/// How surfaces of a kind scatter, lane by lane, for kernels. Directions are local.
pub(super) trait Lobes {
    /// Whether they are delta lobes: then values are coefficients, and nothing is evaluated.
    const IS_DELTA: bool;

    /// The frame of a lane's lobe, where its surface has the shading normal `n`.
    fn frame(kinds: &KindLanes, lane: usize, n: Vec3) -> Frame;

    /// See [`Bsdf::eval`](crate::material::Bsdf::eval).
    fn eval(kinds: &KindLanes, lane: usize, wo: Vec3, wi: Vec3) -> LaneValue;

    /// See [`Bsdf::sample_f`](crate::material::Bsdf::sample_f).
    fn sample(kinds: &KindLanes, lane: usize, wo: Vec3, u: Vec2) -> LaneSample;
}

/// Of [`Kind::Lambertian`].
pub(super) struct Lambertian;

impl Lambertian {
    #[inline(always)]
    fn value(kinds: &KindLanes, lane: usize, cos: f32) -> LocalValue {
        LocalValue {
            f: kinds.albedo[lane] * FRAC_1_PI,
            pdf: cos * FRAC_1_PI,
        }
    }
}

impl Lobes for Lambertian {
    const IS_DELTA: bool = false;

    #[inline(always)]
    fn frame(_kinds: &KindLanes, _lane: usize, n: Vec3) -> Frame {
        Frame::from_normal(n)
    }

    #[inline(always)]
    fn eval(kinds: &KindLanes, lane: usize, wo: Vec3, wi: Vec3) -> LaneValue {
        LaneValue {
            value: Self::value(kinds, lane, wi.z.abs()),
            exists: wo.z * wi.z > 0.0,
        }
    }

    #[inline(always)]
    fn sample(kinds: &KindLanes, lane: usize, wo: Vec3, u: Vec2) -> LaneSample {
        let mut wi = warp::sample_cosine_hemisphere(u);
        let value = Self::value(kinds, lane, wi.z);
        wi.z = if wo.z < 0.0 { -wi.z } else { wi.z };
        LaneSample {
            wi,
            value,
            exists: true,
        }
    }
}

/// Of [`Kind::Beckmann`], or of [`Kind::Ggx`].
pub(super) struct RoughConductor<const IS_BECKMANN: bool>;

impl<const IS_BECKMANN: bool> RoughConductor<IS_BECKMANN> {
    const DISTRIBUTION: Distribution = if IS_BECKMANN {
        Distribution::Beckmann
    } else {
        Distribution::Ggx
    };
}

impl<const IS_BECKMANN: bool> Lobes for RoughConductor<IS_BECKMANN> {
    const IS_DELTA: bool = false;

    #[inline(always)]
    fn frame(kinds: &KindLanes, lane: usize, n: Vec3) -> Frame {
        Frame::from_normal_tangent(n, kinds.tangent.get(lane))
    }

    #[inline(always)]
    fn eval(kinds: &KindLanes, lane: usize, wo: Vec3, wi: Vec3) -> LaneValue {
        kinds.conductors.eval(lane, Self::DISTRIBUTION, wo, wi)
    }

    #[inline(always)]
    fn sample(kinds: &KindLanes, lane: usize, wo: Vec3, u: Vec2) -> LaneSample {
        kinds.conductors.sample(lane, Self::DISTRIBUTION, wo, u)
    }
}

/// Of [`Kind::Mirror`].
pub(super) struct Mirror;

impl Lobes for Mirror {
    const IS_DELTA: bool = true;

    #[inline(always)]
    fn frame(_kinds: &KindLanes, _lane: usize, n: Vec3) -> Frame {
        Frame::from_normal(n)
    }

    #[inline(always)]
    fn eval(_kinds: &KindLanes, _lane: usize, _wo: Vec3, _wi: Vec3) -> LaneValue {
        let value = LocalValue {
            f: SampledSpectrum::ZERO,
            pdf: 0.0,
        };
        LaneValue { value, exists: false }
    }

    #[inline(always)]
    fn sample(kinds: &KindLanes, lane: usize, wo: Vec3, _u: Vec2) -> LaneSample {
        let (wi, f) = kinds.conductors.mirror(lane, wo);
        LaneSample {
            wi,
            value: LocalValue { f, pdf: 1.0 },
            exists: true,
        }
    }
}
