//! Whether the answer for a ray depends on the other rays of its packet: the truth of `is_mate_independent`.

use std::sync::Arc;

use super::EmbreeScene;
use super::tests::Random;
use crate::accel::{Accel, BuildOptions, RayKind};
use crate::geometry::{
    Geometry, Group, HitPacket, Instance, LANES, Ray, RayQueue, Shape, Sphere, TriangleMesh, WorldBuilder,
};
use crate::math::{AnimatedTransform, DAffine3, DQuat, DVec3, Vec3};

/// A closed sphere of quads, each in two triangles, on a grid that gives many rays through vertices and edges.
fn ball(rings: u32) -> TriangleMesh {
    let sectors = 2 * rings;
    let mut vertices = Vec::new();
    let mut indices = Vec::new();
    for ring in 0..=rings {
        let theta = std::f32::consts::PI * ring as f32 / rings as f32;
        for sector in 0..sectors {
            let phi = std::f32::consts::TAU * sector as f32 / sectors as f32;
            vertices.push(Vec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()));
        }
    }
    for ring in 0..rings {
        for sector in 0..sectors {
            let (a, b) = (ring * sectors + sector, ring * sectors + (sector + 1) % sectors);
            indices.extend([[a, a + sectors, b], [b, a + sectors, b + sectors]]);
        }
    }
    TriangleMesh::new(vec![vertices], indices).unwrap()
}

fn scene(robust: bool, compact: bool) -> EmbreeScene {
    let mut world = WorldBuilder::default();
    let mesh = world.add_geometry(Geometry::opaque(Shape::Mesh(ball(24))));
    let spheres = (0..20)
        .map(|i| Sphere::at(DVec3::new(f64::from(i) * 0.3 - 3.0, 1.5, 0.1), 0.2).unwrap())
        .collect();
    let spheres = world.add_geometry(Geometry::opaque(Shape::Spheres(spheres)));
    let group = world.add_group(Group {
        geometries: vec![mesh, spheres],
        instances: Vec::new(),
    });
    world.root.geometries = vec![mesh, spheres];
    for i in 0..3 {
        let shift = DVec3::new(2.5 * f64::from(i) - 2.5, 0.0, 2.5);
        let start = DAffine3::from_translation(shift);
        let end = DAffine3::from_rotation_translation(DQuat::from_rotation_y(0.3 * f64::from(i)), shift);
        world.root.instances.push(Instance {
            group,
            world_from_object: AnimatedTransform::new(start, end).unwrap(),
            mask: u32::MAX,
        });
    }
    let world = Arc::new(world.build().unwrap());
    let options = BuildOptions {
        robust,
        compact,
        ..BuildOptions::default()
    };
    EmbreeScene::build(&world, &options).unwrap()
}

/// The first half are aimed at vertices, edges and middles of triangles that follow each other, from one eye: packets of neighbours.
/// The others go anywhere.
fn rays(count: usize) -> Vec<Ray> {
    let mesh = ball(24);
    let mut random = Random(1);
    (0..count)
        .map(|i| {
            let mut ray = if i < count / 2 {
                let [a, b, c] = mesh.triangle(i / 4 % mesh.triangle_count(), 0.0);
                let target = match random.below(4) {
                    0 => a,
                    1 => 0.5 * (a + b),
                    2 => a + random.unit() * (c - a),
                    _ => (a + b + c) / 3.0,
                };
                let eye = Vec3::new(0.3, -3.0 - (i / 10_000) as f32, 0.7);
                // Every other round looks at the instance at time 0.
                let shift = (i / 4 / mesh.triangle_count() % 2) as f32;
                Ray::new(eye, target + Vec3::new(0.0, 0.0, 2.5 * shift) - eye, 0.0)
            } else {
                let origin = random.vector() * 6.0 - 3.0;
                Ray::new(origin, random.vector() * 2.0 - 1.0, random.unit())
            };
            if random.below(4) == 0 {
                ray.tfar = 1.5 * random.unit();
            }
            ray
        })
        .collect()
}

/// (geometry, primitive, instance, bits of t, occluded) for each ray, in the order of `rays`, traced in packets in that order.
fn trace(scene: &EmbreeScene, kind: RayKind, rays: &[Ray]) -> Vec<(u32, u32, u32, u32, bool)> {
    let mut queue: RayQueue = rays.iter().copied().collect();
    let packets = queue.packets_mut();
    let mut hits = vec![HitPacket::EMPTY; packets.len()];
    scene.intersect(kind, packets, &mut hits, None);
    scene.occluded(kind, packets, None);
    (0..rays.len())
        .map(|i| {
            let (hits, rays, lane) = (&hits[i / LANES], &packets[i / LANES], i % LANES);
            let t = hits.t[lane].to_bits();
            let ids = (hits.geometry[lane], hits.primitive[lane], hits.instance[lane]);
            (ids.0, ids.1, ids.2, t, rays.is_occluded(lane))
        })
        .collect()
}

/// How many of `count` rays get another answer among other mates.
fn differences(scene: &EmbreeScene, kind: RayKind, count: usize) -> usize {
    let rays = rays(count);
    let expected = trace(scene, kind, &rays);
    assert!(expected.iter().filter(|answer| answer.4).count() > count / 4);
    let mut random = Random(2);
    let mut order: Vec<usize> = (0..count).collect();
    let mut different = vec![false; count];
    for _ in 0..4 {
        for i in (1..count).rev() {
            order.swap(i, random.below(i + 1));
        }
        let shuffled: Vec<Ray> = order.iter().map(|&i| rays[i]).collect();
        for (&i, answer) in order.iter().zip(trace(scene, kind, &shuffled)) {
            different[i] |= answer != expected[i];
        }
    }
    different.iter().filter(|&&different| different).count()
}

#[test]
fn kinds_that_are_called_mate_independent_are() {
    for (robust, compact) in [(true, false), (false, false), (true, true)] {
        let scene = scene(robust, compact);
        for kind in RayKind::ALL.into_iter().filter(|&kind| scene.is_mate_independent(kind)) {
            assert_eq!(
                differences(&scene, kind, 60_000),
                0,
                "{kind:?}, robust: {robust}, compact: {compact}"
            );
        }
    }
}
