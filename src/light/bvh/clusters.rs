//! The eight children of a node: how much of the light of each arrives at a point, all computed together.

use super::super::bounds::LightBounds;
use crate::math::{LANES, Lanes, Vec3, Vec3Lanes, VectorLanes};

/// Lights, alone or several together, as [`LightBounds`] describe them.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Clusters {
    center: Vec3Lanes,
    /// Of the sphere around the box.
    radius_squared: Lanes,
    axis: Vec3Lanes,
    /// 0 in lanes without a cluster.
    intensity: Lanes,
    cos_normals: Lanes,
    sin_normals: Lanes,
    cos_emission: Lanes,
    two_sided: [bool; LANES],
}

/// What rounding may take off a cosine: no light that shines on a point may have importance 0 there.
const COSINE_SLACK: f32 = 1e-4;

/// Sums of eight importances stay finite.
const GREATEST_IMPORTANCE: f32 = 1e36;

impl Clusters {
    pub fn set(&mut self, lane: usize, light: &LightBounds) {
        let cos_normals = (light.cos_normals - COSINE_SLACK).max(-1.0);
        self.center.set(lane, light.bounds.center());
        self.radius_squared[lane] = light.bounds.radius().powi(2);
        self.axis.set(lane, light.axis);
        self.intensity[lane] = light.intensity;
        self.cos_normals[lane] = cos_normals;
        self.sin_normals[lane] = (1.0 - cos_normals * cos_normals).max(0.0).sqrt();
        self.cos_emission[lane] = light.cos_emission - COSINE_SLACK;
        self.two_sided[lane] = light.two_sided;
    }

    /// An estimate of each, from above where it matters, of the irradiance at the point `p` with the normal `n` (on either side;
    /// zero: no surface). 0 only where nothing arrives.
    #[inline(always)]
    pub fn importance(&self, p: Vec3, n: Vec3) -> Lanes {
        let mut importance = [0.0; LANES];
        for (i, importance) in importance.iter_mut().enumerate() {
            let from_center = p - self.center.get(i);
            let (distance_squared, radius_squared) = (from_center.length_squared(), self.radius_squared[i]);
            let w = from_center * (1.0 / distance_squared.sqrt());
            let cos_w = self.axis.get(i).dot(w);
            let cos_w = if self.two_sided[i] { cos_w.abs() } else { cos_w };
            let sin_squared = radius_squared / distance_squared;
            let cone = Angle {
                sin: sin_squared.sqrt(),
                cos: (1.0 - sin_squared).max(0.0).sqrt(),
            };
            let normals = Angle {
                sin: self.sin_normals[i],
                cos: self.cos_normals[i],
            };
            let least = Angle::of_cos(cos_w).minus(normals).minus(cone);
            let at_surface = Angle::of_cos(w.dot(n).abs()).minus(cone).cos;
            let cos_at_p = if n == Vec3::ZERO { 1.0 } else { at_surface };
            // Cosines of 90 degrees count as a little more, for the same slack.
            let cosines = least.cos.max(COSINE_SLACK) * cos_at_p.max(COSINE_SLACK);
            let outside = self.intensity[i] * cosines / distance_squared;
            let outside = if least.cos > self.cos_emission[i] { outside } else { 0.0 };
            // From inside, every direction may be one towards a light.
            let inside = self.intensity[i] / radius_squared.max(f32::MIN_POSITIVE);
            let either = if distance_squared > radius_squared {
                outside
            } else {
                inside
            };
            *importance = either.min(GREATEST_IMPORTANCE);
        }
        importance
    }
}

/// An angle between 0 and 180 degrees.
#[derive(Clone, Copy)]
struct Angle {
    cos: f32,
    sin: f32,
}

impl Angle {
    #[inline(always)]
    fn of_cos(cos: f32) -> Self {
        Self {
            cos,
            sin: (1.0 - cos * cos).max(0.0).sqrt(),
        }
    }

    /// The difference, or 0 if `other` is larger.
    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        let is_less = self.cos > other.cos;
        let difference = Self {
            cos: self.cos * other.cos + self.sin * other.sin,
            sin: self.sin * other.cos - self.cos * other.sin,
        };
        Self {
            cos: if is_less { 1.0 } else { difference.cos },
            sin: if is_less { 0.0 } else { difference.sin },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Bounds3;

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

    /// Of clusters in lanes one after the other, from the third on; the others are to have none.
    fn importances(clusters: &[LightBounds], p: Vec3, n: Vec3) -> Vec<f32> {
        let mut lanes = Clusters::default();
        for (i, bounds) in clusters.iter().enumerate() {
            lanes.set(2 + i, bounds);
        }
        let mut importances = lanes.importance(p, n).to_vec();
        let here: Vec<f32> = importances.drain(2..2 + clusters.len()).collect();
        assert!(
            importances.iter().all(|&importance| importance == 0.0),
            "{importances:?}"
        );
        here
    }

    /// Of one point it is the irradiance itself; of a group never less than that of one of its members, whose greatest
    /// distance is that from the far side of the sphere around them.
    #[test]
    fn importance_is_the_irradiance_of_a_point_and_positive_where_one_of_a_group_shines() {
        let n = Vec3::new(0.0, 0.6, 0.8);
        for i in 0..400 {
            let z = (i as f32 + 0.5) / 200.0 - 1.0;
            let (sin, cos) = (i as f32 * 2.399_963).sin_cos();
            let r = (1.0 - z * z).max(0.0).sqrt();
            let w = Vec3::new(r * cos, r * sin, z);
            let light = point(Vec3::new(0.1, -0.2, 3.0), w, 1.0);
            let p = light.bounds.min + Vec3::new(0.3, -0.5, -2.0) * (0.1 + i as f32 / 50.0);
            let to_p = p - light.bounds.min;
            let cos = [w.dot(to_p.normalize()), n.dot(to_p.normalize()).abs()];
            let expected = cos[0].max(0.0) * cos[1] / to_p.length_squared();
            let other = point(Vec3::new(-1.0, 0.5, 2.0), n, 0.9);
            let importances = importances(&[light, other, light.union(&other)], p, n);
            // The slack of the normals' cone is 0.8 degrees.
            assert!(
                (importances[0] - expected).abs() <= 0.02 / to_p.length_squared(),
                "{importances:?} {expected}"
            );
            assert!(importances[0] > 0.0 || expected == 0.0);
            assert!(importances[2] > 0.0 || importances[..2] == [0.0; 2]);
        }
    }

    #[test]
    fn importance_is_finite_at_the_light_itself() {
        let importance = importances(&[point(Vec3::ONE, Vec3::Z, -1.0)], Vec3::ONE, Vec3::X)[0];
        assert!(importance > 0.0 && (8.0 * importance).is_finite());
    }
}
