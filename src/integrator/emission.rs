//! How light paths start.

use super::lane::Slot;
use super::numbers::EmissionNumbers;
use crate::light::{EmissionSample, SampledLight};
use crate::math::Vec3;
use crate::scene::Scene;

/// A light, drawn by its power, and a ray from it at the time and the wavelengths of a slot. `None` carries nothing.
pub(super) fn sample_emission(
    scene: &Scene,
    slot: &Slot,
    numbers: &EmissionNumbers,
) -> Option<(SampledLight, EmissionSample)> {
    let chosen = scene
        .emission_sampler()
        .sample(Vec3::ZERO, Vec3::ZERO, numbers.which_light)?;
    let light = scene.light(chosen.light);
    let bounds = scene.bounds();
    let sample = light.sample_le(slot.time, numbers.position, numbers.direction, &slot.lambda, &bounds)?;
    Some((chosen, sample))
}
