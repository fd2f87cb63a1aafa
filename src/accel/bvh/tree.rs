//! Trees over the members of a group, and over the world.

use rayon::prelude::*;

use super::build::{self, BinaryNode, BuildParams, Leaf};
use super::collapse::collapse;
use super::item::{Item, half_area};
use super::leaf::{Block, FixedBlock, LANES, MovingBlock};
use super::node::{Child, ChildRef, FixedNode, MovingNode, Node, WIDTH};
use super::ploc;
use super::ray::MARGIN;
use super::spatial::Corners;
use crate::accel::BuildQuality;
use crate::geometry::{GeometryId, PrimitiveId, Shape, TriangleMesh, World};
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

/// The mesh of a geometry that is one.
pub fn mesh(world: &World, id: GeometryId) -> Option<&TriangleMesh> {
    match &world.geometry(id).shape {
        Shape::Mesh(mesh) => Some(mesh),
        _ => None,
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

/// The corners of the triangles of a tree.
struct Triangles<'a> {
    world: &'a World,
    names: &'a [(GeometryId, PrimitiveId)],
}

impl Corners for Triangles<'_> {
    fn corners(&self, index: u32) -> Option<[Vec3; 3]> {
        let &(geometry, primitive) = self.names.get(index as usize)?;
        mesh(self.world, geometry).map(|mesh| mesh.triangle(primitive.index(), 0.0))
    }
}

impl Triangles<'_> {
    /// A box around what is of a triangle in the box of a fragment, for rays: the triangle test moves a triangle by a part of its own
    /// coordinates, which nodes know of whole triangles only.
    fn fragment_bounds(&self, fragment: &Bounds3, index: u32) -> Bounds3 {
        let Some(whole) = self.corners(index).map(Bounds3::from_points) else {
            return *fragment;
        };
        if *fragment == whole {
            return whole;
        }
        let size = whole.min.abs().max(whole.max.abs());
        let margin = 2.0 * MARGIN * (size + Vec3::splat(size.max_element()));
        Bounds3 {
            min: (fragment.min - margin).max(whole.min),
            max: (fragment.max + margin).min(whole.max),
        }
    }
}

fn fixed_tree(
    world: &World,
    members: &[GeometryId],
    instances: &[Bounds3],
    quality: BuildQuality,
) -> Option<FixedTree> {
    let mut names = Vec::new();
    let mut analytic = Vec::new();
    let mut boxes = Vec::new();
    for &id in members {
        if let Shape::Mesh(mesh) = &world.geometry(id).shape
            && !mesh.is_moving()
        {
            let bounds = (0..mesh.triangle_count()).into_par_iter();
            boxes.par_extend(bounds.map(|i| mesh.triangle_bounds(i, 0)));
            names.extend((0..mesh.triangle_count()).map(|i| (id, PrimitiveId::from_index(i))));
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
    let first_instance = names.len() + analytic.len();
    let triangles = Triangles { world, names: &names };
    let Built { tree, bounds, items } = binary(boxes, names.len(), quality, Some(&triangles))?;

    let mut leaves = Vec::new();
    let nodes = collapse(&tree, &mut |leaf| {
        let items = &items[leaf.range()];
        let first = items[0].index() as usize;
        if first >= names.len() {
            let child = if first < first_instance {
                Child::Analytic(first - names.len())
            } else {
                Child::Instance(first - first_instance)
            };
            return (ChildRef::new(child), items[0].box4().bounds());
        }
        let bounds = items
            .iter()
            .map(|item| triangles.fragment_bounds(&item.box4().bounds(), item.index()))
            .fold(Bounds3::EMPTY, Bounds3::union);
        leaves.push(leaf);
        (ChildRef::new(Child::Block(leaves.len() - 1)), bounds)
    });
    // Blocks are the most of a tree: what is done with makes room for them.
    drop(tree);
    let in_no_block = (GeometryId(0), PrimitiveId(0));
    let name = |item: &Item| names.get(item.index() as usize).copied().unwrap_or(in_no_block);
    let ordered: Vec<_> = items.par_iter().map(name).collect();
    drop((items, names));
    let block = |leaf: &Leaf| {
        let triangles = &ordered[leaf.range()];
        let mut members = [triangles[0]; LANES];
        members[..triangles.len()].copy_from_slice(triangles);
        // Fragments of one triangle may share a leaf.
        members.sort_unstable_by_key(|(geometry, primitive)| (geometry.0, primitive.0));
        let mut count = 1;
        for i in 1..LANES {
            if members[i] != members[count - 1] {
                members[count] = members[i];
                count += 1;
            }
        }
        FixedBlock::new(world, &members[..count], 0)
    };
    Some(Tree {
        bounds,
        nodes,
        blocks: leaves.par_iter().with_min_len(256).map(block).collect(),
        analytic,
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
    let mut names = Vec::new();
    for &id in meshes {
        let count = mesh(world, id).map_or(0, TriangleMesh::triangle_count);
        names.extend((0..count).map(|i| (id, PrimitiveId::from_index(i))));
    }
    let shape = |segment: usize| {
        let middle = |name: &(GeometryId, PrimitiveId)| {
            let [a, b] = ends(world, *name, segment);
            Bounds3 {
                min: a.min * 0.5 + b.min * 0.5,
                max: a.max * 0.5 + b.max * 0.5,
            }
        };
        binary(names.iter().map(middle).collect(), names.len(), quality, None)
    };
    let shared = if quality == BuildQuality::High { None } else { shape(0) };
    let tree = |segment: usize| {
        let own = if shared.is_some() { None } else { shape(segment) };
        let built = shared.as_ref().or(own.as_ref())?;
        Some(moving_tree(world, &names, segment, built))
    };
    (0..segments).into_par_iter().filter_map(tree).collect()
}

/// The boxes of a triangle at both ends of a segment.
fn ends(world: &World, (id, primitive): (GeometryId, PrimitiveId), segment: usize) -> [Bounds3; 2] {
    let at = |step: usize| mesh(world, id).map_or(Bounds3::EMPTY, |mesh| mesh.triangle_bounds(primitive.index(), step));
    [at(segment), at(segment + 1)]
}

/// A tree of the shape of `tree` over the triangles as they are in a segment.
fn moving_tree(world: &World, names: &[(GeometryId, PrimitiveId)], segment: usize, built: &Built) -> MovingTree {
    let mut blocks = Vec::new();
    let nodes = collapse(&built.tree, &mut |leaf| {
        let items = &built.items[leaf.range()];
        let members: Vec<_> = items.iter().map(|item| names[item.index() as usize]).collect();
        blocks.push(MovingBlock::new(world, &members, segment));
        let bounds = members.iter().map(|&name| ends(world, name, segment));
        let bounds = bounds.fold([Bounds3::EMPTY; 2], MovingNode::union);
        (ChildRef::new(Child::Block(blocks.len() - 1)), bounds)
    });
    Tree {
        bounds: built.bounds,
        nodes,
        blocks,
        analytic: Vec::new(),
    }
}

/// A binary tree, a box around all that is in it, and the items, where its leaves say.
struct Built {
    tree: Vec<BinaryNode>,
    bounds: Bounds3,
    items: Vec<Item>,
}

/// A binary tree over boxes, the first `triangles` of which are those of triangles; `None` over nothing.
fn binary(
    boxes: Vec<Bounds3>,
    triangles: usize,
    quality: BuildQuality,
    corners: Option<&Triangles<'_>>,
) -> Option<Built> {
    // Indices are below 2^32: each box is of a primitive or an instance, whose own numbers are; a sum that is not is more than
    // memory holds.
    let mut items: Vec<Item> = boxes
        .into_par_iter()
        .enumerate()
        .map(|(index, bounds)| Item::new(&bounds, PrimitiveId::from_index(index).0))
        .collect();
    if items.is_empty() {
        return None;
    }
    let triangles = triangles as u32;
    if quality == BuildQuality::Low
        && let Some((tree, bounds)) = ploc::build(&mut items, triangles)
    {
        return Some(Built { tree, bounds, items });
    }
    let (bins, corners) = match quality {
        BuildQuality::Low | BuildQuality::Medium => (16, None),
        BuildQuality::High => (32, corners.map(|corners| corners as &dyn Corners)),
    };
    let params = BuildParams {
        bins,
        triangles,
        corners,
    };
    let (tree, bounds) = build::build(&mut items, &params);
    Some(Built { tree, bounds, items })
}
