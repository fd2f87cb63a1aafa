//! From elements to objects with properties that refer to one another: a directed graph without cycles.

use std::collections::HashMap;

use super::plugins::{self, Class};
use super::transform;
use super::values::{Spectrum, number, numbers, spectrum};
use super::xml::{Attribute, Element, XmlReader};
use crate::desc::suggest;
use crate::error::Span;
use glam::{DMat4, DVec3};

/// Index into [`Graph::objects`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct ObjectIndex(pub usize);

/// All objects; the first is the scene.
#[derive(Debug, Default)]
pub(super) struct Graph {
    pub objects: Vec<Object>,
    ids: HashMap<String, usize>,
}

/// A plugin with its properties.
#[derive(Debug)]
pub(super) struct Object {
    pub class: Class,
    /// The `type`.
    pub plugin: String,
    pub id: Option<String>,
    pub properties: Vec<Property>,
    /// Of the type.
    pub span: Span,
}

impl Object {
    /// Whether it is a texture that asks a mesh for an attribute.
    pub fn is_attribute(&self) -> bool {
        self.class == Class::Texture && self.plugin == "mesh_attribute"
    }
}

/// Something that a plugin is told.
#[derive(Debug)]
pub(super) struct Property {
    /// Empty for objects without a name.
    pub name: String,
    pub value: Value,
    /// Of the element.
    pub span: Span,
}

/// What it is told.
#[derive(Debug)]
pub(super) enum Value {
    Float(f64),
    Integer(i64),
    Boolean(bool),
    String(String),
    Vector(DVec3),
    Rgb([f64; 3]),
    Spectrum(Spectrum),
    Transform(DMat4),
    Object(ObjectIndex),
    /// To the object of this id; none is left when the graph is done.
    Reference(String),
}

impl Value {
    /// As messages call it.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Float(_) => "a float",
            Self::Integer(_) => "an integer",
            Self::Boolean(_) => "a boolean",
            Self::String(_) => "a string",
            Self::Vector(_) => "a vector or point",
            Self::Rgb(_) => "an rgb color",
            Self::Spectrum(_) => "a spectrum",
            Self::Transform(_) => "a transform",
            Self::Object(_) | Self::Reference(_) => "an object",
        }
    }
}

impl Graph {
    /// The objects of a scene; problems are in the report.
    pub fn new(root: &Element, xml: &mut XmlReader) -> Self {
        let mut graph = Self::default();
        if root.tag != "scene" {
            let message = format!("this is <{}>, not a <scene>", root.tag);
            xml.report.error(root.span, message);
            return graph;
        }
        root.check(&mut xml.report, &["version"], &["id", "name", "type"]);
        if let Some(version) = root.attribute("version") {
            match parse_version(&version.value) {
                Some(numbers) => xml.version = numbers,
                None => xml
                    .report
                    .error(version.span, "this is no version; expected one like 3.0.0"),
            }
        }
        graph.objects.push(Object {
            class: Class::Scene,
            plugin: "scene".to_owned(),
            id: None,
            properties: Vec::new(),
            span: root.span,
        });
        for child in &root.children {
            graph.child(0, child, xml);
        }
        graph.resolve(xml);
        graph.refuse_cycles(xml);
        graph
    }

    /// The object of an index.
    pub fn object(&self, index: ObjectIndex) -> &Object {
        &self.objects[index.0]
    }

    /// Whether any texture asks meshes for their attributes.
    pub fn has_attributes(&self) -> bool {
        self.objects.iter().any(Object::is_attribute)
    }

    /// Adds what an element says to an object.
    fn child(&mut self, parent: usize, element: &Element, xml: &mut XmlReader) {
        let Some(class) = plugins::class_of(element) else {
            return self.property(parent, element, xml);
        };
        if !element.check(&mut xml.report, &["type"], &["id", "name"]) {
            return;
        }
        let Some(kind) = element.attribute("type") else { return };
        plugins::check(&mut xml.report, class, &kind.value, kind.span);
        let index = self.objects.len();
        self.objects.push(Object {
            class,
            plugin: kind.value.clone(),
            id: element.attribute("id").map(|id| id.value.clone()),
            properties: Vec::new(),
            span: kind.span,
        });
        if let Some(id) = element.attribute("id") {
            self.name(id, index, xml);
        }
        for child in &element.children {
            self.child(index, child, xml);
        }
        let name = element.attribute("name");
        self.add(parent, name, Value::Object(ObjectIndex(index)), element.span, xml);
    }

    fn name(&mut self, id: &Attribute, index: usize, xml: &mut XmlReader) {
        if self.ids.insert(id.value.clone(), index).is_some() {
            let message = format!("there is already an object with the id `{}`", id.value);
            xml.report.error(id.span, message);
        }
    }

    fn property(&mut self, parent: usize, element: &Element, xml: &mut XmlReader) {
        match element.tag.as_str() {
            "ref" => {
                if element.check(&mut xml.report, &["id"], &["name"])
                    && let Some(id) = element.attribute("id")
                {
                    let value = Value::Reference(id.value.clone());
                    self.add(parent, element.attribute("name"), value, id.span, xml);
                }
                return;
            }
            "alias" => {
                if element.check(&mut xml.report, &["id", "as"], &[])
                    && let (Some(id), Some(alias)) = (element.attribute("id"), element.attribute("as"))
                {
                    match self.ids.get(&id.value) {
                        Some(&index) => self.name(alias, index, xml),
                        None => self.unknown_id(&id.value, id.span, xml),
                    }
                }
                return;
            }
            "transform" => {
                if element.check(&mut xml.report, &["name"], &[])
                    && let Some(matrix) = transform::read(element, &mut xml.report)
                {
                    self.add(
                        parent,
                        element.attribute("name"),
                        Value::Transform(matrix),
                        element.span,
                        xml,
                    );
                }
                return;
            }
            _ => {}
        }
        if let Some(child) = element.children.first() {
            let message = format!("<{}> cannot be inside <{}>", child.tag, element.tag);
            xml.report.error(child.span, message);
        }
        if let Some(value) = value(element, xml) {
            self.add(parent, element.attribute("name"), value, element.span, xml);
        }
    }

    fn add(&mut self, parent: usize, name: Option<&Attribute>, value: Value, span: Span, xml: &mut XmlReader) {
        let mut text = name.map(|name| name.value.clone()).unwrap_or_default();
        if xml.version[0] < 2 {
            text = underscored(&text);
        }
        let properties = &mut self.objects[parent].properties;
        if let Some(name) = name
            && !text.is_empty()
            && properties.iter().any(|p| p.name == text)
        {
            xml.report.error(name.span, format!("`{text}` is given twice"));
            return;
        }
        properties.push(Property {
            name: text,
            value,
            span,
        });
    }

    fn unknown_id(&self, id: &str, span: Span, xml: &mut XmlReader) {
        let known: Vec<&str> = self.ids.keys().map(String::as_str).collect();
        let help = suggest::closest(id, &known).map(|id| format!("did you mean `{id}`?"));
        let message = format!("there is no object with the id `{id}`");
        xml.report.error_with_help(span, message, help);
    }

    fn resolve(&mut self, xml: &mut XmlReader) {
        let mut unknown = Vec::new();
        for object in &mut self.objects {
            for property in &mut object.properties {
                let Value::Reference(id) = &property.value else {
                    continue;
                };
                match self.ids.get(id) {
                    Some(&index) => property.value = Value::Object(ObjectIndex(index)),
                    None => unknown.push((id.clone(), property.span)),
                }
            }
        }
        for (id, span) in unknown {
            self.unknown_id(&id, span, xml);
        }
    }

    /// Complains about objects that contain themselves or are nested too deep. What is read after this may recurse.
    fn refuse_cycles(&self, xml: &mut XmlReader) {
        // Each round settles the objects of what is settled; what a cycle needs never is.
        let mut settled = vec![false; self.objects.len()];
        for _ in 0..DEEPEST {
            let now: Vec<bool> = self
                .objects
                .iter()
                .map(|object| {
                    object.properties.iter().all(|property| match property.value {
                        Value::Object(ObjectIndex(index)) => settled[index],
                        _ => true,
                    })
                })
                .collect();
            if now == settled {
                break;
            }
            settled = now;
        }
        for (object, _) in self
            .objects
            .iter()
            .zip(&settled)
            .skip(1)
            .filter(|(_, settled)| !**settled)
        {
            let message = format!("this object contains itself, or more than {DEEPEST} objects in a row");
            xml.report.error(object.span, message);
        }
    }
}

/// So many objects may contain one another.
const DEEPEST: usize = 100;

/// A value by its element.
fn value(element: &Element, xml: &mut XmlReader) -> Option<Value> {
    let report = &mut xml.report;
    let text = |attribute: &str| element.attribute(attribute);
    match element.tag.as_str() {
        "point" | "vector" => {
            if text("value").is_some() {
                element.check(report, &["name", "value"], &[]).then_some(())?;
                let values = numbers(text("value")?, &[1, 3], report)?;
                let at = |i: usize| values[i.min(values.len() - 1)];
                return Some(Value::Vector(DVec3::new(at(0), at(1), at(2))));
            }
            element.check(report, &["name", "x", "y", "z"], &[]).then_some(())?;
            let [x, y, z] = ["x", "y", "z"].map(|axis| number(element.attribute(axis)?, &mut *report));
            return Some(Value::Vector(DVec3::new(x?, y?, z?)));
        }
        "spectrum" => return spectrum(element, xml).map(Value::Spectrum),
        "float" | "integer" | "boolean" | "string" | "rgb" => {}
        tag => {
            let help = suggest::closest(tag, plugins::TAGS).map(|tag| format!("did you mean <{tag}>?"));
            let message = match tag {
                "translate" | "rotate" | "scale" | "lookat" | "lookAt" | "matrix" => {
                    format!("<{tag}> can only be inside <transform>")
                }
                "animation" => "<animation> is not supported".to_owned(),
                _ => format!("there is no element <{tag}>"),
            };
            report.error_with_help(element.span, message, help.filter(|_| !plugins::TAGS.contains(&tag)));
            return None;
        }
    }
    if !element.check(report, &["name", "value"], &[]) {
        return None;
    }
    let value = element.attribute("value")?;
    let trimmed = value.value.trim();
    match element.tag.as_str() {
        "float" => number(value, report).map(Value::Float),
        "integer" => match trimmed.parse() {
            Ok(integer) => Some(Value::Integer(integer)),
            Err(_) => {
                report.error(value.span, format!("`{trimmed}` is no integer"));
                None
            }
        },
        "boolean" => match trimmed.to_ascii_lowercase().as_str() {
            "true" => Some(Value::Boolean(true)),
            "false" => Some(Value::Boolean(false)),
            _ => {
                report.error(value.span, format!("`{trimmed}` is neither `true` nor `false`"));
                None
            }
        },
        "rgb" => {
            let values = numbers(value, &[1, 3], report)?;
            Some(Value::Rgb(std::array::from_fn(|i| values[i.min(values.len() - 1)])))
        }
        _ => Some(Value::String(value.value.clone())),
    }
}

fn parse_version(text: &str) -> Option<[u32; 3]> {
    let mut parts = text.trim().split('.').map(|part| part.parse().ok());
    let version = [parts.next()??, parts.next()??, parts.next()??];
    parts.next().is_none().then_some(version)
}

/// A name of Mitsuba 0.6, `intIOR`, as one of today, `int_ior`.
fn underscored(name: &str) -> String {
    let mut result = String::with_capacity(name.len() + 4);
    let mut before = ' ';
    let mut in_word = false;
    for c in name.chars() {
        if c.is_uppercase() && before.is_lowercase() {
            result.push('_');
            in_word = true;
        }
        in_word &= c.is_uppercase();
        if in_word {
            result.extend(c.to_lowercase());
        } else {
            result.push(c);
        }
        before = c;
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn old_names_become_new_ones() {
        for (old, new) in [
            ("intIOR", "int_ior"),
            ("toWorld", "to_world"),
            ("maxDepth", "max_depth"),
            ("alphaU", "alpha_u"),
            ("filename", "filename"),
        ] {
            assert_eq!(underscored(old), new);
        }
    }
}
