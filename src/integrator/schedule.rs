//! Which thread renders what: tiles times ranges of samples, in any order, as the sums of a film are exact.

use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

use super::RenderStats;
use super::stage::Estimator;
use super::wave::Wave;
use crate::film::{Film, PixelRect, TILE_SIZE, TileSums, lock};
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
    place: TilePlace<'a>,
    samples: Range<u32>,
}

/// Where paths of a tile start.
#[derive(Clone, Copy, Debug)]
pub(super) struct TilePlace<'a> {
    /// The sums of the pixels that the film has of it; `None` if it has none.
    pub tile: Option<&'a Mutex<TileSums>>,
    /// Those pixels; empty if there are none.
    pub wanted: PixelRect,
    /// The pixels that have light paths, or else that the film has: all of the tile that are in the picture.
    pub whole: PixelRect,
}

impl<'a> TilePlace<'a> {
    /// The tiles that the film has a part of.
    fn of_crop(film: &'a Film) -> Vec<Self> {
        let place = |tile: &'a Mutex<TileSums>| {
            let wanted = lock(tile).rect();
            Self {
                tile: Some(tile),
                wanted,
                whole: wanted,
            }
        };
        film.tiles().iter().map(place).collect()
    }

    /// All tiles of the picture: a crop shows what the light paths of the whole bring to it.
    fn all_of(film: &'a Film) -> Vec<Self> {
        let [width, height] = film.resolution();
        let corners = (0..height)
            .step_by(TILE_SIZE as usize)
            .flat_map(|y0| (0..width).step_by(TILE_SIZE as usize).map(move |x0| [x0, y0]));
        let of_crop = Self::of_crop(film);
        let place = |[x0, y0]: [u32; 2]| {
            let whole = PixelRect {
                x0,
                y0,
                x1: (x0 + TILE_SIZE).min(width),
                y1: (y0 + TILE_SIZE).min(height),
            };
            let in_crop = of_crop
                .iter()
                .find(|place| whole.contains(place.wanted.x0, place.wanted.y0));
            Self {
                tile: in_crop.and_then(|place| place.tile),
                wanted: in_crop.map_or(PixelRect { x1: x0, ..whole }, |place| place.wanted),
                whole,
            }
        };
        corners.map(place).collect()
    }
}

/// Renders the samples `samples` of each pixel, some or all of the view's, on the threads of the current rayon pool.
pub(super) fn render_tiles<E: Estimator>(
    scene: &Scene,
    view: &View,
    film: &Film,
    estimator: &E,
    samples: Range<u32>,
    progress: &dyn Progress,
) -> RenderStats {
    let Range { start, end } = samples;
    let places = if E::LIGHT_PATHS {
        TilePlace::all_of(film)
    } else {
        TilePlace::of_crop(film)
    };
    let units: Vec<Unit> = (start..end)
        .step_by(SAMPLES_PER_UNIT as usize)
        .flat_map(|first| {
            let samples = first..(first + SAMPLES_PER_UNIT).min(end);
            places.iter().map(move |&place| Unit {
                place,
                samples: samples.clone(),
            })
        })
        .collect();
    let pixels: u64 = places.iter().map(|place| place.whole.area()).sum();
    // Of all the samples that are rendered, in whatever parts.
    let total = pixels * view.samples.len() as u64;
    let before = pixels * u64::from(start - view.samples.start);
    let (next, done) = (AtomicUsize::new(0), AtomicU64::new(0));
    let per_thread = rayon::broadcast(|_| {
        let mut wave = Wave::new(scene, view, film, estimator);
        while let Some(unit) = units.get(next.fetch_add(1, Ordering::Relaxed)) {
            wave.render(unit.place, unit.samples.clone());
            let samples = unit.place.whole.area() * unit.samples.len() as u64;
            progress.advance(before + done.fetch_add(samples, Ordering::Relaxed) + samples, total);
        }
        wave.take_stats()
    });
    let mut stats = RenderStats::default();
    per_thread.into_iter().for_each(|other| stats.merge(other));
    stats
}
