//! Whether meshes have the attributes that textures ask for.

use super::report::Report;
use crate::desc::{ClassedTexture, MeshAttributeDesc, ObjectDesc, ShapeDesc, ShapeKind, TextureDesc, TextureKind};

/// What a texture asks meshes for, and whether it has to be a number.
fn wanted(texture: &TextureDesc) -> Option<(&str, bool)> {
    match &texture.kind {
        ClassedTexture::Float(TextureKind::MeshAttribute { name, .. }) => Some((name, true)),
        ClassedTexture::Spectrum(TextureKind::MeshAttribute { name, .. }) => Some((name, false)),
        _ => None,
    }
}

/// Whether any texture asks for an attribute.
pub(super) fn are_wanted(textures: &[TextureDesc]) -> bool {
    textures.iter().any(|texture| wanted(texture).is_some())
}

/// Complains about textures that ask for what no mesh has.
pub(super) fn check(textures: &[TextureDesc], shapes: &[ShapeDesc], objects: &[ObjectDesc], report: &mut Report) {
    if !are_wanted(textures) {
        return;
    }
    let shapes = shapes.iter().chain(objects.iter().flat_map(|object| &object.shapes));
    let known: Vec<(&str, usize)> = {
        let mut known: Vec<_> = shapes
            .flat_map(attributes)
            .map(|attribute| (attribute.name.as_str(), attribute.channels))
            .collect();
        known.sort_unstable();
        known.dedup();
        known
    };
    for texture in textures {
        let Some((name, is_number)) = wanted(texture) else {
            continue;
        };
        let mut of_name = known.iter().filter(|(known, _)| *known == name).peekable();
        if of_name.peek().is_none() {
            let mut names: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
            names.dedup();
            let there = if names.is_empty() {
                "none has any".to_owned()
            } else {
                format!("there are {}", names.join(", "))
            };
            let message = format!("no mesh has the attribute `{name}`: {there}");
            report.unknown(texture.span, message, "it is 0", name, &names);
        } else if is_number && of_name.all(|(_, channels)| *channels != 1) {
            let message = format!("the attribute `{name}` is a color, but this texture is one of numbers");
            report.error(texture.span, message);
        }
    }
}

/// What textures on a shape find.
fn attributes(shape: &ShapeDesc) -> &[MeshAttributeDesc] {
    match &shape.kind {
        ShapeKind::TriangleMesh(mesh) => &mesh.attributes,
        _ => &[],
    }
}
