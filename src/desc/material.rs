//! Materials and the spectra that they and the lights are given.

use super::Textured;
use crate::error::Span;

/// What a surface is made of.
#[derive(Clone, Debug)]
pub struct MaterialDesc {
    /// Its name, if it was defined by `MakeNamedMaterial`.
    pub name: Option<String>,
    /// What it does to light.
    pub kind: MaterialKind,
    /// Its type in the file; for the default material, the whole file's first byte.
    pub span: Span,
}

/// The kinds of materials, with pbrt-v4's parameters.
#[derive(Clone, Debug)]
pub enum MaterialKind {
    /// Lambertian reflection.
    Diffuse {
        /// Albedo; default 0.5.
        reflectance: Textured<SpectrumDesc>,
    },
    /// A metal.
    Conductor {
        /// What it reflects.
        interface: ConductorDesc,
        /// How rough it is.
        roughness: RoughnessDesc,
    },
    /// A boundary between two transparent media.
    Dielectric {
        /// Index of refraction of the inside over that of the outside; default 1.5.
        eta: SpectrumDesc,
        /// How rough it is.
        roughness: RoughnessDesc,
    },
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

/// The roughness of a GGX microfacet surface, along the two tangent directions.
#[derive(Clone, Debug, PartialEq)]
pub struct RoughnessDesc {
    /// Along dp/du; not negative. 0 for both is a smooth surface.
    pub u: Textured<f32>,
    /// Along dp/dv; not negative.
    pub v: Textured<f32>,
    /// Whether the values are pbrt's perceptual roughness, of which alpha is the square root (the default); if not, they are
    /// alpha itself.
    pub remap: bool,
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
    /// Linear sRGB. In [0, 1] where it is an albedo, else not negative.
    Rgb([f32; 3]),
    /// One of pbrt-v4's names (`metal-Cu-eta`, `glass-BK7`, `stdillum-D65`, ...).
    Named(String),
    /// (wavelength in nm, value), by increasing wavelength, at least one; linear in between and constant outside.
    Samples(Vec<(f32, f32)>),
    /// Planck's law at so many kelvin, scaled to a maximum of 1; positive.
    Blackbody(f32),
}
