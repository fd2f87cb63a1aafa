//! Which thread renders what: tiles times ranges of samples, in any order, as the sums of a film are exact.

use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

use super::RenderStats;
use super::stage::Estimator;
use super::wave::Wave;
use crate::film::{Film, TileSums, lock};
use crate::scene::{Scene, View};

/// Hears how far a render is.
pub trait Progress: Sync {
    /// `done` of `total` camera samples are in the film. Called from any thread, a few times a second at most.
    fn advance(&self, done: u64, total: u64);
}

/// Hears nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {
    fn advance(&self, _done: u64, _total: u64) {}
}

/// Samples of a tile that one thread takes at a time: few enough that the threads end together.
const SAMPLES_PER_UNIT: u32 = 16;

/// One tile and a range of samples.
struct Unit<'a> {
    tile: &'a Mutex<TileSums>,
    samples: Range<u32>,
}

/// Renders all samples of all tiles on the threads of the current rayon pool.
pub(super) fn render_tiles<E: Estimator>(
    scene: &Scene,
    view: &View,
    film: &Film,
    estimator: &E,
    progress: &dyn Progress,
) -> RenderStats {
    let Range { start, end } = view.samples;
    let units: Vec<Unit> = (start..end)
        .step_by(SAMPLES_PER_UNIT as usize)
        .flat_map(|first| {
            let samples = first..(first + SAMPLES_PER_UNIT).min(end);
            film.tiles().iter().map(move |tile| Unit {
                tile,
                samples: samples.clone(),
            })
        })
        .collect();
    let total = film.crop().area() * u64::from(end - start);
    let (next, done) = (AtomicUsize::new(0), AtomicU64::new(0));
    let per_thread = rayon::broadcast(|_| {
        let mut wave = Wave::new(scene, view, estimator);
        while let Some(unit) = units.get(next.fetch_add(1, Ordering::Relaxed)) {
            let rect = lock(unit.tile).rect();
            wave.render(unit.tile, rect, unit.samples.clone());
            let samples = rect.area() * unit.samples.len() as u64;
            progress.advance(done.fetch_add(samples, Ordering::Relaxed) + samples, total);
        }
        wave.into_stats()
    });
    let mut stats = RenderStats::default();
    per_thread.into_iter().for_each(|other| stats.merge(other));
    stats
}
