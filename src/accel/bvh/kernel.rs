//! The two tests that a kernel does many at a time, and the portable kernel.

use super::Scene;
use super::leaf::{BlockIds, Corners, LANES};
use super::node::ChildRef;
use super::node::{Planes, WIDTH};
use super::query::Query;
use super::ray::{LocalRay, Slab};
use super::traverse::{self, Level, Walk};
use super::tree::FixedTree;
use super::triangle::{Shear, greatest, least};

/// Which of eight boxes a ray meets.
#[derive(Clone, Copy, Debug)]
pub struct BoxHits {
    /// A bit for each.
    pub mask: u32,
    /// Where it enters them; meaningless for those that it misses.
    pub entry: [f32; WIDTH],
}

/// Which of four triangles a ray meets.
#[derive(Clone, Copy, Debug)]
pub struct TriangleHits {
    /// A bit for each.
    pub mask: u32,
    /// Distances; meaningless for those that it misses.
    pub t: [f32; LANES],
}

/// A set of instructions to trace with. All kernels give the same bits.
pub trait Kernel: Copy + Send + Sync {
    /// Which of eight boxes a ray meets in [tnear, tfar].
    fn boxes(self, planes: &Planes, slab: &Slab, tnear: f32, tfar: f32) -> BoxHits;

    /// Which of four triangles whose mask shares a bit with `mask` a ray meets in `range`: (tnear, tfar].
    fn triangles(self, corners: &Corners, ids: &BlockIds, mask: u32, shear: &Shear, range: [f32; 2]) -> TriangleHits;

    /// Fetches a node or a block into the cache, if the processor will; `index` may be any number.
    fn prefetch<T>(self, items: &[T], index: usize);

    /// [`traverse::group`] compiled for this kernel.
    fn group<const ANY: bool>(
        self,
        scene: &Scene,
        level: &Level,
        ray: &LocalRay,
        query: &mut Query,
        stack: &mut [u64],
    ) -> bool;

    /// [`Walk::tree`] compiled for this kernel, through the tree of what does not move.
    fn fixed<const ANY: bool>(
        self,
        walk: &Walk<'_, Self>,
        tree: &FixedTree,
        start: ChildRef,
        ray: &LocalRay,
        query: &mut Query,
        stack: &mut [u64],
    ) -> bool;
}

/// Plain Rust, for any processor.
#[derive(Clone, Copy, Debug)]
pub struct Portable;

impl Kernel for Portable {
    #[inline(always)]
    fn boxes(self, planes: &Planes, slab: &Slab, tnear: f32, tfar: f32) -> BoxHits {
        let mut entry = [f32::NEG_INFINITY; WIDTH];
        let mut exit = [f32::INFINITY; WIDTH];
        for axis in 0..3 {
            let near = &planes.0[2 * axis + slab.negative[axis]];
            let far = &planes.0[2 * axis + 1 - slab.negative[axis]];
            for slot in 0..WIDTH {
                let enter = near[slot] * slab.near[axis][0] + slab.near[axis][1];
                entry[slot] = greatest(enter, entry[slot]);
                let leave = far[slot] * slab.far[axis][0] + slab.far[axis][1];
                exit[slot] = least(leave, exit[slot]);
            }
        }
        for slot in 0..WIDTH {
            entry[slot] = greatest(entry[slot], tnear);
            exit[slot] = least(exit[slot], tfar);
        }
        let hit = |mask, slot: usize| mask | u32::from(entry[slot] <= exit[slot]) << slot;
        BoxHits {
            mask: (0..WIDTH).fold(0, hit),
            entry,
        }
    }

    #[inline(always)]
    fn triangles(self, corners: &Corners, ids: &BlockIds, mask: u32, shear: &Shear, range: [f32; 2]) -> TriangleHits {
        let mut hits = TriangleHits {
            mask: 0,
            t: [0.0; LANES],
        };
        for lane in 0..LANES {
            if ids.mask[lane] & mask == 0 {
                continue;
            }
            if let Some(t) = shear.distance(&corners.lane(lane))
                && t > range[0]
                && t <= range[1]
            {
                hits.mask |= 1 << lane;
                hits.t[lane] = t;
            }
        }
        hits
    }

    #[inline(always)]
    fn prefetch<T>(self, _items: &[T], _index: usize) {}

    fn group<const ANY: bool>(
        self,
        scene: &Scene,
        level: &Level,
        ray: &LocalRay,
        query: &mut Query,
        stack: &mut [u64],
    ) -> bool {
        traverse::group::<Self, ANY>(self, scene, level, ray, query, stack)
    }

    fn fixed<const ANY: bool>(
        self,
        walk: &Walk<'_, Self>,
        tree: &FixedTree,
        start: ChildRef,
        ray: &LocalRay,
        query: &mut Query,
        stack: &mut [u64],
    ) -> bool {
        walk.tree::<_, _, ANY>(tree, start, 0.0, ray, query, stack)
    }
}
