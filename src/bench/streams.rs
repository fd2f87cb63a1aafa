//! Streams of rays: what a render asks of a backend, by what the rays are for, in the waves in which it asks.

use std::fmt;
use std::str::FromStr;

pub use crate::accel::record::Waves;
use crate::accel::{RayKind, RayOrigin};
use crate::geometry::{LANES, RayPacket};

/// Bounces that are told apart; deeper ones count as the last.
pub const DEEPEST: u32 = 3;

/// What the rays of a stream are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum StreamKind {
    /// From the camera.
    Camera,
    /// Scattered so many times, from 1 to [`DEEPEST`].
    Bounce(u32),
    /// Towards a light or a vertex: whether anything is in the way.
    Shadow,
    /// On the way from a light.
    Photon,
}

impl StreamKind {
    /// All there are, in the order of reports.
    pub fn all() -> impl Iterator<Item = Self> {
        let bounces = (1..=DEEPEST).map(Self::Bounce);
        [Self::Camera]
            .into_iter()
            .chain(bounces)
            .chain([Self::Shadow, Self::Photon])
    }

    /// What queries of `kind` about paths of `origin` are.
    pub fn of(kind: RayKind, origin: RayOrigin) -> Self {
        match kind {
            RayKind::Camera => Self::Camera,
            RayKind::Shadow => Self::Shadow,
            RayKind::Bounce if origin.from_light => Self::Photon,
            RayKind::Bounce => Self::Bounce(origin.depth.clamp(1, DEEPEST)),
        }
    }

    /// What a backend is told.
    pub fn ray_kind(self) -> RayKind {
        match self {
            Self::Camera => RayKind::Camera,
            Self::Shadow => RayKind::Shadow,
            Self::Bounce(_) | Self::Photon => RayKind::Bounce,
        }
    }
}

impl fmt::Display for StreamKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Camera => f.pad("camera"),
            Self::Bounce(DEEPEST) => f.pad(&format!("bounce {DEEPEST}+")),
            Self::Bounce(depth) => f.pad(&format!("bounce {depth}")),
            Self::Shadow => f.pad("shadow"),
            Self::Photon => f.pad("photon"),
        }
    }
}

impl FromStr for StreamKind {
    type Err = ();

    fn from_str(name: &str) -> Result<Self, ()> {
        Self::all().find(|kind| kind.to_string() == name).ok_or(())
    }
}

/// Rays of one kind, in waves.
#[derive(Clone, Debug)]
pub struct Stream {
    /// What they are for.
    pub kind: StreamKind,
    /// The packets of each call.
    pub waves: Waves,
}

/// Rays of packets that take part.
pub fn active(packets: &[RayPacket]) -> usize {
    let of_packet = |packet: &RayPacket| (0..LANES).filter(|&lane| packet.is_active(lane)).count();
    packets.iter().map(of_packet).sum()
}

impl Stream {
    /// Rays that take part.
    pub fn rays(&self) -> usize {
        self.waves.iter().map(|wave| active(wave)).sum()
    }

    /// This one, without some whole waves, evenly, so that about `most` rays are left.
    #[must_use]
    pub fn thinned(&self, most: usize) -> Self {
        let mut thinned = self.clone();
        thinned.thin(most);
        thinned
    }

    /// Leaves out whole waves, evenly, until there are about `most` rays.
    fn thin(&mut self, most: usize) {
        let (rays, count) = (self.rays(), self.waves.len());
        if rays <= most || count < 2 {
            return;
        }
        let kept = (count * most).div_ceil(rays).max(1);
        let mut place = 0;
        self.waves.retain(|_| {
            let keep = place * kept / count != (place + 1) * kept / count;
            place += 1;
            keep
        });
    }
}

/// Puts waves together by what they are for, with about `most` rays of each kind, in the order of [`StreamKind::all`].
pub fn sort(waves: impl IntoIterator<Item = (StreamKind, Waves)>, most: usize) -> Vec<Stream> {
    let mut streams: Vec<Stream> = StreamKind::all()
        .map(|kind| Stream {
            kind,
            waves: Vec::new(),
        })
        .collect();
    for (kind, waves) in waves {
        for stream in streams.iter_mut().filter(|stream| stream.kind == kind) {
            stream
                .waves
                .extend(waves.iter().filter(|wave| active(wave) > 0).cloned());
        }
    }
    streams.iter_mut().for_each(|stream| stream.thin(most));
    streams.retain(|stream| !stream.waves.is_empty());
    streams
}
