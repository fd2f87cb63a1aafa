//! How fast backends answer the same rays.
//!
//! The backends take turns, a few waves each, in an order that changes from turn to turn, so that other work on the machine
//! disturbs all of them alike; a wave's time is the median of its turns, and a stream's the sum over its waves. The spread is that
//! of the quartiles, taken likewise.

use std::hint::black_box;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use super::streams::Stream;
use crate::accel::{Accel, RayKind};
use crate::geometry::{HitPacket, RayPacket};

/// Waves that a thread of a backend traces in one turn.
const TURN: usize = 16;

/// Millions of rays a second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rate {
    /// By the medians of the waves' times.
    pub median: f64,
    /// By the upper quartiles of these times.
    pub least: f64,
    /// By the lower quartiles.
    pub most: f64,
}

/// Times every backend on a stream, `turns` times each (at least once), on all threads of the rayon pool that calls. Rates of several
/// threads are those that they have together while all of them trace.
pub fn measure(backends: &[&dyn Accel], stream: &Stream, turns: usize) -> Vec<Rate> {
    let threads = rayon::current_num_threads();
    let turns = turns.max(1);
    let kind = stream.kind.ray_kind();
    // The sums over waves of the lower quartile, the median and the upper quartile of its turns.
    let mut seconds = vec![[0.0; 3]; backends.len()];
    for (place, waves) in stream.waves.chunks(TURN * threads).enumerate() {
        let mut times = vec![vec![Vec::with_capacity(turns); waves.len()]; backends.len()];
        for turn in 0..turns {
            for i in 0..backends.len() {
                let next = (i + turn + place) % backends.len();
                // Every other turn the other way round: nobody always follows the same one.
                let who = if turn % 2 == 0 { next } else { backends.len() - 1 - next };
                for (wave, time) in trace_all(backends[who], kind, waves) {
                    times[who][wave].push(time);
                }
            }
        }
        for (seconds, times) in seconds.iter_mut().zip(&mut times) {
            for times in times {
                times.sort_unstable_by(f64::total_cmp);
                for (total, share) in seconds.iter_mut().zip([0.25, 0.5, 0.75]) {
                    *total += quantile(times, share);
                }
            }
        }
    }
    let work = stream.rays() as f64 * threads as f64 * 1e-6;
    let rate = |[low, middle, high]: [f64; 3]| Rate {
        median: work / middle,
        least: work / high,
        most: work / low,
    };
    seconds.into_iter().map(rate).collect()
}

/// Of numbers in order, the one that a share of them is below, linear between two.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = share * (sorted.len() - 1) as f64;
    let (low, high) = (sorted[place.floor() as usize], sorted[place.ceil() as usize]);
    low + place.fract() * (high - low)
}

/// Traces waves on all threads; by wave, the seconds that each took.
///
/// They are traced once before that: else whoever comes after another way through the same tree would find it in the cache.
fn trace_all(accel: &dyn Accel, kind: RayKind, waves: &[Vec<RayPacket>]) -> Vec<(usize, f64)> {
    let next = AtomicUsize::new(0);
    let of_thread = |_: rayon::BroadcastContext<'_>| {
        let mut room = Room::default();
        let mut times = Vec::new();
        for wave in waves {
            room.trace(accel, kind, wave);
        }
        loop {
            let place = next.fetch_add(1, Ordering::Relaxed);
            let Some(wave) = waves.get(place) else { return times };
            times.push((place, room.trace(accel, kind, wave).as_secs_f64()));
        }
    };
    rayon::broadcast(of_thread).into_iter().flatten().collect()
}

/// Room for a wave: it is copied into place outside the measured time, as in a render it is in the cache.
#[derive(Default)]
struct Room {
    rays: Vec<RayPacket>,
    hits: Vec<HitPacket>,
}

impl Room {
    fn trace(&mut self, accel: &dyn Accel, kind: RayKind, wave: &[RayPacket]) -> Duration {
        self.rays.clear();
        self.rays.extend_from_slice(wave);
        self.hits.resize(wave.len(), HitPacket::EMPTY);
        let start = Instant::now();
        match kind {
            RayKind::Shadow => accel.occluded(kind, &mut self.rays, None),
            RayKind::Camera | RayKind::Bounce => accel.intersect(kind, &self.rays, &mut self.hits, None),
        }
        let time = start.elapsed();
        black_box((&self.rays, &self.hits));
        time
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_linear_between_numbers() {
        let numbers = [1.0, 2.0, 4.0];
        assert_eq!(
            [0.0, 0.25, 0.5, 0.75, 1.0].map(|share| quantile(&numbers, share)),
            [1.0, 1.5, 2.0, 3.0, 4.0]
        );
        assert_eq!(quantile(&[7.0], 0.75), 7.0);
    }
}
