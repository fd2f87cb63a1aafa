//! Lights of a description to lights of a scene.

use std::f32::consts::PI;
use std::sync::Arc;

use super::shapes::animated;
use super::spectra::SpectrumCompiler;
use crate::desc::{AreaLightDesc, LightDesc, LightKind, color_space_of};
use crate::geometry::{Geometry, Shape, TriangleMesh};
use crate::image_io::Image;
use crate::light::{
    AreaLight, Behind, Coordinates, DistantLight, EmissionImage, EmitterShape, EnvironmentLight, GoniometricLight,
    ImageEnvironment, Light, LightId, MovingEmitter, PatchEmitter, Place, PointLight, Portal, PortalEnvironment,
    ProjectionLight, Side, SpotLight, facing,
};
use crate::math::{AnimatedTransform, DAffine3, DMat3, DVec3, Vec2, Vec3};
use crate::sampling::{Cell, SphereMap};
use crate::spectrum::{ColorMode, ColorSpace, CompiledSpectrum, RgbEmission};
use crate::texture::FloatTexture;

/// The lights so far.
pub(super) struct LightBuilder {
    spectra: SpectrumCompiler,
    mode: ColorMode,
    pub lights: Vec<Light>,
    /// Those that a ray meets when it leaves the scene.
    pub environments: Vec<LightId>,
}

/// What an image of emission says, row by row.
struct Pixels {
    rgb: Vec<[f32; 3]>,
    size: [usize; 2],
    space: ColorSpace,
}

impl Pixels {
    fn of(image: &Image) -> Result<Self, String> {
        Ok(Self {
            rgb: image.to_rgb().ok_or("the image has no colour")?,
            size: [image.width(), image.height()],
            space: color_space_of(image),
        })
    }

    /// Between the middles of the pixels, at a point of the unit square.
    fn bilinear(&self, map: SphereMap, point: Vec2) -> [f32; 3] {
        let at = [0, 1].map(|i| point[i] * self.size[i] as f32 - 0.5);
        let first = at.map(f32::floor);
        let [fx, fy] = [at[0] - first[0], at[1] - first[1]];
        let pixel = |dx: i64, dy: i64| {
            let [x, y] = map.wrap([first[0] as i64 + dx, first[1] as i64 + dy], self.size);
            Vec3::from(self.rgb[y * self.size[0] + x])
        };
        let row = |dy: i64| pixel(0, dy).lerp(pixel(1, dy), fx);
        row(0).lerp(row(1), fy).into()
    }
}

impl LightBuilder {
    pub fn new(mode: ColorMode) -> Self {
        Self {
            spectra: SpectrumCompiler { mode },
            mode,
            lights: Vec::new(),
            environments: Vec::new(),
        }
    }

    fn push(&mut self, light: Light) -> LightId {
        self.lights.push(light);
        LightId(self.lights.len() as u32 - 1)
    }

    fn image(&self, pixels: &Pixels) -> Result<EmissionImage, String> {
        let image = EmissionImage::new(
            &pixels.rgb,
            pixels.size[0],
            RgbEmission::in_space(self.mode, pixels.space),
        );
        image.ok_or_else(|| "the image has no pixels".to_owned())
    }

    /// Adds a light that is not a shape. The error is a message for its place in the file.
    pub fn add(&mut self, desc: &LightDesc) -> Result<(), String> {
        let world_from_light = animated(&desc.world_from_light)?;
        let place = |local: DAffine3| Place::new(world_from_light.clone(), local);
        // pbrt-v4: a photometric value replaces the luminance, the scale stays a factor.
        let scale = |geometric: f32| photometric_scale(desc, geometric);
        let spectrum = self.spectra.emission(desc.spectrum.as_ref());
        let light = match &desc.kind {
            LightKind::Point { from } => {
                let place = place(DAffine3::from_translation(*from));
                Light::Point(PointLight::new(place, spectrum.scaled(scale(4.0 * PI)?)))
            }
            LightKind::Spot {
                from,
                to,
                angle,
                delta,
                falloff,
            } => {
                let [start, end] = [angle - delta, *angle].map(|a| a.to_radians() as f32);
                let spectrum = spectrum.scaled(scale(SpotLight::geometric_power(start, end))?);
                let place = place(facing(*from, (*to - *from).normalize()));
                Light::Spot(SpotLight::new(place, spectrum, start, end).with_falloff(*falloff))
            }
            LightKind::Goniometric { image } => {
                let factors: Vec<f32> = Pixels::of(image)?
                    .rgb
                    .iter()
                    .map(|pixel| pixel.iter().map(|c| c.max(0.0)).sum::<f32>() / 3.0)
                    .collect();
                let spectrum = spectrum.scaled(scale(GoniometricLight::geometric_power(&factors))?);
                // The image's pole is +y of the light.
                let swap = DAffine3::from_mat3(DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::Y));
                let light = GoniometricLight::new(place(swap), spectrum, factors);
                Light::Goniometric(light.ok_or("the image must be square")?)
            }
            LightKind::Projection { image, fov } => {
                let image = self.image(&Pixels::of(image)?)?;
                let light = ProjectionLight::new(place(DAffine3::IDENTITY), image, fov.to_radians() as f32);
                let factor = scale(light.power())?;
                Light::Projection(light.scaled(factor))
            }
            LightKind::Distant { from, to } => {
                let place = place(facing(DVec3::ZERO, (*from - *to).normalize()));
                Light::Distant(DistantLight::new(place, spectrum.scaled(scale(1.0)?)))
            }
            LightKind::Infinite { image, portal } => {
                let light = self.environment(desc, &world_from_light, &spectrum, image.as_deref(), *portal)?;
                self.environments.push(LightId(self.lights.len() as u32));
                Light::Environment(light)
            }
        };
        self.push(light);
        Ok(())
    }

    fn environment(
        &self,
        desc: &LightDesc,
        world_from_light: &AnimatedTransform,
        spectrum: &CompiledSpectrum,
        image: Option<&Image>,
        portal: Option<[DVec3; 4]>,
    ) -> Result<EnvironmentLight, String> {
        let portal = portal.map(|corners: [DVec3; 4]| {
            let portal = Portal::new(std::array::from_fn(|i| corners[i].as_vec3()));
            portal.ok_or("the portal must be a rectangle, its corners in order")
        });
        let portal = portal.transpose()?;
        let Some(image) = image else {
            let spectrum = spectrum.scaled(photometric_scale(desc, PI)?);
            return Ok(match portal {
                None => EnvironmentLight::Constant(spectrum),
                Some(portal) => {
                    EnvironmentLight::Portal(Box::new(PortalEnvironment::new(portal, Behind::Constant(spectrum))))
                }
            });
        };
        let pixels = Pixels::of(image)?;
        let [width, height] = pixels.size;
        let map = SphereMap::of_size(width, height).ok_or("the image must be square or twice as wide as high")?;
        let image = self.image(&pixels)?;
        let factor = photometric_scale(desc, upward_illuminance(&image, map))?;
        let Some(portal) = portal else {
            let place = Place::new(world_from_light.clone(), DAffine3::IDENTITY);
            let environment = ImageEnvironment::new(place, image.scaled(factor));
            let environment = environment.ok_or("the image must be square or twice as wide as high")?;
            return Ok(EnvironmentLight::Image(Box::new(environment)));
        };
        if !world_from_light.is_static() {
            return Err("a moving environment behind a portal is not supported".to_owned());
        }
        let light_from_world = world_from_light.at(0.0).matrix3.inverse().as_mat3();
        let side = width.max(height).min(width * height);
        let rgb = PortalEnvironment::rectified(&portal, side)
            .map(|w| pixels.bilinear(map, map.point((light_from_world * w).normalize())));
        let rectified = Pixels {
            rgb: rgb.collect(),
            size: [side; 2],
            space: pixels.space,
        };
        let behind = Behind::Image(self.image(&rectified)?.scaled(factor));
        Ok(EnvironmentLight::Portal(Box::new(PortalEnvironment::new(
            portal, behind,
        ))))
    }

    /// Adds the lights that a shape's primitives are, those that have an area: one for each, or for two triangles that are the halves
    /// of a parallelogram. `motion` moves the shape, rays pass it as its `alpha` says. The error is a message
    /// for the light's place in the file.
    pub fn add_area(
        &mut self,
        desc: &AreaLightDesc,
        geometry: &Geometry,
        motion: Option<&AnimatedTransform>,
        alpha: &FloatTexture,
    ) -> Result<Vec<Option<LightId>>, String> {
        if let Shape::Curves(_) | Shape::Tubes(_) = &geometry.shape {
            return Err("curves cannot be lights, as in pbrt and Mitsuba".to_owned());
        }
        let image = desc
            .image
            .as_deref()
            .map(|image| self.image(&Pixels::of(image)?).map(Arc::new))
            .transpose()?;
        // What pbrt-v4 scales a power by: the mean of the image, whatever part of it the shape shows.
        let mean = image.as_ref().map_or(1.0, |image| image.mean_luminance());
        if desc.power.is_some() && mean <= 0.0 {
            return Err("the light is black: it has no luminance to be scaled".to_owned());
        }
        let radiance = self.spectra.emission(desc.l.as_ref());
        let joins = image.is_none() && desc.power.is_none() && motion.is_none();
        let add = |lights: &mut Self, primitive| {
            let (light, coordinates) = emitter(geometry, primitive, motion, &radiance, desc.two_sided)?;
            let light = light.with_spread(desc.spread);
            let light = match &image {
                Some(image) => light.with_image(Arc::clone(image), coordinates),
                None => light,
            };
            let light = match alpha {
                FloatTexture::Constant(alpha) if *alpha >= 1.0 => light,
                FloatTexture::Constant(alpha) => light.with_alpha(*alpha),
                texture => light.with_alpha_texture(texture.clone(), coordinates),
            };
            // As in pbrt-v4 the power is that of each light: of one triangle.
            let power = desc.power.map_or(1.0, |p| p / (light.geometric_factor() * mean));
            Some(lights.push(Light::Area(light.scaled(desc.scale * power))))
        };
        let mut lights = Vec::with_capacity(geometry.primitive_count());
        while lights.len() < geometry.primitive_count() {
            let first = lights.len();
            match (parallelogram(geometry, first), alpha) {
                (Some(shape), FloatTexture::Constant(alpha)) if joins => {
                    let light = AreaLight::new(shape, radiance.clone(), desc.two_sided);
                    let adapted =
                        |light: AreaLight| light.with_spread(desc.spread).with_alpha(*alpha).scaled(desc.scale);
                    let light = light.map(adapted);
                    let id = light.map(|light| self.push(Light::Area(light)));
                    lights.extend([id; 2]);
                }
                _ => lights.push(add(self, first)),
            }
        }
        Ok(lights)
    }
}

/// A primitive as a light; `None` if it has no area.
fn emitter(
    geometry: &Geometry,
    primitive: usize,
    motion: Option<&AnimatedTransform>,
    radiance: &CompiledSpectrum,
    two_sided: bool,
) -> Option<(AreaLight, Coordinates)> {
    let radiance = radiance.clone();
    let moving = || motion.cloned().unwrap_or_else(AnimatedTransform::identity);
    match &geometry.shape {
        Shape::Mesh(mesh) => {
            let light = if motion.is_some() || mesh.is_moving() {
                AreaLight::moving(moving_triangle(mesh, primitive, moving()), radiance, two_sided)
            } else {
                AreaLight::new(triangle(mesh, primitive), radiance, two_sided)
            };
            let corners = match mesh.uvs() {
                Some(uvs) => mesh.indices()[primitive].map(|v| uvs[v as usize]),
                None => [Vec2::ZERO, Vec2::X, Vec2::ONE],
            };
            Some((light?, Coordinates::Corners(corners)))
        }
        Shape::Spheres(spheres) => {
            let sphere = &spheres[primitive];
            let light = if motion.is_some() {
                AreaLight::moving(MovingEmitter::sphere(sphere.clone(), moving()), radiance, two_sided)
            } else {
                AreaLight::sphere(sphere, radiance, two_sided)
            };
            Some((light?, Coordinates::Sphere(sphere.object_from_world().matrix3)))
        }
        Shape::Quadrics(quadrics) => {
            let quadric = quadrics[primitive].clone();
            let light = if motion.is_some() {
                AreaLight::moving(MovingEmitter::quadric(quadric, moving()), radiance, two_sided)
            } else {
                AreaLight::new(EmitterShape::Quadric(Arc::new(quadric)), radiance, two_sided)
            };
            Some((light?, Coordinates::Own))
        }
        Shape::Patches(mesh) => {
            let surface = mesh.surface(primitive);
            let light = if motion.is_some() {
                AreaLight::moving(MovingEmitter::patch(surface, moving()), radiance, two_sided)
            } else {
                let patch = Arc::new(PatchEmitter::new(surface)?);
                AreaLight::new(EmitterShape::Patch(patch), radiance, two_sided)
            };
            Some((light?, Coordinates::Own))
        }
        Shape::Curves(_) | Shape::Tubes(_) => None,
    }
}

fn triangle(mesh: &TriangleMesh, triangle: usize) -> EmitterShape {
    EmitterShape::Triangle {
        vertices: mesh.triangle(triangle, 0.0),
        ng: mesh.geometric_normal(triangle),
    }
}

/// The shape that a primitive of a mesh at rest and the next one make up, if it is a parallelogram.
fn parallelogram(geometry: &Geometry, first: usize) -> Option<EmitterShape> {
    match &geometry.shape {
        Shape::Mesh(mesh) if !mesh.is_moving() && first + 1 < mesh.triangle_count() => {
            triangle(mesh, first).joined(&triangle(mesh, first + 1))
        }
        _ => None,
    }
}

fn moving_triangle(mesh: &TriangleMesh, triangle: usize, motion: AnimatedTransform) -> MovingEmitter {
    let corners = mesh.indices()[triangle].map(|v| v as usize);
    let steps = (0..mesh.time_steps()).map(|step| corners.map(|v| mesh.positions(step)[v]));
    let side = match mesh.normals() {
        None => Side::Orientation(mesh.has_flipped_normal()),
        Some(normals) => Side::Of(corners.into_iter().map(|v| normals[v]).sum()),
    };
    MovingEmitter::triangle(steps.collect(), side, motion)
}

/// The factor that a light with a geometric factor is scaled by: power or illuminance of the light as it is, over its luminance.
fn photometric_scale(desc: &LightDesc, geometric: f32) -> Result<f32, String> {
    match desc.photometric {
        None => Ok(desc.scale),
        Some(value) if geometric > 0.0 => Ok(desc.scale * value / geometric),
        Some(_) => Err("the light is black: it has no luminance to be scaled".to_owned()),
    }
}

/// What pbrt-v4 takes for the illuminance of a surface that faces the image's pole: half of it.
fn upward_illuminance(image: &EmissionImage, map: SphereMap) -> f32 {
    let size = image.size();
    let offset = Vec2::splat(0.5);
    0.5 * image.sum(|x, y| map.direction(&Cell { x, y, offset }, size).z.max(0.0) * map.solid_angle(y, size))
}
