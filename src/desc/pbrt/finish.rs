//! The end of reading: names become indices, mesh files are read, and either all is well or nothing is handed out.

use std::sync::Arc;

use rayon::prelude::*;

use super::attributes;
use super::builder::Builder;
use super::files::Context;
use super::nested;
use super::report::Report;
use super::shape::{PendingMeshes, RawKind};
use super::suggest;
use super::world::{RawShape, Slot, World, default_material};
use crate::desc::report::mesh_problem;
use crate::desc::{
    InstanceDesc, MaterialDesc, MaterialId, MaterialKind, MeshDesc, ObjectDesc, ObjectId, SceneDesc, ShapeDesc,
    ShapeKind, ply,
};
use crate::error::{Error, Result, Span};

/// Turns what has been gathered into a scene.
///
/// # Errors
///
/// [`Error::Scene`] if anything was wrong.
pub(super) fn finish(builder: Builder) -> Result<SceneDesc> {
    let Builder {
        mut context,
        options,
        world,
        ..
    } = builder;
    context.report_unused_defaults();
    let views = options.views(&mut context.report, Span::default());
    let instances = instances(&world, &mut context.report);
    let World {
        materials,
        media,
        shapes,
        objects,
        lights,
        meshes,
        ..
    } = world;
    let materials = resolve_materials(materials.into_slots(), &mut context.report);
    let media = media.finish(&mut context.report);
    let textures = std::mem::take(&mut context.textures).finish(&mut context.report);
    let images = std::mem::take(&mut context.images);
    let images = context.read_images(&images);
    let meshes = read_meshes(&meshes, attributes::are_wanted(&textures), &mut context);
    if context.report.has_errors() {
        return Err(Error::Scene(context.report.into_errors()));
    }
    let mut shape_of = |shape: RawShape| resolve_shape(shape, &materials, &meshes, &mut context.report);
    let shapes: Vec<_> = shapes.into_iter().filter_map(&mut shape_of).collect();
    let objects: Vec<_> = objects
        .into_iter()
        .map(|object| ObjectDesc {
            name: object.name,
            shapes: object.shapes.into_iter().filter_map(&mut shape_of).collect(),
            span: object.span,
        })
        .collect();
    attributes::check(&textures, &shapes, &objects, &mut context.report);
    if context.report.has_errors() {
        return Err(Error::Scene(context.report.into_errors()));
    }
    let hash = context.hash();
    let (sources, warnings) = context.report.into_sources_and_warnings();
    Ok(SceneDesc {
        sources,
        views,
        integrator: options.integrator(),
        materials,
        media,
        textures,
        images,
        shapes,
        objects,
        instances,
        lights,
        transform_times: options.transform_times,
        warnings,
        hash,
    })
}

/// The instances of objects that exist; complains about the others.
fn instances(world: &World, report: &mut Report) -> Vec<InstanceDesc> {
    let mut instances = Vec::with_capacity(world.instances.len());
    for instance in &world.instances {
        if let Some(index) = world.object(&instance.name) {
            instances.push(InstanceDesc {
                // There are fewer objects than bytes in a file.
                object: ObjectId(index as u32),
                world_from_instance: instance.world_from_instance,
                span: instance.span,
            });
        } else {
            let message = format!("there is no object `{}`", instance.name);
            let help = suggest::closest(&instance.name, &world.object_names());
            let help = help.map(|name| format!("did you mean `{name}`?"));
            report.error_with_help(instance.span, message, help);
        }
    }
    instances
}

/// The materials, one for each slot.
fn resolve_materials(slots: Vec<Slot>, report: &mut Report) -> Vec<MaterialDesc> {
    let mut materials = Vec::with_capacity(slots.len());
    let mut undefined = Vec::new();
    for slot in slots {
        materials.push(match slot {
            Slot::Defined(material) => *material,
            Slot::Undefined { name, span } => {
                undefined.push((name, span));
                default_material(span)
            }
        });
    }
    let names: Vec<&str> = materials.iter().filter_map(|m| m.name.as_deref()).collect();
    for (name, span) in undefined {
        let message = format!("there is no named material `{name}`");
        report.unknown(span, message, "the default material stands in", &name, &names);
    }
    nested::check(&materials, report);
    materials
}

/// Reads the mesh files, in parallel, with their attributes or without. One that cannot be read is complained about and empty.
fn read_meshes(pending: &PendingMeshes, with_attributes: bool, context: &mut Context) -> Vec<Arc<MeshDesc>> {
    let load = if with_attributes {
        ply::load_with_attributes
    } else {
        ply::load
    };
    let read: Vec<_> = pending.files.par_iter().map(|(path, _)| load(path)).collect();
    let mut meshes = Vec::with_capacity(read.len());
    for ((path, span), outcome) in pending.files.iter().zip(read) {
        meshes.push(match outcome {
            Ok(file) => {
                context.count_hash(&file.hash);
                Arc::new(file.mesh)
            }
            Err(problem) => {
                context.report.error(*span, mesh_problem(path, &problem));
                Arc::default()
            }
        });
    }
    meshes
}

/// A shape with everything in it; none if nothing happens at it, which is said.
fn resolve_shape(
    shape: RawShape,
    materials: &[MaterialDesc],
    meshes: &[Arc<MeshDesc>],
    report: &mut Report,
) -> Option<ShapeDesc> {
    let media = (shape.media.interior != shape.media.exterior).then_some(shape.media);
    let mut area_light = shape.area_light.map(|light| (*light).clone());
    if matches!(materials[shape.material].kind, MaterialKind::Interface) {
        if media.is_none() {
            let message = "this shape is left out: the material `interface` has no surface, and there is the same medium on its two sides";
            report.warning(shape.span, message);
            return None;
        }
        if area_light.take().is_some() {
            let message = "this shape does not emit: the material `interface` has no surface";
            report.warning(shape.span, message);
        }
    }
    let kind = match shape.kind {
        RawKind::Whole(kind) => kind,
        RawKind::File { file, displacement } => {
            let mesh = Arc::clone(&meshes[file]);
            match displacement {
                None => ShapeKind::TriangleMesh(mesh),
                Some(displacement) => ShapeKind::DisplacedMesh { mesh, displacement },
            }
        }
    };
    Some(ShapeDesc {
        span: shape.span,
        kind,
        world_from_object: shape.world_from_object,
        reverse_orientation: shape.reverse_orientation,
        // There are fewer materials than bytes in a file.
        material: MaterialId(shape.material as u32),
        media,
        alpha: shape.alpha,
        area_light,
    })
}
