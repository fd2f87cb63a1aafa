//! `Texture`.

use glam::{DAffine3, DVec3, Mat2, Vec2};

use super::reader::{ParamReader, unknown_type};
use super::texture_names::stand_in;
use crate::desc::kinds::textures as kinds;
use crate::desc::{
    ClassedTexture, Entry, ImageFilterDesc, ImageMapDesc, MappingDesc, OctavesDesc, Parameter, SpectrumDesc, TEXTURES,
    TextureClass, TextureDesc, TextureKind, Textured, WrapDesc,
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
    let entry = entry(&mut reader, class, kind);
    let kind = entry.and_then(|entry| match class {
        TextureClass::Float => read_kind(&mut reader, entry).map(ClassedTexture::Float),
        TextureClass::Spectrum => read_kind(&mut reader, entry).map(ClassedTexture::Spectrum),
    });
    let known = entry.filter(|_| kind.is_some());
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
    if let Some(entry) = known {
        reader.finish_by(entry);
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

/// The kind of texture of this name; `None`, having said so, if there is none in this class.
fn entry(reader: &mut ParamReader<'_>, class: TextureClass, kind: &str) -> Option<&'static Entry> {
    let of_class = || TEXTURES.iter().filter(|entry| entry.classes.contains(&class));
    let entry = of_class().find(|entry| entry.name == kind);
    if entry.is_none() {
        let span = reader.span;
        let known: Vec<&str> = of_class().map(|entry| entry.name).collect();
        let what = format!("{} texture", class.name());
        unknown_type(
            reader.report(),
            &what,
            kind,
            span,
            (&known, &["ptex"]),
            "a constant stands in",
        );
    }
    entry
}

/// Reads a kind of texture; `None`, having said so, if something essential is missing.
fn read_kind<V: Value>(reader: &mut ParamReader<'_>, entry: &Entry) -> Option<TextureKind<V>> {
    Some(match entry.name {
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
        "checkerboard" => checkerboard(reader),
        "dots" => TextureKind::Dots {
            inside: V::textured(reader, &kinds::INSIDE),
            outside: V::textured(reader, &kinds::OUTSIDE),
            mapping: mapping(reader),
        },
        "bilerp" => TextureKind::Bilerp {
            corners: [&kinds::V00, &kinds::V01, &kinds::V10, &kinds::V11].map(|corner| V::value(reader, corner)),
            mapping: mapping(reader),
        },
        "imagemap" => TextureKind::Image(image_map(reader)?),
        "fbm" => TextureKind::Fbm(octaves(reader)),
        "wrinkled" => TextureKind::Wrinkled(octaves(reader)),
        "windy" => TextureKind::Windy,
        "meshattribute" => mesh_attribute(reader)?,
        "marble" => TextureKind::Marble {
            octaves: octaves(reader),
            scale: reader.float_by(&kinds::SCALE) as f32,
            variation: reader.float_by(&kinds::VARIATION) as f32,
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

fn checkerboard<V: Value>(reader: &mut ParamReader<'_>) -> TextureKind<V> {
    let textures = [V::textured(reader, &kinds::TEX1), V::textured(reader, &kinds::TEX2)];
    let is_solid = reader.integer_by(&kinds::DIMENSION) == 3;
    let mapping = mapping(reader);
    if is_solid {
        TextureKind::Checkerboard3 { textures }
    } else {
        TextureKind::Checkerboard2 { textures, mapping }
    }
}

fn mapping(reader: &mut ParamReader<'_>) -> MappingDesc {
    let pair = |reader: &mut ParamReader<'_>, u, v| Vec2::new(reader.float_by(u) as f32, reader.float_by(v) as f32);
    let kind = reader.choice_by(&kinds::MAPPING);
    let scale = pair(reader, &kinds::USCALE, &kinds::VSCALE);
    let delta = pair(reader, &kinds::UDELTA, &kinds::VDELTA);
    let vectors = [&kinds::V1, &kinds::V2].map(|vector| reader.vector_by(vector).as_vec3());
    match kind {
        "spherical" => MappingDesc::Spherical,
        "cylindrical" => MappingDesc::Cylindrical,
        "planar" => MappingDesc::Planar { vectors, delta },
        "affine" => MappingDesc::Affine {
            matrix: Mat2::from_cols(vectors[0].truncate(), vectors[1].truncate()).transpose(),
            delta,
        },
        _ => MappingDesc::Uv { scale, delta },
    }
}

fn octaves(reader: &mut ParamReader<'_>) -> OctavesDesc {
    OctavesDesc {
        octaves: reader.integer_by(&kinds::OCTAVES).unsigned_abs(),
        roughness: reader.float_by(&kinds::ROUGHNESS) as f32,
    }
}

/// `None`, having said so, without a file.
fn image_map(reader: &mut ParamReader<'_>) -> Option<ImageMapDesc> {
    let max_anisotropy = reader.float_by(&kinds::MAXANISOTROPY) as f32;
    let filter = match reader.choice_by(&kinds::FILTER) {
        "point" => ImageFilterDesc::Point,
        "trilinear" => ImageFilterDesc::Trilinear,
        "EWA" => ImageFilterDesc::Ewa { max_anisotropy },
        _ => ImageFilterDesc::Bilinear,
    };
    let wrap = match reader.choice_by(&kinds::WRAP) {
        "black" => WrapDesc::Black,
        "clamp" => WrapDesc::Clamp,
        "octahedralsphere" => WrapDesc::OctahedralSphere,
        "mirror" => WrapDesc::Mirror,
        _ => WrapDesc::Repeat,
    };
    let mapping = mapping(reader);
    let scale = reader.float_by(&kinds::SCALE) as f32;
    let invert = reader.bool_by(&kinds::INVERT);
    let encoding = reader.encoding_by(&kinds::ENCODING);
    Some(ImageMapDesc {
        image: reader.image(kinds::FILENAME.name, encoding)?,
        mapping,
        filter,
        wrap,
        scale,
        invert,
    })
}

/// `None`, having said so, without a name.
fn mesh_attribute<V>(reader: &mut ParamReader<'_>) -> Option<TextureKind<V>> {
    let scale = reader.float_by(&kinds::SCALE) as f32;
    let Some((name, _)) = reader.string(kinds::NAME.name) else {
        if !reader.has(kinds::NAME.name) {
            let span = reader.span;
            let message = "this `meshattribute` has no `\"string name\"`";
            reader.report().error(span, message);
        }
        return None;
    };
    Some(TextureKind::MeshAttribute { name, scale })
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
