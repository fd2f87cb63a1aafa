//! The texture `mesh_attribute`, and whether meshes have what it asks for.

use std::collections::HashSet;

use super::graph::{Object, ObjectIndex, Value};
use super::loader::Loader;
use super::props::Props;
use crate::desc::{MeshAttributeDesc, ShapeKind};

/// Whether an attribute can have this name.
fn is_fit(name: &str) -> bool {
    name.starts_with("vertex_") || name.starts_with("face_")
}

impl<'g> Loader<'g> {
    /// The name and the factor of an attribute.
    pub fn mesh_attribute(&mut self, object: &'g Object) -> Option<(String, f32)> {
        let mut props = Props::new(object);
        let scale = props.float("scale").unwrap_or(1.0) as f32;
        let name = props.string("name");
        match name {
            None if !props.has("name") => {
                let message = "this `mesh_attribute` has no `<string name=\"name\" .../>`";
                props.error(object.span, message);
            }
            Some(name) if !is_fit(name) => {
                let message = format!("`{name}` is no attribute: their names begin with `vertex_` or `face_`");
                props.error(props.span_of("name"), message);
            }
            _ => {}
        }
        props.finish(self.report());
        name.filter(|name| is_fit(name)).map(|name| (name.to_owned(), scale))
    }

    /// Complains about attributes that the textures of a shape's bsdf ask for and that the shape does not have.
    pub fn check_attributes(&mut self, bsdf: ObjectIndex, shape: &Object, kind: &ShapeKind) {
        if !self.graph.has_attributes() {
            return;
        }
        let has: &[MeshAttributeDesc] = match kind {
            ShapeKind::TriangleMesh(mesh) => &mesh.attributes,
            _ => &[],
        };
        for index in self.attributes_within(bsdf) {
            let texture = self.graph.object(index);
            let name = texture.properties.iter().find(|p| p.name == "name");
            // What is wrong with a name has been said.
            let Some(Value::String(name)) = name.map(|p| &p.value) else {
                continue;
            };
            if !is_fit(name) {
                continue;
            }
            let problem = match has.iter().find(|attribute| attribute.name == *name) {
                None => {
                    let known: Vec<String> = has.iter().map(|attribute| format!("`{}`", attribute.name)).collect();
                    let known = if known.is_empty() {
                        "none".to_owned()
                    } else {
                        known.join(", ")
                    };
                    format!("this shape has no attribute `{name}`, which its bsdf asks for; it has {known}")
                }
                Some(attribute) if attribute.channels != 1 && self.texture_ids.contains_key(&(index, false)) => {
                    format!("the attribute `{name}` of this shape is a color, but its bsdf asks for a number")
                }
                Some(_) => continue,
            };
            self.report().error(shape.span, problem);
        }
    }

    /// The textures within a bsdf that ask meshes.
    fn attributes_within(&self, bsdf: ObjectIndex) -> Vec<ObjectIndex> {
        let mut seen = HashSet::from([bsdf]);
        let mut left = vec![bsdf];
        let mut found = Vec::new();
        while let Some(index) = left.pop() {
            let object = self.graph.object(index);
            if object.is_attribute() {
                found.push(index);
            }
            let inner = object.properties.iter().filter_map(|property| match property.value {
                Value::Object(inner) => Some(inner),
                _ => None,
            });
            left.extend(inner.filter(|inner| seen.insert(*inner)));
        }
        found
    }
}
