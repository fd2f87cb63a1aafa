//! Which side of a surface a direction is on, where the shading normal is bent away from the geometric one by a map.
//!
//! Where the two normals disagree about a direction w, a bent frame would have light leak through the surface, and edges black.
//! Here the geometric normal decides: a direction that is on the other side of the bent tangent plane is mirrored at that plane
//! before a lobe sees it, wo and wi alike. So f stays symmetric where the lobe's is, and what reflects for one integrator reflects
//! for all.
//!
//! The mirror makes some local directions stand for two real ones and others for none. A sampled direction that stands for two
//! is either with probability 1/2. A diffuse lobe needs nothing more: |cos| over any hemisphere integrates to pi, so that its albedo
//! is exact under any map. Other lobes are divided by how many the one of wo and wi stands for that stands for more: this is
//! symmetric too, and no lobe gains energy.

use crate::math::Vec3;

/// The geometric normal in the local frame of a bent shading normal, whose z is positive.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sides {
    ng: Vec3,
}

impl Sides {
    /// For a geometric normal in the hemisphere of the shading normal, local.
    pub fn new(ng: Vec3) -> Self {
        Self { ng }
    }

    /// The direction that a lobe is to see for the real direction `w`.
    #[inline]
    pub fn seen(&self, w: Vec3) -> Vec3 {
        if self.is_real(w) { w } else { mirror(w) }
    }

    /// How many real directions a local one stands for.
    #[inline]
    pub fn count(&self, w: Vec3) -> f32 {
        f32::from(u8::from(self.is_real(w)) + u8::from(self.is_real_mirrored(w)))
    }

    /// One of the real directions that `w` stands for: the second with `other`, if there are two. `None` if there are none.
    #[inline]
    pub fn real(&self, w: Vec3, other: bool) -> Option<Vec3> {
        match (self.is_real(w), self.is_real_mirrored(w)) {
            (true, true) => Some(if other { mirror(w) } else { w }),
            (true, false) => Some(w),
            (false, true) => Some(mirror(w)),
            (false, false) => None,
        }
    }

    fn is_real(&self, w: Vec3) -> bool {
        (w.dot(self.ng) > 0.0) == (w.z > 0.0)
    }

    fn is_real_mirrored(&self, w: Vec3) -> bool {
        (mirror(w).dot(self.ng) > 0.0) == (w.z > 0.0)
    }
}

/// The mirror image in the tangent plane.
fn mirror(w: Vec3) -> Vec3 {
    Vec3::new(w.x, w.y, -w.z)
}
