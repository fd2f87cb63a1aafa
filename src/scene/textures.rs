//! Textures as described to textures as evaluated.

use std::collections::HashMap;
use std::sync::Arc;

use super::spectra::SpectrumCompiler;
use crate::desc::{
    ClassedTexture, RoughnessDesc, SpectrumDesc, SpectrumValue, TextureDesc, TextureId, TextureKind, Textured,
};
use crate::error::Span;
use crate::material::Roughness;
use crate::math::{DAffine3, DVec3};
use crate::spectrum::CompiledSpectrum;
use crate::texture::{Blend, BlendWeight, FloatTexture, SpectrumTexture};

/// What the spectra of a texture are, as pbrt-v4 tells them apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum SpectrumUse {
    /// Reflectances, in [0, 1].
    Albedo,
    /// Anything else that light is multiplied by: indices of metals.
    Unbounded,
}

/// Makes textures ready for rendering, each once for each use.
pub(super) struct TextureCompiler<'a> {
    textures: &'a [TextureDesc],
    pub spectra: SpectrumCompiler,
    floats: HashMap<TextureId, FloatTexture>,
    of_spectra: HashMap<(TextureId, SpectrumUse), SpectrumTexture>,
}

impl<'a> TextureCompiler<'a> {
    pub fn new(textures: &'a [TextureDesc], spectra: SpectrumCompiler) -> Self {
        Self {
            textures,
            spectra,
            floats: HashMap::new(),
            of_spectra: HashMap::new(),
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

    /// The roughness of a microfacet surface.
    pub fn roughness(&mut self, desc: &RoughnessDesc) -> Roughness {
        Roughness::new(self.float(&desc.u), self.float(&desc.v), desc.remap)
    }

    fn compile(&self, desc: &SpectrumDesc, usage: SpectrumUse) -> CompiledSpectrum {
        match usage {
            SpectrumUse::Albedo => self.spectra.albedo(&at_most_one(desc)),
            SpectrumUse::Unbounded => self.spectra.metal_index(desc),
        }
    }

    // Textures refer to one another at most TextureDesc::DEEPEST deep, so that these recursions end soon.

    fn float_texture(&mut self, id: TextureId) -> FloatTexture {
        if let Some(texture) = self.floats.get(&id) {
            return texture.clone();
        }
        let desc = &self.textures[id.0 as usize];
        let texture = match &desc.kind {
            ClassedTexture::Float(kind) => self.float_kind(kind, &desc.world_from_texture),
            // The reader keeps the classes apart.
            ClassedTexture::Spectrum(_) => FloatTexture::Constant(1.0),
        };
        self.floats.insert(id, texture.clone());
        texture
    }

    fn float_kind(&mut self, kind: &TextureKind<f32>, world_from_texture: &DAffine3) -> FloatTexture {
        match kind {
            TextureKind::Constant(value) => FloatTexture::Constant(*value),
            TextureKind::Scale { tex, scale } => match (self.float(tex), self.float(scale)) {
                (FloatTexture::Constant(a), FloatTexture::Constant(b)) => FloatTexture::Constant(a * b),
                (tex, scale) => FloatTexture::Scale(Arc::new([tex, scale])),
            },
            TextureKind::Mix { textures, amount } => {
                self.float_blend(textures, |this| BlendWeight::Amount(this.float(amount)))
            }
            TextureKind::DirectionMix {
                textures: [along, across],
                direction,
            } => {
                // The weight counts the texture seen along the direction, which is the first in the file.
                let textures = [across.clone(), along.clone()];
                self.float_blend(&textures, |_| direction_weight(world_from_texture, *direction))
            }
        }
    }

    fn float_blend(
        &mut self,
        textures: &[Textured<f32>; 2],
        weight: impl FnOnce(&mut Self) -> BlendWeight,
    ) -> FloatTexture {
        let textures = textures.each_ref().map(|texture| self.float(texture));
        let weight = weight(self);
        FloatTexture::Blend(Arc::new(Blend { weight, textures }))
    }

    fn spectrum_texture(&mut self, id: TextureId, usage: SpectrumUse) -> SpectrumTexture {
        if let Some(texture) = self.of_spectra.get(&(id, usage)) {
            return texture.clone();
        }
        let desc = &self.textures[id.0 as usize];
        let texture = match &desc.kind {
            ClassedTexture::Spectrum(kind) => self.spectrum_kind(kind, usage, &desc.world_from_texture),
            // The reader keeps the classes apart.
            ClassedTexture::Float(_) => self.compile(&white(desc.span), usage).into(),
        };
        self.of_spectra.insert((id, usage), texture.clone());
        texture
    }

    fn spectrum_kind(
        &mut self,
        kind: &TextureKind<SpectrumDesc>,
        usage: SpectrumUse,
        world_from_texture: &DAffine3,
    ) -> SpectrumTexture {
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
            TextureKind::Mix { textures, amount } => {
                self.spectrum_blend(textures, usage, |this| BlendWeight::Amount(this.float(amount)))
            }
            TextureKind::DirectionMix {
                textures: [along, across],
                direction,
            } => {
                let textures = [across.clone(), along.clone()];
                self.spectrum_blend(&textures, usage, |_| direction_weight(world_from_texture, *direction))
            }
        }
    }

    fn spectrum_blend(
        &mut self,
        textures: &[Textured<SpectrumDesc>; 2],
        usage: SpectrumUse,
        weight: impl FnOnce(&mut Self) -> BlendWeight,
    ) -> SpectrumTexture {
        let textures = textures.each_ref().map(|texture| self.spectrum(texture, usage));
        let weight = weight(self);
        SpectrumTexture::Blend(Arc::new(Blend { weight, textures }))
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
        SpectrumValue::Rgb(rgb) => SpectrumValue::Rgb(rgb.map(|c| c.min(1.0))),
        SpectrumValue::Samples(samples) => {
            SpectrumValue::Samples(samples.iter().map(|&(nm, value)| (nm, value.min(1.0))).collect())
        }
        SpectrumValue::Named(_) | SpectrumValue::Blackbody(_) => desc.value.clone(),
    };
    SpectrumDesc { value, ..*desc }
}

fn direction_weight(world_from_texture: &DAffine3, direction: DVec3) -> BlendWeight {
    let direction = world_from_texture.transform_vector3(direction);
    BlendWeight::Direction(direction.normalize_or_zero().as_vec3())
}
