//! What a tree consists of.

use super::simd::{EIGHT, Simd};
use crate::math::Vec3;

/// Children of a node.
pub const WIDTH: usize = EIGHT;
/// Vectors of a leaf.
const VECTORS: usize = 4;
/// Points of a leaf.
pub const LEAF: usize = VECTORS * EIGHT;

/// A number for each point of a leaf.
pub type Lanes = [[f32; EIGHT]; VECTORS];

/// Points, by axis. The last leaf may have fewer, and no numbers in the lanes left over: comparisons with them are false.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub struct Leaf(pub [Lanes; 3]);

/// The boxes of a node's children, by axis. A child that is not there is infinitely far.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub struct Node {
    pub min: [[f32; WIDTH]; 3],
    pub max: [[f32; WIDTH]; 3],
}

/// A point to search around, in every lane.
#[derive(Clone, Copy)]
pub struct Center<V>([V; 3]);

impl<V> Center<V> {
    #[inline(always)]
    pub fn new<S: Simd<Vector = V>>(simd: S, p: Vec3) -> Self {
        Self([simd.splat(p.x), simd.splat(p.y), simd.splat(p.z)])
    }
}

impl Leaf {
    pub const EMPTY: Self = Self([[[f32::NAN; EIGHT]; VECTORS]; 3]);

    /// The squared distances of its points.
    #[inline(always)]
    pub fn distances<S: Simd>(&self, simd: S, center: &Center<S::Vector>) -> [S::Vector; VECTORS] {
        let (Self([x, y, z]), [px, py, pz]) = (self, center.0);
        let mut distances = [px; VECTORS];
        for (i, distance) in distances.iter_mut().enumerate() {
            let (x, y, z) = (simd.load(&x[i]), simd.load(&y[i]), simd.load(&z[i]));
            *distance = simd.length_squared([simd.sub(x, px), simd.sub(y, py), simd.sub(z, pz)]);
        }
        distances
    }
}

impl Node {
    pub const EMPTY: Self = Self {
        min: [[f32::INFINITY; WIDTH]; 3],
        max: [[f32::NEG_INFINITY; WIDTH]; 3],
    };

    /// The squared distances of its boxes: at most those that [`Leaf::distances`] gives for points within.
    #[inline(always)]
    pub fn distances<S: Simd>(&self, simd: S, center: &Center<S::Vector>) -> S::Vector {
        let zero = simd.splat(0.0);
        let mut offset = center.0;
        for (axis, p) in offset.iter_mut().enumerate() {
            let below = simd.sub(simd.load(&self.min[axis]), *p);
            let above = simd.sub(*p, simd.load(&self.max[axis]));
            *p = simd.max(simd.max(below, above), zero);
        }
        simd.length_squared(offset)
    }

    /// The box of all children.
    pub fn bounds(&self) -> ([f32; 3], [f32; 3]) {
        (
            self.min.map(|axis| axis.into_iter().fold(f32::INFINITY, f32::min)),
            self.max.map(|axis| axis.into_iter().fold(f32::NEG_INFINITY, f32::max)),
        )
    }
}
