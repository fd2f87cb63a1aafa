//! Every kind of texture and its parameters, for the reader and for `lucerna list textures`.

use super::Entry;
use super::parameter::{FloatRange, Parameter, ParameterKind};
use crate::desc::TextureClass;
use crate::image_io::Encoding;

const BOTH: &[TextureClass] = &[TextureClass::Float, TextureClass::Spectrum];

const FLOAT: &[TextureClass] = &[TextureClass::Float];
const SPECTRUM: &[TextureClass] = &[TextureClass::Spectrum];

/// All kinds.
pub static TEXTURES: [Entry; 13] = [
    Entry::new("Texture", "constant", "The same value everywhere", &[&VALUE]).of_classes(BOTH),
    Entry::new("Texture", "scale", "A texture times a number", &[&TEX, &SCALE_BY]).of_classes(BOTH),
    Entry::new(
        "Texture",
        "mix",
        "(1 - amount) tex1 + amount tex2",
        &[&MIX_TEX1, &MIX_TEX2, &AMOUNT],
    )
    .of_classes(BOTH),
    Entry::new(
        "Texture",
        "directionmix",
        "c tex1 + (1 - c) tex2, c = |cos| of the geometric normal to dir",
        &[&MIX_TEX1, &MIX_TEX2, &DIR],
    )
    .of_classes(BOTH),
    Entry::new(
        "Texture",
        "bilerp",
        "Bilinear between the values at the corners of the unit square",
        &[
            &V00, &V01, &V10, &V11, &MAPPING, &USCALE, &VSCALE, &UDELTA, &VDELTA, &V1, &V2,
        ],
    )
    .of_classes(BOTH),
    Entry::new(
        "Texture",
        "imagemap",
        "An image with (0, 0) at its lower left; a float texture has its first channel",
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
    )
    .of_classes(BOTH),
    Entry::new(
        "Texture",
        "checkerboard",
        "Two textures in turn over unit squares or cubes",
        &[
            &DIMENSION, &TEX1, &TEX2, &MAPPING, &USCALE, &VSCALE, &UDELTA, &VDELTA, &V1, &V2,
        ],
    )
    .of_classes(BOTH),
    Entry::new(
        "Texture",
        "dots",
        "Round dots in about half of the unit squares",
        &[
            &INSIDE, &OUTSIDE, &MAPPING, &USCALE, &VSCALE, &UDELTA, &VDELTA, &V1, &V2,
        ],
    )
    .of_classes(BOTH),
    Entry::new(
        "Texture",
        "meshattribute",
        "What the mesh that it lies on has at its vertices or triangles under a name; 0 on shapes that have none (an extension)",
        &[&NAME, &SCALE],
    )
    .of_classes(BOTH),
    Entry::new(
        "Texture",
        "fbm",
        "Noise in texture space: octaves added up, in about [-1, 1]",
        &[&OCTAVES, &ROUGHNESS],
    )
    .of_classes(FLOAT),
    Entry::new(
        "Texture",
        "wrinkled",
        "The magnitude of noise in texture space: octaves added up",
        &[&OCTAVES, &ROUGHNESS],
    )
    .of_classes(FLOAT),
    Entry::new("Texture", "windy", "Waves on water, in texture space", &[]).of_classes(FLOAT),
    Entry::new(
        "Texture",
        "marble",
        "Layers of stone along y of texture space",
        &[&OCTAVES, &ROUGHNESS, &SCALE, &VARIATION],
    )
    .of_classes(SPECTRUM),
];

pub static VALUE: Parameter = Parameter::new("value", ParameterKind::Value { default: 1.0 }, "The value");
pub static TEX: Parameter = Parameter::textured("tex", 1.0, "What is multiplied");
pub static SCALE_BY: Parameter = Parameter::new(
    "scale",
    ParameterKind::FloatTextured { default: 1.0 },
    "What it is multiplied by",
);
pub static MIX_TEX1: Parameter = Parameter::textured("tex1", 0.0, "The first");
pub static MIX_TEX2: Parameter = Parameter::textured("tex2", 1.0, "The second");
pub static AMOUNT: Parameter = Parameter::new(
    "amount",
    ParameterKind::FloatTextured { default: 0.5 },
    "How much there is of the second",
);
pub static DIR: Parameter = Parameter::new(
    "dir",
    ParameterKind::Vector([0.0, 1.0, 0.0]),
    "In texture space; not zero",
);

pub static V00: Parameter = Parameter::value("v00", 0.0, "The value at (0, 0)");
pub static V01: Parameter = Parameter::value("v01", 1.0, "The value at (0, 1)");
pub static V10: Parameter = Parameter::value("v10", 0.0, "The value at (1, 0)");
pub static V11: Parameter = Parameter::value("v11", 1.0, "The value at (1, 1)");
pub static TEX1: Parameter = Parameter::textured("tex1", 1.0, "The first, around (1/2, 1/2)");
pub static TEX2: Parameter = Parameter::textured("tex2", 0.0, "The second");
pub static INSIDE: Parameter = Parameter::textured("inside", 1.0, "In the dots");
pub static OUTSIDE: Parameter = Parameter::textured("outside", 0.0, "Around the dots");
pub static DIMENSION: Parameter = Parameter::integer(
    "dimension",
    2,
    (2, 3),
    "2: squares of the mapping; 3: cubes of texture space",
);
pub static MAPPING: Parameter = Parameter::choice(
    "mapping",
    &["uv", "spherical", "cylindrical", "planar", "affine"],
    "Where texture coordinates come from: the surface, the position in texture space, or by a matrix from the surface (affine, an extension)",
);
pub static USCALE: Parameter = Parameter::float("uscale", 1.0, FloatRange::Any, "uv: factor of u");
pub static VSCALE: Parameter = Parameter::float("vscale", 1.0, FloatRange::Any, "uv: factor of v");
pub static UDELTA: Parameter = Parameter::float(
    "udelta",
    0.0,
    FloatRange::Any,
    "uv, planar and affine: added to the first coordinate",
);
pub static VDELTA: Parameter = Parameter::float(
    "vdelta",
    0.0,
    FloatRange::Any,
    "uv, planar and affine: added to the second coordinate",
);
pub static V1: Parameter = Parameter::new(
    "v1",
    ParameterKind::Vector([1.0, 0.0, 0.0]),
    "planar: the first coordinate is the dot product with this; affine: its with (u, v, 0)",
);
pub static V2: Parameter = Parameter::new(
    "v2",
    ParameterKind::Vector([0.0, 1.0, 0.0]),
    "planar: the second coordinate is the dot product with this; affine: its with (u, v, 0)",
);
pub static FILENAME: Parameter = Parameter::file("filename", "A PNG, JPEG, TGA, HDR, EXR or PFM file");
pub static NAME: Parameter = Parameter::new(
    "name",
    ParameterKind::Attribute,
    "Of the attribute: it begins with vertex_ or face_; required",
);
pub static FILTER: Parameter = Parameter::new(
    "filter",
    ParameterKind::Choice {
        default: "bilinear",
        choices: &["point", "bilinear", "trilinear", "EWA"],
    },
    "How texels are combined: of the mip level that the footprint asks for, the nearest, four, four of each of two levels, or all within an ellipse",
);
pub static MAXANISOTROPY: Parameter = Parameter::float(
    "maxanisotropy",
    8.0,
    FloatRange::AtLeastOne,
    "EWA: the greatest ratio of the ellipse's axes",
);
pub static WRAP: Parameter = Parameter::choice(
    "wrap",
    &["repeat", "black", "clamp", "octahedralsphere", "mirror"],
    "What is beyond the image's edges (mirror, the image and its mirror image in turn, is an extension)",
);
pub static SCALE: Parameter = Parameter::float(
    "scale",
    1.0,
    FloatRange::Any,
    "A factor: of an image's or an attribute's values, of marble's coordinates",
);
pub static INVERT: Parameter = Parameter::flag("invert", false, "Whether 1 - value is meant, after scaling");
pub static ENCODING: Parameter = Parameter::new(
    "encoding",
    ParameterKind::Encoding {
        default: Encoding::Srgb,
    },
    "The curve of 8-bit and 16-bit samples",
);
pub static OCTAVES: Parameter = Parameter::integer(
    "octaves",
    8,
    (0, 64),
    "The most octaves of noise; those finer than the footprint are left out",
);
pub static ROUGHNESS: Parameter =
    Parameter::float("roughness", 0.5, FloatRange::Any, "Factor from each octave to the next");
pub static VARIATION: Parameter = Parameter::float("variation", 0.2, FloatRange::Any, "How far noise bends the layers");
