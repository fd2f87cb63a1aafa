//! A line with margins, and how it may meet a triangle or a sphere.

use crate::geometry::{Ray, Sphere, TriangleMesh};
use crate::math::{AnimatedTransform, DMat3, DVec3};

/// Unit roundoff of `f32`.
const U: f64 = f32::EPSILON as f64 / 2.0;

/// Of corners relative to the origin.
const CORNER: f64 = 16.0 * U;
/// Of corners that move.
const MOTION: f64 = 3.0 * U;
/// Of transforms of instances that do not move, and of those that do.
const INSTANCE: [f64; 2] = [16.0 * U, 64.0 * U];
/// Of distances themselves: two roundings, and the comparison with `tnear` and `tfar`.
pub(super) const DISTANCE: f64 = 16.0 * U;
/// Of spheres.
const SPHERE: f64 = 16.0 * f64::EPSILON;

/// How many times a relative error of the matrix may grow in its inverse: |M| |M^-1| in the maximum norm.
fn condition(m: &DMat3) -> f64 {
    let norm = |m: DMat3| (m.abs() * DVec3::ONE).max_element();
    norm(*m) * norm(m.inverse())
}

/// Corners at a time, each with how far it may be off along each axis.
pub(super) type Corners = [(DVec3, DVec3); 3];

pub(super) fn corners(mesh: &TriangleMesh, triangle: usize, time: f32) -> Corners {
    let vertices = mesh.indices()[triangle].map(|v| v as usize);
    if !mesh.is_moving() {
        return vertices.map(|v| (mesh.positions(0)[v].as_dvec3(), DVec3::ZERO));
    }
    let segments = mesh.time_steps() - 1;
    let scaled = f64::from(time) * segments as f64;
    let step = (scaled as usize).min(segments - 1);
    let fraction = scaled - step as f64;
    vertices.map(|v| {
        let at = |step: usize| mesh.positions(step)[v].as_dvec3();
        let (a, b) = (at(step), at(step + 1));
        // Near a step, a rounded time may fall into the neighbouring segment.
        let neighbours = [step.checked_sub(1), Some(step + 2).filter(|&s| s <= segments)];
        let sway = neighbours.into_iter().flatten().map(&at);
        let speed = sway.fold((b - a).abs(), |most, c| most.max((c - a).abs()).max((c - b).abs()));
        let margin = MOTION * a.abs().max(b.abs()) + 4.0 * U * segments as f64 * speed;
        (a * (1.0 - fraction) + b * fraction, margin)
    })
}

/// What the judge finds about one primitive.
#[derive(Clone, Copy)]
pub(super) struct Found {
    /// The least and the greatest distance.
    pub(super) t: [f64; 2],
    /// Whether it is certainly met.
    pub(super) certain: bool,
}

impl Found {
    /// What is left of it in (tnear, tfar]: `None` if nothing can be.
    pub(super) fn within(self, ray: &Ray) -> Option<Self> {
        let (near, far) = (f64::from(ray.tnear), f64::from(ray.tfar));
        let [low, high] = self.t;
        if high < near || low > far {
            return None;
        }
        Some(Self {
            t: [low.max(near), high.min(far)],
            certain: self.certain && low > near && high <= far,
        })
    }
}

/// A corner in the sheared space of a line.
struct Sheared {
    x: f64,
    y: f64,
    /// How far x and y may be off.
    across: f64,
    /// Distance along the line.
    t: f64,
    /// How far it may be off.
    along: f64,
}

impl Sheared {
    fn edge(&self, other: &Self) -> f64 {
        self.x * other.y - self.y * other.x
    }

    fn edge_error(&self, other: &Self) -> f64 {
        let length = |p: &Self| p.x.abs() + p.y.abs();
        self.across * length(other) + other.across * length(self) + 2.0 * self.across * other.across
    }
}

/// The least and greatest distance at which a triangle may be met whose edge functions are off by `errors`.
fn distances(corners: &[Sheared; 3], edges: &[f64; 3], errors: &[f64; 3]) -> [f64; 2] {
    let least = corners.iter().map(|c| c.t - c.along).fold(f64::INFINITY, f64::min);
    let greatest = corners.iter().map(|c| c.t + c.along).fold(f64::NEG_INFINITY, f64::max);
    let (area, lost) = (edges.iter().sum::<f64>(), errors.iter().sum::<f64>());
    if area.abs() <= lost {
        return [least, greatest];
    }
    let weighted = |of: &dyn Fn(usize) -> f64| (0..3).map(of).sum::<f64>();
    let middle = weighted(&|i| edges[i] * corners[i].t) / area;
    let moved = weighted(&|i| errors[i] * (corners[i].t - middle).abs());
    let off = moved / (area.abs() - lost) + corners.iter().map(|c| c.along).fold(0.0, f64::max);
    [least.max(middle - off), greatest.min(middle + off)]
}

/// A ray's line in the space of a group, with how far each coordinate of origin and direction may be off.
pub(super) struct Line {
    pub(super) origin: DVec3,
    pub(super) direction: DVec3,
    pub(super) origin_margin: DVec3,
    pub(super) direction_margin: DVec3,
}

impl Line {
    pub(super) fn in_world(ray: &Ray) -> Self {
        Self {
            origin: ray.origin.as_dvec3(),
            direction: ray.direction.as_dvec3(),
            origin_margin: DVec3::ZERO,
            direction_margin: DVec3::ZERO,
        }
    }

    pub(super) fn in_instance(ray: &Ray, world_from_object: &AnimatedTransform) -> Self {
        let object_from_world = world_from_object.inverse_at(ray.time);
        let placed = world_from_object.at(ray.time);
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let margin = INSTANCE[usize::from(!world_from_object.is_static())] * (1.0 + condition(&placed.matrix3));
        let size = object_from_world.matrix3.abs();
        Self {
            origin: object_from_world.transform_point3(origin),
            direction: object_from_world.transform_vector3(direction),
            origin_margin: margin * (size * (origin.abs() + placed.translation.abs())),
            direction_margin: margin * (size * direction.abs()),
        }
    }

    /// Whether and where the line meets a triangle.
    ///
    /// With corners c_i = (x, y, z) relative to the origin and sheared onto the line, and their margins m_i across it, an edge
    /// function c_i x c_j is off by at most m_i |c_j| + m_j |c_i| + 2 m_i m_j, in the 1-norm. Where an edge function is smaller
    /// than that, the ray may be on either side. The distance is the mean of the z with the edge functions as weights: errors e
    /// of weights whose sum is A move it by at most sum(e_i |z_i - t|) / (A - sum(e)), and never beyond the corners.
    pub(super) fn triangle(&self, corners: &Corners, pluecker: bool) -> Option<Found> {
        let sheared = self.sheared(corners);
        let [a, b, c] = &sheared;
        let most = a.across.max(b.across).max(c.across);
        let is_beside = |x: f64, y: f64, z: f64| x.min(y).min(z) > most || x.max(y).max(z) < -most;
        if !pluecker && (is_beside(a.x, b.x, c.x) || is_beside(a.y, b.y, c.y)) {
            return None;
        }
        let edges = [c.edge(b), a.edge(c), b.edge(a)];
        let mut errors = [c.edge_error(b), a.edge_error(c), b.edge_error(a)];
        if pluecker {
            for (i, error) in errors.iter_mut().enumerate() {
                let (p, q) = (corners[(i + 1) % 3].0, corners[(i + 2) % 3].0);
                let sum = p + q - 2.0 * self.origin;
                *error += 3.0_f64.sqrt() * CORNER * (p - q).length() * sum.length();
            }
        }
        let is_above = |i: usize| edges[i] > errors[i];
        let is_below = |i: usize| edges[i] < -errors[i];
        if (0..3).any(is_above) && (0..3).any(is_below) {
            return None;
        }
        Some(Found {
            t: distances(&sheared, &edges, &errors),
            certain: (0..3).all(is_above) || (0..3).all(is_below),
        })
    }

    fn sheared(&self, corners: &Corners) -> [Sheared; 3] {
        let size = self.direction.abs();
        let k = if size.x > size.y && size.x > size.z {
            0
        } else if size.y > size.z {
            1
        } else {
            2
        };
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let inverse = 1.0 / self.direction[k];
        let (sx, sy) = (self.direction[i] * inverse, self.direction[j] * inverse);
        corners.map(|(corner, margin)| {
            let c = corner - self.origin;
            let t = c[k] * inverse;
            let moved = margin + self.origin_margin + self.direction_margin * t.abs();
            Sheared {
                x: c[i] - sx * c[k],
                y: c[j] - sy * c[k],
                across: CORNER * (c[i].abs().max(c[j].abs()) + c[k].abs()) + moved[i].max(moved[j]) + moved[k],
                t,
                along: (CORNER * c[k].abs() + moved[k]) * inverse.abs() + DISTANCE * t.abs(),
            }
        })
    }

    /// Widens the distances of a triangle by the margin of [`Judge::with_pluecker_margins`].
    pub(super) fn rounded_plane(&self, corners: &Corners, found: Found) -> Found {
        let [a, b, c] = corners.map(|(corner, _)| corner - self.origin);
        let normal = (b - a).cross(c - a);
        let extent = (b - a).length().max((c - a).length());
        let reach = a.length().max(b.length()).max(c.length());
        let tilt = CORNER * extent * (extent + reach);
        let slope = normal.dot(self.direction).abs() - tilt * self.direction.length();
        let off = (tilt * extent + CORNER * normal.length() * reach) / slope;
        let [low, high] = found.t;
        Found {
            t: if slope > 0.0 {
                [low - off, high + off]
            } else {
                [f64::NEG_INFINITY, f64::INFINITY]
            },
            ..found
        }
    }

    /// The distance of the centre from the line decides whether the line meets the sphere: with it off by the margin both ways,
    /// there are two pairs of roots, between which the true ones are.
    pub(super) fn sphere(&self, sphere: &Sphere, ray: &Ray) -> Option<Found> {
        let m = sphere.object_from_world();
        let (o, d) = (m.transform_point3(self.origin), m.transform_vector3(self.direction));
        let a = d.length_squared();
        let closest = -o.dot(d) / a;
        let distance = (o + d * closest).length();
        let reach = closest.abs() + sphere.radius() / a.sqrt();
        let moved = m.matrix3.abs() * (self.origin_margin + self.direction_margin * reach);
        let margin = moved.length() + SPHERE * (o.length() + sphere.radius());
        let half = |distance: f64| {
            let r = sphere.radius();
            (((r - distance) * (r + distance)).max(0.0) / a).sqrt()
        };
        if distance - margin > sphere.radius() {
            return None;
        }
        let certain = distance + margin < sphere.radius();
        let (outer, inner) = (half((distance - margin).max(0.0)), half(distance + margin));
        let along = moved.length() / a.sqrt() + SPHERE * reach;
        let root = |near: f64, far: f64| {
            let (low, high) = (closest + near, closest + far);
            let off = |t: f64| along + 2.0 * U * t.abs();
            Found {
                t: [low - off(low), high + off(high)],
                certain,
            }
        };
        let enter = root(-outer, -inner).within(ray);
        let leave = root(inner, outer).within(ray);
        match (enter, leave) {
            (Some(first), _) if first.certain => Some(first),
            (Some(first), Some(second)) => Some(Found {
                t: [first.t[0], second.t[1]],
                certain: second.certain,
            }),
            (first, second) => first.or(second),
        }
    }
}
