//! What the world consists of, before names are resolved and mesh files read.

use std::collections::HashMap;
use std::sync::Arc;

use super::medium::Media;
use super::shape::{PendingMeshes, RawKind};
use crate::desc::{
    AreaLightDesc, LightDesc, MaterialDesc, MaterialKind, MediumInterfaceDesc, MotionDesc, SpectrumDesc, SpectrumValue,
    Textured,
};
use crate::error::Span;

/// The world so far.
#[derive(Debug, Default)]
pub(super) struct World {
    pub materials: Materials,
    pub media: Media,
    pub shapes: Vec<RawShape>,
    pub objects: Vec<RawObject>,
    pub instances: Vec<RawInstance>,
    pub lights: Vec<LightDesc>,
    pub meshes: PendingMeshes,
    object_names: HashMap<String, usize>,
    /// The object between `ObjectBegin` and `ObjectEnd`.
    current: Option<usize>,
}

/// A shape whose material is a slot and whose mesh may yet have to be read.
#[derive(Debug)]
pub(super) struct RawShape {
    pub span: Span,
    pub kind: RawKind,
    pub world_from_object: MotionDesc,
    pub reverse_orientation: bool,
    pub material: usize,
    pub media: MediumInterfaceDesc,
    pub alpha: Textured<f32>,
    pub area_light: Option<Arc<AreaLightDesc>>,
}

/// A group of shapes.
#[derive(Debug)]
pub(super) struct RawObject {
    pub name: String,
    pub span: Span,
    pub shapes: Vec<RawShape>,
}

/// An instance of an object that may be defined later.
#[derive(Debug)]
pub(super) struct RawInstance {
    pub name: String,
    pub span: Span,
    pub world_from_instance: MotionDesc,
}

impl World {
    /// Whether shapes now go into an object.
    pub fn is_in_object(&self) -> bool {
        self.current.is_some()
    }

    /// Begins an object; what is wrong with that, if anything is: then its shapes go to nobody's harm into whatever is begun.
    pub fn begin_object(&mut self, name: String, span: Span) -> Option<String> {
        if self.current.is_some() {
            return Some("`ObjectBegin` is not allowed between `ObjectBegin` and `ObjectEnd`".to_owned());
        }
        let index = self.objects.len();
        let taken = self.object_names.contains_key(&name);
        let problem = taken.then(|| format!("there is an object `{name}` already"));
        if !taken {
            self.object_names.insert(name.clone(), index);
        }
        self.objects.push(RawObject {
            name,
            span,
            shapes: Vec::new(),
        });
        self.current = Some(index);
        problem
    }

    /// Ends the object that is begun.
    pub fn end_object(&mut self) {
        self.current = None;
    }

    /// The index of an object.
    pub fn object(&self, name: &str) -> Option<usize> {
        self.object_names.get(name).copied()
    }

    /// The names of all objects.
    pub fn object_names(&self) -> Vec<&str> {
        self.objects.iter().map(|o| o.name.as_str()).collect()
    }

    /// Adds a shape, to the object that is begun if one is.
    pub fn add_shape(&mut self, shape: RawShape) {
        match self.current {
            Some(index) => self.objects[index].shapes.push(shape),
            None => self.shapes.push(shape),
        }
    }
}

/// Materials in slots: a name gets its slot when it is first mentioned, which may be before its definition.
#[derive(Debug)]
pub(super) struct Materials {
    slots: Vec<Slot>,
    names: HashMap<String, usize>,
}

/// What a slot holds.
#[derive(Debug)]
pub(super) enum Slot {
    /// A material.
    Defined(Box<MaterialDesc>),
    /// Nothing yet; where the name was first used.
    Undefined { name: String, span: Span },
}

impl Default for Materials {
    /// With pbrt's default material in slot 0.
    fn default() -> Self {
        let span = Span::default();
        Self {
            slots: vec![Slot::Defined(Box::new(default_material(span)))],
            names: HashMap::new(),
        }
    }
}

/// Diffuse with a reflectance of 0.5.
pub(super) fn default_material(span: Span) -> MaterialDesc {
    let reflectance = Textured::Value(SpectrumDesc {
        value: SpectrumValue::Constant(0.5),
        span,
    });
    MaterialDesc {
        name: None,
        relief: None,
        kind: MaterialKind::Diffuse {
            reflectance,
            roughness: Textured::Value(0.0),
        },
        span,
    }
}

impl Materials {
    /// Adds a material; its slot.
    pub fn add(&mut self, material: MaterialDesc) -> usize {
        self.slots.push(Slot::Defined(Box::new(material)));
        self.slots.len() - 1
    }

    /// The slot of a name used at `span`.
    pub fn named(&mut self, name: String, span: Span) -> usize {
        let slots = &mut self.slots;
        *self.names.entry(name).or_insert_with_key(|name| {
            let name = name.clone();
            slots.push(Slot::Undefined { name, span });
            slots.len() - 1
        })
    }

    /// Whether a name is defined.
    pub fn is_defined(&self, name: &str) -> bool {
        let index = self.names.get(name);
        index.is_some_and(|&index| !matches!(self.slots[index], Slot::Undefined { .. }))
    }

    /// Defines a name; what uses it from here on means this material.
    pub fn define(&mut self, name: String, span: Span, material: MaterialDesc) {
        if self.is_defined(&name) {
            self.names.remove(&name);
        }
        let index = self.named(name.clone(), span);
        self.slots[index] = Slot::Defined(Box::new(MaterialDesc {
            name: Some(name),
            ..material
        }));
    }

    /// All slots.
    pub fn into_slots(self) -> Vec<Slot> {
        self.slots
    }
}
