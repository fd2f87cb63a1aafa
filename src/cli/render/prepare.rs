//! What comes before any ray: reading and building the scene, naming and opening the outputs.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::Job;
use super::strategies::StrategyOutputs;
use crate::accel::BuildOptions;
use crate::cli::memory;
use crate::cli::report::Reporter;
use crate::desc::{self, FilmKind, ParseOptions, SceneDesc};
use crate::error::{Error, Result};
use crate::film::Film;
use crate::image_io::PendingOutput;
use crate::scene::{Scene, SceneOptions, View, ViewOverrides};
use crate::spectrum::ColorMode;

/// A scene, read and built.
pub(super) struct Prepared {
    pub(super) scene: Scene,
    pub(super) desc: SceneDesc,
    pub(super) load_seconds: f64,
}

/// A view and its open outputs.
pub(super) struct Picture {
    pub(super) view: View,
    pub(super) output: PendingOutput,
    pub(super) strategies: Option<StrategyOutputs>,
}

impl Job<'_> {
    /// Reads a scene, opens the outputs of its views, and builds the backend: whatever is wrong with any of them is said before
    /// anything is rendered.
    pub(super) fn prepare(&mut self, path: &Path, start: Instant) -> Result<(Prepared, Vec<Picture>)> {
        let args = self.args;
        let options = ParseOptions {
            lenient: args.lenient,
            defines: args.defines.clone(),
        };
        let mut desc = self.pool.install(|| match &args.env {
            None => desc::load(path, &options),
            Some(environment) if desc::bare::is_mesh(path) => desc::bare::load(path, Some(environment), &options),
            Some(_) => Err(Error::Usage(format!(
                "{}: --env lights bare meshes (.ply, .obj); a scene has lights of its own",
                path.display()
            ))),
        })?;
        let reporter = Reporter {
            channel: self.channel,
            scene: path,
            camera: "",
        };
        reporter.warnings(&desc.warnings);
        let spp_multiple = self.integrator(&desc)?.samples_multiple();
        let overrides = ViewOverrides {
            spp_multiple,
            resolution: args.resolution,
            crop: args.crop.or(args.pixel),
            spp: args.spp,
            sampler: args.sampler.map(Into::into),
            sample: args.sample,
            seed: args.seed,
        };
        let mut pictures = Vec::new();
        for view_desc in &desc.views {
            let view = View::build(&desc, view_desc, args.color.into(), &overrides)?;
            self.check_film(&desc, &view)?;
            check_memory(&view, self.integrator(&desc)?.splats())?;
            let wanted = args.spp.unwrap_or(view_desc.sampler.pixel_samples);
            if view.sampler.samples_per_pixel() != wanted {
                let rounded = view.sampler.samples_per_pixel();
                reporter.say(&format!(
                    "{rounded} samples a pixel instead of {wanted}: a multiple of {spp_multiple} passes"
                ));
            }
            let file = self.output_path(path, &view, desc.views.len())?;
            pictures.push(Picture {
                output: PendingOutput::create(&file)?,
                strategies: self.strategy_outputs(path, &desc, &view)?,
                view,
            });
        }
        let load_seconds = start.elapsed().as_secs_f64();
        let options = SceneOptions {
            backend: args.backend,
            build: BuildOptions {
                quality: args.build_quality.into(),
                robust: !args.not_robust,
                compact: args.compact,
                threads: self.pool.current_num_threads(),
            },
            color: args.color.into(),
        };
        // A profile builds once more.
        let scene = self.pool.install(|| match args.profile {
            true => Scene::build(&desc, &options),
            false => Scene::build_taking_shapes(&mut desc, &options),
        })?;
        let integrator = self.integrator(&desc)?;
        if let Some(missing) = integrator.missing(&scene) {
            return Err(Error::Usage(format!("{}: {missing}", path.display())));
        }
        if let Some(missed) = integrator.blind_spot(&scene) {
            reporter.say(&format!("warning: {missed}"));
        }
        if scene.lights().is_empty() && integrator.needs_lights() {
            reporter.say(&format!(
                "warning: {} has no lights: its picture is black",
                path.display()
            ));
        }
        Ok((
            Prepared {
                scene,
                desc,
                load_seconds,
            },
            pictures,
        ))
    }

    /// Refuses a camera or a film that does not go with the integrator or the colour mode.
    fn check_film(&self, desc: &SceneDesc, view: &View) -> Result<()> {
        let integrator = self.integrator(desc)?;
        if integrator.splats() && !view.camera.takes_light_paths() {
            return Err(Error::Usage(format!(
                "`{}` connects light paths to the camera `{}`, which looks through lenses: `path`, `photon` and `sppm` do not",
                integrator.name(),
                view.name
            )));
        }
        if !matches!(view.film_kind, FilmKind::Spectral(_)) {
            return Ok(());
        }
        let problem = if ColorMode::from(self.args.color) == ColorMode::Rgb {
            "light has no wavelengths with --color rgb".to_owned()
        } else if integrator.splats() {
            format!("`{}` brings light to the film by its colors only", integrator.name())
        } else {
            return Ok(());
        };
        Err(Error::Usage(format!(
            "the film `spectral` of the camera `{}` cannot be filled: {problem}",
            view.name
        )))
    }

    /// The file for a view: distinct from that of every other picture of this job.
    fn output_path(&mut self, scene: &Path, view: &View, views: usize) -> Result<PathBuf> {
        let file_name = scene.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let stem = file_name.trim_end_matches(".gz");
        let stem = [".pbrt", ".ply", ".obj"]
            .iter()
            .fold(stem, |stem, end| stem.trim_end_matches(end));
        let several = if views > 1 {
            "{scene}-{camera}.exr"
        } else {
            "{scene}.exr"
        };
        let template = match (&self.args.output, &view.filename) {
            (Some(output), _) => output.to_string_lossy().into_owned(),
            (None, Some(film)) => film.to_string_lossy().into_owned(),
            (None, None) => several.to_owned(),
        };
        let path = PathBuf::from(template.replace("{scene}", stem).replace("{camera}", &view.name));
        if self.outputs.insert(path.clone()) {
            return Ok(path);
        }
        Err(Error::Usage(format!(
            "{}: two pictures would be written to this file; put {{scene}} or {{camera}} into the name given by -o",
            path.display()
        )))
    }
}

/// Checks that only `{scene}` and `{camera}` stand in a name.
pub(super) fn check_placeholders(template: &str) -> Result<()> {
    let known = template.replace("{scene}", "").replace("{camera}", "");
    match known.split_once('{').and_then(|(_, rest)| rest.split_once('}')) {
        Some((name, _)) => Err(Error::Usage(format!(
            "{template}: unknown placeholder {{{name}}}: expected {{scene}} or {{camera}}"
        ))),
        None => Ok(()),
    }
}

/// Refuses a film that memory cannot hold.
fn check_memory(view: &View, takes_splats: bool) -> Result<()> {
    // Beside the sums there are the pixels as they are written.
    let wanted = view
        .crop
        .area()
        .saturating_mul(Film::bytes_per_pixel(takes_splats) + 16);
    match memory::available_bytes() {
        Some(available) if wanted > available => Err(Error::Usage(format!(
            "the {}x{} pixels of the camera `{}` take {} of memory, and there are {}: a smaller --resolution or --crop takes less",
            view.crop.width(),
            view.crop.y1 - view.crop.y0,
            view.name,
            memory::in_words(wanted),
            memory::in_words(available)
        ))),
        _ => Ok(()),
    }
}
