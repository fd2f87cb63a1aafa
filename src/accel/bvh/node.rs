//! Nodes with eight children.

use super::ray::MARGIN;
use crate::math::{Bounds3, Vec3};

/// Children of a node.
pub const WIDTH: usize = 8;

/// What a child is, in two bits, and where, in thirty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub struct ChildRef(pub u32);

/// A decoded [`ChildRef`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Child {
    /// A node of the same tree.
    Node(usize),
    /// A block of triangles of the same tree.
    Block(usize),
    /// A primitive of the same tree that is no triangle.
    Analytic(usize),
    /// An instance of the world.
    Instance(usize),
}

const INDEX_BITS: u32 = 30;

impl ChildRef {
    /// The root of a tree, and what stands in a slot without a child.
    pub const ROOT: Self = Self(0);

    /// # Panics
    /// If the index needs more than 30 bits: such a tree is larger than any memory.
    pub fn new(child: Child) -> Self {
        let (tag, index) = match child {
            Child::Node(index) => (0, index),
            Child::Block(index) => (1, index),
            Child::Analytic(index) => (2, index),
            Child::Instance(index) => (3, index),
        };
        assert!(index < 1 << INDEX_BITS, "more than 2^30 nodes or leaves");
        Self(tag << INDEX_BITS | index as u32)
    }

    /// What it is.
    #[inline(always)]
    pub fn get(self) -> Child {
        let index = (self.0 & ((1 << INDEX_BITS) - 1)) as usize;
        match self.0 >> INDEX_BITS {
            0 => Child::Node(index),
            1 => Child::Block(index),
            2 => Child::Analytic(index),
            _ => Child::Instance(index),
        }
    }
}

/// The planes of eight boxes: lower x, upper x, lower y, ... A slot without a box has them the wrong way round, which nothing
/// hits; they are finite so that interpolating them makes no NaN.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Planes(pub [[f32; WIDTH]; 6]);

impl Planes {
    const EMPTY: Self = Self([
        [f32::MAX; WIDTH],
        [f32::MIN; WIDTH],
        [f32::MAX; WIDTH],
        [f32::MIN; WIDTH],
        [f32::MAX; WIDTH],
        [f32::MIN; WIDTH],
    ]);

    /// Of at most eight boxes, each grown by its share of the [margin](MARGIN).
    pub fn new(boxes: impl Iterator<Item = Bounds3>) -> Self {
        let mut planes = Self::EMPTY;
        for (slot, bounds) in boxes.enumerate() {
            let bounds = grown(&bounds);
            for axis in 0..3 {
                planes.0[2 * axis][slot] = bounds.min[axis];
                planes.0[2 * axis + 1][slot] = bounds.max[axis];
            }
        }
        planes
    }

    /// Whether a slot has no box.
    #[inline(always)]
    pub fn is_empty(&self, slot: usize) -> bool {
        self.0[0][slot] == f32::MAX
    }

    /// Zeros, to be written over.
    #[inline(always)]
    pub fn scratch() -> Self {
        Self([[0.0; WIDTH]; 6])
    }

    /// Linear between two. The operations are those of [`TriangleMesh::triangle`](crate::geometry::TriangleMesh::triangle):
    /// rounding is monotonic, so a box around a vertex at both ends is around it in between, to the last bit.
    #[inline(always)]
    fn set_between(&mut self, start: &Self, end: &Self, fraction: f32) {
        for plane in 0..6 {
            for slot in 0..WIDTH {
                self.0[plane][slot] = start.0[plane][slot] * (1.0 - fraction) + end.0[plane][slot] * fraction;
            }
        }
    }
}

fn grown(bounds: &Bounds3) -> Bounds3 {
    let size = bounds.min.abs().max(bounds.max.abs());
    let margin = MARGIN * (size + Vec3::splat(size.max_element()));
    Bounds3 {
        min: bounds.min - margin,
        max: bounds.max + margin,
    }
}

/// A node whose children do not move.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct FixedNode {
    planes: Planes,
    children: [ChildRef; WIDTH],
}

/// A node over a time segment: its boxes move linearly.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct MovingNode {
    start: Planes,
    end: Planes,
    children: [ChildRef; WIDTH],
}

/// What the traversal asks of a node.
pub trait Node: Send + Sync {
    /// The boxes of its children.
    type Bounds: Copy + Send + Sync;

    /// A box around nothing.
    const NOTHING: Self::Bounds;

    /// A node of at most eight children.
    fn new(children: &[(ChildRef, Self::Bounds)]) -> Self;

    /// A box around both.
    fn union(a: Self::Bounds, b: Self::Bounds) -> Self::Bounds;

    /// The boxes of the children at a fraction of the time segment, which may be put into `scratch`.
    fn planes<'a>(&'a self, fraction: f32, scratch: &'a mut Planes) -> &'a Planes;

    /// The children.
    fn children(&self) -> &[ChildRef; WIDTH];
}

fn slots<B>(children: &[(ChildRef, B)]) -> [ChildRef; WIDTH] {
    std::array::from_fn(|slot| children.get(slot).map_or(ChildRef::ROOT, |child| child.0))
}

impl FixedNode {
    /// The boxes of the children.
    #[inline(always)]
    pub fn fixed_planes(&self) -> &Planes {
        &self.planes
    }
}

impl Node for FixedNode {
    type Bounds = Bounds3;

    const NOTHING: Bounds3 = Bounds3::EMPTY;

    fn new(children: &[(ChildRef, Bounds3)]) -> Self {
        Self {
            planes: Planes::new(children.iter().map(|child| child.1)),
            children: slots(children),
        }
    }

    fn union(a: Bounds3, b: Bounds3) -> Bounds3 {
        a.union(b)
    }

    #[inline(always)]
    fn planes<'a>(&'a self, _fraction: f32, _scratch: &'a mut Planes) -> &'a Planes {
        &self.planes
    }

    #[inline(always)]
    fn children(&self) -> &[ChildRef; WIDTH] {
        &self.children
    }
}

impl Node for MovingNode {
    /// At the start and at the end of the segment.
    type Bounds = [Bounds3; 2];

    const NOTHING: [Bounds3; 2] = [Bounds3::EMPTY; 2];

    fn new(children: &[(ChildRef, [Bounds3; 2])]) -> Self {
        Self {
            start: Planes::new(children.iter().map(|child| child.1[0])),
            end: Planes::new(children.iter().map(|child| child.1[1])),
            children: slots(children),
        }
    }

    fn union(a: [Bounds3; 2], b: [Bounds3; 2]) -> [Bounds3; 2] {
        [a[0].union(b[0]), a[1].union(b[1])]
    }

    #[inline(always)]
    fn planes<'a>(&'a self, fraction: f32, scratch: &'a mut Planes) -> &'a Planes {
        scratch.set_between(&self.start, &self.end, fraction);
        scratch
    }

    #[inline(always)]
    fn children(&self) -> &[ChildRef; WIDTH] {
        &self.children
    }
}
