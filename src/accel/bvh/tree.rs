//! Trees over the members of a group, and over the world.

use rayon::prelude::*;

use super::build::{self, BuildParams, Item};
use super::collapse::collapse;
use super::leaf::{Block, FixedBlock, MovingBlock};
use super::node::{Child, ChildRef, FixedNode, MovingNode, Node};
use crate::geometry::{GeometryId, PrimitiveId, Shape, TriangleMesh, World};
use crate::math::Bounds3;

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

impl<N, B> Tree<N, B> {
    fn memory(&self) -> usize {
        size_of_val(self.nodes.as_slice()) + size_of_val(self.blocks.as_slice()) + size_of_val(self.analytic.as_slice())
    }
}

/// The mesh of a geometry that is one.
pub fn mesh(world: &World, id: GeometryId) -> Option<&TriangleMesh> {
    match &world.geometry(id).shape {
        Shape::Mesh(mesh) => Some(mesh),
        _ => None,
    }
}

impl GroupTrees {
    /// Builds the trees over geometries and, at the top level, instances, whose boxes are given.
    pub fn build(world: &World, members: &[GeometryId], instances: &[Bounds3], bins: usize) -> Self {
        Self {
            fixed: fixed_tree(world, members, instances, bins),
            moving: moving_trees(world, members, bins),
        }
    }

    /// Bytes.
    pub fn memory(&self) -> usize {
        let moving = self.moving.iter().flat_map(|trees| &trees.segments);
        self.fixed.as_ref().map_or(0, Tree::memory) + moving.map(Tree::memory).sum::<usize>()
    }
}

fn fixed_tree(world: &World, members: &[GeometryId], instances: &[Bounds3], bins: usize) -> Option<FixedTree> {
    let mut triangles = Vec::new();
    let mut analytic = Vec::new();
    let mut boxes = Vec::new();
    for &id in members {
        if let Shape::Mesh(mesh) = &world.geometry(id).shape
            && !mesh.is_moving()
        {
            let bounds = (0..mesh.triangle_count()).into_par_iter();
            boxes.par_extend(bounds.map(|i| mesh.triangle_bounds(i, 0)));
            triangles.extend((0..mesh.triangle_count()).map(|i| (id, PrimitiveId::from_index(i))));
        }
    }
    for &id in members {
        let shape = &world.geometry(id).shape;
        if shape.is_analytic() {
            let bounds = (0..shape.primitive_count()).into_par_iter();
            boxes.par_extend(bounds.map(|i| shape.primitive_bounds(i)));
            analytic.extend((0..shape.primitive_count()).map(|i| (id, PrimitiveId::from_index(i))));
        }
    }
    boxes.extend_from_slice(instances);
    let first_instance = triangles.len() + analytic.len();
    let (tree, items) = binary(boxes, triangles.len(), bins)?;

    let mut blocks = Vec::new();
    let nodes = collapse(&tree, &mut |range| {
        let items = &items[range];
        let bounds = items.iter().fold(Bounds3::EMPTY, |b, item| b.union(item.bounds));
        let first = items[0].index as usize;
        let child = if first < triangles.len() {
            let members: Vec<_> = items.iter().map(|item| triangles[item.index as usize]).collect();
            blocks.push(FixedBlock::new(world, &members, 0));
            Child::Block(blocks.len() - 1)
        } else if first < first_instance {
            Child::Analytic(first - triangles.len())
        } else {
            Child::Instance(first - first_instance)
        };
        (ChildRef::new(child), bounds)
    });
    Some(Tree {
        bounds: tree.bounds,
        nodes,
        blocks,
        analytic,
    })
}

/// One set of trees for each number of time steps.
fn moving_trees(world: &World, members: &[GeometryId], bins: usize) -> Vec<MovingTrees> {
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
        let segments = (0..steps - 1).into_par_iter();
        Some(MovingTrees {
            sample: *meshes.first()?,
            segments: segments
                .filter_map(|segment| moving_tree(world, &meshes, segment, bins))
                .collect(),
        })
    };
    steps.into_iter().filter_map(of_steps).collect()
}

fn moving_tree(world: &World, meshes: &[GeometryId], segment: usize, bins: usize) -> Option<MovingTree> {
    let mut triangles = Vec::new();
    let mut ends = Vec::new();
    for &id in meshes {
        let Some(mesh) = mesh(world, id) else { continue };
        for i in 0..mesh.triangle_count() {
            triangles.push((id, PrimitiveId::from_index(i)));
            ends.push([mesh.triangle_bounds(i, segment), mesh.triangle_bounds(i, segment + 1)]);
        }
    }
    // The shape of the tree is that for the middle of the segment.
    let middle = |[a, b]: &[Bounds3; 2]| Bounds3 {
        min: a.min * 0.5 + b.min * 0.5,
        max: a.max * 0.5 + b.max * 0.5,
    };
    let (tree, items) = binary(ends.iter().map(middle).collect(), triangles.len(), bins)?;
    let mut blocks = Vec::new();
    let nodes = collapse(&tree, &mut |range| {
        let items = items[range].iter().map(|item| item.index as usize);
        let members: Vec<_> = items.clone().map(|i| triangles[i]).collect();
        blocks.push(MovingBlock::new(world, &members, segment));
        let bounds = items.map(|i| ends[i]).fold([Bounds3::EMPTY; 2], MovingNode::union);
        (ChildRef::new(Child::Block(blocks.len() - 1)), bounds)
    });
    Some(Tree {
        bounds: tree.bounds,
        nodes,
        blocks,
        analytic: Vec::new(),
    })
}

/// A binary tree over boxes, the first `triangles` of which are those of triangles; with the items in the order of its leaves.
fn binary(boxes: Vec<Bounds3>, triangles: usize, bins: usize) -> Option<(build::Binary, Vec<Item>)> {
    // Indices are below 2^32: each box is of a primitive or an instance, whose own numbers are; a sum that is not is more than
    // memory holds.
    let mut items: Vec<Item> = boxes
        .into_par_iter()
        .enumerate()
        .map(|(index, bounds)| Item {
            bounds,
            index: PrimitiveId::from_index(index).0,
        })
        .collect();
    if items.is_empty() {
        return None;
    }
    let params = BuildParams {
        bins,
        triangles: triangles as u32,
    };
    let tree = build::build(&mut items, &params);
    Some((tree, items))
}
