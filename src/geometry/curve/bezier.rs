//! Cubic Bézier curves by their control points, in double precision.

use crate::math::DVec3;

/// The point at `u`.
pub fn point(points: &[DVec3; 4], u: f64) -> DVec3 {
    let [a, b, c, d] = *points;
    let (p, q, r) = (a.lerp(b, u), b.lerp(c, u), c.lerp(d, u));
    p.lerp(q, u).lerp(q.lerp(r, u), u)
}

/// By the parameter.
pub fn derivative(points: &[DVec3; 4], u: f64) -> DVec3 {
    let [a, b, c, d] = *points;
    let (p, q, r) = (b - a, c - b, d - c);
    3.0 * p.lerp(q, u).lerp(q.lerp(r, u), u)
}

/// The control points of both halves (de Casteljau).
pub fn halves(points: &[DVec3; 4]) -> [[DVec3; 4]; 2] {
    let [a, b, c, d] = *points;
    let (p, q, r) = (0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + d));
    let (s, t) = (0.5 * (p + q), 0.5 * (q + r));
    let middle = 0.5 * (s + t);
    [[a, p, s, middle], [middle, t, r, d]]
}

/// The control points of the part between two parameters: the blossom at all mixtures of them.
pub fn between(points: &[DVec3; 4], [u0, u1]: [f64; 2]) -> [DVec3; 4] {
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
