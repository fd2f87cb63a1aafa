//! Materials as a scene has them: textures, from which each surface point gets the lobe there.

use std::sync::Arc;

use super::{
    Body, Bsdf, Burley, Conductor, Dielectric, Diffuse, DiffuseTransmission, HairMaterial, Interlayer, Layered, Lobe,
    Measured, MeasuredTables, Microfacets, OrenNayar, PlasticMaterial, Principled, PrincipledParameters,
    PrincipledTables, Relief, Roughness, ThinDielectric, TintedConductor, TintedMaterial,
};
use crate::geometry::SurfaceInteraction;
use crate::math::Frame;
use crate::sampling::hash::{hash_u32s, unit_f32};
use crate::spectrum::{CompiledSpectrum, SampledSpectrum, Wavelengths};
use crate::texture::{FloatTexture, SpectrumTexture};

/// The material of a surface.
#[derive(Clone, Debug)]
pub enum Material {
    /// Diffuse reflection on both sides.
    Diffuse {
        /// Albedo, in [0, 1].
        reflectance: SpectrumTexture,
        /// Of [`OrenNayar`]; 0 is Lambertian.
        roughness: FloatTexture,
    },
    /// Lambertian reflection and transmission.
    DiffuseTransmission {
        /// What is reflected.
        reflectance: SpectrumTexture,
        /// What is transmitted.
        transmittance: SpectrumTexture,
        /// A factor of both; they are kept in [0, 1].
        scale: f32,
    },
    /// A metal, smooth or rough, on both sides.
    Conductor {
        /// What it reflects.
        ior: ConductorIor,
        /// How rough it is.
        roughness: Roughness,
        /// Whether light goes on from facet to facet.
        multiple_scattering: bool,
    },
    /// The boundary of a transparent body, smooth or rough.
    Dielectric {
        /// Index of refraction inside over that outside.
        eta: CompiledSpectrum,
        /// How rough it is.
        roughness: Roughness,
        /// Whether light goes on from facet to facet.
        multiple_scattering: bool,
    },
    /// A thin sheet.
    ThinDielectric {
        /// Index of refraction over that of both sides.
        eta: CompiledSpectrum,
    },
    /// A Lambertian surface under a coat.
    CoatedDiffuse {
        /// Its albedo.
        reflectance: SpectrumTexture,
        /// The coat.
        coat: Arc<Coat>,
    },
    /// A metal under a coat.
    CoatedConductor {
        /// Indices of the metal, relative to vacuum.
        ior: ConductorIor,
        /// How rough the metal is.
        roughness: Roughness,
        /// The coat.
        coat: Arc<Coat>,
    },
    /// No surface, only a boundary between media, which a path passes without being scattered.
    Interface,
    /// One of two materials, from point to point.
    Mix(Arc<MixMaterial>),
    /// By the parameters of artists.
    Principled(Arc<PrincipledMaterial>),
    /// Another material under a bump or normal map.
    Relief(Arc<Relief>),
    /// By measurements.
    Measured(Arc<MeasuredTables>),
    /// One material on the side of the shading normal, another on the other; black without one. Neither transmits.
    Sided(Arc<[Option<Material>; 2]>),
    /// A specular material of which less light comes.
    Tinted(Arc<TintedMaterial>),
    /// A diffuse base under a dielectric boundary, in closed form.
    Plastic(Arc<PlasticMaterial>),
    /// A fibre.
    Hair(Arc<HairMaterial>),
}

/// A dielectric coat and what is under it.
#[derive(Clone, Debug)]
pub struct Coat {
    /// Index of refraction over that of the outside.
    pub eta: CompiledSpectrum,
    /// How rough it is.
    pub roughness: Roughness,
    /// See [`Interlayer`].
    pub thickness: FloatTexture,
    /// See [`Interlayer`].
    pub albedo: SpectrumTexture,
    /// See [`Interlayer`].
    pub g: FloatTexture,
    /// See [`Interlayer`].
    pub max_depth: u32,
    /// See [`Interlayer`].
    pub samples: u32,
}

/// Two materials of which each point has one: pbrt-v4's mix. The choice is a hash of the position, so that all that is asked of a
/// point gets the same answer.
#[derive(Clone, Debug)]
pub struct MixMaterial {
    /// The two.
    pub materials: [Material; 2],
    /// The probability of the second.
    pub amount: FloatTexture,
}

/// The textures of [`PrincipledParameters`].
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "see the description")]
pub struct PrincipledMaterial {
    pub base: SpectrumTexture,
    pub roughness: FloatTexture,
    pub anisotropic: FloatTexture,
    pub metallic: FloatTexture,
    pub spec_trans: FloatTexture,
    pub eta: f32,
    pub spec_tint: FloatTexture,
    pub sheen: FloatTexture,
    pub sheen_tint: FloatTexture,
    pub clearcoat: FloatTexture,
    pub clearcoat_gloss: FloatTexture,
    pub flatness: FloatTexture,
    pub as_in_mitsuba: bool,
    pub tables: PrincipledTables,
}

/// How the complex index of refraction of a conductor is given.
#[derive(Clone, Debug)]
pub enum ConductorIor {
    /// n + i k.
    Measured {
        /// n.
        eta: SpectrumTexture,
        /// k.
        k: SpectrumTexture,
    },
    /// The reflectance at normal incidence, from which n = 1 and k follow, as in pbrt-v4.
    Reflectance(SpectrumTexture),
}

impl Material {
    /// The BSDF at a surface point. A material whose index of refraction varies with wavelength ends the secondary wavelengths.
    #[inline]
    pub fn bsdf(&self, si: &SurfaceInteraction, lambda: &mut Wavelengths) -> Bsdf<'_> {
        let material = match self {
            Self::Mix(_) | Self::Sided(_) => match self.chosen(si) {
                Some(material) => material,
                None => {
                    return Bsdf::new(
                        Frame::from_normal(si.ns),
                        Lobe::Diffuse(Diffuse::new(SampledSpectrum::ZERO)),
                    );
                }
            },
            _ => self,
        };
        // The commonest first, and made in its place: a lobe of any kind is some hundred bytes to move.
        if let Self::Diffuse { reflectance, roughness } = material
            && roughness.at(si) == 0.0
        {
            let albedo = reflectance.reflectance_at(si, lambda);
            return Bsdf::new(Frame::from_normal(si.ns), Lobe::Diffuse(Diffuse::new(albedo)));
        }
        if let Self::Relief(relief) = material {
            return relief.bsdf(si, lambda);
        }
        let (lobe, is_anisotropic) = material.lobe(si, lambda);
        let frame = if is_anisotropic {
            Frame::from_normal_tangent(si.ns, si.dpdu)
        } else {
            Frame::from_normal(si.ns)
        };
        Bsdf::new(frame, lobe)
    }

    /// Its reflectance, if it is Lambertian everywhere and from both sides, and nothing else.
    #[inline]
    pub fn lambertian(&self) -> Option<&SpectrumTexture> {
        match self {
            Self::Diffuse {
                reflectance,
                roughness: FloatTexture::Constant(0.0),
            } => Some(reflectance),
            _ => None,
        }
    }

    /// It at a surface point, if it is a conductor whose facets reflect once. `si` is asked for only if so.
    #[inline]
    pub fn conductor(&self, si: impl FnOnce() -> SurfaceInteraction, lambda: &Wavelengths) -> Option<TintedConductor> {
        let (untinted, reflectance) = match self {
            Self::Tinted(tinted) => (&tinted.material, Some(&tinted.reflectance)),
            _ => (self, None),
        };
        let Self::Conductor {
            ior,
            roughness,
            multiple_scattering: false,
        } = untinted
        else {
            return None;
        };
        let si = &si();
        let (eta, k) = ior.at(si, lambda);
        Some(TintedConductor {
            conductor: Conductor::new(eta, k, roughness.at(si)),
            tint: reflectance.map_or(SampledSpectrum::ONE, |reflectance| {
                reflectance.reflectance_at(si, lambda)
            }),
        })
    }

    /// Whether some point of it may have delta lobes: be a mirror or clear glass, alone or under or over something else.
    pub fn may_have_delta(&self) -> bool {
        match self {
            Self::Diffuse { .. }
            | Self::DiffuseTransmission { .. }
            | Self::Measured(_)
            | Self::Principled(_)
            | Self::Hair(_)
            | Self::Interface => false,
            Self::Conductor { roughness, .. } | Self::Dielectric { roughness, .. } => roughness.may_be_smooth(),
            Self::ThinDielectric { .. } => true,
            Self::CoatedDiffuse { coat, .. } | Self::CoatedConductor { coat, .. } => coat.roughness.may_be_smooth(),
            Self::Mix(mix) => mix.materials.iter().any(Self::may_have_delta),
            Self::Sided(sides) => sides.iter().flatten().any(Self::may_have_delta),
            Self::Tinted(tinted) => tinted.material.may_have_delta(),
            Self::Plastic(plastic) => plastic.tables.is_smooth(),
            Self::Relief(relief) => relief.material.may_have_delta(),
        }
    }

    /// Whether it may refract wavelengths differently, which ends all but one of a path's.
    pub fn disperses(&self) -> bool {
        match self {
            Self::Dielectric { eta, .. } => !eta.is_constant_over_wavelengths(),
            Self::CoatedDiffuse { coat, .. } | Self::CoatedConductor { coat, .. } => {
                !coat.eta.is_constant_over_wavelengths()
            }
            Self::Mix(mix) => mix.materials.iter().any(Self::disperses),
            Self::Sided(sides) => sides.iter().flatten().any(Self::disperses),
            Self::Tinted(tinted) => tinted.material.disperses(),
            Self::Relief(relief) => relief.material.disperses(),
            Self::Diffuse { .. }
            | Self::DiffuseTransmission { .. }
            | Self::Conductor { .. }
            | Self::ThinDielectric { .. }
            | Self::Hair(_)
            | Self::Interface
            | Self::Plastic(_)
            | Self::Principled(_)
            | Self::Measured(_) => false,
        }
    }

    /// Whether no point of it can [be specular](Bsdf::is_specular), whatever its textures say, nor has delta lobes.
    pub fn is_never_specular(&self) -> bool {
        match self {
            Self::Diffuse { .. } | Self::DiffuseTransmission { .. } | Self::Measured(_) | Self::Hair(_) => true,
            Self::Mix(mix) => mix.materials.iter().all(Self::is_never_specular),
            Self::Sided(sides) => sides.iter().flatten().all(Self::is_never_specular),
            Self::Plastic(plastic) => !plastic.tables.is_smooth(),
            Self::Relief(relief) => relief.material.is_never_specular(),
            Self::Conductor { .. }
            | Self::Dielectric { .. }
            | Self::ThinDielectric { .. }
            | Self::Interface
            | Self::CoatedDiffuse { .. }
            | Self::CoatedConductor { .. }
            | Self::Tinted(_)
            | Self::Principled(_) => false,
        }
    }

    /// The lobe, and whether it matters which way the tangent points.
    #[inline]
    pub(super) fn lobe(&self, si: &SurfaceInteraction, lambda: &mut Wavelengths) -> (Lobe<'_>, bool) {
        match self {
            Self::Diffuse { reflectance, roughness } => {
                let albedo = reflectance.reflectance_at(si, lambda);
                let roughness = roughness.at(si);
                let lobe = if roughness > 0.0 {
                    Lobe::OrenNayar(OrenNayar::new(albedo, roughness.min(1.0)))
                } else {
                    Lobe::Diffuse(Diffuse::new(albedo))
                };
                (lobe, false)
            }
            _ => self.other_lobe(si, lambda),
        }
    }

    /// All but the commonest.
    fn other_lobe(&self, si: &SurfaceInteraction, lambda: &mut Wavelengths) -> (Lobe<'_>, bool) {
        match self {
            Self::Diffuse { .. } => self.lobe(si, lambda),
            Self::DiffuseTransmission {
                reflectance,
                transmittance,
                scale,
            } => {
                let [r, t] = [reflectance, transmittance].map(|part| {
                    let value = part.reflectance_at(si, lambda) * *scale;
                    value.map(|v| v.min(1.0))
                });
                (Lobe::DiffuseTransmission(DiffuseTransmission::new(r, t)), false)
            }
            Self::Conductor {
                ior,
                roughness,
                multiple_scattering,
            } => {
                let ((eta, k), facets) = (ior.at(si, lambda), roughness.at(si));
                let lobe = Conductor::new(eta, k, facets).with_multiple_scattering(*multiple_scattering);
                (Lobe::Conductor(lobe), is_anisotropic(facets))
            }
            Self::Dielectric {
                eta,
                roughness,
                multiple_scattering,
            } => {
                let facets = roughness.at(si);
                let lobe = Dielectric::new(hero_index(eta, lambda), facets);
                let lobe = lobe.with_multiple_scattering(*multiple_scattering);
                (Lobe::Dielectric(lobe), is_anisotropic(facets))
            }
            // Who does not know of media sees a sheet of nothing.
            Self::Interface => (Lobe::ThinDielectric(ThinDielectric::new(SampledSpectrum::ONE)), false),
            Self::ThinDielectric { eta } => (Lobe::ThinDielectric(ThinDielectric::new(eta.sample(lambda))), false),
            Self::CoatedDiffuse { reflectance, coat } => {
                let (boundary, anisotropic) = coat.boundary(si, lambda);
                let body = Body::Diffuse(Diffuse::new(reflectance.reflectance_at(si, lambda)));
                (
                    Lobe::Layered(Layered::new(boundary, body, coat.interlayer(si, lambda))),
                    anisotropic,
                )
            }
            Self::CoatedConductor { ior, roughness, coat } => {
                let (boundary, coat_is_anisotropic) = coat.boundary(si, lambda);
                let facets = roughness.at(si);
                let (eta, k) = ior.at(si, lambda);
                let inside = 1.0 / boundary.eta();
                let body = Body::Conductor(Conductor::new(eta * inside, k * inside, facets));
                let lobe = Layered::new(boundary, body, coat.interlayer(si, lambda));
                (Lobe::Layered(lobe), coat_is_anisotropic || is_anisotropic(facets))
            }
            Self::Mix(_) | Self::Sided(_) => match self.chosen(si) {
                Some(material) => material.lobe(si, lambda),
                None => (Lobe::Diffuse(Diffuse::new(SampledSpectrum::ZERO)), false),
            },
            Self::Tinted(tinted) => tinted.lobe(si, lambda),
            Self::Plastic(plastic) => (Lobe::Plastic(plastic.at(si, lambda)), false),
            // For those who want no more than the lobe: the normal has been bent before.
            Self::Relief(relief) => relief.material.lobe(si, lambda),
            Self::Principled(material) => {
                let p = material.at(si, lambda);
                if material.as_in_mitsuba {
                    let lobe = Burley::new(p, luminance(p.base, lambda));
                    return (Lobe::Burley(lobe), p.anisotropic > 0.0);
                }
                let lobe = Principled::new(p, &material.tables);
                (Lobe::Principled(lobe), p.anisotropic > 0.0)
            }
            Self::Measured(tables) => (Lobe::Measured(Measured::new(tables, lambda)), true),
            Self::Hair(hair) => (Lobe::Hair(hair.at(si, lambda)), true),
        }
    }

    /// The material that a mix is at a point, or that is on the side that it is seen from: neither of these. `None` is black.
    fn chosen(&self, si: &SurfaceInteraction) -> Option<&Self> {
        let mut material = self;
        let mut u = unit_f32((hash_u32s(&si.p.to_array().map(f32::to_bits)) >> 32) as u32);
        loop {
            match material {
                Self::Mix(mix) => {
                    let amount = mix.amount.at(si);
                    // What is left of the number is uniform again, for mixes of mixes.
                    if u < amount {
                        material = &mix.materials[1];
                        u /= amount;
                    } else {
                        material = &mix.materials[0];
                        u = (u - amount) / (1.0 - amount);
                    }
                }
                Self::Sided(sides) => material = sides[usize::from(si.wo.dot(si.ns) < 0.0)].as_ref()?,
                _ => return Some(material),
            }
        }
    }
}

/// The luminance of a reflectance; in spectral mode its mean over the wavelengths at hand.
fn luminance(base: SampledSpectrum, lambda: &Wavelengths) -> f32 {
    if *lambda != Wavelengths::rgb() {
        return base.mean();
    }
    let [r, g, b, _] = base.0;
    0.212_671 * r + 0.715_160 * g + 0.072_169 * b
}

fn is_anisotropic(facets: Option<Microfacets>) -> bool {
    facets.is_some_and(|facets| !facets.is_isotropic())
}

/// An index of refraction; one that varies ends the secondary wavelengths.
fn hero_index(eta: &CompiledSpectrum, lambda: &mut Wavelengths) -> f32 {
    if !eta.is_constant_over_wavelengths() {
        lambda.terminate_secondary();
    }
    eta.sample(lambda).0[0]
}

impl Coat {
    /// The coat's boundary, and whether its tangent matters.
    fn boundary(&self, si: &SurfaceInteraction, lambda: &mut Wavelengths) -> (Dielectric, bool) {
        let facets = self.roughness.at(si);
        (
            Dielectric::new(hero_index(&self.eta, lambda), facets),
            is_anisotropic(facets),
        )
    }

    fn interlayer(&self, si: &SurfaceInteraction, lambda: &Wavelengths) -> Interlayer {
        Interlayer {
            thickness: self.thickness.at(si).max(0.0),
            albedo: self.albedo.reflectance_at(si, lambda),
            g: self.g.at(si).clamp(-0.99, 0.99),
            max_depth: self.max_depth,
            samples: self.samples,
        }
    }
}

impl PrincipledMaterial {
    fn at(&self, si: &SurfaceInteraction, lambda: &Wavelengths) -> PrincipledParameters {
        let unit = |texture: &FloatTexture| texture.at(si).clamp(0.0, 1.0);
        PrincipledParameters {
            base: self.base.reflectance_at(si, lambda),
            roughness: unit(&self.roughness),
            anisotropic: unit(&self.anisotropic),
            metallic: unit(&self.metallic),
            spec_trans: unit(&self.spec_trans),
            eta: self.eta,
            spec_tint: unit(&self.spec_tint),
            sheen: unit(&self.sheen),
            sheen_tint: unit(&self.sheen_tint),
            clearcoat: unit(&self.clearcoat),
            clearcoat_gloss: unit(&self.clearcoat_gloss),
            flatness: unit(&self.flatness),
        }
    }
}

impl ConductorIor {
    fn at(&self, si: &SurfaceInteraction, lambda: &Wavelengths) -> (SampledSpectrum, SampledSpectrum) {
        match self {
            Self::Measured { eta, k } => (eta.at(si, lambda), k.at(si, lambda)),
            Self::Reflectance(r) => {
                // With n = 1, R = k² / (4 + k²) at normal incidence.
                let r = r.at(si, lambda).map(|r| r.clamp(0.0, 0.9999));
                (SampledSpectrum::ONE, r.map(|r| 2.0 * (r / (1.0 - r)).sqrt()))
            }
        }
    }
}
