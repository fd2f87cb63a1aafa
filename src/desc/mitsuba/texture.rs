//! Textures: bitmaps and checkerboards; constants are spectra.

use glam::{DAffine3, DMat3, DVec3, Mat2, Vec2};

use super::graph::{Object, ObjectIndex, Property, Value};
use super::loader::{Loader, constant};
use super::plugins::Class;
use super::props::Props;
use super::spectrum::Use;
use crate::desc::{
    ClassedTexture, ImageFilterDesc, ImageId, ImageMapDesc, MappingDesc, SpectrumDesc, SpectrumValue, TextureDesc,
    TextureId, TextureKind, Textured, WrapDesc,
};
use crate::error::Span;
use crate::image_io::Encoding;

impl<'g> Loader<'g> {
    /// A spectrum or a texture of spectra; `default` without the property, and where it is wrong.
    pub fn color(
        &mut self,
        property: Option<&'g Property>,
        default: f32,
        span: Span,
        usage: Use,
    ) -> Textured<SpectrumDesc> {
        let Some(property) = property else {
            return constant(default, span);
        };
        if let Some((index, object)) = self.texture_of(property) {
            return match self.texture(index, object, true) {
                Some(id) => Textured::Texture(id),
                None => constant(default, span),
            };
        }
        let spectrum = self.spectrum(property, usage);
        spectrum.map_or_else(|| constant(default, span), Textured::Value)
    }

    /// A number or a texture of numbers, in [0, 1] if it is one.
    pub fn number(&mut self, property: Option<&'g Property>, default: f32) -> Textured<f32> {
        let Some(property) = property else {
            return Textured::Value(default);
        };
        if let Some((index, object)) = self.texture_of(property) {
            return match self.texture(index, object, false) {
                Some(id) => Textured::Texture(id),
                None => Textured::Value(default),
            };
        }
        let Some(spectrum) = self.spectrum(property, Use::Unbounded) else {
            return Textured::Value(default);
        };
        if let SpectrumValue::Constant(value) = spectrum.value {
            return Textured::Value(value);
        }
        let message = format!("`{}` is a color; expected a number or a texture", property.name);
        self.report().error(property.span, message);
        Textured::Value(default)
    }

    /// [`Loader::number`], where a number is in [0, 1].
    pub fn fraction(&mut self, property: Option<&'g Property>, default: f32) -> Textured<f32> {
        let number = self.number(property, default);
        if let (Textured::Value(value), Some(property)) = (&number, property)
            && !(0.0..=1.0).contains(value)
        {
            let message = format!("`{}` is {value}; expected a number in [0, 1]", property.name);
            self.report().error(property.span, message);
            return Textured::Value(default);
        }
        number
    }

    /// The texture that a property is, if it is one that varies.
    pub fn texture_of(&self, property: &Property) -> Option<(ObjectIndex, &'g Object)> {
        self.object_of(property, Class::Texture).filter(|(_, object)| {
            !matches!(
                object.plugin.as_str(),
                "rgb" | "srgb" | "srgb_d65" | "uniform" | "regular" | "irregular" | "blackbody" | "d65"
            )
        })
    }

    /// A texture of spectra or of numbers, each translated once.
    pub fn texture(&mut self, index: ObjectIndex, object: &'g Object, of_spectra: bool) -> Option<TextureId> {
        if let Some(&id) = self.texture_ids.get(&(index, of_spectra)) {
            return Some(id);
        }
        let kind = match object.plugin.as_str() {
            "bitmap" => {
                let image = self.bitmap(object)?;
                if of_spectra {
                    ClassedTexture::Spectrum(TextureKind::Image(image))
                } else {
                    ClassedTexture::Float(TextureKind::Image(image))
                }
            }
            "checkerboard" => self.checkerboard(object, of_spectra),
            "mesh_attribute" => {
                let (name, scale) = self.mesh_attribute(object)?;
                if of_spectra {
                    ClassedTexture::Spectrum(TextureKind::MeshAttribute { name, scale })
                } else {
                    ClassedTexture::Float(TextureKind::MeshAttribute { name, scale })
                }
            }
            _ => {
                self.refuse(object, "a grey of 0.5 stands in");
                return None;
            }
        };
        self.textures.push(TextureDesc {
            name: format!("texture{}", self.textures.len() + 1),
            kind,
            world_from_texture: DAffine3::IDENTITY,
            span: object.span,
        });
        let id = TextureId(self.textures.len() as u32 - 1);
        self.texture_ids.insert((index, of_spectra), id);
        Some(id)
    }

    fn checkerboard(&mut self, object: &'g Object, of_spectra: bool) -> ClassedTexture {
        let mut props = Props::new(object);
        let colors = ["color0", "color1"].map(|name| props.take(name));
        // Two squares a unit.
        let to_squares = DAffine3::from_scale(DVec3::new(2.0, 2.0, 1.0)) * to_uv(&mut props);
        let mapping = mapping(&(to_squares * FLIP_V));
        props.finish(self.report());
        let defaults = [0.4, 0.2];
        if of_spectra {
            let textures = [0, 1].map(|i| self.color(colors[i], defaults[i], object.span, Use::Unbounded));
            ClassedTexture::Spectrum(TextureKind::Checkerboard2 { textures, mapping })
        } else {
            // As in Mitsuba, numbers are the other way round than colors.
            let textures = [1, 0].map(|i| self.number(colors[i], defaults[i]));
            ClassedTexture::Float(TextureKind::Checkerboard2 { textures, mapping })
        }
    }

    /// A `bitmap` as an image on a surface.
    pub fn bitmap(&mut self, object: &'g Object) -> Option<ImageMapDesc> {
        let mut props = Props::new(object);
        let file = self.bitmap_file(&mut props);
        let filter = match props.choice("filter_type", &["bilinear", "nearest"]) {
            "nearest" => ImageFilterDesc::Point,
            _ => ImageFilterDesc::Bilinear,
        };
        let wrap = match props.choice("wrap_mode", &["repeat", "mirror", "clamp"]) {
            "mirror" => WrapDesc::Mirror,
            "clamp" => WrapDesc::Clamp,
            _ => WrapDesc::Repeat,
        };
        let uv = to_uv(&mut props);
        props.ignore(&["accel", "format"]);
        props.finish(self.report());
        Some(ImageMapDesc {
            image: file?,
            mapping: mapping(&(FLIP_V * uv * FLIP_V)),
            filter,
            wrap,
            scale: 1.0,
            invert: false,
        })
    }

    /// The file of a `bitmap`.
    pub fn bitmap_file(&mut self, props: &mut Props<'g>) -> Option<ImageId> {
        let raw = props.boolean("raw", false);
        let Some(name) = props.string("filename") else {
            if !props.has("filename") {
                props.error(
                    props.object.span,
                    "this `bitmap` has no `<string name=\"filename\" .../>`",
                );
            }
            return None;
        };
        let encoding = if raw { Encoding::Linear } else { Encoding::Srgb };
        let path = self.xml.resolve(name);
        Some(self.images.add(path, encoding, props.span_of("filename")))
    }

    /// Whether a property is a number or a spectrum without any colour of its own, so that it can be left out if it is this one.
    pub fn is_number(property: &Property, number: f64) -> bool {
        match property.value {
            Value::Float(value) => value == number,
            Value::Integer(value) => value as f64 == number,
            _ => false,
        }
    }
}

/// From this program's texture coordinates to Mitsuba's and back: v is the other way round.
const FLIP_V: DAffine3 = DAffine3 {
    matrix3: DMat3::from_diagonal(DVec3::new(1.0, -1.0, 1.0)),
    translation: DVec3::new(0.0, 1.0, 0.0),
};

/// `to_uv`: of its matrix, the first two rows and columns and what it moves by.
fn to_uv(props: &mut Props<'_>) -> DAffine3 {
    let matrix = props.matrix("to_uv");
    let [x, y, by] = [0, 1, 3].map(|i| matrix.col(i).truncate());
    DAffine3 {
        matrix3: DMat3::from_cols(DVec3::new(x.x, x.y, 0.0), DVec3::new(y.x, y.y, 0.0), DVec3::Z),
        translation: DVec3::new(by.x, by.y, 0.0),
    }
}

fn mapping(uv: &DAffine3) -> MappingDesc {
    let m = uv.matrix3.as_mat3();
    let delta = uv.translation.as_vec3().truncate();
    if m.x_axis.y == 0.0 && m.y_axis.x == 0.0 {
        let scale = Vec2::new(m.x_axis.x, m.y_axis.y);
        return MappingDesc::Uv { scale, delta };
    }
    MappingDesc::Affine {
        matrix: Mat2::from_cols(m.x_axis.truncate(), m.y_axis.truncate()),
        delta,
    }
}

/// Whether an image lies on the surface's coordinates as they are, again and again.
pub(super) fn is_plain(image: &ImageMapDesc) -> bool {
    let plain = MappingDesc::Uv {
        scale: Vec2::ONE,
        delta: Vec2::ZERO,
    };
    image.mapping == plain && image.wrap == WrapDesc::Repeat
}

impl Loader<'_> {
    /// A texture of numbers times a factor.
    pub fn scaled(&mut self, id: TextureId, scale: f32, span: Span) -> TextureId {
        if scale == 1.0 {
            return id;
        }
        let (tex, scale) = (Textured::Texture(id), Textured::Value(scale));
        self.of_numbers(TextureKind::Scale { tex, scale }, span)
    }

    /// Two numbers multiplied.
    pub fn product(&mut self, a: Textured<f32>, b: Textured<f32>, span: Span) -> Textured<f32> {
        match (a, b) {
            (Textured::Value(a), Textured::Value(b)) => Textured::Value(a * b),
            (a, Textured::Value(1.0)) => a,
            (Textured::Value(1.0), b) => b,
            (tex, scale) => Textured::Texture(self.of_numbers(TextureKind::Scale { tex, scale }, span)),
        }
    }

    /// What is left of 1.
    pub fn rest(&mut self, number: Textured<f32>, span: Span) -> Textured<f32> {
        match number {
            Textured::Value(value) => Textured::Value(1.0 - value),
            amount @ Textured::Texture(_) => {
                let textures = [1.0, 0.0].map(Textured::Value);
                Textured::Texture(self.of_numbers(TextureKind::Mix { textures, amount }, span))
            }
        }
    }

    fn of_numbers(&mut self, kind: TextureKind<f32>, span: Span) -> TextureId {
        self.textures.push(TextureDesc {
            name: format!("texture{}", self.textures.len() + 1),
            kind: ClassedTexture::Float(kind),
            world_from_texture: DAffine3::IDENTITY,
            span,
        });
        TextureId(self.textures.len() as u32 - 1)
    }
}
