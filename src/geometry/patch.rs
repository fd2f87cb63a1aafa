//! Bilinear patches: four corners p00, p10, p01, p11, and between them p(u, v) linear in u and in v.
//!
//! A line meets a patch where it meets one of the straight lines of constant u: a quadratic equation in u (Ramsey, Potter and
//! Hansen 2004; in the form of Reshetov 2019, "Cool Patches"), solved in double precision.

use crate::math::{Bounds3, DVec2, DVec3};

/// One bilinear patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// p00, p10, p01, p11.
    pub corners: [DVec3; 4],
}

/// Where a line meets a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchHit {
    /// Distance in units of the direction.
    pub t: f64,
    /// Parameters, in [0, 1]².
    pub uv: DVec2,
}

impl Patch {
    /// The point at the parameters.
    #[inline]
    pub fn point(&self, uv: DVec2) -> DVec3 {
        mix(&self.corners, uv)
    }

    /// The derivatives of the point by u and by v.
    #[inline]
    pub fn derivatives(&self, uv: DVec2) -> [DVec3; 2] {
        let [p00, p10, p01, p11] = self.corners;
        [(p10 - p00).lerp(p11 - p01, uv.y), (p01 - p00).lerp(p11 - p10, uv.x)]
    }

    /// The cross product of the derivatives; where they have none, the nearest there is towards the middle.
    pub fn cross(&self, uv: DVec2) -> DVec3 {
        let at = |uv: DVec2| {
            let [dpdu, dpdv] = self.derivatives(uv);
            dpdu.cross(dpdv)
        };
        let cross = at(uv);
        if cross.length_squared() > 0.0 {
            return cross;
        }
        at(uv.lerp(DVec2::splat(0.5), 1e-3))
    }

    /// A box around it.
    pub fn bounds(&self) -> Bounds3 {
        Bounds3::from_points(self.corners.map(DVec3::as_vec3))
    }

    /// Whether it is flat with opposite sides equal, to the last bit of single precision: then u and v are affine on it.
    pub fn is_parallelogram(&self) -> bool {
        let [p00, p10, p01, p11] = self.corners;
        let largest = self.corners.iter().fold(DVec3::ZERO, |m, p| m.max(p.abs()));
        let gap = ((p11 - p01) - (p10 - p00)).abs();
        gap.cmple(largest * f64::from(f32::EPSILON)).all()
    }

    /// Where a line meets it, at most twice, in no order.
    #[inline]
    pub fn intersect(&self, origin: DVec3, direction: DVec3) -> [Option<PatchHit>; 2] {
        let [p00, p10, p01, p11] = self.corners.map(|p| p - origin);
        let (e00, e11) = (p01 - p00, p11 - p10);
        // The volume spanned by the direction and a line of constant u, as a function a + b u + c u² of u.
        let a = p00.cross(direction).dot(e00);
        let c = (p10 - p00).cross(p01 - p11).dot(direction);
        let b = p10.cross(direction).dot(e11) - a - c;
        let discriminant = b * b - 4.0 * a * c;
        if discriminant.is_nan() || discriminant < 0.0 {
            return [None; 2];
        }
        let q = -0.5 * (b + discriminant.sqrt().copysign(b));
        let at = |u: f64| self.on_line(u, [p00.lerp(p10, u), e00.lerp(e11, u)], direction);
        let first = at(a / q);
        // A flat patch has one root.
        let second = if c == 0.0 || discriminant == 0.0 {
            None
        } else {
            at(q / c)
        };
        [first, second]
    }

    /// Where the line of constant `u`, given by its start relative to the ray's origin and by its extent, meets the ray.
    #[inline]
    fn on_line(&self, u: f64, [start, extent]: [DVec3; 2], direction: DVec3) -> Option<PatchHit> {
        if !(0.0..=1.0).contains(&u) {
            return None;
        }
        let normal = direction.cross(extent);
        let square = normal.length_squared();
        let to_start = normal.cross(start);
        let (t, v) = (to_start.dot(extent) / square, to_start.dot(direction) / square);
        ((0.0..=1.0).contains(&v) && t.is_finite()).then_some(PatchHit {
            t,
            uv: DVec2::new(u, v),
        })
    }

    /// The parameters of a point of the patch where its normal is about `ng`.
    pub fn invert(&self, p: DVec3, ng: DVec3) -> DVec2 {
        let hits = self.intersect(p, ng).into_iter().flatten();
        if let Some(hit) = hits.min_by(|a, b| a.t.abs().total_cmp(&b.t.abs())) {
            return hit.uv;
        }
        // Off the rim by rounding: Newton's method finds the place from within.
        let mut uv = DVec2::splat(0.5);
        for _ in 0..8 {
            let [dpdu, dpdv] = self.derivatives(uv);
            let rest = p - self.point(uv);
            let (uu, uv_, vv) = (dpdu.length_squared(), dpdu.dot(dpdv), dpdv.length_squared());
            let (bu, bv) = (dpdu.dot(rest), dpdv.dot(rest));
            let step = DVec2::new(vv * bu - uv_ * bv, uu * bv - uv_ * bu) / (uu * vv - uv_ * uv_);
            if !step.is_finite() {
                break;
            }
            uv = (uv + step).clamp(DVec2::ZERO, DVec2::ONE);
        }
        uv
    }

    /// The parameters, of a grid over the patch, whose point is nearest to a line.
    pub fn nearest_to_line(&self, origin: DVec3, direction: DVec3) -> DVec2 {
        const STEPS: usize = 16;
        let along = direction.normalize();
        let distance = |uv: DVec2| (self.point(uv) - origin).cross(along).length_squared();
        let places = (0..=STEPS).flat_map(|y| (0..=STEPS).map(move |x| DVec2::new(x as f64, y as f64) / STEPS as f64));
        places
            .min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
            .unwrap_or(DVec2::splat(0.5))
    }
}

/// Bilinear interpolation of what the corners have.
#[inline]
pub(super) fn mix<T>(corners: &[T; 4], uv: DVec2) -> T
where
    T: Copy + std::ops::Mul<f64, Output = T> + std::ops::Add<Output = T>,
{
    let [a, b, c, d] = *corners;
    (a * (1.0 - uv.x) + b * uv.x) * (1.0 - uv.y) + (c * (1.0 - uv.x) + d * uv.x) * uv.y
}

#[cfg(test)]
mod tests {
    use super::*;

    fn twisted() -> Patch {
        Patch {
            corners: [
                DVec3::new(-1.0, -1.0, 0.3),
                DVec3::new(1.2, -0.8, -0.5),
                DVec3::new(-0.9, 1.1, -0.6),
                DVec3::new(1.0, 0.9, 0.7),
            ],
        }
    }

    fn places() -> impl Iterator<Item = DVec2> {
        (0..100).map(|i| DVec2::new(f64::from(i % 10), f64::from(i / 10)) / 9.0)
    }

    #[test]
    fn lines_through_a_point_meet_it_there() {
        let flat = Patch {
            corners: [DVec3::ZERO, DVec3::X, DVec3::Y * 2.0, DVec3::new(0.7, 1.2, 0.0)],
        };
        let square = Patch {
            corners: [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 0.0)],
        };
        for patch in [twisted(), flat, square] {
            for uv in places() {
                // A little inside, so that rounding does not leave the patch.
                let uv = DVec2::splat(1e-9) + uv * (1.0 - 2e-9);
                for direction in [DVec3::new(0.1, 0.2, -3.0), DVec3::new(1.0, 1.0, 0.4), DVec3::Z] {
                    let p = patch.point(uv);
                    let hits = patch.intersect(p - direction * 5.0, direction);
                    let is_it = |hit: &PatchHit| (hit.t - 5.0).abs() < 1e-7 && (hit.uv - uv).length() < 1e-6;
                    assert!(hits.iter().flatten().any(is_it), "{patch:?} {uv} {direction}: {hits:?}");
                }
                let normal = patch.cross(uv).normalize();
                assert!((patch.invert(patch.point(uv), normal) - uv).length() < 1e-7);
            }
        }
    }

    #[test]
    fn what_is_met_is_on_the_line_and_on_the_patch() {
        let patch = twisted();
        let mut twice = 0;
        for i in 0..10_000 {
            let angle = f64::from(i) * 0.7;
            let origin = DVec3::new(3.0 * angle.sin(), 3.0 * (1.3 * angle).cos(), 0.1 * (2.1 * angle).sin());
            let target = DVec3::new((3.7 * angle).sin(), (2.9 * angle).cos(), 0.0);
            let hits = patch.intersect(origin, target - origin);
            twice += usize::from(hits.iter().flatten().count() == 2);
            for hit in hits.iter().flatten() {
                let (on_line, on_patch) = (origin + (target - origin) * hit.t, patch.point(hit.uv));
                assert!((on_line - on_patch).length() < 1e-9);
            }
        }
        assert!(twice > 100, "{twice}");
    }

    #[test]
    fn parallelograms_are_known() {
        assert!(!twisted().is_parallelogram());
        let [a, b, c] = [
            DVec3::new(5.0, 1.0, 2.0),
            DVec3::new(1.0, 2.0, 0.5),
            DVec3::new(0.0, -1.0, 3.0),
        ];
        let corners = [a, a + b, a + c, a + b + c];
        assert!(Patch { corners }.is_parallelogram());
        let corners = [a, a + b, a + c, a + b + c + DVec3::X * 1e-3];
        assert!(!Patch { corners }.is_parallelogram());
    }
}
