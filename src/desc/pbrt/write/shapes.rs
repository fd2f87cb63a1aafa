//! Shapes, objects and their instances.

use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::Writer;
use super::entity::{Entity, quoted};
use crate::desc::{MediumId, MeshDesc, ShapeDesc, ShapeKind, Textured};
use crate::error::Result;

/// Triangles of a mesh that stands in the file itself, at most.
const MOST_INLINE: usize = 256;

impl Writer<'_> {
    pub(super) fn shapes(&mut self) -> Result<()> {
        for shape in &self.desc.shapes {
            self.shape(shape)?;
        }
        for object in &self.desc.objects {
            self.line(&format!("\nObjectBegin {}", quoted(&object.name)));
            for shape in &object.shapes {
                self.shape(shape)?;
            }
            self.line("ObjectEnd");
        }
        for instance in &self.desc.instances {
            self.block(|writer| {
                writer.motion(&instance.world_from_instance);
                let object = &writer.desc.objects[instance.object.0 as usize];
                writer.line(&format!("ObjectInstance {}", quoted(&object.name)));
                Ok(())
            })?;
        }
        Ok(())
    }

    fn shape(&mut self, shape: &ShapeDesc) -> Result<()> {
        self.block(|writer| {
            writer.motion(&shape.world_from_object);
            if shape.reverse_orientation {
                writer.line("ReverseOrientation");
            }
            let name = &writer.material_names[shape.material.0 as usize];
            if !name.is_empty() {
                let line = format!("NamedMaterial {}", quoted(name));
                writer.line(&line);
            }
            writer.media_of(shape);
            if let Some(light) = &shape.area_light {
                writer.area_light(light)?;
            }
            let mut entity = match &shape.kind {
                ShapeKind::TriangleMesh(mesh) => writer.mesh(mesh)?,
                ShapeKind::Sphere { radius } => {
                    let mut entity = Entity::new("Shape", "sphere");
                    entity.float("radius", *radius);
                    entity
                }
            };
            if shape.alpha != Textured::Value(1.0) {
                entity.float_textured("alpha", &shape.alpha, &writer.texture_names);
            }
            writer.put(entity)
        })
    }

    /// Where no media are said, whatever is in force has to be the same on both sides.
    fn media_of(&mut self, shape: &ShapeDesc) {
        if self.desc.media.is_empty() {
            return;
        }
        let name = |id: Option<MediumId>| id.map_or("", |id| &self.desc.media[id.0 as usize].name);
        let line = match shape.media {
            Some(media) => format!(
                "MediumInterface {} {}",
                quoted(name(media.interior)),
                quoted(name(media.exterior))
            ),
            None => "MediumInterface \"\" \"\"".to_owned(),
        };
        self.line(&line);
    }

    fn mesh(&mut self, mesh: &Arc<MeshDesc>) -> Result<Entity> {
        // A PLY file has no place for these.
        let is_plain = mesh.positions_end.is_none() && mesh.tangents.is_empty();
        if is_plain && mesh.indices.len() > MOST_INLINE {
            let mut entity = Entity::new("Shape", "plymesh");
            entity.string("filename", &self.parts.mesh(mesh)?);
            return Ok(entity);
        }
        let mut entity = Entity::new("Shape", "trianglemesh");
        let vectors = |vectors: &[Vec3]| -> Vec<f32> { vectors.iter().flat_map(Vec3::to_array).collect() };
        entity.integers("indices", mesh.indices.iter().flatten().map(|&i| i64::from(i)));
        entity.singles("point3", "P", vectors(&mesh.positions).into_iter());
        if let Some(end) = &mesh.positions_end {
            entity.singles("point3", "P1", vectors(end).into_iter());
            self.note("Shape \"trianglemesh\" \"point3 P1\"");
        }
        if !mesh.normals.is_empty() {
            entity.singles("normal", "N", vectors(&mesh.normals).into_iter());
        }
        if !mesh.tangents.is_empty() {
            entity.singles("vector3", "S", vectors(&mesh.tangents).into_iter());
        }
        if !mesh.uvs.is_empty() {
            entity.singles("point2", "uv", mesh.uvs.iter().flat_map(Vec2::to_array));
        }
        Ok(entity)
    }
}
