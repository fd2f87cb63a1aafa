//! Textures: numbers and spectra that vary over surfaces, with the kinds, parameters and meaning of pbrt-v4.
//!
//! A texture is asked with a [`TextureContext`], which says how much of the surface one sample stands for, so that it can filter
//! itself. A [`FloatTexture::Constant`] or [`SpectrumTexture::Constant`] is answered without one.

mod attribute;
mod bilerp;
mod blend;
mod context;
mod image;
mod mapping;
mod mipmap;
mod noise;
mod procedural;

pub use attribute::{AttributeTable, AttributeTexture};
pub use bilerp::Bilerp;
pub use blend::{Blend, BlendWeight};
pub use context::{MeshPlace, TextureContext};
pub use image::ImageTexture;
pub use mapping::{Coordinates2, Coordinates3, Mapping2, TextureSpace};
pub use mipmap::{Filter, MipMap, Wrap};
pub use noise::{fbm, noise, turbulence};
pub use procedural::{Marble, NoiseKind, NoiseTexture};

use std::sync::Arc;

use crate::geometry::SurfaceInteraction;
use crate::spectrum::{CompiledSpectrum, RgbSampler, SampledSpectrum, Wavelengths};

/// A number that may vary over a surface. Cheap to clone.
#[derive(Clone, Debug)]
pub enum FloatTexture {
    /// The same everywhere.
    Constant(f32),
    /// A texture times another.
    Scale(Arc<[FloatTexture; 2]>),
    /// Between two others.
    Blend(Arc<Blend<FloatTexture>>),
    /// Between four numbers.
    Bilerp(Arc<Bilerp<f32>>),
    /// The first channel of an image.
    Image(Arc<ImageTexture>),
    /// What meshes have.
    Attribute(AttributeTexture),
    /// Made of noise.
    Noise(Arc<NoiseTexture>),
}

/// A spectrum that may vary over a surface. Cheap to clone.
#[derive(Clone, Debug)]
pub enum SpectrumTexture {
    /// The same everywhere.
    Constant(CompiledSpectrum),
    /// A texture times a number.
    Scale(Arc<(SpectrumTexture, FloatTexture)>),
    /// Between two others.
    Blend(Arc<Blend<SpectrumTexture>>),
    /// Between four spectra.
    Bilerp(Arc<Bilerp<CompiledSpectrum>>),
    /// The colours of an image.
    Image(Arc<ImageTexture>, RgbSampler),
    /// The colours that meshes have.
    Attribute(AttributeTexture, RgbSampler),
    /// Layers of stone.
    Marble(Arc<Marble>, RgbSampler),
}

impl FloatTexture {
    /// Whether it is the same everywhere.
    #[inline]
    pub fn is_constant(&self) -> bool {
        matches!(self, Self::Constant(_))
    }

    /// The value at a surface point.
    #[inline]
    pub fn at(&self, si: &SurfaceInteraction) -> f32 {
        match self {
            Self::Constant(value) => *value,
            _ => self.evaluate(&TextureContext::new(si)),
        }
    }

    /// The value for a context.
    pub fn evaluate(&self, context: &TextureContext) -> f32 {
        match self {
            Self::Constant(value) => *value,
            Self::Scale(factors) => match factors[1].evaluate(context) {
                0.0 => 0.0,
                factor => factor * factors[0].evaluate(context),
            },
            Self::Blend(blend) => blend.evaluate(
                context,
                |texture| texture.evaluate(context),
                |a, b, t| a * (1.0 - t) + b * t,
            ),
            Self::Bilerp(corners) => {
                corners.evaluate(context, 0.0, |value| *value, |sum, value, weight| sum + value * weight)
            }
            Self::Image(texture) => texture.evaluate(context),
            Self::Attribute(texture) => texture.evaluate(context),
            Self::Noise(texture) => texture.evaluate(context),
        }
    }
}

impl SpectrumTexture {
    /// What it is everywhere, if that is the same.
    #[inline]
    pub fn constant(&self) -> Option<&CompiledSpectrum> {
        match self {
            Self::Constant(spectrum) => Some(spectrum),
            _ => None,
        }
    }

    /// Whether it is the same everywhere.
    #[inline]
    pub fn is_constant(&self) -> bool {
        matches!(self, Self::Constant(_))
    }

    /// The values at a surface point and the wavelengths of a path.
    #[inline]
    pub fn at(&self, si: &SurfaceInteraction, lambda: &Wavelengths) -> SampledSpectrum {
        match self {
            Self::Constant(spectrum) => spectrum.sample(lambda),
            _ => self.evaluate(&TextureContext::new(si), lambda),
        }
    }

    /// [`SpectrumTexture::at`] of a reflectance: what varies is kept in [0, 1], as in pbrt-v4.
    #[inline]
    pub fn reflectance_at(&self, si: &SurfaceInteraction, lambda: &Wavelengths) -> SampledSpectrum {
        match self {
            Self::Constant(spectrum) => spectrum.sample(lambda),
            _ => self
                .evaluate(&TextureContext::new(si), lambda)
                .map(|value| value.clamp(0.0, 1.0)),
        }
    }

    /// The values for a context and the wavelengths of a path.
    pub fn evaluate(&self, context: &TextureContext, lambda: &Wavelengths) -> SampledSpectrum {
        match self {
            Self::Constant(spectrum) => spectrum.sample(lambda),
            Self::Scale(factors) => match factors.1.evaluate(context) {
                0.0 => SampledSpectrum::ZERO,
                factor => factors.0.evaluate(context, lambda) * factor,
            },
            Self::Blend(blend) => blend.evaluate(
                context,
                |texture| texture.evaluate(context, lambda),
                |a, b, t| a * (1.0 - t) + b * t,
            ),
            Self::Bilerp(corners) => corners.evaluate(
                context,
                SampledSpectrum::ZERO,
                |spectrum| spectrum.sample(lambda),
                |sum, value, weight| sum + value * weight,
            ),
            Self::Image(texture, rgb) => rgb.sample(texture.evaluate_rgb(context), lambda),
            Self::Attribute(texture, rgb) => rgb.sample(texture.evaluate_rgb(context), lambda),
            Self::Marble(texture, rgb) => rgb.sample(texture.evaluate(context), lambda),
        }
    }
}

impl From<f32> for FloatTexture {
    fn from(value: f32) -> Self {
        Self::Constant(value)
    }
}

impl From<CompiledSpectrum> for SpectrumTexture {
    fn from(spectrum: CompiledSpectrum) -> Self {
        Self::Constant(spectrum)
    }
}
