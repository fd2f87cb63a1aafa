//! Orthonormal frames.

use super::Vec3;

/// A right-handed orthonormal basis; local z is the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Local x, in world space.
    pub s: Vec3,
    /// Local y, in world space.
    pub t: Vec3,
    /// Local z, in world space.
    pub n: Vec3,
}

impl Frame {
    /// Some frame with normal `n` (unit length): Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
    #[inline(always)]
    pub fn from_normal(n: Vec3) -> Self {
        let sign = 1.0_f32.copysign(n.z);
        let a = -1.0 / (sign + n.z);
        let b = n.x * n.y * a;
        Self {
            s: Vec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
            t: Vec3::new(b, sign + n.y * n.y * a, -n.y),
            n,
        }
    }

    /// The frame with normal `n` (unit length) whose `s` is `tangent` made orthogonal to it; falls back to
    /// [`Frame::from_normal`] where the two are parallel or the tangent is zero.
    #[inline(always)]
    pub fn from_normal_tangent(n: Vec3, tangent: Vec3) -> Self {
        let s = (tangent - n * n.dot(tangent)).normalize_or(Vec3::ZERO);
        // Once more: where the tangent is nearly parallel to the normal, the first difference is mostly rounding.
        let s = (s - n * n.dot(s)).normalize_or(Vec3::ZERO);
        let t = n.cross(s);
        let other = Self::from_normal(n);
        let is_parallel = (s.x == 0.0) & (s.y == 0.0) & (s.z == 0.0);
        let select = |other: Vec3, this: Vec3| {
            let select = |other, this| if is_parallel { other } else { this };
            Vec3::new(
                select(other.x, this.x),
                select(other.y, this.y),
                select(other.z, this.z),
            )
        };
        Self {
            s: select(other.s, s),
            t: select(other.t, t),
            n,
        }
    }

    /// World direction to local.
    #[inline(always)]
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(v.dot(self.s), v.dot(self.t), v.dot(self.n))
    }

    /// Local direction to world.
    #[inline(always)]
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        self.s * v.x + self.t * v.y + self.n * v.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn frames_are_orthonormal_and_right_handed_in_every_direction() {
        for i in 0..1000 {
            let z = 1.0 - 2.0 * (i as f32 + 0.5) / 1000.0;
            let (sin, cos) = (i as f32 * 2.4).sin_cos();
            let r = (1.0 - z * z).sqrt();
            let n = Vec3::new(r * cos, r * sin, z).normalize();
            for frame in [
                Frame::from_normal(n),
                Frame::from_normal_tangent(n, Vec3::new(0.3, -0.5, 0.2)),
            ] {
                assert_abs_diff_eq!(frame.s.cross(frame.t).dot(frame.n), 1.0, epsilon = 2e-6);
                assert_abs_diff_eq!(frame.s.dot(frame.t), 0.0, epsilon = 1e-6);
                let v = Vec3::new(0.2, 0.7, -0.4);
                assert!((frame.to_world(frame.to_local(v)) - v).length() < 1e-6);
            }
        }
    }
}
