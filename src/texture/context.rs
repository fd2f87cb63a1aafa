//! What a texture is asked about: a point of a surface, and how much around it one sample stands for.

use crate::geometry::{GeometryId, PrimitiveId, SurfaceInteraction};
use crate::math::{Vec2, Vec3};

/// A point of a surface and its neighbourhood, world space. `x` and `y` are the two axes of the footprint: how far the point moves,
/// and its texture coordinates with it, from one sample to the next.
#[derive(Clone, Copy, Debug)]
pub struct TextureContext {
    /// The point.
    pub p: Vec3,
    /// Long axis of the footprint, on the surface.
    pub dpdx: Vec3,
    /// Short axis of the footprint.
    pub dpdy: Vec3,
    /// Unit geometric normal.
    pub n: Vec3,
    /// Texture coordinates of the surface.
    pub uv: Vec2,
    /// Change of `uv` along the long axis.
    pub duvdx: Vec2,
    /// Change of `uv` along the short axis.
    pub duvdy: Vec2,
    /// Which primitive it is of, for textures that ask a mesh; `None` if that is not known.
    pub place: Option<MeshPlace>,
}

/// A point of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshPlace {
    /// The mesh.
    pub geometry: GeometryId,
    /// The triangle.
    pub primitive: PrimitiveId,
    /// See [`SurfaceInteraction::barycentrics`].
    pub barycentrics: Vec2,
}

/// The least cosine that a footprint is drawn out by.
const LEAST_COS: f32 = 1e-3;

/// The largest change of texture coordinates within a footprint, as in pbrt-v4: more comes from degenerate parametrisations.
const LARGEST_CHANGE: f32 = 1e8;

impl TextureContext {
    /// Where a ray's cone meets a surface: an ellipse, drawn out along the ray.
    pub fn new(si: &SurfaceInteraction) -> Self {
        let mut context = Self::at_point(si.p, si.ng, si.uv);
        context.place = Some(MeshPlace {
            geometry: si.hit.geometry,
            primitive: si.hit.primitive,
            barycentrics: si.barycentrics,
        });
        if si.footprint > 0.0 {
            let cos = si.ng.dot(si.wo);
            let across = (si.wo - si.ng * cos).try_normalize();
            let long = across.unwrap_or_else(|| si.ng.any_orthonormal_vector());
            context.dpdx = long * (si.footprint / cos.abs().clamp(LEAST_COS, 1.0));
            context.dpdy = si.ng.cross(long) * si.footprint;
            [context.duvdx, context.duvdy] = uv_changes(si.dpdu, si.dpdv, context.dpdx, context.dpdy);
        }
        context
    }

    /// A point of no extent, where the unit geometric normal is `n` and the texture coordinates are `uv`: asks for the finest detail.
    pub fn at_point(p: Vec3, n: Vec3, uv: Vec2) -> Self {
        Self {
            p,
            dpdx: Vec3::ZERO,
            dpdy: Vec3::ZERO,
            n,
            uv,
            duvdx: Vec2::ZERO,
            duvdy: Vec2::ZERO,
            place: None,
        }
    }

    /// The context a little beside the point, by `dp` in space and by `duv` in texture coordinates.
    #[must_use]
    pub fn moved(&self, dp: Vec3, duv: Vec2) -> Self {
        Self {
            p: self.p + dp,
            uv: self.uv + duv,
            ..*self
        }
    }
}

/// The changes of (u, v) that move the point by each axis, by least squares.
fn uv_changes(dpdu: Vec3, dpdv: Vec3, dpdx: Vec3, dpdy: Vec3) -> [Vec2; 2] {
    let (uu, uv, vv) = (dpdu.length_squared(), dpdu.dot(dpdv), dpdv.length_squared());
    let inverse = 1.0 / (uu * vv - uv * uv);
    let inverse = if inverse.is_finite() { inverse } else { 0.0 };
    [dpdx, dpdy].map(|axis| {
        let (bu, bv) = (dpdu.dot(axis), dpdv.dot(axis));
        let change = Vec2::new(vv * bu - uv * bv, uu * bv - uv * bu) * inverse;
        if change.is_finite() {
            change.clamp(Vec2::splat(-LARGEST_CHANGE), Vec2::splat(LARGEST_CHANGE))
        } else {
            Vec2::ZERO
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Hit;

    /// The plane z = 0 with u = x / 2 and v = y / 3 seen from direction `wo`.
    fn plane(wo: Vec3, footprint: f32) -> SurfaceInteraction {
        SurfaceInteraction {
            p: Vec3::ZERO,
            error: 0.0,
            ng: Vec3::Z,
            ns: Vec3::Z,
            dpdu: Vec3::new(2.0, 0.0, 0.0),
            dpdv: Vec3::new(0.0, 3.0, 0.0),
            uv: Vec2::new(0.25, 0.5),
            barycentrics: Vec2::ZERO,
            wo,
            footprint,
            time: 0.0,
            hit: Hit {
                geometry: GeometryId(0),
                primitive: PrimitiveId(0),
                instance: None,
            },
        }
    }

    #[test]
    fn a_footprint_is_drawn_out_along_the_ray() {
        // Seen at 60 degrees along x: twice as long in x.
        let context = TextureContext::new(&plane(Vec3::new(0.75_f32.sqrt(), 0.0, 0.5), 0.12));
        assert!((context.dpdx - Vec3::new(0.24, 0.0, 0.0)).length() < 1e-6);
        assert!((context.dpdy - Vec3::new(0.0, 0.12, 0.0)).length() < 1e-6);
        assert!((context.duvdx - Vec2::new(0.12, 0.0)).length() < 1e-6);
        assert!((context.duvdy - Vec2::new(0.0, 0.04)).length() < 1e-6);
    }

    #[test]
    fn a_footprint_from_above_is_round_and_none_is_none() {
        let context = TextureContext::new(&plane(Vec3::Z, 0.1));
        assert!((context.dpdx.length() - 0.1).abs() < 1e-7 && (context.dpdy.length() - 0.1).abs() < 1e-7);
        assert!(context.dpdx.dot(context.dpdy).abs() < 1e-9);
        let context = TextureContext::new(&plane(Vec3::Z, 0.0));
        assert_eq!((context.dpdx, context.duvdy), (Vec3::ZERO, Vec2::ZERO));
    }

    #[test]
    fn degenerate_coordinates_have_no_changes() {
        let mut si = plane(Vec3::Z, 0.1);
        si.dpdv = si.dpdu;
        assert_eq!(TextureContext::new(&si).duvdx, Vec2::ZERO);
    }
}
