//! Where media scatter light to.

use crate::math::{Frame, Vec2, Vec3};
use crate::sampling::SolidAnglePdf;
use crate::sampling::warp::{henyey_greenstein_pdf, sample_henyey_greenstein};

/// The phase function of Henyey and Greenstein (1941). Its value and the density of its samples are the same number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HenyeyGreenstein {
    /// Mean cosine of the angle by which light turns, in (-1, 1): 0 is isotropic, positive scatters forward.
    pub g: f32,
}

impl HenyeyGreenstein {
    /// The phase function for light that comes from `wi` and goes to `wo`, both unit length and leaving the point.
    #[inline]
    pub fn pdf(self, wo: Vec3, wi: Vec3) -> SolidAnglePdf {
        henyey_greenstein_pdf(-wo.dot(wi), self.g)
    }

    /// A direction `wi` and its density.
    #[inline]
    pub fn sample(self, wo: Vec3, u: Vec2) -> (Vec3, SolidAnglePdf) {
        let turned = sample_henyey_greenstein(u, self.g);
        let wi = Frame::from_normal(-wo).to_world(turned).normalize();
        (wi, henyey_greenstein_pdf(turned.z, self.g))
    }
}
