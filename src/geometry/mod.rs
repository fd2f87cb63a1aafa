//! Shapes, the world they make up, packets of rays, and what a hit says about the surface.

mod cone;
mod curve;
mod mesh;
mod packet;
mod patch;
mod patch_mesh;
mod placement;
mod quadric;
mod shape;
mod sphere;
mod surface;
mod surface_lanes;
mod triangle;
mod triangle_lanes;
mod triangle_records;
mod tube;
mod vertices;
mod world;

pub use crate::math::LANES;
pub use cone::RayCone;
pub use curve::{CurveKind, CurveSegment, CurveSet, FacingCurves};
pub use mesh::TriangleMesh;
pub use packet::{HitPacket, Ray, RayLanes, RayPacket, RayQueue};
pub use patch::{Patch, PatchHit};
pub use patch_mesh::{PatchMesh, PatchSurface};
pub use quadric::{Quadric, QuadricKind, QuadricPoint};
pub use shape::{LineHits, Shape};
pub(crate) use sphere::line_roots_or_nan;
pub use sphere::{Sphere, SphereHits};
pub use surface::{Hit, SurfaceInteraction};
pub use surface_lanes::{SurfaceLanes, Surfaces};
pub use triangle::{LEAST_ERROR, triangle_error};
pub use tube::{TubePiece, TubeSet};
pub use vertices::MeshError;
pub use world::{Geometry, Group, Instance, Opacity, World, WorldBuilder};

macro_rules! index_newtype {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub struct $name(pub u32);

        impl $name {
            /// As an index into a slice.
            #[inline]
            pub fn index(self) -> usize {
                self.0 as usize
            }

            /// From a position in a slice.
            ///
            /// # Panics
            /// At 2^32 - 1 and above: that value means "none" in packets.
            #[inline]
            pub fn from_index(index: usize) -> Self {
                match u32::try_from(index) {
                    Ok(index) if index != u32::MAX => Self(index),
                    _ => panic!("more than 2^32 - 2 of {}", stringify!($name)),
                }
            }
        }
    };
}

index_newtype! {
    /// A geometry of a [`World`].
    GeometryId
}
index_newtype! {
    /// A primitive of a geometry: a triangle, a sphere, a patch.
    PrimitiveId
}
index_newtype! {
    /// A group of a [`World`].
    GroupId
}
index_newtype! {
    /// An instance at the top level of a [`World`].
    InstanceId
}
