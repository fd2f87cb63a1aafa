//! Trees over the members of a group, and over the world.

use rayon::prelude::*;

use super::build::{self, BuildParams, Built, Leaf};
use super::collapse::collapse;
use super::item::{Item, half_area};
use super::leaf::{Block, FixedBlock, LANES, MovingBlock};
use super::linear;
use super::node::{Child, FixedNode, MovingNode, Node, WIDTH};
use super::pages::vec_in_large_pages;
use super::primitives::{self, Fixed, Moving, Primitives, Triangles, mesh};
use super::ray::MARGIN;
use super::topology::Topology;
use crate::accel::BuildQuality;
use crate::geometry::{GeometryId, PrimitiveId, TriangleMesh, World};
use crate::math::{Bounds3, Vec3};

/// A tree of 8-wide nodes; the root is the first.
pub struct Tree<N, B> {
    /// A box around all that does not move, and the middle of what does.
    pub bounds: Bounds3,
    /// Nodes.
    pub nodes: Vec<N>,
    /// Leaves of triangles.
    pub blocks: Vec<B>,
    /// Leaves of one primitive each, those that are no triangles.
    pub analytic: Vec<(GeometryId, PrimitiveId)>,
}

/// A tree of what does not move: triangles, other primitives, and instances by the box of all that they sweep.
pub type FixedTree = Tree<FixedNode, FixedBlock>;

/// A tree of triangles whose vertices move, over one segment of time.
pub type MovingTree = Tree<MovingNode, MovingBlock>;

/// Meshes that have their time steps in common: a tree for each segment between two steps.
pub struct MovingTrees {
    /// One of the meshes, which knows the segment of a time.
    pub sample: GeometryId,
    /// By segment.
    pub segments: Vec<MovingTree>,
}

/// The trees over the members of a group, or over the top level of the world.
pub struct GroupTrees {
    /// What does not move; `None` if there is nothing.
    pub fixed: Option<FixedTree>,
    /// What does.
    pub moving: Vec<MovingTrees>,
}

impl FixedTree {
    /// How many nodes a ray that meets the root's box meets on average, if nothing stops it and it comes from anywhere: the surface area
    /// heuristic.
    pub fn expected_nodes(&self) -> f64 {
        let of_node = |node: &FixedNode| -> f64 {
            let planes = &node.fixed_planes().0;
            let inner =
                (0..WIDTH).filter(|&slot| matches!(node.children()[slot].get(), Child::Node(index) if index > 0));
            inner
                .map(|slot| {
                    let corner = |side: usize| Vec3::from_array([0, 2, 4].map(|row| planes[row + side][slot]));
                    half_area(&Bounds3 {
                        min: corner(0),
                        max: corner(1),
                    })
                })
                .sum()
        };
        1.0 + self.nodes.iter().map(of_node).sum::<f64>() / half_area(&self.bounds)
    }
}

impl<N, B> Tree<N, B> {
    fn memory(&self) -> usize {
        size_of_val(self.nodes.as_slice()) + size_of_val(self.blocks.as_slice()) + size_of_val(self.analytic.as_slice())
    }
}

impl GroupTrees {
    /// Builds the trees over geometries and, at the top level, instances, whose boxes are given.
    pub fn build(world: &World, members: &[GeometryId], instances: &[Bounds3], quality: BuildQuality) -> Self {
        Self {
            fixed: fixed_tree(world, members, instances, quality),
            moving: moving_trees(world, members, quality),
        }
    }

    /// Bytes.
    pub fn memory(&self) -> usize {
        let moving = self.moving.iter().flat_map(|trees| &trees.segments);
        self.fixed.as_ref().map_or(0, Tree::memory) + moving.map(Tree::memory).sum::<usize>()
    }
}

/// What holds triangles, other primitives and instances together.
struct Shape {
    topology: Topology,
    /// The names of what is in the leaves, where they say.
    order: Vec<u32>,
}

impl Shape {
    /// Over primitives, with the items that it was made of, if it was, in the order of the leaves; `None` over nothing.
    fn new<P: Primitives>(primitives: &P, quality: BuildQuality) -> Option<(Self, Vec<Item>)> {
        let census = primitives.census();
        if census.count() == 0 {
            return None;
        }
        let params = match quality {
            BuildQuality::Low => {
                let (topology, order) = linear::build(primitives);
                return Some((Self { topology, order }, Vec::new()));
            }
            BuildQuality::Medium => BuildParams {
                bins: 16,
                splits: false,
            },
            BuildQuality::High => BuildParams {
                bins: 32,
                splits: P::SPLITS,
            },
        };
        let Built { tree, items } = build::build(primitives, params);
        let analytic = |leaf: Leaf| {
            let index = items[leaf.range().start].index();
            (index >= census.triangles).then(|| census.child(index))
        };
        let topology = collapse(&tree, &analytic);
        let order = items.par_iter().map(Item::index).collect();
        Some((Self { topology, order }, items))
    }

    /// Boxes around the leaves of triangles, by the items in them.
    fn leaf_bounds(&self, items: &[Item], primitives: &impl Primitives) -> Vec<Bounds3> {
        let of_item = |item: &Item| {
            item.whole().unwrap_or_else(|| match primitives.corners(item.index()) {
                Some(corners) if item.is_fragment() => fragment_bounds(&item.box4().bounds(), corners),
                _ => primitives.bounds(item.index()),
            })
        };
        let of_leaf = |leaf: &Leaf| {
            let boxes = items[leaf.range()].iter().map(of_item);
            boxes.fold(Bounds3::EMPTY, Bounds3::union)
        };
        self.topology.blocks.par_iter().with_min_len(256).map(of_leaf).collect()
    }

    /// The block of a leaf.
    #[inline(always)]
    fn block<B: Block>(&self, leaf: &Leaf, world: &World, triangles: &Triangles<'_>, step: usize) -> B {
        let in_leaf = &self.order[leaf.range()];
        let mut indices = [in_leaf[0]; LANES];
        indices[..in_leaf.len()].copy_from_slice(in_leaf);
        sort(&mut indices);
        // Fragments of one triangle may share a leaf.
        let mut members = [triangles.find(indices[0]); LANES];
        let mut count = 1;
        for i in 1..LANES {
            if indices[i] != indices[i - 1] {
                members[count] = triangles.find(indices[i]);
                count += 1;
            }
        }
        B::new(world, &members[..count], step)
    }

    /// The blocks of its leaves.
    fn blocks<B: Block>(&self, world: &World, triangles: &Triangles<'_>) -> Vec<B> {
        let leaves = self.topology.blocks.par_iter().with_min_len(256);
        let mut blocks = vec_in_large_pages(leaves.len());
        leaves
            .map(|leaf| self.block(leaf, world, triangles, 0))
            .collect_into_vec(&mut blocks);
        blocks
    }

    /// The same from a time step on, and boxes around them.
    fn blocks_and_bounds<B: Block>(
        &self,
        world: &World,
        triangles: &Triangles<'_>,
        step: usize,
    ) -> (Vec<B>, Vec<B::Bounds>) {
        let leaves = self.topology.blocks.par_iter().with_min_len(256);
        let mut blocks = vec_in_large_pages(leaves.len());
        let mut bounds = vec_in_large_pages(leaves.len());
        bounds.resize(leaves.len(), B::NOTHING);
        let block = |(leaf, bounds): (&Leaf, &mut B::Bounds)| {
            let block: B = self.block(leaf, world, triangles, step);
            *bounds = block.bounds();
            block
        };
        leaves.zip(&mut bounds).map(block).collect_into_vec(&mut blocks);
        (blocks, bounds)
    }
}

/// Sorts four numbers without a branch, which in so short a list could not be predicted.
#[inline(always)]
fn sort(numbers: &mut [u32; LANES]) {
    for (i, j) in [(0, 1), (2, 3), (0, 2), (1, 3), (1, 2)] {
        let (a, b) = (numbers[i], numbers[j]);
        (numbers[i], numbers[j]) = (a.min(b), a.max(b));
    }
}

/// A box around what is of a triangle in the box of a fragment, for rays: the triangle test moves a triangle by a part of its own
/// coordinates, which nodes know of whole triangles only.
fn fragment_bounds(fragment: &Bounds3, corners: [Vec3; 3]) -> Bounds3 {
    let whole = Bounds3::from_points(corners);
    let size = whole.min.abs().max(whole.max.abs());
    let margin = 2.0 * MARGIN * (size + Vec3::splat(size.max_element()));
    Bounds3 {
        min: (fragment.min - margin).max(whole.min),
        max: (fragment.max + margin).min(whole.max),
    }
}

fn fixed_tree(
    world: &World,
    members: &[GeometryId],
    instances: &[Bounds3],
    quality: BuildQuality,
) -> Option<FixedTree> {
    let fixed = Fixed::new(world, members, instances);
    let (shape, items) = Shape::new(&fixed, quality)?;
    let fit = |topology: &Topology, blocks: &[Bounds3]| {
        topology.fit(|leaf| match leaf {
            Child::Block(index) => blocks[index],
            other => fixed.leaf_bounds(other),
        })
    };
    let ((nodes, bounds), blocks) = if items.is_empty() {
        let (blocks, bounds) = shape.blocks_and_bounds(world, &fixed.triangles, 0);
        (fit(&shape.topology, &bounds), blocks)
    } else {
        let nodes = fit(&shape.topology, &shape.leaf_bounds(&items, &fixed));
        // Blocks are the most of a tree: what is done with makes room for them.
        drop(items);
        (nodes, shape.blocks(world, &fixed.triangles))
    };
    Some(Tree {
        bounds,
        nodes,
        blocks,
        analytic: fixed.analytic,
    })
}

/// One set of trees for each number of time steps.
fn moving_trees(world: &World, members: &[GeometryId], quality: BuildQuality) -> Vec<MovingTrees> {
    let mut steps: Vec<usize> = members
        .iter()
        .filter_map(|&id| mesh(world, id))
        .filter(|mesh| mesh.is_moving() && mesh.triangle_count() > 0)
        .map(TriangleMesh::time_steps)
        .collect();
    steps.sort_unstable();
    steps.dedup();
    let of_steps = |steps: usize| {
        let has_steps = |id: &GeometryId| mesh(world, *id).is_some_and(|mesh| mesh.time_steps() == steps);
        let meshes: Vec<GeometryId> = members.iter().copied().filter(has_steps).collect();
        Some(MovingTrees {
            sample: *meshes.first()?,
            segments: segment_trees(world, &meshes, steps - 1, quality),
        })
    };
    steps.into_iter().filter_map(of_steps).collect()
}

/// A tree for each segment of time. Those of high quality are built one by one; of others the shape is that of the first, refitted
/// to where the triangles are in each.
fn segment_trees(world: &World, meshes: &[GeometryId], segments: usize, quality: BuildQuality) -> Vec<MovingTree> {
    let triangles = Triangles::new(world, meshes, TriangleMesh::is_moving);
    let shape = |segment: usize| {
        let moving = Moving {
            triangles: &triangles,
            segment,
        };
        Shape::new(&moving, quality).map(|(shape, _)| shape)
    };
    let shared = if quality == BuildQuality::High { None } else { shape(0) };
    let tree = |segment: usize| {
        let own = if shared.is_some() { None } else { shape(segment) };
        let shape = shared.as_ref().or(own.as_ref())?;
        let (blocks, bounds) = shape.blocks_and_bounds::<MovingBlock>(world, &triangles, segment);
        let (nodes, [start, end]) = shape.topology.fit(|leaf| match leaf {
            Child::Block(index) => bounds[index],
            _ => MovingNode::NOTHING,
        });
        Some(Tree {
            bounds: primitives::between(start, end),
            nodes,
            blocks,
            analytic: Vec::new(),
        })
    };
    (0..segments).into_par_iter().filter_map(tree).collect()
}
