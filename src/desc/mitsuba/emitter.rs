//! Emitters: those of shapes, and those that stand alone.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use super::graph::{Object, Property};
use super::light_image;
use super::loader::Loader;
use super::props::Props;
use crate::desc::{AreaLightDesc, AreaSpread, LightDesc, LightKind, MotionDesc, SpectrumDesc, SpotFalloff};
use crate::error::Error;
use crate::image_io::{self, Encoding, Image};

impl<'g> Loader<'g> {
    /// The emitter of a shape.
    pub fn area_light(&mut self, object: &'g Object) -> Option<AreaLightDesc> {
        let mut props = Props::new(object);
        let spread = match object.plugin.as_str() {
            "area" => AreaSpread::Diffuse,
            "directionalarea" => AreaSpread::Normal,
            other => {
                let message =
                    format!("an emitter of a shape is of the type `area` or `directionalarea`, not `{other}`");
                props.error(object.span, message);
                props.objects(|_| true);
                props.finish(self.report());
                return None;
            }
        };
        let radiance = props.take("radiance");
        props.ignore(&["sampling_weight"]);
        self.medium_inside(&mut props);
        let image = self.light_image(&mut props, radiance);
        let light = match image {
            Some(image) => image.map(|image| (None, Some(Arc::new(light_image::smooth(&image))), 1.0)),
            None => self
                .emission(radiance, object.span)
                .map(|(l, scale)| (Some(l), None, scale)),
        };
        props.finish(self.report());
        let (l, image, scale) = light?;
        Some(AreaLightDesc {
            span: object.span,
            l,
            image,
            scale,
            power: None,
            two_sided: false,
            spread,
        })
    }

    /// An emitter that stands alone.
    pub fn emitter(&mut self, object: &'g Object) {
        let mut props = Props::new(object);
        props.ignore(&["sampling_weight"]);
        let light = match object.plugin.as_str() {
            "point" => self.point(&mut props),
            "spot" => self.spot(&mut props),
            "directional" => self.directional(&mut props),
            "constant" => {
                let radiance = props.take("radiance");
                let kind = LightKind::Infinite {
                    image: None,
                    portal: None,
                };
                self.light(radiance, kind, DAffine3::IDENTITY, &props)
            }
            "envmap" => self.environment(&mut props),
            "projector" => self.projector(&mut props),
            "area" | "directionalarea" => {
                let message = format!(
                    "an emitter of the type `{}` is inside the shape that emits",
                    object.plugin
                );
                props.error(object.span, message);
                props.objects(|_| true);
                None
            }
            _ => {
                self.refuse(object, "it is left out");
                props.objects(|_| true);
                None
            }
        };
        // Paths from the camera know what is around a light when they come there.
        self.medium_inside(&mut props);
        props.finish(self.report());
        self.lights.extend(light);
    }

    fn light(
        &mut self,
        property: Option<&'g Property>,
        kind: LightKind,
        world_from_light: DAffine3,
        props: &Props<'g>,
    ) -> Option<LightDesc> {
        let (spectrum, scale) = self.emission(property, props.object.span)?;
        Some(light_desc(props, kind, Some(spectrum), scale, world_from_light))
    }

    fn point(&mut self, props: &mut Props<'g>) -> Option<LightDesc> {
        let to_world = props.transform("to_world");
        let position = props.vector("position");
        if position.is_some() && props.has("to_world") {
            props.error(
                props.span_of("position"),
                "`position` and `to_world` exclude each other",
            );
        }
        let from = position.unwrap_or(to_world.translation);
        let intensity = props.take("intensity");
        self.light(intensity, LightKind::Point { from }, DAffine3::IDENTITY, props)
    }

    fn spot(&mut self, props: &mut Props<'g>) -> Option<LightDesc> {
        let to_world = props.transform("to_world");
        let intensity = props.take("intensity");
        let in_range = |v: f64| v > 0.0 && v <= 180.0;
        let angle = props.float_in("cutoff_angle", 20.0, "an angle in (0, 180] degrees", in_range);
        let range = "an angle from 0 to `cutoff_angle`";
        let beam = props.float_in("beam_width", 0.75 * angle, range, |v| (0.0..=angle).contains(&v));
        if let Some(texture) = props.take("texture") {
            props.unsupported(
                texture.span,
                "the `texture` of a spot is not supported",
                "it is ignored",
            );
        }
        let kind = LightKind::Spot {
            from: DVec3::ZERO,
            to: DVec3::Z,
            angle,
            delta: angle - beam,
            falloff: SpotFalloff::Linear,
        };
        self.light(intensity, kind, to_world, props)
    }

    fn directional(&mut self, props: &mut Props<'g>) -> Option<LightDesc> {
        let to_world = props.transform("to_world");
        let direction = props.vector("direction");
        if direction.is_some() && props.has("to_world") {
            props.error(
                props.span_of("direction"),
                "`direction` and `to_world` exclude each other",
            );
        }
        let to = direction.unwrap_or(to_world.transform_vector3(DVec3::Z));
        let to = to.try_normalize().unwrap_or_else(|| {
            props.error(props.span_of("direction"), "`direction` must not be zero");
            DVec3::Z
        });
        let irradiance = props.take("irradiance");
        let from = DVec3::ZERO;
        self.light(irradiance, LightKind::Distant { from, to }, DAffine3::IDENTITY, props)
    }

    fn environment(&mut self, props: &mut Props<'g>) -> Option<LightDesc> {
        let to_world = props.transform("to_world");
        let scale = props.float_in("scale", 1.0, "not negative", |v| v >= 0.0);
        let Some(name) = props.string("filename") else {
            if !props.has("filename") {
                props.error(
                    props.object.span,
                    "this `envmap` has no `<string name=\"filename\" .../>`",
                );
            }
            return None;
        };
        let image = self.read_light_image(props, name, Encoding::Srgb)?;
        props.ignore(&["mis_compensation"]);
        let image = Arc::new(light_image::environment(&image));
        // Mitsuba's pole is +y, and the left edge of the picture is at -z; pbrt's are +z and +x.
        let turn = DMat3::from_cols(DVec3::NEG_Z, DVec3::X, DVec3::Y);
        let kind = LightKind::Infinite {
            image: Some(image),
            portal: None,
        };
        let to_world = to_world * DAffine3::from_mat3(turn);
        Some(light_desc(props, kind, None, scale as f32, to_world))
    }

    fn projector(&mut self, props: &mut Props<'g>) -> Option<LightDesc> {
        let to_world = props.transform("to_world");
        let scale = props.float_in("scale", 1.0, "not negative", |v| v >= 0.0);
        let irradiance = props.take("irradiance");
        let image = self.light_image(props, irradiance);
        let Some(image) = image else {
            let fov = super::camera::field_of_view(props, 1.0);
            let message = "a `projector` whose `irradiance` is no `bitmap` is not supported";
            props.unsupported(props.span_of("irradiance"), message, "it is left out");
            return fov.and(None);
        };
        let aspect = image
            .as_ref()
            .map_or(1.0, |image| image.width() as f64 / image.height() as f64);
        let x_fov = super::camera::field_of_view(props, aspect)?;
        let half_width = (0.5 * x_fov.to_radians()).tan();
        // The angle of the shorter side.
        let half = half_width / aspect.max(1.0);
        let half_size = [half_width, half_width / aspect];
        let kind = LightKind::Projection {
            image: Arc::new(light_image::projected(image.as_deref()?, half_size)),
            fov: (2.0 * half.atan()).to_degrees(),
        };
        // To the left is +x.
        let to_world = to_world * DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
        Some(light_desc(props, kind, None, scale as f32, to_world))
    }

    /// The image that a spectrum of a light is, if it is a `bitmap`: inside, none if it is wrong, which is said.
    #[expect(clippy::option_option, reason = "whether it is an image, and which")]
    fn light_image(&mut self, props: &mut Props<'g>, property: Option<&'g Property>) -> Option<Option<Arc<Image>>> {
        let property = property?;
        let (_, object) = self.texture_of(property)?;
        if object.plugin != "bitmap" {
            let message = format!(
                "a light whose emission is the texture `{}` is not supported",
                object.plugin
            );
            props.unsupported(object.span, message, "it is left out");
            return Some(None);
        }
        let mut bitmap = Props::new(object);
        let raw = bitmap.boolean("raw", false);
        let name = bitmap.string("filename");
        bitmap.ignore(&["accel", "format", "filter_type", "wrap_mode"]);
        if bitmap.has("to_uv") {
            bitmap.take("to_uv");
            bitmap.unsupported(
                object.span,
                "`to_uv` of a light's image is not supported",
                "it is ignored",
            );
        }
        let encoding = if raw { Encoding::Linear } else { Encoding::Srgb };
        let image = match name {
            Some(name) => self.read_light_image(&mut bitmap, name, encoding),
            None => {
                bitmap.error(object.span, "this `bitmap` has no `<string name=\"filename\" .../>`");
                None
            }
        };
        bitmap.finish(self.report());
        Some(image)
    }

    fn read_light_image(&mut self, props: &mut Props<'g>, name: &str, encoding: Encoding) -> Option<Arc<Image>> {
        let path = self.xml.resolve(name);
        let span = props.span_of("filename");
        let read = std::fs::read(&path).map_err(|e| format!("cannot read {}: {e}", path.display()));
        let image = read.and_then(|bytes| {
            self.xml.count(&bytes);
            image_io::decode(&bytes, &path, encoding).map_err(|e| match e {
                Error::Image { message, .. } => format!("cannot read the image {}: {message}", path.display()),
                other => other.to_string(),
            })
        });
        let checked = image.and_then(|image| match image.to_rgb() {
            None => Err("the image has neither the channels R, G and B nor Y".to_owned()),
            Some(rgb) if rgb.iter().flatten().any(|c| !c.is_finite()) => {
                Err("the image has a value that is not finite".to_owned())
            }
            Some(_) => Ok(Arc::new(image)),
        });
        match checked {
            Ok(image) => Some(image),
            Err(problem) => {
                props.error(span, problem);
                None
            }
        }
    }
}

fn light_desc(
    props: &Props<'_>,
    kind: LightKind,
    spectrum: Option<SpectrumDesc>,
    scale: f32,
    world_from_light: DAffine3,
) -> LightDesc {
    LightDesc {
        span: props.object.span,
        kind,
        spectrum,
        scale,
        photometric: None,
        world_from_light: MotionDesc::fixed(world_from_light),
    }
}
