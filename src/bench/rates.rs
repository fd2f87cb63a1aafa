//! How fast backends answer the same rays.
//!
//! The backends take turns, a few waves each, in an order that changes from turn to turn, so that other work on the machine
//! disturbs all of them alike; a wave's time is the median of its turns, and a stream's the sum over its waves.

use std::hint::black_box;
use std::time::{Duration, Instant};

use crate::accel::{Accel, RayKind};
use crate::geometry::{HitPacket, LANES, RayPacket};

/// Waves that a backend traces in one turn: its tree is in the cache after the first.
const TURN: usize = 16;

/// What a backend did with a stream.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rate {
    /// Rays in the stream.
    pub rays: usize,
    /// Of which met anything.
    pub hits: usize,
    /// Millions of rays in a second.
    pub mrays: f64,
}

/// Times every backend on `waves`, `turns` times each (at least once).
pub fn measure(backends: &[&dyn Accel], kind: RayKind, waves: &[Vec<RayPacket>], turns: usize) -> Vec<Rate> {
    let active = |packet: &RayPacket| (0..LANES).filter(|&lane| packet.is_active(lane)).count();
    let rays = waves.iter().flatten().map(active).sum();
    let mut seconds = vec![0.0; backends.len()];
    let mut hits = vec![0; backends.len()];
    let mut bench = Bench::default();
    for (place, turn_waves) in waves.chunks(TURN).enumerate() {
        let mut times = vec![vec![Vec::new(); turn_waves.len()]; backends.len()];
        for turn in 0..turns.max(1) {
            for i in 0..backends.len() {
                let who = (i + turn + place) % backends.len();
                let mut found = 0;
                for (wave, times) in turn_waves.iter().zip(&mut times[who]) {
                    times.push(bench.trace(backends[who], kind, wave));
                    found += bench.hits(kind);
                }
                if turn == 0 {
                    hits[who] += found;
                }
            }
        }
        for (seconds, times) in seconds.iter_mut().zip(&mut times) {
            *seconds += times.iter_mut().map(|times| median(times)).sum::<f64>();
        }
    }
    let rate = |(seconds, hits): (f64, usize)| Rate {
        rays,
        hits,
        mrays: rays as f64 / seconds / 1e6,
    };
    seconds.into_iter().zip(hits).map(rate).collect()
}

fn median(times: &mut [Duration]) -> f64 {
    times.sort_unstable();
    let middle = times.len() / 2;
    (times[middle] + times[(times.len() - 1) / 2]).as_secs_f64() / 2.0
}

/// Room for a wave: it is copied into place outside the measured time, as in a render it is in the cache.
#[derive(Default)]
struct Bench {
    rays: Vec<RayPacket>,
    hits: Vec<HitPacket>,
}

impl Bench {
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

    fn hits(&self, kind: RayKind) -> usize {
        let lanes = (0..self.rays.len()).flat_map(|packet| (0..LANES).map(move |lane| (packet, lane)));
        match kind {
            RayKind::Shadow => lanes.filter(|&(p, lane)| self.rays[p].is_occluded(lane)).count(),
            RayKind::Camera | RayKind::Bounce => lanes.filter(|&(p, lane)| self.hits[p].is_hit(lane)).count(),
        }
    }
}
