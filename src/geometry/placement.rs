//! Where shapes are that keep a space of their own.

use crate::math::{AnimatedTransform, Bounds3, DAffine3, DMat3, DVec3, Vec3};

/// The space of a shape in the world (or in its group), in double precision, and the side of its geometric normal.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placement {
    pub world_from_object: DAffine3,
    pub object_from_world: DAffine3,
    pub flip_normal: bool,
    /// Where the transform moves the origin, if that is all it does.
    pub only_moved_by: Option<DVec3>,
}

impl Placement {
    /// By a transform, with the normal not flipped; `None` if it is singular.
    pub fn new(world_from_object: DAffine3) -> Option<Self> {
        Some(Self {
            world_from_object,
            object_from_world: AnimatedTransform::fixed(world_from_object)?.inverse_at(0.0),
            flip_normal: false,
            only_moved_by: (world_from_object.matrix3 == DMat3::IDENTITY).then_some(world_from_object.translation),
        })
    }

    /// Origin and direction of a ray of the world in object space. Distances along it are the same.
    #[inline]
    pub fn ray(&self, origin: DVec3, direction: DVec3) -> (DVec3, DVec3) {
        // With no zeros added, which could be of the other sign: as it is done for many rays at a time.
        if let Some(by) = self.only_moved_by {
            return (origin - by, direction);
        }
        let object = &self.object_from_world;
        (object.transform_point3(origin), object.transform_vector3(direction))
    }

    /// A point of object space in the world.
    pub fn point(&self, p: DVec3) -> DVec3 {
        self.world_from_object.transform_point3(p)
    }

    /// A vector of object space in the world.
    pub fn vector(&self, v: DVec3) -> Vec3 {
        self.world_from_object.transform_vector3(v).as_vec3()
    }

    /// A normal of object space in the world, of unit length, on the side of the geometric normal.
    pub fn normal(&self, n: DVec3) -> DVec3 {
        let normal = (self.object_from_world.matrix3.transpose() * n).normalize();
        if self.flip_normal { -normal } else { normal }
    }

    /// A box of the world around balls of object space, each a center and a radius.
    pub fn box_around(&self, balls: impl IntoIterator<Item = (DVec3, f64)>) -> Bounds3 {
        // The support of an ellipsoid along axis i is r |row i of M|.
        let rows = self.world_from_object.matrix3.transpose();
        let reach = DVec3::new(rows.x_axis.length(), rows.y_axis.length(), rows.z_axis.length());
        let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for (center, radius) in balls {
            let (center, margin) = (self.point(center), reach * radius);
            (min, max) = (min.min(center - margin), max.max(center + margin));
        }
        Bounds3::around(min, max)
    }
}
