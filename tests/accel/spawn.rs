//! Rays that leave a surface do not meet the primitive they leave.

use std::sync::Arc;

use lucerna::geometry::{CurveKind, Ray, Shape, Sphere, TriangleMesh, World};
use lucerna::math::{AnimatedTransform, DVec3, Vec2, Vec3};

use crate::rng::Rng;
use crate::{backends, intersect, worlds};

/// Triangles of all sizes and places, some parallel to axes, some slivers.
fn triangles(rng: &mut Rng) -> TriangleMesh {
    let mut positions = Vec::new();
    for i in 0..600 {
        let size = 10.0_f32.powf(rng.range(-4.0, 3.0));
        let mut center = rng.cube() * 10.0_f32.powf(rng.range(-2.0, 3.0));
        let mut shape = Vec3::ONE;
        match i % 4 {
            0 => shape[rng.below(3)] = 0.0,
            1 => shape[rng.below(3)] = 1e-3,
            2 => {
                // In a plane of the axes.
                let axis = rng.below(3);
                shape[axis] = 0.0;
                center[axis] = 0.0;
            }
            _ => {}
        }
        positions.extend((0..3).map(|_| center + size * shape * rng.cube()));
    }
    let indices = (0..600).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    TriangleMesh::new(vec![positions], indices).unwrap()
}

fn all(rng: &mut Rng) -> Vec<(&'static str, Arc<World>)> {
    let sphere = |rng: &mut Rng| {
        let radius = 10.0_f64.powf(f64::from(rng.range(-3.0, 5.0)));
        Sphere::at((10.0 * rng.cube()).as_dvec3(), radius).unwrap()
    };
    let fixed = |rng: &mut Rng| {
        let scale = 10.0_f64.powf(f64::from(rng.range(-2.0, 2.0)));
        AnimatedTransform::fixed(worlds::place(rng, scale, 100.0)).unwrap()
    };
    let moving = AnimatedTransform::new(worlds::place(rng, 1.0, 3.0), worlds::place(rng, 1.3, 3.0)).unwrap();
    vec![
        ("triangles", worlds::of_mesh(triangles(rng))),
        (
            "spheres",
            worlds::of_shapes(vec![Shape::Spheres((0..300).map(|_| sphere(rng)).collect())]),
        ),
        (
            "instanced triangles",
            worlds::instanced(vec![Shape::Mesh(triangles(rng))], [fixed(rng), fixed(rng)]),
        ),
        (
            "instanced spheres",
            worlds::instanced(
                vec![Shape::Spheres(vec![
                    Sphere::at(DVec3::ZERO, 1.0).unwrap(),
                    Sphere::at(DVec3::new(5.0, 0.0, 0.0), 0.1).unwrap(),
                ])],
                (0..20).map(|_| fixed(rng)).collect::<Vec<_>>(),
            ),
        ),
        ("quadrics", worlds::of_shapes(vec![worlds::quadrics(rng, 300)])),
        ("patches", worlds::of_shapes(vec![worlds::patches(rng, 300)])),
        (
            "curves",
            worlds::of_shapes(vec![worlds::curves(rng, 100, CurveKind::Flat)]),
        ),
        (
            "round curves",
            worlds::of_shapes(vec![worlds::curves(rng, 100, CurveKind::Cylinder)]),
        ),
        (
            "instanced quadrics",
            worlds::instanced(vec![worlds::quadrics(rng, 20)], [fixed(rng), fixed(rng), fixed(rng)]),
        ),
        (
            "moving triangles",
            worlds::instanced(vec![Shape::Mesh(triangles(rng))], [moving]),
        ),
        ("tubes", worlds::of_shapes(vec![worlds::tubes(rng, 200)])),
        (
            "instanced tubes",
            worlds::instanced(vec![worlds::tubes(rng, 20)], [fixed(rng), fixed(rng)]),
        ),
    ]
}

/// A ray towards a random point of a random primitive, which it may or may not reach.
fn towards(world: &World, rng: &mut Rng) -> Ray {
    let instance = (!world.instances().is_empty()).then(|| &world.instances()[rng.below(world.instances().len())]);
    let members = instance.map_or(world.root(), |instance| &world.groups()[instance.group.index()]);
    let time = rng.unit();
    let (target, size) = match &world.geometry(members[0]).shape {
        Shape::Mesh(mesh) => {
            let [a, b, c] = mesh
                .triangle(rng.below(mesh.triangle_count()), time)
                .map(Vec3::as_dvec3);
            let (u, v) = (f64::from(rng.unit()), f64::from(rng.unit()));
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            (a + (b - a) * u + (c - a) * v, (b - a).length())
        }
        Shape::Spheres(spheres) => {
            let sphere = &spheres[rng.below(spheres.len())];
            let on = rng.direction().as_dvec3() * sphere.radius();
            (sphere.world_from_object().transform_point3(on), sphere.radius())
        }
        Shape::Quadrics(quadrics) => {
            let quadric = &quadrics[rng.below(quadrics.len())];
            let u = Vec2::new(rng.unit(), rng.unit());
            (quadric.sample(u).p, f64::from(quadric.bounds().extent().length()))
        }
        Shape::Curves(curves) => {
            let [a, b, c, d] = curves.segments()[rng.below(curves.segments().len())].points;
            let on = (a + 3.0 * b + 3.0 * c + d) * 0.125 + 0.01 * rng.cube();
            (on.as_dvec3(), 0.1)
        }
        Shape::Tubes(tubes) => {
            let piece = &tubes.pieces()[rng.below(tubes.pieces().len())];
            let on = piece.ends[0].lerp(piece.ends[1], rng.unit()) + piece.radii[0] * rng.direction();
            (on.as_dvec3(), 0.1)
        }
        Shape::Patches(mesh) => {
            let patch = mesh.patch(rng.below(mesh.patch_count()));
            let uv = Vec2::new(rng.unit(), rng.unit()).as_dvec2();
            (patch.point(uv), f64::from(patch.bounds().extent().length()))
        }
    };
    let place = instance.map_or(lucerna::math::DAffine3::IDENTITY, |instance| {
        instance.world_from_object.at(time)
    });
    let target = place.transform_point3(target);
    let scale = place.matrix3.x_axis.length();
    let away = rng.direction() * (10.0_f32.powf(rng.range(-1.0, 2.0)) * (size * scale) as f32);
    let origin = target.as_vec3() + away;
    Ray::new(origin, (target - origin.as_dvec3()).as_vec3(), time)
}

#[test]
fn a_ray_does_not_meet_the_primitive_that_it_leaves() {
    let rng = &mut Rng::new(53);
    for (name, world) in all(rng) {
        let first: Vec<Ray> = (0..12_000)
            .map(|_| towards(&world, rng))
            .filter(Ray::is_valid)
            .collect();
        for (backend, accel) in backends(&world) {
            let answers = intersect(&*accel, &first, None);
            let mut left = Vec::new();
            let mut spawned = Vec::new();
            for (ray, answer) in first.iter().zip(&answers) {
                let Some((hit, _)) = answer else { continue };
                let surface = world.interaction(ray, *hit);
                let shape = &world.geometry(hit.geometry).shape;
                let is_convex = matches!(shape, Shape::Spheres(_) | Shape::Quadrics(_) | Shape::Tubes(_));
                for _ in 0..4 {
                    let mut w = rng.direction();
                    if rng.below(4) == 0 {
                        // Close to the surface.
                        w = (w - surface.ng * (w.dot(surface.ng) * 0.999)).normalize();
                    }
                    // From inside a sphere or a cylinder the other side is met.
                    if is_convex && w.dot(surface.ng) < 0.0 {
                        w = -w;
                    }
                    left.push((*hit, surface.error, w.dot(surface.ng).abs()));
                    spawned.push(surface.spawn_ray(w));
                }
            }
            let again = intersect(&*accel, &spawned, None);
            let mut met = 0;
            for ((answer, (hit, error, cos)), ray) in again.iter().zip(&left).zip(&spawned) {
                // A twisted patch may be met again, but farther away than its error explains, except by a ray that grazes it;
                // so may a bent curve, but not within its width, by which a ray leaves it.
                let is_false = |t: f32| match world.geometry(hit.geometry).shape {
                    Shape::Patches(_) => *cos > 0.05 && t * cos < *error,
                    Shape::Curves(_) => t < 0.25 * error,
                    _ => true,
                };
                if let Some((other, t)) = answer
                    && other == hit
                    && is_false(*t)
                {
                    met += 1;
                    if met <= 3 {
                        println!("{name}, {backend}: {ray:?} met {hit:?} again at {t}, error {error}");
                    }
                }
            }
            println!(
                "{name}, {backend}: {met} of {} spawned rays met what they left",
                spawned.len()
            );
            assert!(spawned.len() > 20_000);
            assert!(met == 0 || !backend.contains("bvh"), "{name}, {backend}");
        }
    }
}
