//! A scene ready to be rendered: what rays can hit, what it is made of, what emits. Built from a description, with one backend; it
//! outlives renders and serves many [`View`]s.

mod attributes;
mod build;
mod cutouts;
mod lights;
mod materials;
mod media;
mod shapes;
mod spectra;
mod tessellate;
mod textures;
mod tubes;
mod view;

use std::sync::Arc;

use crate::accel::{Accel, Backend, BuildOptions};
use crate::geometry::{GeometryId, PrimitiveId, SurfaceInteraction, World};
use crate::light::{EnvironmentLight, Light, LightId, LightSampler};
use crate::material::Material;
use crate::math::{Bounds3, Vec3};
use crate::medium::{HomogeneousMedium, MediumId};
use crate::spectrum::ColorMode;
use crate::texture::FloatTexture;

use media::MediumInterface;
pub use view::{View, ViewOverrides};

/// How to build a [`Scene`].
#[derive(Clone, Copy, Debug, Default)]
pub struct SceneOptions {
    /// Who answers ray queries; by default the [one for the world](Backend::for_world).
    pub backend: Option<Backend>,
    /// How its structures are built.
    pub build: BuildOptions,
    /// Whether transport is spectral or rgb.
    pub color: ColorMode,
}

/// Everything that an integrator needs to know of a scene.
pub struct Scene {
    world: Arc<World>,
    accel: Arc<dyn Accel>,
    color: ColorMode,
    bounds: Bounds3,
    materials: Vec<Material>,
    media: Vec<HomogeneousMedium>,
    /// By geometry.
    surfaces: Vec<Surface>,
    /// Whether any material may refract wavelengths differently.
    disperses: bool,
    /// Whether any of the surfaces is only a boundary between media.
    has_interfaces: bool,
    /// Whether any of them has an alpha.
    has_cutouts: bool,
    lights: Vec<Light>,
    /// Those that a ray meets when it leaves the scene.
    environments: Vec<LightId>,
    light_sampler: LightSampler,
    /// By power.
    emission_sampler: LightSampler,
    /// Of points, by power; empty without media.
    point_sampler: LightSampler,
    /// Whether anything but a camera moves.
    moves: bool,
    /// Seconds that the backend took to build.
    build_seconds: f64,
}

/// What a geometry is made of and which lights its primitives are.
#[derive(Clone, Debug)]
struct Surface {
    /// Index of the material.
    material: u32,
    /// What is on its two sides, if that differs.
    media: Option<MediumInterface>,
    /// By primitive; empty if none emits.
    lights: Vec<Option<LightId>>,
    /// How much of it there is, if rays pass some of it.
    alpha: Option<FloatTexture>,
}

impl Scene {
    /// What rays can hit.
    pub fn world(&self) -> &Arc<World> {
        &self.world
    }

    /// Who answers ray queries.
    pub fn accel(&self) -> &dyn Accel {
        self.accel.as_ref()
    }

    /// This scene with the backend wrapped by `wrap`, to listen to its queries.
    #[must_use]
    pub fn map_accel(mut self, wrap: impl FnOnce(Arc<dyn Accel>) -> Arc<dyn Accel>) -> Self {
        self.accel = wrap(self.accel);
        self
    }

    /// Whether transport is spectral or rgb.
    pub fn color(&self) -> ColorMode {
        self.color
    }

    /// A box around everything that can be hit.
    pub fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    /// Whether any shape or light moves.
    pub fn moves(&self) -> bool {
        self.moves
    }

    /// The material of a geometry.
    #[inline]
    pub fn material(&self, geometry: GeometryId) -> &Material {
        &self.materials[self.surfaces[geometry.index()].material as usize]
    }

    /// All materials.
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// A medium.
    #[inline]
    pub fn medium(&self, id: MediumId) -> &HomogeneousMedium {
        &self.media[id.index()]
    }

    /// Whether there are any media that something is in, or boundaries between media.
    pub fn has_media(&self) -> bool {
        !self.media.is_empty() || self.has_interfaces
    }

    /// Whether a geometry is only a boundary between media.
    #[inline]
    pub fn is_interface(&self, geometry: GeometryId) -> bool {
        matches!(self.material(geometry), Material::Interface)
    }

    /// The medium on the side of a surface that `w` points to, where it is `current` if the surface does not say.
    #[inline]
    pub fn medium_beyond(&self, si: &SurfaceInteraction, w: Vec3, current: Option<MediumId>) -> Option<MediumId> {
        match self.surfaces[si.hit.geometry.index()].media {
            Some(media) if w.dot(si.ng) > 0.0 => media.exterior,
            Some(media) => media.interior,
            None => current,
        }
    }

    /// Whether any material may refract wavelengths differently.
    pub fn disperses(&self) -> bool {
        self.disperses
    }

    /// Whether any geometry is only a boundary between media.
    pub fn has_interfaces(&self) -> bool {
        self.has_interfaces
    }

    /// The light that a primitive is, if it emits.
    #[inline]
    pub fn light_of(&self, geometry: GeometryId, primitive: PrimitiveId) -> Option<LightId> {
        let lights = &self.surfaces[geometry.index()].lights;
        lights.get(primitive.index()).copied().flatten()
    }

    /// All lights, by [`LightId`].
    pub fn lights(&self) -> &[Light] {
        &self.lights
    }

    /// One light.
    #[inline]
    pub fn light(&self, id: LightId) -> &Light {
        &self.lights[id.index()]
    }

    /// The lights that a ray meets when it leaves the scene.
    #[inline]
    pub fn environments(&self) -> impl Iterator<Item = (LightId, &EnvironmentLight)> {
        self.environments.iter().filter_map(|&id| match self.light(id) {
            Light::Environment(light) => Some((id, light)),
            _ => None,
        })
    }

    /// Chooses lights for next-event estimation.
    #[inline]
    pub fn light_sampler(&self) -> &LightSampler {
        &self.light_sampler
    }

    /// Chooses lights that paths start from: by power, whatever point is asked for.
    #[inline]
    pub fn emission_sampler(&self) -> &LightSampler {
        &self.emission_sampler
    }

    /// Chooses lights that are points, for what media scatter of their light, whatever point is asked for. Empty without media.
    #[inline]
    pub fn point_sampler(&self) -> &LightSampler {
        &self.point_sampler
    }

    /// Seconds that the backend took to build.
    pub fn build_seconds(&self) -> f64 {
        self.build_seconds
    }

    /// Bytes of geometry and of the backend's structures.
    pub fn memory(&self) -> usize {
        self.world.memory() + self.accel.info().memory
    }
}
