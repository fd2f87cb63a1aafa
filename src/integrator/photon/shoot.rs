//! A pass's photons, from all lights.

use rayon::prelude::*;

use super::guide::{EmissionGuide, Pilot};
use super::stored::Photon;
use super::tracer::{Keep, Landed, PhotonTracer};
use crate::film::Film;
use crate::integrator::RenderStats;
use crate::integrator::lane::Slot;
use crate::integrator::numbers::EmissionNumbers;
use crate::integrator::stage::Moment;
use crate::integrator::wave::Wave;
use crate::sampling::{SampleStream, Sampler, SamplerKind};
use crate::scene::{Scene, View};
use crate::spectrum::SampledSpectrum;

/// Where photons are shot from and seen.
#[derive(Clone, Copy)]
pub(in crate::integrator) struct Stand<'a> {
    pub scene: &'a Scene,
    pub view: &'a View,
    pub film: &'a Film,
}

/// Photons in the order of their paths.
#[derive(Debug, Default)]
pub(super) struct Shot {
    pub photons: Vec<Photon>,
    /// Paths that were started, whether or not they left a photon.
    pub emitted: u64,
}

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub(super) enum Until {
    /// So many photons are stored: not more, and emission ends at 100 times as many.
    Stored(u32),
    /// So many are emitted.
    Emitted(u32),
}

/// Random numbers of a kind of photons: independent of those of the others and of pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct PhotonNumbers {
    sampler: Sampler,
    /// Which photons.
    kind: i32,
    /// Of which pass.
    pass: i32,
}

/// What sets photons' numbers apart from those of pixels.
const PHOTON_SEED: u64 = 0x7068_6f74_6f6e_0001;
const PASS_KIND: i32 = -1;
const PILOT_KIND: i32 = -2;

impl PhotonNumbers {
    pub fn new(seed: u64, keep: Keep, pass: u32) -> Self {
        let kind = match keep {
            Keep::Caustic => 0,
            Keep::All => 1,
            Keep::Indirect => 2,
        };
        Self::of_kind(seed, kind, pass)
    }

    fn of_kind(seed: u64, kind: i32, pass: u32) -> Self {
        Self {
            sampler: Sampler::new(SamplerKind::Sobol, seed ^ PHOTON_SEED, u32::MAX),
            kind,
            pass: pass.cast_signed(),
        }
    }

    /// Those of one photon.
    fn stream(&self, photon: u32) -> SampleStream {
        self.sampler.start(self.kind, self.pass, photon)
    }
}

/// The wavelengths and the time of a pass: over any number of passes from the first on they are evenly spread, each and together.
pub(super) fn moment_of(seed: u64, pass: u32) -> Moment {
    let numbers = PhotonNumbers::of_kind(seed, PASS_KIND, 0);
    let [wavelength, time] = numbers.stream(pass).draw2(0);
    Moment { wavelength, time }
}

/// Photon paths of a wave.
const CHUNK: u32 = 1 << 12;
/// Paths between two looks at how many photons there are, at least and at most.
const LEAST_ROUND: u32 = 1 << 8;
const MOST_ROUND: u32 = CHUNK * 16;
/// How many more paths than are probably needed: another round costs more than a few of them.
const ROUND_MARGIN: f64 = 1.02;
/// Photons emitted for each that is wanted, at most.
const MOST_PER_STORED: u64 = 100;

/// Shoots photons until there are enough.
pub(super) fn shoot(
    stand: Stand<'_>,
    tracer: &PhotonTracer<'_>,
    numbers: PhotonNumbers,
    moment: Moment,
    until: Until,
    stats: &mut RenderStats,
) -> Shot {
    let (stored, emitted) = match until {
        Until::Stored(count) => (count as usize, MOST_PER_STORED * u64::from(count)),
        Until::Emitted(count) => (usize::MAX, u64::from(count)),
    };
    let emitted = emitted.min(u64::from(u32::MAX)) as u32;
    let mut shot = Shot::default();
    let mut first = 0;
    while first < emitted {
        let paths = match until {
            Until::Stored(_) => paths_until(&shot, stored),
            Until::Emitted(_) => MOST_ROUND,
        };
        let end = emitted.min(first.saturating_add(paths));
        for chunk in follow(stand, tracer, numbers, |_| moment, first..end) {
            stats.merge(chunk.stats);
            if !take(&mut shot, &chunk.landed, chunk.paths, stored) {
                return shot;
            }
        }
        first = end;
    }
    shot
}

/// The paths that it probably takes until `wanted` photons are stored, as far as the photons so far tell, or some of them.
fn paths_until(shot: &Shot, wanted: usize) -> u32 {
    let (missing, stored) = ((wanted - shot.photons.len()) as f64, shot.photons.len().max(1) as f64);
    let paths = ROUND_MARGIN * missing * shot.emitted as f64 / stored;
    // Conversion saturates.
    (paths as u32).clamp(LEAST_ROUND, MOST_ROUND)
}

/// Adds the photons of a chunk, path after path, as long as there is room; whether there was for all.
///
/// The path that would be too much does not count among those emitted: the others are then as many as were needed for what is stored,
/// and the estimate has no bias to speak of (none at all if each path leaves one photon).
fn take(shot: &mut Shot, landed: &[Landed], paths: u32, most: usize) -> bool {
    if shot.photons.len() + landed.len() <= most {
        shot.photons.extend(landed.iter().map(|landed| landed.photon));
        shot.emitted += u64::from(paths);
        return true;
    }
    for of_path in landed.chunk_by(|a, b| a.path == b.path) {
        if shot.photons.len() + of_path.len() > most {
            shot.emitted += u64::from(of_path[0].path);
            break;
        }
        shot.photons.extend(of_path.iter().map(|landed| landed.photon));
    }
    false
}

/// What the photon paths of a wave left.
struct Chunk {
    /// Ordered by path, which is counted from the chunk's first.
    landed: Vec<Landed>,
    paths: u32,
    stats: RenderStats,
}

/// Follows the photons of `range`, at the moment that `moment_of` gives each.
fn follow(
    stand: Stand<'_>,
    tracer: &PhotonTracer<'_>,
    numbers: PhotonNumbers,
    moment_of: impl Fn(u32) -> Moment + Sync,
    range: std::ops::Range<u32>,
) -> Vec<Chunk> {
    let Stand { scene, view, film } = stand;
    let starts: Vec<u32> = range.clone().step_by(CHUNK as usize).collect();
    let new_wave = || Wave::new(scene, view, film, tracer);
    let follow_chunk = |wave: &mut Wave<'_, PhotonTracer<'_>>, first: u32| {
        let end = range.end.min(first.saturating_add(CHUNK));
        let paths = (first..end).map(|photon| {
            let moment = moment_of(photon);
            let slot = Slot {
                pixel: [0, 0],
                sample: photon,
                filter_weight: 0.0,
                importance: 0.0,
                time: view.camera.scene_time(moment.time),
                lambda: moment.wavelengths(scene.color()),
                l: SampledSpectrum::ZERO,
                broken: false,
            };
            (slot, numbers.stream(photon))
        });
        let (slots, memory) = wave.follow_light_paths(paths);
        let mut landed = std::mem::take(memory);
        landed.retain(|landed| !slots[landed.path as usize].broken);
        // Those of a path are found one after the other, with those of others between.
        landed.sort_by_key(|landed| landed.path);
        let broken = slots.iter().filter(|slot| slot.broken).count();
        let mut stats = wave.take_stats();
        stats.dropped_samples += broken as u64;
        Chunk {
            landed,
            paths: end - first,
            stats,
        }
    };
    starts.into_par_iter().map_init(new_wave, follow_chunk).collect()
}

/// Pilots that teach where caustics come from: of the first round, unaimed, up to [`MOST_PILOTS`] if those find nothing.
const FIRST_PILOTS: u32 = 1 << 14;
/// Of later rounds together, aimed by what is known from those before.
const LEAST_LATER_PILOTS: u32 = 1 << 15;
const MOST_PILOTS: u32 = 1 << 20;
/// A pilot teaches for so many photons: what no pilot found is found by a photon that is much brighter than the others, and the more
/// photons there are the more of these there would be.
const PHOTONS_PER_PILOT: u64 = 16;

/// Learns where to aim the photons of all passes, `photons` of them, that end in the caustic map. `None` if no pilot did: the scene has
/// no caustics to speak of.
pub(super) fn learn_caustics(
    stand: Stand<'_>,
    max_depth: Option<u32>,
    photons: u64,
    stats: &mut RenderStats,
) -> Option<EmissionGuide> {
    let numbers = PhotonNumbers::of_kind(stand.view.sampler.seed(), PILOT_KIND, 0);
    let mut pilots = Vec::new();
    let mut send = |range: std::ops::Range<u32>, guide: Option<&EmissionGuide>, pilots: &mut Vec<Pilot>| {
        let tracer = PhotonTracer {
            keep: Keep::Caustic,
            max_depth,
            guide,
        };
        // Of all wavelengths and times.
        let moment = |pilot| moment_of(!stand.view.sampler.seed(), pilot);
        let mut path = range.start;
        for chunk in follow(stand, &tracer, numbers, moment, range) {
            stats.merge(chunk.stats);
            let mut powers = vec![0.0_f32; chunk.paths as usize];
            for landed in &chunk.landed {
                powers[landed.path as usize] += landed.photon.power().max_value();
            }
            for power in powers {
                let drawn = EmissionNumbers::draw(&numbers.stream(path));
                pilots.push(Pilot::new(tracer.aim(drawn), power));
                path += 1;
            }
        }
    };
    let mut sent = 0;
    while sent < MOST_PILOTS && !pilots.iter().any(Pilot::is_useful) {
        send(sent..sent + FIRST_PILOTS, None, &mut pilots);
        sent += FIRST_PILOTS;
    }
    let mut guide = EmissionGuide::new(&mut pilots)?;
    let wanted = (photons / PHOTONS_PER_PILOT).clamp(u64::from(LEAST_LATER_PILOTS), u64::from(MOST_PILOTS)) as u32;
    let end = sent + wanted;
    while sent < end {
        // As many as before, so that all are sorted a few times only.
        let round = sent..end.min(2 * sent);
        sent = round.end;
        send(round, Some(&guide), &mut pilots);
        guide = EmissionGuide::new(&mut pilots)?;
    }
    Some(guide)
}
