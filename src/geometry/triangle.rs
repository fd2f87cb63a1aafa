//! Where a ray meets a triangle, in double precision, and how far from there a backend may see it.

use super::LANES;
use crate::math::{DVec3, Kernel, Vec3, Vectorizer, gamma};

/// The least error, relative to the size of a primitive: where a plane through the origin is exact a ray must start off it all
/// the same, and by more than the smallest numbers there are.
pub const LEAST_ERROR: f64 = 1.0 / (1_u64 << 36) as f64;

/// How far from its plane a backend may see a triangle, for a ray that starts on it.
///
/// A backend computes T = ng . (v - o), a distance times |ng|, from corners relative to the origin, in single precision. With
/// extents E of the triangle, an element of ng = e x e' is off by some 14 u E E (u the unit roundoff: edges are off by 3 u E, and
/// two products and their difference round), the corner by u E, the sum by 3 u; together 22 u E E E for each of three terms. Half
/// of this worst case is never exceeded in tests. Where the triangle is perpendicular to an axis only [`LEAST_ERROR`]
/// is left, as the sum then has one term and the rest is exact.
pub fn triangle_error(vertices: &[DVec3; 3]) -> f64 {
    let [a, b, c] = *vertices;
    plane_error(vertices, (b - a).cross(c - a).length().recip())
}

/// [`triangle_error`] of a triangle, given the reciprocal of the length of the cross product of two edges.
#[inline(always)]
fn plane_error(vertices: &[DVec3; 3], inverse_area: f64) -> f64 {
    let [a, b, c] = *vertices;
    let extent = larger(larger(a, b), c) - smaller(smaller(a, b), c);
    let size = larger_of(larger_of(extent.x, extent.y), extent.z);
    let volume = extent.x * extent.y * extent.z;
    let plane = f64::from(gamma(32)) * volume * inverse_area;
    let plane = if volume == 0.0 { 0.0 } else { plane };
    // The plane of a sliver means nothing; a thousandth of its size is as far as a ray may be moved.
    smaller_of(larger_of(plane, LEAST_ERROR * size), 1e-3 * size)
}

// One instruction each, where the functions of the standard library take care of NaN.
#[inline(always)]
fn larger_of(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[inline(always)]
fn smaller_of(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[inline(always)]
fn larger(a: DVec3, b: DVec3) -> DVec3 {
    DVec3::new(larger_of(a.x, b.x), larger_of(a.y, b.y), larger_of(a.z, b.z))
}

#[inline(always)]
fn smaller(a: DVec3, b: DVec3) -> DVec3 {
    DVec3::new(smaller_of(a.x, b.x), smaller_of(a.y, b.y), smaller_of(a.z, b.z))
}

/// A point of a triangle, in the space of its vertices.
#[derive(Clone, Copy, Debug)]
pub(super) struct TrianglePoint {
    /// The point.
    pub p: DVec3,
    /// See [`triangle_error`].
    pub error: f64,
    /// Unit normal, on the side from which the vertices run anticlockwise; NaN for a triangle without area.
    pub ng: DVec3,
    /// Barycentric coordinates of the second and the third vertex.
    pub barycentrics: [f64; 2],
}

/// The point where a ray's line meets a triangle's plane, or the nearest of the triangle, nearly, where a backend rounded otherwise
/// (Moeller and Trumbore 1997). Without branches, for the sake of [`points`].
#[inline(always)]
pub(super) fn point(vertices: &[Vec3; 3], origin: DVec3, direction: DVec3) -> TrianglePoint {
    let vertices = vertices.map(Vec3::as_dvec3);
    let (e1, e2) = (vertices[1] - vertices[0], vertices[2] - vertices[0]);
    let cross = e1.cross(e2);
    let inverse_area = 1.0 / cross.length();
    let moment = (origin - vertices[0]).cross(direction);
    let inverse = -1.0 / direction.dot(cross);
    let (v, w) = (e2.dot(moment) * inverse, -e1.dot(moment) * inverse);
    // A ray within the plane: NaN or infinite.
    let is_finite = v.is_finite() & w.is_finite();
    let (v, w) = (larger_of(v, 0.0), larger_of(w, 0.0));
    let scale = 1.0 / larger_of(v + w, 1.0);
    let v = if is_finite { v * scale } else { 1.0 / 3.0 };
    let w = if is_finite { w * scale } else { 1.0 / 3.0 };
    TrianglePoint {
        p: vertices[0] + e1 * v + e2 * w,
        error: plane_error(&vertices, inverse_area),
        ng: cross * inverse_area,
        barycentrics: [v, w],
    }
}

/// A point of a triangle in world space, in single precision.
#[derive(Clone, Copy, Debug)]
pub(super) struct WorldPoint {
    pub p: Vec3,
    /// That of [`TrianglePoint`] and of the rounding to single precision.
    pub error: f32,
    pub ng: Vec3,
    pub barycentrics: [f32; 2],
}

impl TrianglePoint {
    /// As it is, where the vertices are in world space.
    #[inline(always)]
    pub fn in_world(&self) -> WorldPoint {
        let ng = self.ng.as_vec3();
        WorldPoint {
            p: self.p.as_vec3(),
            error: (self.error + rounding_error(self.p, ng)) as f32,
            ng,
            barycentrics: self.barycentrics.map(|b| b as f32),
        }
    }
}

/// How far rounding to single precision can move `p`, and then the origin of a ray beside it, along the unit normal `n`.
#[inline(always)]
pub(super) fn rounding_error(p: DVec3, n: Vec3) -> f64 {
    n.abs().as_dvec3().dot(p.abs()) * f64::from(gamma(3))
}

/// Eight triangles and the rays that meet them, element by element.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TriangleLanes {
    /// By vertex and axis.
    pub vertices: [[[f32; LANES]; 3]; 3],
    /// By axis.
    pub origins: [[f32; LANES]; 3],
    /// By axis.
    pub directions: [[f32; LANES]; 3],
}

/// Eight of [`WorldPoint`].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct WorldPoints {
    p: [[f32; LANES]; 3],
    error: [f32; LANES],
    ng: [[f32; LANES]; 3],
    barycentrics: [[f32; LANES]; 2],
}

impl TriangleLanes {
    /// [`point`] of each lane, in world space: the same bits as one by one, several times faster.
    #[inline]
    pub fn points(&self, vectorizer: Vectorizer) -> WorldPoints {
        vectorizer.run(PointLanes(self))
    }
}

/// See [`TriangleLanes::points`].
struct PointLanes<'a>(&'a TriangleLanes);

impl Kernel for PointLanes<'_> {
    type Output = WorldPoints;

    #[inline(always)]
    fn call(self) -> WorldPoints {
        let Self(lanes) = self;
        let mut points = WorldPoints::default();
        for i in 0..LANES {
            let of = |axes: &[[f32; LANES]; 3]| Vec3::new(axes[0][i], axes[1][i], axes[2][i]);
            let [a, b, c] = &lanes.vertices;
            let (origin, direction) = (of(&lanes.origins).as_dvec3(), of(&lanes.directions).as_dvec3());
            let point = point(&[of(a), of(b), of(c)], origin, direction).in_world();
            [points.p[0][i], points.p[1][i], points.p[2][i]] = [point.p.x, point.p.y, point.p.z];
            [points.ng[0][i], points.ng[1][i], points.ng[2][i]] = [point.ng.x, point.ng.y, point.ng.z];
            points.error[i] = point.error;
            [points.barycentrics[0][i], points.barycentrics[1][i]] = point.barycentrics;
        }
        points
    }
}

impl WorldPoints {
    /// One of them.
    #[inline]
    pub fn get(&self, lane: usize) -> WorldPoint {
        let of = |axes: &[[f32; LANES]; 3]| Vec3::new(axes[0][lane], axes[1][lane], axes[2][lane]);
        WorldPoint {
            p: of(&self.p),
            error: self.error[lane],
            ng: of(&self.ng),
            barycentrics: self.barycentrics.map(|b| b[lane]),
        }
    }
}
