//! The numbers that a pixel sample consumes, each a pure function of (seed, pixel, sample, branch, dimension).
//!
//! The dimensions come in groups of four; what a group serves is fixed by its number (see [`crate::integrator`] for the table),
//! whatever the sampler.

use super::hash::{GOLDEN, combine, mix64, split_mix, unit_f32};
use super::sobol::{scramble_reversed, scrambled_points};
use super::stratified::Strata;
use super::zsobol::Order;
use super::{halton, stratified, zsobol};

/// How the samples of a pixel relate to one another. All estimate the same, but for strata without jitter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SamplerKind {
    /// Not at all: independent uniform numbers.
    Independent,
    /// One point in each cell of a grid over each pair of numbers, and in each slice of either, the slices as many as samples.
    /// Even over all samples of a pixel only, not over the first of them.
    Stratified(Strata),
    /// Owen-scrambled Halton points: a prime base for each dimension, so that few samples are even in the first groups only.
    Halton,
    /// Owen-scrambled Sobol points: over the samples of a pixel each group of numbers fills its domain evenly.
    Sobol,
    /// As [`SamplerKind::Sobol`], and so that neighbouring pixels together are even too: what noise remains is of high frequency.
    ZSobol,
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
    /// A sampler for `samples_per_pixel` (at least 1) samples in each pixel. Sobol points are at their best for powers of two.
    /// Strata that are not as many as the samples are replaced by those that are, and nearest to squares.
    pub fn new(kind: SamplerKind, seed: u64, samples_per_pixel: u32) -> Self {
        let kind = match kind {
            SamplerKind::Stratified(strata) => SamplerKind::Stratified(strata.for_samples(samples_per_pixel)),
            _ => kind,
        };
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
        let (key, place) = self.key_and_place(x, y);
        SampleStream {
            key,
            reversed_index: sample_index.reverse_bits(),
            place,
            plan: self.plan(),
        }
    }

    /// Of all its streams.
    #[inline(always)]
    pub(super) fn plan(&self) -> Plan {
        match self.kind {
            SamplerKind::Independent => Plan::Independent,
            SamplerKind::Stratified(strata) => Plan::Stratified(strata),
            SamplerKind::Halton => Plan::Halton(self.samples_per_pixel),
            SamplerKind::Sobol => Plan::Sobol,
            SamplerKind::ZSobol => Plan::ZSobol(Order::new(self.samples_per_pixel, 0, 0).0.log2_samples),
        }
    }

    /// See [`SampleStream`].
    #[inline(always)]
    pub(super) fn key_and_place(&self, x: i32, y: i32) -> (u64, u16) {
        let (place, [x, y]) = if self.kind == SamplerKind::ZSobol {
            let (order, tile) = Order::new(self.samples_per_pixel, x, y);
            (order.place, tile)
        } else {
            (0, [x, y])
        };
        let pixel = u64::from(x.cast_unsigned()) << 32 | u64::from(y.cast_unsigned());
        (combine(mix64(self.seed ^ GOLDEN), pixel), place)
    }

    /// It, or another with the same keys and places, such that the compiler knows which way these go.
    #[inline(always)]
    pub(super) fn with_known_keys(&self, is_zsobol: bool) -> Self {
        let kind = if is_zsobol {
            SamplerKind::ZSobol
        } else {
            SamplerKind::Sobol
        };
        Self { kind, ..*self }
    }
}

/// The numbers of one pixel sample, in groups of four dimensions. A group is one decision of a path (a point on the lens
/// and the time; a direction and a lobe); its caller numbers the groups so that no two decisions share one.
///
/// Drawing changes nothing: the same group gives the same numbers again, and [`Self::draw1`] and [`Self::draw2`] give the
/// first of the group's four. The first two dimensions are the most even pair, each dimension on its own is stratified, and
/// different groups and branches are randomised independently; so are different pixels, but for [`SamplerKind::ZSobol`], and
/// groups of [`SamplerKind::Halton`] share an index: they are independent over seeds and pixels, not over a pixel's samples.
///
/// - Sobol and Z-Sobol: of the first pair any power-of-two prefix of the samples has one point in each elementary interval of
///   its size; the whole group is a net with t = 3.
/// - Stratified: both pairs of a group are multi-jittered, over all samples of the pixel.
/// - Halton: the bases of group g are the prime numbers 4 g to 4 g + 3 (counted from 0).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SampleStream {
    /// A hash of seed, pixel (or tile of pixels) and branches.
    pub(super) key: u64,
    pub(super) reversed_index: u32,
    /// Of the pixel, see [`Order::place`].
    pub(super) place: u16,
    pub(super) plan: Plan,
}

const _: () = assert!(size_of::<SampleStream>() <= 32);

/// What a sampler of each kind has to know to draw: the same for all its streams.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Plan {
    Independent,
    Stratified(Strata),
    /// For so many samples.
    Halton(u32),
    Sobol,
    /// See [`Order::log2_samples`].
    ZSobol(u8),
}

impl SampleStream {
    /// The four numbers of `group`, in [0, 1).
    #[inline]
    pub fn draw4(&self, group: u32) -> [f32; 4] {
        let Self {
            key,
            reversed_index,
            place,
            plan,
        } = *self;
        draw([key], [reversed_index], [place.into()], plan, group).map(|[number]| number)
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

/// The four numbers of `group` of each stream; all are of one sampler.
#[inline(always)]
pub(super) fn draw<const N: usize>(
    keys: [u64; N],
    reversed_indices: [u32; N],
    places: [u32; N],
    plan: Plan,
    group: u32,
) -> [[f32; N]; 4] {
    match plan {
        Plan::Independent => each_lane(
            keys,
            reversed_indices,
            #[inline(always)]
            |key, index| independent(key, index, group),
        ),
        Plan::Sobol => sobol(keys, reversed_indices, group),
        Plan::Stratified(strata) => stratified::draw(keys, reversed_indices.map(u32::reverse_bits), strata, group),
        Plan::Halton(samples) => halton::draw(keys, reversed_indices.map(u32::reverse_bits), samples, group),
        Plan::ZSobol(log2_samples) => zsobol::draw(keys, reversed_indices, log2_samples, places, group),
    }
}

#[inline(always)]
fn each_lane<const N: usize>(
    keys: [u64; N],
    reversed_indices: [u32; N],
    numbers_of: impl Fn(u64, u32) -> [f32; 4],
) -> [[f32; N]; 4] {
    let mut numbers = [[0.0; N]; 4];
    let [x, y, z, w] = &mut numbers;
    for i in 0..N {
        [x[i], y[i], z[i], w[i]] = numbers_of(keys[i], reversed_indices[i]);
    }
    numbers
}

/// Four uniform numbers for (key, index, group).
#[inline(always)]
fn independent(key: u64, reversed_index: u32, group: u32) -> [f32; 4] {
    let a = split_mix(key, u64::from(reversed_index) << 32 | u64::from(group));
    let b = mix64(a.wrapping_add(GOLDEN));
    [a as u32, (a >> 32) as u32, b as u32, (b >> 32) as u32].map(unit_f32)
}

/// The Sobol points that samples take in `group`, scrambled. The index is shuffled by a nested scramble as well, so that the
/// samples of a prefix of 2^k keep to one another while different groups are paired at random.
#[inline(always)]
fn sobol<const N: usize>(keys: [u64; N], reversed_indices: [u32; N], group: u32) -> [[f32; N]; 4] {
    let (mut hashes, mut indices) = ([0; N], [0; N]);
    for i in 0..N {
        hashes[i] = split_mix(keys[i], u64::from(group));
        indices[i] = scramble_reversed(reversed_indices[i], hashes[i] as u32).reverse_bits();
    }
    scrambled_points(indices, hashes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{LANES, Vectorizer};
    use crate::sampling::StreamLanes;

    const KINDS: [SamplerKind; 6] = [
        SamplerKind::Independent,
        SamplerKind::Stratified(Strata {
            columns: 4,
            rows: 4,
            jitter: true,
        }),
        SamplerKind::Stratified(Strata {
            columns: 5,
            rows: 3,
            jitter: false,
        }),
        SamplerKind::Halton,
        SamplerKind::Sobol,
        SamplerKind::ZSobol,
    ];

    #[test]
    fn draws_are_prefixes_of_one_group_and_branches_differ() {
        for kind in KINDS {
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
        for kind in KINDS {
            let sampler = Sampler::new(kind, 3, 64);
            let streams: [_; LANES] =
                std::array::from_fn(|i| sampler.start(i as i32 - 3, 7, 5 * i as u32).branch(i as u32 % 3));
            let mut lanes = StreamLanes::all(streams[0]);
            for (i, stream) in streams.into_iter().enumerate() {
                lanes.set(i, stream);
            }
            for group in [0, 11, 300] {
                let [numbers, some] = lanes.draw::<0b1111, 0b1001>(Vectorizer::default(), group);
                for (i, stream) in streams.iter().enumerate() {
                    assert_eq!(lanes.get(i), *stream, "{kind:?}");
                    assert_eq!(numbers.map(|numbers| numbers[i]), stream.draw4(group), "{kind:?}");
                    let [x, _, _, w] = stream.draw4(group + 1);
                    assert_eq!(some.map(|numbers| numbers[i]), [x, 0.0, 0.0, w], "{kind:?}");
                }
            }
        }
    }

    #[test]
    fn streams_of_eight_pixels_are_those_of_each() {
        for kind in KINDS {
            let sampler = Sampler::new(kind, 5, 48);
            let pixel = |i: usize| [250 + 3 * i as u32, 1000 - i as u32];
            let lanes = StreamLanes::start(Vectorizer::default(), &sampler, pixel, 37);
            for i in 0..LANES {
                let [x, y] = pixel(i).map(u32::cast_signed);
                assert_eq!(lanes.get(i), sampler.start(x, y, 37), "{kind:?}");
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
        let newer = [
            SamplerKind::Stratified(Strata::default()),
            SamplerKind::Halton,
            SamplerKind::ZSobol,
        ];
        let expected = [
            [3_815_203, 666_366, 3_457_363, 11_679_164],
            [9_950_562, 11_596_498, 6_410_702, 5_002_444],
            [15_338_946, 6_293_353, 11_704_387, 2_795_484],
        ];
        assert_eq!(newer.map(bits), expected);
    }
}
