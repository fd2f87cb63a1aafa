//! Where a light stands and how it is turned, which may change over time.

use std::sync::Arc;

use crate::math::{AnimatedTransform, Bounds3, DAffine3, DMat3, DVec3, Frame, Mat3, Vec3};

/// The transform of a light at every time: a motion after a transform that stays the same.
#[derive(Clone, Debug)]
pub struct Place {
    start: Pose,
    motion: Option<Arc<Motion>>,
}

#[derive(Debug)]
struct Motion {
    world_from_light: AnimatedTransform,
    local: DAffine3,
}

/// The transform at one time.
#[derive(Clone, Debug)]
pub(super) struct Pose {
    /// The light's origin, world space.
    pub position: Vec3,
    world_from_light: Mat3,
    light_from_world: Mat3,
    /// Absolute determinant of `light_from_world`.
    determinant: f32,
}

impl Place {
    /// `world_from_light` after `local`, which is invertible.
    pub fn new(world_from_light: AnimatedTransform, local: DAffine3) -> Self {
        Self {
            start: Pose::new(&(world_from_light.at(0.0) * local)),
            motion: (!world_from_light.is_static()).then(|| {
                Arc::new(Motion {
                    world_from_light,
                    local,
                })
            }),
        }
    }

    /// At a point, not turned.
    pub fn at_point(p: Vec3) -> Self {
        Self::new(AnimatedTransform::identity(), DAffine3::from_translation(p.as_dvec3()))
    }

    /// At the point `from` with +z in the direction `z`, of unit length; how it is turned about it is not said.
    pub fn facing(from: DVec3, z: DVec3) -> Self {
        Self::new(AnimatedTransform::identity(), facing(from, z))
    }

    /// At a time in [0, 1].
    #[inline]
    pub(super) fn at(&self, time: f32) -> Pose {
        match &self.motion {
            None => self.start.clone(),
            Some(motion) => Pose::new(&(motion.world_from_light.at(time) * motion.local)),
        }
    }

    /// Whether it is the same at all times.
    pub fn is_static(&self) -> bool {
        self.motion.is_none()
    }

    /// Around the light's origin at all times.
    pub(super) fn bounds(&self) -> Bounds3 {
        match &self.motion {
            None => Bounds3::from_points([self.start.position]),
            Some(motion) => {
                let origin = Bounds3::from_points([motion.local.translation.as_vec3()]);
                motion.world_from_light.moving_bounds(&origin)
            }
        }
    }
}

/// A transform that takes the origin to `from` and +z to `z`, of unit length.
pub fn facing(from: DVec3, z: DVec3) -> DAffine3 {
    let frame = Frame::from_normal(z.as_vec3());
    let (s, t) = (frame.s.as_dvec3(), frame.t.as_dvec3());
    DAffine3::from_mat3_translation(DMat3::from_cols(s, t, z), from)
}

impl Pose {
    fn new(world_from_light: &DAffine3) -> Self {
        let inverse = world_from_light.matrix3.inverse();
        Self {
            position: world_from_light.translation.as_vec3(),
            world_from_light: world_from_light.matrix3.as_mat3(),
            light_from_world: inverse.as_mat3(),
            determinant: inverse.determinant().abs() as f32,
        }
    }

    /// A direction of the light's space in the world, of unit length.
    #[inline]
    pub fn world_direction(&self, w: Vec3) -> Vec3 {
        (self.world_from_light * w).normalize()
    }

    /// A direction of the world in the light's space, of unit length.
    #[inline]
    pub fn local_direction(&self, w: Vec3) -> Vec3 {
        (self.light_from_world * w).normalize()
    }

    /// The density by solid angle in the world at `w`, of unit length, over that in the light's space: 1 unless the transform
    /// stretches.
    #[inline]
    pub fn stretch(&self, w: Vec3) -> f32 {
        let length = (self.light_from_world * w).length();
        self.determinant / (length * length * length)
    }

    /// +z of the light in the world.
    #[inline]
    pub fn axis(&self) -> Vec3 {
        self.world_direction(Vec3::Z)
    }
}
