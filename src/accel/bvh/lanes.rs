//! Vectors of a number for each ray of a packet.

use super::leaf::{Corners, LANES as TRIANGLES};
use super::prepare::Rays;
use super::triangle::Plane;

/// Instructions on `N` lanes. Single operations round as scalars do, and none but [`Lanes::fused`] is fused.
///
/// A comparison with NaN is false; of `least` and `greatest` the result is the second operand where either is NaN.
pub trait Lanes<const N: usize>: Copy + Send + Sync {
    /// A number for each lane.
    type F: Copy;
    /// An integer for each lane.
    type U: Copy;
    /// A number of double precision for each lane.
    type D: Copy;
    /// A truth value for each lane.
    type M: Copy;

    fn splat(self, x: f32) -> Self::F;
    fn load(self, x: &[f32; N]) -> Self::F;
    fn store(self, x: Self::F, to: &mut [f32; N]);
    fn add(self, a: Self::F, b: Self::F) -> Self::F;
    fn sub(self, a: Self::F, b: Self::F) -> Self::F;
    fn mul(self, a: Self::F, b: Self::F) -> Self::F;
    fn div(self, a: Self::F, b: Self::F) -> Self::F;
    /// a b + c, rounded once.
    fn fused(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F;
    fn least(self, a: Self::F, b: Self::F) -> Self::F;
    fn greatest(self, a: Self::F, b: Self::F) -> Self::F;
    fn abs(self, a: Self::F) -> Self::F;
    /// The size of `a` with the sign of `b`.
    fn copysign(self, a: Self::F, b: Self::F) -> Self::F;
    /// a < b.
    fn lt(self, a: Self::F, b: Self::F) -> Self::M;
    /// a <= b.
    fn le(self, a: Self::F, b: Self::F) -> Self::M;
    fn and(self, a: Self::M, b: Self::M) -> Self::M;
    /// A bit for each lane, the first the least.
    fn bits(self, m: Self::M) -> u32;
    /// The sign bit of each lane.
    fn signs(self, a: Self::F) -> u32;
    /// The lanes whose bits are set.
    fn mask(self, bits: u32) -> Self::M;
    /// `b` where `m`, else `a`.
    fn blend(self, m: Self::M, a: Self::F, b: Self::F) -> Self::F;
    fn splat_u(self, x: u32) -> Self::U;
    fn load_u(self, x: &[u32; N]) -> Self::U;
    fn store_u(self, x: Self::U, to: &mut [u32; N]);
    fn blend_u(self, m: Self::M, a: Self::U, b: Self::U) -> Self::U;
    /// Whether a and b have a bit in common.
    fn meet(self, a: Self::U, b: Self::U) -> Self::M;
    /// Whether all bits are set.
    fn none(self, a: Self::U) -> Self::M;
    /// The planes of the triangles of a block.
    fn planes(self, corners: &Corners) -> BlockPlanes;
    /// Origins and directions in double precision.
    fn widen(self, rays: &Rays<N>) -> WideRays<Self::D>;
    /// The distances of a plane, by the operations of [`Plane::distance`], rounded to single precision at the end.
    fn plane_distance(self, plane: &Plane, rays: &WideRays<Self::D>) -> Self::F;
}

/// Rays in double precision.
pub struct WideRays<D> {
    /// Origins, by axis.
    pub origin: [D; 3],
    /// Directions, by axis.
    pub direction: [D; 3],
}

/// The planes of four triangles: first corners and normals, by axis and triangle.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub struct BlockPlanes {
    /// See [`Plane::corner`].
    pub corner: [[f64; TRIANGLES]; 3],
    /// See [`Plane::normal`].
    pub normal: [[f64; TRIANGLES]; 3],
}

impl BlockPlanes {
    /// That of a triangle.
    #[inline(always)]
    pub fn of(&self, triangle: usize) -> Plane {
        let of = |[x, y, z]: &[[f64; TRIANGLES]; 3]| [x[triangle], y[triangle], z[triangle]];
        Plane {
            corner: of(&self.corner),
            normal: of(&self.normal),
        }
    }
}

/// The lanes whose bits are set.
#[inline(always)]
pub fn lanes_of(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = bits.trailing_zeros() as usize;
        (bits != 0).then(|| {
            bits &= bits - 1;
            lane
        })
    })
}
