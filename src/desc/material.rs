//! Materials and the spectra that they and the lights are given.

use std::sync::Arc;

use super::{ColorSpace, ImageId, MaterialId, MeasuredDesc, TextureId, Textured};
use crate::error::Span;

/// What a surface is made of.
#[derive(Clone, Debug)]
pub struct MaterialDesc {
    /// Its name, if it was defined by `MakeNamedMaterial`.
    pub name: Option<String>,
    /// What it does to light.
    pub kind: MaterialKind,
    /// What bends its shading normals.
    pub relief: Option<ReliefDesc>,
    /// Its type in the file; for the default material, the whole file's first byte.
    pub span: Span,
}

/// What bends the shading normals of a surface.
#[derive(Clone, Debug, PartialEq)]
pub enum ReliefDesc {
    /// A height over the surface, in scene units.
    Displacement(TextureId),
    /// An image of normals in the tangent frame, (1 + n) / 2 by colour, linear.
    Normals(ImageId),
}

/// The kinds of materials, with pbrt-v4's parameters and defaults. Numbers that are not textures are within the ranges of
/// [`MATERIALS`](super::MATERIALS).
#[derive(Clone, Debug)]
pub enum MaterialKind {
    /// Diffuse reflection.
    Diffuse {
        /// Albedo.
        reflectance: Textured<SpectrumDesc>,
        /// Of the energy-preserving model of Oren and Nayar; 0 is Lambertian.
        roughness: Textured<f32>,
    },
    /// Lambertian reflection and transmission.
    DiffuseTransmission {
        /// What is reflected.
        reflectance: Textured<SpectrumDesc>,
        /// What is transmitted.
        transmittance: Textured<SpectrumDesc>,
        /// A factor of both.
        scale: f32,
    },
    /// A metal.
    Conductor {
        /// What it reflects.
        interface: ConductorDesc,
        /// How rough it is.
        roughness: RoughnessDesc,
        /// Whether light goes on from facet to facet.
        multiple_scattering: bool,
    },
    /// A boundary between two transparent media.
    Dielectric {
        /// Index of refraction of the inside over that of the outside.
        eta: SpectrumDesc,
        /// How rough it is.
        roughness: RoughnessDesc,
        /// Whether light goes on from facet to facet.
        multiple_scattering: bool,
    },
    /// A thin sheet of a transparent medium.
    ThinDielectric {
        /// Its index of refraction over that of both sides.
        eta: SpectrumDesc,
    },
    /// A diffuse surface under a dielectric coat.
    CoatedDiffuse {
        /// Albedo of the surface.
        reflectance: Textured<SpectrumDesc>,
        /// The coat.
        coat: CoatDesc,
    },
    /// A metal under a dielectric coat.
    CoatedConductor {
        /// What it reflects; indices are relative to vacuum.
        interface: ConductorDesc,
        /// How rough the metal is.
        roughness: RoughnessDesc,
        /// The coat.
        coat: CoatDesc,
    },
    /// No surface at all, only a boundary between media.
    Interface,
    /// Of two materials, one here and one there.
    Mix {
        /// The two. A mix does not contain itself.
        materials: [MaterialId; 2],
        /// How much there is of the second.
        amount: Textured<f32>,
    },
    /// One material seen from the side of the shading normal, another from behind; black without one. Neither may transmit light.
    Sided {
        /// On the side of the shading normal.
        front: Option<MaterialId>,
        /// On the other side.
        back: Option<MaterialId>,
    },
    /// A conductor, dielectric or thin dielectric of which less light comes than is reflected and transmitted.
    Tinted {
        /// Which.
        material: MaterialId,
        /// Factor of what is reflected.
        reflectance: Textured<SpectrumDesc>,
        /// Factor of what is transmitted.
        transmittance: Textured<SpectrumDesc>,
    },
    /// Mitsuba's `plastic` and `roughplastic`.
    Plastic(PlasticDesc),
    /// A surface by the parameters of artists.
    Principled(PrincipledDesc),
    /// A surface by measurements.
    Measured(Arc<MeasuredDesc>),
    /// Hair: a fibre along dp/du, across which the second texture coordinate runs from 0 to 1.
    Hair(HairDesc),
}

impl MaterialKind {
    /// The materials that it is made of.
    pub fn parts(&self) -> impl Iterator<Item = MaterialId> {
        let parts = match self {
            Self::Mix { materials: [a, b], .. } => [Some(*a), Some(*b)],
            Self::Sided { front, back } => [*front, *back],
            Self::Tinted { material, .. } => [Some(*material), None],
            _ => [None; 2],
        };
        parts.into_iter().flatten()
    }
}

/// The parameters of pbrt-v4's `hair`.
#[derive(Clone, Debug)]
pub struct HairDesc {
    /// What it absorbs.
    pub color: HairColorDesc,
    /// Index of refraction; positive.
    pub eta: f32,
    /// Roughness along the fibre, in [0, 1].
    pub beta_m: Textured<f32>,
    /// Roughness around the fibre, in [0, 1].
    pub beta_n: Textured<f32>,
    /// Slant of the fibre's scales, in degrees.
    pub alpha: Textured<f32>,
}

/// What hair absorbs.
#[derive(Clone, Debug)]
pub enum HairColorDesc {
    /// So much over the radius of a fibre; not negative.
    Absorption(Textured<SpectrumDesc>),
    /// As much as makes many fibres look like this.
    Reflectance(Textured<SpectrumDesc>),
    /// By what it has of its pigments; not negative.
    Pigments {
        /// The brown one.
        eumelanin: Textured<f32>,
        /// The red one.
        pheomelanin: Textured<f32>,
    },
}

/// A coat and what lies between it and the surface under it.
#[derive(Clone, Debug)]
pub struct CoatDesc {
    /// Index of refraction over that of the outside.
    pub eta: SpectrumDesc,
    /// How rough it is.
    pub roughness: RoughnessDesc,
    /// Mean free paths to the surface.
    pub thickness: Textured<f32>,
    /// The share of extinction on the way that is scattering.
    pub albedo: Textured<SpectrumDesc>,
    /// Asymmetry of that scattering.
    pub g: Textured<f32>,
    /// Most events of a walk between the layers.
    pub max_depth: u32,
    /// Walks that a value is the mean of.
    pub samples: u32,
}

/// A diffuse base under a dielectric boundary, in closed form.
#[derive(Clone, Debug)]
pub struct PlasticDesc {
    /// Albedo of the base.
    pub diffuse_reflectance: Textured<SpectrumDesc>,
    /// Factor of what the boundary reflects.
    pub specular_reflectance: Textured<SpectrumDesc>,
    /// Index of refraction of the inside over that of the outside; positive.
    pub eta: f32,
    /// Whether light that the boundary reflects back inside takes on more of the base's color each time.
    pub nonlinear: bool,
    /// How rough the boundary is.
    pub roughness: RoughnessDesc,
}

/// The parameters of Mitsuba's `principled`, all in [0, 1] but for `eta`.
#[derive(Clone, Debug)]
pub struct PrincipledDesc {
    /// Albedo of what is diffuse, reflectance of what is metal, tint of what is transmitted.
    pub base_color: Textured<SpectrumDesc>,
    /// The square root of the microfacets' slope.
    pub roughness: Textured<f32>,
    /// How much slopes along and across the tangent differ.
    pub anisotropic: Textured<f32>,
    /// From dielectric to metal.
    pub metallic: Textured<f32>,
    /// From opaque to transparent.
    pub spec_trans: Textured<f32>,
    /// Index of refraction.
    pub eta: f32,
    /// How much specular reflection takes on the hue of the base.
    pub spec_tint: Textured<f32>,
    /// Retroreflection of cloth at grazing angles.
    pub sheen: Textured<f32>,
    /// How much that takes on the hue of the base.
    pub sheen_tint: Textured<f32>,
    /// A coat of lacquer.
    pub clearcoat: Textured<f32>,
    /// How smooth it is.
    pub clearcoat_gloss: Textured<f32>,
    /// From diffuse to what looks like light from under the surface; only as in Mitsuba.
    pub flatness: Textured<f32>,
    /// Whether its lobes are added up as Mitsuba adds them, which may gain energy and which is not reciprocal.
    pub as_in_mitsuba: bool,
}

/// How a conductor's Fresnel reflectance is given.
#[derive(Clone, Debug)]
pub enum ConductorDesc {
    /// By the complex index of refraction eta + i k; the default is copper (`metal-Cu-eta`, `metal-Cu-k`).
    Ior {
        /// Real part.
        eta: Textured<SpectrumDesc>,
        /// Imaginary part.
        k: Textured<SpectrumDesc>,
    },
    /// By the reflectance r at normal incidence: eta is 1 and k is 2 sqrt(r / (1 - r)), with r at most 0.9999, as in pbrt-v4.
    Reflectance(Textured<SpectrumDesc>),
}

/// How the slopes of microfacets are distributed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum DistributionDesc {
    /// With the long tails of GGX.
    #[default]
    Ggx,
    /// Gaussian.
    Beckmann,
}

/// The roughness of a microfacet surface, along the two tangent directions.
#[derive(Clone, Debug, PartialEq)]
pub struct RoughnessDesc {
    /// Along dp/du; not negative. 0 for both is a smooth surface.
    pub u: Textured<f32>,
    /// Along dp/dv; not negative.
    pub v: Textured<f32>,
    /// Whether the values are pbrt's perceptual roughness, of which alpha is the square root (the default); if not, they are
    /// alpha itself.
    pub remap: bool,
    /// How slopes are distributed.
    pub distribution: DistributionDesc,
    /// Whether facets are masked and shadowed independently of each other, as in Mitsuba; if not, by their heights, as in pbrt.
    pub separable_masking: bool,
}

/// A spectrum as it was typed. What it means (albedo, emission, unbounded) depends on where it is used.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectrumDesc {
    /// Its value.
    pub value: SpectrumValue,
    /// The parameter's value in the file, or the directive for a default.
    pub span: Span,
}

/// The forms of a spectrum.
#[derive(Clone, Debug, PartialEq)]
pub enum SpectrumValue {
    /// The same at all wavelengths.
    Constant(f32),
    /// Linear in a colour space. In [0, 1] where it is an albedo, else not negative.
    Rgb([f32; 3], ColorSpace),
    /// One of the names of [`crate::spectrum::named_spectra`] (`metal-Cu-eta`, `glass-BK7`, `stdillum-D65`, ...).
    Named(String),
    /// (wavelength in nm, value), by increasing wavelength, at least one; linear in between and constant outside.
    Samples(Vec<(f32, f32)>),
    /// Planck's law at so many kelvin, scaled to a maximum of 1; positive.
    Blackbody(f32),
}
