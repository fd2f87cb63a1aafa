//! What a tree consists of.

use crate::math::Vec3;

/// Children of a node.
pub const WIDTH: usize = 8;
/// Points of a leaf.
pub const LEAF: usize = 32;

/// A number for each point of a leaf.
pub type Lanes = [f32; LEAF];

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

impl Leaf {
    pub const EMPTY: Self = Self([[f32::NAN; LEAF]; 3]);

    /// The squared distances from `p`.
    #[inline(always)]
    pub fn distances(&self, p: Vec3) -> Lanes {
        let [x, y, z] = &self.0;
        std::array::from_fn(|i| squared(x[i] - p.x, y[i] - p.y, z[i] - p.z))
    }
}

impl Node {
    pub const EMPTY: Self = Self {
        min: [[f32::INFINITY; WIDTH]; 3],
        max: [[f32::NEG_INFINITY; WIDTH]; 3],
    };

    /// The squared distances from `p` to the boxes: at most those that [`Leaf::distances`] gives for points within.
    #[inline(always)]
    pub fn distances(&self, p: Vec3) -> [f32; WIDTH] {
        let Self { min, max } = self;
        let p = p.to_array();
        std::array::from_fn(|i| {
            let [dx, dy, dz] = [0, 1, 2].map(|axis| {
                let (below, above) = (min[axis][i] - p[axis], p[axis] - max[axis][i]);
                let d = if below > above { below } else { above };
                if d > 0.0 { d } else { 0.0 }
            });
            squared(dx, dy, dz)
        })
    }

    /// The box of all children.
    pub fn bounds(&self) -> ([f32; 3], [f32; 3]) {
        (
            self.min.map(|axis| axis.into_iter().fold(f32::INFINITY, f32::min)),
            self.max.map(|axis| axis.into_iter().fold(f32::NEG_INFINITY, f32::max)),
        )
    }
}

#[inline(always)]
fn squared(dx: f32, dy: f32, dz: f32) -> f32 {
    (dx * dx + dy * dy) + dz * dz
}
