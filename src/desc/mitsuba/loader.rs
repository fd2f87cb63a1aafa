//! What the translators of plugins share, and the scene as a whole.

use std::collections::HashMap;

use super::bsdf::{Scattering, Surface};
use super::graph::{Graph, Object, ObjectIndex, Property, Value};
use super::mesh::Meshes;
use super::plugins::{self, Class};
use super::props::Props;
use super::xml::XmlReader;
use crate::desc::images::{self, PendingImages};
use crate::desc::report::Report;
use crate::desc::{
    ImageDesc, InstanceDesc, IntegratorDesc, LightDesc, MaterialDesc, MaterialId, MaterialKind, MediumDesc, MediumId,
    ObjectDesc, ObjectId, SceneDesc, ShapeDesc, SpectrumDesc, SpectrumValue, TextureDesc, TextureId, Textured,
    ViewDesc,
};
use crate::error::{Error, Result, Span};

/// A scene in the making.
pub(super) struct Loader<'g> {
    pub graph: &'g Graph,
    pub xml: XmlReader,
    pub materials: Vec<MaterialDesc>,
    /// The bsdfs that have been translated, as they are inside a `twosided`.
    pub scattering: HashMap<ObjectIndex, Option<Scattering>>,
    /// Materials that are black from behind, by what they are in front.
    pub one_sided: HashMap<MaterialId, MaterialId>,
    pub textures: Vec<TextureDesc>,
    /// Textures that have been translated, by whether they are of spectra.
    pub texture_ids: HashMap<(ObjectIndex, bool), TextureId>,
    pub images: PendingImages,
    pub media: Vec<MediumDesc>,
    /// Media that have been translated; none for those that nothing sees.
    pub media_ids: HashMap<ObjectIndex, Option<MediumId>>,
    pub meshes: Meshes,
    pub shapes: Vec<ShapeDesc>,
    pub objects: Vec<ObjectDesc>,
    /// By the `shapegroup`.
    pub groups: HashMap<ObjectIndex, ObjectId>,
    pub instances: Vec<InstanceDesc>,
    pub lights: Vec<LightDesc>,
    pub views: Vec<ViewDesc>,
    integrator: Option<IntegratorDesc>,
    /// The bsdf of shapes that have none, and of such shapes that emit.
    pub default_surfaces: [Option<Surface>; 2],
    /// The material of shapes that are boundaries between media only.
    pub boundary: Option<MaterialId>,
}

impl<'g> Loader<'g> {
    pub fn new(graph: &'g Graph, mut xml: XmlReader) -> Self {
        let span = graph.objects[0].span;
        let meshes = Meshes::new(graph, &mut xml);
        Self {
            graph,
            xml,
            materials: vec![grey(0.5, span)],
            scattering: HashMap::new(),
            one_sided: HashMap::new(),
            textures: Vec::new(),
            texture_ids: HashMap::new(),
            images: PendingImages::default(),
            media: Vec::new(),
            media_ids: HashMap::new(),
            meshes,
            shapes: Vec::new(),
            objects: Vec::new(),
            groups: HashMap::new(),
            instances: Vec::new(),
            lights: Vec::new(),
            views: Vec::new(),
            integrator: None,
            default_surfaces: [None, None],
            boundary: None,
        }
    }

    pub fn report(&mut self) -> &mut Report {
        &mut self.xml.report
    }

    /// The object that a property is, if it is one of a class.
    pub fn object_of(&self, property: &Property, class: Class) -> Option<(ObjectIndex, &'g Object)> {
        match property.value {
            Value::Object(index) if self.graph.object(index).class == class => Some((index, self.graph.object(index))),
            _ => None,
        }
    }

    /// All objects of a class among the properties of another.
    pub fn children(&self, props: &mut Props<'g>, class: Class) -> Vec<(ObjectIndex, &'g Object)> {
        let graph = self.graph;
        let of_class = |property: &Property| match property.value {
            Value::Object(index) => graph.object(index).class == class,
            _ => false,
        };
        let found = props.objects(of_class);
        found
            .into_iter()
            .filter_map(|property| self.object_of(property, class))
            .collect()
    }

    /// The one object of a class among the properties of another, if there is any; several are an error.
    pub fn child(&self, props: &mut Props<'g>, class: Class) -> Option<(ObjectIndex, &'g Object)> {
        let children = self.children(props, class);
        for (_, object) in children.iter().skip(1) {
            props.error(object.span, format!("only one {} is possible here", class.name()));
        }
        children.into_iter().next()
    }

    /// Says that an object is of a type that is not supported.
    pub fn refuse(&mut self, object: &Object, instead: &str) {
        plugins::refuse(&mut self.xml.report, object.class, &object.plugin, object.span, instead);
    }

    /// Adds a material without a name.
    pub fn add_material(&mut self, kind: MaterialKind, span: Span) -> MaterialId {
        self.materials.push(MaterialDesc {
            name: None,
            kind,
            relief: None,
            span,
        });
        MaterialId(self.materials.len() as u32 - 1)
    }

    /// Translates everything.
    ///
    /// # Errors
    /// [`Error::Scene`] if anything was wrong.
    pub fn scene(mut self) -> Result<SceneDesc> {
        let root = &self.graph.objects[0];
        let mut sensors = Vec::new();
        for property in &root.properties {
            let Value::Object(index) = property.value else {
                let message = format!("the scene has no property `{}`", property.name);
                self.report().error(property.span, message);
                continue;
            };
            let object = self.graph.object(index);
            match object.class {
                Class::Shape => self.shape(index, object),
                Class::Emitter => self.emitter(object),
                Class::Sensor => sensors.push(object),
                Class::Integrator => self.add_integrator(object),
                // Others are there to be referred to.
                _ => {}
            }
            if self.report().is_full() {
                break;
            }
        }
        for (number, sensor) in sensors.iter().enumerate() {
            self.sensor(sensor, number, sensors.len());
        }
        if sensors.is_empty() {
            self.xml.report.error(root.span, "this scene has no <sensor>");
        }
        let images = self.read_images();
        if self.xml.report.has_errors() {
            return Err(Error::Scene(self.xml.report.into_errors()));
        }
        let integrator = self.integrator.unwrap_or_else(super::integrator::default);
        let hash = self.xml.hasher.finalize().to_hex().to_string();
        let (sources, warnings) = self.xml.report.into_sources_and_warnings();
        Ok(SceneDesc {
            sources,
            views: self.views,
            integrator,
            materials: self.materials,
            textures: self.textures,
            images,
            shapes: self.shapes,
            objects: self.objects,
            instances: self.instances,
            lights: self.lights,
            media: self.media,
            transform_times: [0.0, 1.0],
            warnings,
            hash,
        })
    }

    fn add_integrator(&mut self, object: &'g Object) {
        if self.integrator.is_some() {
            self.report().error(object.span, "a scene has one integrator only");
        }
        self.integrator = Some(super::integrator::read(self, object));
    }

    fn read_images(&mut self) -> Vec<ImageDesc> {
        let hasher = &mut self.xml.hasher;
        images::read(&self.images, &mut self.xml.report, |hash| {
            hasher.update(hash.as_bytes());
        })
    }
}

/// A diffuse material that reflects so much.
pub(super) fn grey(reflectance: f32, span: Span) -> MaterialDesc {
    MaterialDesc {
        name: None,
        kind: MaterialKind::Diffuse {
            reflectance: constant(reflectance, span),
            roughness: Textured::Value(0.0),
        },
        relief: None,
        span,
    }
}

/// A spectrum that is the same everywhere.
pub(super) fn constant(value: f32, span: Span) -> Textured<SpectrumDesc> {
    Textured::Value(SpectrumDesc {
        value: SpectrumValue::Constant(value),
        span,
    })
}
