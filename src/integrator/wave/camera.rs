//! The camera rays of a wave.
//!
//! They are packed by blocks of 4 x 2 pixels at absolute coordinates: what a packet is made of does not depend on the crop. A block
//! that the crop touches is traced whole, as a backend's answer to coherent rays may depend on their mates. Where it does so for
//! other kinds of rays too, whole tiles are rendered and the rest is discarded.

use std::ops::Range;

use super::Wave;
use crate::accel::RayKind;
use crate::camera::CameraSample;
use crate::film::{PixelRect, TILE_SIZE};
use crate::geometry::{LANES, Ray, RayCone};
use crate::integrator::lane::{Batch, Lane, NO_SLOT, Slot};
use crate::integrator::numbers::{DETECTOR_GROUP, FILM_GROUP};
use crate::integrator::stage::{Estimator, Moment};
use crate::material::TransportMode;
use crate::math::Vec2;
use crate::sampling::SampleStream;
use crate::scene::{Scene, View};
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
        let streams = pixels.map(|[x, y]| {
            let sampler = &self.view.sampler;
            sampler.start(x.cast_signed(), y.cast_signed(), sample)
        });
        let film = SampleStream::draw4_lanes(self.vectorizer, &streams, FILM_GROUP);
        let detector = SampleStream::draw4_lanes(self.vectorizer, &streams, DETECTOR_GROUP);
        let shared_moment = self.estimator.moment();
        for (i, &[x, y]) in pixels.iter().enumerate() {
            let mut ray = Ray::INACTIVE;
            let mut lane = Lane {
                slot: NO_SLOT,
                split: false,
                stream: streams[i],
                beta: SampledSpectrum::ONE,
                eta_scale: 1.0,
                cone: RayCone::default(),
                state: self.estimator.camera_state(self.view, &ray),
            };
            let is_traced = traced.contains(x, y);
            let is_wanted = wanted.contains(x, y) || (self.whole_tiles && is_traced);
            let has_slot = is_wanted || light.contains(x, y);
            if is_traced || has_slot {
                let moment = shared_moment.unwrap_or(Moment {
                    wavelength: detector[0][i],
                    time: detector[1][i],
                });
                let numbers = film.map(|numbers| numbers[i]);
                let (mut slot, camera_ray, cone) = camera_slot(self.scene, self.view, [x, y], sample, numbers, moment);
                lane.cone = cone;
                match camera_ray.filter(|_| is_traced) {
                    // A light path only, or nothing comes through the lenses.
                    None => {}
                    Some(camera_ray) if camera_ray.is_valid() => {
                        ray = camera_ray;
                        lane.state = self.estimator.camera_state(self.view, &ray);
                        self.stats.camera_rays += 1;
                    }
                    Some(_) => slot.broken = true,
                }
                if is_wanted {
                    lane.slot = self.slots.len() as u32;
                }
                if has_slot {
                    self.slots.push(slot);
                }
            }
            batch.push(&lane, &ray);
        }
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

/// A pixel sample, its camera ray, if one comes through the lenses, and how wide that is, from the numbers for film and lens.
#[inline(always)]
fn camera_slot(
    scene: &Scene,
    view: &View,
    pixel: [u32; 2],
    sample: u32,
    [film_x, film_y, lens_x, lens_y]: [f32; 4],
    moment: Moment,
) -> (Slot, Option<Ray>, RayCone) {
    let filter = view.filter.sample(Vec2::new(film_x, film_y));
    let center = Vec2::new(pixel[0] as f32 + 0.5, pixel[1] as f32 + 0.5);
    let camera_sample = CameraSample {
        film: center + filter.offset,
        lens: Vec2::new(lens_x, lens_y),
        time: moment.time,
    };
    let start = view.camera.generate_ray(&camera_sample);
    let cone = view.camera.ray_cone(camera_sample.film, view.detail_scale());
    let slot = Slot {
        pixel,
        sample,
        filter_weight: filter.weight,
        importance: start.map_or(0.0, |(_, importance)| importance),
        time: view.camera.scene_time(moment.time),
        lambda: moment.wavelengths(scene.color()),
        l: SampledSpectrum::ZERO,
        broken: false,
    };
    (slot, start.map(|(ray, _)| ray), cone)
}
