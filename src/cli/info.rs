//! `lucerna info`.

use serde::Serialize;

use super::args::InfoArgs;
use super::report::{Channel, Reporter, print_json};
use super::stats::peak_memory_bytes;
use crate::accel::BuildOptions;
use crate::desc::{self, ParseOptions, SceneDesc};
use crate::error::Result;
use crate::geometry::Shape;
use crate::light::Light;
use crate::material::Material;
use crate::scene::{Scene, SceneOptions};

/// What is in a scene.
#[derive(Debug, Serialize)]
struct SceneInfo {
    scene: String,
    views: Vec<ViewInfo>,
    meshes: usize,
    triangles: u64,
    spheres: u64,
    quadrics: u64,
    patches: u64,
    curve_segments: u64,
    instances: usize,
    instanced_primitives: u64,
    bounds_min: [f32; 3],
    bounds_max: [f32; 3],
    lights: Vec<Count>,
    materials: Vec<Count>,
    backend: String,
    geometry_bytes: usize,
    backend_bytes: usize,
    peak_memory_bytes: u64,
    build_seconds: f64,
}

#[derive(Debug, Serialize)]
struct ViewInfo {
    name: String,
    resolution: [u32; 2],
    spp: u32,
}

#[derive(Debug, Serialize)]
struct Count {
    kind: &'static str,
    count: usize,
}

/// Prints what is in a scene.
pub fn run(args: &InfoArgs) -> Result<()> {
    let options = ParseOptions {
        lenient: args.lenient,
        defines: args.defines.clone(),
    };
    let mut desc = desc::load(&args.scene, &options)?;
    let channel = if args.json { Channel::Nobody } else { Channel::Person };
    Reporter {
        channel,
        scene: &args.scene,
        camera: "",
    }
    .warnings(&desc.warnings);
    let threads = rayon::current_num_threads();
    let options = SceneOptions {
        backend: args.backend,
        build: BuildOptions {
            compact: args.compact,
            threads,
            ..BuildOptions::default()
        },
        ..SceneOptions::default()
    };
    let scene = Scene::build_taking_shapes(&mut desc, &options)?;
    let info = SceneInfo::new(&args.scene.display().to_string(), &desc, &scene);
    if args.json {
        return print_json(&info);
    }
    print!("{info}");
    Ok(())
}

impl SceneInfo {
    fn new(name: &str, desc: &SceneDesc, scene: &Scene) -> Self {
        let world = scene.world();
        let (mut meshes, mut triangles, mut spheres, mut quadrics, mut patches) = (0, 0, 0, 0, 0);
        let mut curve_segments = 0;
        for geometry in world.geometries() {
            match &geometry.shape {
                Shape::Mesh(mesh) => {
                    meshes += 1;
                    triangles += mesh.triangle_count() as u64;
                }
                Shape::Spheres(list) => spheres += list.len() as u64,
                Shape::Quadrics(list) => quadrics += list.len() as u64,
                Shape::Patches(mesh) => patches += mesh.patch_count() as u64,
                Shape::Curves(curves) => curve_segments += curves.segments().len() as u64,
                Shape::Tubes(tubes) => curve_segments += tubes.pieces().len() as u64,
            }
        }
        let bounds = scene.bounds();
        let accel = scene.accel().info();
        let view = |view: &desc::ViewDesc| ViewInfo {
            name: view.name.clone(),
            resolution: view.film.resolution,
            spp: view.sampler.pixel_samples,
        };
        Self {
            scene: name.to_owned(),
            views: desc.views.iter().map(view).collect(),
            meshes,
            triangles,
            spheres,
            quadrics,
            patches,
            curve_segments,
            instances: world.instances().len(),
            instanced_primitives: world.instanced_primitive_count(),
            bounds_min: bounds.min.to_array(),
            bounds_max: bounds.max.to_array(),
            lights: count(scene.lights().iter().map(light_kind)),
            materials: count(scene.materials().iter().map(material_kind)),
            backend: format!("{} {}", accel.backend, accel.version),
            geometry_bytes: world.memory(),
            backend_bytes: accel.memory,
            peak_memory_bytes: peak_memory_bytes(),
            build_seconds: scene.build_seconds(),
        }
    }
}

fn light_kind(light: &Light) -> &'static str {
    match light {
        Light::Area(_) => "area",
        Light::Point(_) => "point",
        Light::Spot(_) => "spot",
        Light::Goniometric(_) => "goniometric",
        Light::Projection(_) => "projection",
        Light::Distant(_) => "distant",
        Light::Environment(_) => "infinite",
    }
}

fn material_kind(material: &Material) -> &'static str {
    match material {
        Material::Diffuse { .. } => "diffuse",
        Material::Conductor { .. } => "conductor",
        Material::Dielectric { .. } => "dielectric",
        Material::DiffuseTransmission { .. } => "diffusetransmission",
        Material::ThinDielectric { .. } => "thindielectric",
        Material::CoatedDiffuse { .. } => "coateddiffuse",
        Material::CoatedConductor { .. } => "coatedconductor",
        Material::Mix(_) => "mix",
        Material::Principled(_) => "principled",
        Material::Relief(relief) => material_kind(&relief.material),
        Material::Measured(_) => "measured",
        Material::Sided(_) => "sided",
        Material::Tinted(tinted) => material_kind(&tinted.material),
        Material::Plastic(_) => "plastic",
        Material::Hair(_) => "hair",
        Material::Interface => "interface",
    }
}

/// How many there are of each kind, in the order in which they first come.
fn count(kinds: impl Iterator<Item = &'static str>) -> Vec<Count> {
    let mut counts: Vec<Count> = Vec::new();
    for kind in kinds {
        match counts.iter_mut().find(|count| count.kind == kind) {
            Some(count) => count.count += 1,
            None => counts.push(Count { kind, count: 1 }),
        }
    }
    counts
}

impl std::fmt::Display for SceneInfo {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let list = |counts: &[Count]| {
            let parts: Vec<_> = counts.iter().map(|c| format!("{} {}", c.count, c.kind)).collect();
            if parts.is_empty() {
                "none".to_owned()
            } else {
                parts.join(", ")
            }
        };
        let megabytes = |bytes: usize| bytes as f64 / (1024.0 * 1024.0);
        writeln!(f, "{}", self.scene)?;
        for view in &self.views {
            let [width, height] = view.resolution;
            writeln!(
                f,
                "  view        {}: {width}x{height} pixels, {} spp",
                view.name, view.spp
            )?;
        }
        writeln!(
            f,
            "  shapes      {} meshes of {} triangles, {} spheres, {} other quadrics, {} patches, {} segments of curves",
            self.meshes, self.triangles, self.spheres, self.quadrics, self.patches, self.curve_segments
        )?;
        writeln!(
            f,
            "  instances   {}, {} primitives in all",
            self.instances, self.instanced_primitives
        )?;
        if self.bounds_min[0] <= self.bounds_max[0] {
            writeln!(f, "  bounds      {:?} to {:?}", self.bounds_min, self.bounds_max)?;
        } else {
            writeln!(f, "  bounds      none")?;
        }
        writeln!(f, "  lights      {}", list(&self.lights))?;
        writeln!(f, "  materials   {}", list(&self.materials))?;
        writeln!(
            f,
            "  backend     {}, built in {:.3} s",
            self.backend, self.build_seconds
        )?;
        writeln!(
            f,
            "  memory      {:.1} MiB geometry, {:.1} MiB backend, {:.1} MiB peak",
            megabytes(self.geometry_bytes),
            megabytes(self.backend_bytes),
            self.peak_memory_bytes as f64 / (1024.0 * 1024.0)
        )
    }
}
