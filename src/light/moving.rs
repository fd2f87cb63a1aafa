//! Emitters that move with the shape that they are.

use std::sync::Arc;

use super::emitter::{Emitter, EmitterShape};
use super::patch::PatchEmitter;
use crate::geometry::{PatchSurface, Quadric, Sphere};
use crate::math::{AnimatedTransform, Bounds3, DAffine3, DMat3, DVec3, Vec3, transform_point};

/// A shape that emits, at every time.
#[derive(Clone, Debug)]
pub struct MovingEmitter {
    world_from_object: AnimatedTransform,
    kind: Kind,
}

#[derive(Clone, Debug)]
enum Kind {
    /// Corners at time steps, evenly spaced over [0, 1], and the side that emits.
    Triangle {
        steps: Vec<[Vec3; 3]>,
        side: Side,
    },
    Sphere(Sphere),
    Quadric(Quadric),
    Patch(PatchSurface),
}

/// On which side of a triangle its geometric normal is.
#[derive(Clone, Copy, Debug)]
pub enum Side {
    /// That of the cross product of its edges, or (`true`) the other one.
    Orientation(bool),
    /// That of a vector.
    Of(Vec3),
}

impl MovingEmitter {
    /// A triangle by its corners at one or more time steps, evenly spaced over [0, 1], which move with a transform.
    pub fn triangle(steps: Vec<[Vec3; 3]>, side: Side, world_from_object: AnimatedTransform) -> Self {
        let kind = Kind::Triangle { steps, side };
        Self {
            world_from_object,
            kind,
        }
    }

    /// A sphere that moves with a transform.
    pub fn sphere(sphere: Sphere, world_from_object: AnimatedTransform) -> Self {
        let kind = Kind::Sphere(sphere);
        Self {
            world_from_object,
            kind,
        }
    }

    /// A part of a sphere, a cylinder or a disk that moves with a transform.
    pub fn quadric(quadric: Quadric, world_from_object: AnimatedTransform) -> Self {
        let kind = Kind::Quadric(quadric);
        Self {
            world_from_object,
            kind,
        }
    }

    /// A bilinear patch that moves with a transform.
    pub fn patch(surface: PatchSurface, world_from_object: AnimatedTransform) -> Self {
        let kind = Kind::Patch(surface);
        Self {
            world_from_object,
            kind,
        }
    }

    /// The emitter at a time in [0, 1]; `None` if it has no area then.
    pub(super) fn at(&self, time: f32) -> Option<Emitter> {
        let world = self.world_from_object.at(time);
        Emitter::new(match &self.kind {
            Kind::Triangle { steps, side } => triangle_at(&corners_at(steps, time), *side, &world),
            Kind::Sphere(sphere) => sphere_shape(&moved(sphere, &world)?),
            Kind::Quadric(quadric) => EmitterShape::Quadric(Arc::new(quadric.transformed(&world)?)),
            Kind::Patch(surface) => EmitterShape::Patch(Arc::new(PatchEmitter::new(surface.transformed(&world))?)),
        })
    }

    /// From the world to the object space of a sphere at a time.
    pub(super) fn object_from_world(&self, time: f32) -> Option<DMat3> {
        match &self.kind {
            Kind::Triangle { .. } | Kind::Quadric(_) | Kind::Patch(_) => None,
            Kind::Sphere(sphere) => Some(
                moved(sphere, &self.world_from_object.at(time))?
                    .object_from_world()
                    .matrix3,
            ),
        }
    }

    /// Around it at all times.
    pub(super) fn bounds(&self) -> Bounds3 {
        let in_object = match &self.kind {
            Kind::Triangle { steps, .. } => Bounds3::from_points(steps.iter().flatten().copied()),
            Kind::Sphere(sphere) => sphere.bounds(),
            Kind::Quadric(quadric) => quadric.bounds(),
            Kind::Patch(surface) => surface.patch.bounds(),
        };
        self.world_from_object.moving_bounds(&in_object)
    }
}

/// A sphere, or an ellipsoid, as it is.
pub(super) fn sphere_shape(sphere: &Sphere) -> EmitterShape {
    match uniform_scale(&sphere.world_from_object().matrix3) {
        Some(scale) => EmitterShape::Sphere {
            center: sphere.center(),
            radius: sphere.radius() * scale,
            inward: sphere.has_flipped_normal(),
        },
        None => EmitterShape::Ellipsoid(Arc::new(sphere.clone())),
    }
}

fn moved(sphere: &Sphere, world: &DAffine3) -> Option<Sphere> {
    let moved = Sphere::new(sphere.radius(), *world * *sphere.world_from_object())?;
    Some(moved.with_flipped_normal(sphere.has_flipped_normal()))
}

fn corners_at(steps: &[[Vec3; 3]], time: f32) -> [Vec3; 3] {
    let segments = steps.len() - 1;
    let scaled = time * segments as f32;
    let step = (scaled as usize).min(segments.saturating_sub(1));
    let next = (step + 1).min(segments);
    let fraction = (scaled - step as f32).clamp(0.0, 1.0);
    std::array::from_fn(|i| steps[step][i] * (1.0 - fraction) + steps[next][i] * fraction)
}

fn triangle_at(corners: &[Vec3; 3], side: Side, world: &DAffine3) -> EmitterShape {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let cross = (b - a).cross(c - a);
    let flip = match side {
        Side::Orientation(flip) => flip,
        Side::Of(normal) => cross.dot(normal.as_dvec3()) < 0.0,
    };
    let local = if flip { -cross } else { cross };
    let normal: DVec3 = world.matrix3.inverse().transpose() * local;
    EmitterShape::Triangle {
        vertices: corners.map(|p| transform_point(world, p)),
        ng: normal.normalize_or_zero().as_vec3(),
    }
}

/// The factor of a rotation with uniform scale; `None` for any other matrix.
fn uniform_scale(m: &DMat3) -> Option<f64> {
    let lengths = DVec3::new(m.x_axis.length(), m.y_axis.length(), m.z_axis.length());
    let scale = lengths.x;
    let orthogonal = [m.x_axis.dot(m.y_axis), m.y_axis.dot(m.z_axis), m.z_axis.dot(m.x_axis)];
    let uniform = (lengths - DVec3::splat(scale)).abs().max_element() <= 1e-6 * scale;
    (uniform && orthogonal.iter().all(|d| d.abs() <= 1e-6 * scale * scale)).then_some(scale)
}
