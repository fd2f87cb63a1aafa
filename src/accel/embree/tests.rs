//! What Embree finds, against what is there.

use std::sync::Arc;

use embree_sys as ffi;

use super::EmbreeScene;
use super::device::Device;
use super::scene;
use crate::accel::{Accel, BuildOptions, BuildQuality, HitFilter, RayKind};
use crate::error::Error;
use crate::geometry::{
    Geometry, GeometryId, Group, Hit, HitPacket, Instance, InstanceId, LANES, PrimitiveId, Ray, RayPacket, Shape,
    Sphere, TriangleMesh, World, WorldBuilder,
};
use crate::math::{AnimatedTransform, DAffine3, DQuat, DVec3, Vec3};

/// A small generator, the same on every machine.
pub struct Random(pub u64);

impl Random {
    /// Uniform in 0..n.
    pub fn below(&mut self, n: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (((self.0 >> 33) * n as u64) >> 31) as usize
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f32 {
        self.below(1 << 24) as f32 / (1 << 24) as f32
    }

    /// Uniform in the unit cube.
    pub fn vector(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit())
    }
}

/// The triangle (0,0,z) (1,0,z) (0,1,z) for each time step.
pub fn triangle(z: &[f32]) -> Geometry {
    let corners = |&z: &f32| vec![Vec3::new(0.0, 0.0, z), Vec3::new(1.0, 0.0, z), Vec3::new(0.0, 1.0, z)];
    let mesh = TriangleMesh::new(z.iter().map(corners).collect(), vec![[0, 1, 2]]).unwrap();
    Geometry::opaque(Shape::Mesh(mesh))
}

pub fn sphere(center: DVec3, radius: f64) -> Geometry {
    Geometry::opaque(Shape::Spheres(vec![Sphere::at(center, radius).unwrap()]))
}

/// A world of geometries in world space.
pub fn flat(geometries: impl IntoIterator<Item = Geometry>) -> Arc<World> {
    let mut world = WorldBuilder::default();
    for geometry in geometries {
        let id = world.add_geometry(geometry);
        world.root.geometries.push(id);
    }
    Arc::new(world.build().unwrap())
}

/// A world of one group, placed by each transform; geometry 0 is in no group, so that ids of Embree and of the world differ.
pub fn placed(geometry: Geometry, transforms: impl IntoIterator<Item = AnimatedTransform>) -> Arc<World> {
    let mut world = WorldBuilder::default();
    world.add_geometry(triangle(&[1e6]));
    let id = world.add_geometry(geometry);
    let group = world.add_group(Group {
        geometries: vec![id],
        instances: Vec::new(),
    });
    for world_from_object in transforms {
        world.root.instances.push(Instance {
            group,
            world_from_object,
            mask: 0b11,
        });
    }
    Arc::new(world.build().unwrap())
}

pub fn build(world: &Arc<World>) -> EmbreeScene {
    EmbreeScene::build(world, &BuildOptions::default()).unwrap()
}

/// What `ray` hits and at what distance, alone in a lane of a packet; every kind of ray, and occlusion, must say the same.
pub fn trace(scene: &EmbreeScene, ray: &Ray, filter: Option<&dyn HitFilter>) -> Option<(Hit, f32)> {
    let mut answers = RayKind::ALL.iter().enumerate().map(|(i, &kind)| {
        let lane = (i * 3 + 1) % LANES;
        let mut packets = [RayPacket::EMPTY];
        packets[0].set(lane, ray);
        let mut hits = [HitPacket::EMPTY];
        scene.intersect(kind, &packets, &mut hits, filter);
        scene.occluded(kind, &mut packets, filter);
        let found = hits[0].get(lane).map(|hit| (hit, hits[0].t[lane]));
        assert_eq!(packets[0].is_occluded(lane), found.is_some(), "{kind:?}");
        if found.is_none() {
            assert_eq!(hits[0].t[lane], ray.tfar, "{kind:?}");
        }
        found
    });
    let first = answers.next().unwrap();
    for answer in answers {
        assert_eq!(answer, first);
    }
    first
}

/// Down the z axis from z = 10 over (x, y).
pub fn down(x: f32, y: f32) -> Ray {
    Ray::new(Vec3::new(x, y, 10.0), Vec3::NEG_Z, 0.0)
}

pub fn hit(geometry: u32, primitive: u32, instance: Option<u32>) -> Hit {
    Hit {
        geometry: GeometryId(geometry),
        primitive: PrimitiveId(primitive),
        instance: instance.map(InstanceId),
    }
}

#[test]
fn a_triangle_is_hit_inside_and_within_the_segment() {
    for quality in [BuildQuality::Low, BuildQuality::Medium, BuildQuality::High] {
        for (robust, compact) in [(true, false), (false, false), (true, true)] {
            let options = BuildOptions {
                quality,
                robust,
                compact,
                threads: 2,
            };
            let scene = EmbreeScene::build(&flat([triangle(&[0.0])]), &options).unwrap();
            assert_eq!(trace(&scene, &down(0.25, 0.25), None), Some((hit(0, 0, None), 10.0)));
            assert_eq!(trace(&scene, &down(0.75, 0.75), None), None);
            let short = Ray {
                tfar: 9.5,
                ..down(0.25, 0.25)
            };
            assert_eq!(trace(&scene, &short, None), None);
            let late = Ray {
                tnear: 10.5,
                ..down(0.25, 0.25)
            };
            assert_eq!(trace(&scene, &late, None), None);
        }
    }
}

#[test]
fn distances_are_in_units_of_the_direction() {
    let scene = build(&flat([triangle(&[0.0])]));
    let ray = Ray::new(Vec3::new(0.25, 0.25, 10.0), Vec3::new(0.0, 0.0, -4.0), 0.0);
    assert_eq!(trace(&scene, &ray, None), Some((hit(0, 0, None), 2.5)));
}

#[test]
fn masks_hide_meshes_and_spheres() {
    let masked = |geometry: Geometry, mask| Geometry { mask, ..geometry };
    let scene = build(&flat([
        masked(triangle(&[4.0]), 0b01),
        masked(sphere(DVec3::ZERO, 2.0), 0b10),
        masked(triangle(&[-5.0]), 0),
    ]));
    let with = |mask| Ray {
        mask,
        ..down(0.0625, 0.0625)
    };
    assert_eq!(trace(&scene, &with(0b01), None), Some((hit(0, 0, None), 6.0)));
    assert_eq!(trace(&scene, &with(0b11), None), Some((hit(0, 0, None), 6.0)));
    assert_eq!(trace(&scene, &with(0b10), None).unwrap().0, hit(1, 0, None));
    assert_eq!(trace(&scene, &with(0b100), None), None);
}

#[test]
fn an_instance_has_a_mask_of_its_own() {
    let scene = build(&placed(triangle(&[0.0]), [AnimatedTransform::identity()]));
    let with = |mask| Ray {
        mask,
        ..down(0.25, 0.25)
    };
    assert_eq!(trace(&scene, &with(0b10), None).unwrap().0, hit(1, 0, Some(0)));
    assert_eq!(trace(&scene, &with(0b100), None), None);
}

#[test]
fn lanes_that_take_no_part_are_left_alone() {
    let scene = build(&flat([triangle(&[0.0])]));
    for kind in RayKind::ALL {
        for pattern in 0..=u8::MAX {
            let mut packets = [RayPacket::EMPTY; 2];
            let active = |lane: usize| pattern >> lane & 1 == 1;
            for lane in 0..LANES {
                // An inactive lane holds a ray that would hit, but for its segment.
                let mut ray = down(0.25, 0.25);
                if !active(lane) {
                    (ray.tnear, ray.tfar) = (20.0, 15.0);
                }
                packets[0].set(lane, &ray);
                packets[1].set(LANES - 1 - lane, &ray);
            }
            let mut hits = [HitPacket::EMPTY; 2];
            scene.intersect(kind, &packets, &mut hits, None);
            scene.occluded(kind, &mut packets, None);
            for lane in 0..LANES {
                for (packet, lane_there) in [(0, lane), (1, LANES - 1 - lane)] {
                    assert_eq!(hits[packet].is_hit(lane_there), active(lane));
                    let tfar = if active(lane) { f32::NEG_INFINITY } else { 15.0 };
                    assert_eq!(packets[packet].tfar[lane_there], tfar, "{kind:?} {pattern:b} {lane}");
                }
            }
        }
    }
}

#[test]
fn a_long_run_of_partial_packets_keeps_its_order() {
    let scene = build(&flat([triangle(&[0.0])]));
    let mut packets = vec![RayPacket::EMPTY; 200];
    let mut random = Random(3);
    let mut expected = Vec::new();
    for packet in &mut packets {
        for lane in 0..LANES {
            let (part, inside) = (random.below(3) > 0, random.below(2) == 0);
            if part {
                let at = if inside { 0.25 } else { 0.75 };
                packet.set(lane, &down(at, at));
            }
            expected.push((part, inside));
        }
    }
    for kind in RayKind::ALL {
        let mut traced = packets.clone();
        scene.occluded(kind, &mut traced, None);
        for (i, (part, inside)) in expected.iter().enumerate() {
            let tfar = match (part, inside) {
                (true, false) => f32::INFINITY,
                _ => f32::NEG_INFINITY,
            };
            assert_eq!(traced[i / LANES].tfar[i % LANES], tfar, "{kind:?} {i}");
        }
    }
}

#[test]
fn vertices_move_with_time() {
    let scene = build(&flat([triangle(&[0.0, 4.0, 2.0])]));
    for (time, z) in [(0.0, 0.0), (0.25, 2.0), (0.5, 4.0), (0.75, 3.0), (1.0, 2.0)] {
        let ray = Ray {
            time,
            ..down(0.25, 0.25)
        };
        let (_, t) = trace(&scene, &ray, None).unwrap();
        assert!((t - (10.0 - z)).abs() < 1e-5, "at {time}: {t}");
    }
}

#[test]
fn a_packet_has_a_time_for_each_lane() {
    let scene = build(&flat([triangle(&[0.0, 7.0])]));
    let mut packets = [RayPacket::EMPTY];
    for lane in 0..LANES {
        let ray = Ray {
            time: lane as f32 / 7.0,
            ..down(0.25, 0.25)
        };
        packets[0].set(lane, &ray);
    }
    for kind in RayKind::ALL {
        let mut hits = [HitPacket::EMPTY];
        scene.intersect(kind, &packets, &mut hits, None);
        for lane in 0..LANES {
            assert!((hits[0].t[lane] - (10.0 - lane as f32)).abs() < 1e-5, "{kind:?} {lane}");
        }
    }
}

#[test]
fn instances_are_told_apart() {
    let at = |x: f64| AnimatedTransform::fixed(DAffine3::from_translation(DVec3::new(x, 0.0, x))).unwrap();
    let scene = build(&placed(triangle(&[0.0]), [at(0.0), at(2.0), at(4.0)]));
    for (i, x) in [(0, 0.0), (1, 2.0), (2, 4.0)] {
        assert_eq!(
            trace(&scene, &down(x + 0.25, 0.25), None),
            Some((hit(1, 0, Some(i)), 10.0 - x))
        );
    }
}

#[test]
fn a_turning_instance_is_where_its_transform_says() {
    // A ball far out on an arm, which turns by 2.5 radians about z: a linear motion would miss it by more than its size.
    let start = DAffine3::from_translation(DVec3::new(0.0, 0.0, 1.0));
    let end = DAffine3::from_rotation_translation(DQuat::from_rotation_z(2.5), DVec3::new(0.0, 0.0, 1.0));
    let motion = AnimatedTransform::new(start, end).unwrap();
    let scene = build(&placed(sphere(DVec3::new(4.0, 0.0, 0.0), 0.5), [motion.clone()]));
    for i in 0..=50 {
        let time = i as f32 / 50.0;
        let center = motion.at(time).transform_point3(DVec3::new(4.0, 0.0, 0.0)).as_vec3();
        let ray = Ray {
            time,
            ..down(center.x, center.y)
        };
        let (found, t) = trace(&scene, &ray, None).unwrap();
        assert_eq!(found, hit(1, 0, Some(0)));
        assert!((t - 8.5).abs() < 1e-4, "at {time}: {t}");
        let missed = down(-center.x, -center.y);
        assert_eq!(trace(&scene, &Ray { time, ..missed }, None), None);
    }
}

#[test]
fn a_huge_sphere_is_met_exactly_from_inside() {
    // The walls of smallpt: radius 1e5, with the camera among them.
    let left = sphere(DVec3::new(1e5 + 1.0, 40.8, 81.6), 1e5);
    let right = sphere(DVec3::new(-1e5 + 99.0, 40.8, 81.6), 1e5);
    let scene = build(&flat([left, right]));
    let mut random = Random(4);
    let origin = Vec3::new(50.0, 52.0, 295.6);
    for _ in 0..1000 {
        let direction = random.vector() * 2.0 - 1.0;
        let ray = Ray::new(origin, direction, 0.0);
        let (o, d) = (origin.as_dvec3(), direction.as_dvec3());
        let expected = [1e5 + 1.0, -1e5 + 99.0]
            .iter()
            .flat_map(|&x| {
                // The quadratic in a frame where nothing cancels: doubles have 29 bits to spare here.
                let oc = o - DVec3::new(x, 40.8, 81.6);
                let (a, b, c) = (d.length_squared(), oc.dot(d), oc.length_squared() - 1e10);
                let root = (b * b - a * c).sqrt();
                [(-b - root) / a, (-b + root) / a]
            })
            .filter(|&t| t >= 0.0)
            .fold(f64::INFINITY, f64::min);
        let (_, t) = trace(&scene, &ray, None).unwrap();
        let error = (f64::from(t) - expected).abs();
        // One rounding to single precision, and what the plain quadratic loses.
        assert!(
            error <= expected * f64::from(f32::EPSILON) + 1e-7 / d.length(),
            "{t} {expected}"
        );
    }
}

#[test]
fn an_empty_world_is_missed() {
    let no_triangles = Geometry::opaque(Shape::Mesh(TriangleMesh::new(vec![vec![]], vec![]).unwrap()));
    let worlds = [
        flat([]),
        flat([no_triangles.clone(), Geometry::opaque(Shape::Spheres(Vec::new()))]),
        placed(no_triangles, [AnimatedTransform::identity()]),
    ];
    for world in worlds {
        assert_eq!(trace(&build(&world), &down(0.25, 0.25), None), None);
    }
    build(&flat([])).intersect(RayKind::Camera, &[], &mut [], None);
}

#[test]
fn what_embree_reports_is_an_error() {
    let device = Device::new(1).unwrap();
    assert!(device.check().is_ok());
    // SAFETY: a live device; Embree refuses the kind and returns null.
    let geometry = unsafe { ffi::rtcNewGeometry(device.handle(), 9999) };
    assert!(geometry.is_null());
    let first = device.check().expect_err("reported").to_string();
    assert!(first.starts_with("backend embree: "), "{first}");
    // SAFETY: a live device; a null geometry is a mistake that Embree reports. The first error stays.
    unsafe { ffi::rtcCommitGeometry(std::ptr::null_mut()) };
    assert_eq!(device.check().expect_err("reported").to_string(), first);
}

#[test]
fn too_many_time_steps_are_an_error() {
    let world = flat([triangle(&[0.0; 130])]);
    let error = EmbreeScene::build(&world, &BuildOptions::default()).err();
    assert!(
        matches!(error, Some(Error::Backend { backend: "embree", .. })),
        "{error:?}"
    );
}

#[test]
fn memory_is_counted_and_given_back() {
    let world = placed(triangle(&[0.0]), [AnimatedTransform::identity()]);
    let device = Device::new(1).unwrap();
    let scenes = scene::build(&world, &device, &BuildOptions::default()).unwrap();
    assert!(device.memory() > 0);
    drop(scenes);
    assert_eq!(device.memory(), 0);
    assert_eq!(Arc::strong_count(&device), 1);
    let info = build(&world).info();
    assert!(info.memory > 0);
    let (major, minor, patch) = ffi::VERSION;
    assert_eq!(info.version, format!("{major}.{minor}.{patch}"));
}
