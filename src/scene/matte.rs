//! Surfaces that are Lambertian and nothing else, which integrators may take together.

use super::Scene;
use crate::material::Material;
use crate::spectrum::SampledSpectrum;

/// What is known of a geometry's surface before anything is looked up there: its reflectance, if it is Lambertian, the same everywhere and
/// at all wavelengths, and no light.
pub(super) fn known_albedo(material: &Material, emits: bool) -> Option<SampledSpectrum> {
    let reflectance = material.lambertian().filter(|_| !emits)?;
    reflectance.constant()?.constant()
}

impl Scene {
    /// The reflectance of a geometry, if it is known to be Lambertian, the same everywhere and at all wavelengths (in rgb mode all are
    /// that are the same everywhere), and no light. `geometry` may be none of the scene's.
    #[inline]
    pub fn known_albedo(&self, geometry: u32) -> Option<SampledSpectrum> {
        self.known_albedos.get(geometry as usize).copied().flatten()
    }
}
