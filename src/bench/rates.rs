//! How fast backends answer the same rays.
//!
//! The backends take turns, a few waves each, in an order that changes from turn to turn, so that other work on the machine
//! disturbs all of them alike; a wave's time is the median of its turns, and a stream's the sum over its waves.

use std::hint::black_box;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use super::streams::Stream;
use crate::accel::{Accel, RayKind};
use crate::geometry::{HitPacket, RayPacket};

/// Waves that a thread of a backend traces in one turn: its tree is in the cache after the first.
const TURN: usize = 16;

/// Millions of rays a second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rate {
    /// By the medians of the waves' times.
    pub median: f64,
    /// Of the slowest turn of all waves.
    pub least: f64,
    /// Of the fastest.
    pub most: f64,
}

/// Times every backend on a stream, `turns` times each (at least once), on all threads of the rayon pool that calls. Rates of several
/// threads are those that they have together while all of them trace.
pub fn measure(backends: &[&dyn Accel], stream: &Stream, turns: usize) -> Vec<Rate> {
    let threads = rayon::current_num_threads();
    let turns = turns.max(1);
    let kind = stream.kind.ray_kind();
    let mut medians = vec![0.0; backends.len()];
    let mut by_turn = vec![vec![0.0; turns]; backends.len()];
    for (place, waves) in stream.waves.chunks(TURN * threads).enumerate() {
        let mut times = vec![vec![vec![0.0; turns]; waves.len()]; backends.len()];
        for turn in 0..turns {
            for i in 0..backends.len() {
                let who = (i + turn + place) % backends.len();
                for (wave, time) in trace_all(backends[who], kind, waves) {
                    times[who][wave][turn] = time;
                    by_turn[who][turn] += time;
                }
            }
        }
        for (total, times) in medians.iter_mut().zip(&mut times) {
            *total += times.iter_mut().map(|times| median(times)).sum::<f64>();
        }
    }
    let work = stream.rays() as f64 * threads as f64 * 1e-6;
    let rate = |(median, turns): (f64, Vec<f64>)| Rate {
        median: work / median,
        least: work / turns.iter().copied().fold(0.0, f64::max),
        most: work / turns.iter().copied().fold(f64::INFINITY, f64::min),
    };
    medians.into_iter().zip(by_turn).map(rate).collect()
}

/// Traces waves on all threads; by wave, the seconds that each took.
fn trace_all(accel: &dyn Accel, kind: RayKind, waves: &[Vec<RayPacket>]) -> Vec<(usize, f64)> {
    let next = AtomicUsize::new(0);
    let of_thread = |_: rayon::BroadcastContext<'_>| {
        let mut room = Room::default();
        let mut times = Vec::new();
        loop {
            let place = next.fetch_add(1, Ordering::Relaxed);
            let Some(wave) = waves.get(place) else { return times };
            times.push((place, room.trace(accel, kind, wave).as_secs_f64()));
        }
    };
    rayon::broadcast(of_thread).into_iter().flatten().collect()
}

fn median(times: &mut [f64]) -> f64 {
    times.sort_unstable_by(f64::total_cmp);
    let middle = times.len() / 2;
    (times[middle] + times[(times.len() - 1) / 2]) / 2.0
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
