//! Debian's Embree.

use std::sync::Arc;

use super::{Accel, AccelInfo, BuildOptions, HitFilter, RayKind};
use crate::error::Result;
use crate::geometry::{HitPacket, RayPacket, World};

/// A committed Embree scene.
pub struct EmbreeScene;

impl EmbreeScene {
    /// Builds it.
    pub fn build(_world: &Arc<World>, _options: &BuildOptions) -> Result<Self> {
        Ok(Self)
    }
}

impl Accel for EmbreeScene {
    fn intersect(&self, _: RayKind, _: &[RayPacket], _: &mut [HitPacket], _: Option<&dyn HitFilter>) {}
    fn occluded(&self, _: RayKind, _: &mut [RayPacket], _: Option<&dyn HitFilter>) {}
    fn is_mate_independent(&self, _: RayKind) -> bool {
        true
    }
    fn info(&self) -> AccelInfo {
        AccelInfo {
            backend: super::Backend::Embree,
            version: String::new(),
            memory: 0,
        }
    }
}
