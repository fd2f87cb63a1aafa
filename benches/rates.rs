//! Rates of the backends on the same rays, side by side: Embree, fast and robust, by the calls that the layer makes, and our BVH.
//!
//! `cargo bench --bench rates -- terrain:50e3 soup:5e5 cornell-box` takes synthetic worlds of about so many triangles (box, terrain,
//! soup, spheres, hair) and names of scenes in scenes/. Without any it takes a list of its own. One thread; `TURNS=n` sets how often
//! each wave is traced. Prints millions of rays a second and ratios by ray kind, and the time and the bytes a triangle of the builds.

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use lucerna::accel::record::{RayStreams, Recorder};
use lucerna::accel::{Accel, Backend, BuildOptions, BuildQuality, RayKind, build};
use lucerna::bench::streams::Waves;
use lucerna::bench::{rates, streams, synthetic};
use lucerna::desc::{self, ParseOptions};
use lucerna::error::{Error, Result};
use lucerna::geometry::World;
use lucerna::integrator::{Integrator, Silent};
use lucerna::scene::{Scene, SceneOptions, View, ViewOverrides};

const DEFAULT: [&str; 6] = [
    "box",
    "terrain:5e4",
    "spheres:5e4",
    "soup:5e4",
    "hair:5e4",
    "terrain:1e6",
];

/// Packets of a wave of a render.
const WAVE: usize = 128;

/// Waves of each kind, at most.
const MOST_WAVES: usize = 256;

/// A world and its rays, by [`RayKind::ALL`].
struct Case {
    world: Arc<World>,
    waves: [Waves; 3],
}

fn synthetic_case(kind: synthetic::Kind, count: usize) -> Result<Case> {
    let scene = synthetic::world(kind, count)?;
    let accel = build(Backend::default(), &scene.world, &BuildOptions::default())?;
    let waves = streams::synthetic(&scene, &*accel, 8, 4).waves;
    Ok(Case {
        world: scene.world,
        waves,
    })
}

fn recorded_case(name: &str) -> Result<Case> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scenes")
        .join(name)
        .with_extension("pbrt");
    let desc = desc::load(&path, &ParseOptions::default())?;
    let scene = Scene::build(&desc, &SceneOptions::default())?;
    let overrides = ViewOverrides {
        resolution: Some([256, 256]),
        spp: Some(1),
        ..ViewOverrides::default()
    };
    let view = View::build(&desc, &desc.views[0], scene.color(), &overrides)?;
    let recorded = RayStreams::new(MOST_WAVES * WAVE);
    let world = Arc::clone(scene.world());
    let scene = scene.map_accel(|inner| Box::new(Recorder::new(inner, recorded.clone())));
    Integrator::from_desc(&desc.integrator).render(&scene, &view, &view.film(), &Silent);
    let waves = RayKind::ALL.map(|kind| recorded.of(kind).chunks(WAVE).map(<[_]>::to_vec).collect());
    Ok(Case { world, waves })
}

fn case(argument: &str) -> Result<Case> {
    let (name, count) = argument.split_once(':').unwrap_or((argument, "0"));
    let count: f64 = count
        .parse()
        .map_err(|_| Error::Usage(format!("`{argument}`: the number of triangles is no number")))?;
    let kind = match name {
        "box" => synthetic::Kind::Box,
        "terrain" => synthetic::Kind::Terrain,
        "soup" => synthetic::Kind::Soup,
        "spheres" => synthetic::Kind::Spheres,
        "hair" => synthetic::Kind::Hair,
        scene => return recorded_case(scene),
    };
    synthetic_case(kind, count as usize)
}

/// What is compared: Embree where it is compiled in, and last our own.
fn backends(world: &Arc<World>) -> Result<Vec<(String, Box<dyn Accel>)>> {
    let mut built = Vec::new();
    for &backend in Backend::AVAILABLE {
        let robust: &[bool] = if backend == Backend::Bvh {
            &[true]
        } else {
            &[false, true]
        };
        for &robust in robust {
            let options = BuildOptions {
                quality: BuildQuality::High,
                robust,
                threads: 1,
            };
            let start = Instant::now();
            let accel = build(backend, world, &options)?;
            let seconds = start.elapsed().as_secs_f64();
            let bytes = accel.info().memory as f64 / world.instanced_primitive_count().max(1) as f64;
            let name = match (backend, robust) {
                (Backend::Bvh, _) => "bvh".to_owned(),
                (_, true) => format!("{backend} robust"),
                (_, false) => format!("{backend} fast"),
            };
            println!("  {name}: built in {seconds:.3} s, {bytes:.1} bytes a primitive");
            built.push((name, accel));
        }
    }
    Ok(built)
}

fn run(arguments: &[String], turns: usize) -> Result<()> {
    for argument in arguments {
        println!("{argument}");
        let case = case(argument)?;
        let built = backends(&case.world)?;
        let accels: Vec<&dyn Accel> = built.iter().map(|(_, accel)| &**accel).collect();
        for (kind, waves) in RayKind::ALL.into_iter().zip(&case.waves) {
            let rates = rates::measure(&accels, kind, waves, turns);
            let Some(ours) = rates.last() else { continue };
            if ours.rays == 0 {
                continue;
            }
            for ((name, _), rate) in built.iter().zip(&rates) {
                println!(
                    "  {:8}{name:14}{:9.2} Mrays/s, bvh at {:.3} of it, {} hits of {}",
                    format!("{kind:?}"),
                    rate.mrays,
                    ours.mrays / rate.mrays,
                    rate.hits,
                    rate.rays
                );
            }
        }
    }
    Ok(())
}

fn main() -> Result<()> {
    // Cargo passes an option of its own.
    let mut arguments: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    if arguments.is_empty() {
        arguments = DEFAULT.map(String::from).to_vec();
    }
    let turns = std::env::var("TURNS")
        .ok()
        .and_then(|turns| turns.parse().ok())
        .unwrap_or(7);
    match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
        Ok(pool) => pool.install(|| run(&arguments, turns)),
        Err(error) => Err(Error::Usage(format!("no thread to measure on: {error}"))),
    }
}
