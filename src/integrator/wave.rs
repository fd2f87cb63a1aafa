//! A wave: the paths of one tile, at one sample index or several, that go through each stage together.
//!
//! A *slot* is a pixel sample; it stays until its last shadow ray is back, then is turned into sensor values and retires. A *lane*
//! is a live path, and names its slot; lane i is ray i % 8 of packet i / 8. Lanes are compacted as paths end.
//!
//! Camera rays are packed by blocks of 4 x 2 pixels at absolute coordinates: what a packet is made of does not depend on the crop.
//! A block that the crop touches is traced whole, as a backend's answer to coherent rays may depend on their mates. Where it does
//! so for other kinds of rays too, whole tiles are rendered and the rest is discarded.

use std::ops::Range;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use super::path::PathIntegrator;
use super::shadow::ShadowQueue;
use super::{DroppedSample, RenderStats};
use crate::accel::RayKind;
use crate::camera::CameraSample;
use crate::film::{PixelRect, TILE_SIZE, TileSums, lock};
use crate::geometry::{HitPacket, LANES, Ray, RayCone, RayPacket};
use crate::math::{Vec2, Vec3, Vectorizer};
use crate::sampling::{SampleStream, SolidAnglePdf};
use crate::scene::{Scene, View};
use crate::spectrum::{ColorMode, SampledSpectrum, Wavelengths};

/// Columns and rows of the block of pixels whose camera rays share a packet.
const BLOCK: [u32; 2] = [4, 2];

/// Groups of random numbers that the camera sample uses.
const FILM_GROUP: u32 = 0;
const DETECTOR_GROUP: u32 = 1;
/// The first group of the scattering events.
const FIRST_PATH_GROUP: u32 = 2;

/// Lanes that a wave is filled up to with several sample indices, where a tile is small.
const WAVE_LANES: u32 = TILE_SIZE * TILE_SIZE;

/// A pixel sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slot {
    pixel: [u32; 2],
    sample: u32,
    filter_weight: f32,
    /// Its random numbers.
    pub stream: SampleStream,
    /// Its wavelengths.
    pub lambda: Wavelengths,
    /// Radiance gathered so far, not divided by the density of the wavelengths.
    pub l: SampledSpectrum,
    /// Set if a ray of it could not be traced.
    pub broken: bool,
}

/// Where a lane's ray came from, which says how else the light that it meets could have been found.
#[derive(Clone, Copy, Debug)]
pub(super) enum Origin {
    /// The camera or a delta lobe: in no other way.
    Delta,
    /// A BSDF sample at a point with a normal, with this density: by light sampling too.
    Sampled { p: Vec3, n: Vec3, pdf: SolidAnglePdf },
}

/// A live path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lane {
    /// Its slot; [`Lane::NO_SLOT`] for a camera ray that is traced for the sake of its packet only.
    pub slot: u32,
    /// Throughput.
    pub beta: SampledSpectrum,
    /// Product of the squared relative indices of the refractions so far: without it Russian roulette would see the squeezing
    /// of radiance inside glass as absorption.
    pub eta_scale: f32,
    /// Where the ray came from.
    pub origin: Origin,
    /// How wide the ray is.
    pub cone: RayCone,
}

impl Lane {
    /// No slot: nothing is wanted of this ray.
    pub const NO_SLOT: u32 = u32::MAX;
}

/// The paths that a thread is working on.
pub(super) struct Wave<'a> {
    scene: &'a Scene,
    view: &'a View,
    /// Whether whole tiles are rendered, as packets' answers depend on all their lanes.
    whole_tiles: bool,
    vectorizer: Vectorizer,
    /// Stands in for the stream of a lane that is not there.
    idle_stream: SampleStream,
    slots: Vec<Slot>,
    lanes: Vec<Lane>,
    rays: Vec<RayPacket>,
    hits: Vec<HitPacket>,
    shadows: ShadowQueue,
    stats: RenderStats,
}

/// What an integrator's shading stage works on: one lane after the other, in order.
pub(super) struct Stage<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Scattering events before this stage.
    pub depth: u32,
    /// All slots.
    pub slots: &'a mut [Slot],
    /// The queue for shadow rays.
    pub shadows: &'a mut ShadowQueue,
}

impl<'a> Wave<'a> {
    pub fn new(scene: &'a Scene, view: &'a View) -> Self {
        let accel = scene.accel();
        let independent = |kind| accel.is_mate_independent(kind);
        Self {
            scene,
            view,
            whole_tiles: !(independent(RayKind::Bounce) && independent(RayKind::Shadow)),
            vectorizer: Vectorizer::default(),
            idle_stream: view.sampler.start(0, 0, 0),
            slots: Vec::new(),
            lanes: Vec::new(),
            rays: Vec::new(),
            hits: Vec::new(),
            shadows: ShadowQueue::default(),
            stats: RenderStats::default(),
        }
    }

    /// What was done so far.
    pub fn into_stats(self) -> RenderStats {
        self.stats
    }

    /// Renders the samples `samples` of the pixels `rect` of a tile.
    pub fn render(&mut self, path: &PathIntegrator, tile: &Mutex<TileSums>, rect: PixelRect, samples: Range<u32>) {
        let traced = self.traced_rect(rect);
        let at_once = if self.whole_tiles {
            1
        } else {
            (u64::from(WAVE_LANES) / traced.area()).max(1) as u32
        };
        for first in samples.clone().step_by(at_once as usize) {
            self.generate(rect, traced, first..(first + at_once).min(samples.end));
            let mut depth = 0;
            while !self.lanes.is_empty() {
                self.trace(if depth == 0 { RayKind::Camera } else { RayKind::Bounce });
                self.shade(path, depth);
                depth += 1;
            }
            self.retire(tile);
        }
    }

    /// The pixels whose camera rays are traced: whole blocks, or the whole tile, within the picture.
    fn traced_rect(&self, rect: PixelRect) -> PixelRect {
        let [step_x, step_y] = if self.whole_tiles { [TILE_SIZE; 2] } else { BLOCK };
        let [width, height] = self.view.resolution;
        PixelRect {
            x0: rect.x0 / step_x * step_x,
            y0: rect.y0 / step_y * step_y,
            x1: (rect.x1.div_ceil(step_x) * step_x).min(width),
            y1: (rect.y1.div_ceil(step_y) * step_y).min(height),
        }
    }

    /// Makes slots, lanes and camera rays.
    fn generate(&mut self, rect: PixelRect, traced: PixelRect, samples: Range<u32>) {
        self.slots.clear();
        self.lanes.clear();
        self.rays.clear();
        for sample in samples {
            for y in (traced.y0..traced.y1).step_by(BLOCK[1] as usize) {
                for x in (traced.x0..traced.x1).step_by(BLOCK[0] as usize) {
                    self.generate_block(rect, traced, [x, y], sample);
                }
            }
        }
    }

    fn generate_block(&mut self, rect: PixelRect, traced: PixelRect, corner: [u32; 2], sample: u32) {
        let pixels: [[u32; 2]; LANES] =
            std::array::from_fn(|i| [corner[0] + i as u32 % BLOCK[0], corner[1] + i as u32 / BLOCK[0]]);
        let streams = pixels.map(|[x, y]| self.view.sampler.start(x.cast_signed(), y.cast_signed(), sample));
        let film = SampleStream::draw4_lanes(self.vectorizer, &streams, FILM_GROUP);
        let detector = SampleStream::draw4_lanes(self.vectorizer, &streams, DETECTOR_GROUP);
        let mut packet = RayPacket::EMPTY;
        for (i, &[x, y]) in pixels.iter().enumerate() {
            let mut lane = Lane {
                slot: Lane::NO_SLOT,
                beta: SampledSpectrum::ONE,
                eta_scale: 1.0,
                origin: Origin::Delta,
                cone: RayCone::default(),
            };
            if traced.contains(x, y) {
                let of = |group: &[[f32; LANES]; 4]| group.map(|numbers| numbers[i]);
                let (mut slot, ray, cone) = camera_slot(
                    self.scene,
                    self.view,
                    [x, y],
                    (sample, streams[i]),
                    of(&film),
                    of(&detector),
                );
                lane.cone = cone;
                if ray.is_valid() {
                    packet.set(i, &ray);
                    self.stats.camera_rays += 1;
                } else {
                    slot.broken = true;
                }
                if self.whole_tiles || rect.contains(x, y) {
                    lane.slot = self.slots.len() as u32;
                    self.slots.push(slot);
                }
            }
            self.lanes.push(lane);
        }
        self.rays.push(packet);
    }

    /// Finds what the ray of each lane hits.
    fn trace(&mut self, kind: RayKind) {
        self.hits.resize(self.rays.len(), HitPacket::EMPTY);
        let start = Instant::now();
        self.scene.accel().intersect(kind, &self.rays, &mut self.hits, None);
        self.stats.backend_time += start.elapsed();
        if kind == RayKind::Bounce {
            self.stats.bounce_rays += self.lanes.len() as u64;
        }
    }

    /// Shades each lane, compacts those that go on, and brings home what lights send.
    fn shade(&mut self, path: &PathIntegrator, depth: u32) {
        let mut stage = Stage {
            scene: self.scene,
            depth,
            slots: &mut self.slots,
            shadows: &mut self.shadows,
        };
        let mut alive = 0;
        for first in (0..self.lanes.len()).step_by(LANES) {
            let mates = first..(first + LANES).min(self.lanes.len());
            let hits = &self.hits[first / LANES];
            let surfaces = self
                .scene
                .world()
                .surfaces(self.vectorizer, &self.rays[first / LANES], hits);
            let streams = std::array::from_fn(|i| match self.lanes.get(first + i) {
                Some(lane) if lane.slot != Lane::NO_SLOT => stage.slots[lane.slot as usize].stream,
                _ => self.idle_stream,
            });
            let numbers = StageNumbers::draw(self.vectorizer, &streams, depth);
            for i in mates {
                let (packet, lane) = (&self.rays[i / LANES], self.lanes[i]);
                if lane.slot == Lane::NO_SLOT || !packet.is_active(i % LANES) {
                    continue;
                }
                let ray = packet.get(i % LANES);
                let surface = hits.get(i % LANES).map(|hit| surfaces.get(i % LANES, &ray, hit));
                let numbers = numbers.lane(i % LANES);
                let Some((next, ray)) = path.shade(&mut stage, &lane, &ray, surface, &numbers) else {
                    continue;
                };
                if !ray.is_valid() {
                    stage.slots[next.slot as usize].broken = true;
                    continue;
                }
                // Lane `alive` was read at or before this one.
                self.rays[alive / LANES].set(alive % LANES, &ray);
                self.lanes[alive] = next;
                alive += 1;
            }
        }
        self.lanes.truncate(alive);
        self.rays.truncate(alive.div_ceil(LANES));
        if let Some(last) = self.rays.last_mut() {
            for lane in (alive - 1) % LANES + 1..LANES {
                last.tfar[lane] = f32::NEG_INFINITY;
            }
        }
        self.stats.shadow_rays += self.shadows.len() as u64;
        let elapsed = self.flush_shadows();
        self.stats.backend_time += elapsed;
    }

    fn flush_shadows(&mut self) -> Duration {
        let slots = &mut self.slots;
        self.shadows
            .flush(self.scene.accel(), |slot, value| slots[slot as usize].l += value)
    }

    /// Turns slots into sensor values.
    fn retire(&mut self, tile: &Mutex<TileSums>) {
        let mut sums = lock(tile);
        let rect = sums.rect();
        for slot in &self.slots {
            let [x, y] = slot.pixel;
            if !rect.contains(x, y) {
                continue;
            }
            let good = !slot.broken && slot.l.is_finite() && slot.l.min_value() >= 0.0;
            let rgb = good.then(|| self.view.sensor.to_rgb(slot.l, &slot.lambda));
            if !sums.add(x, y, rgb, slot.filter_weight) {
                self.stats.drop_sample(DroppedSample {
                    pixel: slot.pixel,
                    sample: slot.sample,
                });
            }
        }
    }
}

/// A pixel sample, its camera ray and how wide that is, from the numbers of the two groups that the camera sample uses.
#[inline]
fn camera_slot(
    scene: &Scene,
    view: &View,
    pixel: [u32; 2],
    (sample, stream): (u32, SampleStream),
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
        stream,
        lambda,
        l: SampledSpectrum::ZERO,
        broken: false,
    };
    (slot, ray, cone)
}

/// The random numbers of a scattering event of eight paths: see the table in [`integrator`](super).
pub(super) struct StageNumbers {
    light: [[f32; LANES]; 4],
    bsdf: [[f32; LANES]; 4],
}

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
}

impl StageNumbers {
    fn draw(vectorizer: Vectorizer, streams: &[SampleStream; LANES], depth: u32) -> Self {
        let group = FIRST_PATH_GROUP + 2 * depth;
        Self {
            light: SampleStream::draw4_lanes(vectorizer, streams, group),
            bsdf: SampleStream::draw4_lanes(vectorizer, streams, group + 1),
        }
    }

    #[inline]
    fn lane(&self, i: usize) -> EventNumbers {
        let ([x, y, which_light, roulette], [bsdf_x, bsdf_y, lobe, _]) = (
            self.light.map(|numbers| numbers[i]),
            self.bsdf.map(|numbers| numbers[i]),
        );
        EventNumbers {
            light: Vec2::new(x, y),
            which_light,
            roulette,
            bsdf: Vec2::new(bsdf_x, bsdf_y),
            lobe,
        }
    }
}
