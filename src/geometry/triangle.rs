//! Where a ray meets a triangle, in double precision, and how far from there a backend may see it.

use crate::math::{DVec3, Vec2, Vec3, gamma};

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
    let axis = |a, b, c| larger_of(larger_of(a, b), c) - smaller_of(smaller_of(a, b), c);
    let extent = DVec3::new(axis(a.x, b.x, c.x), axis(a.y, b.y, c.y), axis(a.z, b.z, c.z));
    plane_error(extent, (b - a).cross(c - a).length().recip())
}

/// [`triangle_error`] of a triangle of this extent, given the reciprocal of the length of the cross product of two edges.
#[inline(always)]
fn plane_error(extent: DVec3, inverse_area: f64) -> f64 {
    let size = larger_of(larger_of(extent.x, extent.y), extent.z);
    let volume = extent.x * extent.y * extent.z;
    let plane = f64::from(gamma(32)) * volume * inverse_area;
    let plane = if volume == 0.0 { 0.0 } else { plane };
    // The plane of a sliver means nothing; a thousandth of its size is as far as a ray may be moved.
    smaller_of(larger_of(plane, LEAST_ERROR * size), 1e-3 * size)
}

// One instruction each, where the functions of the standard library take care of NaN.
#[inline(always)]
fn larger_of<T: PartialOrd>(a: T, b: T) -> T {
    if a > b { a } else { b }
}

#[inline(always)]
fn smaller_of<T: PartialOrd>(a: T, b: T) -> T {
    if a < b { a } else { b }
}

/// The extent of a triangle: the difference is in double precision, but not what is chosen.
#[inline(always)]
fn extent([a, b, c]: &[Vec3; 3]) -> DVec3 {
    let axis =
        |a: f32, b: f32, c: f32| f64::from(larger_of(larger_of(a, b), c)) - f64::from(smaller_of(smaller_of(a, b), c));
    DVec3::new(axis(a.x, b.x, c.x), axis(a.y, b.y, c.y), axis(a.z, b.z, c.z))
}

/// The plane of a triangle, in the space of its vertices.
#[derive(Clone, Copy, Debug)]
pub(super) struct TrianglePlane {
    /// See [`triangle_error`].
    pub error: f64,
    /// Unit normal, on the side from which the vertices run anticlockwise; NaN for a triangle without area.
    pub ng: DVec3,
}

impl TrianglePlane {
    /// Of the triangle with these vertices. Without branches, so that it is vectorised over lanes.
    #[inline(always)]
    pub fn of(vertices: &[Vec3; 3]) -> Self {
        let extent = extent(vertices);
        let [a, b, c] = vertices.map(Vec3::as_dvec3);
        let cross = (b - a).cross(c - a);
        let inverse_area = 1.0 / cross.length();
        Self {
            error: plane_error(extent, inverse_area),
            ng: cross * inverse_area,
        }
    }
}

/// A point of a triangle, in the space of its vertices.
#[derive(Clone, Copy, Debug)]
pub(super) struct TrianglePoint {
    /// The point.
    pub p: DVec3,
    /// Barycentric coordinates of the second and the third vertex.
    pub barycentrics: [f32; 2],
}

/// The point where a ray's line meets a triangle's plane, or the nearest of the triangle, nearly, where a backend rounded otherwise
/// (Moeller and Trumbore 1997). Without branches, as [`TrianglePlane::of`] is.
#[inline(always)]
pub(super) fn point(vertices: &[Vec3; 3], origin: DVec3, direction: DVec3) -> TrianglePoint {
    let vertices = vertices.map(Vec3::as_dvec3);
    let (e1, e2) = (vertices[1] - vertices[0], vertices[2] - vertices[0]);
    let moment = (origin - vertices[0]).cross(direction);
    let inverse = -1.0 / direction.dot(e1.cross(e2));
    let (v, w) = (e2.dot(moment) * inverse, -e1.dot(moment) * inverse);
    // A ray within the plane: NaN or infinite.
    let is_finite = v.is_finite() & w.is_finite();
    let (v, w) = (larger_of(v, 0.0), larger_of(w, 0.0));
    let scale = 1.0 / larger_of(v + w, 1.0);
    let v = if is_finite { v * scale } else { 1.0 / 3.0 };
    let w = if is_finite { w * scale } else { 1.0 / 3.0 };
    TrianglePoint {
        p: vertices[0] + e1 * v + e2 * w,
        barycentrics: [v as f32, w as f32],
    }
}

/// How far rounding to single precision can move `p`, and then the origin of a ray beside it, along the unit normal `n`.
#[inline(always)]
pub(super) fn rounding_error(p: DVec3, n: Vec3) -> f64 {
    n.abs().as_dvec3().dot(p.abs()) * f64::from(gamma(3))
}

/// What a mesh says of the corners of a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corners {
    /// Shading normals, of any length; all zero if the mesh has none.
    pub normals: [Vec3; 3],
    /// Texture coordinates.
    pub uvs: [Vec2; 3],
    /// 1 if the geometric normal is on the anticlockwise side, -1 if on the other, if there are no normals to say so.
    pub side: f32,
}

/// How texture coordinates lie on a mesh at a point of a triangle: see [`SurfaceInteraction`](super::SurfaceInteraction).
#[derive(Clone, Copy, Debug)]
pub(super) struct Parametrization {
    pub dpdu: Vec3,
    pub dpdv: Vec3,
    pub uv: Vec2,
}

/// 1 if the geometric normal is on the side from which the vertices run anticlockwise, where it is `ng`, and -1 if on the other, with
/// `normals` and `side` as [`Corners`] has them. Without branches.
#[inline(always)]
pub(super) fn facing_side(normals: &[Vec3; 3], side: f32, ng: Vec3) -> f32 {
    let [a, b, c] = *normals;
    // With normals given they say which side is out, as in pbrt.
    let cos = ng.dot(a + b + c);
    if cos == 0.0 { side } else { 1.0_f32.copysign(cos) }
}

/// The interpolated shading normal at the point with the barycentrics `v` and `w` of the second and the third corner, unit length; zero
/// without normals, or where they cancel. Without branches.
#[inline(always)]
pub(super) fn shading_normal(normals: &[Vec3; 3], [v, w]: [f32; 2]) -> Vec3 {
    let u = 1.0 - v - w;
    let [a, b, c] = *normals;
    let mean = a * u + b * v + c * w;
    let inverse_length = 1.0 / mean.length();
    let has_direction = (inverse_length > 0.0) & (inverse_length < f32::INFINITY);
    mean * if has_direction { inverse_length } else { 0.0 }
}

impl Parametrization {
    /// At the point with the barycentrics `v` and `w` of the second and the third corner, with `uvs` as [`Corners`] has them. Without branches.
    #[inline(always)]
    pub fn at(uvs: &[Vec2; 3], vertices: &[Vec3; 3], [v, w]: [f32; 2]) -> Self {
        let u = 1.0 - v - w;
        let (e1, e2) = (vertices[1] - vertices[0], vertices[2] - vertices[0]);
        let [p, q, r] = *uvs;
        let [dpdu, dpdv] = derivatives(e1, e2, q - p, r - p);
        Self {
            dpdu,
            dpdv,
            uv: p * u + q * v + r * w,
        }
    }
}

/// Solves dp = dpdu du + dpdv dv along two edges, over which (u, v) change by `d1` and `d2`; zero where these are degenerate.
#[inline(always)]
fn derivatives(e1: Vec3, e2: Vec3, d1: Vec2, d2: Vec2) -> [Vec3; 2] {
    let determinant = d1.perp_dot(d2);
    let inverse = 1.0 / determinant;
    let inverse = if determinant == 0.0 { 0.0 } else { inverse };
    [(e1 * d2.y - e2 * d1.y) * inverse, (e2 * d1.x - e1 * d2.x) * inverse]
}
