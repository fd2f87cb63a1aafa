//! Curves that face the ray as Embree's own primitives.
//!
//! They have scenes of their own. Embree leaves out where a ray meets a flat curve nearer to its origin than twice the curve's radius
//! there: it takes that for the place that the ray comes from. Here rays leave curves by an offset, and what else is that near counts: a
//! strip above a floor has a shadow. So rays start farther back when they are traced through these scenes, from where nothing is left
//! out that they are to meet.

use std::sync::Arc;

use embree_sys as ffi;

use super::device::{Device, backend_error};
use super::scene::{GeometryHandle, Layer};
use crate::error::Result;
use crate::geometry::{
    FacingCurves, Geometry, GeometryId, HitPacket, InstanceId, LANES, Opacity, Ray, RayPacket, Shape, World,
};
use crate::math::{AnimatedTransform, DMat3};

/// Embree's factor, rounded up.
const LEFT_OUT: f64 = 2.001;
/// The widest curves may be wider than the thinnest by this: the farther back rays start, the less precise they are.
const MOST_RANGE: f32 = 1000.0;

/// The scenes of curves, and how far back rays start.
pub struct CurveLayer {
    pub layer: Layer,
    reach: f32,
}

/// What Embree takes for each geometry; `None` where it is no curve, or one that Embree cannot have.
pub fn facing(world: &World) -> Vec<Option<FacingCurves>> {
    let of = |geometry: &Geometry| match &geometry.shape {
        // A filter is asked about the places that our test finds.
        Shape::Curves(curves) if geometry.opacity == Opacity::Opaque => curves.facing(),
        _ => None,
    };
    let mut all: Vec<_> = world.geometries().iter().map(of).collect();
    let least = all
        .iter()
        .flatten()
        .map(|f| f.largest_radius)
        .fold(f32::INFINITY, f32::min);
    for curves in &mut all {
        if curves
            .as_ref()
            .is_some_and(|curves| curves.largest_radius > MOST_RANGE * least)
        {
            *curves = None;
        }
    }
    all
}

/// A geometry of Embree's, not committed.
pub fn geometry(device: &Arc<Device>, geometry: &Geometry, curves: &FacingCurves) -> Result<GeometryHandle> {
    let handle = GeometryHandle::new(device, ffi::RTC_GEOMETRY_TYPE_FLAT_BEZIER_CURVE, geometry.mask)?;
    let raw = handle.raw();
    let copy = |kind, format, bytes: &[u8], stride: usize| {
        // SAFETY: the geometry is live; Embree allocates as many elements of that size as there are.
        let to = unsafe { ffi::rtcSetNewGeometryBuffer(raw, kind, 0, format, stride, bytes.len() / stride) };
        if to.is_null() {
            device.check()?;
            return Err(backend_error("cannot allocate the points of curves".into()));
        }
        // SAFETY: both have at least that many bytes, and the one was just allocated.
        unsafe { std::ptr::copy_nonoverlapping(bytes.as_ptr(), to.cast::<u8>(), bytes.len()) };
        Ok(())
    };
    let points: Vec<u8> = curves.points.iter().flatten().flat_map(|x| x.to_ne_bytes()).collect();
    copy(ffi::RTC_BUFFER_TYPE_VERTEX, ffi::RTC_FORMAT_FLOAT4, &points, 16)?;
    let first: Vec<u8> = curves.first.iter().flat_map(|i| i.to_ne_bytes()).collect();
    copy(ffi::RTC_BUFFER_TYPE_INDEX, ffi::RTC_FORMAT_UINT, &first, 4)?;
    // SAFETY: the geometry is live.
    unsafe { ffi::rtcSetGeometryTessellationRate(raw, curves.steps as f32) };
    Ok(handle)
}

/// How far in front of a ray's origin Embree leaves curves out, at most, in the units of the world.
fn reach(world: &World, facing: &[Option<FacingCurves>]) -> f32 {
    let radius = |members: &[GeometryId]| {
        let radii = members.iter().filter_map(|id| facing[id.index()].as_ref());
        radii.map(|curves| f64::from(curves.largest_radius)).fold(0.0, f64::max)
    };
    let placed = (0..world.instances().len()).map(|i| {
        let instance = world.instance(InstanceId::from_index(i));
        radius(&world.groups()[instance.group.index()]) * largest_scale(&instance.world_from_object)
    });
    (LEFT_OUT * placed.fold(radius(world.root()), f64::max)) as f32
}

/// More than a transform ever stretches anything.
fn largest_scale(transform: &AnimatedTransform) -> f64 {
    let norm = |m: DMat3| m.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt();
    match transform.decompositions() {
        None => norm(transform.at(0.0).matrix3),
        Some(ends) => ends.iter().map(|end| norm(end.scale_skew)).fold(0.0, f64::max),
    }
}

impl CurveLayer {
    /// Of scenes that hold nothing but these curves.
    pub fn new(layer: Layer, world: &World, facing: &[Option<FacingCurves>]) -> Self {
        Self {
            layer,
            reach: reach(world, facing),
        }
    }

    /// The rays, as far back as is needed, ending at `ends`; and by how much each starts farther back, in units of its direction.
    #[inline]
    pub fn moved_back(&self, rays: &RayPacket, ends: &[f32; LANES]) -> (RayPacket, [f32; LANES]) {
        let mut moved = *rays;
        let mut by = [0.0; LANES];
        for lane in 0..LANES {
            moved.tfar[lane] = ends[lane];
            // Rounding must not make a lane take part.
            if !moved.is_active(lane) {
                continue;
            }
            let [x, y, z] = [rays.dir_x[lane], rays.dir_y[lane], rays.dir_z[lane]];
            let back = self.reach / (x * x + y * y + z * z).sqrt();
            let at = [
                rays.org_x[lane] - back * x,
                rays.org_y[lane] - back * y,
                rays.org_z[lane] - back * z,
            ];
            // Else it would start where no ray may, or the square of its direction is out of range: it starts where it is.
            if !at.iter().all(|x| x.abs() <= Ray::LARGEST) {
                continue;
            }
            by[lane] = back;
            [moved.org_x[lane], moved.org_y[lane], moved.org_z[lane]] = at;
            moved.tnear[lane] += back;
            moved.tfar[lane] += back;
        }
        (moved, by)
    }
}

/// Takes over the hits that were found by rays that started farther back.
#[inline]
pub fn merge(hits: &mut HitPacket, found: &HitPacket, by: &[f32; LANES]) {
    for (lane, by) in by.iter().enumerate() {
        if found.is_hit(lane) {
            hits.geometry[lane] = found.geometry[lane];
            hits.primitive[lane] = found.primitive[lane];
            hits.instance[lane] = found.instance[lane];
            hits.t[lane] = (found.t[lane] - by).max(0.0);
        }
    }
}
