//! Further numbers of vertices and faces, by name.

use super::header::{Element, Property, Scalar};
use crate::desc::{AttributeDomain, MeshAttributeDesc};

/// Where the numbers of an attribute are in a row.
#[derive(Clone, Debug)]
pub(super) struct AttributeColumns {
    /// Without what it is an attribute of.
    name: String,
    /// One or three.
    columns: Vec<usize>,
    /// What each is divided by.
    unit: f32,
}

/// What numbers in a row are if not attributes.
const RESERVED: [&str; 14] = [
    "x",
    "y",
    "z",
    "nx",
    "ny",
    "nz",
    "u",
    "v",
    "s",
    "t",
    "texture_u",
    "texture_v",
    "texture_s",
    "texture_t",
];

/// The attributes of an element, of one number or three each.
pub(super) fn of(element: &Element) -> Vec<AttributeColumns> {
    let mut found: Vec<(AttributeColumns, Vec<u32>)> = Vec::new();
    for (column, property) in element.properties.iter().enumerate() {
        let Some((name, rank)) = name_and_rank(property) else {
            continue;
        };
        let at = found.iter().position(|(attribute, _)| attribute.name == name);
        let at = at.unwrap_or_else(|| {
            let unit = if name.ends_with("color") {
                largest(property.value)
            } else {
                1.0
            };
            let columns = Vec::new();
            found.push((AttributeColumns { name, columns, unit }, Vec::new()));
            found.len() - 1
        });
        let (attribute, ranks) = &mut found[at];
        let place = ranks.partition_point(|other| *other <= rank);
        ranks.insert(place, rank);
        attribute.columns.insert(place, column);
    }
    let mut attributes: Vec<_> = found.into_iter().map(|(attribute, _)| attribute).collect();
    attributes.retain(|attribute| matches!(attribute.columns.len(), 1 | 3));
    attributes
}

/// Which attribute a property is a part of, and which channel of a colour; of others the parts are in the order of the file.
fn name_and_rank(property: &Property) -> Option<(String, u32)> {
    if property.length.is_some() || RESERVED.contains(&property.name.as_str()) {
        return None;
    }
    let channel = |name: &str| match name {
        "r" | "red" => Some(0),
        "g" | "green" => Some(1),
        "b" | "blue" => Some(2),
        _ => None,
    };
    if let Some(rank) = channel(&property.name) {
        return Some(("color".to_owned(), rank));
    }
    match property.name.rsplit_once('_') {
        Some((stem, ending)) if !stem.is_empty() => match (channel(ending), ending) {
            (Some(rank), _) => Some((format!("{stem}_color"), rank)),
            (None, "a") => None,
            (None, _) => Some((stem.to_owned(), 0)),
        },
        _ => None,
    }
}

/// What a colour of an integer type has as its 1.
fn largest(kind: Scalar) -> f32 {
    match kind {
        Scalar::U8 => f32::from(u8::MAX),
        Scalar::U16 => f32::from(u16::MAX),
        _ => 1.0,
    }
}

impl AttributeColumns {
    /// The attribute, without values as yet.
    pub fn named(&self, of: &str, domain: AttributeDomain) -> MeshAttributeDesc {
        MeshAttributeDesc {
            name: format!("{of}_{}", self.name),
            domain,
            channels: self.columns.len(),
            values: Vec::new(),
        }
    }

    /// The numbers of a row.
    #[inline]
    pub fn values(&self, at: impl Fn(usize) -> f32) -> impl Iterator<Item = f32> {
        self.columns.iter().map(move |&column| at(column) / self.unit)
    }
}

/// Adds the numbers of a row to each attribute.
pub(super) fn push(attributes: &mut [MeshAttributeDesc], columns: &[AttributeColumns], at: impl Fn(usize) -> f32) {
    for (attribute, columns) in attributes.iter_mut().zip(columns) {
        attribute.values.extend(columns.values(&at));
    }
}
