//! Carries out directives: keeps the graphics state and gathers what the scene consists of.

use std::collections::HashMap;
use std::sync::Arc;

use super::files::Context;
use super::options::{Options, Surroundings};
use super::params::Param;
use super::reader::ParamReader;
use super::state::{Block, GraphicsState, Saved};
use super::world::{RawInstance, RawShape, World};
use super::{light, material, medium, shape, texture, v3};
use crate::desc::{ColorSpace, MediumInterfaceDesc, MotionDesc, TextureClass, Textured};
use crate::error::Span;

pub(super) use super::options::OptionKind;

/// A scene in the making.
#[derive(Debug)]
pub(super) struct Builder {
    pub context: Context,
    pub state: GraphicsState,
    pub options: Options,
    pub world: World,
    pub(super) saved: Vec<Saved>,
    coordinate_systems: HashMap<String, MotionDesc>,
    pub(super) in_world: bool,
}

impl Builder {
    pub fn new(context: Context) -> Self {
        Self {
            context,
            state: GraphicsState::new(),
            options: Options::default(),
            world: World::default(),
            saved: Vec::new(),
            coordinate_systems: HashMap::new(),
            in_world: false,
        }
    }

    /// Whether the world has begun; if not, says that `what` must wait for it.
    pub fn expect_world(&mut self, what: &str, span: Span) -> bool {
        if !self.in_world {
            let message = format!("`{what}` is allowed only after `WorldBegin`");
            self.context.report.error(span, message);
        }
        self.in_world
    }

    fn expect_options(&mut self, what: &str, span: Span) -> bool {
        if self.in_world {
            let message = format!("`{what}` is allowed only before `WorldBegin`");
            self.context.report.error(span, message);
        }
        !self.in_world
    }

    /// `Camera`, `Film` and the like.
    pub fn option(&mut self, kind: OptionKind, mut name: String, name_span: Span, mut params: Vec<Param>, span: Span) {
        if !self.expect_options(kind.directive(), span) {
            return;
        }
        let report = &mut self.context.report;
        v3::translate(report, kind.directive(), &mut name, name_span, &mut params);
        if kind == OptionKind::Camera {
            let world_from_camera = self.state.ctm.inverse();
            self.coordinate_systems.insert("camera".to_owned(), world_from_camera);
        }
        let around = Surroundings {
            ctm: self.state.ctm,
            medium: self.state.media.exterior,
        };
        self.options
            .read(&mut self.context, kind, (&name, name_span), params, span, around);
    }

    pub fn transform_times(&mut self, start: f64, end: f64, span: Span) {
        if !self.expect_options("TransformTimes", span) {
            return;
        }
        if start < end {
            self.options.transform_times = [start, end];
        } else {
            let message = "the first of the transform times must come before the second";
            self.context.report.error(span, message);
        }
    }

    pub fn render_option(&mut self, name: &str, value: &str, span: Span) {
        super::options::render_option(&mut self.context.report, name, value, span);
    }

    pub fn world_begin(&mut self, span: Span) {
        if !self.expect_options("WorldBegin", span) {
            return;
        }
        self.in_world = true;
        self.state.ctm = MotionDesc::IDENTITY;
        self.state.active = [true; 2];
        self.coordinate_systems.insert("world".to_owned(), MotionDesc::IDENTITY);
    }

    pub fn coordinate_system(&mut self, name: String) {
        self.coordinate_systems.insert(name, self.state.ctm);
    }

    pub fn coord_sys_transform(&mut self, name: &str, span: Span) {
        if let Some(&ctm) = self.coordinate_systems.get(name) {
            self.state.ctm = ctm;
        } else {
            let known: Vec<&str> = self.coordinate_systems.keys().map(String::as_str).collect();
            let message = format!("there is no coordinate system `{name}`");
            let instead = "the current transform is kept";
            self.context.report.unknown(span, message, instead, name, &known);
        }
    }

    pub fn color_space(&mut self, name: &str, span: Span) {
        match ColorSpace::from_name(name) {
            Some(space) => {
                self.state.color_space = space;
                self.context.color_space = space;
            }
            None => {
                let known = ColorSpace::ALL.map(ColorSpace::name);
                let message = format!("unknown color space `{name}`");
                let report = &mut self.context.report;
                report.unknown(span, message, "it is ignored", name, &known);
            }
        }
    }

    pub fn attribute_begin(&mut self, span: Span) {
        if self.expect_world("AttributeBegin", span) {
            self.save(Block::Attribute, span);
        }
    }

    pub fn attribute_end(&mut self, span: Span) {
        if self.expect_world("AttributeEnd", span) {
            self.restore(Block::Attribute, "AttributeEnd", span);
        }
    }

    pub fn reverse_orientation(&mut self, span: Span) {
        if self.expect_world("ReverseOrientation", span) {
            self.state.reverse_orientation = !self.state.reverse_orientation;
        }
    }

    pub fn object_begin(&mut self, name: String, name_span: Span, span: Span) {
        if !self.expect_world("ObjectBegin", span) {
            return;
        }
        if let Some(problem) = self.world.begin_object(name, name_span) {
            self.context.report.error(name_span, problem);
        }
        self.save(Block::Object, span);
    }

    pub fn object_end(&mut self, span: Span) {
        if self.expect_world("ObjectEnd", span) {
            self.restore(Block::Object, "ObjectEnd", span);
            if !self.saved.iter().any(|s| s.why == Block::Object) {
                self.world.end_object();
            }
        }
    }

    pub fn object_instance(&mut self, name: String, span: Span) {
        if !self.expect_world("ObjectInstance", span) {
            return;
        }
        if self.world.is_in_object() {
            let message = "`ObjectInstance` is not allowed between `ObjectBegin` and `ObjectEnd`";
            self.context.report.error(span, message);
            return;
        }
        self.world.instances.push(RawInstance {
            name,
            span,
            world_from_instance: self.state.ctm,
        });
    }

    pub fn named_material(&mut self, name: String, span: Span) {
        if self.expect_world("NamedMaterial", span) {
            self.state.material = self.world.materials.named(name, span);
        }
    }

    /// `MediumInterface`: the names of the media inside and outside of the shapes to come; the empty name is the vacuum.
    pub fn medium_interface(&mut self, interior: (String, Span), exterior: (String, Span)) {
        let media = &mut self.world.media;
        self.state.media = MediumInterfaceDesc {
            interior: media.named(interior.0, interior.1),
            exterior: media.named(exterior.0, exterior.1),
        };
    }

    /// A directive with a type and parameters inside the world.
    pub fn entity(&mut self, directive: &str, mut name: String, name_span: Span, mut params: Vec<Param>, span: Span) {
        if directive != "Attribute" && directive != "MakeNamedMedium" && !self.expect_world(directive, span) {
            return;
        }
        let report = &mut self.context.report;
        if !v3::translate(report, directive, &mut name, name_span, &mut params) {
            return;
        }
        let defaults = &self.state.defaults;
        let (class, defaults) = match directive {
            "Material" => ("material", Arc::clone(&defaults.material)),
            "MakeNamedMaterial" => ("named material", Arc::clone(&defaults.material)),
            "LightSource" => ("light", Arc::clone(&defaults.light)),
            "AreaLightSource" => ("area light", Arc::clone(&defaults.light)),
            "Shape" => ("shape", Arc::clone(&defaults.shape)),
            "Attribute" => return self.set_defaults(&name, name_span, params),
            _ => ("medium", Arc::clone(&defaults.medium)),
        };
        let reader = ParamReader::new(&mut self.context, class, &name, name_span, params, &defaults);
        match directive {
            "Material" => {
                let material = material::read(reader, &mut self.world.materials, &name, None);
                self.state.material = self.world.materials.add(material);
            }
            "MakeNamedMaterial" => {
                let material = material::read_named(reader, &mut self.world.materials);
                if self.world.materials.is_defined(&name) && !self.redefine(name_span) {
                    let message = format!("there is a named material `{name}` already");
                    self.context.report.error(name_span, message);
                } else {
                    self.world.materials.define(name, name_span, material);
                }
            }
            "LightSource" => self.world.lights.extend(light::read(reader, &name, self.state.ctm)),
            "MakeNamedMedium" => {
                if let Some(problem) = self.world.media.define(medium::read(reader, name)) {
                    self.context.report.error(name_span, problem);
                }
            }
            "AreaLightSource" => self.state.area_light = light::read_area(reader, &name).map(Arc::new),
            _ => {
                if let Some((kind, alpha)) = shape::read(reader, &name, &mut self.world.meshes) {
                    self.shape(kind, alpha, name_span);
                }
            }
        }
    }

    /// `Texture`.
    pub fn texture(
        &mut self,
        (name, name_span): (String, Span),
        (class, class_span): (&str, Span),
        (mut kind, kind_span): (String, Span),
        mut params: Vec<Param>,
        span: Span,
    ) {
        if !self.expect_world("Texture", span) {
            return;
        }
        let report = &mut self.context.report;
        v3::translate(report, "Texture", &mut kind, kind_span, &mut params);
        let class = match class {
            "float" => TextureClass::Float,
            "spectrum" => TextureClass::Spectrum,
            "color" if report.is_old() => TextureClass::Spectrum,
            _ => {
                let message = format!("a texture is of the class `float` or `spectrum`, not `{class}`");
                return self.context.report.error(class_span, message);
            }
        };
        if self.context.textures.is_defined(class, &name) && !self.redefine(name_span) {
            let message = format!("there is a {} texture `{name}` already", class.name());
            return self.context.report.error(name_span, message);
        }
        if !self.state.ctm.is_static() {
            let message = "a texture does not move: the transform at the start holds";
            self.context.report.warning(span, message);
        }
        let defaults = Arc::clone(&self.state.defaults.texture);
        let what = format!("{} texture", class.name());
        let reader = ParamReader::new(&mut self.context, &what, &kind, kind_span, params, &defaults);
        texture::read(reader, name, class, &kind, self.state.ctm.start);
    }

    /// Whether a name may get another meaning, as in pbrt-v3.
    fn redefine(&mut self, span: Span) -> bool {
        let report = &mut self.context.report;
        let old = report.is_old();
        if old {
            report.translated(
                span,
                "this name is defined a second time: from here on it means this, as in pbrt-v3",
            );
        }
        old
    }

    fn shape(&mut self, kind: shape::RawKind, alpha: Textured<f32>, span: Span) {
        let in_object = self.world.is_in_object();
        let mut area_light = self.state.area_light.clone();
        if in_object && area_light.is_some() {
            let report = &mut self.context.report;
            report.unsupported(
                span,
                "lights in an object, which may have many instances, are not supported (nor are they in pbrt)",
                "this shape does not emit",
            );
            area_light = None;
        }
        self.world.add_shape(RawShape {
            span,
            kind,
            world_from_object: self.state.ctm,
            reverse_orientation: self.state.reverse_orientation,
            material: self.state.material,
            media: self.state.media,
            alpha,
            area_light,
        });
    }

    fn set_defaults(&mut self, target: &str, span: Span, params: Vec<Param>) {
        let defaults = &mut self.state.defaults;
        let (target, of_target) = match target {
            "shape" => ("shape", &mut defaults.shape),
            "light" => ("light", &mut defaults.light),
            "material" => ("material", &mut defaults.material),
            "texture" => ("texture", &mut defaults.texture),
            "medium" => ("medium", &mut defaults.medium),
            _ => {
                let known = ["shape", "light", "material", "medium", "texture"];
                let message = format!("unknown target `{target}` of `Attribute`");
                let report = &mut self.context.report;
                report.unknown(span, message, "it is ignored", target, &known);
                return;
            }
        };
        let of_target = Arc::make_mut(of_target);
        for param in params {
            let number = self.context.add_default(target, &param.name, param.span);
            of_target.retain(|p| p.name != param.name);
            of_target.push(Param {
                default: Some(number),
                color_space: Some(self.context.color_space),
                ..param
            });
        }
    }
}
