//! Rays that are hard for a world.

use lucerna::geometry::{Ray, Shape, World};
use lucerna::math::{Bounds3, Vec3};

use crate::rng::Rng;

/// Draws rays about a world: random, parallel to axes, along planes of boxes, aimed at vertices and at edges, some of them
/// segments, of any length of direction and any time.
pub struct RayMaker {
    bounds: Bounds3,
    /// Corners of triangles at times 0 and 1, in world space.
    triangles: Vec<[[Vec3; 3]; 2]>,
}

impl RayMaker {
    pub fn new(world: &World) -> Self {
        let mut bounds = world.bounds();
        if bounds.is_empty() {
            bounds = Bounds3 {
                min: Vec3::NEG_ONE,
                max: Vec3::ONE,
            };
        }
        // Of a huge sphere, the part around the origin.
        if world.geometries().iter().all(|g| matches!(g.shape, Shape::Spheres(_))) {
            bounds.min = bounds.min.max(Vec3::splat(-3.0));
            bounds.max = bounds.max.min(Vec3::splat(3.0));
        }
        // Rays start beyond a flat world too.
        bounds = bounds.expand(0.25 * bounds.extent().max_element());
        let mut triangles = Vec::new();
        let mut add = |members: &[lucerna::geometry::GeometryId], place: &dyn Fn(Vec3, f32) -> Vec3| {
            for &id in members {
                if let Shape::Mesh(mesh) = &world.geometry(id).shape {
                    triangles.extend(
                        (0..mesh.triangle_count())
                            .map(|i| [0.0, 1.0].map(|time| mesh.triangle(i, time).map(|p| place(p, time)))),
                    );
                }
            }
        };
        add(world.root(), &|p, _| p);
        for instance in world.instances() {
            let place = |p: Vec3, time| lucerna::math::transform_point(&instance.world_from_object.at(time), p);
            add(&world.groups()[instance.group.index()], &place);
        }
        Self { bounds, triangles }
    }

    /// Anywhere in the bounds.
    fn point(&self, rng: &mut Rng) -> Vec3 {
        self.bounds.center() + 0.5 * self.bounds.extent() * rng.cube()
    }

    /// A vertex, a point of an edge, or a point within a triangle.
    fn target(&self, rng: &mut Rng, time: f32) -> Vec3 {
        if self.triangles.is_empty() {
            return self.point(rng);
        }
        let triangle = self.triangles[rng.below(self.triangles.len())];
        let [a, b, c] = triangle[usize::from(time > 0.5)];
        match rng.below(3) {
            0 => a,
            1 => a + (b - a) * rng.unit(),
            _ => a + (b - a) * rng.unit() * 0.5 + (c - a) * rng.unit() * 0.5,
        }
    }

    pub fn ray(&self, rng: &mut Rng, id: u32) -> Ray {
        // Time steps are where the vertices are known.
        let time = match rng.below(4) {
            0 => 0.0,
            1 => 1.0,
            _ => rng.unit(),
        };
        let mut origin = self.point(rng);
        let mut direction = rng.direction();
        match rng.below(6) {
            0 => {}
            1 => direction = self.point(rng) - origin,
            2 => {
                direction = [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z][rng.below(6)];
                if rng.below(2) == 0 {
                    // Through a vertex, an edge, and along the planes of its boxes.
                    let axis = direction.abs();
                    origin = origin * axis + self.target(rng, time) * (Vec3::ONE - axis);
                }
            }
            3 => {
                // Within an axis plane.
                let axis = [Vec3::X, Vec3::Y, Vec3::Z][rng.below(3)];
                let target = self.target(rng, time);
                origin = origin * (Vec3::ONE - axis) + target * axis;
                direction = target - origin;
            }
            _ => direction = self.target(rng, time) - origin,
        }
        if direction == Vec3::ZERO {
            direction = Vec3::X;
        }
        let mut ray = Ray::new(origin, direction, time);
        if rng.below(4) == 0 {
            ray.direction *= 10.0_f32.powf(rng.range(-6.0, 6.0));
            if !ray.is_valid() {
                ray.direction = Vec3::Z;
            }
        }
        let lengths = [self.bounds.extent(), ray.direction].map(|v| v.as_dvec3().length());
        let size = ((lengths[0] / lengths[1]) as f32).min(1e38);
        if rng.below(4) == 0 {
            ray.tnear = rng.unit() * 0.5 * size;
        }
        if rng.below(4) == 0 {
            ray.tfar = ray.tnear + rng.unit() * size;
        }
        ray.id = id;
        assert!(ray.is_valid(), "{ray:?}");
        ray
    }
}
