//! From a point of a surface to the coordinates that a texture looks at.

use std::f32::consts::{FRAC_1_PI, PI};

use super::TextureContext;
use crate::math::{DAffine3, Vec2, Vec3};

/// Coordinates (s, t), and how they change along the axes of the footprint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coordinates2 {
    /// The coordinates.
    pub st: Vec2,
    /// Their change along the long axis.
    pub dstdx: Vec2,
    /// Their change along the short axis.
    pub dstdy: Vec2,
}

/// A point in texture space, and how it moves along the axes of the footprint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coordinates3 {
    /// The point.
    pub p: Vec3,
    /// Its change along the long axis.
    pub dpdx: Vec3,
    /// Its change along the short axis.
    pub dpdy: Vec3,
}

/// The space of a texture: the current transform at its definition.
#[derive(Clone, Copy, Debug)]
pub struct TextureSpace {
    texture_from_world: DAffine3,
}

/// A mapping to two coordinates.
#[derive(Clone, Copy, Debug)]
pub enum Mapping2 {
    /// Those of the surface, times `scale` plus `delta`.
    Uv {
        /// Factors.
        scale: Vec2,
        /// Added after.
        delta: Vec2,
    },
    /// (polar angle / pi, azimuth / 2 pi) around the origin of texture space.
    Spherical(TextureSpace),
    /// ((pi + azimuth) / 2 pi, z) around the z axis of texture space.
    Cylindrical(TextureSpace),
    /// The dot products with two vectors, in texture space, plus `delta`.
    Planar {
        /// The space of the vectors.
        space: TextureSpace,
        /// For s and t.
        vectors: [Vec3; 2],
        /// Added.
        delta: Vec2,
    },
}

impl TextureSpace {
    /// The space that `world_from_texture`, which must be invertible, leads out of.
    pub fn new(world_from_texture: &DAffine3) -> Self {
        Self {
            texture_from_world: world_from_texture.inverse(),
        }
    }

    /// The point and its footprint in texture space.
    pub fn map(&self, context: &TextureContext) -> Coordinates3 {
        let vector = |v: Vec3| self.texture_from_world.transform_vector3(v.as_dvec3()).as_vec3();
        Coordinates3 {
            p: self.texture_from_world.transform_point3(context.p.as_dvec3()).as_vec3(),
            dpdx: vector(context.dpdx),
            dpdy: vector(context.dpdy),
        }
    }
}

impl Mapping2 {
    /// The coordinates for a context.
    pub fn map(&self, context: &TextureContext) -> Coordinates2 {
        match self {
            Self::Uv { scale, delta } => Coordinates2 {
                st: *scale * context.uv + *delta,
                dstdx: *scale * context.duvdx,
                dstdy: *scale * context.duvdy,
            },
            Self::Spherical(space) => spherical(&space.map(context)),
            Self::Cylindrical(space) => cylindrical(&space.map(context)),
            Self::Planar { space, vectors, delta } => {
                let c = space.map(context);
                let dots = |v: Vec3| Vec2::new(v.dot(vectors[0]), v.dot(vectors[1]));
                Coordinates2 {
                    st: dots(c.p) + *delta,
                    dstdx: dots(c.dpdx),
                    dstdy: dots(c.dpdy),
                }
            }
        }
    }
}

/// s is the polar angle over pi, t the azimuth in [0, 2 pi) over 2 pi, as in pbrt-v4; but the changes are those of these
/// coordinates, where pbrt-v4 has them the other way round.
fn spherical(c: &Coordinates3) -> Coordinates2 {
    let p = c.p;
    let (r2, across2) = (p.length_squared(), p.x * p.x + p.y * p.y);
    let across = across2.sqrt();
    let ds = Vec3::new(p.x * p.z / across, p.y * p.z / across, -across) / (PI * r2);
    let azimuth = p.y.atan2(p.x);
    let azimuth = if azimuth < 0.0 { azimuth + 2.0 * PI } else { azimuth };
    Coordinates2 {
        st: Vec2::new(across.atan2(p.z) * FRAC_1_PI, azimuth * (0.5 * FRAC_1_PI)),
        dstdx: finite(Vec2::new(ds.dot(c.dpdx), azimuth_change(p, c.dpdx))),
        dstdy: finite(Vec2::new(ds.dot(c.dpdy), azimuth_change(p, c.dpdy))),
    }
}

fn cylindrical(c: &Coordinates3) -> Coordinates2 {
    Coordinates2 {
        st: Vec2::new((PI + c.p.y.atan2(c.p.x)) * (0.5 * FRAC_1_PI), c.p.z),
        dstdx: finite(Vec2::new(azimuth_change(c.p, c.dpdx), c.dpdx.z)),
        dstdy: finite(Vec2::new(azimuth_change(c.p, c.dpdy), c.dpdy.z)),
    }
}

/// The change of azimuth / 2 pi with a step `dp`.
fn azimuth_change(p: Vec3, dp: Vec3) -> f32 {
    (p.x * dp.y - p.y * dp.x) / (2.0 * PI * (p.x * p.x + p.y * p.y))
}

/// On the axis the coordinates have no derivative; there all of the texture is within the footprint.
fn finite(change: Vec2) -> Vec2 {
    if change.is_finite() { change } else { Vec2::ONE }
}
