//! What a light bounding volume hierarchy knows of a light, or of several together: where they are, in which directions they
//! emit and how much (Conty Estevez and Kulla 2018, in the form of pbrt-v4, section 12.6.3).

use std::f32::consts::PI;

use crate::math::{Bounds3, Quat, Vec3};

/// Bounds of the emission of lights that are not infinitely far away.
#[derive(Clone, Copy, Debug)]
pub struct LightBounds {
    /// Around all points that emit.
    pub bounds: Bounds3,
    /// Unit axis of the cone that holds all normals: directions of greatest emission.
    pub axis: Vec3,
    /// Cosine of that cone's half angle; -1 for all directions.
    pub cos_normals: f32,
    /// Cosine of the greatest angle to a normal at which anything is emitted.
    pub cos_emission: f32,
    /// The greatest photometric intensity, radiance times area for a surface: summed over the lights.
    pub intensity: f32,
    /// Whether the same goes for the opposite directions.
    pub two_sided: bool,
}

impl LightBounds {
    /// Bounds of a light at the point `p`, or of what is small enough to be one, that emits in all directions.
    pub fn omnidirectional(bounds: Bounds3, intensity: f32) -> Self {
        Self {
            bounds,
            axis: Vec3::Z,
            cos_normals: -1.0,
            cos_emission: 0.0,
            intensity,
            two_sided: false,
        }
    }

    /// Bounds of both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        let (axis, cos_normals) = union_of_cones((self.axis, self.cos_normals), (other.axis, other.cos_normals));
        Self {
            bounds: self.bounds.union(other.bounds),
            axis,
            cos_normals,
            cos_emission: self.cos_emission.min(other.cos_emission),
            intensity: self.intensity + other.intensity,
            two_sided: self.two_sided || other.two_sided,
        }
    }

    /// The measure of the surface area orientation heuristic without its factor for long boxes: intensity, solid angle of
    /// emission weighed by cosine, and surface area (half of it).
    pub fn cost(&self) -> f32 {
        let theta_o = self.cos_normals.clamp(-1.0, 1.0).acos();
        let theta_e = self.cos_emission.clamp(-1.0, 1.0).acos();
        let theta_w = (theta_o + theta_e).min(PI);
        let sin_o = theta_o.sin();
        let solid_angle = 2.0 * PI * (1.0 - self.cos_normals)
            + PI / 2.0
                * (2.0 * theta_w * sin_o - (theta_o - 2.0 * theta_w).cos() - 2.0 * theta_o * sin_o + self.cos_normals);
        self.intensity * solid_angle * self.bounds.half_area()
    }
}

/// A cone (unit axis and cosine of its half angle) that holds two.
fn union_of_cones(a: (Vec3, f32), b: (Vec3, f32)) -> (Vec3, f32) {
    let (theta_a, theta_b) = (a.1.clamp(-1.0, 1.0).acos(), b.1.clamp(-1.0, 1.0).acos());
    // The angle between the axes, precise where it is small.
    let between = 2.0 * (a.0 - b.0).length().atan2((a.0 + b.0).length());
    if (between + theta_b).min(PI) <= theta_a {
        return a;
    }
    if (between + theta_a).min(PI) <= theta_b {
        return b;
    }
    let theta = 0.5 * (theta_a + between + theta_b);
    let turn_axis = a.0.cross(b.0).try_normalize();
    match turn_axis {
        Some(turn_axis) if theta < PI => {
            let axis = Quat::from_axis_angle(turn_axis, theta - theta_a) * a.0;
            (axis.normalize(), theta.cos())
        }
        _ => (a.0, -1.0),
    }
}

/// [`LightBounds`] made ready for [`Cluster::importance`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Cluster {
    center: Vec3,
    /// Of the sphere around the box.
    radius_squared: f32,
    axis: Vec3,
    intensity: f32,
    cos_normals: f32,
    sin_normals: f32,
    cos_emission: f32,
    two_sided: bool,
}

/// What rounding may take off a cosine: no light that shines on a point may have importance 0 there.
const COSINE_SLACK: f32 = 1e-4;

/// Sums of two importances stay finite.
const GREATEST_IMPORTANCE: f32 = 1e36;

impl Cluster {
    pub fn new(light: &LightBounds) -> Self {
        let cos_normals = (light.cos_normals - COSINE_SLACK).max(-1.0);
        Self {
            center: light.bounds.center(),
            radius_squared: light.bounds.radius().powi(2),
            axis: light.axis,
            intensity: light.intensity,
            cos_normals,
            sin_normals: (1.0 - cos_normals * cos_normals).max(0.0).sqrt(),
            cos_emission: light.cos_emission - COSINE_SLACK,
            two_sided: light.two_sided,
        }
    }

    /// An estimate, from above where it matters, of the irradiance at the point `p` with the normal `n` (on either side; zero:
    /// no surface). 0 only where nothing arrives.
    #[inline]
    pub fn importance(&self, p: Vec3, n: Vec3) -> f32 {
        let from_center = p - self.center;
        let distance_squared = from_center.length_squared();
        if distance_squared <= self.radius_squared {
            // From inside, every direction may be one towards a light.
            return (self.intensity / self.radius_squared.max(f32::MIN_POSITIVE)).min(GREATEST_IMPORTANCE);
        }
        let w = from_center / distance_squared.sqrt();
        let cos_w = self.axis.dot(w);
        let cos_w = if self.two_sided { cos_w.abs() } else { cos_w };
        let cone = Angle {
            sin: (self.radius_squared / distance_squared).sqrt(),
            cos: (1.0 - self.radius_squared / distance_squared).max(0.0).sqrt(),
        };
        let normals = Angle {
            sin: self.sin_normals,
            cos: self.cos_normals,
        };
        let least = Angle::of_cos(cos_w).minus(normals).minus(cone);
        if least.cos <= self.cos_emission {
            return 0.0;
        }
        let cos_at_p = if n == Vec3::ZERO {
            1.0
        } else {
            Angle::of_cos(w.dot(n).abs()).minus(cone).cos
        };
        // Cosines of 90 degrees count as a little more, for the same slack.
        let cosines = least.cos.max(COSINE_SLACK) * cos_at_p.max(COSINE_SLACK);
        (self.intensity * cosines / distance_squared).min(GREATEST_IMPORTANCE)
    }
}

/// An angle between 0 and 180 degrees.
#[derive(Clone, Copy)]
struct Angle {
    cos: f32,
    sin: f32,
}

impl Angle {
    fn of_cos(cos: f32) -> Self {
        Self {
            cos,
            sin: (1.0 - cos * cos).max(0.0).sqrt(),
        }
    }

    /// The difference, or 0 if `other` is larger.
    fn minus(self, other: Self) -> Self {
        if self.cos > other.cos {
            return Self { cos: 1.0, sin: 0.0 };
        }
        Self {
            cos: self.cos * other.cos + self.sin * other.sin,
            sin: self.sin * other.cos - self.cos * other.sin,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(p: Vec3, axis: Vec3, cos_normals: f32) -> LightBounds {
        LightBounds {
            bounds: Bounds3::from_points([p]),
            axis,
            cos_normals,
            cos_emission: 0.0,
            intensity: 1.0,
            two_sided: false,
        }
    }

    /// Directions all around, deterministic.
    fn directions() -> impl Iterator<Item = Vec3> {
        (0..400).map(|i| {
            let z = (i as f32 + 0.5) / 200.0 - 1.0;
            let (sin, cos) = (i as f32 * 2.399_963).sin_cos();
            let r = (1.0 - z * z).max(0.0).sqrt();
            Vec3::new(r * cos, r * sin, z)
        })
    }

    #[test]
    fn a_union_of_cones_holds_both() {
        let all: Vec<Vec3> = directions().collect();
        let angle = |a: Vec3, b: Vec3| 2.0 * (a - b).length().atan2((a + b).length());
        for (i, &a) in all.iter().enumerate().step_by(7) {
            let b = all[(i * 31 + 5) % all.len()];
            let (cos_a, cos_b) = (((i % 5) as f32 * 0.4).cos(), ((i % 3) as f32 * 0.7).cos());
            let (axis, cos) = union_of_cones((a, cos_a), (b, cos_b));
            for (part, cos_part) in [(a, cos_a), (b, cos_b)] {
                let reach = (angle(axis, part) + cos_part.acos()).min(PI);
                assert!(
                    cos.acos() >= reach - 2e-3,
                    "{axis} {cos} does not hold {part} {cos_part}"
                );
            }
            assert!((axis.length() - 1.0).abs() < 1e-5);
        }
        // Opposite directions have no cone but all of them.
        assert_eq!(union_of_cones((Vec3::X, 1.0), (-Vec3::X, 1.0)).1, -1.0);
        assert_eq!(union_of_cones((Vec3::X, 1.0), (Vec3::X, 0.5)), (Vec3::X, 0.5));
    }

    /// Of one point it is the irradiance itself; of a group never less than that of one of its members, whose greatest
    /// distance is that from the far side of the sphere around them.
    #[test]
    fn importance_is_the_irradiance_of_a_point_and_positive_where_one_of_a_group_shines() {
        let n = Vec3::new(0.0, 0.6, 0.8);
        for (i, w) in directions().enumerate() {
            let light = point(Vec3::new(0.1, -0.2, 3.0), w, 1.0);
            let p = light.bounds.min + Vec3::new(0.3, -0.5, -2.0) * (0.1 + i as f32 / 50.0);
            let to_p = p - light.bounds.min;
            let cos = [w.dot(to_p.normalize()), n.dot(to_p.normalize()).abs()];
            let expected = cos[0].max(0.0) * cos[1] / to_p.length_squared();
            let importance = Cluster::new(&light).importance(p, n);
            // The slack of the normals' cone is 0.8 degrees.
            assert!(
                (importance - expected).abs() <= 0.02 / to_p.length_squared(),
                "{importance} {expected}"
            );
            assert!(importance > 0.0 || expected == 0.0);

            let other = point(Vec3::new(-1.0, 0.5, 2.0), n, 0.9);
            let group = Cluster::new(&light.union(&other));
            let members = [light, other].map(|l| Cluster::new(&l).importance(p, n));
            assert!(group.importance(p, n) > 0.0 || members == [0.0; 2]);
        }
    }

    #[test]
    fn importance_is_finite_at_the_light_itself() {
        let light = point(Vec3::ONE, Vec3::Z, -1.0);
        let importance = Cluster::new(&light).importance(Vec3::ONE, Vec3::X);
        assert!(importance > 0.0 && (2.0 * importance).is_finite());
    }
}
