//! Eight camera samples added to the sums of their pixels together.

use super::sums::{LARGEST, TileSums};
use crate::math::{Kernel, LANES, LaneSet, Lanes, Vec3Lanes, VectorLanes, Vectorizer};

/// What eight camera samples bring to their pixels.
#[derive(Clone, Copy, Debug, Default)]
pub struct SampleLanes {
    /// Linear RGB.
    pub rgb: Vec3Lanes,
    /// Of the pixel filter.
    pub weight: Lanes,
    /// Whether the sample counts, or else is dropped.
    pub is_good: [bool; LANES],
}

impl TileSums {
    /// [`TileSums::add`] of the `chosen` samples, of these `pixels`: the same bits. Says which of them were dropped.
    #[inline]
    pub fn add_together(
        &mut self,
        vectorizer: Vectorizer,
        chosen: LaneSet,
        pixels: &[[u32; 2]; LANES],
        samples: &SampleLanes,
    ) -> LaneSet {
        let quantized = vectorizer.run(Quantize(samples));
        for lane in chosen.lanes() {
            let [x, y] = pixels[lane];
            self.add_quantized(self.index(x, y), quantized.get(lane));
        }
        let counted = LaneSet::from(quantized.counts);
        if self.has_squares() {
            for lane in chosen.and(counted).lanes() {
                let [x, y] = pixels[lane];
                self.add_square(self.index(x, y), samples.rgb.get(lane).into());
            }
        }
        let dropped = chosen.without(counted);
        self.count_dropped(dropped.len().into());
        dropped
    }
}

/// What red, green, blue and the weight of eight samples are in units of 2^-64, in two halves.
#[derive(Debug, Default)]
struct Quantized {
    high: [[i64; LANES]; 4],
    low: [[u64; LANES]; 4],
    /// Whether the colour counts; else it is black.
    counts: [bool; LANES],
}

impl Quantized {
    #[inline(always)]
    fn get(&self, lane: usize) -> [i128; 4] {
        std::array::from_fn(|i| i128::from(self.high[i][lane]) << 64 | i128::from(self.low[i][lane]))
    }
}

/// See [`super::sums::quantize`].
struct Quantize<'a>(&'a SampleLanes);

impl Kernel for Quantize<'_> {
    type Output = Quantized;

    #[inline(always)]
    fn call(self) -> Quantized {
        let Self(samples) = self;
        let mut quantized = Quantized::default();
        for i in 0..LANES {
            let weight = f64::from(samples.weight[i]);
            let rgb = samples.rgb.get(i);
            let values = [rgb.x, rgb.y, rgb.z].map(
                #[inline(always)]
                |value| weight * f64::from(value),
            );
            let is_within = |value: f64| value.abs() < LARGEST;
            let counts = samples.is_good[i] & is_within(values[0]) & is_within(values[1]) & is_within(values[2]);
            quantized.counts[i] = counts;
            for (channel, value) in values.into_iter().enumerate() {
                (quantized.high[channel][i], quantized.low[channel][i]) = halves(if counts { value } else { 0.0 });
            }
            (quantized.high[3][i], quantized.low[3][i]) = halves(if is_within(weight) { weight } else { 0.0 });
        }
        quantized
    }
}

/// The upper and the lower half of `value` in units of 2^-64, rounded to an even number of them towards 0. Its magnitude is below
/// [`LARGEST`].
#[inline(always)]
fn halves(value: f64) -> (i64, u64) {
    // All steps are exact but for the last truncation: the fraction's 63 digits come in two parts, which fit where `integer` finds them.
    let whole = value.trunc();
    let first = (value - whole) * 4_294_967_296.0;
    let upper = first.trunc();
    let lower = ((first - upper) * 2_147_483_648.0).trunc();
    let fraction = (integer(upper) << 31) + integer(lower);
    (integer(whole) + (fraction >> 63), (fraction << 1).cast_unsigned())
}

/// An integer of a magnitude below 2^51, read off the digits of a sum: few machines have an instruction to convert several.
#[inline(always)]
fn integer(value: f64) -> i64 {
    const SHIFT: f64 = 6_755_399_441_055_744.0;
    (value + SHIFT).to_bits().wrapping_sub(SHIFT.to_bits()).cast_signed()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::sums::quantize;
    use crate::film::{Film, PixelRect, lock};
    use crate::math::Vec3;

    #[test]
    fn halves_are_those_of_the_quantized_number() {
        let mut value = 1.0 - f64::EPSILON;
        for i in 0..2000 {
            value = (value * 1.618_033_988_749_895).fract() + 0.25;
            for v in [
                value * 2.0_f64.powi(i % 200 - 160),
                f64::from(value as f32) * 2.0_f64.powi(i % 40),
            ] {
                for v in [v, -v, v.trunc(), -v.trunc(), 0.0, -0.0] {
                    let (high, low) = halves(v);
                    assert_eq!(Some(i128::from(high) << 64 | i128::from(low)), quantize(v), "{v:e}");
                }
            }
        }
    }

    #[test]
    fn samples_together_are_samples_one_by_one() {
        let film = || {
            let crop = PixelRect {
                x0: 0,
                y0: 0,
                x1: 20,
                y1: 3,
            };
            Film::new([20, 3], crop).with_squares()
        };
        let (together, alone) = (film(), film());
        let colors = [0.3, -2e9, 1e30, f32::NAN, 1e-12, 7.5, f32::INFINITY, 0.0];
        for round in 0..LANES {
            let mut samples = SampleLanes::default();
            let pixels: [[u32; 2]; LANES] = std::array::from_fn(|i| [(3 * i as u32 + round as u32) % 20, i as u32 % 3]);
            for i in 0..LANES {
                let c = |k: usize| colors[(i + k * round) % LANES];
                samples.rgb.set(i, Vec3::new(c(1), c(2), c(3)));
                samples.weight[i] = [1.0, -0.3, 1e14, f32::NAN][(i + round / 2) % 4];
                samples.is_good[i] = i != round;
            }
            let chosen = LaneSet::from(std::array::from_fn(|i| i != 5));
            let mut tile = lock(&together.tiles()[0]);
            let dropped = tile.add_together(Vectorizer::default(), chosen, &pixels, &samples);
            let mut tile = lock(&alone.tiles()[0]);
            for i in chosen.lanes() {
                let [x, y] = pixels[i];
                let rgb = samples.is_good[i].then(|| samples.rgb.get(i).into());
                let is_dropped = !tile.add(x, y, rgb, samples.weight[i]);
                assert_eq!(is_dropped, dropped.lanes().any(|lane| lane == i));
            }
        }
        assert_eq!(together.develop(), alone.develop());
        assert_eq!(together.dropped_samples(), alone.dropped_samples());
        assert!(together.dropped_samples() > 0);
        assert_eq!(together.noise(8).to_bits(), alone.noise(8).to_bits());
    }
}
