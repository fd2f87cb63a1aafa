//! Textures between two others: `mix`, `directionmix`, `checkerboard` and `dots` differ in where there is how much of which.

use super::procedural::{checkerboard2, checkerboard3, is_in_dot};
use super::{FloatTexture, Mapping2, TextureContext, TextureSpace};
use crate::math::Vec3;

/// The first texture where the weight is 0, the second where it is 1, and between them a mean.
#[derive(Clone, Debug)]
pub struct Blend<T> {
    /// How much there is of the second.
    pub weight: BlendWeight,
    /// The two.
    pub textures: [T; 2],
}

/// How much there is of the second texture.
#[derive(Clone, Debug)]
pub enum BlendWeight {
    /// What a texture says (`mix`); not kept in [0, 1], as in pbrt-v4.
    Amount(FloatTexture),
    /// |cos| of the geometric normal to this unit vector, world space (`directionmix`: the texture that is seen along it is the
    /// second here).
    Direction(Vec3),
    /// A filtered checkerboard of unit squares.
    Checkerboard2(Mapping2),
    /// A filtered checkerboard of unit cubes.
    Checkerboard3(TextureSpace),
    /// Inside of dots.
    Dots(Mapping2),
}

impl BlendWeight {
    fn evaluate(&self, context: &TextureContext) -> f32 {
        match self {
            Self::Amount(texture) => texture.evaluate(context),
            Self::Direction(direction) => context.n.dot(*direction).abs(),
            Self::Checkerboard2(mapping) => checkerboard2(&mapping.map(context)),
            Self::Checkerboard3(space) => checkerboard3(&space.map(context)),
            Self::Dots(mapping) => f32::from(u8::from(is_in_dot(mapping.map(context).st))),
        }
    }
}

impl<T> Blend<T> {
    /// The value for a context, where `evaluate` gives those of the textures. A texture of which there is nothing is not asked.
    pub(super) fn evaluate<V: Copy>(
        &self,
        context: &TextureContext,
        evaluate: impl Fn(&T) -> V,
        lerp: impl Fn(V, V, f32) -> V,
    ) -> V {
        let weight = self.weight.evaluate(context);
        let [first, second] = &self.textures;
        if weight == 0.0 {
            return evaluate(first);
        }
        if weight == 1.0 {
            return evaluate(second);
        }
        lerp(evaluate(first), evaluate(second), weight)
    }
}
