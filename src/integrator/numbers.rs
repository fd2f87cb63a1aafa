//! The random numbers of paths, by what they decide: see the table in [`integrator`](super).

use crate::math::{LANES, Lanes, Vec2, Vectorizer};
use crate::sampling::SampleStream;

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

/// [`EventNumbers`] of eight paths.
pub(super) struct EventLanes {
    light: [Lanes; 4],
    bsdf: [Lanes; 4],
}

impl EventLanes {
    /// Those of the scattering event `depth` of each path.
    pub fn draw(vectorizer: Vectorizer, streams: &[SampleStream; LANES], depth: u32) -> Self {
        let group = event_group(depth);
        Self {
            light: SampleStream::draw4_lanes(vectorizer, streams, group),
            bsdf: SampleStream::draw4_lanes(vectorizer, streams, group + 1),
        }
    }

    /// The two for points of lights.
    #[inline]
    pub fn light(&self) -> [&Lanes; 2] {
        let [x, y, ..] = &self.light;
        [x, y]
    }

    /// See [`EventNumbers::which_light`].
    #[inline]
    pub fn which_light(&self) -> &Lanes {
        &self.light[2]
    }

    /// See [`EventNumbers::roulette`].
    #[inline]
    pub fn roulette(&self) -> &Lanes {
        &self.light[3]
    }

    /// The two for directions within lobes.
    #[inline]
    pub fn bsdf(&self) -> [&Lanes; 2] {
        let [x, y, ..] = &self.bsdf;
        [x, y]
    }

    /// Those of one of the paths.
    #[inline]
    pub fn get(&self, lane: usize) -> EventNumbers {
        let of = |numbers: &[Lanes; 4]| numbers.map(|numbers| numbers[lane]);
        EventNumbers::new(of(&self.light), of(&self.bsdf))
    }
}
