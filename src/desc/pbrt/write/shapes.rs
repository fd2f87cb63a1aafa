//! Shapes, objects and their instances.

use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::Writer;
use super::entity::{Entity, quoted};
use crate::desc::{
    CurveDesc, CurveKindDesc, MediumId, MeshDesc, PatchMeshDesc, QuadricDesc, ShapeDesc, ShapeKind, Textured,
    TubeBasis, TubesDesc,
};
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
                ShapeKind::Quadric { surface, phi_max } => {
                    if matches!(surface, QuadricDesc::Disk { radial_uv: true, .. }) {
                        writer.note("Shape \"disk\" \"bool radialuv\"");
                    }
                    quadric(surface, *phi_max)
                }
                ShapeKind::BilinearMesh(patches) => bilinear_mesh(patches),
                ShapeKind::LoopSubdivision { cage, levels } => {
                    let mut entity = Entity::new("Shape", "loopsubdiv");
                    entity.integer("levels", (*levels).into());
                    put_triangles(&mut entity, cage);
                    entity
                }
                ShapeKind::Curve(description) => curve(description),
                ShapeKind::Tubes(description) => {
                    writer.note("Shape \"tubes\"");
                    tubes(description)
                }
                ShapeKind::DisplacedMesh { mesh, displacement } => {
                    let mut entity = Entity::new("Shape", "plymesh");
                    entity
                        .string("filename", &writer.parts.mesh(mesh)?)
                        .float_textured("displacement", &displacement.texture, &writer.texture_names)
                        .float("displacement.edgelength", displacement.edge_length);
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
        put_triangles(&mut entity, mesh);
        if let Some(end) = &mesh.positions_end {
            put_vectors(&mut entity, "point3", "P1", end);
            self.note("Shape \"trianglemesh\" \"point3 P1\"");
        }
        put_vectors(&mut entity, "normal", "N", &mesh.normals);
        put_vectors(&mut entity, "vector3", "S", &mesh.tangents);
        put_uvs(&mut entity, &mesh.uvs);
        for attribute in &mesh.attributes {
            let kind = if attribute.channels == 1 { "float" } else { "rgb" };
            entity.singles(kind, &attribute.name, attribute.values.iter().copied());
            let prefix = attribute.domain.prefix();
            self.note(&format!("Shape \"trianglemesh\" \"{kind} {prefix}...\""));
        }
        Ok(entity)
    }
}

fn quadric(surface: &QuadricDesc, phi_max: f64) -> Entity {
    let mut entity;
    match *surface {
        QuadricDesc::Sphere { radius, z } => {
            entity = Entity::new("Shape", "sphere");
            entity.float("radius", radius).float("zmin", z[0]).float("zmax", z[1]);
        }
        QuadricDesc::Cylinder { radius, z } => {
            entity = Entity::new("Shape", "cylinder");
            entity.float("radius", radius).float("zmin", z[0]).float("zmax", z[1]);
        }
        QuadricDesc::Disk {
            height,
            radius,
            inner_radius,
            radial_uv,
        } => {
            entity = Entity::new("Shape", "disk");
            entity
                .float("height", height)
                .float("radius", radius)
                .float("innerradius", inner_radius);
            if radial_uv {
                entity.boolean("radialuv", true);
            }
        }
    }
    entity.float("phimax", phi_max);
    entity
}

fn curve(curve: &CurveDesc) -> Entity {
    let kind = match curve.kind {
        CurveKindDesc::Flat => "flat",
        CurveKindDesc::Cylinder => "cylinder",
        CurveKindDesc::Ribbon => "ribbon",
    };
    let mut entity = Entity::new("Shape", "curve");
    let [start, end] = curve.widths;
    entity
        .string("type", kind)
        .float("width0", start)
        .float("width1", end)
        .integer("splitdepth", curve.split_depth.into());
    // Each segment begins where the one before ends.
    let first = curve.segments.first().map(|segment| segment[0]);
    let rest = curve.segments.iter().flat_map(|segment| &segment[1..]).copied();
    put_vectors(
        &mut entity,
        "point3",
        "P",
        &first.into_iter().chain(rest).collect::<Vec<_>>(),
    );
    put_vectors(&mut entity, "normal", "N", &curve.normals);
    entity
}

fn tubes(tubes: &TubesDesc) -> Entity {
    let mut entity = Entity::new("Shape", "tubes");
    let basis = match tubes.basis {
        TubeBasis::Linear => "linear",
        TubeBasis::CubicBSpline => "bspline",
    };
    entity
        .string("basis", basis)
        .integers("counts", tubes.counts.iter().map(|&count| count.into()));
    put_vectors(&mut entity, "point3", "P", &tubes.points);
    entity.singles("float", "radius", tubes.radii.iter().copied());
    entity
}

fn bilinear_mesh(patches: &PatchMeshDesc) -> Entity {
    let mut entity = Entity::new("Shape", "bilinearmesh");
    entity.integers("indices", patches.indices.iter().flatten().map(|&i| i64::from(i)));
    put_vectors(&mut entity, "point3", "P", &patches.positions);
    put_vectors(&mut entity, "normal", "N", &patches.normals);
    put_uvs(&mut entity, &patches.uvs);
    entity
}

fn put_triangles(entity: &mut Entity, mesh: &MeshDesc) {
    entity.integers("indices", mesh.indices.iter().flatten().map(|&i| i64::from(i)));
    put_vectors(entity, "point3", "P", &mesh.positions);
}

/// A parameter, unless there are none.
fn put_vectors(entity: &mut Entity, kind: &str, name: &str, vectors: &[Vec3]) {
    if !vectors.is_empty() {
        entity.singles(kind, name, vectors.iter().flat_map(Vec3::to_array));
    }
}

fn put_uvs(entity: &mut Entity, uvs: &[Vec2]) {
    if !uvs.is_empty() {
        entity.singles("point2", "uv", uvs.iter().flat_map(Vec2::to_array));
    }
}
