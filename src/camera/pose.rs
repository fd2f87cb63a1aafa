//! Where a camera is at one time.

use crate::math::{DAffine3, Vec3};

/// An affine transform in single precision, by its columns.
#[derive(Clone, Copy, Debug)]
pub(super) struct CameraFrame {
    x: Vec3,
    y: Vec3,
    z: Vec3,
    origin: Vec3,
}

impl CameraFrame {
    pub fn new(m: &DAffine3) -> Self {
        Self {
            x: m.matrix3.x_axis.as_vec3(),
            y: m.matrix3.y_axis.as_vec3(),
            z: m.matrix3.z_axis.as_vec3(),
            origin: m.translation.as_vec3(),
        }
    }

    #[inline]
    pub fn vector(&self, v: Vec3) -> Vec3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }

    #[inline]
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.vector(p) + self.origin
    }
}

/// The transforms of a camera in both directions, and what they do to areas and volumes. They may scale, skew and mirror.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pose {
    pub frame: CameraFrame,
    /// In double precision: a film position is a small difference of angles.
    pub camera_from_world: DAffine3,
    /// Unit normal of the plane of the lens, towards the scene.
    pub normal: Vec3,
    /// Area in the world of a unit area of that plane.
    pub area: f32,
    /// Volume in the world of a unit cube.
    pub volume: f32,
}

impl Pose {
    pub fn new(world_from_camera: &DAffine3) -> Self {
        let m = &world_from_camera.matrix3;
        let across = m.x_axis.cross(m.y_axis);
        let volume = across.dot(m.z_axis);
        Self {
            frame: CameraFrame::new(world_from_camera),
            camera_from_world: world_from_camera.inverse(),
            normal: (across.normalize() * volume.signum()).as_vec3(),
            area: across.length() as f32,
            volume: volume.abs() as f32,
        }
    }
}
