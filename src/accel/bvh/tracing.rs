//! Which instructions trace, and how rays go through the trees.

use super::Scene;
#[cfg(target_arch = "x86_64")]
use super::avx2::Avx2;
#[cfg(target_arch = "x86_64")]
use super::avx512::Avx512;
#[cfg(target_arch = "x86_64")]
use super::few::MOST_TESTS;
use super::kernel::Portable;
#[cfg(target_arch = "x86_64")]
use super::stream::{Plan, Together};
use crate::accel::{HitFilter, RayKind};
use crate::geometry::{HitPacket, RayPacket};

/// A way to trace. Where packets cannot be traced ([`Scene::takes_packets`]), rays go one by one.
#[derive(Clone, Copy, Debug)]
pub struct Tracing {
    instructions: Instructions,
    way: Way,
}

/// Which kernel traces.
#[derive(Clone, Copy, Debug)]
enum Instructions {
    #[cfg(target_arch = "x86_64")]
    Avx512(Avx512, Avx2),
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    Portable(Portable),
}

/// How rays go through the trees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    /// By kind of ray and size of the tree, as measured.
    Usual,
    /// In packets of neighbours, against all primitives if they are few.
    Exhaustive,
    /// In packets: neighbours, from the camera, else rays that were sorted.
    Packets,
    /// Sorted, then one by one, several being on their way.
    Interleaved,
    /// One after the other, as they come.
    Single,
}

/// Which bounces go through the tree of the top level together, sorted, as measured. Surfaces of 2000 triangles have 3 to 5 expected
/// nodes, of a million 7 to 10; triangles strewn in space have 8 to 40.
#[cfg(target_arch = "x86_64")]
const BOUNCES: &[Together] = &[
    Together {
        alike: 0,
        nodes: usize::MAX,
        expected: 2.0,
    },
    Together {
        alike: 2,
        nodes: 200,
        expected: 12.0,
    },
    Together {
        alike: 4,
        nodes: usize::MAX,
        expected: 12.0,
    },
    Together {
        alike: 16,
        nodes: usize::MAX,
        expected: f64::INFINITY,
    },
];

/// Which shadow rays do, which have their ends in common.
#[cfg(target_arch = "x86_64")]
const SHADOWS: &[Together] = &[
    Together {
        alike: 0,
        nodes: 200,
        expected: 12.0,
    },
    Together {
        alike: 8,
        nodes: 3000,
        expected: 12.0,
    },
];

/// Tests of triangles at most that rays are done with sooner than they go through a tree, as measured: of camera rays, which go together
/// well.
#[cfg(target_arch = "x86_64")]
const FEW_FOR_CAMERA: usize = 20;

/// The same of shadow rays.
#[cfg(target_arch = "x86_64")]
const FEW_FOR_SHADOWS: usize = 48;

/// All rays do.
#[cfg(target_arch = "x86_64")]
const ALL: &[Together] = &[Together {
    alike: 0,
    nodes: usize::MAX,
    expected: f64::INFINITY,
}];

/// Packets of a call, as deep bounces make it, of which the rays do not go together through any tree, as measured.
#[cfg(target_arch = "x86_64")]
const FEW_PACKETS: usize = 8;

impl Tracing {
    /// The fastest that the processor has.
    pub fn detect() -> Self {
        Self {
            instructions: Instructions::all().swap_remove(0),
            way: Way::Usual,
        }
    }

    /// Whether rays are tested against all primitives where these are few.
    pub fn is_exhaustive(self) -> bool {
        !matches!(self.instructions, Instructions::Portable(_))
    }

    /// Whether it is a way of its own for worlds of few primitives only.
    pub fn is_for_few(self) -> bool {
        self.way == Way::Exhaustive
    }

    /// All that the processor has, by name.
    pub fn all() -> Vec<(String, Self)> {
        let ways = |instructions: Instructions| {
            let ways: &[Way] = match instructions {
                Instructions::Portable(_) => &[Way::Single],
                #[cfg(target_arch = "x86_64")]
                Instructions::Avx2(_) => &[Way::Exhaustive, Way::Packets, Way::Interleaved, Way::Single],
                // A ray by itself has no use for as many lanes.
                #[cfg(target_arch = "x86_64")]
                Instructions::Avx512(..) => &[Way::Exhaustive, Way::Packets, Way::Interleaved],
            };
            ways.iter().map(move |&way| (instructions, way))
        };
        let named = |(instructions, way): (Instructions, Way)| {
            let name = match way {
                Way::Usual => instructions.name().to_owned(),
                Way::Exhaustive => format!("{} exhaustive", instructions.name()),
                Way::Packets => format!("{} packets", instructions.name()),
                Way::Interleaved => format!("{} interleaved", instructions.name()),
                Way::Single => format!("{} single", instructions.name()),
            };
            (name, Self { instructions, way })
        };
        Instructions::all().into_iter().flat_map(ways).map(named).collect()
    }

    #[cfg(target_arch = "x86_64")]
    fn plan(self, kind: RayKind) -> Plan {
        let together = match self.way {
            Way::Usual if kind == RayKind::Shadow => SHADOWS,
            Way::Usual => BOUNCES,
            Way::Packets => ALL,
            Way::Exhaustive | Way::Interleaved | Way::Single => &[],
        };
        Plan {
            exhaustive: match self.way {
                Way::Usual if kind == RayKind::Camera => FEW_FOR_CAMERA,
                Way::Usual if kind == RayKind::Shadow => FEW_FOR_SHADOWS,
                Way::Usual | Way::Exhaustive => MOST_TESTS,
                Way::Packets | Way::Interleaved | Way::Single => 0,
            },
            as_they_come: kind == RayKind::Camera && matches!(self.way, Way::Usual | Way::Packets),
            together,
            few_packets: if self.way == Way::Usual { FEW_PACKETS } else { 0 },
        }
    }

    /// Nearest hits.
    pub fn intersect(
        self,
        scene: &Scene,
        kind: RayKind,
        rays: &[RayPacket],
        hits: &mut [HitPacket],
        filter: Option<&dyn HitFilter>,
    ) {
        #[cfg(target_arch = "x86_64")]
        let together = self.way != Way::Single && scene.takes_packets();
        match self.instructions {
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512(wide, _) if together => wide.intersect(scene, self.plan(kind), rays, hits, filter),
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2(kernel) if together => kernel.intersect(scene, self.plan(kind), rays, hits, filter),
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512(_, kernel) | Instructions::Avx2(kernel) => {
                scene.intersect(kernel, rays, hits, filter);
            }
            Instructions::Portable(kernel) => scene.intersect(kernel, rays, hits, filter),
        }
        #[cfg(not(target_arch = "x86_64"))]
        let _ = kind;
    }

    /// Occlusion.
    pub fn occluded(self, scene: &Scene, rays: &mut [RayPacket], filter: Option<&dyn HitFilter>) {
        #[cfg(target_arch = "x86_64")]
        let (together, plan) = (
            self.way != Way::Single && scene.takes_packets(),
            self.plan(RayKind::Shadow),
        );
        match self.instructions {
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512(wide, _) if together => wide.occluded(scene, plan, rays, filter),
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2(kernel) if together => kernel.occluded(scene, plan, rays, filter),
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512(_, kernel) | Instructions::Avx2(kernel) => scene.occluded(kernel, rays, filter),
            Instructions::Portable(kernel) => scene.occluded(kernel, rays, filter),
        }
    }
}

impl Instructions {
    /// Those that the processor has, the fastest first; there is one at least.
    fn all() -> Vec<Self> {
        let mut all = Vec::new();
        #[cfg(target_arch = "x86_64")]
        if let Some(kernel) = Avx2::detect() {
            all.extend(Avx512::detect().map(|wide| Self::Avx512(wide, kernel)));
            all.push(Self::Avx2(kernel));
        }
        all.push(Self::Portable(Portable));
        all
    }

    fn name(self) -> &'static str {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(..) => "avx-512",
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(_) => "avx2",
            Self::Portable(_) => "portable",
        }
    }
}
