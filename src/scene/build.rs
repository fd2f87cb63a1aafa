//! From a description to a scene.

use std::borrow::Borrow;
use std::collections::HashMap;
use std::sync::Arc;
use std::time::Instant;

use super::attributes::{self, AttributeTables};
use super::lights::LightBuilder;
use super::materials::compile_materials;
use super::matte;
use super::media;
use super::shapes::{animated, place};
use super::spectra::SpectrumCompiler;
use super::textures::TextureCompiler;
use super::{Scene, SceneOptions, Surface};
use crate::accel::{self, Backend};
use crate::desc::{AreaLightDesc, LightSamplerKind, SceneDesc, ShapeDesc};
use crate::error::{Diagnostic, Error, Result, Severity, Span};
use crate::geometry::{Geometry, GeometryId, Group, Instance, Opacity, WorldBuilder};
use crate::light::{Light, LightId, LightSampler};
use crate::material::Material;
use crate::math::AnimatedTransform;
use crate::texture::FloatTexture;

/// What is collected while shapes and lights are gone through.
struct SceneBuilder<'a> {
    desc: &'a SceneDesc,
    textures: TextureCompiler<'a>,
    world: WorldBuilder,
    surfaces: Vec<Surface>,
    lights: LightBuilder,
    problems: Vec<Diagnostic>,
}

impl Scene {
    /// Builds a scene and its backend, in the rayon pool of the caller.
    ///
    /// # Errors
    /// [`Error::Scene`] for what the description asks and cannot be had, [`Error::Backend`] if the backend fails.
    pub fn build(desc: &SceneDesc, options: &SceneOptions) -> Result<Self> {
        Self::of_shapes(desc, desc.shapes.iter(), attributes::asked_for(desc), options)
    }

    /// As [`Scene::build`], but takes the shapes that stand in the world themselves out of the description, and forgets each once it has its
    /// geometry: else there would be two of each mesh while memory is scarcest.
    ///
    /// # Errors
    /// As for [`Scene::build`].
    pub fn build_taking_shapes(desc: &mut SceneDesc, options: &SceneOptions) -> Result<Self> {
        let attributes = attributes::asked_for(desc);
        let shapes = std::mem::take(&mut desc.shapes);
        Self::of_shapes(desc, shapes.into_iter(), attributes, options)
    }

    fn of_shapes(
        desc: &SceneDesc,
        shapes: impl Iterator<Item = impl Borrow<ShapeDesc>>,
        attributes: HashMap<String, AttributeTables>,
        options: &SceneOptions,
    ) -> Result<Self> {
        let spectra = SpectrumCompiler { mode: options.color };
        let mut builder = SceneBuilder {
            desc,
            textures: TextureCompiler::new(desc, attributes, spectra),
            world: WorldBuilder::default(),
            surfaces: Vec::new(),
            lights: LightBuilder::new(options.color),
            problems: Vec::new(),
        };
        builder.add_shapes(shapes);
        builder.add_objects();
        for light in &desc.lights {
            if let Err(message) = builder.lights.add(light) {
                builder.problem(light.span, message);
            }
        }
        if !builder.problems.is_empty() {
            return Err(Error::Scene(builder.problems));
        }
        let materials = compile_materials(&desc.materials, &mut builder.textures);
        // Media that are defined and nowhere used, as files from converters have them, must not slow a render down.
        let has_medium = |surface: &Surface| surface.media.is_some_and(|media| media.is_any());
        let are_used = builder.surfaces.iter().any(has_medium) || desc.views.iter().any(|v| v.camera.medium.is_some());
        let media: Vec<_> = desc
            .media
            .iter()
            .filter(|_| are_used)
            .map(|medium| media::compile(medium, spectra))
            .collect();
        let is_interface = |surface: &Surface| matches!(materials[surface.material as usize], Material::Interface);
        let has_interfaces = builder.surfaces.iter().any(is_interface);
        let world = Arc::new(builder.world.build()?);
        let bounds = world.bounds();
        let start = Instant::now();
        let backend = options
            .backend
            .unwrap_or_else(|| Backend::for_world(&world, &options.build));
        let accel = Arc::from(accel::build(backend, &world, &options.build)?);
        let build_seconds = start.elapsed().as_secs_f64();
        let emission_sampler = LightSampler::power(&builder.lights.lights, &bounds);
        let in_media: &[Light] = if media.is_empty() { &[] } else { &builder.lights.lights };
        let point_sampler = LightSampler::points(in_media, &bounds);
        let light_sampler = match desc.integrator.light_sampler {
            LightSamplerKind::Bvh => LightSampler::bvh(&builder.lights.lights, &bounds),
            LightSamplerKind::Power => LightSampler::power(&builder.lights.lights, &bounds),
            LightSamplerKind::Uniform => LightSampler::uniform(&builder.lights.lights),
        };
        let moves = world.moves() || desc.lights.iter().any(|light| !light.world_from_light.is_static());
        let known_albedo =
            |surface: &Surface| matte::known_albedo(&materials[surface.material as usize], !surface.lights.is_empty());
        Ok(Self {
            known_albedos: builder.surfaces.iter().map(known_albedo).collect(),
            world,
            moves,
            accel,
            color: options.color,
            bounds,
            disperses: materials.iter().any(Material::disperses),
            materials,
            media,
            has_interfaces,
            has_cutouts: builder.surfaces.iter().any(|surface| surface.alpha.is_some()),
            surfaces: builder.surfaces,
            lights: builder.lights.lights,
            environments: builder.lights.environments,
            light_sampler,
            emission_sampler,
            point_sampler,
            build_seconds,
        })
    }
}

impl SceneBuilder<'_> {
    fn problem(&mut self, span: Span, message: impl Into<String>) {
        self.problems
            .push(self.desc.sources.diagnostic(Severity::Error, span, message.into()));
    }

    fn add_shapes(&mut self, shapes: impl Iterator<Item = impl Borrow<ShapeDesc>>) {
        for shape in shapes {
            if let Some((id, motion)) = self.add_shape(shape.borrow()) {
                match motion {
                    None => self.world.root.geometries.push(id),
                    Some(instance) => self.world.root.instances.push(instance),
                }
            }
        }
    }

    fn add_objects(&mut self) {
        let mut groups = Vec::with_capacity(self.desc.objects.len());
        for object in &self.desc.objects {
            let mut group = Group::default();
            for shape in &object.shapes {
                if let Some((id, motion)) = self.add_shape(shape) {
                    match motion {
                        None => group.geometries.push(id),
                        Some(instance) => group.instances.push(instance),
                    }
                }
            }
            groups.push(self.world.add_group(group));
        }
        for instance in &self.desc.instances {
            match animated(&instance.world_from_instance) {
                Ok(world_from_object) => self.world.root.instances.push(Instance {
                    group: groups[instance.object.0 as usize],
                    world_from_object,
                    mask: u32::MAX,
                }),
                Err(message) => self.problem(instance.span, message),
            }
        }
    }

    /// Adds a shape's geometry and its lights; one that moves gets a group of its own and the instance that moves it.
    fn add_shape(&mut self, shape: &ShapeDesc) -> Option<(GeometryId, Option<Instance>)> {
        let mut placed = match place(shape, &mut self.textures) {
            Ok(placed) => placed,
            Err(message) => {
                self.problem(shape.span, message);
                return None;
            }
        };
        let alpha = self.textures.float(&shape.alpha);
        let lights = match &shape.area_light {
            None => Vec::new(),
            Some(area_light) => self.add_area_lights(area_light, &placed.geometry, placed.motion.as_ref(), &alpha),
        };
        let alpha = match alpha {
            FloatTexture::Constant(alpha) if alpha >= 1.0 => None,
            alpha => Some(alpha),
        };
        if alpha.is_some() {
            placed.geometry.opacity = Opacity::Filtered;
        }
        let id = self.world.add_geometry(placed.geometry);
        self.surfaces.push(Surface {
            material: shape.material.0,
            media: shape.media.as_ref().map(media::interface),
            lights,
            alpha,
        });
        let instance = placed.motion.map(|world_from_object| Instance {
            group: self.world.add_group(Group {
                geometries: vec![id],
                instances: Vec::new(),
            }),
            world_from_object,
            mask: u32::MAX,
        });
        Some((id, instance))
    }

    /// One light for each primitive that has an area.
    fn add_area_lights(
        &mut self,
        desc: &AreaLightDesc,
        geometry: &Geometry,
        motion: Option<&AnimatedTransform>,
        alpha: &FloatTexture,
    ) -> Vec<Option<LightId>> {
        let lights = self.lights.add_area(desc, geometry, motion, alpha);
        lights.unwrap_or_else(|message| {
            self.problem(desc.span, message);
            Vec::new()
        })
    }
}
