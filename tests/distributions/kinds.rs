//! The lobes with exact densities, and what each one's model says that it reflects and transmits.

use std::f64::consts::PI;
use std::fmt;
use std::sync::OnceLock;

use glam::{DVec3, Vec3};
use lucerna::material::Distribution::{self, Beckmann, Ggx};
use lucerna::material::{
    Bsdf, Burley, Conductor, Dielectric, Diffuse, DiffuseTransmission, Lobe, Microfacets, OrenNayar, Plastic,
    PlasticParameters, PlasticTables, Principled, PrincipledParameters, PrincipledTables, Tinted, TransportMode,
    Untinted,
};
use lucerna::math::Frame;
use lucerna::spectrum::SampledSpectrum;

use super::common::grooves::Grooves;
use super::common::microfacet::{Shape, Slopes, conductor_reflectance, dielectric_reflectance, direction};

/// What is tested, with what the model is made of.
#[derive(Clone, Copy)]
pub enum Kind {
    Diffuse,
    /// Roughness.
    OrenNayar(f32),
    /// Reflectance and transmittance.
    Paper(f32, f32),
    /// Slopes.
    Metal(Distribution, f32, f32),
    /// Index and slopes.
    Glass(Distribution, f32, f32, f32),
    Principled(&'static PrincipledParameters),
    /// The same parameters in Mitsuba's composition, which may gain energy.
    Additive(&'static PrincipledParameters),
    /// A base under a rough boundary, and whether its colour counts at each bounce under it.
    Plastic(bool),
    /// Slopes of a metal, with a factor.
    TintedMetal(f32),
    /// Slopes of glass of index 1.5, with factors.
    TintedGlass(f32),
}

/// Factors of what tinted lobes reflect and transmit.
const TINTS: [f32; 2] = [0.6, 0.8];

const METAL_N: f64 = 0.2;
const METAL_K: f64 = 3.9;
const ALBEDO: f32 = 0.7;

impl fmt::Debug for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Diffuse => write!(f, "diffuse"),
            Self::OrenNayar(roughness) => write!(f, "grooves {roughness}"),
            Self::Paper(r, t) => write!(f, "paper {r} {t}"),
            Self::Metal(distribution, x, y) => write!(f, "metal {distribution:?} {x} {y}"),
            Self::Glass(distribution, eta, x, y) => write!(f, "glass {eta} {distribution:?} {x} {y}"),
            Self::Principled(p) => write!(f, "principled, metallic {} spec_trans {}", p.metallic, p.spec_trans),
            Self::Additive(p) => write!(
                f,
                "additive, metallic {} spec_trans {} flatness {}",
                p.metallic, p.spec_trans, p.flatness
            ),
            Self::Plastic(nonlinear) => write!(f, "plastic, nonlinear {nonlinear}"),
            Self::TintedMetal(alpha) => write!(f, "tinted metal {alpha}"),
            Self::TintedGlass(alpha) => write!(f, "tinted glass {alpha}"),
        }
    }
}

impl Kind {
    /// The BSDF where the normal is +z and the tangent +x.
    pub fn bsdf(self) -> Bsdf<'static> {
        self.bsdf_in(Vec3::Z, Vec3::X)
    }

    /// The BSDF for a normal and a derivative of the position, which need not be perpendicular or of unit length.
    pub fn bsdf_in(self, ns: Vec3, dpdu: Vec3) -> Bsdf<'static> {
        let splat = SampledSpectrum::splat;
        let lobe = match self {
            Self::Diffuse => Lobe::Diffuse(Diffuse::new(splat(ALBEDO))),
            Self::OrenNayar(roughness) => Lobe::OrenNayar(OrenNayar::new(splat(ALBEDO), roughness)),
            Self::Paper(r, t) => Lobe::DiffuseTransmission(DiffuseTransmission::new(splat(r), splat(t))),
            Self::Metal(distribution, x, y) => Lobe::Conductor(Conductor::new(
                splat(METAL_N as f32),
                splat(METAL_K as f32),
                Microfacets::new(distribution, x, y),
            )),
            Self::Glass(distribution, eta, x, y) => {
                Lobe::Dielectric(Dielectric::new(eta, Microfacets::new(distribution, x, y)))
            }
            Self::Principled(parameters) => {
                static TABLES: OnceLock<PrincipledTables> = OnceLock::new();
                let tables = TABLES.get_or_init(|| PrincipledTables::new(parameters.eta));
                Lobe::Principled(Principled::new(*parameters, tables))
            }
            Self::Additive(parameters) => Lobe::Burley(Burley::new(*parameters, parameters.base.mean())),
            Self::Plastic(nonlinear) => {
                static TABLES: OnceLock<PlasticTables> = OnceLock::new();
                let tables = TABLES.get_or_init(|| PlasticTables::new(1.49, Microfacets::new(Beckmann, 0.3, 0.3)));
                let parameters = PlasticParameters {
                    diffuse: splat(ALBEDO),
                    specular: splat(0.9),
                    nonlinear,
                };
                Lobe::Plastic(Plastic::new(parameters, tables))
            }
            Self::TintedMetal(alpha) => {
                let metal = Conductor::new(
                    splat(METAL_N as f32),
                    splat(METAL_K as f32),
                    Microfacets::new(Ggx, alpha, alpha),
                );
                tinted(Untinted::Conductor(metal))
            }
            Self::TintedGlass(alpha) => {
                let glass = Dielectric::new(1.5, Microfacets::new(Ggx, alpha, alpha));
                tinted(Untinted::Dielectric(glass))
            }
        };
        Bsdf::new(Frame::from_normal_tangent(ns, dpdu), lobe)
    }

    /// The index of refraction of the inside over that of the outside, if there is light there.
    pub fn eta(self) -> f32 {
        match self {
            Self::Glass(_, eta, ..) => eta,
            Self::TintedGlass(_) => 1.5,
            Self::Principled(p) | Self::Additive(p) => p.eta,
            _ => 1.0,
        }
    }

    /// Whether its model leaves no more light than came.
    pub fn keeps_energy(self) -> bool {
        !matches!(self, Self::Additive(_))
    }

    /// The cosine-weighted integral of f over all wi for `wo` (of either side), by the model.
    pub fn albedo(self, wo: DVec3, mode: TransportMode) -> f64 {
        let up = DVec3::new(wo.x, wo.y, wo.z.abs());
        let slopes = |distribution, x: f32, y: f32| {
            let shape = match distribution {
                Distribution::Ggx => Shape::Ggx,
                Distribution::Beckmann => Shape::Beckmann,
            };
            Slopes(x.into(), y.into(), shape)
        };
        match self {
            Self::Diffuse => ALBEDO.into(),
            Self::OrenNayar(roughness) => Grooves(roughness.into()).albedo(up.z, ALBEDO.into()),
            Self::Paper(r, t) => f64::from(r) + f64::from(t),
            Self::Metal(distribution, x, y) => {
                let fresnel = |cos| conductor_reflectance(cos, METAL_N, METAL_K);
                slopes(distribution, x, y).reflected(up, fresnel)
            }
            Self::Glass(distribution, eta, x, y) => {
                let [reflected, transmitted] = of_glass(&slopes(distribution, x, y), wo, eta.into(), mode);
                reflected + transmitted
            }
            Self::TintedMetal(alpha) => f64::from(TINTS[0]) * Self::Metal(Ggx, alpha, alpha).albedo(wo, mode),
            Self::TintedGlass(alpha) => {
                let shares = of_glass(&slopes(Ggx, alpha, alpha), wo, 1.5, mode);
                shares
                    .iter()
                    .zip(TINTS)
                    .map(|(share, tint)| share * f64::from(tint))
                    .sum()
            }
            Self::Principled(_) | Self::Additive(_) | Self::Plastic(_) => integral(&self.bsdf(), wo, mode),
        }
    }
}

fn tinted(lobe: Untinted) -> Lobe<'static> {
    let [reflectance, transmittance] = TINTS.map(SampledSpectrum::splat);
    Lobe::Tinted(Tinted::new(lobe, reflectance, transmittance))
}

/// What rough glass reflects and what it transmits.
fn of_glass(slopes: &Slopes, wo: DVec3, eta: f64, mode: TransportMode) -> [f64; 2] {
    let up = DVec3::new(wo.x, wo.y, wo.z.abs());
    let eta = if wo.z > 0.0 { eta } else { 1.0 / eta };
    let scale = if mode == TransportMode::Radiance {
        1.0 / (eta * eta)
    } else {
        1.0
    };
    let fresnel = |cos| dielectric_reflectance(cos, eta);
    [slopes.reflected(up, fresnel), scale * slopes.transmitted(up, eta)]
}

pub const KINDS: [Kind; 31] = [
    Kind::Diffuse,
    Kind::OrenNayar(0.3),
    Kind::OrenNayar(1.0),
    Kind::Paper(0.5, 0.2),
    Kind::Metal(Ggx, 0.1, 0.1),
    Kind::Metal(Ggx, 0.4, 0.4),
    Kind::Metal(Ggx, 1.0, 1.0),
    Kind::Metal(Ggx, 0.15, 0.5),
    Kind::Metal(Beckmann, 0.1, 0.1),
    Kind::Metal(Beckmann, 0.8, 0.8),
    Kind::Metal(Beckmann, 0.15, 0.5),
    Kind::Glass(Ggx, 1.5, 0.1, 0.1),
    Kind::Glass(Ggx, 1.5, 0.5, 0.5),
    Kind::Glass(Ggx, 1.5, 0.2, 0.7),
    Kind::Glass(Ggx, 0.75, 0.3, 0.3),
    Kind::Glass(Ggx, 2.4, 0.9, 0.4),
    Kind::Glass(Beckmann, 1.5, 0.2, 0.5),
    Kind::Glass(Beckmann, 0.75, 0.4, 0.4),
    Kind::Principled(&PLASTIC),
    Kind::Principled(&METAL),
    Kind::Principled(&GLASS),
    Kind::Principled(&ALL),
    Kind::Additive(&PLASTIC),
    Kind::Additive(&FLAT),
    Kind::Additive(&GLASS),
    Kind::Additive(&ALL),
    Kind::Plastic(false),
    Kind::Plastic(true),
    Kind::TintedMetal(0.3),
    Kind::TintedGlass(0.2),
    Kind::TintedGlass(0.6),
];

const PLASTIC: PrincipledParameters = PrincipledParameters {
    base: SampledSpectrum::splat(0.8),
    roughness: 0.5,
    anisotropic: 0.0,
    metallic: 0.0,
    spec_trans: 0.0,
    eta: 1.5,
    spec_tint: 0.0,
    sheen: 0.0,
    sheen_tint: 0.0,
    clearcoat: 0.0,
    clearcoat_gloss: 0.0,
    flatness: 0.0,
};
const FLAT: PrincipledParameters = PrincipledParameters {
    flatness: 0.8,
    ..PLASTIC
};
const METAL: PrincipledParameters = PrincipledParameters {
    metallic: 1.0,
    anisotropic: 0.7,
    clearcoat: 1.0,
    clearcoat_gloss: 0.2,
    ..PLASTIC
};
const GLASS: PrincipledParameters = PrincipledParameters {
    spec_trans: 1.0,
    roughness: 0.6,
    ..PLASTIC
};
const ALL: PrincipledParameters = PrincipledParameters {
    base: SampledSpectrum([1.0, 0.7, 0.3, 0.1]),
    roughness: 0.7,
    anisotropic: 0.3,
    metallic: 0.3,
    spec_trans: 0.4,
    eta: 1.5,
    spec_tint: 0.5,
    sheen: 1.0,
    sheen_tint: 0.5,
    clearcoat: 0.8,
    clearcoat_gloss: 0.1,
    flatness: 0.0,
};

/// The cosine-weighted integral of f over all directions: the midpoint rule in azimuth, of a periodic function, and Gauss's rule
/// of two points in the polar angle.
pub fn integral(bsdf: &Bsdf<'_>, wo: DVec3, mode: TransportMode) -> f64 {
    const STEPS: usize = 250;
    // Towards grazing angles the half vector turns ever faster with the azimuth.
    let azimuths = if wo.z.abs() < 0.1 { 2400 } else { 360 };
    let mut sum = 0.0;
    for i in 0..2 * STEPS {
        let node = if i % 2 == 0 { -1.0 } else { 1.0 } / 3.0_f64.sqrt();
        let theta = PI * ((i / 2) as f64 + 0.5 + 0.5 * node) / STEPS as f64;
        for j in 0..azimuths {
            let phi = 360.0 * (f64::from(j) + 0.5) / f64::from(azimuths);
            let wi = direction(theta.to_degrees(), phi);
            let f = f64::from(bsdf.f(wo.as_vec3(), wi.as_vec3(), mode).0[0]);
            sum += 0.5 * f * wi.z.abs() * theta.sin();
        }
    }
    sum * (PI / STEPS as f64) * (2.0 * PI / f64::from(azimuths))
}

/// Polar angle and azimuth of wo, in degrees, for both sides: from the normal to grazing.
pub const DIRECTIONS: [(f64, f64); 6] = [
    (0.0, 0.0),
    (35.0, 70.0),
    (65.0, 200.0),
    (88.0, 20.0),
    (140.0, 310.0),
    (100.0, 45.0),
];
