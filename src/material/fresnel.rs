//! Reflection and refraction at a smooth boundary, for unpolarised light.

use crate::math::Vec3;

/// Fresnel reflectance of a dielectric boundary. `cos_i` is the cosine of the incident direction to the normal; on the negative
/// side light comes from inside. `eta` is the index inside over that outside. 1 beyond the critical angle.
#[inline]
pub fn fresnel_dielectric(cos_i: f32, eta: f32) -> f32 {
    let cos_i = cos_i.clamp(-1.0, 1.0);
    let (cos_i, eta) = if cos_i < 0.0 { (-cos_i, 1.0 / eta) } else { (cos_i, eta) };
    let sin2_t = (1.0 - cos_i * cos_i) / (eta * eta);
    if sin2_t >= 1.0 {
        return 1.0;
    }
    let cos_t = (1.0 - sin2_t).sqrt();
    let parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    0.5 * (parallel * parallel + perpendicular * perpendicular)
}

/// Fresnel reflectance of a conductor of index `eta` + i `k` relative to the outside; `cos_i` in [0, 1].
///
/// The real form of the equations (Born and Wolf, section 14.2): a² + b² = |eta² - sin²|.
#[inline(always)]
pub fn fresnel_complex(cos_i: f32, eta: f32, k: f32) -> f32 {
    let cos_i = cos_i.clamp(0.0, 1.0);
    let cos2 = cos_i * cos_i;
    let sin2 = 1.0 - cos2;
    let difference = eta * eta - k * k - sin2;
    let a2_plus_b2 = (difference * difference + 4.0 * eta * eta * k * k).sqrt();
    let a = (0.5 * (a2_plus_b2 + difference)).max(0.0).sqrt();
    let perpendicular_sum = a2_plus_b2 + cos2;
    let perpendicular_term = 2.0 * a * cos_i;
    let perpendicular = (perpendicular_sum - perpendicular_term) / (perpendicular_sum + perpendicular_term);
    let parallel_sum = cos2 * a2_plus_b2 + sin2 * sin2;
    let parallel_term = perpendicular_term * sin2;
    let both = parallel_sum + parallel_term;
    // Only an index of 0 (the fourth lane of rgb mode) seen head on has nothing here.
    let parallel = perpendicular * (parallel_sum - parallel_term) / both;
    let parallel = if both > 0.0 { parallel } else { perpendicular };
    0.5 * (perpendicular + parallel)
}

/// The direction refracted at a boundary with normal `n`, and the relative index it crossed: that on the far side over that on the
/// side of `wi`. `None` for total internal reflection. `eta` is the index on the side that `n` does not point to, over the other.
#[inline]
pub fn refract(wi: Vec3, n: Vec3, eta: f32) -> Option<(Vec3, f32)> {
    let cos_i = n.dot(wi);
    let (cos_i, n, eta) = if cos_i < 0.0 {
        (-cos_i, -n, 1.0 / eta)
    } else {
        (cos_i, n, eta)
    };
    let sin2_t = (1.0 - cos_i * cos_i).max(0.0) / (eta * eta);
    if sin2_t >= 1.0 {
        return None;
    }
    let cos_t = (1.0 - sin2_t).sqrt();
    Some((-wi / eta + (cos_i / eta - cos_t) * n, eta))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_dielectric_reflects_what_the_textbook_says() {
        assert_relative_eq!(fresnel_dielectric(1.0, 1.5), 0.04, epsilon = 1e-6);
        assert_relative_eq!(fresnel_dielectric(-1.0, 1.5), 0.04, epsilon = 1e-6);
        // Brewster's angle: only perpendicular light is reflected, ((1 - n²) / (1 + n²))² / 2.
        let brewster = 1.5_f32.atan().cos();
        assert_relative_eq!(
            fresnel_dielectric(brewster, 1.5),
            0.5 * (1.25_f32 / 3.25).powi(2),
            epsilon = 1e-6
        );
        assert_eq!(fresnel_dielectric(-0.7, 1.5), 1.0);
    }

    #[test]
    fn a_conductor_without_absorption_is_a_dielectric() {
        for i in 1..=20 {
            let cos = i as f32 / 20.0;
            assert_relative_eq!(
                fresnel_complex(cos, 1.5, 0.0),
                fresnel_dielectric(cos, 1.5),
                epsilon = 2e-6
            );
        }
        // Gold at 550 nm, normal incidence: ((n - 1)² + k²) / ((n + 1)² + k²).
        let (n, k) = (0.43_f32, 2.46_f32);
        let expected = ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k);
        assert_relative_eq!(fresnel_complex(1.0, n, k), expected, epsilon = 1e-6);
    }

    #[test]
    fn refraction_obeys_snell_and_is_reversible() {
        let wi = Vec3::new(0.6, 0.0, 0.8);
        let (wt, eta) = refract(wi, Vec3::Z, 1.5).unwrap();
        assert_relative_eq!(wt.x, -0.4, epsilon = 1e-6);
        assert_eq!(eta, 1.5);
        let (back, eta) = refract(wt, Vec3::Z, 1.5).unwrap();
        assert_relative_eq!(eta, 1.0 / 1.5);
        assert!((back - wi).length() < 1e-6);
        assert!(refract(Vec3::new(0.8, 0.0, -0.6), Vec3::Z, 1.5).is_none());
    }
}
