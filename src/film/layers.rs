//! What a film keeps of its pixels beside their colours.

use super::bins::{Bins, spectral_channels};
use super::gbuffer::{GBUFFER_CHANNELS, GBuffer, SurfaceSample};
use super::sums::{Film, TileSums, lock};
use crate::desc::FilmKind;
use crate::spectrum::{SampledSpectrum, Wavelengths};

/// What a tile keeps beside colours.
#[derive(Clone, Debug, Default)]
pub(super) enum TileLayers {
    #[default]
    None,
    GBuffer(GBuffer),
    Bins(Bins),
}

/// A camera sample, for what a film keeps of it beside its colour.
#[derive(Clone, Copy, Debug)]
pub struct LayerSample<'a> {
    /// Of the pixel filter.
    pub weight: f32,
    /// Its colour; `None` if it was dropped.
    pub rgb: Option<[f32; 3]>,
    /// Its radiance, not divided by the density of the wavelengths; 0 if it was dropped.
    pub l: SampledSpectrum,
    /// Its wavelengths.
    pub lambda: &'a Wavelengths,
    /// The surface that it sees first.
    pub surface: Option<&'a SurfaceSample>,
}

impl TileSums {
    /// Adds what the film keeps of a camera sample of pixel (x, y), which must lie in [`TileSums::rect`], beside what
    /// [`TileSums::add`] does.
    pub fn add_layers(&mut self, x: u32, y: u32, sample: &LayerSample<'_>) {
        let index = self.index(x, y);
        match &mut self.layers {
            TileLayers::None => {}
            TileLayers::GBuffer(buffer) => buffer.add(index, sample.weight, sample.rgb, sample.surface),
            TileLayers::Bins(bins) => bins.add(index, sample.weight, sample.l, sample.lambda),
        }
    }
}

impl Film {
    /// The same film, which keeps more than colours; no coordinate of a surface that it sees is more than `reach`.
    #[must_use]
    pub fn of_kind(mut self, kind: FilmKind, reach: f64) -> Self {
        self.kind = kind;
        for tile in self.tiles_mut() {
            tile.layers = match kind {
                FilmKind::Rgb => TileLayers::None,
                FilmKind::GBuffer(_) => TileLayers::GBuffer(GBuffer::new(tile.pixel_count(), reach)),
                FilmKind::Spectral(bins) => TileLayers::Bins(Bins::new(tile.pixel_count(), bins)),
            };
        }
        self
    }

    /// What it keeps beside colours.
    #[inline]
    pub fn kind(&self) -> FilmKind {
        self.kind
    }

    /// The names of what it keeps beside colours.
    pub fn layer_channels(&self) -> Vec<String> {
        match self.kind {
            FilmKind::Rgb => Vec::new(),
            FilmKind::GBuffer(_) => GBUFFER_CHANNELS.map(str::to_owned).to_vec(),
            FilmKind::Spectral(bins) => spectral_channels(&bins),
        }
    }

    /// Surfaces that were left out because they were out of range.
    pub fn dropped_surfaces(&self) -> u64 {
        let dropped = |tile: &TileSums| match &tile.layers {
            TileLayers::GBuffer(buffer) => buffer.dropped,
            TileLayers::None | TileLayers::Bins(_) => 0,
        };
        self.tiles().iter().map(|tile| dropped(&lock(tile))).sum()
    }

    /// The values of [`Film::layer_channels`] for each pixel, pixel by pixel, row by row from the top left one of the crop.
    pub fn develop_layers(&self) -> Vec<f32> {
        let channels = self.layer_channels().len();
        let crop = self.crop();
        let mut image = vec![0.0; channels * crop.area() as usize];
        for tile in self.tiles() {
            let tile = lock(tile);
            let rect = tile.rect();
            for (y, x) in (rect.y0..rect.y1).flat_map(|y| (rect.x0..rect.x1).map(move |x| (y, x))) {
                let row = u64::from(y - crop.y0) * u64::from(crop.width());
                let first = channels * (row + u64::from(x - crop.x0)) as usize;
                let out = &mut image[first..first + channels];
                let index = tile.index(x, y);
                match &tile.layers {
                    TileLayers::None => {}
                    TileLayers::GBuffer(buffer) => buffer.develop(index, tile.weight(index), out),
                    TileLayers::Bins(bins) => bins.develop(index, out),
                }
            }
        }
        image
    }
}
