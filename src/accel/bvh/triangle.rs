//! The watertight test of a ray against a triangle: Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection",
//! JCGT 2(1).
//!
//! The ray is moved to the origin and sheared onto the axis of its greatest direction component. What remains is whether the
//! origin lies in a triangle of the plane, which the signs of three edge functions say. Each is a difference of two products
//! that are rounded alike for both triangles at an edge (so never fused into a multiply-add), and rounding is monotonic: a sign
//! other than zero is exact. Where the difference is zero, it is taken again in double precision, which is exact. So a ray
//! cannot pass between two triangles that share an edge.
//!
//! The distance is not the paper's, which interpolates those of the corners and is off by their rounding: it is that to the
//! triangle's plane, in double precision. A ray that starts beyond the plane by however little does not meet it, and slivers
//! are met where they are. It is kept within the triangle's box, however the ray grazes the plane: so no box around a triangle begins
//! behind a hit on it, and what a ray hits does not depend on the order in which boxes are visited.
//!
//! This is the one lane version. The kernels do the same operations in the same order and agree to the last bit.

use super::ray::{LEAST_SLOPE, MARGIN};

/// The part of a ray that the triangle test needs. The axes are in the order of the sheared space: z is that of the greatest
/// direction component.
#[derive(Clone, Copy, Debug)]
pub struct Shear {
    /// Which axis of the ray's space each is.
    pub axes: [usize; 3],
    /// Origin, by the axes of the ray's space.
    pub origin: [f32; 3],
    /// Direction, by the axes of the ray's space.
    pub direction: [f32; 3],
    /// Direction x and y over z, and 1 over z.
    pub scale: [f32; 3],
    /// 1 over direction x and y, of which none counts as less than [`LEAST_SLOPE`] of z.
    pub inverse: [f32; 2],
}

/// What the kernels ask of a ray.
pub trait Shears: Copy {
    /// See [`Shear::axes`].
    fn axis(self, i: usize) -> usize;
    /// See [`Shear::origin`].
    fn origin(self, i: usize) -> f32;
    /// See [`Shear::direction`].
    fn direction(self, i: usize) -> f32;
    /// See [`Shear::scale`].
    fn scale(self, i: usize) -> f32;
    /// See [`Shear::inverse`].
    fn inverse(self, i: usize) -> f32;
    /// All of it.
    fn shear(self) -> Shear;
}

impl Shears for &Shear {
    #[inline(always)]
    fn axis(self, i: usize) -> usize {
        self.axes[i]
    }
    #[inline(always)]
    fn origin(self, i: usize) -> f32 {
        self.origin[i]
    }
    #[inline(always)]
    fn direction(self, i: usize) -> f32 {
        self.direction[i]
    }
    #[inline(always)]
    fn scale(self, i: usize) -> f32 {
        self.scale[i]
    }
    #[inline(always)]
    fn inverse(self, i: usize) -> f32 {
        self.inverse[i]
    }
    #[inline(always)]
    fn shear(self) -> Shear {
        *self
    }
}

impl Shear {
    /// For a direction that is not zero.
    #[inline(always)]
    pub fn new(origin: [f32; 3], direction: [f32; 3]) -> Self {
        let size = direction.map(f32::abs);
        let z = if size[0] > size[1] && size[0] > size[2] {
            0
        } else if size[1] > size[2] {
            1
        } else {
            2
        };
        let x = if z == 2 { 0 } else { z + 1 };
        let y = if x == 2 { 0 } else { x + 1 };
        let axes = [x, y, z];
        Self {
            axes,
            origin,
            direction,
            scale: [
                direction[x] / direction[z],
                direction[y] / direction[z],
                1.0 / direction[z],
            ],
            inverse: [x, y].map(|axis| {
                let slope = direction[axis].abs().max(LEAST_SLOPE * direction[z].abs());
                1.0 / slope.copysign(direction[axis])
            }),
        }
    }

    /// Distance to a triangle; `None` for a miss. A triangle without area is never hit.
    #[inline(always)]
    pub fn distance(&self, corners: &[[f32; 3]; 3]) -> Option<f32> {
        let sheared = self.sheared(corners);
        if !sheared.is_origin_inside() {
            return None;
        }
        let plane = Plane::new(corners);
        let t = plane.distance(self.origin, self.direction);
        let [enter, leave] = match self.range(corners, sheared.z) {
            range if range[0] <= range[1] => range,
            _ => self.wide_range(corners),
        };
        let within = |t: f32| least(greatest(t, enter), leave);
        if t.is_finite() {
            Some(within(t as f32))
        } else if plane.has_area() {
            sheared.resolve().map(|hit| within(hit.t))
        } else {
            None
        }
    }

    /// Where the ray enters and leaves the box of a triangle, whose corners are at the distances `z` along it. A ray that meets the
    /// triangle only by rounding may miss its box.
    #[inline(always)]
    fn range(&self, corners: &[[f32; 3]; 3], z: [f32; 3]) -> [f32; 2] {
        let along = |i: usize| {
            let axis = self.axes[i];
            corners.map(|corner| (corner[axis] - self.origin[axis]) * self.inverse[i])
        };
        let ([ax, bx, cx], [ay, by, cy], [az, bz, cz]) = (along(0), along(1), z);
        let enter = |a, b, c| least(least(a, b), c);
        let leave = |a, b, c| greatest(greatest(a, b), c);
        [
            leave(enter(ax, bx, cx), enter(ay, by, cy), enter(az, bz, cz)),
            enter(leave(ax, bx, cx), leave(ay, by, cy), leave(az, bz, cz)),
        ]
    }

    /// The same of the box grown across the ray by what rounding may move the triangle there, which is less than the [`MARGIN`] by
    /// which the boxes of nodes are grown. Along the ray, nothing is moved.
    #[cold]
    #[inline(never)]
    fn wide_range(&self, corners: &[[f32; 3]; 3]) -> [f32; 2] {
        let share = 0.75 * f64::from(MARGIN);
        let most = |v: [f64; 3]| v[0].max(v[1]).max(v[2]);
        let rows = self.axes.map(|axis| corners.map(|corner| f64::from(corner[axis])));
        let origin = self.axes.map(|axis| f64::from(self.origin[axis]));
        let size = rows.map(|row| most(row.map(f64::abs)));
        let inverse = [self.inverse[0], self.inverse[1], self.scale[2]].map(f64::from);
        let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in 0..3 {
            let grown = match axis {
                2 => 0.0,
                _ => share * (size[axis] + most(size) + origin[axis].abs() + most(origin.map(f64::abs))),
            };
            let high = most(rows[axis]) + grown;
            let low = -most(rows[axis].map(|x| -x)) - grown;
            let [a, b] = [low, high].map(|plane| (plane - origin[axis]) * inverse[axis]);
            enter = enter.max(a.min(b));
            leave = leave.min(a.max(b));
        }
        [enter as f32, leave as f32]
    }

    /// Barycentric coordinates of the second and third corner where the ray hits the triangle; zero for a miss.
    pub fn barycentrics(&self, corners: &[[f32; 3]; 3]) -> [f32; 2] {
        self.sheared(corners).resolve().map_or([0.0; 2], |hit| [hit.u, hit.v])
    }

    #[inline(always)]
    fn sheared(&self, corners: &[[f32; 3]; 3]) -> Sheared {
        let mut result = Sheared {
            x: [0.0; 3],
            y: [0.0; 3],
            z: [0.0; 3],
        };
        let [x, y, z] = self.axes;
        for (i, corner) in corners.iter().enumerate() {
            let depth = corner[z] - self.origin[z];
            result.x[i] = (corner[x] - self.origin[x]) - self.scale[0] * depth;
            result.y[i] = (corner[y] - self.origin[y]) - self.scale[1] * depth;
            result.z[i] = self.scale[2] * depth;
        }
        result
    }
}

/// The corners of a triangle in the sheared space of a ray: x and y across it, z along it in units of its direction.
struct Sheared {
    x: [f32; 3],
    y: [f32; 3],
    z: [f32; 3],
}

/// A hit found in double precision.
struct Resolved {
    t: f32,
    u: f32,
    v: f32,
}

impl Sheared {
    /// Whether the ray passes through the triangle or its boundary.
    #[inline(always)]
    fn is_origin_inside(&self) -> bool {
        let ([ax, bx, cx], [ay, by, cy]) = (self.x, self.y);
        let u = cx * by - cy * bx;
        let v = ax * cy - ay * cx;
        let w = bx * ay - by * ax;
        let (below, above) = (u < 0.0 || v < 0.0 || w < 0.0, u > 0.0 || v > 0.0 || w > 0.0);
        if below && above {
            return false;
        }
        // Zero, or NaN where the products overflow.
        let is_sure = |volume: f32| volume.abs() > 0.0;
        (is_sure(u) && is_sure(v) && is_sure(w)) || self.resolve().is_some()
    }

    /// Where the ray passes through the triangle, with edge functions in double precision, where their products are exact.
    #[cold]
    #[inline(never)]
    fn resolve(&self) -> Option<Resolved> {
        let ([ax, bx, cx], [ay, by, cy]) = (self.x.map(f64::from), self.y.map(f64::from));
        let [az, bz, cz] = self.z.map(f64::from);
        let u = cx * by - cy * bx;
        let v = ax * cy - ay * cx;
        let w = bx * ay - by * ax;
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        let sum = u + v + w;
        if sum == 0.0 || !sum.is_finite() {
            return None;
        }
        Some(Resolved {
            t: ((u * az + v * bz + w * cz) / sum) as f32,
            u: (v / sum) as f32,
            v: (w / sum) as f32,
        })
    }
}

/// The plane of a triangle.
pub struct Plane {
    /// One of its corners.
    pub corner: [f64; 3],
    /// Twice its area, across it.
    pub normal: [f64; 3],
}

impl Plane {
    #[inline(always)]
    pub fn new(corners: &[[f32; 3]; 3]) -> Self {
        let [a, b, c] = corners.map(|corner| corner.map(f64::from));
        let e = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
        let f = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
        Self {
            corner: a,
            normal: [
                e[1] * f[2] - e[2] * f[1],
                e[2] * f[0] - e[0] * f[2],
                e[0] * f[1] - e[1] * f[0],
            ],
        }
    }

    /// Along a ray; not finite if it is parallel to the plane.
    #[inline(always)]
    pub fn distance(&self, origin: [f32; 3], direction: [f32; 3]) -> f64 {
        let (a, n) = (&self.corner, &self.normal);
        let [ox, oy, oz] = origin.map(f64::from);
        let [dx, dy, dz] = direction.map(f64::from);
        let height = (n[0] * (a[0] - ox) + n[1] * (a[1] - oy)) + n[2] * (a[2] - oz);
        height / ((n[0] * dx + n[1] * dy) + n[2] * dz)
    }

    /// Whether the triangle has any.
    #[inline(always)]
    pub fn has_area(&self) -> bool {
        self.normal != [0.0; 3]
    }
}

/// The lesser; `b` where either is NaN, as the vector instruction has it.
#[inline(always)]
pub fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The greater; `b` where either is NaN, as the vector instruction has it.
#[inline(always)]
pub fn greatest(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hit(direction: [f32; 3], corners: [[f32; 3]; 3]) -> Option<f32> {
        Shear::new([0.0; 3], direction).distance(&corners)
    }

    #[test]
    fn both_triangles_at_an_edge_or_a_vertex_are_hit_there() {
        let quad = [[-1.0, -1.0, 2.0], [1.0, -1.0, 2.0], [1.0, 1.0, 2.0], [-1.0, 1.0, 2.0]];
        for (direction, name) in [([0.0, 0.0, 1.0], "edge"), ([1.0, 1.0, 2.0], "vertex")] {
            for corners in [[0, 1, 2], [0, 2, 3], [2, 1, 0], [3, 2, 0]] {
                let t = hit(direction, corners.map(|i| quad[i]));
                assert_eq!(t, Some(2.0 / direction[2]), "{name} {corners:?}");
            }
        }
    }

    #[test]
    fn triangles_without_area_are_missed() {
        let (a, b) = ([-1.0, 0.0, 1.0], [1.0, 0.0, 1.0]);
        assert_eq!(hit([0.0, 0.0, 1.0], [a, b, b]), None);
        assert_eq!(hit([0.0, 0.0, 1.0], [a, b, [0.0, 0.0, 1.0]]), None);
        assert_eq!(hit([0.0, 0.0, 1.0], [[0.0, 0.0, 1.0]; 3]), None);
    }

    #[test]
    fn tiny_and_huge_triangles_are_hit_where_they_are() {
        for scale in [1e-30_f32, 1e-18, 1.0, 1e18, 1e30] {
            let corners =
                [[-1.0, -1.0, 2.0], [1.0, -1.0, 2.0], [0.1, 1.0, 2.0]].map(|c: [f32; 3]| c.map(|x| x * scale));
            assert_eq!(hit([0.0, 0.0, 1.0], corners), Some(2.0 * scale));
        }
    }

    #[test]
    fn a_ray_that_leaves_the_plane_of_an_axis_does_not_meet_it() {
        let corners = [[-3.1, 0.0, -2.7], [5.3, 0.0, 1.1], [0.2, 0.0, 7.9]];
        for i in 0..1000 {
            let direction = [
                (i as f32 * 0.37).sin(),
                1e-3 + (i % 7) as f32 * 0.1,
                (i as f32 * 0.91).cos(),
            ];
            let t = Shear::new([0.6, 0.0, 1.7], direction).distance(&corners);
            assert!(t.is_none_or(|t| t <= 0.0), "{t:?}");
        }
    }
}
