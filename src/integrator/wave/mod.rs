//! A wave: the paths of one tile, at one sample index or several, that go through each stage together.
//!
//! A *slot* is a pixel sample; it stays until its last shadow ray is back, then is turned into sensor values and retires. A *lane*
//! is a live path, and names its slot. Lanes lie in packets of eight, each beside the packet of their rays, and a stage goes from packet to packet.
//! The lanes that go on after it are packed anew and make up the next *batch*. Where paths branch batches are
//! several; the last one goes first, so that their number stays in proportion to the depth of paths. If the estimator has light
//! paths, one for each slot, all of a wave go before its camera paths.
//!
//! Waves begin in `camera.rs` and `light.rs`, and end in `retire.rs`.

mod camera;
mod first_hit;
mod light;
mod retire;

use std::ops::Range;
use std::time::Instant;

use self::camera::Pixels;
use self::first_hit::{FirstHits, surface_sample};
use super::RenderStats;
use super::lane::{Batch, NO_SLOT, Slot};
use super::numbers::EventLanes;
use super::queue::Packet;
use super::schedule::TilePlace;
use super::shadow::{ContributionLanes, ShadowQueue, SplatContribution, SplatLanes};
use super::stage::{Estimator, PacketVertices, Stage, Vertex};
use super::times::lap;
use crate::accel::{RayKind, RayOrigin};
use crate::film::{Film, Splat, TILE_SIZE};
use crate::geometry::{HitPacket, LANES, RayPacket, SurfaceLanes};
use crate::material::TransportMode;
use crate::math::{LaneSet, Vectorizer};
use crate::scene::{Scene, View};

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
    surfaces: [SurfaceLanes<'s>; 2],
    first_hits: FirstHits,
    shadows: ShadowQueue<ContributionLanes>,
    splats: ShadowQueue<SplatLanes>,
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
            surfaces: SurfaceLanes::two(scene.world()),
            first_hits: FirstHits::default(),
            shadows: ShadowQueue::default(),
            splats: ShadowQueue::default(),
            landed: Vec::new(),
            splatted: Vec::new(),
            stats: RenderStats::default(),
        }
    }

    /// What was done since the last time.
    pub fn take_stats(&mut self) -> RenderStats {
        std::mem::take(&mut self.stats)
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
            let mut start = Instant::now();
            let camera_rays = self.generate(&pixels, first..(first + at_once).min(samples.end));
            self.first_hits.restart(self.slots.len(), self.film.kind());
            if E::LIGHT_PATHS {
                self.emit();
            }
            lap(&mut start, &mut self.stats.times.sample);
            // Light paths, if there are any, go before.
            self.finish_pending();
            self.pending.push(camera_rays);
            self.finish_pending();
            start = Instant::now();
            self.retire(place.tile);
            lap(&mut start, &mut self.stats.times.film);
        }
    }

    /// Takes all paths to their ends.
    fn finish_pending(&mut self) {
        let mut surfaces = std::mem::take(&mut self.surfaces);
        while let Some(batch) = self.pending.pop() {
            self.trace(&batch);
            self.shade(&batch, &mut surfaces);
            self.spare.push(batch);
        }
        self.surfaces = surfaces;
    }

    /// The stage of paths after `depth` scattering events, which collects those that will have had `next` of them.
    fn stage(&mut self, mode: TransportMode, depth: u32, next: u32) -> Stage<'_, 's, E> {
        let mut stage = Stage {
            scene: self.scene,
            view: self.view,
            estimator: self.estimator,
            vectorizer: self.vectorizer,
            mode,
            depth,
            slots: &mut self.slots,
            memory: &mut self.memory,
            shadows: &mut self.shadows,
            splats: &mut self.splats,
            landed: &mut self.landed,
            pending: &mut self.pending,
            spare: &mut self.spare,
            passed: Batch::default(),
            next: Batch::default(),
        };
        stage.start_batch(next);
        stage
    }

    /// Finds what the ray of each lane hits.
    fn trace(&mut self, batch: &Batch<E::State>) {
        let kind = batch.kind;
        let rays = batch.paths.rays();
        if self.hits.len() < rays.len() {
            self.hits.resize(rays.len(), HitPacket::EMPTY);
        }
        self.scene.accel().announce(RayOrigin {
            from_light: batch.mode == TransportMode::Importance,
            depth: batch.depth,
        });
        let mut start = Instant::now();
        self.scene.intersect(kind, rays, &mut self.hits[..rays.len()]);
        let (stats, count) = (&mut self.stats, batch.paths.len() as u64);
        let time = match (kind, batch.mode) {
            (RayKind::Bounce, TransportMode::Importance) => {
                stats.photon_rays += count;
                &mut stats.times.photon
            }
            (RayKind::Bounce, TransportMode::Radiance) => {
                stats.bounce_rays += count;
                &mut stats.times.bounce
            }
            // Camera rays were counted where they were made: some are traced for the sake of their packets.
            (RayKind::Camera | RayKind::Shadow, _) => &mut stats.times.camera,
        };
        lap(&mut start, time);
    }

    /// Shades each lane, collects those that go on, and brings home what lights send.
    fn shade(&mut self, batch: &Batch<E::State>, surfaces: &mut [SurfaceLanes<'s>; 2]) {
        let (estimator, scene, vectorizer) = (self.estimator, self.scene, self.vectorizer);
        let (all_hits, mut stats) = (std::mem::take(&mut self.hits), std::mem::take(&mut self.stats));
        let (mut start, shadows_before) = (Instant::now(), stats.times.shadow);
        let mut first_hits = std::mem::take(&mut self.first_hits);
        let (view, space) = (self.view, self.gbuffer_space());
        let is_first = first_hits.are_wanted() && batch.depth == 0 && batch.mode == TransportMode::Radiance;
        let mut stage = self.stage(batch.mode, batch.depth, batch.depth + 1);
        for (index, ((rays, lanes), hits)) in batch.paths.packets().zip(&all_hits).enumerate() {
            if index % 2 == 0 {
                // Two at a time: what is gathered lane by lane is in its place when it is read.
                let both = batch.paths.rays()[index..].iter().zip(&all_hits[index..]);
                scene.interactions(surfaces, both);
            }
            let surfaces = &surfaces[index % 2];
            let numbers = EventLanes::new(vectorizer, &lanes.streams, batch.depth);
            let mut rest = active_lanes(rays, &lanes.slot);
            if !is_first {
                let packet = PacketVertices {
                    active: rest,
                    lanes,
                    rays,
                    hits,
                    surfaces,
                    numbers: &numbers,
                };
                let together = estimator.shade_together(&mut stage, &packet);
                stats.events_together += u64::from(together.and(hits.hit_lanes()).len());
                rest = rest.without(together);
            }
            for i in rest.lanes() {
                let lane = &lanes.get(i);
                let ray = &rays.get(i);
                let mut si;
                let (mut surface, mut cone) = (None, lane.cone);
                if let Some(hit) = hits.get(i) {
                    si = surfaces.get(i, hit, rays, hits);
                    cone = cone.after(si.p.distance(ray.origin));
                    si.footprint = cone.width;
                    surface = Some(&si);
                    if is_first && !scene.is_interface(si.hit.geometry) {
                        let slot = &stage.slots[lane.slot as usize];
                        first_hits.set(lane.slot, surface_sample((scene, view), space, slot, &lane.stream, &si));
                    }
                }
                let vertex = Vertex {
                    lane,
                    ray,
                    surface,
                    cone,
                    index: i,
                    events: &numbers,
                };
                estimator.shade(&mut stage, vertex);
            }
            stage.limit_shadows(&mut stats);
        }
        stage.finish();
        stage.flush_shadows(&mut stats);
        lap(&mut start, &mut stats.times.shade);
        stats.times.shade -= stats.times.shadow - shadows_before;
        (self.hits, self.stats, self.first_hits) = (all_hits, stats, first_hits);
    }
}

/// The lanes that are paths with rays that were traced.
#[inline]
fn active_lanes(rays: &RayPacket, slots: &[u32; LANES]) -> LaneSet {
    std::array::from_fn(|i| (rays.tnear[i] <= rays.tfar[i]) & (slots[i] != NO_SLOT)).into()
}
