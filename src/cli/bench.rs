//! `lucerna bench`.

use std::io::Write;
use std::path::Path;

use super::args::BenchArgs;
use super::check_writable;
use super::memory;
use super::pin::pin;
use super::report::{Channel, Reporter};
use crate::accel::{Backend, BuildOptions};
use crate::bench::case::{self, Case, Settings};
use crate::bench::contenders::Choice;
use crate::bench::machine::Machine;
use crate::bench::report::Report;
use crate::bench::{file, page, paths, recorded, synthetic};
use crate::desc::{self, ParseOptions};
use crate::error::{Error, Result};
use crate::integrator::Integrator;
use crate::scene::{Scene, SceneOptions, View, ViewOverrides};

/// Measures, prints a table, writes files.
pub fn run(args: &BenchArgs) -> Result<()> {
    check(args)?;
    if let Some(cpus) = &args.pin {
        pin(cpus)?;
    }
    for path in [&args.json, &args.html].into_iter().flatten() {
        check_writable(path)?;
    }
    let settings = Settings {
        turns: args.turns as usize,
        threads: args.threads.0.clone(),
        choice: Choice {
            all: args.all,
            only: args.only.clone(),
        },
        memory: memory::available_bytes(),
    };
    let mut report = Report {
        machine: Machine::here(),
        command: command(),
        seed: args.seed,
        turns: settings.turns,
        pinned: args.pin.clone(),
        cases: Vec::new(),
    };
    let hear = |what: &str| {
        if !args.quiet {
            eprintln!("{what}");
        }
    };
    for source in sources(args) {
        let case = source.case(args, &hear)?;
        report.cases.push(case::run(&case, &settings, &hear)?);
        // What is done is not lost if a later scene fails.
        write_files(args, &report)?;
    }
    // Nobody listens any more: no reason to fail.
    let _ = write!(std::io::stdout(), "{report}");
    Ok(())
}

/// Checks what can be checked before anything is done.
fn check(args: &BenchArgs) -> Result<()> {
    let worlds = args.scenes.len() + args.synthetic.len();
    let usage = |message: &str| Err(Error::Usage(message.into()));
    match &args.rays {
        Some(_) if worlds > 1 => return usage("--rays is for one scene, or for the rays of a file alone"),
        Some(path) if worlds == 0 && !path.exists() => {
            return Err(Error::Usage(format!(
                "{}: there is no such file of rays, and no scene to record them from",
                path.display()
            )));
        }
        None if worlds == 0 => return usage("nothing to measure: name a scene, or --synthetic KIND:N, or --rays FILE"),
        _ => {}
    }
    Ok(())
}

/// The command as typed.
fn command() -> String {
    let words = std::env::args().skip(1);
    ["lucerna".to_owned()]
        .into_iter()
        .chain(words)
        .collect::<Vec<_>>()
        .join(" ")
}

fn write_files(args: &BenchArgs, report: &Report) -> Result<()> {
    if let Some(path) = &args.json {
        let text = serde_json::to_string_pretty(report).map_err(|e| Error::io("write", path, e.into()))?;
        std::fs::write(path, text + "\n").map_err(|e| Error::io("write", path, e))?;
    }
    if let Some(path) = &args.html {
        std::fs::write(path, page::html(report)).map_err(|e| Error::io("write", path, e))?;
    }
    Ok(())
}

/// Where a world and its rays come from.
enum Source<'a> {
    Scene(&'a Path),
    Synthetic(synthetic::Recipe),
    /// The rays of a file, in a world of its own.
    File(&'a Path),
}

fn sources(args: &BenchArgs) -> Vec<Source<'_>> {
    let scenes = args.scenes.iter().map(|path| Source::Scene(path));
    let made = args.synthetic.iter().map(|&recipe| Source::Synthetic(recipe));
    let mut sources: Vec<_> = scenes.chain(made).collect();
    if let (Some(path), true) = (&args.rays, sources.is_empty()) {
        sources.push(Source::File(path));
    }
    sources
}

impl Source<'_> {
    fn case(&self, args: &BenchArgs, hear: &dyn Fn(&str)) -> Result<Case> {
        let saved = args.rays.as_deref().filter(|path| path.exists());
        let case = match self {
            Self::File(path) => return file::read(path, None),
            Self::Scene(path) => {
                hear(&format!("{}: recording rays", path.display()));
                scene_case(path, args, saved)?
            }
            Self::Synthetic(recipe) => {
                hear(&format!("{recipe}: making rays"));
                synthetic_case(*recipe, args, saved)?
            }
        };
        if let (Some(path), None) = (&args.rays, saved) {
            file::write(path, &case)?;
            hear(&format!("{}: rays saved", path.display()));
        }
        Ok(case)
    }
}

fn build_options() -> BuildOptions {
    BuildOptions {
        threads: rayon::current_num_threads(),
        ..BuildOptions::default()
    }
}

fn scene_case(path: &Path, args: &BenchArgs, saved: Option<&Path>) -> Result<Case> {
    let desc = desc::load(
        path,
        &ParseOptions {
            lenient: args.lenient,
            ..ParseOptions::default()
        },
    )?;
    let channel = if args.quiet { Channel::Nobody } else { Channel::Person };
    Reporter {
        channel,
        scene: path,
        camera: "",
    }
    .warnings(&desc.warnings);
    let options = SceneOptions {
        backend: Some(Backend::default()),
        build: build_options(),
        ..SceneOptions::default()
    };
    let scene = Scene::build(&desc, &options)?;
    let world = scene.world().clone();
    if let Some(saved) = saved {
        return file::read(saved, Some(&world));
    }
    let mut integrator = Integrator::from_desc(&desc.integrator);
    if let Some(name) = &args.integrator {
        integrator = integrator.named(name);
    }
    let overrides = ViewOverrides {
        spp_multiple: integrator.samples_multiple(),
        resolution: args.resolution,
        spp: Some(1),
        seed: args.seed,
        ..ViewOverrides::default()
    };
    let Some(view) = desc.views.first() else {
        return Err(Error::Usage(format!("{}: no camera to record rays of", path.display())));
    };
    let view = View::build(&desc, view, scene.color(), &overrides)?;
    let (_, streams) = recorded::record(scene, &view, &integrator, args.count as usize);
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Ok(Case {
        name,
        recipe: None,
        world,
        streams,
    })
}

fn synthetic_case(recipe: synthetic::Recipe, args: &BenchArgs, saved: Option<&Path>) -> Result<Case> {
    let made = synthetic::world(recipe)?;
    let streams = match saved {
        Some(path) => return file::read(path, Some(&made.world)),
        None => {
            let accel = crate::accel::build(Backend::Bvh, &made.world, &build_options())?;
            paths::trace(&made, &*accel, args.count as usize, args.seed)
        }
    };
    Ok(Case {
        name: recipe.to_string(),
        recipe: Some(recipe),
        world: made.world,
        streams,
    })
}
