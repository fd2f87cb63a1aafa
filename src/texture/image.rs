//! Textures from images.

use std::sync::Arc;

use super::{Filter, Mapping2, MipMap, TextureContext};
use crate::math::Vec3;

/// An image on a surface: (0, 0) is the lower left corner.
#[derive(Clone, Debug)]
pub struct ImageTexture {
    /// The image.
    pub image: Arc<MipMap>,
    /// Where it lies.
    pub mapping: Mapping2,
    /// How texels are combined.
    pub filter: Filter,
    /// Factor of the values.
    pub scale: f32,
    /// Whether 1 - value is meant, after scaling.
    pub invert: bool,
}

impl ImageTexture {
    fn lookup(&self, context: &TextureContext) -> Vec3 {
        let mut c = self.mapping.map(context);
        c.st.y = 1.0 - c.st.y;
        let value = self.image.lookup(c.st, c.dstdx, c.dstdy, self.filter) * self.scale;
        if self.invert { Vec3::ONE - value } else { value }
    }

    /// The first channel; 0 where inverting would give less.
    pub(super) fn evaluate(&self, context: &TextureContext) -> f32 {
        let value = self.lookup(context).x;
        if self.invert { value.max(0.0) } else { value }
    }

    /// The colour in the linear RGB of the image, no component negative.
    pub(super) fn evaluate_rgb(&self, context: &TextureContext) -> [f32; 3] {
        self.lookup(context).max(Vec3::ZERO).into()
    }
}
