//! When a progressive render may end before its last pass.

use std::time::{Duration, Instant};

use crate::film::Film;
use crate::integrator::schedule::Progress;

/// What ends a progressive render besides its number of passes: whichever comes first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// No pass begins after so long.
    pub time: Option<Duration>,
    /// The picture's relative error, as [`Film::noise`] expects it, is at most this.
    pub noise: Option<f64>,
}

/// Passes before the error of the picture can be told.
const PASSES_TO_TELL: u32 = 8;

impl Limits {
    /// Whether a render that began at `start` has reached one of them after `passes`.
    pub(super) fn are_reached(&self, start: Instant, film: &Film, passes: u32) -> bool {
        self.time.is_some_and(|time| start.elapsed() >= time)
            || passes >= PASSES_TO_TELL && self.noise.is_some_and(|noise| film.noise(passes) <= noise)
    }
}

/// Progress towards the end of the passes or of the time, whichever is nearer.
pub(super) struct LimitedProgress<'a> {
    pub progress: &'a dyn Progress,
    pub start: Instant,
    pub time: Option<Duration>,
}

impl Progress for LimitedProgress<'_> {
    fn advance(&self, done: u64, total: u64) {
        let of_time = self
            .time
            .map_or(0.0, |time| self.start.elapsed().as_secs_f64() / time.as_secs_f64());
        let done = done.max((of_time.min(1.0) * total as f64) as u64);
        self.progress.advance(done, total);
    }
}
