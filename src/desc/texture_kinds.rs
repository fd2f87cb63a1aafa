//! Every kind of texture and its parameters, for the reader and for `lucerna list textures`.

use super::parameter::{FloatRange, Parameter, ParameterKind};
use super::texture::TextureClass;

/// A kind of texture.
#[derive(Clone, Copy, Debug)]
pub struct TextureEntry {
    /// As in a scene file.
    pub name: &'static str,
    /// Of which classes there are textures of this kind.
    pub classes: &'static [TextureClass],
    /// What it is, in a sentence without a full stop.
    pub doc: &'static str,
    /// Its parameters.
    pub parameters: &'static [&'static Parameter],
}

const BOTH: &[TextureClass] = &[TextureClass::Float, TextureClass::Spectrum];

const FLOAT: &[TextureClass] = &[TextureClass::Float];
const SPECTRUM: &[TextureClass] = &[TextureClass::Spectrum];

const fn entry(
    name: &'static str,
    classes: &'static [TextureClass],
    parameters: &'static [&'static Parameter],
    doc: &'static str,
) -> TextureEntry {
    TextureEntry {
        name,
        classes,
        doc,
        parameters,
    }
}

/// All kinds.
pub static TEXTURES: [TextureEntry; 12] = [
    entry("constant", BOTH, &[&VALUE], "The same value everywhere"),
    entry("scale", BOTH, &[&TEX, &SCALE_BY], "A texture times a number"),
    entry(
        "mix",
        BOTH,
        &[&MIX_TEX1, &MIX_TEX2, &AMOUNT],
        "(1 - amount) tex1 + amount tex2",
    ),
    entry(
        "directionmix",
        BOTH,
        &[&MIX_TEX1, &MIX_TEX2, &DIR],
        "c tex1 + (1 - c) tex2, c = |cos| of the geometric normal to dir",
    ),
    entry(
        "bilerp",
        BOTH,
        &[
            &V00, &V01, &V10, &V11, &MAPPING, &USCALE, &VSCALE, &UDELTA, &VDELTA, &V1, &V2,
        ],
        "Bilinear between the values at the corners of the unit square",
    ),
    entry(
        "imagemap",
        BOTH,
        &[
            &FILENAME,
            &FILTER,
            &MAXANISOTROPY,
            &WRAP,
            &SCALE,
            &INVERT,
            &ENCODING,
            &MAPPING,
            &USCALE,
            &VSCALE,
            &UDELTA,
            &VDELTA,
            &V1,
            &V2,
        ],
        "An image with (0, 0) at its lower left; a float texture has its first channel",
    ),
    entry(
        "checkerboard",
        BOTH,
        &[
            &DIMENSION, &TEX1, &TEX2, &MAPPING, &USCALE, &VSCALE, &UDELTA, &VDELTA, &V1, &V2,
        ],
        "Two textures in turn over unit squares or cubes",
    ),
    entry(
        "dots",
        BOTH,
        &[
            &INSIDE, &OUTSIDE, &MAPPING, &USCALE, &VSCALE, &UDELTA, &VDELTA, &V1, &V2,
        ],
        "Round dots in about half of the unit squares",
    ),
    entry(
        "fbm",
        FLOAT,
        &[&OCTAVES, &ROUGHNESS],
        "Noise in texture space: octaves added up, in about [-1, 1]",
    ),
    entry(
        "wrinkled",
        FLOAT,
        &[&OCTAVES, &ROUGHNESS],
        "The magnitude of noise in texture space: octaves added up",
    ),
    entry("windy", FLOAT, &[], "Waves on water, in texture space"),
    entry(
        "marble",
        SPECTRUM,
        &[&OCTAVES, &ROUGHNESS, &SCALE, &VARIATION],
        "Layers of stone along y of texture space",
    ),
];

const fn textured(name: &'static str, default: f64, doc: &'static str) -> Parameter {
    Parameter {
        name,
        kind: ParameterKind::Textured { default },
        doc,
    }
}

pub(super) static VALUE: Parameter = Parameter {
    name: "value",
    kind: ParameterKind::Value { default: 1.0 },
    doc: "The value",
};
pub(super) static TEX: Parameter = textured("tex", 1.0, "What is multiplied");
pub(super) static SCALE_BY: Parameter = Parameter {
    name: "scale",
    kind: ParameterKind::FloatTextured { default: 1.0 },
    doc: "What it is multiplied by",
};
pub(super) static MIX_TEX1: Parameter = textured("tex1", 0.0, "The first");
pub(super) static MIX_TEX2: Parameter = textured("tex2", 1.0, "The second");
pub(super) static AMOUNT: Parameter = Parameter {
    name: "amount",
    kind: ParameterKind::FloatTextured { default: 0.5 },
    doc: "How much there is of the second",
};
pub(super) static DIR: Parameter = Parameter {
    name: "dir",
    kind: ParameterKind::Vector([0.0, 1.0, 0.0]),
    doc: "In texture space; not zero",
};

const fn value(name: &'static str, default: f64, doc: &'static str) -> Parameter {
    Parameter {
        name,
        kind: ParameterKind::Value { default },
        doc,
    }
}

const fn number(name: &'static str, default: f64, doc: &'static str) -> Parameter {
    Parameter {
        name,
        kind: ParameterKind::Float {
            default,
            range: FloatRange::Any,
        },
        doc,
    }
}

pub(super) static V00: Parameter = value("v00", 0.0, "The value at (0, 0)");
pub(super) static V01: Parameter = value("v01", 1.0, "The value at (0, 1)");
pub(super) static V10: Parameter = value("v10", 0.0, "The value at (1, 0)");
pub(super) static V11: Parameter = value("v11", 1.0, "The value at (1, 1)");
pub(super) static TEX1: Parameter = textured("tex1", 1.0, "The first, around (1/2, 1/2)");
pub(super) static TEX2: Parameter = textured("tex2", 0.0, "The second");
pub(super) static INSIDE: Parameter = textured("inside", 1.0, "In the dots");
pub(super) static OUTSIDE: Parameter = textured("outside", 0.0, "Around the dots");
pub(super) static DIMENSION: Parameter = Parameter {
    name: "dimension",
    kind: ParameterKind::Integer {
        default: 2,
        range: (2, 3),
    },
    doc: "2: squares of the mapping; 3: cubes of texture space",
};
pub(super) static MAPPING: Parameter = Parameter {
    name: "mapping",
    kind: ParameterKind::Choice {
        default: "uv",
        choices: &["uv", "spherical", "cylindrical", "planar"],
    },
    doc: "Where texture coordinates come from: the surface, or the position in texture space",
};
pub(super) static USCALE: Parameter = number("uscale", 1.0, "uv: factor of u");
pub(super) static VSCALE: Parameter = number("vscale", 1.0, "uv: factor of v");
pub(super) static UDELTA: Parameter = number("udelta", 0.0, "uv and planar: added to the first coordinate");
pub(super) static VDELTA: Parameter = number("vdelta", 0.0, "uv and planar: added to the second coordinate");
pub(super) static V1: Parameter = Parameter {
    name: "v1",
    kind: ParameterKind::Vector([1.0, 0.0, 0.0]),
    doc: "planar: the first coordinate is the dot product with this",
};
pub(super) static V2: Parameter = Parameter {
    name: "v2",
    kind: ParameterKind::Vector([0.0, 1.0, 0.0]),
    doc: "planar: the second coordinate is the dot product with this",
};
pub(super) static FILENAME: Parameter = Parameter {
    name: "filename",
    kind: ParameterKind::File,
    doc: "A PNG, JPEG, TGA, HDR, EXR or PFM file",
};
pub(super) static FILTER: Parameter = Parameter {
    name: "filter",
    kind: ParameterKind::Choice {
        default: "bilinear",
        choices: &["point", "bilinear", "trilinear", "EWA"],
    },
    doc: "How texels are combined: of the mip level that the footprint asks for, the nearest, four, four of each of two levels, or all within an ellipse",
};
pub(super) static MAXANISOTROPY: Parameter = Parameter {
    name: "maxanisotropy",
    kind: ParameterKind::Float {
        default: 8.0,
        range: FloatRange::AtLeastOne,
    },
    doc: "EWA: the greatest ratio of the ellipse's axes",
};
pub(super) static WRAP: Parameter = Parameter {
    name: "wrap",
    kind: ParameterKind::Choice {
        default: "repeat",
        choices: &["repeat", "black", "clamp", "octahedralsphere"],
    },
    doc: "What is beyond the image's edges",
};
pub(super) static SCALE: Parameter = number("scale", 1.0, "A factor: of an image's values, of marble's coordinates");
pub(super) static INVERT: Parameter = Parameter {
    name: "invert",
    kind: ParameterKind::Bool(false),
    doc: "Whether 1 - value is meant, after scaling",
};
pub(super) static ENCODING: Parameter = Parameter {
    name: "encoding",
    kind: ParameterKind::Text { default: "sRGB" },
    doc: "Of 8-bit and 16-bit samples: sRGB, linear, or gamma followed by a positive exponent, as in \"gamma 2.2\"",
};
pub(super) static OCTAVES: Parameter = Parameter {
    name: "octaves",
    kind: ParameterKind::Integer {
        default: 8,
        range: (0, 64),
    },
    doc: "The most octaves of noise; those finer than the footprint are left out",
};
pub(super) static ROUGHNESS: Parameter = number("roughness", 0.5, "Factor from each octave to the next");
pub(super) static VARIATION: Parameter = number("variation", 0.2, "How far noise bends the layers");
