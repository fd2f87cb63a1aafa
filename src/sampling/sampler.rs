//! The numbers that a pixel sample consumes, each a pure function of (seed, pixel, sample, branch, dimension).

use super::hash::{GOLDEN, combine, mix64, unit_f32};
use super::sobol::{dimension_1_reversed, dimensions_2_3_reversed, scramble_reversed};
use crate::math::{Kernel, Vectorizer};

/// How the samples of a pixel relate to one another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SamplerKind {
    /// Not at all: independent uniform numbers.
    Independent,
    /// Owen-scrambled Sobol points: over the samples of a pixel each group of numbers fills its domain evenly.
    Sobol,
}

/// The source of all random numbers of a render. It has no state: the same arguments always give the same numbers, in any
/// order and on any thread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampler {
    kind: SamplerKind,
    seed: u64,
    samples_per_pixel: u32,
}

impl Sampler {
    /// A sampler for `samples_per_pixel` samples in each pixel. Sobol points are at their best for powers of two.
    pub fn new(kind: SamplerKind, seed: u64, samples_per_pixel: u32) -> Self {
        Self {
            kind,
            seed,
            samples_per_pixel,
        }
    }

    /// The kind it was made with.
    pub fn kind(&self) -> SamplerKind {
        self.kind
    }

    /// The seed it was made with.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// The planned number of samples in a pixel.
    pub fn samples_per_pixel(&self) -> u32 {
        self.samples_per_pixel
    }

    /// The numbers of sample `sample_index` of pixel (`x`, `y`), which may lie outside the image. An index from
    /// `samples_per_pixel` on is the caller's error, which debug builds assert: it has numbers, but the even distribution
    /// over the samples of a pixel is promised for the planned ones only.
    #[inline]
    pub fn start(&self, x: i32, y: i32, sample_index: u32) -> SampleStream {
        debug_assert!(sample_index < self.samples_per_pixel);
        let pixel = u64::from(x.cast_unsigned()) << 32 | u64::from(y.cast_unsigned());
        SampleStream {
            key: combine(mix64(self.seed ^ GOLDEN), pixel),
            reversed_index: sample_index.reverse_bits(),
            kind: self.kind,
        }
    }
}

/// The numbers of one pixel sample, in groups of four dimensions. A group is one decision of a path (a point on the lens
/// and the time; a direction and a lobe); its caller numbers the groups so that no two decisions share one.
///
/// Drawing changes nothing: the same group gives the same numbers again, and [`Self::draw1`] and [`Self::draw2`] give the
/// first of the group's four. Of a Sobol group the first two dimensions are the most even pair (any power-of-two prefix of
/// the samples has one point in each elementary interval of its size), each dimension on its own is perfectly stratified,
/// and different groups, pixels and branches are randomised independently.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SampleStream {
    /// A hash of seed, pixel and branches.
    key: u64,
    reversed_index: u32,
    kind: SamplerKind,
}

const _: () = assert!(size_of::<SampleStream>() <= 16);

impl SampleStream {
    /// The four numbers of `group`, in [0, 1).
    #[inline]
    pub fn draw4(&self, group: u32) -> [f32; 4] {
        match self.kind {
            SamplerKind::Independent => independent(self.key, self.reversed_index, group),
            SamplerKind::Sobol => sobol(self.key, self.reversed_index, group),
        }
    }

    /// The first number of `group`, in [0, 1).
    #[inline]
    pub fn draw1(&self, group: u32) -> f32 {
        self.draw4(group)[0]
    }

    /// The first two numbers of `group`, in [0, 1).
    #[inline]
    pub fn draw2(&self, group: u32) -> [f32; 2] {
        let [x, y, ..] = self.draw4(group);
        [x, y]
    }

    /// [`Self::draw4`] of `N` streams of one sampler at once, lane by lane: the same numbers, several times faster.
    #[inline]
    pub fn draw4_lanes<const N: usize>(vectorizer: Vectorizer, streams: &[Self; N], group: u32) -> [[f32; N]; 4] {
        vectorizer.run(DrawLanes { streams, group })
    }

    /// The stream of branch `n` of this one, for a path that splits: independent of this stream, of its other branches and
    /// of theirs. For a fixed `n` the branches of a pixel's samples are as evenly distributed as the samples.
    #[inline]
    #[must_use]
    pub fn branch(&self, n: u32) -> Self {
        Self {
            // A value above 32 bits: no group number gives it.
            key: combine(self.key, u64::from(n) | 1 << 63),
            ..*self
        }
    }
}

/// See [`SampleStream::draw4_lanes`].
struct DrawLanes<'a, const N: usize> {
    streams: &'a [SampleStream; N],
    group: u32,
}

impl<const N: usize> Kernel for DrawLanes<'_, N> {
    type Output = [[f32; N]; 4];

    #[inline(always)]
    fn call(self) -> Self::Output {
        let (keys, indices) = (self.streams.map(|s| s.key), self.streams.map(|s| s.reversed_index));
        let mut numbers = [[0.0; N]; 4];
        let [x, y, z, w] = &mut numbers;
        match self.streams[0].kind {
            SamplerKind::Independent => {
                for i in 0..N {
                    [x[i], y[i], z[i], w[i]] = independent(keys[i], indices[i], self.group);
                }
            }
            SamplerKind::Sobol => {
                for i in 0..N {
                    [x[i], y[i], z[i], w[i]] = sobol(keys[i], indices[i], self.group);
                }
            }
        }
        numbers
    }
}

/// Four uniform numbers for (key, index, group).
#[inline(always)]
fn independent(key: u64, reversed_index: u32, group: u32) -> [f32; 4] {
    let a = split_mix(key, u64::from(reversed_index) << 32 | u64::from(group));
    let b = mix64(a.wrapping_add(GOLDEN));
    [a as u32, (a >> 32) as u32, b as u32, (b >> 32) as u32].map(unit_f32)
}

/// The Sobol point that this sample takes in `group`, scrambled. The index is shuffled by a nested scramble as well, so that the
/// samples of a prefix of 2^k keep to one another while different groups are paired at random.
#[inline(always)]
fn sobol(key: u64, reversed_index: u32, group: u32) -> [f32; 4] {
    let hash = split_mix(key, u64::from(group));
    let (a, b) = (mix64(hash.wrapping_add(GOLDEN)), mix64(hash ^ GOLDEN.rotate_left(32)));
    let index = scramble_reversed(reversed_index, hash as u32).reverse_bits();
    let (second, third) = dimensions_2_3_reversed(index);
    [
        scrambled_unit(index, a as u32),
        scrambled_unit(dimension_1_reversed(index), (a >> 32) as u32),
        scrambled_unit(second, b as u32),
        scrambled_unit(third, (b >> 32) as u32),
    ]
}

/// The number at place `counter` of the SplitMix64 generator (Steele, Lea and Flood 2014) whose state is the key. Keys are
/// hashes, so that no two of these sequences come near each other.
#[inline(always)]
fn split_mix(key: u64, counter: u64) -> u64 {
    mix64(key.wrapping_add(counter.wrapping_add(1).wrapping_mul(GOLDEN)))
}

#[inline(always)]
fn scrambled_unit(reversed: u32, seed: u32) -> f32 {
    unit_f32(scramble_reversed(reversed, seed).reverse_bits())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_are_prefixes_of_one_group_and_branches_differ() {
        for kind in [SamplerKind::Independent, SamplerKind::Sobol] {
            let stream = Sampler::new(kind, 7, 16).start(-3, 5, 11);
            let four = stream.draw4(9);
            assert_eq!(stream.draw2(9), [four[0], four[1]]);
            assert_eq!(stream.draw1(9), four[0]);
            assert_eq!(stream.draw4(9), four);
            let others = [
                stream.draw4(8),
                stream.branch(0).draw4(9),
                stream.branch(1).draw4(9),
                stream.branch(0).branch(1).draw4(9),
                stream.branch(1).branch(0).draw4(9),
                Sampler::new(kind, 8, 16).start(-3, 5, 11).draw4(9),
                Sampler::new(kind, 7, 16).start(5, -3, 11).draw4(9),
                Sampler::new(kind, 7, 16).start(-3, 5, 10).draw4(9),
            ];
            for (i, a) in others.iter().enumerate() {
                assert!(*a != four && others[..i].iter().all(|b| a != b), "{kind:?} {i}");
            }
        }
    }

    #[test]
    fn lanes_get_the_numbers_of_their_streams() {
        for kind in [SamplerKind::Independent, SamplerKind::Sobol] {
            let sampler = Sampler::new(kind, 3, 64);
            let streams: [_; 8] =
                std::array::from_fn(|i| sampler.start(i as i32 - 3, 7, 5 * i as u32).branch(i as u32 % 3));
            let lanes = SampleStream::draw4_lanes(Vectorizer::default(), &streams, 11);
            for (i, stream) in streams.iter().enumerate() {
                assert_eq!(lanes.map(|numbers| numbers[i]), stream.draw4(11), "{kind:?}");
            }
        }
    }

    #[test]
    fn numbers_are_the_same_forever() {
        // A change here changes every image and invalidates every stored film: it has to be meant.
        let bits = |kind| {
            let stream = Sampler::new(kind, 0, 4).start(1, 2, 3);
            stream.draw4(5).map(|u| (u * 16_777_216.0) as u32)
        };
        assert_eq!(
            bits(SamplerKind::Independent),
            [2_026_895, 8_073_496, 12_369_065, 14_045_273]
        );
        assert_eq!(bits(SamplerKind::Sobol), [3_760_583, 9_305_995, 767_873, 3_742_433]);
    }
}
