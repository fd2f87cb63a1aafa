//! Transforms of instances, at rest and moving.
//!
//! Embree's motion is ours, T R S with R along the arc, but it interpolates quaternions in single precision with an approximate
//! arc cosine: measured against the exact motion, elements of its matrices, of size 1, are off by up to 8e-7 for turns of up to a
//! radian and up to 2.1e-6 for half a turn, where their own rounding is 3e-7. Time steps in between would bring that down, but a
//! turn in 13 steps takes Embree a hundred times as long to build as one in 2 steps, and twice as long to trace.

use embree_sys as ffi;

use super::scene::GeometryHandle;
use crate::math::{AnimatedTransform, Decomposition};

/// Gives the transform to an instance geometry that is not committed yet.
pub fn set_transform(instance: &GeometryHandle, transform: &AnimatedTransform) {
    let Some(ends) = transform.decompositions() else {
        let matrix = transform.at(0.0).to_cols_array().map(|element| element as f32);
        // SAFETY: the geometry is a live instance; Embree copies the twelve floats.
        unsafe {
            ffi::rtcSetGeometryTransform(
                instance.raw(),
                0,
                ffi::RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR,
                matrix.as_ptr().cast(),
            );
        }
        return;
    };
    // SAFETY: the geometry is a live instance.
    unsafe { ffi::rtcSetGeometryTimeStepCount(instance.raw(), 2) };
    for (step, end) in (0..).zip(ends) {
        let at = quaternion_decomposition(end);
        // SAFETY: as above, and it has two steps; Embree copies the decomposition.
        unsafe { ffi::rtcSetGeometryTransformQuaternion(instance.raw(), step, &raw const at) };
    }
}

/// Embree's M = T R S has an upper triangular S too, with a shift besides, which is 0 here.
fn quaternion_decomposition(d: &Decomposition) -> ffi::RTCQuaternionDecomposition {
    let (s, r, t) = (d.scale_skew, d.rotation, d.translation);
    ffi::RTCQuaternionDecomposition {
        scale_x: s.x_axis.x as f32,
        scale_y: s.y_axis.y as f32,
        scale_z: s.z_axis.z as f32,
        skew_xy: s.y_axis.x as f32,
        skew_xz: s.z_axis.x as f32,
        skew_yz: s.z_axis.y as f32,
        shift_x: 0.0,
        shift_y: 0.0,
        shift_z: 0.0,
        quaternion_r: r.w as f32,
        quaternion_i: r.x as f32,
        quaternion_j: r.y as f32,
        quaternion_k: r.z as f32,
        translation_x: t.x as f32,
        translation_y: t.y as f32,
        translation_z: t.z as f32,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::embree::device::Device;
    use crate::math::{DAffine3, DMat3, DQuat, DVec3};

    /// Embree's matrix of `transform` at `time`, against ours: the largest difference of an element.
    fn worst_difference(device: &std::sync::Arc<Device>, transform: &AnimatedTransform) -> f64 {
        let instance = GeometryHandle::new(device, ffi::RTC_GEOMETRY_TYPE_INSTANCE, u32::MAX).unwrap();
        set_transform(&instance, transform);
        // SAFETY: a live instance geometry.
        unsafe { ffi::rtcCommitGeometry(instance.raw()) };
        device.check().unwrap();
        let difference = |i: u32| {
            let time = i as f32 / 1000.0;
            let mut matrix = [0.0_f32; 12];
            let format = ffi::RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR;
            // SAFETY: a committed instance geometry, and room for the twelve floats of the format.
            unsafe { ffi::rtcGetGeometryTransform(instance.raw(), time, format, matrix.as_mut_ptr().cast()) };
            let ours = transform.at(time).to_cols_array();
            let differences = ours.iter().zip(matrix).map(|(a, b)| (a - f64::from(b)).abs());
            differences.fold(0.0, f64::max)
        };
        (0..=1000).map(difference).fold(0.0, f64::max)
    }

    #[test]
    fn embree_interpolates_as_we_do() {
        let device = Device::new(1).unwrap();
        let axis = DVec3::new(1.0, 2.0, 3.0).normalize();
        let start = DAffine3 {
            // A skew and a mirror, so that every element of S counts.
            matrix3: DMat3::from_cols_array(&[1.0, 0.0, 0.0, 0.2, -0.9, 0.0, 0.1, -0.3, 0.8]),
            translation: DVec3::new(0.5, -0.5, 0.25),
        };
        for i in 0..=62 {
            let angle = f64::from(i) * 0.05;
            let turn = DAffine3::from_rotation_translation(DQuat::from_axis_angle(axis, angle), DVec3::X);
            let transform = AnimatedTransform::new(start, turn * start).unwrap();
            let worst = worst_difference(&device, &transform);
            // The figures above, with some room for another processor's rounding.
            let bound = if angle <= 1.0 { 1e-6 } else { 2.5e-6 };
            assert!(worst < bound, "angle {angle}: {worst:e}");
        }
    }
}
