//! The end of reading: names become indices, mesh files are read, and either all is well or nothing is handed out.

use std::sync::Arc;

use rayon::prelude::*;

use super::builder::Builder;
use super::files::Context;
use super::report::Report;
use super::shape::{PendingMeshes, RawKind};
use super::suggest;
use super::world::{RawShape, Slot, World, default_material};
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
        shapes,
        objects,
        lights,
        meshes,
        ..
    } = world;
    let (materials, ids) = resolve_materials(materials.into_slots(), &mut context.report);
    let textures = std::mem::take(&mut context.textures).finish(&mut context.report);
    let images = std::mem::take(&mut context.images);
    let images = context.read_images(&images);
    let meshes = read_meshes(&meshes, &mut context);
    if context.report.has_errors() {
        return Err(Error::Scene(context.report.into_errors()));
    }
    let mut shape_of = |shape: RawShape| resolve_shape(shape, &ids, &meshes, &mut context.report);
    let shapes = shapes.into_iter().filter_map(&mut shape_of).collect();
    let objects = objects
        .into_iter()
        .map(|object| ObjectDesc {
            name: object.name,
            shapes: object.shapes.into_iter().filter_map(&mut shape_of).collect(),
            span: object.span,
        })
        .collect();
    let hash = context.hash();
    let (sources, warnings) = context.report.into_sources_and_warnings();
    Ok(SceneDesc {
        sources,
        views,
        integrator: options.integrator(),
        materials,
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

/// The materials, and for each slot which one it is: none for an interface.
fn resolve_materials(slots: Vec<Slot>, report: &mut Report) -> (Vec<MaterialDesc>, Vec<Option<MaterialId>>) {
    let mut materials = Vec::with_capacity(slots.len());
    let mut ids = Vec::with_capacity(slots.len());
    let mut undefined = Vec::new();
    for slot in slots {
        let material = match slot {
            Slot::Surface(material) => *material,
            Slot::Interface => {
                ids.push(None);
                continue;
            }
            Slot::Undefined { name, span } => {
                undefined.push((name, span));
                default_material(span)
            }
        };
        ids.push(Some(MaterialId(materials.len() as u32)));
        materials.push(material);
    }
    let names: Vec<&str> = materials.iter().filter_map(|m| m.name.as_deref()).collect();
    for (name, span) in undefined {
        let message = format!("there is no named material `{name}`");
        report.unknown(span, message, "the default material stands in", &name, &names);
    }
    resolve_mixes(&mut materials, &ids, report);
    (materials, ids)
}

/// How many mixes may contain one another in a row.
const DEEPEST_MIX: usize = 64;

/// Makes the slots that mixes name the ids of their materials.
fn resolve_mixes(materials: &mut [MaterialDesc], ids: &[Option<MaterialId>], report: &mut Report) {
    for material in &mut *materials {
        let MaterialKind::Mix { materials: parts, .. } = &mut material.kind else {
            continue;
        };
        let found = parts.map(|slot| ids[slot.0 as usize]);
        if found.contains(&None) {
            report.error(
                material.span,
                "a mix cannot contain the material `interface`, which is no surface",
            );
        }
        *parts = found.map(|id| id.unwrap_or(MaterialId(0)));
    }
    // Each round settles the mixes of what is settled; what a cycle needs never is.
    let mut settled: Vec<bool> = vec![false; materials.len()];
    for _ in 0..=DEEPEST_MIX {
        let now: Vec<bool> = materials
            .iter()
            .map(|material| match &material.kind {
                MaterialKind::Mix { materials: parts, .. } => parts.iter().all(|id| settled[id.0 as usize]),
                _ => true,
            })
            .collect();
        if now == settled {
            break;
        }
        settled = now;
    }
    for (material, _) in materials.iter().zip(&settled).filter(|(_, settled)| !**settled) {
        let message = format!("this mix contains itself, or more than {DEEPEST_MIX} mixes in a row");
        report.error(material.span, message);
    }
}

/// Reads the mesh files, in parallel. One that cannot be read is complained about and empty.
fn read_meshes(pending: &PendingMeshes, context: &mut Context) -> Vec<Arc<MeshDesc>> {
    let read: Vec<_> = pending.files.par_iter().map(|(path, _)| ply::load(path)).collect();
    let mut meshes = Vec::with_capacity(read.len());
    for ((path, span), outcome) in pending.files.iter().zip(read) {
        meshes.push(match outcome {
            Ok(file) => {
                context.count_hash(&file.hash);
                Arc::new(file.mesh)
            }
            Err(problem) => {
                let message = format!("cannot read the mesh {}: {problem}", path.display());
                context.report.error(*span, message);
                Arc::default()
            }
        });
    }
    meshes
}

/// A shape with everything in it; none if it has no surface, which is said.
fn resolve_shape(
    shape: RawShape,
    materials: &[Option<MaterialId>],
    meshes: &[Arc<MeshDesc>],
    report: &mut Report,
) -> Option<ShapeDesc> {
    let Some(material) = materials[shape.material] else {
        let message =
            "this shape is left out: the material `interface` has no surface, and without media it does nothing";
        report.warning(shape.span, message);
        return None;
    };
    let kind = match shape.kind {
        RawKind::Mesh(mesh) => ShapeKind::TriangleMesh(mesh),
        RawKind::Pending(index) => ShapeKind::TriangleMesh(Arc::clone(&meshes[index])),
        RawKind::Sphere { radius } => ShapeKind::Sphere { radius },
    };
    Some(ShapeDesc {
        span: shape.span,
        kind,
        world_from_object: shape.world_from_object,
        reverse_orientation: shape.reverse_orientation,
        material,
        alpha: shape.alpha,
        area_light: shape.area_light.map(|light| (*light).clone()),
    })
}
