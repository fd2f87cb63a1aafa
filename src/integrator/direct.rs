//! Light straight from its source, found in two ways that are weighed by multiple importance sampling (Veach 1997, section 9.2): by
//! points of lights, and by directions drawn from BSDFs that meet a light.

use super::fault::Fault;
use super::lane::LaneState;
use super::numbers::EventNumbers;
use super::queue::Packet;
use crate::desc::{Heuristic, Strategy};
use crate::geometry::{Ray, SurfaceInteraction};
use crate::light::{LightDensity, LightEnd, LightSample, SampledLight};
use crate::material::{Bsdf, TransportMode};
use crate::math::{LANES, Lanes, Vec3, Vec3Lanes, VectorLanes, columns};
use crate::sampling::{SolidAnglePdf, balance_heuristic, power_heuristic};
use crate::scene::Scene;
use crate::spectrum::{SampledSpectrum, Wavelengths};

/// Where a path's ray came from, which says how else the light that it meets could have been found.
#[derive(Clone, Copy, Debug)]
pub(super) enum Origin {
    /// The camera or a delta lobe: in no other way.
    Delta,
    /// A BSDF sample at a point of this shading normal: by light sampling too. `pdf` is its density, times the number of such samples.
    Sampled { p: Vec3, n: Vec3, pdf: SolidAnglePdf },
}

impl Origin {
    /// The origin of a path that then passed media, with the mean probability `passed`.
    #[inline]
    pub fn after(self, passed: f32) -> Self {
        match self {
            Self::Delta => Self::Delta,
            Self::Sampled { p, n, pdf } => Self::Sampled {
                p,
                n,
                pdf: SolidAnglePdf(pdf.0 * passed),
            },
        }
    }
}

impl LaneState for Origin {
    type Lanes = OriginLanes;
}

/// Eight of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct OriginLanes {
    pub p: Vec3Lanes,
    pub n: Vec3Lanes,
    /// Negative for [`Origin::Delta`].
    pub pdf: Lanes,
}

columns!(OriginLanes { p, n, pdf });

impl Packet for OriginLanes {
    type Lane = Origin;

    #[inline(always)]
    fn all(origin: Origin) -> Self {
        let mut lanes = Self {
            p: Vec3Lanes::default(),
            n: Vec3Lanes::default(),
            pdf: [-1.0; LANES],
        };
        if let Origin::Sampled { .. } = origin {
            (0..LANES).for_each(|lane| lanes.set(lane, origin));
        }
        lanes
    }

    #[inline(always)]
    fn get(&self, lane: usize) -> Origin {
        if self.pdf[lane] < 0.0 {
            return Origin::Delta;
        }
        Origin::Sampled {
            p: self.p.get(lane),
            n: self.n.get(lane),
            pdf: SolidAnglePdf(self.pdf[lane]),
        }
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, origin: Origin) {
        self.pdf[lane] = -1.0;
        if let Origin::Sampled { p, n, pdf } = origin {
            self.p.set(lane, p);
            self.n.set(lane, n);
            self.pdf[lane] = pdf.0;
        }
    }
}

/// Where light is looked for from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Viewpoint {
    pub p: Vec3,
    /// The shading normal, zero where there is no surface.
    pub n: Vec3,
    pub time: f32,
}

/// A point of a light, found from a scattering event.
#[derive(Clone, Copy, Debug)]
pub(super) struct FoundLight {
    pub sample: LightSample,
    /// Whose it is.
    pub chosen: SampledLight,
    /// What arrives by way of the event if nothing is between, divided by the density of the sample, not weighed.
    pub value: SampledSpectrum,
    /// The density of the sample; none if no direction could have met the light.
    pub pdf_light: Option<SolidAnglePdf>,
    /// The density of its direction by the other technique, times the number of such samples.
    pub pdf_scatter: SolidAnglePdf,
}

/// How light is looked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct DirectLight {
    pub strategy: Strategy,
    pub heuristic: Heuristic,
    /// BSDF samples for each light sample at a point.
    pub bsdf_samples: f32,
    pub fault: Fault,
}

impl DirectLight {
    /// What the environment sends along a ray that left the scene, weighed against light samples.
    #[inline]
    pub fn environment(&self, scene: &Scene, origin: &Origin, ray: &Ray, lambda: &Wavelengths) -> SampledSpectrum {
        let mut l = SampledSpectrum::ZERO;
        for (id, light) in scene.environments() {
            let weight = self.weight_of_hit(origin, |p, n| {
                let pmf = scene.light_sampler().pmf(p, n, id);
                SolidAnglePdf(pmf * light.pdf_li(p, ray.direction, ray.time).0)
            });
            l += light.le(ray.origin, ray.direction, ray.time, lambda) * weight;
        }
        l
    }

    /// What the surface that a ray hit emits, weighed against light samples.
    #[inline]
    pub fn emission(
        &self,
        scene: &Scene,
        origin: &Origin,
        si: &SurfaceInteraction,
        lambda: &Wavelengths,
    ) -> Option<SampledSpectrum> {
        let id = scene.light_of(si.hit.geometry, si.hit.primitive)?;
        let light = scene.light(id);
        let le = light.le(si, si.wo, lambda);
        if le.is_black() {
            return None;
        }
        let weight = self.weight_of_hit(origin, |p, n| {
            let pdf = scene.light_sampler().pmf(p, n, id) * light.pdf_li(p, si).0;
            if self.fault.is(Fault::PdfInWrongMeasure) {
                return SolidAnglePdf(pdf * si.ng.dot(si.wo).abs() / p.distance_squared(si.p));
            }
            SolidAnglePdf(pdf)
        });
        Some(le * weight)
    }

    /// A point of a light, and what it sends by way of `bsdf` if nothing is between, weighed against BSDF samples.
    #[inline]
    pub fn sample(
        &self,
        scene: &Scene,
        si: &SurfaceInteraction,
        bsdf: &Bsdf,
        numbers: &EventNumbers,
        lambda: &Wavelengths,
    ) -> Option<(LightSample, SampledSpectrum)> {
        let found = self.look_from_surface(scene, si, bsdf, numbers, lambda)?;
        let weight = self.weight_of_light(found.pdf_light, found.pdf_scatter);
        Some((found.sample, found.value * weight))
    }

    /// A point of a light, and what it sends by way of `bsdf`.
    #[inline]
    pub fn look_from_surface(
        &self,
        scene: &Scene,
        si: &SurfaceInteraction,
        bsdf: &Bsdf,
        numbers: &EventNumbers,
        lambda: &Wavelengths,
    ) -> Option<FoundLight> {
        let from = Viewpoint {
            p: si.p,
            n: si.ns,
            time: si.time,
        };
        self.look(scene, &from, numbers, lambda, |wi| {
            let bsdf = bsdf.eval(si.wo, wi, TransportMode::Radiance)?;
            if bsdf.f.is_black() {
                return None;
            }
            let cos = if self.fault.is(Fault::MissingCosine) {
                1.0
            } else {
                bsdf.cos_theta
            };
            Some((bsdf.f * cos, bsdf.pdf))
        })
    }

    /// A point of a light, and what it sends by way of an event that scatters the share `scatter(wi).0` of it, where the other technique
    /// draws `wi` with the density `scatter(wi).1`.
    #[inline]
    pub fn look(
        &self,
        scene: &Scene,
        from: &Viewpoint,
        numbers: &EventNumbers,
        lambda: &Wavelengths,
        scatter: impl FnOnce(Vec3) -> Option<(SampledSpectrum, SolidAnglePdf)>,
    ) -> Option<FoundLight> {
        let chosen = scene.light_sampler().sample(from.p, from.n, numbers.which_light)?;
        let light = scene.light(chosen.light);
        let sample = light.sample_li(from.p, from.time, numbers.light, lambda)?;
        let (scattered, pdf) = scatter(sample.wi)?;
        let mut factor = 1.0 / chosen.pmf;
        let mut pdf_light = None;
        if let LightDensity::Continuous(pdf) = sample.density {
            pdf_light = Some(SolidAnglePdf(chosen.pmf * pdf.0));
            factor /= pdf.0;
        }
        if self.fault.is(Fault::WrongJacobian) {
            factor /= cos_at_light(&sample);
        }
        Some(FoundLight {
            value: scattered * sample.li * factor,
            sample,
            chosen,
            pdf_light,
            pdf_scatter: SolidAnglePdf(self.bsdf_samples * pdf.0),
        })
    }

    /// The weight of a light sample: `pdf_light` is its density, none if no direction could have met the light; `pdf_scatter` that of the
    /// other technique, each times its number of samples.
    #[inline]
    pub fn weight_of_light(&self, pdf_light: Option<SolidAnglePdf>, pdf_scatter: SolidAnglePdf) -> f32 {
        match pdf_light {
            Some(pdf) if self.strategy == Strategy::Mis => self.weight(pdf, pdf_scatter),
            _ => 1.0,
        }
    }

    /// The weight of light that a ray met, which light samples from point p with normal n would have found with the density
    /// `pdf_light(p, n)`.
    #[inline]
    fn weight_of_hit(&self, origin: &Origin, pdf_light: impl FnOnce(Vec3, Vec3) -> SolidAnglePdf) -> f32 {
        match *origin {
            Origin::Delta => 1.0,
            Origin::Sampled { p, n, pdf } => match self.strategy {
                Strategy::Bsdf => 1.0,
                Strategy::Light => 0.0,
                Strategy::Mis => self.weight(pdf, pdf_light(p, n)),
            },
        }
    }

    /// The weight of a sample with density `pdf` where the other technique has the density `other`, each times its number of samples.
    #[inline]
    fn weight(&self, pdf: SolidAnglePdf, other: SolidAnglePdf) -> f32 {
        if self.fault.is(Fault::LightTwice) {
            return 1.0;
        }
        match self.heuristic {
            Heuristic::Power => power_heuristic(pdf.0, other.0),
            Heuristic::Balance => balance_heuristic(pdf.0, other.0),
        }
    }
}

/// |cos| at the point of a light; 1 where it has no surface.
fn cos_at_light(sample: &LightSample) -> f32 {
    match sample.end {
        LightEnd::Point { ng, .. } if ng != Vec3::ZERO => ng.dot(sample.wi).abs(),
        LightEnd::Point { .. } | LightEnd::Infinity => 1.0,
    }
}
