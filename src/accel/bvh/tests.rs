//! Builds: the same trees on any number of threads, and every triangle in them.

use std::sync::Arc;

use super::few::Few;
use super::node::{Child, Node};
use super::tree::{FixedTree, GroupTrees};
use crate::accel::BuildQuality;
use crate::geometry::{Geometry, Shape, TriangleMesh, World, WorldBuilder};
use crate::math::Vec3;

const QUALITIES: [BuildQuality; 3] = [BuildQuality::Low, BuildQuality::Medium, BuildQuality::High];

/// Numbers in [0, 1).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1 << 24) as f32
    }

    fn point(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }
}

/// Triangles from corner to corner of a cube, among small ones; at `steps` times.
fn sticks(count: usize, steps: usize) -> TriangleMesh {
    let mut random = Random(7);
    let mut positions = vec![Vec::new(); steps];
    for i in 0..count {
        let [a, b] = if i % 3 == 0 {
            [0.2 * random.point(), Vec3::ONE - 0.2 * random.point()]
        } else {
            let a = random.point();
            [a, a + 0.01 * random.point()]
        };
        let c = b + 0.01 * random.point();
        for (step, positions) in positions.iter_mut().enumerate() {
            positions.extend([a, b, c].map(|p| p + 0.3 * step as f32 * Vec3::X));
        }
    }
    let indices = (0..count as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
    TriangleMesh::new(positions, indices.collect()).unwrap()
}

fn world(mesh: TriangleMesh) -> Arc<World> {
    let mut builder = WorldBuilder::default();
    let id = builder.add_geometry(Geometry::opaque(Shape::Mesh(mesh)));
    builder.root.geometries.push(id);
    Arc::new(builder.build().unwrap())
}

/// A cube from -`size` to `size`.
fn cube(size: f32) -> TriangleMesh {
    let corner = |i: u32| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * 2.0 - 1.0;
    let sides = [
        [0, 1, 3, 2],
        [4, 6, 7, 5],
        [0, 4, 5, 1],
        [2, 3, 7, 6],
        [0, 2, 6, 4],
        [1, 5, 7, 3],
    ];
    let triangles = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    TriangleMesh::new(vec![(0..8).map(|i| size * corner(i)).collect()], triangles.collect()).unwrap()
}

fn build(world: &World, quality: BuildQuality, threads: usize) -> GroupTrees {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| GroupTrees::build(world, world.root(), &[], quality))
}

#[test]
fn trees_have_the_same_bits_on_any_number_of_threads() {
    let bits = |trees: &GroupTrees| {
        let fixed = trees
            .fixed
            .as_ref()
            .map(|tree| format!("{:?} {:?}", tree.nodes, tree.blocks));
        let moving = trees.moving.iter().flat_map(|trees| &trees.segments);
        let moving: Vec<_> = moving
            .map(|tree| format!("{:?} {:?}", tree.nodes, tree.blocks))
            .collect();
        (fixed, moving)
    };
    for world in [world(sticks(30_000, 1)), world(sticks(6_000, 3))] {
        for quality in QUALITIES {
            let one = bits(&build(&world, quality, 1));
            for threads in [2, 5] {
                assert!(
                    one == bits(&build(&world, quality, threads)),
                    "{quality:?}, {threads} threads"
                );
            }
        }
    }
}

/// The primitives in the leaves below a node, each in the boxes of all nodes above it.
fn visit(tree: &FixedTree, node: usize, found: &mut Vec<u32>) {
    let planes = tree.nodes[node].fixed_planes();
    for (slot, child) in tree.nodes[node].children().iter().enumerate() {
        if planes.is_empty(slot) {
            continue;
        }
        match child.get() {
            Child::Node(index) => visit(tree, index, found),
            Child::Block(index) => {
                use super::leaf::Block;
                let ids = tree.blocks[index].ids();
                found.extend(
                    ids.primitive
                        .iter()
                        .zip(ids.mask)
                        .filter(|(_, mask)| *mask != 0)
                        .map(|(id, _)| *id),
                );
            }
            Child::Analytic(_) | Child::Instance(_) => {}
        }
    }
}

#[test]
fn every_triangle_is_in_the_tree_and_only_spatial_splits_repeat_them() {
    let count = 20_000;
    let world = world(sticks(count, 1));
    for quality in QUALITIES {
        let trees = build(&world, quality, 2);
        let mut found = Vec::new();
        visit(trees.fixed.as_ref().unwrap(), 0, &mut found);
        let all = found.len();
        found.sort_unstable();
        found.dedup();
        assert!(found.iter().copied().eq(0..count as u32), "{quality:?}");
        match quality {
            BuildQuality::High => assert!(all > count + count / 20 && all <= count + count / 3, "{all} fragments"),
            BuildQuality::Low | BuildQuality::Medium => assert_eq!(all, count),
        }
    }
}

#[test]
fn boxes_that_a_fast_build_cannot_order_have_trees_all_the_same() {
    let same = TriangleMesh::new(vec![vec![Vec3::ZERO, Vec3::X, Vec3::Y]], vec![[0, 1, 2]; 50_000]).unwrap();
    let spaced = |i: usize| Vec3::splat(2.0_f32.powi(i as i32 % 200 - 100));
    let positions = (0..6000).flat_map(|i| [spaced(i), spaced(i) * 1.01, spaced(i) * Vec3::new(1.0, 1.02, 1.0)]);
    let indices = (0..6000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
    let spaced = TriangleMesh::new(vec![positions.collect()], indices.collect()).unwrap();
    for mesh in [same, spaced] {
        let count = mesh.triangle_count() as u32;
        for quality in QUALITIES {
            let trees = build(&world(mesh.clone()), quality, 2);
            let mut found = Vec::new();
            visit(trees.fixed.as_ref().unwrap(), 0, &mut found);
            found.sort_unstable();
            found.dedup();
            assert_eq!(found.len() as u32, count, "{quality:?}");
        }
    }
}

#[test]
fn few_triangles_share_corners_edges_and_ends_of_boxes() {
    let few = Few::new(&world(cube(1.0))).unwrap();
    let counts = [few.corners.len(), few.edges.len(), few.facets.len()];
    assert_eq!(counts, [8, 18, 12]);
    assert_eq!(few.ends, [[-1.0, 1.0]; 3]);
    for facet in &few.facets {
        // Each edge leads from one corner of the triangle to another.
        let mut ends: Vec<u16> = facet
            .edges
            .iter()
            .flat_map(|&edge| few.edges[usize::from(edge)])
            .collect();
        ends.sort_unstable();
        assert!(ends.chunks(2).all(|pair| pair[0] == pair[1]), "{ends:?}");
    }
}

#[test]
fn worlds_of_several_masks_or_far_corners_or_many_triangles_are_not_few() {
    assert!(Few::new(&world(cube(1e14))).is_some());
    assert!(Few::new(&world(cube(1e16))).is_none());
    assert!(Few::new(&world(sticks(50, 1))).is_some());
    assert!(Few::new(&world(sticks(60, 1))).is_none());
    assert!(Few::new(&world(sticks(50, 2))).is_none());
    let of_masks = |masks: [u32; 2]| {
        let mut builder = WorldBuilder::default();
        for mask in masks {
            let id = builder.add_geometry(Geometry {
                mask,
                ..Geometry::opaque(Shape::Mesh(cube(1.0)))
            });
            builder.root.geometries.push(id);
        }
        Few::new(&builder.build().unwrap())
    };
    assert!(of_masks([2, 2]).is_some());
    assert!(of_masks([2, 3]).is_none());
}
