//! Ray queries: which primitive, at what distance. Knows no material and no light.
//!
//! A query takes many packets in one dynamic call, with the [`RayKind`] as a hint of how coherent they are. There are two
//! backends, both in one binary and chosen at run time: Debian's Embree (feature `embree`) and our own BVH. A third, brute force,
//! is the reference of the tests.

pub mod brute;
pub mod bvh;
#[cfg(feature = "embree")]
pub mod embree;
pub mod judge;
pub mod record;

use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

use crate::error::{Error, Result};
use crate::geometry::{Geometry, GeometryId, HitPacket, InstanceId, PrimitiveId, RayPacket, World};

/// What rays are for, which says how coherent a packet of them is. A backend serves each kind by its best entry point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RayKind {
    /// From the camera: the rays of a packet are neighbours.
    Camera,
    /// From a surface towards a sampled light or vertex.
    Shadow,
    /// Scattered by a surface: incoherent.
    Bounce,
}

impl RayKind {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::Camera, Self::Shadow, Self::Bounce];
}

/// Where the paths come from whose rays are traced next, which only listeners such as [`record::Recorder`] want to know.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct RayOrigin {
    /// Whether the paths began at lights: the rays are those of photons.
    pub from_light: bool,
    /// Scattering events of the paths so far.
    pub depth: u32,
}

/// A candidate hit on [filtered](crate::geometry::Opacity::Filtered) geometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterHit {
    /// The geometry.
    pub geometry: GeometryId,
    /// The primitive of that geometry.
    pub primitive: PrimitiveId,
    /// The instance, unless the geometry is in world space.
    pub instance: Option<InstanceId>,
    /// Barycentric coordinate of the second vertex; of what is no triangle, 0.
    pub u: f32,
    /// Barycentric coordinate of the third vertex; of what is no triangle, 0.
    pub v: f32,
    /// Distance in units of the ray's direction.
    pub t: f32,
    /// The ray's [id](crate::geometry::Ray::id).
    pub ray_id: u32,
}

/// Decides whether hits on filtered geometry count. It may be asked about the same hit more than once and about hits beyond the
/// nearest, in any order, so it must be a function of its argument.
pub trait HitFilter: Sync {
    /// Whether the hit counts; if not, the ray goes on behind it.
    fn accept(&self, hit: &FilterHit) -> bool;
}

/// A structure over a [`World`] that answers ray queries.
///
/// Lanes whose `tnear <= tfar` take part; the others are passed over. A ray that takes part must be
/// [valid](crate::geometry::Ray::is_valid). Where two primitives are met at the same distance either may be reported; our own
/// backends report the least (geometry, primitive, instance).
pub trait Accel: Send + Sync {
    /// Finds the nearest hit of each ray in (tnear, tfar]; `hits[i]` belongs to `rays[i]`. (Embree counts a hit at tnear itself.)
    ///
    /// # Panics
    /// If the slices differ in length.
    fn intersect(&self, kind: RayKind, rays: &[RayPacket], hits: &mut [HitPacket], filter: Option<&dyn HitFilter>);

    /// Sets `tfar` to negative infinity in each lane that hits anything in (tnear, tfar]; all else stays.
    fn occluded(&self, kind: RayKind, rays: &mut [RayPacket], filter: Option<&dyn HitFilter>);

    /// Hears what the next queries of the calling thread are for. Answers do not depend on it.
    fn announce(&self, origin: RayOrigin) {
        let _ = origin;
    }

    /// Whether the answer for a ray of this kind does not depend on the other rays of its packet or call, to the last bit.
    fn is_mate_independent(&self, kind: RayKind) -> bool;

    /// Which backend it is, and how big.
    fn info(&self) -> AccelInfo;
}

/// What a backend says about itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AccelInfo {
    /// Which backend.
    pub backend: Backend,
    /// Its version: of the Embree library, or of this crate.
    pub version: String,
    /// Bytes of its trees; 0 if it cannot tell.
    pub memory: usize,
}

/// The backends that can be chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Backend {
    /// Debian's Embree.
    Embree,
    /// Our own 8-wide BVH.
    Bvh,
}

impl Backend {
    /// Those that are compiled in, the default first.
    pub const AVAILABLE: &[Self] = &[
        #[cfg(feature = "embree")]
        Self::Embree,
        Self::Bvh,
    ];

    /// The one for a world if nobody asks for another. Our BVH from [`Backend::MANY`] primitives on, where it needs less memory to build and
    /// on average traces faster, unless there are instances, which are slower in it; and for spheres among few primitives, which it tests many at
    /// a time, where Embree calls back for each. Elsewhere, and where what only Embree has is asked for, the default.
    pub fn for_world(world: &World, options: &BuildOptions) -> Self {
        let primitives: usize = world.geometries().iter().map(Geometry::primitive_count).sum();
        let wants_embree = options.compact || !options.robust;
        let is_large = primitives >= Self::MANY && world.instances().is_empty();
        if (is_large || bvh::Bvh::has_spheres_among_few(world)) && !wants_embree {
            Self::Bvh
        } else {
            Self::default()
        }
    }

    /// See [`Backend::for_world`].
    pub const MANY: usize = 1_000_000;
}

impl Default for Backend {
    fn default() -> Self {
        Self::AVAILABLE[0]
    }
}

impl fmt::Display for Backend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Embree => "embree",
            Self::Bvh => "bvh",
        })
    }
}

impl FromStr for Backend {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self> {
        match name {
            "embree" if cfg!(feature = "embree") => Ok(Self::Embree),
            "embree" => Err(Error::Usage(
                "this lucerna was built without Embree (--no-default-features)".into(),
            )),
            "bvh" => Ok(Self::Bvh),
            _ => Err(Error::Usage(format!(
                "unknown backend `{name}`: expected embree or bvh"
            ))),
        }
    }
}

/// How much time a build may take for faster queries.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BuildQuality {
    /// Fast builds.
    Low,
    /// The balance that most scenes want.
    #[default]
    Medium,
    /// Fast queries.
    High,
}

/// How to build a backend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BuildOptions {
    /// Build time against query time.
    pub quality: BuildQuality,
    /// Watertight triangle tests in Embree (our BVH is always watertight).
    pub robust: bool,
    /// The least memory, while building and after, at the price of slower queries: Embree's compact scenes, which are
    /// always robust. Our BVH has one form.
    pub compact: bool,
    /// Threads that may build.
    pub threads: usize,
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self {
            quality: BuildQuality::default(),
            robust: true,
            compact: false,
            threads: 1,
        }
    }
}

/// Builds a backend over `world`. Runs in the rayon pool of the caller.
///
/// # Errors
/// [`Error::Backend`] if the backend fails (out of memory, say) or is not compiled in.
pub fn build(backend: Backend, world: &Arc<World>, options: &BuildOptions) -> Result<Box<dyn Accel>> {
    match backend {
        Backend::Bvh => Ok(Box::new(bvh::Bvh::build(world, options))),
        #[cfg(feature = "embree")]
        Backend::Embree => Ok(Box::new(embree::EmbreeScene::build(world, options)?)),
        #[cfg(not(feature = "embree"))]
        Backend::Embree => Err(Error::Backend {
            backend: "embree",
            message: "not compiled in (--no-default-features)".into(),
        }),
    }
}
