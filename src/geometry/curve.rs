//! Curves with a width, pbrt's: cubic Bézier segments swept by a line that faces the ray, or that a normal turns (ribbons). On
//! `cylinder` curves the normal bends across the width as on a cylinder; the points stay those of the ribbon that faces the ray.
//!
//! A segment is divided until it is flat within a twentieth of its width; then the ray meets the piece if it passes its axis within
//! half the width, between the perpendiculars at its ends (Nakamaru and Ohno 2002; Pharr, Jakob and Humphreys 2023, section 6.7).
//! Here that is done in double precision, by one function for every backend, so that all see the same surface.

mod bezier;
mod facing;

use std::f64::consts::{FRAC_PI_2, SQRT_2};

pub use self::facing::FacingCurves;

use super::placement::Placement;
use super::shape::LineHits;
use super::surface::LocalSurface;
use crate::math::{Bounds3, DAffine3, DQuat, DVec2, DVec3, Vec2, Vec3};

/// How a curve's width lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveKind {
    /// Facing the ray.
    Flat,
    /// The same, with the normals of a cylinder.
    Cylinder,
    /// Perpendicular to the normals of its ends and those between.
    Ribbon,
}

/// One cubic segment, object space.
#[derive(Clone, Copy, Debug)]
pub struct CurveSegment {
    /// Bézier's control points.
    pub points: [Vec3; 4],
    /// Width at the start and at the end, and linear between; not negative.
    pub widths: [f32; 2],
    /// Unit normals at the start and at the end; of no matter but for ribbons.
    pub normals: [Vec3; 2],
}

/// Curves of one kind. Primitives are equal parts of segments, 2^depth of each, so that their boxes are small.
#[derive(Clone, Debug)]
pub struct CurveSet {
    segments: Vec<CurveSegment>,
    kind: CurveKind,
    depth: u32,
    placement: Placement,
}

/// Where a ray meets a curve.
#[derive(Clone, Copy, Debug)]
struct CurveHit {
    t: f64,
    /// Along the segment and across it, in [0, 1].
    uv: DVec2,
    /// Across the ray.
    width: f64,
}

/// The two nearest so far, in order.
#[derive(Default)]
struct Nearest([Option<CurveHit>; 2]);

impl Nearest {
    fn add(&mut self, hit: CurveHit) {
        let is_nearer = |other: &Option<CurveHit>| other.is_none_or(|other| hit.t < other.t);
        if is_nearer(&self.0[0]) {
            self.0 = [Some(hit), self.0[0]];
        } else if is_nearer(&self.0[1]) {
            self.0[1] = Some(hit);
        }
    }
}

/// The axes of a ray: along it, across it and the curve's chord, and the third.
struct RayFrame {
    x: DVec3,
    y: DVec3,
    z: DVec3,
    origin: DVec3,
    /// Length of the direction.
    length: f64,
}

impl RayFrame {
    fn new(origin: DVec3, direction: DVec3, chord: DVec3) -> Self {
        let length = direction.length();
        let z = direction / length;
        let y = z
            .cross(chord)
            .try_normalize()
            .unwrap_or_else(|| z.any_orthonormal_vector());
        Self {
            x: y.cross(z),
            y,
            z,
            origin,
            length,
        }
    }

    fn point(&self, p: DVec3) -> DVec3 {
        self.vector(p - self.origin)
    }

    fn vector(&self, v: DVec3) -> DVec3 {
        DVec3::new(v.dot(self.x), v.dot(self.y), v.dot(self.z))
    }
}

impl CurveSet {
    /// Curves of `segments`, each of which is 2^`depth` primitives (fewer if there are too many); `None` if the transform is singular or
    /// anything is not finite.
    pub fn new(segments: Vec<CurveSegment>, kind: CurveKind, depth: u32, world_from_object: DAffine3) -> Option<Self> {
        const MOST: usize = 1 << 30;
        let placement = Placement::new(world_from_object)?;
        let is_finite = |s: &CurveSegment| {
            s.points.iter().chain(&s.normals).all(|v| v.is_finite()) && s.widths.iter().all(|w| w.is_finite())
        };
        if segments.len() > MOST || !segments.iter().all(is_finite) {
            return None;
        }
        let depth = (0..=depth.min(10)).rev().find(|d| segments.len() << d <= MOST);
        Some(Self {
            segments,
            kind,
            depth: depth.unwrap_or(0),
            placement,
        })
    }

    /// With the geometric normal on the other side.
    #[must_use]
    pub fn with_flipped_normal(mut self, flip: bool) -> Self {
        self.placement.flip_normal = flip;
        self
    }

    /// Number of primitives.
    pub fn primitive_count(&self) -> usize {
        self.segments.len() << self.depth
    }

    /// The segments.
    pub fn segments(&self) -> &[CurveSegment] {
        &self.segments
    }

    /// Bytes of its arrays.
    pub fn memory(&self) -> usize {
        size_of_val(self.segments.as_slice())
    }

    /// The segment of a primitive, and between which parameters it lies.
    #[inline]
    fn part(&self, primitive: usize) -> (&CurveSegment, [f64; 2]) {
        let parts = 1_usize << self.depth;
        let part = primitive & (parts - 1);
        let at = |i: usize| i as f64 / parts as f64;
        (&self.segments[primitive >> self.depth], [at(part), at(part + 1)])
    }

    /// A box around a primitive.
    pub fn primitive_bounds(&self, primitive: usize) -> Bounds3 {
        let (segment, u) = self.part(primitive);
        let points = bezier::between(&segment.points.map(Vec3::as_dvec3), u);
        let half = 0.5 * u.map(|u| width_at(segment, u)).into_iter().fold(0.0, f64::max);
        self.placement.box_around(points.map(|p| (p, half)))
    }

    /// Where a ray meets a primitive in front of its origin: the two nearest places, if it is so twisted that there are more.
    #[inline]
    pub fn intersect(&self, primitive: usize, origin: DVec3, direction: DVec3) -> LineHits {
        let [a, b] = self.hits(primitive, origin, direction);
        LineHits::new(a.map(|hit| hit.t), b.map(|hit| hit.t))
    }

    fn hits(&self, primitive: usize, origin: DVec3, direction: DVec3) -> [Option<CurveHit>; 2] {
        let (o, d) = self.placement.ray(origin, direction);
        let (segment, u) = self.part(primitive);
        let points = bezier::between(&segment.points.map(Vec3::as_dvec3), u);
        let frame = RayFrame::new(o, d, points[3] - points[0]);
        let points = points.map(|p| frame.point(p));
        let mut nearest = Nearest::default();
        let widest = u.map(|u| width_at(segment, u)).into_iter().fold(0.0, f64::max);
        if is_crossed(&points, widest) {
            let piece = Piece {
                segment,
                kind: self.kind,
                frame: &frame,
            };
            piece.divide(&points, u, divisions(&points, widest), &mut nearest);
        }
        nearest.0
    }

    /// The surface where a ray meets a primitive at `tnear` or behind, or nearly does.
    pub(super) fn surface(&self, primitive: usize, origin: DVec3, direction: DVec3, tnear: f64) -> LocalSurface {
        let hits = self.hits(primitive, origin, direction);
        let found = hits.iter().flatten().find(|hit| hit.t >= tnear).or(hits[0].as_ref());
        let (o, d) = self.placement.ray(origin, direction);
        let (segment, range) = self.part(primitive);
        let points = segment.points.map(Vec3::as_dvec3);
        let frame = RayFrame::new(o, d, points[3] - points[0]);
        // Where a backend saw a hit by its own test, or through an instance's rounded transform: the nearest point of the axis.
        let hit = found.copied().unwrap_or_else(|| nearest_to_ray(segment, range, &frame));
        let dpdu = match bezier::derivative(&points, hit.uv.x) {
            DVec3::ZERO => points[3] - points[0],
            dpdu => dpdu,
        };
        let dpdv = match self.kind {
            CurveKind::Ribbon => normal_at(segment, hit.uv.x).cross(dpdu).normalize_or_zero() * hit.width,
            CurveKind::Flat => frame.z.cross(dpdu).normalize_or_zero() * hit.width,
            CurveKind::Cylinder => {
                let flat = frame.z.cross(dpdu).normalize_or_zero() * hit.width;
                // The round side faces the ray; pbrt-v4 turns the other way, as if it were hollow.
                let angle = (2.0 * hit.uv.y - 1.0) * FRAC_PI_2;
                dpdu.try_normalize()
                    .map_or(flat, |axis| DQuat::from_axis_angle(axis, angle) * flat)
            }
        };
        let normal = dpdu.cross(dpdv).try_normalize().unwrap_or(frame.z);
        let ng = self.placement.normal(normal);
        LocalSurface {
            p: origin + direction * hit.t,
            // A ray that leaves must not meet the curve again, which turns to face it; at the rim of a cylinder its normal leads across.
            error: 1.5
                * self
                    .placement
                    .world_from_object
                    .transform_vector3(frame.y * hit.width)
                    .length(),
            ng,
            ns: ng.as_vec3(),
            dpdu: self.placement.vector(dpdu),
            dpdv: self.placement.vector(dpdv),
            uv: hit.uv.as_vec2(),
            barycentrics: Vec2::ZERO,
        }
    }
}

/// A part of a segment that a ray may meet.
struct Piece<'a> {
    segment: &'a CurveSegment,
    kind: CurveKind,
    frame: &'a RayFrame,
}

impl Piece<'_> {
    /// Halves the curve of `points`, in the frame of the ray, so many times, where the ray may meet it.
    fn divide(&self, points: &[DVec3; 4], u: [f64; 2], depth: u32, nearest: &mut Nearest) {
        if depth == 0 {
            if let Some(hit) = self.flat(points, u) {
                nearest.add(hit);
            }
            return;
        }
        let middle = 0.5 * (u[0] + u[1]);
        for (half, u) in bezier::halves(points).iter().zip([[u[0], middle], [middle, u[1]]]) {
            let widest = u.map(|u| width_at(self.segment, u)).into_iter().fold(0.0, f64::max);
            if is_crossed(half, widest) {
                self.divide(half, u, depth - 1, nearest);
            }
        }
    }

    /// Where the ray meets a curve that is nearly straight.
    fn flat(&self, points: &[DVec3; 4], [u0, u1]: [f64; 2]) -> Option<CurveHit> {
        let [p0, p1, p2, p3] = points.map(DVec3::truncate);
        // Beyond the perpendiculars at both ends is the matter of the neighbours.
        if (p1 - p0).dot(-p0) < 0.0 || (p2 - p3).dot(-p3) < 0.0 {
            return None;
        }
        let chord = p3 - p0;
        let square = chord.length_squared();
        if square == 0.0 {
            return None;
        }
        let w = (-p0.dot(chord) / square).clamp(0.0, 1.0);
        let u = u0 + (u1 - u0) * w;
        let mut width = width_at(self.segment, u);
        if self.kind == CurveKind::Ribbon {
            width *= normal_at(self.segment, u).dot(self.frame.z).abs();
        }
        let axis = bezier::point(points, w);
        let distance = axis.truncate().length();
        if distance > 0.5 * width || axis.z < 0.0 || width == 0.0 {
            return None;
        }
        let along = bezier::derivative(points, w);
        let side = (-along.x * axis.y + axis.x * along.y).signum();
        Some(CurveHit {
            t: axis.z / self.frame.length,
            uv: DVec2::new(u, 0.5 + side * distance / width),
            width,
        })
    }
}

/// Whether a box around a curve, in the frame of a ray, holds points of the ray.
#[inline]
fn is_crossed(points: &[DVec3; 4], width: f64) -> bool {
    let [a, b, c, d] = *points;
    let (min, max) = (a.min(b).min(c.min(d)), a.max(b).max(c.max(d)));
    let half = 0.5 * width;
    min.y <= half && max.y >= -half && min.x <= half && max.x >= -half && max.z >= -half
}

/// How often a curve is halved until it is flat within a twentieth of its width (Wang 1984).
fn divisions(points: &[DVec3; 4], width: f64) -> u32 {
    let bend = |i: usize| (points[i] - 2.0 * points[i + 1] + points[i + 2]).abs();
    let bend = bend(0).max(bend(1)).max_element();
    let error = 0.05 * width;
    let halvings = (SQRT_2 * 6.0 * bend / (8.0 * error)).log2() / 2.0;
    // A width of zero: any number will do.
    halvings.ceil().clamp(0.0, 10.0) as u32
}

fn width_at(segment: &CurveSegment, u: f64) -> f64 {
    let [start, end] = segment.widths.map(f64::from);
    start + (end - start) * u
}

/// Along the arc between the normals of the ends.
fn normal_at(segment: &CurveSegment, u: f64) -> DVec3 {
    let [a, b] = segment.normals.map(Vec3::as_dvec3);
    let angle = a.dot(b).clamp(-1.0, 1.0).acos();
    let sin = angle.sin();
    if sin.abs() < 1e-9 {
        return a;
    }
    (a * ((1.0 - u) * angle).sin() + b * (u * angle).sin()) / sin
}

/// The place of the axis, of some along a part of a segment, that is nearest to a ray.
fn nearest_to_ray(segment: &CurveSegment, [u0, u1]: [f64; 2], frame: &RayFrame) -> CurveHit {
    const STEPS: u32 = 16;
    let points = segment.points.map(|p| frame.point(p.as_dvec3()));
    let nearest = |[u0, u1]: [f64; 2]| {
        let at = |i: u32| {
            let u = u0 + (u1 - u0) * f64::from(i) / f64::from(STEPS);
            (u, bezier::point(&points, u))
        };
        let distance = |p: &(f64, DVec3)| p.1.truncate().length_squared();
        let steps = (0..=STEPS).map(at);
        steps
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
            .unwrap_or((u0, points[0]))
    };
    let (about, _) = nearest([u0, u1]);
    let step = (u1 - u0) / f64::from(STEPS);
    let (u, axis) = nearest([(about - step).max(u0), (about + step).min(u1)]);
    let along = bezier::derivative(&points, u);
    let side = -along.x * axis.y + axis.x * along.y;
    CurveHit {
        t: axis.z / frame.length,
        uv: DVec2::new(u, if side > 0.0 { 1.0 } else { 0.0 }),
        width: width_at(segment, u),
    }
}

#[cfg(test)]
mod tests;
