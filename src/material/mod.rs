//! What surfaces do to light: materials as a scene names them, and the BSDF that one gives at a point for some wavelengths.
//!
//! Each lobe is a file. Lobes work in the local frame of the shading normal, where the cosine to the normal is z.

mod albedo;
mod argument_random;
mod beckmann;
mod bsdf;
mod burley;
mod conductor;
mod dielectric;
mod diffuse;
mod diffuse_transmission;
mod fresnel;
mod hair;
mod lanes;
mod layered;
mod lobe;
mod measured;
mod measured_warp;
mod microfacet;
mod multiscatter;
mod oren_nayar;
mod plastic;
mod principled;
mod relief;
mod roughness;
mod sides;
mod surface;
mod thin_dielectric;
mod tinted;

pub use bsdf::{Bsdf, BsdfSample, BsdfValue, Density, SPECULAR_ALPHA, TransportMode};
pub use burley::Burley;
pub use conductor::Conductor;
pub use dielectric::Dielectric;
pub use diffuse::Diffuse;
pub use diffuse_transmission::DiffuseTransmission;
pub use fresnel::{fresnel_complex, fresnel_dielectric, refract};
pub use hair::{Hair, HairColor, HairMaterial, HairParameters, absorption_of_reflectance};
pub use lanes::{ConductorLanes, TintedConductor};
pub use layered::{Body, Interlayer, Layered};
pub use lobe::{LaneSample, LaneValue, Lobe, LocalSample, LocalValue};
pub use measured::{Measured, MeasuredTables};
pub use microfacet::{Distribution, Microfacets};
pub use oren_nayar::OrenNayar;
pub use plastic::{Plastic, PlasticMaterial, PlasticParameters, PlasticTables};
pub use principled::{Principled, PrincipledParameters, PrincipledTables};
pub use relief::{Relief, ReliefMap};
pub use roughness::Roughness;
pub use surface::{Coat, ConductorIor, Material, MixMaterial, PrincipledMaterial};
pub use thin_dielectric::ThinDielectric;
pub use tinted::{Tinted, TintedMaterial, Untinted};
