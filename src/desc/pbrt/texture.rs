//! `Texture`.

use glam::{DAffine3, DVec3};

use super::reader::{ParamReader, unknown_type};
use super::texture_names::stand_in;
use crate::desc::texture_kinds as kinds;
use crate::desc::{
    ClassedTexture, Parameter, SpectrumDesc, TEXTURES, TextureClass, TextureDesc, TextureKind, Textured,
};

/// How the parameters of a class of textures are read.
trait Value: Sized {
    fn value(reader: &mut ParamReader<'_>, parameter: &'static Parameter) -> Self;
    fn textured(reader: &mut ParamReader<'_>, parameter: &'static Parameter) -> Textured<Self>;
}

impl Value for f32 {
    fn value(reader: &mut ParamReader<'_>, parameter: &'static Parameter) -> Self {
        reader.value_by(parameter)
    }

    fn textured(reader: &mut ParamReader<'_>, parameter: &'static Parameter) -> Textured<Self> {
        reader.float_textured_by(parameter)
    }
}

impl Value for SpectrumDesc {
    fn value(reader: &mut ParamReader<'_>, parameter: &'static Parameter) -> Self {
        reader.spectrum_value_by(parameter)
    }

    fn textured(reader: &mut ParamReader<'_>, parameter: &'static Parameter) -> Textured<Self> {
        reader.spectrum_textured_by(parameter)
    }
}

/// Reads the texture `name` of a class and defines it. What cannot be read is a constant.
pub(super) fn read(
    mut reader: ParamReader<'_>,
    name: String,
    class: TextureClass,
    kind: &str,
    world_from_texture: DAffine3,
) {
    let span = reader.span;
    let kind = match class {
        TextureClass::Float => read_kind(&mut reader, class, kind).map(ClassedTexture::Float),
        TextureClass::Spectrum => read_kind(&mut reader, class, kind).map(ClassedTexture::Spectrum),
    };
    let is_known = kind.is_some();
    let depth = deepest(&mut reader);
    let texture = TextureDesc {
        name,
        kind: kind
            .filter(|_| depth.is_some())
            .unwrap_or_else(|| stand_in(class, span)),
        world_from_texture,
        span,
    };
    reader.context.textures.define(class, texture, depth.unwrap_or(0));
    if is_known {
        reader.finish();
    }
}

/// How many textures in a row those that this one refers to are; complains about what is not defined yet and about too many:
/// then `None`.
fn deepest(reader: &mut ParamReader<'_>) -> Option<u32> {
    let mut deepest = Some(0);
    for (id, span) in std::mem::take(&mut reader.textures) {
        match reader.context.textures.depth(id) {
            None => {
                let message = "a texture can refer only to textures that are defined before it";
                reader.report().error(span, message);
                deepest = None;
            }
            Some(depth) if depth >= TextureDesc::DEEPEST => {
                let message = format!("more than {} textures refer to one another", TextureDesc::DEEPEST);
                reader.report().error(span, message);
                deepest = None;
            }
            Some(depth) => deepest = deepest.map(|deepest: u32| deepest.max(depth)),
        }
    }
    deepest
}

/// Reads a kind of texture; `None`, having said so, if there is no such kind in this class.
fn read_kind<V: Value>(reader: &mut ParamReader<'_>, class: TextureClass, kind: &str) -> Option<TextureKind<V>> {
    let entry = TEXTURES.iter().find(|entry| entry.name == kind);
    if !entry.is_some_and(|entry| entry.classes.contains(&class)) {
        let span = reader.span;
        let of_class = TEXTURES.iter().filter(|entry| entry.classes.contains(&class));
        let known: Vec<&str> = of_class.map(|entry| entry.name).collect();
        let what = format!("{} texture", class.name());
        unknown_type(
            reader.report(),
            &what,
            kind,
            span,
            (&known, &["ptex"]),
            "a constant stands in",
        );
        return None;
    }
    Some(match kind {
        "scale" => TextureKind::Scale {
            tex: V::textured(reader, &kinds::TEX),
            scale: reader.float_textured_by(&kinds::SCALE_BY),
        },
        "mix" => TextureKind::Mix {
            textures: mix_textures(reader),
            amount: reader.float_textured_by(&kinds::AMOUNT),
        },
        "directionmix" => TextureKind::DirectionMix {
            textures: mix_textures(reader),
            direction: direction(reader),
        },
        _ => TextureKind::Constant(V::value(reader, &kinds::VALUE)),
    })
}

fn mix_textures<V: Value>(reader: &mut ParamReader<'_>) -> [Textured<V>; 2] {
    [
        V::textured(reader, &kinds::MIX_TEX1),
        V::textured(reader, &kinds::MIX_TEX2),
    ]
}

fn direction(reader: &mut ParamReader<'_>) -> DVec3 {
    let direction = reader.vector_by(&kinds::DIR);
    if direction.length_squared() > 0.0 {
        return direction;
    }
    let span = reader.span_of(kinds::DIR.name);
    reader.report().error(span, "`dir` must not be zero");
    DVec3::Y
}
