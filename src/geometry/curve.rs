//! Curves with a width, pbrt's: cubic Bézier segments swept by a line that faces the ray, or that a normal turns (ribbons). On
//! `cylinder` curves the normal bends across the width as on a cylinder; the points stay those of the ribbon that faces the ray.
//!
//! A segment is divided until it is flat within a twentieth of its width; then the ray meets the piece if it passes its axis within
//! half the width, between the perpendiculars at its ends (Nakamaru and Ohno 2002; Pharr, Jakob and Humphreys 2023, section 6.7).
//! Here that is done in double precision, by one function for every backend, so that all see the same surface.

use std::f64::consts::{FRAC_PI_2, SQRT_2};

use super::shape::LineHits;
use super::surface::LocalSurface;
use crate::math::{AnimatedTransform, Bounds3, DAffine3, DQuat, DVec2, DVec3, Vec2, Vec3};

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
    world_from_object: DAffine3,
    object_from_world: DAffine3,
    flip_normal: bool,
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
        let object_from_world = AnimatedTransform::fixed(world_from_object)?.inverse_at(0.0);
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
            world_from_object,
            object_from_world,
            flip_normal: false,
        })
    }

    /// With the geometric normal on the other side.
    #[must_use]
    pub fn with_flipped_normal(mut self, flip: bool) -> Self {
        self.flip_normal = flip;
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
        let points = between(&segment.points.map(Vec3::as_dvec3), u);
        let half = 0.5 * u.map(|u| width_at(segment, u)).into_iter().fold(0.0, f64::max);
        let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let m = &self.world_from_object;
        let rows = m.matrix3.transpose();
        let margin = DVec3::new(rows.x_axis.length(), rows.y_axis.length(), rows.z_axis.length()) * half;
        for p in points {
            let p = m.transform_point3(p);
            (min, max) = (min.min(p - margin), max.max(p + margin));
        }
        let outward = |v: DVec3, round: fn(f32) -> f32| Vec3::from_array(v.as_vec3().to_array().map(round));
        Bounds3 {
            min: outward(min, f32::next_down),
            max: outward(max, f32::next_up),
        }
    }

    /// Where a ray meets a primitive in front of its origin: the two nearest places, if it is so twisted that there are more.
    #[inline]
    pub fn intersect(&self, primitive: usize, origin: DVec3, direction: DVec3) -> LineHits {
        let [a, b] = self.hits(primitive, origin, direction);
        LineHits::new(a.map(|hit| hit.t), b.map(|hit| hit.t))
    }

    fn hits(&self, primitive: usize, origin: DVec3, direction: DVec3) -> [Option<CurveHit>; 2] {
        let o = self.object_from_world.transform_point3(origin);
        let d = self.object_from_world.transform_vector3(direction);
        let (segment, u) = self.part(primitive);
        let points = between(&segment.points.map(Vec3::as_dvec3), u);
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
        let o = self.object_from_world.transform_point3(origin);
        let d = self.object_from_world.transform_vector3(direction);
        let (segment, range) = self.part(primitive);
        let points = segment.points.map(Vec3::as_dvec3);
        let frame = RayFrame::new(o, d, points[3] - points[0]);
        // Where a backend saw a hit through an instance's rounded transform: the nearest point of the axis.
        let hit = found.copied().unwrap_or_else(|| nearest_to_ray(segment, range, &frame));
        let dpdu = match derivative(&points, hit.uv.x) {
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
        let ng = (self.object_from_world.matrix3.transpose() * normal).normalize();
        let ng = if self.flip_normal { -ng } else { ng };
        let to_world = |v: DVec3| self.world_from_object.transform_vector3(v).as_vec3();
        LocalSurface {
            p: origin + direction * hit.t,
            // A ray that leaves must not meet the curve again, which turns to face it; at the rim of a cylinder its normal leads across.
            error: 1.5 * self.world_from_object.transform_vector3(frame.y * hit.width).length(),
            ng,
            ns: ng.as_vec3(),
            dpdu: to_world(dpdu),
            dpdv: to_world(dpdv),
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
        for (half, u) in halves(points).iter().zip([[u[0], middle], [middle, u[1]]]) {
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
        let axis = bezier(points, w);
        let distance = axis.truncate().length();
        if distance > 0.5 * width || axis.z < 0.0 || width == 0.0 {
            return None;
        }
        let along = derivative(points, w);
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

/// The point at `u`.
fn bezier(points: &[DVec3; 4], u: f64) -> DVec3 {
    let [a, b, c, d] = *points;
    let (p, q, r) = (a.lerp(b, u), b.lerp(c, u), c.lerp(d, u));
    p.lerp(q, u).lerp(q.lerp(r, u), u)
}

fn derivative(points: &[DVec3; 4], u: f64) -> DVec3 {
    let [a, b, c, d] = *points;
    let (p, q, r) = (b - a, c - b, d - c);
    3.0 * p.lerp(q, u).lerp(q.lerp(r, u), u)
}

/// The control points of both halves (de Casteljau).
fn halves(points: &[DVec3; 4]) -> [[DVec3; 4]; 2] {
    let [a, b, c, d] = *points;
    let (p, q, r) = (0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + d));
    let (s, t) = (0.5 * (p + q), 0.5 * (q + r));
    let middle = 0.5 * (s + t);
    [[a, p, s, middle], [middle, t, r, d]]
}

/// The control points of the part between two parameters: the blossom at all mixtures of them.
fn between(points: &[DVec3; 4], [u0, u1]: [f64; 2]) -> [DVec3; 4] {
    let blossom = |x: f64, y: f64, z: f64| {
        let [a, b, c, d] = *points;
        let (p, q, r) = (a.lerp(b, x), b.lerp(c, x), c.lerp(d, x));
        p.lerp(q, y).lerp(q.lerp(r, y), z)
    };
    [
        blossom(u0, u0, u0),
        blossom(u0, u0, u1),
        blossom(u0, u1, u1),
        blossom(u1, u1, u1),
    ]
}

/// The place of the axis, of some along a part of a segment, that is nearest to a ray.
fn nearest_to_ray(segment: &CurveSegment, [u0, u1]: [f64; 2], frame: &RayFrame) -> CurveHit {
    const STEPS: u32 = 16;
    let points = segment.points.map(|p| frame.point(p.as_dvec3()));
    let at = |i: u32| {
        let u = u0 + (u1 - u0) * f64::from(i) / f64::from(STEPS);
        (u, bezier(&points, u))
    };
    let distance = |p: &(f64, DVec3)| p.1.truncate().length_squared();
    let (u, axis) = (0..=STEPS)
        .map(at)
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .unwrap_or((u0, points[0]));
    let along = derivative(&points, u);
    let side = -along.x * axis.y + axis.x * along.y;
    CurveHit {
        t: axis.z / frame.length,
        uv: DVec2::new(u, if side > 0.0 { 1.0 } else { 0.0 }),
        width: width_at(segment, u),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn segment() -> CurveSegment {
        CurveSegment {
            points: [
                Vec3::new(-1.0, 0.0, 0.0),
                Vec3::new(-0.3, 0.8, 0.2),
                Vec3::new(0.4, -0.6, -0.3),
                Vec3::new(1.0, 0.2, 0.1),
            ],
            widths: [0.2, 0.05],
            normals: [Vec3::Z, Vec3::new(0.0, 0.6, 0.8)],
        }
    }

    fn set(kind: CurveKind, depth: u32) -> CurveSet {
        CurveSet::new(vec![segment()], kind, depth, DAffine3::IDENTITY).unwrap()
    }

    /// All that a ray meets of a set, nearest first.
    fn nearest(set: &CurveSet, origin: DVec3, direction: DVec3) -> Option<(usize, f64)> {
        (0..set.primitive_count())
            .filter_map(|i| set.intersect(i, origin, direction).from(0.0).map(|t| (i, t)))
            .min_by(|a, b| a.1.total_cmp(&b.1))
    }

    #[test]
    fn rays_meet_what_is_within_half_the_width_of_the_axis() {
        let points = segment().points.map(Vec3::as_dvec3);
        let direction = DVec3::new(0.1, -0.2, -3.0);
        for kind in [CurveKind::Flat, CurveKind::Cylinder] {
            for depth in [0, 3] {
                let set = set(kind, depth);
                for i in 1..39 {
                    // Not where parts meet: of what goes through the end of a part rounding decides.
                    let u = (f64::from(i) + 0.37) / 40.0;
                    let axis = bezier(&points, u);
                    let across = direction.cross(derivative(&points, u)).normalize();
                    let half = 0.5 * width_at(&segment(), u);
                    for (share, is_met) in [(-1.1, false), (-0.85, true), (0.0, true), (0.85, true), (1.1, false)] {
                        let target = axis + across * (half * share);
                        let found = nearest(&set, target - 2.0 * direction, direction);
                        assert_eq!(found.is_some(), is_met, "{kind:?} {depth} {u} {share}");
                        let Some((part, t)) = found else { continue };
                        assert!((t - 2.0).abs() < 0.01, "{t}");
                        let surface = set.surface(part, target - 2.0 * direction, direction, 0.0);
                        // Flat within a twentieth of the greatest width, so that coordinates are off by as much of the width here.
                        let v = f64::from(surface.uv.y);
                        let off = 0.05 * 0.2 / (2.0 * half);
                        assert!(
                            (v - (0.5 + 0.5 * share)).abs() < off || (v - (0.5 - 0.5 * share)).abs() < off,
                            "{kind:?} {depth} {u} {share}: {v}"
                        );
                        assert!((f64::from(surface.uv.x) - u).abs() < 0.05);
                        assert!(
                            surface
                                .dpdu
                                .as_dvec3()
                                .normalize()
                                .dot(derivative(&points, u).normalize())
                                > 0.99
                        );
                        assert!(surface.ng.dot(surface.dpdu.as_dvec3()).abs() < 1e-6);
                    }
                }
            }
        }
    }

    #[test]
    fn parts_are_the_whole() {
        let (whole, parts) = (set(CurveKind::Flat, 0), set(CurveKind::Flat, 4));
        let mut hits = 0;
        for i in 0..4000 {
            let a = f64::from(i) * 0.37;
            let target = DVec3::new((1.7 * a).sin(), 0.3 * (2.3 * a).cos(), 0.0);
            let direction = DVec3::new(0.3 * a.cos(), 0.3 * a.sin(), -1.0);
            let [a, b] = [&whole, &parts].map(|set| nearest(set, target - 3.0 * direction, direction).map(|(_, t)| t));
            // They are divided in other places: at the rim they may differ.
            hits += usize::from(a.is_some());
            if let (Some(a), Some(b)) = (a, b) {
                assert!((a - b).abs() < 0.02);
            }
        }
        assert!(hits > 200);
    }

    #[test]
    fn ribbons_turn_with_their_normals() {
        let set = set(CurveKind::Ribbon, 2);
        // At the start the normal is z: seen along y its edge is met only within what the turning leaves.
        let p = bezier(&segment().points.map(Vec3::as_dvec3), 0.05);
        let wide = p + DVec3::new(0.0, 0.0, 0.05);
        assert!(nearest(&set, p + DVec3::Z * 2.0, DVec3::NEG_Z).is_some());
        assert!(nearest(&set, wide + DVec3::Y * 2.0, DVec3::NEG_Y).is_none());
        let surface = set.surface(0, p + DVec3::Z * 2.0, DVec3::NEG_Z, 0.0);
        assert!(surface.ng.z.abs() > 0.95);
    }

    #[test]
    fn the_normal_of_a_cylinder_is_that_of_its_place() {
        let straight = CurveSegment {
            points: [0.0, 1.0, 2.0, 3.0].map(|x| Vec3::new(x, 0.0, 0.0)),
            widths: [0.5; 2],
            normals: [Vec3::Z; 2],
        };
        let set = CurveSet::new(vec![straight], CurveKind::Cylinder, 0, DAffine3::IDENTITY).unwrap();
        for y in [-0.2, -0.1, 0.0, 0.15] {
            let surface = set.surface(0, DVec3::new(1.2, y, 4.0), DVec3::NEG_Z, 0.0);
            let angle = (y / 0.25) * FRAC_PI_2;
            // pbrt's angle is proportional to the distance from the axis. Up to the sign of the whole.
            let expected = DVec3::new(0.0, angle.sin(), angle.cos());
            assert!(
                surface.ng.dot(expected).abs() > 1.0 - 1e-6,
                "{y}: {} {expected}",
                surface.ng
            );
            assert!((f64::from(surface.dpdu.x) - 3.0).abs() < 1e-6);
            assert!((f64::from(surface.uv.x) - 0.4).abs() < 1e-6);
        }
    }

    #[test]
    fn boxes_hold_what_is_met() {
        let place = DAffine3::from_scale_rotation_translation(
            DVec3::new(2.0, 0.5, 1.0),
            DQuat::from_rotation_y(0.7),
            DVec3::new(1.0, 2.0, 3.0),
        );
        let set = CurveSet::new(vec![segment()], CurveKind::Flat, 3, place).unwrap();
        let mut hits = 0;
        for i in 0..20_000 {
            let a = f64::from(i) * 0.73;
            let target = place.transform_point3(DVec3::new((1.7 * a).sin(), 0.4 * (2.3 * a).cos(), 0.0));
            let direction = DVec3::new(a.cos(), a.sin(), (0.3 * a).cos());
            for part in 0..set.primitive_count() {
                let origin = target - 3.0 * direction;
                for t in set.intersect(part, origin, direction).iter() {
                    let p = (origin + direction * t).as_vec3();
                    let bounds = set.primitive_bounds(part).expand(1e-5);
                    assert!(p.cmpge(bounds.min).all() && p.cmple(bounds.max).all());
                    hits += 1;
                }
            }
        }
        assert!(hits > 1000);
    }
}
