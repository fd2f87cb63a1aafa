//! Listens to the queries of a render: wraps any [`Accel`] and keeps the calls that go through it as they are, to replay them through
//! other backends and configurations.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, ThreadId};

use super::{Accel, AccelInfo, HitFilter, RayKind, RayOrigin};
use crate::geometry::{HitPacket, RayPacket};

/// The packets of each call, in the order of the calls.
pub type Waves = Vec<Vec<RayPacket>>;

/// Calls of one kind, spread evenly over all that there were.
#[derive(Debug)]
struct Stream {
    waves: Waves,
    /// Packets of them.
    packets: usize,
    /// Of so many calls one is kept.
    stride: usize,
    /// Calls so far.
    calls: usize,
}

impl Stream {
    const EMPTY: Self = Self {
        waves: Vec::new(),
        packets: 0,
        stride: 1,
        calls: 0,
    };

    fn add(&mut self, rays: &[RayPacket], limit: usize) {
        if self.calls.is_multiple_of(self.stride) {
            self.waves.push(rays.to_vec());
            self.packets += rays.len();
        }
        self.calls += 1;
        while self.packets > limit && self.waves.len() > 1 {
            let mut keep = false;
            self.waves.retain(|_| {
                keep = !keep;
                keep
            });
            self.stride *= 2;
            self.packets = self.waves.iter().map(Vec::len).sum();
        }
    }
}

/// The calls of a render, by kind of ray and origin of its paths.
#[derive(Debug)]
pub struct RayStreams {
    limit: usize,
    streams: Mutex<HashMap<(RayKind, RayOrigin), Stream>>,
    /// What each thread has announced.
    origins: Mutex<HashMap<ThreadId, RayOrigin>>,
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl RayStreams {
    /// Streams that hold up to `limit` packets of each kind and origin (or one call, if that alone has more): where there are more, every
    /// second call is kept, every fourth, and so on.
    pub fn new(limit: usize) -> Arc<Self> {
        Arc::new(Self {
            limit,
            streams: Mutex::default(),
            origins: Mutex::default(),
        })
    }

    /// What was recorded, in the order of kinds ([`RayKind::ALL`]) and of origins: those of camera paths first, then by depth.
    pub fn take(&self) -> Vec<(RayKind, RayOrigin, Waves)> {
        let streams = std::mem::take(&mut *lock(&self.streams));
        let mut streams: Vec<_> = streams.into_iter().collect();
        streams.sort_by_key(|((kind, origin), _)| (*kind as usize, origin.from_light, origin.depth));
        streams
            .into_iter()
            .map(|((kind, origin), s)| (kind, origin, s.waves))
            .collect()
    }

    fn record(&self, kind: RayKind, rays: &[RayPacket]) {
        let origin = lock(&self.origins).get(&thread::current().id()).copied();
        let mut streams = lock(&self.streams);
        let stream = streams
            .entry((kind, origin.unwrap_or_default()))
            .or_insert(Stream::EMPTY);
        stream.add(rays, self.limit);
    }
}

/// An [`Accel`] that answers as the one within and records what it is asked.
pub struct Recorder {
    inner: Arc<dyn Accel>,
    streams: Arc<RayStreams>,
}

impl Recorder {
    /// Listens to `inner`.
    pub fn new(inner: Arc<dyn Accel>, streams: Arc<RayStreams>) -> Self {
        Self { inner, streams }
    }
}

impl Accel for Recorder {
    fn intersect(&self, kind: RayKind, rays: &[RayPacket], hits: &mut [HitPacket], filter: Option<&dyn HitFilter>) {
        self.streams.record(kind, rays);
        self.inner.intersect(kind, rays, hits, filter);
    }

    fn occluded(&self, kind: RayKind, rays: &mut [RayPacket], filter: Option<&dyn HitFilter>) {
        self.streams.record(kind, rays);
        self.inner.occluded(kind, rays, filter);
    }

    fn announce(&self, origin: RayOrigin) {
        lock(&self.streams.origins).insert(thread::current().id(), origin);
    }

    fn is_mate_independent(&self, kind: RayKind) -> bool {
        self.inner.is_mate_independent(kind)
    }

    fn info(&self) -> AccelInfo {
        self.inner.info()
    }
}
