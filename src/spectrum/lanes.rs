//! The spectral values of eight paths side by side.

use super::SampledSpectrum;
use crate::math::{Lanes, columns};

/// A [`SampledSpectrum`] for each lane of a packet.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(32))]
pub struct SpectrumLanes([Lanes; super::LANES]);

impl SpectrumLanes {
    /// The same value in all lanes.
    #[inline(always)]
    pub fn all(value: SampledSpectrum) -> Self {
        Self(value.0.map(|value| [value; _]))
    }

    /// The value of a lane.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> SampledSpectrum {
        let [a, b, c, d] = &self.0;
        SampledSpectrum([a[lane], b[lane], c[lane], d[lane]])
    }

    /// Puts `value` into a lane.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, value: SampledSpectrum) {
        let [a, b, c, d] = &mut self.0;
        [a[lane], b[lane], c[lane], d[lane]] = value.0;
    }
}

columns!(SpectrumLanes { 0 });
