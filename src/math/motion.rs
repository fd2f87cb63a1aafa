//! Affine transforms that change over time.
//!
//! A motion is given by its transform at scene time 0 and at scene time 1. Both are decomposed as M = T R S, with translation T,
//! rotation R (a unit quaternion) and an upper triangular S (scale and skew): the factors of Embree's
//! `RTCQuaternionDecomposition`. T and S are interpolated linearly, R along the shorter arc of the sphere of unit quaternions.
//! (pbrt-v4 decomposes by polar decomposition; the two motions are the same unless a rotation turns something that was scaled
//! unevenly along other axes than its own.)

use super::{Bounds3, DAffine3, DMat3, DQuat, DVec3, Vec3};

/// M = T R S.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decomposition {
    /// T.
    pub translation: DVec3,
    /// R, of unit length.
    pub rotation: DQuat,
    /// S, upper triangular; its diagonal is negative where M mirrors.
    pub scale_skew: DMat3,
}

impl Decomposition {
    /// Decomposes an invertible affine transform by Gram-Schmidt (a QR decomposition).
    fn of(m: &DAffine3) -> Self {
        let [a, b] = [m.matrix3.x_axis, m.matrix3.y_axis];
        let q0 = a.normalize();
        let q1 = (b - q0 * q0.dot(b)).normalize();
        // A proper rotation even if M mirrors: S then has a negative last element.
        let q = DMat3::from_cols(q0, q1, q0.cross(q1));
        let mut scale_skew = q.transpose() * m.matrix3;
        scale_skew.x_axis.y = 0.0;
        scale_skew.x_axis.z = 0.0;
        scale_skew.y_axis.z = 0.0;
        Self {
            translation: m.translation,
            rotation: DQuat::from_mat3(&q).normalize(),
            scale_skew,
        }
    }

    /// T R S.
    pub fn compose(&self) -> DAffine3 {
        DAffine3 {
            matrix3: DMat3::from_quat(self.rotation) * self.scale_skew,
            translation: self.translation,
        }
    }
}

/// An affine transform as a function of scene time.
#[derive(Clone, Debug, PartialEq)]
pub struct AnimatedTransform {
    start: DAffine3,
    start_inverse: DAffine3,
    moving: Option<Box<[Decomposition; 2]>>,
}

impl AnimatedTransform {
    /// A transform that does not move; `None` if it is singular or not finite.
    pub fn fixed(transform: DAffine3) -> Option<Self> {
        let inverse = invert(&transform)?;
        Some(Self {
            start: transform,
            start_inverse: inverse,
            moving: None,
        })
    }

    /// The motion from `start` at time 0 to `end` at time 1; `None` if either is singular or not finite.
    pub fn new(start: DAffine3, end: DAffine3) -> Option<Self> {
        let mut result = Self::fixed(start)?;
        if start != end {
            invert(&end)?;
            let first = Decomposition::of(&start);
            let mut last = Decomposition::of(&end);
            if first.rotation.dot(last.rotation) < 0.0 {
                last.rotation = -last.rotation;
            }
            // A mirrored and an unmirrored transform have no motion between them.
            if start.matrix3.determinant() * end.matrix3.determinant() < 0.0 {
                return None;
            }
            result.moving = Some(Box::new([first, last]));
        }
        Some(result)
    }

    /// The identity.
    pub fn identity() -> Self {
        Self {
            start: DAffine3::IDENTITY,
            start_inverse: DAffine3::IDENTITY,
            moving: None,
        }
    }

    /// Whether it is the same at all times.
    pub fn is_static(&self) -> bool {
        self.moving.is_none()
    }

    /// The decompositions at time 0 and 1 of a motion; their quaternions lie in one hemisphere. `None` if static.
    pub fn decompositions(&self) -> Option<&[Decomposition; 2]> {
        self.moving.as_deref()
    }

    /// The transform at `time`, in [0, 1].
    pub fn at(&self, time: f32) -> DAffine3 {
        match &self.moving {
            None => self.start,
            Some(ends) => interpolate(ends, f64::from(time)).compose(),
        }
    }

    /// The inverse of [`AnimatedTransform::at`].
    pub fn inverse_at(&self, time: f32) -> DAffine3 {
        if self.is_static() {
            self.start_inverse
        } else {
            self.at(time).inverse()
        }
    }

    /// `self * inner` as one motion, where that is exactly one: when neither moves, when `self` is static and a rotation with
    /// uniform scale, or when `inner` is static and the scale of `self` is uniform. `None` otherwise.
    pub fn compose(&self, inner: &Self) -> Option<Self> {
        let product = |time| self.at(time) * inner.at(time);
        let exact = match (self.is_static(), inner.is_static()) {
            (true, true) => true,
            (true, false) => is_uniform(&Decomposition::of(&self.start).scale_skew),
            (false, true) => self.decompositions()?.iter().all(|d| is_uniform(&d.scale_skew)),
            (false, false) => false,
        };
        if exact {
            Self::new(product(0.0), product(1.0))
        } else {
            None
        }
    }

    /// A box that holds `bounds` transformed at every time: conservative over the rotation.
    ///
    /// The path of a point is f(t) = T(t) + R(t) S(t) p. Over a step of length h it stays within h²/8 max|f''| of its chord, and
    /// |f''| <= w² |S p| + 2 w |(S1 - S0) p|, w being the angle that R turns by.
    pub fn moving_bounds(&self, bounds: &Bounds3) -> Bounds3 {
        let Some(ends) = &self.moving else {
            return bounds.transformed(&self.start);
        };
        if bounds.is_empty() {
            return *bounds;
        }
        const STEPS: u32 = 32;
        let angle = 2.0 * ends[0].rotation.dot(ends[1].rotation).abs().min(1.0).acos();
        let mut reach = 0.0_f64;
        let mut change = 0.0_f64;
        for corner in bounds.corners() {
            let p = corner.as_dvec3();
            let ends = [ends[0].scale_skew * p, ends[1].scale_skew * p];
            reach = reach.max(ends[0].length()).max(ends[1].length());
            change = change.max((ends[1] - ends[0]).length());
        }
        let step = 1.0 / f64::from(STEPS);
        let sagitta = step * step / 8.0 * (angle * angle * reach + 2.0 * angle * change);
        let mut result = Bounds3::EMPTY;
        for i in 0..=STEPS {
            result = result.union(bounds.transformed(&self.at(i as f32 / STEPS as f32)));
        }
        result.expand((sagitta as f32).next_up())
    }
}

fn interpolate(ends: &[Decomposition; 2], time: f64) -> Decomposition {
    Decomposition {
        translation: ends[0].translation.lerp(ends[1].translation, time),
        rotation: ends[0].rotation.slerp(ends[1].rotation, time),
        scale_skew: ends[0].scale_skew * (1.0 - time) + ends[1].scale_skew * time,
    }
}

fn invert(transform: &DAffine3) -> Option<DAffine3> {
    // Relative to the size of its columns: a scene in microns is not singular.
    let m = &transform.matrix3;
    let volume = m.x_axis.length() * m.y_axis.length() * m.z_axis.length();
    if !transform.is_finite() || volume == 0.0 || m.determinant().abs() <= 1e-14 * volume {
        return None;
    }
    let inverse = transform.inverse();
    inverse.is_finite().then_some(inverse)
}

fn is_uniform(scale_skew: &DMat3) -> bool {
    let s = scale_skew.x_axis.x;
    (*scale_skew - DMat3::from_diagonal(DVec3::splat(s)))
        .to_cols_array()
        .iter()
        .all(|e| e.abs() <= 1e-12 * s.abs())
}

/// Transforms a point and rounds it to `f32`.
#[inline]
pub fn transform_point(transform: &DAffine3, p: Vec3) -> Vec3 {
    transform.transform_point3(p.as_dvec3()).as_vec3()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motion() -> AnimatedTransform {
        let start = DAffine3::from_scale_rotation_translation(
            DVec3::new(1.0, 2.0, 0.5),
            DQuat::from_rotation_z(0.3),
            DVec3::new(1.0, 0.0, 0.0),
        );
        let end = DAffine3::from_scale_rotation_translation(
            DVec3::new(1.5, 1.0, 0.7),
            DQuat::from_rotation_y(2.5),
            DVec3::new(0.0, 3.0, -1.0),
        );
        AnimatedTransform::new(start, end).unwrap()
    }

    #[test]
    fn ends_of_a_motion_are_the_given_transforms_mirrored_ones_too() {
        let mirror = DAffine3::from_scale(DVec3::new(-1.0, 2.0, 1.0)) * DAffine3::from_rotation_x(0.4);
        let sheared = DAffine3::from_mat3(DMat3::from_cols_array(&[-1.0, 0.2, 0.1, 0.3, 2.0, 0.0, 0.5, 0.1, 0.9]));
        let mirrored = AnimatedTransform::new(mirror, sheared).unwrap();
        assert!(mirrored.at(0.0).abs_diff_eq(mirror, 1e-12) && mirrored.at(1.0).abs_diff_eq(sheared, 1e-12));
    }

    #[test]
    fn a_rotation_is_interpolated_along_its_arc() {
        let quarter = DAffine3::from_rotation_z(std::f64::consts::FRAC_PI_2);
        let motion = AnimatedTransform::new(DAffine3::IDENTITY, quarter).unwrap();
        let expected = DAffine3::from_rotation_z(std::f64::consts::FRAC_PI_4);
        assert!(motion.at(0.5).abs_diff_eq(expected, 1e-12));
    }

    #[test]
    fn moving_bounds_hold_every_point_at_every_time() {
        let bounds = Bounds3 {
            min: Vec3::new(-1.0, 0.5, 2.0),
            max: Vec3::new(1.0, 2.0, 5.0),
        };
        let motion = motion();
        let moving = motion.moving_bounds(&bounds);
        for i in 0..=1000 {
            for corner in bounds.corners() {
                let p = transform_point(&motion.at(i as f32 / 1000.0), corner);
                assert!(
                    p.cmpge(moving.min).all() && p.cmple(moving.max).all(),
                    "{p} at step {i} outside {moving:?}"
                );
            }
        }
    }

    #[test]
    fn composition_is_exact_or_refused() {
        let turn = DAffine3::from_rotation_x(0.7) * DAffine3::from_scale(DVec3::splat(3.0));
        let fixed = AnimatedTransform::fixed(turn).unwrap();
        let product = fixed
            .compose(&motion())
            .expect("a similarity after a motion is a motion");
        for time in [0.0, 0.25, 0.5, 1.0] {
            assert!(product.at(time).abs_diff_eq(turn * motion().at(time), 1e-9));
        }
        assert!(motion().compose(&fixed).is_none() && motion().compose(&motion()).is_none());
    }

    #[test]
    fn singular_transforms_are_refused() {
        assert!(AnimatedTransform::fixed(DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0))).is_none());
        assert!(AnimatedTransform::fixed(DAffine3::from_scale(DVec3::splat(1e-9))).is_some());
        assert!(AnimatedTransform::fixed(DAffine3::from_translation(DVec3::new(f64::NAN, 0.0, 0.0))).is_none());
    }
}
