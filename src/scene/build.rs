//! From a description to a scene.

use std::sync::Arc;
use std::time::Instant;

use super::materials::compile_materials;
use super::shapes::{animated, place};
use super::spectra::SpectrumCompiler;
use super::textures::TextureCompiler;
use super::{Scene, SceneOptions, Surface};
use crate::accel;
use crate::desc::{AreaLightDesc, LightDesc, LightKind, LightSamplerKind, SceneDesc, ShapeDesc};
use crate::error::{Diagnostic, Error, Result, Severity, Span};
use crate::geometry::{Geometry, GeometryId, Group, Instance, Opacity, Shape, TriangleMesh, WorldBuilder};
use crate::light::{
    AreaLight, DistantLight, EmitterShape, EnvironmentLight, Light, LightId, LightSampler, Place, PointLight,
};
use crate::math::DVec3;
use crate::texture::FloatTexture;

/// What is collected while shapes and lights are gone through.
struct SceneBuilder<'a> {
    desc: &'a SceneDesc,
    spectra: SpectrumCompiler,
    textures: TextureCompiler<'a>,
    world: WorldBuilder,
    surfaces: Vec<Surface>,
    lights: Vec<Light>,
    environments: Vec<LightId>,
    problems: Vec<Diagnostic>,
}

impl Scene {
    /// Builds a scene and its backend, in the rayon pool of the caller.
    ///
    /// # Errors
    /// [`Error::Scene`] for what the description asks and cannot be had, [`Error::Backend`] if the backend fails.
    pub fn build(desc: &SceneDesc, options: &SceneOptions) -> Result<Self> {
        let spectra = SpectrumCompiler { mode: options.color };
        let mut builder = SceneBuilder {
            desc,
            spectra,
            textures: TextureCompiler::new(desc, spectra),
            world: WorldBuilder::default(),
            surfaces: Vec::new(),
            lights: Vec::new(),
            environments: Vec::new(),
            problems: Vec::new(),
        };
        builder.add_shapes();
        builder.add_objects();
        desc.lights.iter().for_each(|light| builder.add_light(light));
        if !builder.problems.is_empty() {
            return Err(Error::Scene(builder.problems));
        }
        let materials = compile_materials(&desc.materials, &mut builder.textures);
        let world = Arc::new(builder.world.build()?);
        let bounds = world.bounds();
        let start = Instant::now();
        let accel = accel::build(options.backend, &world, &options.build)?;
        let build_seconds = start.elapsed().as_secs_f64();
        let light_sampler = match desc.integrator.light_sampler {
            LightSamplerKind::Bvh => LightSampler::bvh(&builder.lights, &bounds),
            LightSamplerKind::Power => LightSampler::power(&builder.lights, &bounds),
            LightSamplerKind::Uniform => LightSampler::uniform(&builder.lights),
        };
        Ok(Self {
            world,
            accel,
            color: options.color,
            bounds,
            materials,
            has_cutouts: builder.surfaces.iter().any(|surface| surface.alpha.is_some()),
            surfaces: builder.surfaces,
            lights: builder.lights,
            environments: builder.environments,
            light_sampler,
            build_seconds,
        })
    }
}

impl SceneBuilder<'_> {
    fn problem(&mut self, span: Span, message: impl Into<String>) {
        self.problems
            .push(self.desc.sources.diagnostic(Severity::Error, span, message.into()));
    }

    fn add_shapes(&mut self) {
        for shape in &self.desc.shapes {
            if let Some((id, motion)) = self.add_shape(shape) {
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
        let mut placed = match place(shape) {
            Ok(placed) => placed,
            Err(message) => {
                self.problem(shape.span, message);
                return None;
            }
        };
        let lights = match &shape.area_light {
            None => Vec::new(),
            Some(area_light) => self.add_area_lights(area_light, &placed.geometry, placed.motion.is_some()),
        };
        let alpha = self.textures.float(&shape.alpha);
        let alpha = match alpha {
            FloatTexture::Constant(alpha) if alpha >= 1.0 => None,
            alpha => Some(alpha),
        };
        if alpha.is_some() {
            placed.geometry.opacity = Opacity::Filtered;
        }
        if let (Some(alpha), true) = (&alpha, shape.area_light.is_some()) {
            self.see_through(shape.span, alpha, &lights);
        }
        let id = self.world.add_geometry(placed.geometry);
        self.surfaces.push(Surface {
            material: shape.material.0,
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

    /// Makes lights send what their shape's alpha leaves of it.
    fn see_through(&mut self, span: Span, alpha: &FloatTexture, lights: &[Option<LightId>]) {
        let FloatTexture::Constant(alpha) = *alpha else {
            let message = "an area light on a shape whose `alpha` is a texture is not supported yet";
            return self.problem(span, message);
        };
        for light in lights.iter().flatten() {
            if let Light::Area(light) = &mut self.lights[light.index()] {
                light.see_through(alpha);
            }
        }
    }

    /// One light for each primitive that has an area.
    fn add_area_lights(&mut self, desc: &AreaLightDesc, geometry: &Geometry, moves: bool) -> Vec<Option<LightId>> {
        let emitters = match &geometry.shape {
            _ if moves => Err("an area light on a moving shape is not supported yet"),
            Shape::Mesh(mesh) => triangle_emitters(mesh),
            Shape::Spheres(spheres) => spheres
                .iter()
                .map(|sphere| {
                    let scale = uniform_scale(&sphere.world_from_object().matrix3);
                    let radius = sphere.radius() * scale.ok_or("an area light on an ellipsoid is not supported")?;
                    Ok(EmitterShape::Sphere {
                        center: sphere.center(),
                        radius,
                        inward: sphere.has_flipped_normal(),
                    })
                })
                .collect(),
        };
        let emitters = match emitters {
            Ok(emitters) => emitters,
            Err(message) => {
                self.problem(desc.span, message);
                return Vec::new();
            }
        };
        let radiance = self.spectra.emission(desc.l.as_ref());
        let add = |emitter| {
            let light = AreaLight::new(emitter, radiance.scaled(desc.scale), desc.two_sided)?;
            // As in pbrt-v4 the power is that of each light: of one triangle.
            let light = match desc.power {
                Some(power) => {
                    let geometric = light.sides() * std::f32::consts::PI * light.area();
                    light.scaled(power / geometric)
                }
                None => light,
            };
            self.lights.push(Light::Area(light));
            Some(LightId(self.lights.len() as u32 - 1))
        };
        emitters.into_iter().map(add).collect()
    }

    fn add_light(&mut self, desc: &LightDesc) {
        if !desc.world_from_light.is_static() {
            self.problem(desc.span, "a moving light is not supported yet");
            return;
        }
        let world_from_light = desc.world_from_light.start;
        // pbrt-v4: a photometric value replaces the luminance, the scale stays a factor.
        let scale = |geometric: f32| desc.scale * desc.photometric.map_or(1.0, |value| value / geometric);
        let spectrum = self.spectra.emission(desc.spectrum.as_ref());
        let pi = std::f32::consts::PI;
        let light = match desc.kind {
            LightKind::Point { from } => {
                let position = world_from_light.transform_point3(from).as_vec3();
                Light::Point(PointLight::new(
                    Place::at_point(position),
                    spectrum.scaled(scale(4.0 * pi)),
                ))
            }
            LightKind::Distant { from, to } => {
                let towards = world_from_light.transform_vector3(from - to).normalize();
                Light::Distant(DistantLight::new(
                    Place::facing(DVec3::ZERO, towards),
                    spectrum.scaled(scale(1.0)),
                ))
            }
            LightKind::Infinite => {
                self.environments.push(LightId(self.lights.len() as u32));
                Light::Environment(EnvironmentLight::Constant(spectrum.scaled(scale(pi))))
            }
        };
        self.lights.push(light);
    }
}

fn triangle_emitters(mesh: &TriangleMesh) -> Result<Vec<EmitterShape>, &'static str> {
    if mesh.is_moving() {
        return Err("an area light on a moving mesh is not supported yet");
    }
    Ok((0..mesh.triangle_count())
        .map(|triangle| EmitterShape::Triangle {
            vertices: mesh.triangle(triangle, 0.0),
            ng: mesh.geometric_normal(triangle),
        })
        .collect())
}

/// The factor of a rotation with uniform scale; `None` for any other matrix.
fn uniform_scale(m: &crate::math::DMat3) -> Option<f64> {
    let lengths = DVec3::new(m.x_axis.length(), m.y_axis.length(), m.z_axis.length());
    let scale = lengths.x;
    let orthogonal = [m.x_axis.dot(m.y_axis), m.y_axis.dot(m.z_axis), m.z_axis.dot(m.x_axis)];
    let uniform = (lengths - DVec3::splat(scale)).abs().max_element() <= 1e-6 * scale;
    (uniform && orthogonal.iter().all(|d| d.abs() <= 1e-6 * scale * scale)).then_some(scale)
}
