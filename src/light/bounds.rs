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

#[cfg(test)]
mod tests {
    use super::*;

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
}
