//! Textures as described to textures as evaluated.

use std::collections::HashMap;
use std::sync::Arc;

use super::attributes::AttributeTables;
use super::spectra::SpectrumCompiler;
use crate::desc::{
    ClassedTexture, DistributionDesc, ImageDesc, ImageFilterDesc, ImageId, ImageMapDesc, MappingDesc, ReliefDesc,
    RoughnessDesc, SceneDesc, SpectrumDesc, SpectrumValue, TextureDesc, TextureId, TextureKind, Textured, WrapDesc,
    color_space_of,
};
use crate::error::Span;
use crate::material::{Distribution, ReliefMap, Roughness};
use crate::math::DAffine3;
use crate::spectrum::{ColorSpace, CompiledSpectrum, RgbKind, RgbSampler};
use crate::texture::{
    AttributeTexture, Bilerp, Blend, BlendWeight, Filter, FloatTexture, ImageTexture, Mapping2, Marble, MipMap,
    NoiseKind, NoiseTexture, SpectrumTexture, TextureSpace, Wrap,
};

/// What the spectra of a texture are, as pbrt-v4 tells them apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum SpectrumUse {
    /// Reflectances, in [0, 1].
    Albedo,
    /// Anything else that light is multiplied by: indices of metals.
    Unbounded,
}

impl SpectrumUse {
    /// How colours become such spectra.
    fn of_rgb(self) -> RgbKind {
        match self {
            Self::Albedo => RgbKind::Albedo,
            Self::Unbounded => RgbKind::Unbounded,
        }
    }
}

/// Makes textures ready for rendering, each once for each use.
pub(super) struct TextureCompiler<'a> {
    textures: &'a [TextureDesc],
    images: &'a [ImageDesc],
    pub spectra: SpectrumCompiler,
    floats: HashMap<TextureId, FloatTexture>,
    of_spectra: HashMap<(TextureId, SpectrumUse), SpectrumTexture>,
    maps: HashMap<(ImageId, Wrap, bool), Arc<MipMap>>,
    attributes: HashMap<String, AttributeTables>,
}

impl<'a> TextureCompiler<'a> {
    /// For the textures of a description, the tables of the attributes that they ask for made already.
    pub fn new(desc: &'a SceneDesc, attributes: HashMap<String, AttributeTables>, spectra: SpectrumCompiler) -> Self {
        Self {
            textures: &desc.textures,
            images: &desc.images,
            spectra,
            floats: HashMap::new(),
            of_spectra: HashMap::new(),
            maps: HashMap::new(),
            attributes,
        }
    }

    /// A number or the texture that gives it.
    pub fn float(&mut self, value: &Textured<f32>) -> FloatTexture {
        match value {
            Textured::Value(value) => FloatTexture::Constant(*value),
            Textured::Texture(id) => self.float_texture(*id),
        }
    }

    /// A spectrum or the texture that gives it.
    pub fn spectrum(&mut self, value: &Textured<SpectrumDesc>, usage: SpectrumUse) -> SpectrumTexture {
        match value {
            Textured::Value(desc) => self.compile(desc, usage).into(),
            Textured::Texture(id) => self.spectrum_texture(*id, usage),
        }
    }

    /// What bends a surface's shading normals; `None` if nothing does.
    pub fn relief(&mut self, desc: &ReliefDesc) -> Option<ReliefMap> {
        match desc {
            ReliefDesc::Displacement(id) => match self.float_texture(*id) {
                FloatTexture::Constant(_) => None,
                texture => Some(ReliefMap::Displacement(texture)),
            },
            ReliefDesc::Normals(id) => self.map(*id, Wrap::Repeat, false).map(ReliefMap::Normals),
        }
    }

    /// The roughness of a microfacet surface.
    pub fn roughness(&mut self, desc: &RoughnessDesc) -> Roughness {
        let distribution = match desc.distribution {
            DistributionDesc::Ggx => Distribution::Ggx,
            DistributionDesc::Beckmann => Distribution::Beckmann,
        };
        Roughness::new(self.float(&desc.u), self.float(&desc.v), desc.remap, distribution)
            .with_separable_masking(desc.separable_masking)
    }

    fn compile(&self, desc: &SpectrumDesc, usage: SpectrumUse) -> CompiledSpectrum {
        match usage {
            SpectrumUse::Albedo => self.spectra.albedo(&at_most_one(desc)),
            SpectrumUse::Unbounded => self.spectra.unbounded(desc),
        }
    }

    // Textures refer to one another at most TextureDesc::DEEPEST deep, so that these recursions end soon.

    fn float_texture(&mut self, id: TextureId) -> FloatTexture {
        if let Some(texture) = self.floats.get(&id) {
            return texture.clone();
        }
        let desc = &self.textures[id.0 as usize];
        let space = &desc.world_from_texture;
        let texture = match &desc.kind {
            ClassedTexture::Float(kind) => match self.weighted(kind, space) {
                Some((weight, textures)) => {
                    let textures = textures.map(|texture| self.float(texture));
                    FloatTexture::Blend(Arc::new(Blend { weight, textures }))
                }
                None => self.float_kind(kind, space),
            },
            // The reader keeps the classes apart.
            ClassedTexture::Spectrum(_) => FloatTexture::Constant(1.0),
        };
        self.floats.insert(id, texture.clone());
        texture
    }

    fn spectrum_texture(&mut self, id: TextureId, usage: SpectrumUse) -> SpectrumTexture {
        if let Some(texture) = self.of_spectra.get(&(id, usage)) {
            return texture.clone();
        }
        let desc = &self.textures[id.0 as usize];
        let space = &desc.world_from_texture;
        let texture = match &desc.kind {
            ClassedTexture::Spectrum(kind) => match self.weighted(kind, space) {
                Some((weight, textures)) => {
                    let textures = textures.map(|texture| self.spectrum(texture, usage));
                    SpectrumTexture::Blend(Arc::new(Blend { weight, textures }))
                }
                None => self.spectrum_kind(kind, usage, space, desc.span),
            },
            // The reader keeps the classes apart.
            ClassedTexture::Float(_) => self.compile(&white(desc.span), usage).into(),
        };
        self.of_spectra.insert((id, usage), texture.clone());
        texture
    }

    /// The weight and the textures of a kind that is between two others.
    fn weighted<'k, V>(
        &mut self,
        kind: &'k TextureKind<V>,
        space: &DAffine3,
    ) -> Option<(BlendWeight, [&'k Textured<V>; 2])> {
        Some(match kind {
            TextureKind::Mix { textures, amount } => (BlendWeight::Amount(self.float(amount)), textures.each_ref()),
            TextureKind::DirectionMix {
                textures: [along, across],
                direction,
            } => {
                let direction = space.transform_vector3(*direction).normalize_or_zero().as_vec3();
                // The weight is that of the texture seen along the direction, which is the first in the file.
                (BlendWeight::Direction(direction), [across, along])
            }
            TextureKind::Checkerboard2 { textures, mapping } => (
                BlendWeight::Checkerboard2(mapping2(mapping, space)),
                textures.each_ref(),
            ),
            TextureKind::Checkerboard3 { textures } => (
                BlendWeight::Checkerboard3(TextureSpace::new(space)),
                textures.each_ref(),
            ),
            TextureKind::Dots {
                inside,
                outside,
                mapping,
            } => (BlendWeight::Dots(mapping2(mapping, space)), [outside, inside]),
            _ => return None,
        })
    }

    fn float_kind(&mut self, kind: &TextureKind<f32>, space: &DAffine3) -> FloatTexture {
        let noise = |kind| {
            let space = TextureSpace::new(space);
            FloatTexture::Noise(Arc::new(NoiseTexture { space, kind }))
        };
        match kind {
            TextureKind::Scale { tex, scale } => match (self.float(tex), self.float(scale)) {
                (FloatTexture::Constant(a), FloatTexture::Constant(b)) => FloatTexture::Constant(a * b),
                (tex, scale) => FloatTexture::Scale(Arc::new([tex, scale])),
            },
            TextureKind::Bilerp { corners, mapping } => FloatTexture::Bilerp(Arc::new(Bilerp {
                mapping: mapping2(mapping, space),
                corners: *corners,
            })),
            TextureKind::Image(desc) => match self.image(desc, space, true) {
                Some(image) => FloatTexture::Image(Arc::new(image)),
                None => FloatTexture::Constant(1.0),
            },
            TextureKind::MeshAttribute { name, scale } => FloatTexture::Attribute(self.attribute(name, *scale)),
            TextureKind::Fbm(desc) => noise(NoiseKind::Fbm {
                octaves: desc.octaves,
                roughness: desc.roughness,
            }),
            TextureKind::Wrinkled(desc) => noise(NoiseKind::Wrinkled {
                octaves: desc.octaves,
                roughness: desc.roughness,
            }),
            TextureKind::Windy => noise(NoiseKind::Windy),
            TextureKind::Constant(value) => FloatTexture::Constant(*value),
            // Those between two others are not made here, and marble is of spectra only.
            _ => FloatTexture::Constant(1.0),
        }
    }

    fn spectrum_kind(
        &mut self,
        kind: &TextureKind<SpectrumDesc>,
        usage: SpectrumUse,
        space: &DAffine3,
        span: Span,
    ) -> SpectrumTexture {
        let rgb = |kind, space| RgbSampler::new(self.spectra.mode, kind, space);
        match kind {
            TextureKind::Constant(value) => self.compile(value, usage).into(),
            TextureKind::Scale { tex, scale } => match (self.spectrum(tex, usage), self.float(scale)) {
                // Beyond 1, a reflectance must be kept in range when it is evaluated.
                (SpectrumTexture::Constant(spectrum), FloatTexture::Constant(scale))
                    if (0.0..=1.0).contains(&scale) =>
                {
                    spectrum.scaled(scale).into()
                }
                factors => SpectrumTexture::Scale(Arc::new(factors)),
            },
            TextureKind::Bilerp { corners, mapping } => SpectrumTexture::Bilerp(Arc::new(Bilerp {
                mapping: mapping2(mapping, space),
                corners: corners.each_ref().map(|corner| self.compile(corner, usage)),
            })),
            TextureKind::Image(desc) => {
                let rgb = rgb(
                    usage.of_rgb(),
                    color_space_of(&self.images[desc.image.0 as usize].image),
                );
                match self.image(desc, space, false) {
                    Some(image) => SpectrumTexture::Image(Arc::new(image), rgb),
                    None => self.compile(&white(span), usage).into(),
                }
            }
            TextureKind::MeshAttribute { name, scale } => {
                let rgb = rgb(usage.of_rgb(), ColorSpace::Srgb);
                SpectrumTexture::Attribute(self.attribute(name, *scale), rgb)
            }
            TextureKind::Marble {
                octaves,
                scale,
                variation,
            } => {
                let marble = Marble {
                    space: TextureSpace::new(space),
                    octaves: octaves.octaves,
                    roughness: octaves.roughness,
                    scale: *scale,
                    variation: *variation,
                };
                SpectrumTexture::Marble(Arc::new(marble), rgb(RgbKind::Albedo, ColorSpace::Srgb))
            }
            // Those between two others are not made here, and the rest is of numbers only.
            _ => self.compile(&white(span), usage).into(),
        }
    }

    fn attribute(&self, name: &str, scale: f32) -> AttributeTexture {
        let tables = self.attributes.get(name).cloned().unwrap_or_default();
        AttributeTexture { tables, scale }
    }

    /// An image at all scales, made once. `None` if it has no colour, which the reader has seen to.
    fn map(&mut self, id: ImageId, wrap: Wrap, grey: bool) -> Option<Arc<MipMap>> {
        let key = (id, wrap, grey);
        if let Some(map) = self.maps.get(&key) {
            return Some(Arc::clone(map));
        }
        let map = Arc::new(MipMap::new(&self.images[id.0 as usize].image, wrap, grey)?);
        self.maps.insert(key, Arc::clone(&map));
        Some(map)
    }

    /// `None` if the image has no colour, which the reader has seen to.
    fn image(&mut self, desc: &ImageMapDesc, space: &DAffine3, grey: bool) -> Option<ImageTexture> {
        let wrap = match desc.wrap {
            WrapDesc::Repeat => Wrap::Repeat,
            WrapDesc::Black => Wrap::Black,
            WrapDesc::Clamp => Wrap::Clamp,
            WrapDesc::Mirror => Wrap::Mirror,
            WrapDesc::OctahedralSphere => Wrap::OctahedralSphere,
        };
        Some(ImageTexture {
            image: self.map(desc.image, wrap, grey)?,
            mapping: mapping2(&desc.mapping, space),
            filter: match desc.filter {
                ImageFilterDesc::Point => Filter::Point,
                ImageFilterDesc::Bilinear => Filter::Bilinear,
                ImageFilterDesc::Trilinear => Filter::Trilinear,
                ImageFilterDesc::Ewa { max_anisotropy } => Filter::Ewa { max_anisotropy },
            },
            scale: desc.scale,
            invert: desc.invert,
        })
    }
}

fn mapping2(desc: &MappingDesc, world_from_texture: &DAffine3) -> Mapping2 {
    let space = || TextureSpace::new(world_from_texture);
    match *desc {
        MappingDesc::Uv { scale, delta } => Mapping2::Uv { scale, delta },
        MappingDesc::Affine { matrix, delta } => Mapping2::Affine { matrix, delta },
        MappingDesc::Spherical => Mapping2::Spherical(space()),
        MappingDesc::Cylindrical => Mapping2::Cylindrical(space()),
        MappingDesc::Planar { vectors, delta } => Mapping2::Planar {
            space: space(),
            vectors,
            delta,
        },
    }
}

fn white(span: Span) -> SpectrumDesc {
    SpectrumDesc {
        value: SpectrumValue::Constant(1.0),
        span,
    }
}

/// A spectrum as a reflectance: a texture may have values above 1, as it may be used for something else.
fn at_most_one(desc: &SpectrumDesc) -> SpectrumDesc {
    let value = match &desc.value {
        SpectrumValue::Constant(value) => SpectrumValue::Constant(value.min(1.0)),
        SpectrumValue::Rgb(rgb, space) => SpectrumValue::Rgb(rgb.map(|c| c.min(1.0)), *space),
        SpectrumValue::Samples(samples) => {
            SpectrumValue::Samples(samples.iter().map(|&(nm, value)| (nm, value.min(1.0))).collect())
        }
        SpectrumValue::Named(_) | SpectrumValue::Blackbody(_) => desc.value.clone(),
    };
    SpectrumDesc { value, ..*desc }
}
