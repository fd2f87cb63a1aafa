//! Every kind of material and its parameters, for the reader and for `lucerna list materials`.

use super::parameter::{FloatRange, Parameter, ParameterKind};

/// A kind of material.
#[derive(Clone, Copy, Debug)]
pub struct MaterialEntry {
    /// As in a scene file.
    pub name: &'static str,
    /// What it is, in a sentence without a full stop.
    pub doc: &'static str,
    /// Its parameters.
    pub parameters: &'static [&'static Parameter],
}

/// All kinds.
pub static MATERIALS: [MaterialEntry; 11] = [
    MaterialEntry {
        name: "diffuse",
        doc: "Diffuse reflection on both sides",
        parameters: &[&REFLECTANCE, &DIFFUSE_ROUGHNESS, &DISPLACEMENT, &NORMAL_MAP],
    },
    MaterialEntry {
        name: "diffusetransmission",
        doc: "Lambertian reflection and transmission",
        parameters: &[
            &REFLECTED,
            &TRANSMITTED,
            &TRANSMISSION_SCALE,
            &DISPLACEMENT,
            &NORMAL_MAP,
        ],
    },
    MaterialEntry {
        name: "conductor",
        doc: "A metal, on both sides; either by eta and k or by its reflectance",
        parameters: &[
            &ETA_METAL,
            &K,
            &METAL_REFLECTANCE,
            &ROUGHNESS,
            &U_ROUGHNESS,
            &V_ROUGHNESS,
            &REMAP_ROUGHNESS,
            &DISTRIBUTION,
            &MULTIPLE_SCATTERING,
            &DISPLACEMENT,
            &NORMAL_MAP,
        ],
    },
    MaterialEntry {
        name: "dielectric",
        doc: "The boundary of a transparent body",
        parameters: &[
            &ETA,
            &ROUGHNESS,
            &U_ROUGHNESS,
            &V_ROUGHNESS,
            &REMAP_ROUGHNESS,
            &DISTRIBUTION,
            &MULTIPLE_SCATTERING,
            &DISPLACEMENT,
            &NORMAL_MAP,
        ],
    },
    MaterialEntry {
        name: "thindielectric",
        doc: "A thin smooth sheet of a transparent medium, which light passes straight on",
        parameters: &[&ETA, &DISPLACEMENT, &NORMAL_MAP],
    },
    MaterialEntry {
        name: "coateddiffuse",
        doc: "A Lambertian surface under a dielectric coat, on both sides",
        parameters: &[
            &REFLECTANCE,
            &ETA,
            &ROUGHNESS,
            &U_ROUGHNESS,
            &V_ROUGHNESS,
            &REMAP_ROUGHNESS,
            &DISTRIBUTION,
            &THICKNESS,
            &ALBEDO,
            &G,
            &MAX_DEPTH,
            &N_SAMPLES,
            &DISPLACEMENT,
            &NORMAL_MAP,
        ],
    },
    MaterialEntry {
        name: "coatedconductor",
        doc: "A metal under a dielectric coat, on both sides",
        parameters: &[
            &CONDUCTOR_ETA,
            &CONDUCTOR_K,
            &METAL_REFLECTANCE,
            &CONDUCTOR_ROUGHNESS,
            &CONDUCTOR_U_ROUGHNESS,
            &CONDUCTOR_V_ROUGHNESS,
            &INTERFACE_ETA,
            &INTERFACE_ROUGHNESS,
            &INTERFACE_U_ROUGHNESS,
            &INTERFACE_V_ROUGHNESS,
            &REMAP_ROUGHNESS,
            &DISTRIBUTION,
            &THICKNESS,
            &ALBEDO,
            &G,
            &MAX_DEPTH,
            &N_SAMPLES,
            &DISPLACEMENT,
            &NORMAL_MAP,
        ],
    },
    MaterialEntry {
        name: "mix",
        doc: "At each point one of two named materials, chosen by a hash of the position",
        parameters: &[&MIX_MATERIALS, &MIX_AMOUNT],
    },
    MaterialEntry {
        name: "principled",
        doc: "Metal, plastic, glass, cloth and lacquer by the parameters of Mitsuba's principled (an extension)",
        parameters: &[
            &BASE_COLOR,
            &PRINCIPLED_ROUGHNESS,
            &ANISOTROPIC,
            &METALLIC,
            &SPEC_TRANS,
            &PRINCIPLED_ETA,
            &SPECULAR,
            &SPEC_TINT,
            &SHEEN,
            &SHEEN_TINT,
            &CLEARCOAT,
            &CLEARCOAT_GLOSS,
            &DISPLACEMENT,
            &NORMAL_MAP,
        ],
    },
    MaterialEntry {
        name: "measured",
        doc: "Reflection as measured, on both sides, from a file of RGL's database",
        parameters: &[&MEASURED_FILE, &DISPLACEMENT, &NORMAL_MAP],
    },
    MaterialEntry {
        name: "interface",
        doc: "No surface",
        parameters: &[],
    },
];

const fn parameter(name: &'static str, kind: ParameterKind, doc: &'static str) -> Parameter {
    Parameter { name, kind, doc }
}

const fn reflectance(default: f64) -> ParameterKind {
    ParameterKind::Reflectance { default: Some(default) }
}

const fn unit(default: f64) -> ParameterKind {
    ParameterKind::FloatTexturedIn {
        default: Some(default),
        range: FloatRange::Unit,
    }
}

const ROUGH: ParameterKind = ParameterKind::FloatTexturedIn {
    default: Some(0.0),
    range: FloatRange::NotNegative,
};
const ROUGH_ONE_WAY: ParameterKind = ParameterKind::FloatTexturedIn {
    default: None,
    range: FloatRange::NotNegative,
};
const GLASS: ParameterKind = ParameterKind::GlassIndex { default: 1.5 };
const COPPER_ETA: ParameterKind = ParameterKind::MetalIndex {
    default: "metal-Cu-eta",
};
const COPPER_K: ParameterKind = ParameterKind::MetalAbsorption { default: "metal-Cu-k" };

pub(super) static REFLECTANCE: Parameter = parameter("reflectance", reflectance(0.5), "Albedo");
pub(super) static DIFFUSE_ROUGHNESS: Parameter = parameter(
    "roughness",
    unit(0.0),
    "Roughness of the energy-preserving model of Oren and Nayar; 0 is Lambertian (an extension)",
);

pub(super) static REFLECTED: Parameter = parameter("reflectance", reflectance(0.25), "What is reflected");
pub(super) static TRANSMITTED: Parameter = parameter("transmittance", reflectance(0.25), "What is transmitted");
pub(super) static TRANSMISSION_SCALE: Parameter = parameter(
    "scale",
    ParameterKind::Float {
        default: 1.0,
        range: FloatRange::NotNegative,
    },
    "A factor of both",
);

pub(super) static ETA_METAL: Parameter = parameter("eta", COPPER_ETA, "Index of refraction, real part");
pub(super) static K: Parameter = parameter("k", COPPER_K, "Index of refraction, imaginary part");
pub(super) static METAL_REFLECTANCE: Parameter = parameter(
    "reflectance",
    ParameterKind::Reflectance { default: None },
    "Reflectance head on, instead of eta and k",
);
pub(super) static ROUGHNESS: Parameter = parameter("roughness", ROUGH, "Roughness; 0 is smooth");
pub(super) static U_ROUGHNESS: Parameter = parameter("uroughness", ROUGH_ONE_WAY, "The same along dp/du only");
pub(super) static V_ROUGHNESS: Parameter = parameter("vroughness", ROUGH_ONE_WAY, "The same along dp/dv only");
pub(super) static REMAP_ROUGHNESS: Parameter = parameter(
    "remaproughness",
    ParameterKind::Bool(true),
    "Whether the slope of facets is the square root of the roughness, not the roughness itself",
);
pub(super) static DISTRIBUTION: Parameter = parameter(
    "distribution",
    ParameterKind::Choice {
        default: "ggx",
        choices: &["ggx", "beckmann"],
    },
    "Distribution of the slopes of facets (an extension)",
);
pub(super) static MULTIPLE_SCATTERING: Parameter = parameter(
    "multiplescattering",
    ParameterKind::Bool(false),
    "Whether light goes on from facet to facet, so that rough surfaces lose none (an extension)",
);

pub(super) static ETA: Parameter = parameter(
    "eta",
    GLASS,
    "Index of refraction of the inside over that of the outside",
);

pub(super) static THICKNESS: Parameter = parameter(
    "thickness",
    ParameterKind::FloatTexturedIn {
        default: Some(0.01),
        range: FloatRange::NotNegative,
    },
    "Mean free paths from the coat to what is under it",
);
pub(super) static ALBEDO: Parameter = parameter(
    "albedo",
    reflectance(0.0),
    "Share of extinction there that is scattering",
);
pub(super) static G: Parameter = parameter(
    "g",
    ParameterKind::FloatTexturedIn {
        default: Some(0.0),
        range: FloatRange::Asymmetry,
    },
    "Asymmetry of that scattering, the mean cosine",
);
pub(super) static MAX_DEPTH: Parameter = parameter(
    "maxdepth",
    ParameterKind::Integer {
        default: 10,
        range: (1, 1000),
    },
    "Most events of a walk between the layers",
);
pub(super) static N_SAMPLES: Parameter = parameter(
    "nsamples",
    ParameterKind::Integer {
        default: 1,
        range: (1, 1000),
    },
    "Walks that a value is the mean of",
);
pub(super) static CONDUCTOR_ETA: Parameter = parameter("conductor.eta", COPPER_ETA, "The metal's index, real part");
pub(super) static CONDUCTOR_K: Parameter = parameter("conductor.k", COPPER_K, "The metal's index, imaginary part");
pub(super) static CONDUCTOR_ROUGHNESS: Parameter = parameter("conductor.roughness", ROUGH, "Roughness of the metal");
pub(super) static CONDUCTOR_U_ROUGHNESS: Parameter =
    parameter("conductor.uroughness", ROUGH_ONE_WAY, "The same along dp/du only");
pub(super) static CONDUCTOR_V_ROUGHNESS: Parameter =
    parameter("conductor.vroughness", ROUGH_ONE_WAY, "The same along dp/dv only");
pub(super) static INTERFACE_ETA: Parameter = parameter("interface.eta", GLASS, "Index of refraction of the coat");
pub(super) static INTERFACE_ROUGHNESS: Parameter = parameter("interface.roughness", ROUGH, "Roughness of the coat");
pub(super) static INTERFACE_U_ROUGHNESS: Parameter =
    parameter("interface.uroughness", ROUGH_ONE_WAY, "The same along dp/du only");
pub(super) static INTERFACE_V_ROUGHNESS: Parameter =
    parameter("interface.vroughness", ROUGH_ONE_WAY, "The same along dp/dv only");

pub(super) static MIX_MATERIALS: Parameter = parameter(
    "materials",
    ParameterKind::TwoMaterials,
    "The names of the two materials",
);
pub(super) static MIX_AMOUNT: Parameter = parameter("amount", unit(0.5), "How much there is of the second");

pub(super) static BASE_COLOR: Parameter = parameter(
    "base_color",
    reflectance(0.5),
    "Albedo of what is diffuse, reflectance of metal, tint of glass",
);
pub(super) static PRINCIPLED_ROUGHNESS: Parameter = parameter(
    "roughness",
    unit(0.5),
    "Square root of the slope of facets; also of the diffuse part",
);
pub(super) static ANISOTROPIC: Parameter = parameter(
    "anisotropic",
    unit(0.0),
    "How much slopes along and across the tangent differ",
);
pub(super) static METALLIC: Parameter = parameter("metallic", unit(0.0), "From dielectric to metal");
pub(super) static SPEC_TRANS: Parameter = parameter("spec_trans", unit(0.0), "From opaque to transparent");
pub(super) static PRINCIPLED_ETA: Parameter = parameter(
    "eta",
    ParameterKind::Float {
        default: 1.5,
        range: FloatRange::AtLeastOne,
    },
    "Index of refraction",
);
pub(super) static SPECULAR: Parameter = parameter(
    "specular",
    ParameterKind::Float {
        default: 0.5,
        range: FloatRange::Unit,
    },
    "The index of refraction by the reflectance head on, 0.08 times this; instead of eta",
);
pub(super) static SPEC_TINT: Parameter = parameter(
    "spec_tint",
    unit(0.0),
    "How much specular reflection takes on the hue of the base",
);
pub(super) static SHEEN: Parameter = parameter("sheen", unit(0.0), "Reflection of cloth at grazing angles");
pub(super) static SHEEN_TINT: Parameter =
    parameter("sheen_tint", unit(0.0), "How much that takes on the hue of the base");
pub(super) static CLEARCOAT: Parameter = parameter("clearcoat", unit(0.0), "How much there is of a coat of lacquer");
pub(super) static CLEARCOAT_GLOSS: Parameter =
    parameter("clearcoat_gloss", unit(0.0), "From a satin coat to a glossy one");
pub(super) static DISPLACEMENT: Parameter = Parameter {
    name: "displacement",
    kind: ParameterKind::FloatTextured { default: 0.0 },
    doc: "Height over the surface in scene units: bends the shading normal (a bump map)",
};
pub(super) static NORMAL_MAP: Parameter = Parameter {
    name: "normalmap",
    kind: ParameterKind::File,
    doc: "An image of shading normals in the tangent frame, (1 + n) / 2 by colour, linear; counts before displacement; none by default",
};

pub(super) static MEASURED_FILE: Parameter = parameter("filename", ParameterKind::File, "A .bsdf file");
