//! What [`lucerna::accel::Accel`] promises besides the right answer.

use std::sync::Arc;

use lucerna::accel::brute::Brute;
use lucerna::accel::bvh::Bvh;
use lucerna::accel::{Accel, Backend, BuildOptions, BuildQuality, RayKind};
use lucerna::geometry::{
    Geometry, Group, HitPacket, Instance, LANES, Ray, RayPacket, RayQueue, Shape, TriangleMesh, World, WorldBuilder,
};
use lucerna::math::{AnimatedTransform, DAffine3, DVec3, Vec3};

use crate::rays::RayMaker;
use crate::rng::Rng;
use crate::{backends, intersect, is_full, occluded, worlds};

fn rays(world: &World, count: u32, seed: u64) -> Vec<Ray> {
    let (maker, rng) = (RayMaker::new(world), &mut Rng::new(seed));
    (0..count).map(|id| maker.ray(rng, id)).collect()
}

#[test]
fn lanes_that_take_no_part_are_passed_over_and_change_nothing() {
    for (name, world) in worlds::all() {
        let rays = rays(&world, 2000, 17);
        for (backend, accel) in backends(&world) {
            let whole = intersect(&*accel, &rays, None);
            let rng = &mut Rng::new(23);
            for (chunk, answers) in rays.chunks(LANES).zip(whole.chunks(LANES)) {
                let mut packet = RayPacket::EMPTY;
                let taken: Vec<bool> = chunk.iter().map(|_| rng.below(2) == 0).collect();
                for (lane, ray) in chunk.iter().enumerate().filter(|&(lane, _)| taken[lane]) {
                    packet.set(lane, ray);
                }
                // What a lane without a ray holds must not matter.
                for lane in (0..LANES).filter(|&lane| !taken.get(lane).is_some_and(|&t| t)) {
                    packet.org_x[lane] = f32::NAN;
                    packet.dir_z[lane] = f32::INFINITY;
                    packet.tfar[lane] = -1.0;
                }
                let mut hits = [HitPacket::EMPTY];
                accel.intersect(RayKind::Bounce, &[packet], &mut hits, None);
                for lane in 0..LANES {
                    if taken.get(lane).is_some_and(|&t| t) {
                        let answer = hits[0].get(lane).map(|hit| (hit, hits[0].t[lane]));
                        assert_eq!(Some(&answer), answers.get(lane), "{name}, {backend}, lane {lane}");
                    } else {
                        assert!(!hits[0].is_hit(lane));
                        assert_eq!(hits[0].t[lane], -1.0, "{name}, {backend}");
                    }
                }
                let mut occluded = [packet];
                accel.occluded(RayKind::Shadow, &mut occluded, None);
                for lane in (0..LANES).filter(|&lane| !taken.get(lane).is_some_and(|&t| t)) {
                    assert_eq!(occluded[0].tfar[lane], -1.0, "{name}, {backend}");
                }
            }
        }
    }
}

#[test]
fn a_miss_leaves_the_end_of_the_ray_and_occlusion_only_marks_it() {
    let world = worlds::of_mesh(worlds::cube());
    let ray = Ray {
        tfar: 0.75,
        ..Ray::new(Vec3::new(-2.0, 0.1, 0.2), Vec3::X, 0.0)
    };
    for (backend, accel) in backends(&world) {
        let longer = Ray { tfar: 1.5, ..ray };
        let mut queue: RayQueue = [ray, longer].into_iter().collect();
        let packets = queue.packets_mut();
        let mut hits = vec![HitPacket::EMPTY; 1];
        accel.intersect(RayKind::Camera, packets, &mut hits, None);
        assert!(!hits[0].is_hit(0) && hits[0].t[0] == 0.75, "{backend}");
        assert!(hits[0].is_hit(1) && hits[0].t[1] == 1.0, "{backend}");
        let before = packets[0];
        accel.occluded(RayKind::Shadow, packets, None);
        assert!(!packets[0].is_occluded(0) && packets[0].is_occluded(1), "{backend}");
        assert!(packets[0].tfar[0] == 0.75 && packets[0].org_x == before.org_x && packets[0].tnear == before.tnear);
    }
}

#[test]
fn an_answer_depends_on_its_packet_mates_only_where_a_backend_says_so() {
    for (name, world) in worlds::all() {
        let rays = rays(&world, 4000, 29);
        let rng = &mut Rng::new(31);
        let mut order: Vec<usize> = (0..rays.len()).collect();
        for i in (1..order.len()).rev() {
            order.swap(i, rng.below(i + 1));
        }
        let shuffled: Vec<Ray> = order.iter().map(|&i| rays[i]).collect();
        for (backend, accel) in backends(&world) {
            for kind in RayKind::ALL.into_iter().filter(|&kind| accel.is_mate_independent(kind)) {
                let trace = |rays: &[Ray]| {
                    let mut queue: RayQueue = rays.iter().copied().collect();
                    let packets = queue.packets_mut();
                    let mut hits = vec![HitPacket::EMPTY; packets.len()];
                    accel.intersect(kind, packets, &mut hits, None);
                    accel.occluded(kind, packets, None);
                    let answer = |i: usize| {
                        let (hits, lane) = (&hits[i / LANES], i % LANES);
                        (
                            hits.get(lane),
                            hits.t[lane].to_bits(),
                            packets[i / LANES].is_occluded(lane),
                        )
                    };
                    (0..rays.len()).map(answer).collect::<Vec<_>>()
                };
                let (straight, mixed) = (trace(&rays), trace(&shuffled));
                for (place, &i) in order.iter().enumerate() {
                    assert_eq!(mixed[place], straight[i], "{name}, {backend}, {kind:?}: {:?}", rays[i]);
                }
            }
        }
    }
}

#[test]
fn every_kernel_and_brute_force_give_the_same_bits() {
    for (name, world) in worlds::all().into_iter().chain(worlds::extreme()) {
        let rays = rays(&world, 8000, 37);
        let brute = intersect(&Brute::new(&world), &rays, None);
        let bits = |answers: &[Option<(lucerna::geometry::Hit, f32)>]| -> Vec<_> {
            answers.iter().map(|a| a.map(|(hit, t)| (hit, t.to_bits()))).collect()
        };
        for quality in [BuildQuality::Low, BuildQuality::Medium, BuildQuality::High] {
            let options = BuildOptions {
                quality,
                ..BuildOptions::default()
            };
            for (kernel, bvh) in Bvh::build(&world, &options).variants() {
                let nearest = intersect(&bvh, &rays, None);
                assert_eq!(bits(&nearest), bits(&brute), "{name}, {quality:?}, {kernel}");
                let any = occluded(&bvh, &rays, None);
                assert_eq!(
                    any,
                    brute.iter().map(Option::is_some).collect::<Vec<_>>(),
                    "{name}, {quality:?}, {kernel}"
                );
            }
        }
    }
}

/// Rays from one point through a small window, as a camera's: eight to a packet, some of which take no part.
fn camera_rays(world: &World, count: u32, seed: u64) -> Vec<Ray> {
    let (maker, rng) = (RayMaker::new(world), &mut Rng::new(seed));
    let mut rays = Vec::new();
    while rays.len() < count as usize {
        let first = maker.ray(rng, rays.len() as u32);
        let spread = [0.3, 1e-2, 1e-4][rng.below(3)] * first.direction.length();
        for _ in 0..64 {
            let mut ray = first;
            ray.direction += spread * rng.cube();
            ray.id = rays.len() as u32;
            if rng.below(10) == 0 || !ray.is_valid() {
                ray = Ray::INACTIVE;
            }
            rays.push(ray);
        }
    }
    rays
}

#[test]
fn a_million_rays_are_answered_alike_alone_and_together() {
    let worlds = worlds::all();
    let count = if is_full() { 100_000_000 } else { 1_000_000 } / worlds.len() as u32;
    let mut hits = 0;
    for (seed, (name, world)) in (0..).zip(&worlds) {
        // Spatial splits are what could make the order of visits matter.
        let options = BuildOptions {
            quality: [BuildQuality::High, BuildQuality::Medium][seed as usize % 2],
            ..BuildOptions::default()
        };
        let variants = Bvh::build(world, &options).variants();
        let Some(((_, portable), others)) = variants.split_last() else {
            continue;
        };
        for (batch, rays) in [
            rays(world, count / 2, 100 + seed),
            camera_rays(world, count / 2, 200 + seed),
        ]
        .iter()
        .enumerate()
        {
            let answers = |bvh: &Bvh, kind: RayKind| {
                let mut queue: RayQueue = rays.iter().copied().collect();
                let packets = queue.packets_mut();
                let mut hits = vec![HitPacket::EMPTY; packets.len()];
                bvh.intersect(kind, packets, &mut hits, None);
                bvh.occluded(RayKind::Shadow, packets, None);
                let answer = |i: usize| {
                    let (hits, lane) = (&hits[i / LANES], i % LANES);
                    (
                        hits.get(lane),
                        hits.t[lane].to_bits(),
                        packets[i / LANES].tfar[lane].to_bits(),
                    )
                };
                (0..rays.len()).map(answer).collect::<Vec<_>>()
            };
            let alone = answers(portable, RayKind::Bounce);
            hits += alone.iter().filter(|answer| answer.0.is_some()).count();
            for (kernel, bvh) in others {
                for kind in [RayKind::Camera, RayKind::Bounce] {
                    let together = answers(bvh, kind);
                    let differing = (0..rays.len()).filter(|&i| alone[i] != together[i]);
                    let differing: Vec<_> = differing.map(|i| (rays[i], alone[i], together[i])).collect();
                    assert!(
                        differing.is_empty(),
                        "{name}, {kernel}, {kind:?}, batch {batch}: {} differ, {:?}",
                        differing.len(),
                        differing[0]
                    );
                }
            }
        }
    }
    assert!(hits > count as usize, "{hits} hits");
}

#[test]
fn masks_of_geometries_and_instances_hide_them() {
    let rng = &mut Rng::new(41);
    let mut builder = WorldBuilder::default();
    let mut add = |shape: Shape, mask: u32| {
        let geometry = Geometry {
            mask,
            ..Geometry::opaque(shape)
        };
        builder.add_geometry(geometry)
    };
    let masks = [0b001, 0b010, 0b100, 0b011];
    let ids = [
        add(Shape::Mesh(worlds::soup(rng, 100, 0.4)), masks[0]),
        add(Shape::Mesh(worlds::soup(rng, 100, 0.4)), masks[1]),
        add(worlds::spheres(rng, 30), masks[2]),
        add(Shape::Mesh(worlds::soup(rng, 100, 0.4)), masks[3]),
    ];
    builder.root.geometries.extend([ids[0], ids[2]]);
    let group = builder.add_group(Group {
        geometries: vec![ids[1], ids[3]],
        instances: Vec::new(),
    });
    let instance_masks = [0b001, 0b110];
    for (i, mask) in instance_masks.into_iter().enumerate() {
        let world_from_object =
            AnimatedTransform::fixed(DAffine3::from_translation(DVec3::splat(0.3 * i as f64))).unwrap();
        builder.root.instances.push(Instance {
            group,
            world_from_object,
            mask,
        });
    }
    let world = Arc::new(builder.build().unwrap());
    let judge = lucerna::accel::judge::Judge::new(&world);
    let mut rays = rays(&world, 8000, 43);
    for ray in &mut rays {
        ray.mask = rng.below(8) as u32;
    }
    for (backend, accel) in backends(&world) {
        let (nearest, any) = (intersect(&*accel, &rays, None), occluded(&*accel, &rays, None));
        let mut seen = [0; 4];
        for (i, ray) in rays.iter().enumerate() {
            let verdict = judge.judge(ray, |_| true);
            assert!(
                verdict.allows(nearest[i]),
                "{backend}: {ray:?} {:?} {verdict:?}",
                nearest[i]
            );
            assert!(verdict.allows_occluded(any[i]), "{backend}: {ray:?}");
            if let Some((hit, _)) = nearest[i] {
                seen[hit.geometry.index()] += 1;
                assert_ne!(masks[hit.geometry.index()] & ray.mask, 0, "{backend}");
                if let Some(instance) = hit.instance {
                    assert_ne!(instance_masks[instance.index()] & ray.mask, 0, "{backend}");
                }
            }
        }
        assert!(seen.iter().all(|&count| count > 50), "{backend}: {seen:?}");
    }
}

#[test]
fn a_tree_does_not_depend_on_threads_and_its_quality_changes_no_answer() {
    let world = worlds::of_mesh(worlds::terrain(128, 0.1));
    let rays = rays(&world, 4000, 47);
    let build = |threads: usize, quality: BuildQuality| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let options = BuildOptions {
            quality,
            threads,
            ..BuildOptions::default()
        };
        pool.install(|| Bvh::build(&world, &options))
    };
    let reference = build(1, BuildQuality::Medium);
    assert_eq!(reference.info().backend, Backend::Bvh);
    let memory = reference.info().memory;
    assert!(
        (40..200).contains(&(memory / world.instanced_primitive_count() as usize)),
        "{memory} bytes"
    );
    assert_eq!(build(3, BuildQuality::Medium).info().memory, memory);
    let answers = intersect(&reference, &rays, None);
    for quality in [BuildQuality::Low, BuildQuality::High] {
        assert_eq!(answers, intersect(&build(2, quality), &rays, None), "{quality:?}");
    }
}

#[test]
fn few_spheres_are_for_our_bvh_where_it_tests_many_at_a_time() {
    let usual = BuildOptions::default();
    let rng = &mut Rng::new(11);
    let expect = |shapes: Vec<Shape>, backend: Backend| {
        assert_eq!(Backend::for_world(&worlds::of_shapes(shapes), &usual), backend);
    };
    let ours = if Bvh::variant_names().iter().any(|name| name.ends_with("exhaustive")) {
        Backend::Bvh
    } else {
        Backend::default()
    };
    expect(vec![worlds::moved_spheres(rng, 32)], ours);
    expect(vec![worlds::moved_spheres(rng, 12), Shape::Mesh(worlds::cube())], ours);
    expect(vec![Shape::Mesh(worlds::cube())], Backend::default());
    expect(vec![worlds::moved_spheres(rng, 33)], Backend::default());
    expect(vec![worlds::spheres(rng, 2)], ours);
    expect(vec![worlds::quadrics(rng, 2)], Backend::default());
    let unmoved: &dyn Fn(Vec3) -> Vec3 = &|p| p;
    let moving = worlds::moving(&worlds::cube(), &[unmoved, &|p| 2.0 * p]);
    expect(vec![Shape::Mesh(moving)], Backend::default());
    let world = worlds::of_shapes(vec![worlds::moved_spheres(rng, 2)]);
    for options in [
        BuildOptions { compact: true, ..usual },
        BuildOptions { robust: false, ..usual },
    ] {
        assert_eq!(Backend::for_world(&world, &options), Backend::default());
    }
}

#[test]
fn large_worlds_without_instances_are_for_our_bvh_unless_embree_alone_can_do_what_is_asked() {
    let world = |triangles: usize, instances: usize| {
        let positions = vec![vec![Vec3::ZERO, Vec3::X, Vec3::Y]];
        let mesh = TriangleMesh::new(positions, vec![[0, 1, 2]; triangles]).expect("indices are of vertices");
        let mut builder = WorldBuilder::default();
        let geometry = builder.add_geometry(Geometry::opaque(Shape::Mesh(mesh)));
        if instances == 0 {
            builder.root.geometries.push(geometry);
        } else {
            let group = builder.add_group(Group {
                geometries: vec![geometry],
                instances: Vec::new(),
            });
            builder.root.instances = vec![
                Instance {
                    group,
                    world_from_object: AnimatedTransform::fixed(DAffine3::IDENTITY).expect("it has an inverse"),
                    mask: u32::MAX,
                };
                instances
            ];
        }
        builder.build().expect("a world")
    };
    let usual = BuildOptions::default();
    let large = world(Backend::MANY, 0);
    assert_eq!(Backend::for_world(&large, &usual), Backend::Bvh);
    assert_eq!(
        Backend::for_world(&world(Backend::MANY - 1, 0), &usual),
        Backend::default()
    );
    assert_eq!(Backend::for_world(&world(Backend::MANY, 2), &usual), Backend::default());
    for options in [
        BuildOptions { compact: true, ..usual },
        BuildOptions { robust: false, ..usual },
    ] {
        assert_eq!(Backend::for_world(&large, &options), Backend::default());
    }
}
