//! What materials are told.

use crate::desc::kinds::parameter::{FloatRange, Parameter, ParameterDefault, ParameterKind};

const fn reflectance(default: f64) -> ParameterKind {
    ParameterKind::Reflectance { default: Some(default) }
}

const fn unit(default: f64) -> ParameterKind {
    ParameterKind::FloatTexturedIn {
        default: ParameterDefault::Number(default),
        range: FloatRange::Unit,
    }
}

const ROUGH: ParameterKind = ParameterKind::FloatTexturedIn {
    default: ParameterDefault::Number(0.0),
    range: FloatRange::NotNegative,
};
const fn rough_one_way(both: &'static str) -> ParameterKind {
    ParameterKind::FloatTexturedIn {
        default: ParameterDefault::Of(both),
        range: FloatRange::NotNegative,
    }
}

const GLASS: ParameterKind = ParameterKind::GlassIndex { default: 1.5 };
const COPPER_ETA: ParameterKind = ParameterKind::MetalIndex {
    default: "metal-Cu-eta",
};
const COPPER_K: ParameterKind = ParameterKind::MetalAbsorption { default: "metal-Cu-k" };

pub static REFLECTANCE: Parameter = Parameter::new("reflectance", reflectance(0.5), "Albedo");
pub static DIFFUSE_ROUGHNESS: Parameter = Parameter::new(
    "roughness",
    unit(0.0),
    "Roughness of the energy-preserving model of Oren and Nayar; 0 is Lambertian (an extension)",
);

pub static REFLECTED: Parameter = Parameter::new("reflectance", reflectance(0.25), "What is reflected");
pub static TRANSMITTED: Parameter = Parameter::new("transmittance", reflectance(0.25), "What is transmitted");
pub static TRANSMISSION_SCALE: Parameter = Parameter::float("scale", 1.0, FloatRange::NotNegative, "A factor of both");

pub static ETA_METAL: Parameter = Parameter::new("eta", COPPER_ETA, "Index of refraction, real part");
pub static K: Parameter = Parameter::new("k", COPPER_K, "Index of refraction, imaginary part");
pub static METAL_REFLECTANCE: Parameter = Parameter::new(
    "reflectance",
    ParameterKind::Reflectance { default: None },
    "Reflectance head on, instead of eta and k",
);
pub static ROUGHNESS: Parameter = Parameter::new("roughness", ROUGH, "Roughness; 0 is smooth");
pub static U_ROUGHNESS: Parameter =
    Parameter::new("uroughness", rough_one_way("roughness"), "The same along dp/du only");
pub static V_ROUGHNESS: Parameter =
    Parameter::new("vroughness", rough_one_way("roughness"), "The same along dp/dv only");
pub static REMAP_ROUGHNESS: Parameter = Parameter::flag(
    "remaproughness",
    true,
    "Whether the slope of facets is the square root of the roughness, not the roughness itself",
);
pub static DISTRIBUTION: Parameter = Parameter::choice(
    "distribution",
    &["ggx", "beckmann"],
    "Distribution of the slopes of facets (an extension)",
);
pub static MASKING: Parameter = Parameter::choice(
    "masking",
    &["correlated", "separable"],
    "Whether facets are masked and shadowed by their heights, as in pbrt, or independently, as in Mitsuba (an extension)",
);
pub static MULTIPLE_SCATTERING: Parameter = Parameter::flag(
    "multiplescattering",
    false,
    "Whether light goes on from facet to facet, so that rough surfaces lose none (an extension)",
);

pub static ETA: Parameter = Parameter::new(
    "eta",
    GLASS,
    "Index of refraction of the inside over that of the outside",
);

pub static THICKNESS: Parameter = Parameter::new(
    "thickness",
    ParameterKind::FloatTexturedIn {
        default: ParameterDefault::Number(0.01),
        range: FloatRange::NotNegative,
    },
    "From the coat to what is under it",
)
.unit("mean free paths");
pub static ALBEDO: Parameter = Parameter::new(
    "albedo",
    reflectance(0.0),
    "Share of extinction there that is scattering",
);
pub static G: Parameter = Parameter::new(
    "g",
    ParameterKind::FloatTexturedIn {
        default: ParameterDefault::Number(0.0),
        range: FloatRange::Asymmetry,
    },
    "Asymmetry of that scattering, the mean cosine",
);
pub static MAX_DEPTH: Parameter =
    Parameter::integer("maxdepth", 10, (1, 1000), "Most events of a walk between the layers");
pub static N_SAMPLES: Parameter = Parameter::integer("nsamples", 1, (1, 1000), "Walks that a value is the mean of");
pub static CONDUCTOR_ETA: Parameter = Parameter::new("conductor.eta", COPPER_ETA, "The metal's index, real part");
pub static CONDUCTOR_K: Parameter = Parameter::new("conductor.k", COPPER_K, "The metal's index, imaginary part");
pub static CONDUCTOR_ROUGHNESS: Parameter = Parameter::new("conductor.roughness", ROUGH, "Roughness of the metal");
pub static CONDUCTOR_U_ROUGHNESS: Parameter = Parameter::new(
    "conductor.uroughness",
    rough_one_way("conductor.roughness"),
    "The same along dp/du only",
);
pub static CONDUCTOR_V_ROUGHNESS: Parameter = Parameter::new(
    "conductor.vroughness",
    rough_one_way("conductor.roughness"),
    "The same along dp/dv only",
);
pub static INTERFACE_ETA: Parameter = Parameter::new("interface.eta", GLASS, "Index of refraction of the coat");
pub static INTERFACE_ROUGHNESS: Parameter = Parameter::new("interface.roughness", ROUGH, "Roughness of the coat");
pub static INTERFACE_U_ROUGHNESS: Parameter = Parameter::new(
    "interface.uroughness",
    rough_one_way("interface.roughness"),
    "The same along dp/du only",
);
pub static INTERFACE_V_ROUGHNESS: Parameter = Parameter::new(
    "interface.vroughness",
    rough_one_way("interface.roughness"),
    "The same along dp/dv only",
);

pub static MIX_MATERIALS: Parameter = Parameter::new(
    "materials",
    ParameterKind::TwoMaterials,
    "The names of the two materials",
);
pub static MIX_AMOUNT: Parameter = Parameter::new("amount", unit(0.5), "How much there is of the second");

pub static BASE_COLOR: Parameter = Parameter::new(
    "base_color",
    reflectance(0.5),
    "Albedo of what is diffuse, reflectance of metal, tint of glass",
);
pub static PRINCIPLED_ROUGHNESS: Parameter = Parameter::new(
    "roughness",
    unit(0.5),
    "Square root of the slope of facets; also of the diffuse part",
);
pub static ANISOTROPIC: Parameter = Parameter::new(
    "anisotropic",
    unit(0.0),
    "How much slopes along and across the tangent differ",
);
pub static METALLIC: Parameter = Parameter::new("metallic", unit(0.0), "From dielectric to metal");
pub static SPEC_TRANS: Parameter = Parameter::new("spec_trans", unit(0.0), "From opaque to transparent");
pub static PRINCIPLED_ETA: Parameter = Parameter::float("eta", 1.5, FloatRange::AtLeastOne, "Index of refraction");
pub static SPECULAR: Parameter = Parameter::float(
    "specular",
    0.5,
    FloatRange::Unit,
    "The index of refraction by the reflectance head on, 0.08 times this; instead of eta",
);
pub static SPEC_TINT: Parameter = Parameter::new(
    "spec_tint",
    unit(0.0),
    "How much specular reflection takes on the hue of the base",
);
pub static SHEEN: Parameter = Parameter::new("sheen", unit(0.0), "Reflection of cloth at grazing angles");
pub static SHEEN_TINT: Parameter =
    Parameter::new("sheen_tint", unit(0.0), "How much that takes on the hue of the base");
pub static CLEARCOAT: Parameter = Parameter::new("clearcoat", unit(0.0), "How much there is of a coat of lacquer");
pub static CLEARCOAT_GLOSS: Parameter =
    Parameter::new("clearcoat_gloss", unit(0.0), "From a satin coat to a glossy one");
pub static FLATNESS: Parameter = Parameter::new(
    "flatness",
    unit(0.0),
    "From diffuse to what looks like light from under the surface; only with additive",
);
pub static ADDITIVE: Parameter = Parameter::flag(
    "additive",
    false,
    "Whether lobes are added up as Mitsuba adds them, which may gain energy",
);

pub static SPECULAR_REFLECTANCE: Parameter = Parameter::new(
    "specularreflectance",
    reflectance(1.0),
    "A factor of what the boundary reflects",
);
pub static PLASTIC_ETA: Parameter = Parameter::float(
    "eta",
    1.49,
    FloatRange::Positive,
    "Index of refraction of the base over that of the outside",
);
pub static NONLINEAR: Parameter = Parameter::flag(
    "nonlinear",
    false,
    "Whether light that is reflected back inside takes on more of the base's colour each time",
);

pub static FRONT: Parameter = Parameter::new(
    "front",
    ParameterKind::Material,
    "On the side of the normal; black by default",
);
pub static BACK: Parameter = Parameter::new("back", ParameterKind::Material, "On the other side; black by default");

pub static TINTED: Parameter = Parameter::new("material", ParameterKind::Material, "Which; required");
pub static TINT_REFLECTED: Parameter = Parameter::new("reflectance", reflectance(1.0), "A factor of what is reflected");
pub static TINT_TRANSMITTED: Parameter =
    Parameter::new("transmittance", reflectance(1.0), "A factor of what is transmitted");

pub static DISPLACEMENT: Parameter = Parameter::new(
    "displacement",
    ParameterKind::FloatTextured { default: 0.0 },
    "Height over the surface: bends the shading normal (a bump map)",
)
.unit("scene units");
pub static NORMAL_MAP: Parameter = Parameter::file(
    "normalmap",
    "An image of shading normals in the tangent frame, (1 + n) / 2 by colour, linear; counts before displacement; none by default",
);

pub static SIGMA_A: Parameter = Parameter::new(
    "sigma_a",
    ParameterKind::Absorption,
    "Absorption over the radius of a fibre; counts before `color` and pigments",
);
pub static HAIR_REFLECTANCE: Parameter = Parameter::new(
    "reflectance",
    ParameterKind::Reflectance { default: None },
    "The colour of many fibres, instead of what one absorbs; counts before pigments",
);
pub static HAIR_COLOR: Parameter = Parameter::new(
    "color",
    ParameterKind::Reflectance { default: None },
    "An older name of `reflectance`",
);
pub static EUMELANIN: Parameter = Parameter::new(
    "eumelanin",
    ParameterKind::Pigment,
    "How much there is of the brown pigment; 1.3 if nothing is said of color",
);
pub static PHEOMELANIN: Parameter = Parameter::new(
    "pheomelanin",
    ParameterKind::Pigment,
    "How much there is of the red pigment",
);
pub static HAIR_ETA: Parameter = Parameter::float("eta", 1.55, FloatRange::AtLeastOne, "Index of refraction");
pub static BETA_M: Parameter = Parameter::new("beta_m", unit(0.3), "Roughness along the fibre");
pub static BETA_N: Parameter = Parameter::new("beta_n", unit(0.3), "Roughness around the fibre");
pub static HAIR_ALPHA: Parameter = Parameter::new(
    "alpha",
    ParameterKind::FloatTextured { default: 2.0 },
    "Slant of the scales of the fibre",
)
.unit("degrees");

pub static MEASURED_FILE: Parameter = Parameter::file("filename", "A .bsdf file");
