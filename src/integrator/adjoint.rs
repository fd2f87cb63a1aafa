//! Shading normals and light paths.

use crate::geometry::SurfaceInteraction;
use crate::material::Bsdf;
use crate::math::Vec3;

/// What takes the BSDF of a shading normal to its adjoint, for light that arrives from `si.wo` and goes on into `wi` (Veach 1997,
/// section 5.3.2): 1 where the two normals are the same. The shading normal is the BSDF's, which maps may have bent.
pub(super) fn adjoint_correction(si: &SurfaceInteraction, bsdf: &Bsdf, wi: Vec3) -> f32 {
    let correction = bend(si.ng, bsdf, wi) / bend(si.ng, bsdf, si.wo);
    if correction.is_finite() { correction } else { 0.0 }
}

/// |cos| of `w` to the geometric normal over that to the shading normal: the correction is that of `wi` over that of `wo`.
pub(super) fn bend(ng: Vec3, bsdf: &Bsdf, w: Vec3) -> f32 {
    ng.dot(w).abs() / bsdf.abs_cos(w)
}
