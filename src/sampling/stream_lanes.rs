//! The sample streams of eight paths side by side.

use super::sampler::{Plan, SampleStream, Sampler, SamplerKind, draw};
use crate::math::{Columns, Kernel, LANES, Lanes, Packing, Shuffle, Vectorizer};

/// [`SampleStream`]s of one sampler, one for each lane of a packet.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub struct StreamLanes {
    key_low: [u32; LANES],
    key_high: [u32; LANES],
    reversed_index: [u32; LANES],
    place: [u32; LANES],
    /// Of all of them.
    plan: Plan,
}

impl StreamLanes {
    /// The same stream in all lanes.
    #[inline(always)]
    pub fn all(stream: SampleStream) -> Self {
        let mut lanes = Self {
            key_low: [0; LANES],
            key_high: [0; LANES],
            reversed_index: [0; LANES],
            place: [0; LANES],
            plan: stream.plan,
        };
        for lane in 0..LANES {
            lanes.set(lane, stream);
        }
        lanes
    }

    /// The streams of sample `sample_index` of eight pixels, which `pixel` tells: those of [`Sampler::start`], several times faster.
    #[inline]
    pub fn start(
        vectorizer: Vectorizer,
        sampler: &Sampler,
        pixel: impl Fn(usize) -> [u32; 2],
        sample_index: u32,
    ) -> Self {
        vectorizer.run(Start {
            sampler,
            pixel,
            sample_index,
        })
    }

    /// The stream of a lane.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> SampleStream {
        SampleStream {
            key: u64::from(self.key_high[lane]) << 32 | u64::from(self.key_low[lane]),
            reversed_index: self.reversed_index[lane],
            place: self.place[lane] as u16,
            plan: self.plan,
        }
    }

    /// Puts a stream into a lane, of the sampler that the others are of.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, stream: SampleStream) {
        (self.key_low[lane], self.key_high[lane]) = (stream.key as u32, (stream.key >> 32) as u32);
        (self.reversed_index[lane], self.place[lane]) = (stream.reversed_index, stream.place.into());
        self.plan = stream.plan;
    }

    /// Numbers of `group` and of the next one, for each lane: those of [`SampleStream::draw4`], several times faster. `FIRST` and `SECOND`
    /// say which: number i where bit i is set; the others are 0.
    #[inline]
    pub fn draw<const FIRST: u8, const SECOND: u8>(&self, vectorizer: Vectorizer, group: u32) -> [[Lanes; 4]; 2] {
        vectorizer.run(Draw::<FIRST, SECOND> { streams: self, group })
    }
}

impl Columns for StreamLanes {
    #[inline(always)]
    fn pack<S: Shuffle>(&self, packing: &Packing<S>, last: &mut Self, next: &mut Self) {
        self.key_low.pack(packing, &mut last.key_low, &mut next.key_low);
        self.key_high.pack(packing, &mut last.key_high, &mut next.key_high);
        self.reversed_index
            .pack(packing, &mut last.reversed_index, &mut next.reversed_index);
        self.place.pack(packing, &mut last.place, &mut next.place);
        (last.plan, next.plan) = (self.plan, self.plan);
    }
}

/// See [`StreamLanes::start`].
struct Start<'a, P> {
    sampler: &'a Sampler,
    pixel: P,
    sample_index: u32,
}

impl<P: Fn(usize) -> [u32; 2]> Kernel for Start<'_, P> {
    type Output = StreamLanes;

    #[inline(always)]
    fn call(self) -> StreamLanes {
        if self.sampler.kind() == SamplerKind::ZSobol {
            self.streams(&self.sampler.with_known_keys(true))
        } else {
            self.streams(&self.sampler.with_known_keys(false))
        }
    }
}

impl<P: Fn(usize) -> [u32; 2]> Start<'_, P> {
    #[inline(always)]
    fn streams(&self, known: &Sampler) -> StreamLanes {
        let mut lanes = StreamLanes {
            key_low: [0; LANES],
            key_high: [0; LANES],
            reversed_index: [self.sample_index.reverse_bits(); LANES],
            place: [0; LANES],
            plan: self.sampler.plan(),
        };
        for i in 0..LANES {
            let [x, y] = (self.pixel)(i);
            let (key, place) = known.key_and_place(x.cast_signed(), y.cast_signed());
            (lanes.key_low[i], lanes.key_high[i]) = (key as u32, (key >> 32) as u32);
            lanes.place[i] = place.into();
        }
        lanes
    }
}

/// See [`StreamLanes::draw`].
struct Draw<'a, const FIRST: u8, const SECOND: u8> {
    streams: &'a StreamLanes,
    group: u32,
}

impl<const FIRST: u8, const SECOND: u8> Kernel for Draw<'_, FIRST, SECOND> {
    type Output = [[Lanes; 4]; 2];

    #[inline(always)]
    fn call(self) -> [[Lanes; 4]; 2] {
        let streams = self.streams;
        let (indices, places) = (streams.reversed_index, streams.place);
        let mut keys = [0; LANES];
        for (i, key) in keys.iter_mut().enumerate() {
            *key = u64::from(streams.key_high[i]) << 32 | u64::from(streams.key_low[i]);
        }
        // The plan is known where numbers are drawn, so that these stay in registers.
        match streams.plan {
            Plan::Sobol => self.groups(
                #[inline(always)]
                |group| draw(keys, indices, places, Plan::Sobol, group),
            ),
            Plan::ZSobol(log2_samples) => self.groups(
                #[inline(always)]
                |group| draw(keys, indices, places, Plan::ZSobol(log2_samples), group),
            ),
            plan => self.groups(
                #[inline(always)]
                |group| draw(keys, indices, places, plan, group),
            ),
        }
    }
}

impl<const FIRST: u8, const SECOND: u8> Draw<'_, FIRST, SECOND> {
    /// What is not asked for is not computed.
    #[inline(always)]
    fn groups(&self, draw: impl Fn(u32) -> [Lanes; 4]) -> [[Lanes; 4]; 2] {
        let mut numbers = [[[0.0; LANES]; 4]; 2];
        let (first, second) = (draw(self.group), draw(self.group + 1));
        for i in 0..4 {
            if FIRST >> i & 1 == 1 {
                numbers[0][i] = first[i];
            }
            if SECOND >> i & 1 == 1 {
                numbers[1][i] = second[i];
            }
        }
        numbers
    }
}
