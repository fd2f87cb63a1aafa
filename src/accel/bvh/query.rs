//! What is asked of a ray, and the nearest hit so far.

use super::ray::Line;
use crate::accel::{FilterHit, HitFilter};
use crate::geometry::{GeometryId, HitPacket, InstanceId, PrimitiveId, Ray, Shape};

/// A box that begins farther than the nearest hit by more than this, relatively, is passed over; one at the same distance never
/// is, as the distances of a box and of what is in it are rounded differently and equal distances are decided by ids.
pub const CULL_SLACK: f32 = 1.0 + 16.0 * f32::EPSILON;

/// The state of one ray's query.
pub struct Query<'a> {
    /// Hits at this distance or nearer do not count.
    pub tnear: f32,
    /// Distance of the nearest hit so far, at first the ray's end.
    pub tfar: f32,
    /// Boxes beyond this are passed over.
    pub cull: f32,
    /// Ids of the nearest hit so far: geometry, primitive, instance; [`HitPacket::NONE`] for none.
    pub ids: [u32; 3],
    /// The ray's mask.
    pub mask: u32,
    /// The ray's time.
    pub time: f32,
    /// The ray's id, for the filter.
    pub ray_id: u32,
    /// Distances are those of the ray divided by this.
    pub scale: f32,
    /// Who else decides.
    pub asked: Asked<'a>,
}

/// Which hits count.
#[derive(Clone, Copy)]
pub struct Asked<'a> {
    /// Asked about hits on filtered geometry.
    pub filter: Option<&'a dyn HitFilter>,
    /// Of each geometry, whether hits on it are filtered.
    pub filtered: &'a [bool],
}

impl Asked<'_> {
    /// Whether the filter is to be asked about hits on a geometry.
    #[inline(always)]
    pub fn is_filtered(&self, geometry: u32) -> bool {
        self.filter.is_some() && self.filtered[geometry as usize]
    }
}

/// A hit to be compared with the nearest so far.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// Distance.
    pub t: f32,
    /// Index of the geometry.
    pub geometry: u32,
    /// Index of the primitive.
    pub primitive: u32,
    /// Index of the instance, or [`HitPacket::NONE`].
    pub instance: u32,
}

impl Candidate {
    /// Whether it precedes the nearest hit so far, at a distance and with ids, by (t, geometry, primitive, instance).
    #[inline(always)]
    pub fn precedes(&self, tfar: f32, ids: impl FnOnce() -> [u32; 3]) -> bool {
        self.t < tfar || (self.t == tfar && [self.geometry, self.primitive, self.instance] < ids())
    }
}

impl<'a> Query<'a> {
    /// A query of `ray`, along its direction times `scale`.
    #[inline(always)]
    pub fn new(ray: &Ray, scale: f32, asked: Asked<'a>) -> Self {
        let tfar = ray.tfar / scale;
        Self {
            // Adding zero turns a negative zero into a positive one, whose bits compare as an integer.
            tnear: ray.tnear / scale + 0.0,
            tfar,
            cull: tfar * CULL_SLACK,
            ids: [HitPacket::NONE; 3],
            mask: ray.mask,
            time: ray.time,
            ray_id: ray.id,
            scale,
            asked,
        }
    }

    /// Whether anything was hit.
    #[inline(always)]
    pub fn is_hit(&self) -> bool {
        self.ids[0] != HitPacket::NONE
    }

    /// Takes a candidate in (tnear, tfar] if it precedes the nearest hit so far by (t, geometry, primitive, instance) and the
    /// filter accepts it; says whether it did. `uv` is asked only for a filter.
    #[inline(always)]
    pub fn offer(&mut self, candidate: &Candidate, uv: impl FnOnce() -> [f32; 2]) -> bool {
        if !candidate.precedes(self.tfar, || self.ids) || !self.accepts(candidate, uv) {
            return false;
        }
        self.tfar = candidate.t;
        self.cull = candidate.t * CULL_SLACK;
        self.ids = [candidate.geometry, candidate.primitive, candidate.instance];
        true
    }

    /// Whether a distance is in (tnear, tfar].
    #[inline(always)]
    pub fn contains(&self, t: f32) -> bool {
        t > self.tnear && t <= self.tfar
    }

    /// Offers the hits with a primitive of an analytic shape, the farther if the filter takes away the nearer.
    #[inline(always)]
    pub fn offer_analytic(
        &mut self,
        shape: &Shape,
        primitive: usize,
        line: Line,
        candidate: impl Fn(f32) -> Candidate,
    ) -> bool {
        let hits = shape.line_hits(primitive, line.origin.as_dvec3(), line.direction.as_dvec3());
        let mut distances = hits.iter().map(|t| t as f32);
        distances.any(|t| self.contains(t) && self.offer(&candidate(t), || [0.0; 2]))
    }

    /// Whether the filter, if any, accepts a candidate.
    #[inline(always)]
    fn accepts(&self, candidate: &Candidate, uv: impl FnOnce() -> [f32; 2]) -> bool {
        match self.asked.filter {
            Some(filter) if self.asked.is_filtered(candidate.geometry) => {
                let [u, v] = uv();
                filter.accept(&FilterHit {
                    geometry: GeometryId(candidate.geometry),
                    primitive: PrimitiveId(candidate.primitive),
                    instance: (candidate.instance != HitPacket::NONE).then_some(InstanceId(candidate.instance)),
                    u,
                    v,
                    t: candidate.t * self.scale,
                    ray_id: self.ray_id,
                })
            }
            _ => true,
        }
    }

    /// Writes the answer into a lane.
    #[inline(always)]
    pub fn store(&self, hits: &mut HitPacket, lane: usize) {
        [hits.geometry[lane], hits.primitive[lane], hits.instance[lane]] = self.ids;
        hits.t[lane] = self.tfar * self.scale;
    }
}
