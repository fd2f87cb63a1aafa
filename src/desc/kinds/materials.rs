//! Every kind of material and its parameters, for the reader and for `lucerna list materials`.

use super::Entry;
use super::parameter::{FloatRange, Parameter, ParameterDefault, ParameterKind};

/// All kinds.
pub static MATERIALS: [Entry; 12] = [
    Entry::new(
        "Material",
        "diffuse",
        "Diffuse reflection on both sides",
        &[&REFLECTANCE, &DIFFUSE_ROUGHNESS, &DISPLACEMENT, &NORMAL_MAP],
    ),
    Entry::new(
        "Material",
        "diffusetransmission",
        "Lambertian reflection and transmission",
        &[
            &REFLECTED,
            &TRANSMITTED,
            &TRANSMISSION_SCALE,
            &DISPLACEMENT,
            &NORMAL_MAP,
        ],
    ),
    Entry::new(
        "Material",
        "conductor",
        "A metal, on both sides; either by eta and k or by its reflectance",
        &[
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
    ),
    Entry::new(
        "Material",
        "dielectric",
        "The boundary of a transparent body",
        &[
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
    ),
    Entry::new(
        "Material",
        "thindielectric",
        "A thin smooth sheet of a transparent medium, which light passes straight on",
        &[&ETA, &DISPLACEMENT, &NORMAL_MAP],
    ),
    Entry::new(
        "Material",
        "coateddiffuse",
        "A Lambertian surface under a dielectric coat, on both sides",
        &[
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
    ),
    Entry::new(
        "Material",
        "coatedconductor",
        "A metal under a dielectric coat, on both sides",
        &[
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
    ),
    Entry::new(
        "Material",
        "mix",
        "At each point one of two named materials, chosen by a hash of the position",
        &[&MIX_MATERIALS, &MIX_AMOUNT],
    ),
    Entry::new(
        "Material",
        "principled",
        "Metal, plastic, glass, cloth and lacquer by the parameters of Mitsuba's principled (an extension)",
        &[
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
    ),
    Entry::new(
        "Material",
        "measured",
        "Reflection as measured, on both sides, from a file of RGL's database",
        &[&MEASURED_FILE, &DISPLACEMENT, &NORMAL_MAP],
    ),
    Entry::new(
        "Material",
        "hair",
        "A fibre along the first texture coordinate, across which the second one runs: for curves",
        &[
            &SIGMA_A,
            &HAIR_REFLECTANCE,
            &HAIR_COLOR,
            &EUMELANIN,
            &PHEOMELANIN,
            &HAIR_ETA,
            &BETA_M,
            &BETA_N,
            &HAIR_ALPHA,
        ],
    ),
    Entry::new("Material", "interface", "No surface", &[]),
];

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
