//! Bump and normal maps: a shading normal from a texture.
//!
//! What they do to the frame is as in pbrt-v4, but for the term of a displacement's height times the curvature, which is left out:
//! heights are small against radii. How black edges are kept away is said in `sides.rs`.

use std::sync::Arc;

use super::{Bsdf, Material};
use crate::geometry::SurfaceInteraction;
use crate::math::{Frame, Vec2, Vec3};
use crate::spectrum::Wavelengths;
use crate::texture::{Filter, FloatTexture, MipMap, TextureContext};

/// A material under a bump or normal map.
#[derive(Clone, Debug)]
pub struct Relief {
    /// What bends the shading normal.
    pub map: ReliefMap,
    /// What it is made of.
    pub material: Material,
}

/// What bends the shading normal.
#[derive(Clone, Debug)]
pub enum ReliefMap {
    /// Height over the surface along the shading normal, in scene units.
    Displacement(FloatTexture),
    /// Normals by colour: 2 rgb - 1 in the frame of dp/du and the shading normal, linear, (0, 0) at the lower left.
    Normals(Arc<MipMap>),
}

/// The step in texture coordinates by which slopes are taken where a ray has no footprint, as in pbrt-v4.
const LEAST_STEP: f32 = 5e-4;

impl Relief {
    pub(super) fn bsdf(&self, si: &SurfaceInteraction, lambda: &mut Wavelengths) -> Bsdf<'_> {
        match self.map.bend(si) {
            Some(bent) => self.material.bsdf(&bent, lambda).with_sides_of(si.ng),
            None => self.material.bsdf(si, lambda),
        }
    }
}

impl ReliefMap {
    /// The point with the bent shading normal; `None` where the map is flat, or the surface has no texture coordinates.
    fn bend(&self, si: &SurfaceInteraction) -> Option<SurfaceInteraction> {
        let in_plane = |v: Vec3| v - si.ns * si.ns.dot(v);
        let (dpdu, dpdv) = (in_plane(si.dpdu), in_plane(si.dpdv));
        let (ns, dpdu) = match self {
            Self::Displacement(height) => {
                let slopes = slopes(height, si);
                if slopes == Vec2::ZERO {
                    return None;
                }
                // Tangents of the displaced surface.
                let (along_u, along_v) = (dpdu + si.ns * slopes.x, dpdv + si.ns * slopes.y);
                (along_u.cross(along_v).try_normalize()?, along_u)
            }
            Self::Normals(map) => {
                let frame = Frame {
                    s: dpdu.try_normalize()?,
                    n: si.ns,
                    t: si.ns.cross(dpdu).try_normalize()?,
                };
                let st = Vec2::new(si.uv.x, 1.0 - si.uv.y);
                let colour = map.lookup(st, Vec2::ZERO, Vec2::ZERO, Filter::Bilinear);
                let local = (colour * 2.0 - 1.0).try_normalize()?;
                if local == Vec3::Z {
                    return None;
                }
                let ns = frame.to_world(local).normalize();
                (ns, dpdu - ns * ns.dot(dpdu))
            }
        };
        let ns = if ns.dot(si.ng) < 0.0 { -ns } else { ns };
        Some(SurfaceInteraction { ns, dpdu, ..*si })
    }
}

/// The slopes of a height by u and by v.
fn slopes(height: &FloatTexture, si: &SurfaceInteraction) -> Vec2 {
    let context = TextureContext::new(si);
    let step = |dx: f32, dy: f32| match 0.5 * (dx.abs() + dy.abs()) {
        0.0 => LEAST_STEP,
        step => step,
    };
    let du = step(context.duvdx.x, context.duvdy.x);
    let dv = step(context.duvdx.y, context.duvdy.y);
    let here = height.evaluate(&context);
    let along_u = height.evaluate(&context.moved(si.dpdu * du, Vec2::new(du, 0.0)));
    let along_v = height.evaluate(&context.moved(si.dpdv * dv, Vec2::new(0.0, dv)));
    Vec2::new((along_u - here) / du, (along_v - here) / dv)
}

#[cfg(test)]
#[path = "relief_tests.rs"]
mod tests;
