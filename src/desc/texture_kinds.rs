//! Every kind of texture and its parameters, for the reader and for `lucerna list textures`.

use super::parameter::{Parameter, ParameterKind};
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

/// All kinds.
pub static TEXTURES: [TextureEntry; 4] = [
    TextureEntry {
        name: "constant",
        classes: BOTH,
        doc: "The same value everywhere",
        parameters: &[&VALUE],
    },
    TextureEntry {
        name: "scale",
        classes: BOTH,
        doc: "A texture times a number",
        parameters: &[&TEX, &SCALE_BY],
    },
    TextureEntry {
        name: "mix",
        classes: BOTH,
        doc: "(1 - amount) tex1 + amount tex2",
        parameters: &[&MIX_TEX1, &MIX_TEX2, &AMOUNT],
    },
    TextureEntry {
        name: "directionmix",
        classes: BOTH,
        doc: "c tex1 + (1 - c) tex2, c = |cos| of the geometric normal to dir",
        parameters: &[&MIX_TEX1, &MIX_TEX2, &DIR],
    },
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
