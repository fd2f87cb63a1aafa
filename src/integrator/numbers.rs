//! The random numbers of paths, by what they decide: see the table in [`integrator`](super).

use std::cell::OnceCell;

use crate::math::{Lanes, Vec2, Vectorizer};
use crate::sampling::{SampleStream, StreamLanes};

/// Groups of random numbers that the camera sample uses; of a light path's branch, those of its start.
pub(super) const FILM_GROUP: u32 = 0;
pub(super) const DETECTOR_GROUP: u32 = 1;
/// The branch of a sample's numbers that its light path has, which shares the groups of the scattering events.
pub(super) const LIGHT_BRANCH: u32 = u32::MAX;
/// The first group of the scattering events, each of which has two.
const FIRST_EVENT_GROUP: u32 = 2;

/// The random numbers of a scattering event.
#[derive(Clone, Copy, Debug)]
pub(super) struct EventNumbers {
    /// Point of a light.
    pub light: Vec2,
    /// Which light.
    pub which_light: f32,
    /// Russian roulette.
    pub roulette: f32,
    /// Direction within a lobe.
    pub bsdf: Vec2,
    /// Which lobe.
    pub lobe: f32,
    /// Which connections are made of those that could be; how far a path that arrives here flew through media.
    pub connections: f32,
}

impl EventNumbers {
    /// Those of the scattering event `depth` of a path.
    pub fn draw(stream: &SampleStream, depth: u32) -> Self {
        let group = event_group(depth);
        Self::new(stream.draw4(group), stream.draw4(group + 1))
    }

    #[inline]
    fn new([light_x, light_y, which_light, roulette]: [f32; 4], [bsdf_x, bsdf_y, lobe, connections]: [f32; 4]) -> Self {
        Self {
            light: Vec2::new(light_x, light_y),
            which_light,
            roulette,
            bsdf: Vec2::new(bsdf_x, bsdf_y),
            lobe,
            connections,
        }
    }
}

/// The random numbers that start a light path, of its branch of a sample's.
#[derive(Clone, Copy, Debug)]
pub(super) struct EmissionNumbers {
    /// Point of the light.
    pub position: Vec2,
    /// Which light.
    pub which_light: f32,
    /// Direction from it.
    pub direction: Vec2,
}

impl EmissionNumbers {
    /// Those of a light path.
    pub fn draw(stream: &SampleStream) -> Self {
        let [position_x, position_y, which_light, _] = stream.draw4(FILM_GROUP);
        Self {
            position: Vec2::new(position_x, position_y),
            which_light,
            direction: stream.draw2(DETECTOR_GROUP).into(),
        }
    }
}

fn event_group(depth: u32) -> u32 {
    FIRST_EVENT_GROUP + 2 * depth
}

/// [`EventNumbers`] of eight paths, drawn when they are asked for.
pub(super) struct EventLanes<'a> {
    vectorizer: Vectorizer,
    streams: &'a StreamLanes,
    group: u32,
    all: OnceCell<[[Lanes; 4]; 2]>,
}

impl<'a> EventLanes<'a> {
    /// Those of the scattering event `depth` of each path.
    #[inline]
    pub fn new(vectorizer: Vectorizer, streams: &'a StreamLanes, depth: u32) -> Self {
        Self {
            vectorizer,
            streams,
            group: event_group(depth),
            all: OnceCell::new(),
        }
    }

    /// Those of one of the paths.
    #[inline]
    pub fn get(&self, lane: usize) -> EventNumbers {
        let [light, bsdf] = self.all();
        let of = |numbers: &[Lanes; 4]| numbers.map(|numbers| numbers[lane]);
        EventNumbers::new(of(light), of(bsdf))
    }

    /// Those of all of the paths.
    pub fn all(&self) -> &[[Lanes; 4]; 2] {
        self.all
            .get_or_init(|| self.streams.draw::<0b1111, 0b1111>(self.vectorizer, self.group))
    }

    /// Those that surfaces ask for that have but one lobe, of all paths: which light and Russian roulette only where there is a choice.
    #[inline(always)]
    pub fn of_one_lobe(&self, chooses_light: bool, may_end: bool) -> [[Lanes; 4]; 2] {
        let Self {
            vectorizer,
            streams,
            group,
            ..
        } = *self;
        match (chooses_light, may_end) {
            (false, false) => streams.draw::<0b0011, 0b0011>(vectorizer, group),
            (false, true) => streams.draw::<0b1011, 0b0011>(vectorizer, group),
            (true, _) => streams.draw::<0b1111, 0b0011>(vectorizer, group),
        }
    }
}

/// What surfaces with one lobe need of [`EventNumbers`], of eight paths, where they were drawn: copies would be waited for.
pub(super) struct OneLobeLanes<'a> {
    /// See [`EventNumbers::light`].
    pub light: [&'a Lanes; 2],
    /// See [`EventNumbers::which_light`].
    pub which_light: &'a Lanes,
    /// See [`EventNumbers::roulette`].
    pub roulette: &'a Lanes,
    /// See [`EventNumbers::bsdf`].
    pub bsdf: [&'a Lanes; 2],
}

impl<'a> OneLobeLanes<'a> {
    /// Those among the numbers of [`EventLanes::all`] or of [`EventLanes::of_one_lobe`].
    #[inline(always)]
    pub fn of([light, bsdf]: &'a [[Lanes; 4]; 2]) -> Self {
        Self {
            light: [&light[0], &light[1]],
            which_light: &light[2],
            roulette: &light[3],
            bsdf: [&bsdf[0], &bsdf[1]],
        }
    }
}
