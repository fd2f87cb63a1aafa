//! Listens to the queries of a render: wraps any [`Accel`] and keeps the packets that go through it, kind by kind, as they are, to
//! replay them through other backends and configurations.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::{Accel, AccelInfo, HitFilter, RayKind};
use crate::geometry::{HitPacket, RayPacket};

/// The packets of a render, in the order in which they were traced, up to a number of each kind.
#[derive(Debug)]
pub struct RayStreams {
    limit: usize,
    streams: [Mutex<Vec<RayPacket>>; RayKind::ALL.len()],
}

impl RayStreams {
    /// Streams that stop growing at `limit` packets of a kind.
    pub fn new(limit: usize) -> Arc<Self> {
        Arc::new(Self {
            limit,
            streams: Default::default(),
        })
    }

    /// The packets of one kind.
    pub fn of(&self, kind: RayKind) -> Vec<RayPacket> {
        self.lock(kind).clone()
    }

    fn lock(&self, kind: RayKind) -> MutexGuard<'_, Vec<RayPacket>> {
        let index = match kind {
            RayKind::Camera => 0,
            RayKind::Shadow => 1,
            RayKind::Bounce => 2,
        };
        self.streams[index].lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn record(&self, kind: RayKind, rays: &[RayPacket]) {
        let mut stream = self.lock(kind);
        let room = self.limit - stream.len();
        stream.extend_from_slice(&rays[..rays.len().min(room)]);
    }
}

/// An [`Accel`] that answers as the one within and records what it is asked.
pub struct Recorder {
    inner: Box<dyn Accel>,
    streams: Arc<RayStreams>,
}

impl Recorder {
    /// Listens to `inner`.
    pub fn new(inner: Box<dyn Accel>, streams: Arc<RayStreams>) -> Self {
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

    fn is_mate_independent(&self, kind: RayKind) -> bool {
        self.inner.is_mate_independent(kind)
    }

    fn info(&self) -> AccelInfo {
        self.inner.info()
    }
}
