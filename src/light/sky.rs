//! An environment given by an image of the whole sphere, sampled by its pixels.

use super::image::EmissionImage;
use super::place::Place;
use crate::math::{Vec2, Vec3};
use crate::sampling::{CellDistribution, SolidAnglePdf, SphereMap};
use crate::spectrum::{SampledSpectrum, Wavelengths};

/// Each direction has the radiance of its pixel, and a density in proportion to the luminance of that.
#[derive(Clone, Debug)]
pub struct ImageEnvironment {
    place: Place,
    map: SphereMap,
    image: EmissionImage,
    /// `None` if the image is black.
    distribution: Option<CellDistribution>,
}

impl ImageEnvironment {
    /// With the radiances of `image` (W·m⁻²·sr⁻¹·nm⁻¹), whose pole is +z of `place`. `None` if the image is neither square nor
    /// twice as wide as high, see [`SphereMap::of_size`].
    pub fn new(place: Place, image: EmissionImage) -> Option<Self> {
        let size = image.size();
        let map = SphereMap::of_size(size[0], size[1])?;
        let weights: Vec<f32> = (0..size[0] * size[1])
            .map(|i| {
                let (x, y) = (i % size[0], i / size[0]);
                image.luminance(x, y) * map.solid_angle(y, size)
            })
            .collect();
        Some(Self {
            place,
            map,
            distribution: CellDistribution::new(&weights, size[0]),
            image,
        })
    }

    /// Which part of the sphere each pixel is.
    pub fn map(&self) -> SphereMap {
        self.map
    }

    #[inline]
    pub(super) fn le(&self, w: Vec3, time: f32, lambda: &Wavelengths) -> SampledSpectrum {
        let cell = self.map.cell(self.place.at(time).local_direction(w), self.image.size());
        self.image.sample(cell.x, cell.y, lambda)
    }

    pub(super) fn pdf_li(&self, w: Vec3, time: f32) -> SolidAnglePdf {
        let Some(distribution) = &self.distribution else {
            return SolidAnglePdf(0.0);
        };
        let (pose, size) = (self.place.at(time), self.image.size());
        let cell = self.map.cell(pose.local_direction(w), size);
        let pdf = distribution.probability(cell.x, cell.y) / self.map.solid_angle(cell.y, size);
        SolidAnglePdf(pdf * pose.stretch(w))
    }

    /// A direction, its density and its radiance.
    pub(super) fn sample(
        &self,
        time: f32,
        u: Vec2,
        lambda: &Wavelengths,
    ) -> Option<(Vec3, SolidAnglePdf, SampledSpectrum)> {
        let (cell, probability) = self.distribution.as_ref()?.sample(u);
        let (pose, size) = (self.place.at(time), self.image.size());
        let w = pose.world_direction(self.map.direction(&cell, size));
        let pdf = probability / self.map.solid_angle(cell.y, size) * pose.stretch(w);
        Some((w, SolidAnglePdf(pdf), self.image.sample(cell.x, cell.y, lambda)))
    }

    /// The integral of luminance over all directions.
    pub(super) fn fluence(&self) -> f32 {
        let size = self.image.size();
        self.image.sum(|_, y| self.map.solid_angle(y, size))
    }
}
