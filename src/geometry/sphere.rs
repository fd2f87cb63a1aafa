//! Spheres, in double precision from the parser to the hit.

use super::placement::Placement;
use crate::math::{Bounds3, DAffine3, DVec3, Vec3};

/// A sphere around the origin of its object space. An affine transform may make it an ellipsoid; it does not move by itself
/// (an instance can move it).
#[derive(Clone, Debug)]
pub struct Sphere {
    radius: f64,
    placement: Placement,
}

/// Where a ray enters and leaves a sphere, in units of the ray's direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereHits {
    /// The nearer one.
    pub enter: f64,
    /// The farther one.
    pub leave: f64,
}

impl Sphere {
    /// A sphere of `radius` (positive) about the object space origin; `None` if the transform is singular.
    pub fn new(radius: f64, world_from_object: DAffine3) -> Option<Self> {
        let placement = Placement::new(world_from_object)?;
        (radius.is_finite() && radius > 0.0).then_some(Self { radius, placement })
    }

    /// A sphere of `radius` around `center`.
    pub fn at(center: DVec3, radius: f64) -> Option<Self> {
        Self::new(radius, DAffine3::from_translation(center))
    }

    /// With the geometric normal pointing inward.
    #[must_use]
    pub fn with_flipped_normal(mut self, flip: bool) -> Self {
        self.placement.flip_normal = flip;
        self
    }

    /// Whether the geometric normal points inward.
    pub fn has_flipped_normal(&self) -> bool {
        self.placement.flip_normal
    }

    /// Radius in object space.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The centre, in world space (or that of the group).
    pub fn center(&self) -> DVec3 {
        self.placement.world_from_object.translation
    }

    /// Object space to world space (or that of the group).
    pub fn world_from_object(&self) -> &DAffine3 {
        &self.placement.world_from_object
    }

    /// The centre of a sphere that its transform only moves, in world space (or that of the group).
    pub fn only_moved_by(&self) -> Option<DVec3> {
        self.placement.only_moved_by
    }

    /// World space to object space.
    pub fn object_from_world(&self) -> &DAffine3 {
        &self.placement.object_from_world
    }

    /// A box around it.
    pub fn bounds(&self) -> Bounds3 {
        self.placement.box_around([(DVec3::ZERO, self.radius)])
    }

    /// Where the infinite line of a ray meets the sphere; `None` where it misses.
    #[inline]
    pub fn intersect(&self, origin: DVec3, direction: DVec3) -> Option<SphereHits> {
        let (o, d) = self.placement.ray(origin, direction);
        let [first, second] = line_roots(o, d, self.radius)?;
        Some(SphereHits {
            enter: first.min(second),
            leave: first.max(second),
        })
    }

    /// The nearest hit in [tnear, tfar].
    #[inline]
    pub fn nearest(&self, origin: Vec3, direction: Vec3, tnear: f32, tfar: f32) -> Option<f64> {
        let hits = self.intersect(origin.as_dvec3(), direction.as_dvec3())?;
        let inside = f64::from(tnear)..=f64::from(tfar);
        [hits.enter, hits.leave].into_iter().find(|t| inside.contains(t))
    }
}

/// The distances, in units of `d`, at which a line from `o` along `d` is `radius` away from the origin; `None` if it never is, or if
/// `d` is zero.
///
/// The discriminant is taken from the distance of the origin to the line, which does not cancel for a small sphere far away,
/// and the roots by the stable form of the quadratic (Haines et al. 2019, "Precision Improvements for Ray/Sphere
/// Intersection").
#[inline]
pub(super) fn line_roots(o: DVec3, d: DVec3, radius: f64) -> Option<[f64; 2]> {
    let quadratic = Quadratic::new(o, d, radius);
    (quadratic.discriminant >= 0.0).then(|| quadratic.roots())
}

/// The same; NaN for none.
#[inline(always)]
pub(crate) fn line_roots_or_nan(o: DVec3, d: DVec3, radius: f64) -> [f64; 2] {
    let quadratic = Quadratic::new(o, d, radius);
    let roots = quadratic.roots();
    if quadratic.discriminant >= 0.0 {
        roots
    } else {
        [f64::NAN; 2]
    }
}

/// a t² - 2 b t + c = 0, and its discriminant over a.
struct Quadratic {
    a: f64,
    b: f64,
    c: f64,
    /// NaN if there is no direction.
    discriminant: f64,
}

impl Quadratic {
    #[inline(always)]
    fn new(o: DVec3, d: DVec3, radius: f64) -> Self {
        let a = d.length_squared();
        let b = -o.dot(d);
        let to_line = o + d * (b / a);
        // |o|² - r² by a difference of lengths: exact to the last bits where the ray starts on the sphere.
        let distance = o.length();
        Self {
            a,
            b,
            c: (distance - radius) * (distance + radius),
            discriminant: radius * radius - to_line.length_squared(),
        }
    }

    #[inline(always)]
    fn roots(&self) -> [f64; 2] {
        let q = self.b + (self.a * self.discriminant).sqrt().copysign(self.b);
        if q == 0.0 { [0.0, 0.0] } else { [self.c / q, q / self.a] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_huge_sphere_is_met_exactly_from_inside() {
        // The left wall of smallpt: radius 1e5, its surface at x = 1.
        let wall = Sphere::at(DVec3::new(1e5 + 1.0, 40.8, 81.6), 1e5).unwrap();
        let t = wall
            .nearest(Vec3::new(50.0, 40.8, 81.6), Vec3::NEG_X, 0.0, f32::INFINITY)
            .unwrap();
        assert!((t - 49.0).abs() < 1e-10, "{t}");
    }

    #[test]
    fn a_ray_that_starts_just_outside_does_not_hit_the_sphere_it_left() {
        let wall = Sphere::at(DVec3::new(1e5 + 1.0, 40.8, 81.6), 1e5).unwrap();
        let outside = Vec3::new(1.0_f32.next_down(), 40.8, 81.6);
        assert_eq!(wall.nearest(outside, Vec3::NEG_X, 0.0, f32::INFINITY), None);
    }

    #[test]
    fn an_ellipsoid_is_met_where_its_equation_says() {
        let m = DAffine3::from_scale_rotation_translation(
            DVec3::new(3.0, 1.0, 0.5),
            crate::math::DQuat::from_rotation_z(0.5),
            DVec3::new(1.0, 2.0, 3.0),
        );
        let sphere = Sphere::new(2.0, m).unwrap();
        let (origin, direction) = (DVec3::new(10.0, 3.0, 3.5), DVec3::new(-2.0, -0.1, -0.05));
        let hits = sphere.intersect(origin, direction).unwrap();
        for t in [hits.enter, hits.leave] {
            let p = origin + direction * t;
            assert!((m.inverse().transform_point3(p).length() - 2.0).abs() < 1e-12);
        }
        assert!(hits.enter < hits.leave);
    }

    #[test]
    fn bounds_are_tight_for_a_rotated_sphere() {
        let m = DAffine3::from_rotation_z(0.7) * DAffine3::from_scale(DVec3::splat(2.0));
        let bounds = Sphere::new(1.0, m).unwrap().bounds();
        assert!((bounds.extent() - Vec3::splat(4.0)).length() < 1e-5);
    }
}
