//! The camera rays of a wave.
//!
//! They are packed by blocks of 4 x 2 pixels at absolute coordinates: what a packet is made of does not depend on the crop. A block
//! that the crop touches is traced whole, as a backend's answer to coherent rays may depend on their mates. Where it does so for
//! other kinds of rays too, whole tiles are rendered and the rest is discarded.

use std::ops::Range;

use super::Wave;
use crate::accel::RayKind;
use crate::camera::{CameraSample, CameraSampleLanes};
use crate::film::{PixelRect, TILE_SIZE};
use crate::geometry::{LANES, Ray, RayCone, RayPacket};
use crate::integrator::lane::{Batch, Lane, LanePacket, NO_SLOT, Slot};
use crate::integrator::numbers::{DETECTOR_GROUP, FILM_GROUP};
use crate::integrator::queue::Packet;
use crate::integrator::stage::{Estimator, Moment};
use crate::material::TransportMode;
use crate::math::{LaneSet, Lanes, Vec2, VectorLanes, Vectorizer};
use crate::sampling::StreamLanes;
use crate::scene::View;
use crate::spectrum::{ColorMode, SampledSpectrum, SpectrumLanes};

/// Columns and rows of the block of pixels whose camera rays share a packet.
const BLOCK: [u32; 2] = [4, 2];

impl<E: Estimator> Wave<'_, E> {
    /// The pixels whose camera rays are traced: whole blocks, or the whole tile, within the picture.
    pub(super) fn traced_rect(&self, rect: PixelRect) -> PixelRect {
        if rect.area() == 0 {
            return rect;
        }
        let [step_x, step_y] = if self.whole_tiles { [TILE_SIZE; 2] } else { BLOCK };
        let [width, height] = self.view.resolution;
        PixelRect {
            x0: rect.x0 / step_x * step_x,
            y0: rect.y0 / step_y * step_y,
            x1: (rect.x1.div_ceil(step_x) * step_x).min(width),
            y1: (rect.y1.div_ceil(step_y) * step_y).min(height),
        }
    }

    /// Makes slots, and the batch of camera rays.
    pub(super) fn generate(&mut self, pixels: &Pixels, samples: Range<u32>) -> Batch<E::State> {
        let all = pixels.all();
        self.slots.clear();
        let mut batch = self.spare.pop().unwrap_or_default();
        batch.restart(TransportMode::Radiance, 0);
        batch.kind = RayKind::Camera;
        for sample in samples {
            for y in (all.y0..all.y1).step_by(BLOCK[1] as usize) {
                for x in (all.x0..all.x1).step_by(BLOCK[0] as usize) {
                    self.generate_block(&mut batch, pixels, [x, y], sample);
                }
            }
        }
        batch
    }

    fn generate_block(&mut self, batch: &mut Batch<E::State>, pixels: &Pixels, corner: [u32; 2], sample: u32) {
        let (view, vectorizer, estimator) = (self.view, self.vectorizer, self.estimator);
        let pixel = move |i| pixel_of_block(corner, i);
        let Block { traced, wanted, slots } = pixels.of_block(pixel, self.whole_tiles);
        let streams = StreamLanes::start(vectorizer, &view.sampler, pixel, sample);
        let (shared_moment, color) = (estimator.moment(), self.scene.color());
        let [film, detector] = draw(&streams, vectorizer, view, color, shared_moment);
        let filters = view.filter.sample_lanes(vectorizer, pixel, [&film[0], &film[1]]);
        let [wavelengths, times] = shared_moment.map_or([detector[0], detector[1]], |moment| {
            [[moment.wavelength; LANES], [moment.time; LANES]]
        });
        let samples = CameraSampleLanes {
            film: &filters.film,
            lens: [&film[2], &film[3]],
            time: &times,
        };
        let any = || {
            LanePacket::all(Lane {
                slot: NO_SLOT,
                split: false,
                stream: streams.get(0),
                beta: SampledSpectrum::ONE,
                eta_scale: 1.0,
                cone: RayCone::default(),
                state: estimator.camera_state(view, &Ray::INACTIVE),
            })
        };
        let (rays, lanes) = batch.paths.push_any_packet(any);
        let starts = Starts::new(view, vectorizer, samples, traced, rays);
        lanes.split = [0; LANES];
        lanes.streams = streams;
        lanes.beta = SpectrumLanes::all(SampledSpectrum::ONE);
        lanes.eta_scale = [1.0; LANES];
        (lanes.cone_width, lanes.cone_spread) = (starts.width, starts.spread);
        for i in 0..LANES {
            lanes.states.set(i, estimator.camera_state(view, &rays.get(i)));
        }
        self.stats.camera_rays += u64::from(starts.sent.len());
        lanes.slot = [NO_SLOT; LANES];
        for i in slots.lanes() {
            if wanted.has(i) {
                lanes.slot[i] = self.slots.len() as u32;
            }
            let moment = Moment {
                wavelength: wavelengths[i],
                time: times[i],
            };
            self.slots.push(Slot {
                pixel: pixel(i),
                sample,
                filter_weight: filters.weight[i],
                importance: starts.importance[i],
                time: view.camera.scene_time(moment.time),
                lambda: moment.wavelengths(color),
                l: SampledSpectrum::ZERO,
                broken: starts.broken.has(i),
            });
        }
    }
}

/// The pixel of a lane.
#[inline(always)]
fn pixel_of_block([x, y]: [u32; 2], lane: usize) -> [u32; 2] {
    [x + lane as u32 % BLOCK[0], y + lane as u32 / BLOCK[0]]
}

/// The numbers of the groups of film and detector of eight samples: those that are asked for.
#[inline]
fn draw(
    streams: &StreamLanes,
    vectorizer: Vectorizer,
    view: &View,
    color: ColorMode,
    shared_moment: Option<Moment>,
) -> [[Lanes; 4]; 2] {
    const { assert!(DETECTOR_GROUP == FILM_GROUP + 1) };
    let needs_moment = shared_moment.is_none() && (color == ColorMode::Spectral || view.camera.has_exposure());
    match (view.camera.has_lens(), needs_moment) {
        (true, _) => streams.draw::<0b1111, 0b0011>(vectorizer, FILM_GROUP),
        (false, true) => streams.draw::<0b0011, 0b0011>(vectorizer, FILM_GROUP),
        (false, false) => streams.draw::<0b0011, 0>(vectorizer, FILM_GROUP),
    }
}

/// Which lanes of a block of pixels have what.
struct Block {
    /// Camera rays.
    traced: LaneSet,
    /// Paths that the film wants.
    wanted: LaneSet,
    slots: LaneSet,
}

/// The pixels of a tile.
pub(super) struct Pixels {
    /// That the film wants.
    pub wanted: PixelRect,
    /// Whose camera rays are traced.
    pub traced: PixelRect,
    /// That have light paths, if there are any.
    pub light: PixelRect,
}

impl Pixels {
    /// All of them.
    pub fn all(&self) -> PixelRect {
        let (a, b) = (self.traced, self.light);
        if a.area() == 0 {
            return b;
        }
        PixelRect {
            x0: a.x0.min(b.x0),
            y0: a.y0.min(b.y0),
            x1: a.x1.max(b.x1),
            y1: a.y1.max(b.y1),
        }
    }

    /// Those of a block.
    #[inline]
    fn of_block(&self, pixel: impl Fn(usize) -> [u32; 2], whole_tiles: bool) -> Block {
        let within = |rect: &PixelRect| {
            let contains = |i| {
                let [x, y] = pixel(i);
                rect.contains(x, y)
            };
            // A rectangle that has two opposite corners has all between.
            if contains(0) && contains(LANES - 1) {
                LaneSet::ALL
            } else {
                LaneSet::from(std::array::from_fn(contains))
            }
        };
        let traced = within(&self.traced);
        let wanted = if whole_tiles { traced } else { LaneSet::NONE };
        let wanted = wanted.or(within(&self.wanted));
        Block {
            traced,
            wanted,
            slots: wanted.or(within(&self.light)),
        }
    }
}

/// The camera rays of a block.
struct Starts {
    /// Which were sent.
    sent: LaneSet,
    /// Which could not be traced.
    broken: LaneSet,
    importance: Lanes,
    width: Lanes,
    spread: Lanes,
}

impl Starts {
    /// Writes the rays of the `traced` ones of these samples.
    #[inline]
    fn new(
        view: &View,
        vectorizer: Vectorizer,
        samples: CameraSampleLanes<'_>,
        traced: LaneSet,
        rays: &mut RayPacket,
    ) -> Self {
        let camera = &view.camera;
        let Some(known) = camera.generate_rays(vectorizer, samples, view.detail_scale(), rays) else {
            return Self::one_by_one(view, samples, traced, rays);
        };
        let valid = LaneSet::from(known.is_valid);
        let (sent, broken) = (traced.and(valid), traced.without(valid));
        for i in LaneSet::ALL.without(sent).lanes() {
            rays.set(i, &Ray::INACTIVE);
        }
        Self {
            sent,
            broken,
            importance: [1.0; LANES],
            width: known.width,
            spread: known.spread,
        }
    }

    fn one_by_one(view: &View, samples: CameraSampleLanes<'_>, traced: LaneSet, rays: &mut RayPacket) -> Self {
        *rays = RayPacket::EMPTY;
        let (mut sent, mut broken) = ([false; LANES], [false; LANES]);
        let (mut importance, mut width, mut spread) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            let sample = CameraSample {
                film: samples.film.get(i),
                lens: Vec2::new(samples.lens[0][i], samples.lens[1][i]),
                time: samples.time[i],
            };
            let cone = view.camera.ray_cone(sample.film, view.detail_scale());
            (width[i], spread[i]) = (cone.width, cone.spread);
            // Else nothing comes through the lenses.
            if let Some((ray, weight)) = view.camera.generate_ray(&sample) {
                importance[i] = weight;
                (sent[i], broken[i]) = (ray.is_valid(), !ray.is_valid());
                if sent[i] && traced.has(i) {
                    rays.set(i, &ray);
                }
            }
        }
        Self {
            sent: traced.and(sent.into()),
            broken: traced.and(broken.into()),
            importance,
            width,
            spread,
        }
    }
}
