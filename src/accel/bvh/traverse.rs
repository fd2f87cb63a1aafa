//! The traversal: nearest children first, the others on a stack with their distances.

use super::Scene;
use super::kernel::{BoxHits, Kernel};
use super::leaf::{Block, Corners};
use super::node::{Child, ChildRef, Node, Planes, WIDTH};
use super::primitives::mesh;
use super::query::{Candidate, Query};
use super::ray::{Line, LocalRay};
use super::tree::{GroupTrees, Tree};
use crate::geometry::{HitPacket, InstanceId};

use super::build::MOST_LEVELS;

/// Entries of a stack of one tree: each level leaves at most seven children of its node on it.
pub const TREE_STACK: usize = MOST_LEVELS as usize * (WIDTH - 1) + 1;

/// Entries of a stack: an instance has a tree of its own.
pub const STACK: usize = 2 * TREE_STACK;

/// Which trees a ray is in.
#[derive(Clone, Copy)]
pub struct Level<'a> {
    /// The trees.
    pub trees: &'a GroupTrees,
    /// The instance they are seen through, or [`HitPacket::NONE`].
    pub instance: u32,
}

/// Traces a ray through the trees of a group: the nearest hit into `query`, or with `ANY` whether there is any.
#[inline(always)]
pub fn group<K: Kernel, const ANY: bool>(
    kernel: K,
    scene: &Scene,
    level: &Level,
    ray: &LocalRay,
    query: &mut Query,
    stack: &mut [u64],
) -> bool {
    let walk = Walk { kernel, scene, level };
    if let Some(tree) = &level.trees.fixed
        && walk.tree::<_, _, ANY>(tree, ChildRef::ROOT, 0.0, ray, query, stack)
    {
        return true;
    }
    for moving in &level.trees.moving {
        let (segment, fraction) = mesh(&scene.world, moving.sample).map_or((0, 0.0), |mesh| mesh.time_step(query.time));
        if let Some(tree) = moving.segments.get(segment)
            && walk.tree::<_, _, ANY>(tree, ChildRef::ROOT, fraction, ray, query, stack)
        {
            return true;
        }
    }
    false
}

/// What stays the same while rays go through a group.
#[derive(Clone, Copy)]
pub struct Walk<'a, K> {
    /// The instructions to trace with.
    pub kernel: K,
    /// The world.
    pub scene: &'a Scene,
    /// The group.
    pub level: &'a Level<'a>,
}

impl<K: Kernel> Walk<'_, K> {
    /// Traces a ray through what is below `start`; with `ANY`, says whether it hits something.
    #[inline(always)]
    pub fn tree<N: Node, B: Block, const ANY: bool>(
        &self,
        tree: &Tree<N, B>,
        start: ChildRef,
        fraction: f32,
        ray: &LocalRay,
        query: &mut Query,
        stack: &mut [u64],
    ) -> bool {
        let mut planes = Planes::scratch();
        let mut corners = Corners::scratch();
        let mut depth = 0;
        let mut current = start;
        loop {
            let found = match current.get() {
                Child::Node(index) => {
                    let node = &tree.nodes[index];
                    let planes = node.planes(fraction, &mut planes);
                    let hits = self.kernel.boxes(planes, &ray.slab, query.tnear, query.cull);
                    if hits.mask != 0 {
                        let children = node.children();
                        self.prefetch(tree, hits.mask, children);
                        current = push::<ANY>(&hits, children, stack, &mut depth);
                        continue;
                    }
                    false
                }
                Child::Block(index) => {
                    let block = &tree.blocks[index];
                    let corners = block.corners(fraction, &mut corners);
                    self.block::<_, ANY>(block, corners, ray, query)
                }
                Child::Analytic(_) | Child::Instance(_) => {
                    self.other::<_, _, ANY>(tree, current, ray.line(), query, &mut stack[depth..])
                }
            };
            if ANY && found {
                return true;
            }
            // The nearest of what is left, unless it begins behind the nearest hit.
            loop {
                if depth == 0 {
                    return false;
                }
                depth -= 1;
                let entry = stack[depth];
                if ANY || f32::from_bits((entry >> 32) as u32) <= query.cull {
                    current = ChildRef(entry as u32);
                    break;
                }
            }
        }
    }

    /// Fetches the children that are hit, while the order of them is found out.
    #[inline(always)]
    fn prefetch<N: Node, B: Block>(&self, tree: &Tree<N, B>, mask: u32, children: &[ChildRef; WIDTH]) {
        let mut rest = mask;
        while rest != 0 {
            match children[rest.trailing_zeros() as usize % WIDTH].get() {
                Child::Node(index) => self.kernel.prefetch(&tree.nodes, index),
                Child::Block(index) => self.kernel.prefetch(&tree.blocks, index),
                Child::Analytic(_) | Child::Instance(_) => {}
            }
            rest &= rest - 1;
        }
    }

    /// Fetches one child into the cache.
    #[inline(always)]
    pub fn fetch<N: Node, B: Block>(&self, tree: &Tree<N, B>, child: ChildRef) {
        match child.get() {
            Child::Node(index) => self.kernel.prefetch(&tree.nodes, index),
            Child::Block(index) => self.kernel.prefetch(&tree.blocks, index),
            Child::Analytic(_) | Child::Instance(_) => {}
        }
    }

    /// Tests a ray against the triangles of a block; says whether it hits one.
    #[inline(always)]
    pub fn block<B: Block, const ANY: bool>(
        &self,
        block: &B,
        corners: &Corners,
        ray: &LocalRay,
        query: &mut Query,
    ) -> bool {
        let ids = block.ids();
        let range = [query.tnear, query.tfar];
        let hits = self.kernel.triangles(corners, ids, query.mask, &ray.shear, range);
        let mut rest = hits.mask;
        let mut found = false;
        while rest != 0 {
            let lane = rest.trailing_zeros() as usize;
            rest &= rest - 1;
            let candidate = Candidate {
                t: hits.t[lane],
                geometry: ids.geometry[lane],
                primitive: ids.primitive[lane],
                instance: self.level.instance,
            };
            found |= query.offer(&candidate, || corners.barycentrics(lane, ray));
            if ANY && found {
                return true;
            }
        }
        found
    }

    /// Tests a ray against what is no node and no block of triangles; says whether it hits it.
    #[inline(always)]
    pub fn other<N: Node, B: Block, const ANY: bool>(
        &self,
        tree: &Tree<N, B>,
        child: ChildRef,
        line: Line,
        query: &mut Query,
        stack: &mut [u64],
    ) -> bool {
        match child.get() {
            Child::Node(_) | Child::Block(_) => false,
            Child::Analytic(index) => {
                let (geometry, primitive) = tree.analytic[index];
                self.analytic(geometry.0, primitive.0, line, query)
            }
            Child::Instance(index) => self.instance::<ANY>(index, line, query, stack),
        }
    }

    #[inline(never)]
    fn analytic(&self, geometry: u32, primitive: u32, line: Line, query: &mut Query) -> bool {
        let member = &self.scene.world.geometries()[geometry as usize];
        if member.mask & query.mask == 0 {
            return false;
        }
        let candidate = |t| Candidate {
            t,
            geometry,
            primitive,
            instance: self.level.instance,
        };
        query.offer_analytic(&member.shape, primitive as usize, line, candidate)
    }

    #[inline(never)]
    fn instance<const ANY: bool>(&self, index: usize, line: Line, query: &mut Query, stack: &mut [u64]) -> bool {
        let id = InstanceId::from_index(index);
        let instance = self.scene.world.instance(id);
        if instance.mask & query.mask == 0 {
            return false;
        }
        let object_from_world = instance.world_from_object.inverse_at(query.time);
        let origin = object_from_world.transform_point3(line.origin.as_dvec3());
        let direction = object_from_world.transform_vector3(line.direction.as_dvec3());
        let ray = LocalRay::new(origin.as_vec3(), direction.as_vec3());
        let level = Level {
            trees: &self.scene.groups[instance.group.index()],
            instance: id.0,
        };
        debug_assert_eq!(self.level.instance, HitPacket::NONE);
        self.kernel.group::<ANY>(self.scene, &level, &ray, query, stack)
    }
}

/// Puts all children that are hit but one on the stack and returns that one: the nearest, or with `ANY` any. The entries come
/// off the stack nearest first.
#[inline(always)]
pub fn push<const ANY: bool>(
    hits: &BoxHits,
    children: &[ChildRef; WIDTH],
    stack: &mut [u64],
    depth: &mut usize,
) -> ChildRef {
    let mut rest = hits.mask;
    let mut take = || {
        let slot = rest.trailing_zeros() as usize % WIDTH;
        rest &= rest - 1;
        // Distances are not negative: their bits have the order of their values.
        let entry = u64::from(hits.entry[slot].to_bits()) << 32 | u64::from(children[slot].0);
        (entry, rest == 0)
    };
    let (a, last) = take();
    if last {
        return ChildRef(a as u32);
    }
    let (b, last) = take();
    let (mut nearest, b) = in_order(a, b);
    // The farthest is the lowest on the stack.
    stack[*depth] = b;
    *depth += 1;
    if last {
        return ChildRef(nearest as u32);
    }
    let (c, mut last) = take();
    let c = take_nearer(&mut nearest, c);
    let (b, c) = in_order(b, c);
    stack[*depth - 1] = c;
    stack[*depth] = b;
    *depth += 1;
    let first = *depth - 2;
    while !last {
        let entry;
        (entry, last) = take();
        let far = take_nearer(&mut nearest, entry);
        let mut place = *depth;
        while !ANY && place > first && stack[place - 1] < far {
            stack[place] = stack[place - 1];
            place -= 1;
        }
        stack[place] = far;
        *depth += 1;
    }
    ChildRef(nearest as u32)
}

#[inline(always)]
fn in_order(a: u64, b: u64) -> (u64, u64) {
    (a.min(b), a.max(b))
}

/// Makes `nearest` the nearer of the two and returns the other.
#[inline(always)]
fn take_nearer(nearest: &mut u64, entry: u64) -> u64 {
    let far;
    (*nearest, far) = in_order(*nearest, entry);
    far
}
