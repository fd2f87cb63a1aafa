//! Densities that name their measure, and the one place where they are converted.

/// A probability density with respect to solid angle, in sr⁻¹.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct SolidAnglePdf(pub f32);

/// A probability density with respect to area, in scene units⁻².
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct AreaPdf(pub f32);

impl AreaPdf {
    /// The density per solid angle seen from a point at the squared distance `distance_squared`, in a direction that makes
    /// the cosine `abs_cos` with the surface's normal: p d² / |cos|. Infinite for a surface seen edge on (`abs_cos` = 0)
    /// unless the density is zero, which stays zero.
    #[inline]
    pub fn to_solid_angle(self, distance_squared: f32, abs_cos: f32) -> SolidAnglePdf {
        if self.0 == 0.0 {
            return SolidAnglePdf(0.0);
        }
        SolidAnglePdf(self.0 * distance_squared / abs_cos.abs())
    }
}

impl SolidAnglePdf {
    /// The density per area at a point at the squared distance `distance_squared`, where the direction makes the cosine
    /// `abs_cos` with the surface's normal: p |cos| / d².
    #[inline]
    pub fn to_area(self, distance_squared: f32, abs_cos: f32) -> AreaPdf {
        AreaPdf(self.0 * abs_cos.abs() / distance_squared)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conversion_is_the_jacobian_and_inverts() {
        let area = AreaPdf(0.5);
        let solid_angle = area.to_solid_angle(4.0, 0.25);
        assert_eq!(solid_angle, SolidAnglePdf(8.0));
        assert_eq!(solid_angle.to_area(4.0, -0.25), area);
        assert_eq!(AreaPdf(0.0).to_solid_angle(4.0, 0.0), SolidAnglePdf(0.0));
        assert_eq!(area.to_solid_angle(4.0, 0.0), SolidAnglePdf(f32::INFINITY));
    }
}
