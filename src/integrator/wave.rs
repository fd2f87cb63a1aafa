//! A wave: the paths of one tile, at one sample index or several, that go through each stage together.
//!
//! A *slot* is a pixel sample; it stays until its last shadow ray is back, then is turned into sensor values and retires. A *lane*
//! is a live path, and names its slot. The lanes that go on after a stage make up the next batch. Where paths branch they are
//! several; the last one goes first, so that their number stays in proportion to the depth of paths. If the estimator has light
//! paths, one for each slot, all of a wave go before its camera paths.
//!
//! Camera rays are packed by blocks of 4 x 2 pixels at absolute coordinates: what a packet is made of does not depend on the crop.
//! A block that the crop touches is traced whole, as a backend's answer to coherent rays may depend on their mates. Where it does
//! so for other kinds of rays too, whole tiles are rendered and the rest is discarded.

use std::ops::Range;
use std::sync::Mutex;
use std::time::Instant;

use super::lane::{Batch, Lane, NO_SLOT, Slot};
use super::numbers::{DETECTOR_GROUP, EventLanes, FILM_GROUP, LIGHT_BRANCH};
use super::schedule::TilePlace;
use super::shadow::{Contribution, ShadowQueue, SplatContribution};
use super::stage::{Estimator, Retiring, Stage, Vertex};
use super::{DroppedSample, RenderStats};
use crate::accel::RayKind;
use crate::camera::CameraSample;
use crate::film::{Film, PixelRect, Splat, TILE_SIZE, TileSums, lock};
use crate::geometry::{HitPacket, LANES, Ray, RayCone, SurfaceLanes};
use crate::material::TransportMode;
use crate::math::{Vec2, Vectorizer};
use crate::sampling::SampleStream;
use crate::scene::{Scene, View};
use crate::spectrum::{ColorMode, SampledSpectrum, Wavelengths};

/// Columns and rows of the block of pixels whose camera rays share a packet.
const BLOCK: [u32; 2] = [4, 2];

/// Lanes of a batch, which a wave is filled up to with several sample indices where a tile is small.
pub(super) const WAVE_LANES: u32 = TILE_SIZE * TILE_SIZE;

/// The paths that a thread is working on.
pub(super) struct Wave<'s, E: Estimator> {
    scene: &'s Scene,
    view: &'s View,
    film: &'s Film,
    estimator: &'s E,
    /// Whether whole tiles are rendered, as packets' answers depend on all their lanes.
    whole_tiles: bool,
    vectorizer: Vectorizer,
    slots: Vec<Slot>,
    memory: E::Memory<'s>,
    /// Batches to come, the next one last.
    pending: Vec<Batch<E::State>>,
    /// Batches whose memory can be used again.
    spare: Vec<Batch<E::State>>,
    hits: Vec<HitPacket>,
    surfaces: SurfaceLanes,
    shadows: ShadowQueue<Contribution>,
    splats: ShadowQueue<SplatContribution>,
    /// What light paths have brought to the film.
    landed: Vec<SplatContribution>,
    splatted: Vec<Splat>,
    stats: RenderStats,
}

impl<'s, E: Estimator> Wave<'s, E> {
    pub fn new(scene: &'s Scene, view: &'s View, film: &'s Film, estimator: &'s E) -> Self {
        let accel = scene.accel();
        let independent = |kind| accel.is_mate_independent(kind);
        Self {
            scene,
            view,
            film,
            estimator,
            whole_tiles: !(independent(RayKind::Bounce) && independent(RayKind::Shadow)),
            vectorizer: Vectorizer::default(),
            slots: Vec::new(),
            memory: estimator.memory(film),
            pending: Vec::new(),
            spare: Vec::new(),
            hits: Vec::new(),
            surfaces: SurfaceLanes::default(),
            shadows: ShadowQueue::default(),
            splats: ShadowQueue::default(),
            landed: Vec::new(),
            splatted: Vec::new(),
            stats: RenderStats::default(),
        }
    }

    /// What was done so far.
    pub fn into_stats(self) -> RenderStats {
        self.stats
    }

    /// Renders the samples `samples` of a tile.
    pub fn render(&mut self, place: TilePlace<'_>, samples: Range<u32>) {
        let pixels = Pixels {
            wanted: place.wanted,
            traced: self.traced_rect(place.wanted),
            light: if E::LIGHT_PATHS { place.whole } else { place.wanted },
        };
        let at_once = if self.whole_tiles {
            1
        } else {
            (u64::from(WAVE_LANES) / pixels.all().area()).max(1) as u32
        };
        for first in samples.clone().step_by(at_once as usize) {
            let camera_rays = self.generate(&pixels, first..(first + at_once).min(samples.end));
            if E::LIGHT_PATHS {
                self.emit();
                self.finish_pending();
            }
            self.pending.push(camera_rays);
            self.finish_pending();
            self.retire(place.tile);
        }
    }

    /// Takes all paths to their ends.
    fn finish_pending(&mut self) {
        while let Some(batch) = self.pending.pop() {
            self.trace(&batch);
            self.shade(&batch);
            self.spare.push(batch);
        }
    }

    /// The pixels whose camera rays are traced: whole blocks, or the whole tile, within the picture.
    fn traced_rect(&self, rect: PixelRect) -> PixelRect {
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
    fn generate(&mut self, pixels: &Pixels, samples: Range<u32>) -> Batch<E::State> {
        let all = pixels.all();
        self.slots.clear();
        let mut batch = self.spare.pop().unwrap_or_default();
        batch.restart(TransportMode::Radiance, 0);
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
                let of = |group: &[[f32; LANES]; 4]| group.map(|numbers| numbers[i]);
                let (mut slot, camera_ray, cone) =
                    camera_slot(self.scene, self.view, [x, y], sample, of(&film), of(&detector));
                lane.cone = cone;
                if !is_traced {
                    // A light path only.
                } else if camera_ray.is_valid() {
                    ray = camera_ray;
                    lane.state = self.estimator.camera_state(self.view, &ray);
                    self.stats.camera_rays += 1;
                } else {
                    slot.broken = true;
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

    /// Starts the light path of each slot.
    fn emit(&mut self) {
        let streams = self.slots.iter().map(|slot| {
            let [x, y] = slot.pixel.map(u32::cast_signed);
            self.view.sampler.start(x, y, slot.sample).branch(LIGHT_BRANCH)
        });
        let streams: Vec<_> = streams.collect();
        let estimator = self.estimator;
        let mut stage = self.stage(TransportMode::Importance, 0, 0);
        for (slot, stream) in streams.into_iter().enumerate() {
            estimator.emit(&mut stage, slot as u32, stream);
        }
        stage.finish_batch();
    }

    /// The stage of paths after `depth` scattering events, which collects those that will have had `next` of them.
    fn stage(&mut self, mode: TransportMode, depth: u32, next: u32) -> Stage<'_, 's, E> {
        let mut stage = Stage {
            scene: self.scene,
            view: self.view,
            mode,
            depth,
            slots: &mut self.slots,
            memory: &mut self.memory,
            shadows: &mut self.shadows,
            splats: &mut self.splats,
            landed: &mut self.landed,
            pending: &mut self.pending,
            spare: &mut self.spare,
            next: Batch::default(),
        };
        stage.start_batch(next);
        stage
    }

    /// Finds what the ray of each lane hits.
    fn trace(&mut self, batch: &Batch<E::State>) {
        let kind = if batch.depth == 0 && batch.mode == TransportMode::Radiance {
            RayKind::Camera
        } else {
            RayKind::Bounce
        };
        let rays = batch.rays.packets();
        if self.hits.len() < rays.len() {
            self.hits.resize(rays.len(), HitPacket::EMPTY);
        }
        let start = Instant::now();
        self.scene.intersect(kind, rays, &mut self.hits[..rays.len()]);
        self.stats.backend_time += start.elapsed();
        if kind == RayKind::Bounce {
            self.stats.bounce_rays += batch.lanes.len() as u64;
        }
    }

    /// Shades each lane, collects those that go on, and brings home what lights send.
    fn shade(&mut self, batch: &Batch<E::State>) {
        let (estimator, scene, vectorizer) = (self.estimator, self.scene, self.vectorizer);
        let (hits, mut stats) = (std::mem::take(&mut self.hits), std::mem::take(&mut self.stats));
        let mut surfaces = std::mem::take(&mut self.surfaces);
        let mut stage = self.stage(batch.mode, batch.depth, batch.depth + 1);
        let packets = batch.rays.packets().iter().zip(&hits);
        for ((rays, hits), mates) in packets.zip(batch.lanes.chunks(LANES)) {
            surfaces.fill(scene.world(), rays, hits);
            let streams = std::array::from_fn(|i| mates[i.min(mates.len() - 1)].stream);
            let numbers = EventLanes::draw(vectorizer, &streams, batch.depth);
            for (i, lane) in mates.iter().enumerate() {
                if lane.slot == NO_SLOT || !rays.is_active(i) {
                    continue;
                }
                let ray = &rays.get(i);
                let numbers = &numbers.get(i);
                let mut si;
                let (mut surface, mut cone) = (None, lane.cone);
                if let Some(hit) = hits.get(i) {
                    let behind = scene.interaction_behind(ray, hit, hits.t[i]);
                    si = behind.unwrap_or_else(|| surfaces.get(scene.world(), i, ray, hit));
                    cone = cone.after(si.p.distance(ray.origin));
                    si.footprint = cone.width;
                    surface = Some(&si);
                }
                let vertex = Vertex {
                    lane,
                    ray,
                    surface,
                    cone,
                    numbers,
                };
                estimator.shade(&mut stage, vertex);
            }
            stage.limit_shadows(&mut stats);
        }
        stage.finish_batch();
        stage.flush_shadows(&mut stats);
        (self.hits, self.stats, self.surfaces) = (hits, stats, surfaces);
    }

    /// Turns slots into sensor values, and what light paths brought to the film into splats.
    fn retire(&mut self, tile: Option<&Mutex<TileSums>>) {
        if !self.film.layers().is_empty() {
            let wave = Retiring {
                view: self.view,
                film: self.film,
                slots: &self.slots,
                tile,
            };
            self.estimator.retire_layers(&mut self.memory, &wave);
        }
        if let Some(tile) = tile {
            self.retire_slots(&mut lock(tile));
        }
        if E::LIGHT_PATHS {
            self.retire_splats();
        }
    }

    fn retire_splats(&mut self) {
        for splat in self.landed.drain(..) {
            let slot = &self.slots[splat.slot as usize];
            if slot.broken || !splat.value.is_finite() || splat.value.min_value() < 0.0 {
                self.stats.drop_sample(DroppedSample {
                    pixel: slot.pixel,
                    sample: slot.sample,
                });
                continue;
            }
            self.splatted.push(Splat {
                film: splat.film,
                rgb: self.view.splat_to_rgb(splat.value, &slot.lambda),
            });
        }
        self.stats.dropped_samples += self.film.splat(&self.view.filter, &mut self.splatted);
        self.film.add_light_paths(self.slots.len() as u64);
    }

    fn retire_slots(&mut self, sums: &mut TileSums) {
        let rect = sums.rect();
        for slot in &self.slots {
            let [x, y] = slot.pixel;
            if !rect.contains(x, y) {
                continue;
            }
            let rgb = slot
                .is_good()
                .then(|| self.view.sensor.to_rgb(slot.l * slot.importance, &slot.lambda));
            if !sums.add(x, y, rgb, slot.filter_weight) {
                self.stats.drop_sample(DroppedSample {
                    pixel: slot.pixel,
                    sample: slot.sample,
                });
            }
        }
    }
}

/// The pixels of a tile.
struct Pixels {
    /// That the film wants.
    wanted: PixelRect,
    /// Whose camera rays are traced.
    traced: PixelRect,
    /// That have light paths, if there are any.
    light: PixelRect,
}

impl Pixels {
    /// All of them.
    fn all(&self) -> PixelRect {
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

/// A pixel sample, its camera ray and how wide that is, from the numbers of the two groups that the camera sample uses.
#[inline]
fn camera_slot(
    scene: &Scene,
    view: &View,
    pixel: [u32; 2],
    sample: u32,
    [film_x, film_y, lens_x, lens_y]: [f32; 4],
    [u_lambda, u_time, ..]: [f32; 4],
) -> (Slot, Ray, RayCone) {
    let filter = view.filter.sample(Vec2::new(film_x, film_y));
    let center = Vec2::new(pixel[0] as f32 + 0.5, pixel[1] as f32 + 0.5);
    let camera_sample = CameraSample {
        film: center + filter.offset,
        lens: Vec2::new(lens_x, lens_y),
        time: u_time,
    };
    let ray = view.camera.sample_ray(&camera_sample);
    let cone = view.camera.ray_cone(camera_sample.film, view.detail_scale());
    let lambda = match scene.color() {
        ColorMode::Spectral => Wavelengths::sample_visible(u_lambda),
        ColorMode::Rgb => Wavelengths::rgb(),
    };
    let slot = Slot {
        pixel,
        sample,
        filter_weight: filter.weight,
        importance: view.camera.importance(&camera_sample),
        time: ray.time,
        lambda,
        l: SampledSpectrum::ZERO,
        broken: false,
    };
    (slot, ray, cone)
}
