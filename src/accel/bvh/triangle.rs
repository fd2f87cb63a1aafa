//! The watertight test of a ray against a triangle: Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection",
//! JCGT 2(1).
//!
//! The ray is moved to the origin and sheared onto the axis of its greatest direction component. What remains is whether the
//! origin lies in a triangle of the plane, which the signs of three edge functions say. Each is a difference of two products
//! that are rounded alike for both triangles at an edge (so never fused into a multiply-add), and rounding is monotonic: a sign
//! other than zero is exact. Where the difference is zero, it is taken again in double precision, which is exact. So a ray
//! cannot pass between two triangles that share an edge.
//!
//! This is the one lane version. The kernels do the same operations in the same order and agree to the last bit.

/// The part of a ray that the triangle test needs.
#[derive(Clone, Copy, Debug)]
pub struct Shear {
    /// The axes in the order x, y, z of the sheared space; z is that of the greatest direction component.
    pub axes: [usize; 3],
    /// Origin, in that order.
    pub origin: [f32; 3],
    /// Direction x and y over z, and 1 over z.
    pub scale: [f32; 3],
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
        let inverse = 1.0 / direction[z];
        Self {
            axes: [x, y, z],
            origin: [origin[x], origin[y], origin[z]],
            scale: [direction[x] / direction[z], direction[y] / direction[z], inverse],
        }
    }

    /// The corners of a triangle in sheared space; z is the distance along the ray.
    #[inline(always)]
    pub fn corners(&self, corners: &[[f32; 3]; 3]) -> Sheared {
        let mut result = Sheared {
            x: [0.0; 3],
            y: [0.0; 3],
            z: [0.0; 3],
        };
        for (i, corner) in corners.iter().enumerate() {
            let z = corner[self.axes[2]] - self.origin[2];
            result.x[i] = (corner[self.axes[0]] - self.origin[0]) - self.scale[0] * z;
            result.y[i] = (corner[self.axes[1]] - self.origin[1]) - self.scale[1] * z;
            result.z[i] = self.scale[2] * z;
        }
        result
    }
}

/// The corners of a triangle in the sheared space of a ray.
#[derive(Clone, Copy, Debug)]
pub struct Sheared {
    /// Across the ray.
    pub x: [f32; 3],
    /// Across the ray.
    pub y: [f32; 3],
    /// Distance along the ray, in units of its direction.
    pub z: [f32; 3],
}

/// Outside this range a sum of edge functions is taken again in double precision: its terms may have lost bits to underflow, or
/// its reciprocal would.
pub const DETERMINANTS: [f32; 2] = [1e-30, 1e30];

impl Sheared {
    /// Distance to the triangle; `None` for a miss. A triangle without area is never hit.
    #[inline(always)]
    pub fn distance(&self) -> Option<f32> {
        let ([ax, bx, cx], [ay, by, cy], [az, bz, cz]) = (self.x, self.y, self.z);
        let u = cx * by - cy * bx;
        let v = ax * cy - ay * cx;
        let w = bx * ay - by * ax;
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        let determinant = (u + v) + w;
        let size = determinant.abs();
        let is_exact = u != 0.0 && v != 0.0 && w != 0.0 && size > DETERMINANTS[0] && size < DETERMINANTS[1];
        if !is_exact {
            return self.resolve().map(|hit| hit.t);
        }
        let inverse = 1.0 / determinant;
        let t = ((u * inverse) * az + (v * inverse) * bz) + (w * inverse) * cz;
        Some(clamp(t, self.z))
    }

    /// Barycentric coordinates of the second and third corner where the ray hits the triangle; zero for a miss.
    pub fn barycentrics(&self) -> [f32; 2] {
        self.resolve().map_or([0.0; 2], |hit| [hit.u, hit.v])
    }

    /// [`Sheared::distance`] in double precision, where the products of the edge functions are exact; with the barycentrics.
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
        let determinant = u + v + w;
        if determinant == 0.0 || !determinant.is_finite() {
            return None;
        }
        let t = (u * az + v * bz + w * cz) / determinant;
        Some(Resolved {
            t: clamp(t as f32, self.z),
            u: (v / determinant) as f32,
            v: (w / determinant) as f32,
        })
    }
}

/// A hit found in double precision.
#[derive(Clone, Copy, Debug)]
struct Resolved {
    /// Distance.
    t: f32,
    /// Barycentric coordinate of the second corner.
    u: f32,
    /// Barycentric coordinate of the third corner.
    v: f32,
}

/// Keeps a distance between those of the corners, whatever the edge functions of a sliver have lost.
#[inline(always)]
fn clamp(t: f32, [a, b, c]: [f32; 3]) -> f32 {
    least(greatest(t, least(least(a, b), c)), greatest(greatest(a, b), c))
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
        Shear::new([0.0; 3], direction).corners(&corners).distance()
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
    fn tiny_and_huge_triangles_are_hit() {
        for scale in [1e-30_f32, 1e-18, 1.0, 1e18, 1e30] {
            let corners =
                [[-1.0, -1.0, 2.0], [1.0, -1.0, 2.0], [0.1, 1.0, 2.0]].map(|c: [f32; 3]| c.map(|x| x * scale));
            let t = hit([0.0, 0.0, 1.0], corners).expect("a hit");
            assert!((t / scale - 2.0).abs() < 1e-6, "{t} at scale {scale}");
        }
    }
}
