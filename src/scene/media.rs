//! Media as described to media as evaluated.

use super::spectra::SpectrumCompiler;
use crate::desc::{self, CoefficientsDesc, MediumDesc, MediumInterfaceDesc};
use crate::medium::{Extinction, HenyeyGreenstein, HomogeneousMedium, MediumId};

/// What is on the two sides of a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct MediumInterface {
    /// Where the geometric normal points away from.
    pub interior: Option<MediumId>,
    /// Where it points to.
    pub exterior: Option<MediumId>,
}

impl MediumInterface {
    /// Whether there is a medium on either side.
    pub fn is_any(&self) -> bool {
        self.interior.is_some() || self.exterior.is_some()
    }
}

/// The medium of a description's number.
pub(super) fn id(id: desc::MediumId) -> MediumId {
    MediumId(id.0)
}

pub(super) fn interface(desc: &MediumInterfaceDesc) -> MediumInterface {
    MediumInterface {
        interior: desc.interior.map(id),
        exterior: desc.exterior.map(id),
    }
}

pub(super) fn compile(desc: &MediumDesc, spectra: SpectrumCompiler) -> HomogeneousMedium {
    let scale = desc.scale as f32;
    let coefficient = |sigma| spectra.unbounded(sigma).scaled(scale);
    let extinction = match &desc.coefficients {
        CoefficientsDesc::Parts { sigma_a, sigma_s } => Extinction::Parts {
            sigma_a: coefficient(sigma_a),
            sigma_s: coefficient(sigma_s),
        },
        CoefficientsDesc::Whole { sigma_t, albedo } => Extinction::Whole {
            sigma_t: coefficient(sigma_t),
            albedo: spectra.unbounded(albedo),
        },
    };
    HomogeneousMedium {
        phase: extinction.scatters().then_some(HenyeyGreenstein { g: desc.g as f32 }),
        extinction,
        le: desc
            .le
            .as_ref()
            .map(|le| spectra.emission(Some(le)).scaled(desc.le_scale as f32)),
    }
}
