//! Our own BVH, pure Rust.

use std::sync::Arc;

use super::{Accel, AccelInfo, BuildOptions, HitFilter, RayKind};
use crate::geometry::{HitPacket, RayPacket, World};

/// An 8-wide BVH over a world.
pub struct Bvh;

impl Bvh {
    /// Builds it.
    pub fn build(_world: &Arc<World>, _options: &BuildOptions) -> Self {
        Self
    }
}

impl Accel for Bvh {
    fn intersect(&self, _: RayKind, _: &[RayPacket], _: &mut [HitPacket], _: Option<&dyn HitFilter>) {}
    fn occluded(&self, _: RayKind, _: &mut [RayPacket], _: Option<&dyn HitFilter>) {}
    fn is_mate_independent(&self, _: RayKind) -> bool {
        true
    }
    fn info(&self) -> AccelInfo {
        AccelInfo {
            backend: super::Backend::Bvh,
            version: String::new(),
            memory: 0,
        }
    }
}
