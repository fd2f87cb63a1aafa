//! Attributes of meshes as described to tables that textures look up.

use std::collections::HashMap;
use std::sync::Arc;

use crate::desc::{
    AttributeDomain, ClassedTexture, MeshAttributeDesc, MeshDesc, SceneDesc, ShapeDesc, ShapeKind, TextureKind,
};
use crate::texture::AttributeTable;

/// The tables of an attribute by geometry.
pub(super) type AttributeTables = Arc<[Option<Arc<AttributeTable>>]>;

/// The tables of all attributes that textures ask for, by name. They are made while the description still has its meshes.
pub(super) fn asked_for(desc: &SceneDesc) -> HashMap<String, AttributeTables> {
    let mut asked = HashMap::new();
    for texture in &desc.textures {
        if let ClassedTexture::Float(TextureKind::MeshAttribute { name, .. })
        | ClassedTexture::Spectrum(TextureKind::MeshAttribute { name, .. }) = &texture.kind
        {
            asked.entry(name.clone()).or_insert_with(|| tables(desc, name));
        }
    }
    asked
}

/// What each geometry has of the attribute of a name. Geometries are numbered as they are added: the shapes of the world, then those
/// of the objects.
fn tables(desc: &SceneDesc, name: &str) -> AttributeTables {
    let shapes = desc
        .shapes
        .iter()
        .chain(desc.objects.iter().flat_map(|object| &object.shapes));
    // A mesh that several shapes have has one table.
    let mut made: HashMap<*const MeshDesc, Option<Arc<AttributeTable>>> = HashMap::new();
    let of_shape = |shape: &ShapeDesc| match &shape.kind {
        ShapeKind::TriangleMesh(mesh) => {
            let table = made.entry(Arc::as_ptr(mesh)).or_insert_with(|| of_mesh(mesh, name));
            table.clone()
        }
        _ => None,
    };
    shapes.map(of_shape).collect()
}

fn of_mesh(mesh: &MeshDesc, name: &str) -> Option<Arc<AttributeTable>> {
    let attribute = mesh.attributes.iter().find(|attribute| attribute.name == name)?;
    let values = values(attribute);
    let table = match attribute.domain {
        AttributeDomain::Vertices => AttributeTable::of_vertices(values, mesh.indices.clone())?,
        AttributeDomain::Triangles => AttributeTable::of_triangles(values),
    };
    Some(Arc::new(table))
}

fn values(attribute: &MeshAttributeDesc) -> Vec<[f32; 3]> {
    let channel = |value: &[f32], i: usize| value.get(i).or(value.first()).copied().unwrap_or(0.0);
    let values = attribute.values.chunks_exact(attribute.channels.max(1));
    values.map(|value| [0, 1, 2].map(|i| channel(value, i))).collect()
}
