//! The camera rays of a wave.
//!
//! They are packed by blocks of 4 x 2 pixels at absolute coordinates: what a packet is made of does not depend on the crop. A block
//! that the crop touches is traced whole, as a backend's answer to coherent rays may depend on their mates. Where it does so for
//! other kinds of rays too, whole tiles are rendered and the rest is discarded.

use std::ops::Range;

use super::Wave;
use crate::accel::RayKind;
use crate::camera::{CameraLanes, CameraSample};
use crate::film::{FilterLanes, PixelRect, TILE_SIZE};
use crate::geometry::{LANES, Ray, RayCone, RayPacket};
use crate::integrator::lane::{Batch, Lane, LanePacket, NO_SLOT, Slot};
use crate::integrator::numbers::{DETECTOR_GROUP, FILM_GROUP};
use crate::integrator::queue::Packet;
use crate::integrator::stage::{Estimator, Moment};
use crate::material::TransportMode;
use crate::math::{Lanes, Vec2, Vec2Lanes, VectorLanes, Vectorizer};
use crate::sampling::StreamLanes;
use crate::scene::View;
use crate::spectrum::SampledSpectrum;

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
        let Pixels { wanted, traced, light } = *pixels;
        let pixels: [[u32; 2]; LANES] =
            std::array::from_fn(|i| [corner[0] + i as u32 % BLOCK[0], corner[1] + i as u32 / BLOCK[0]]);
        let sampler = &self.view.sampler;
        let start = |[x, y]: [u32; 2]| sampler.start(x.cast_signed(), y.cast_signed(), sample);
        let mut streams = StreamLanes::all(start(corner));
        for (i, &pixel) in pixels.iter().enumerate() {
            streams.set(i, start(pixel));
        }
        const { assert!(DETECTOR_GROUP == FILM_GROUP + 1) };
        let [film, detector] = streams.draw::<0b1111, 0b0011>(self.vectorizer, FILM_GROUP);
        let starts = Starts::new(self.view, self.vectorizer, &pixels, &film);
        let shared_moment = self.estimator.moment();
        let mut rays = RayPacket::EMPTY;
        let mut lanes = LanePacket::all(Lane {
            slot: NO_SLOT,
            split: false,
            stream: streams.get(0),
            beta: SampledSpectrum::ONE,
            eta_scale: 1.0,
            cone: RayCone::default(),
            state: self.estimator.camera_state(self.view, &Ray::INACTIVE),
        });
        lanes.streams = streams;
        for (i, &[x, y]) in pixels.iter().enumerate() {
            let is_traced = traced.contains(x, y);
            let is_wanted = wanted.contains(x, y) || (self.whole_tiles && is_traced);
            let has_slot = is_wanted || light.contains(x, y);
            if !is_traced && !has_slot {
                continue;
            }
            let moment = shared_moment.unwrap_or(Moment {
                wavelength: detector[0][i],
                time: detector[1][i],
            });
            let time = self.view.camera.scene_time(moment.time);
            let start = starts.get(self.view, i, time);
            let mut broken = false;
            (lanes.cone_width[i], lanes.cone_spread[i]) = (start.cone.width, start.cone.spread);
            // Else it is a light path only, or nothing comes through the lenses.
            if is_traced && start.exists {
                broken = !start.ray.is_valid();
                if !broken {
                    rays.set(i, &start.ray);
                    lanes.states.set(i, self.estimator.camera_state(self.view, &start.ray));
                    self.stats.camera_rays += 1;
                }
            }
            if is_wanted {
                lanes.slot[i] = self.slots.len() as u32;
            }
            if has_slot {
                self.slots.push(Slot {
                    pixel: [x, y],
                    sample,
                    filter_weight: starts.filters.weight[i],
                    importance: start.importance,
                    time,
                    lambda: moment.wavelengths(self.scene.color()),
                    l: SampledSpectrum::ZERO,
                    broken,
                });
            }
        }
        batch.paths.push_packet(&rays, &lanes);
    }
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
}

/// A camera ray.
struct Start {
    /// Whether there is one: whether it comes through the lenses.
    exists: bool,
    ray: Ray,
    importance: f32,
    /// How wide it is.
    cone: RayCone,
}

/// The camera rays of a block.
struct Starts {
    filters: FilterLanes,
    film: Vec2Lanes,
    lens: Vec2Lanes,
    /// All of them, if the camera knows them together.
    rays: Option<CameraLanes>,
}

impl Starts {
    /// From the numbers for film and lens of each pixel.
    #[inline]
    fn new(view: &View, vectorizer: Vectorizer, pixels: &[[u32; 2]; LANES], numbers: &[Lanes; 4]) -> Self {
        let [film_x, film_y, lens_x, lens_y] = numbers;
        let filters = view.filter.sample_lanes(vectorizer, [film_x, film_y]);
        let (mut film, mut lens) = (Vec2Lanes::default(), Vec2Lanes::default());
        for (i, [x, y]) in pixels.iter().enumerate() {
            let center = Vec2::new(*x as f32 + 0.5, *y as f32 + 0.5);
            film.set(i, center + filters.offset.get(i));
            lens.set(i, Vec2::new(lens_x[i], lens_y[i]));
        }
        Self {
            rays: view.camera.rays(vectorizer, &film, &lens, view.detail_scale()),
            filters,
            film,
            lens,
        }
    }

    /// That of a lane.
    #[inline]
    fn get(&self, view: &View, lane: usize, time: f32) -> Start {
        if let Some(rays) = &self.rays {
            return Start {
                exists: true,
                ray: rays.ray(lane, time),
                importance: 1.0,
                cone: rays.cone(lane),
            };
        }
        let sample = CameraSample {
            film: self.film.get(lane),
            lens: self.lens.get(lane),
            time: 0.0,
        };
        let start = view.camera.ray_at(&sample, time);
        let (ray, importance) = start.unwrap_or((Ray::INACTIVE, 0.0));
        Start {
            exists: start.is_some(),
            ray,
            importance,
            cone: view.camera.ray_cone(sample.film, view.detail_scale()),
        }
    }
}
