//! One picture: rendered, written, counted.

use std::path::Path;
use std::time::{Duration, Instant};

use super::Job;
use super::prepare::{Picture, Prepared};
use crate::cli::report::Reporter;
use crate::cli::stats::{Photons, Statistics, peak_memory_bytes};
use crate::desc::{FilmKind, SceneDesc, Terms};
use crate::error::{Error, Result};
use crate::film::Film;
use crate::image_io::{Image, ImageMetadata, Window, false_colors};
use crate::integrator::{Integrator, Limits, RenderStats};
use crate::scene::View;
use crate::spectrum::ColorSpace;

impl Job<'_> {
    /// Renders a view and writes its picture; `start` is when the work for it began.
    pub(super) fn render_picture(
        &self,
        path: &Path,
        prepared: &Prepared,
        picture: Picture,
        start: Instant,
    ) -> Result<Statistics> {
        let Picture {
            view,
            output,
            strategies,
        } = picture;
        let reporter = Reporter {
            channel: self.channel,
            scene: path,
            camera: &view.name,
        };
        let integrator = self.integrator(&prepared.desc)?;
        let film = strategies
            .as_ref()
            .and_then(|outputs| integrator.film_of_strategies(&view, outputs.pyramid))
            .unwrap_or_else(|| integrator.film(&view));
        let film = view.with_layers(film, &prepared.scene);
        let progress = reporter.progress(None);
        let stats = self
            .pool
            .install(|| integrator.render(&prepared.scene, &view, &film, &progress));
        progress.finish();

        let accel = prepared.scene.accel().info();
        let metadata = ImageMetadata {
            seed: self.args.seed,
            spp: i32::try_from(samples_of(&view, &stats)).unwrap_or(i32::MAX),
            integrator: integrator.name().to_owned(),
            backend: accel.backend.to_string(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            render_seconds: stats.render_time.as_secs_f64(),
            scene_hash: prepared.desc.hash.clone(),
            chromaticities: chromaticities(view.color_space),
            is_spectral: matches!(view.film_kind, FilmKind::Spectral(_)),
        };
        let mut pixels = film.develop();
        if self.args.photon_map.is_some() {
            false_colors(&mut pixels);
        }
        let image = image_of(&film, &view, pixels)?;
        let written = output.commit(&image, Some(&metadata), self.args.exposure)?;
        if view.film_kind != FilmKind::Rgb && written.path.extension().is_none_or(|e| e != "exr") {
            let path = written.path.display();
            reporter.say(&format!(
                "{path} has the colors only: the film's other layers need a file .exr"
            ));
        }
        if film.dropped_surfaces() > 0 {
            let dropped = film.dropped_surfaces();
            reporter.say(&format!(
                "warning: the layers leave out {dropped} surfaces that are out of range"
            ));
        }
        if view.color_space != ColorSpace::Srgb && written.path.extension().is_none_or(|e| e != "exr") {
            let name = view.color_space.name();
            reporter.say(&format!(
                "{} cannot say that its colors are in {name}: programs will take them for sRGB",
                written.path.display()
            ));
        }
        if let Some(reason) = &written.instead_because {
            (self.print_error)(reason);
            reporter.say(&format!("the picture is in {} instead", written.path.display()));
        }
        reporter.dropped(&stats, self.args.seed, "(and the options of this render)");
        let mut one_sided = Vec::new();
        if let Some(outputs) = strategies {
            let (pictures, statistics) = self.one_sided(&prepared.scene, &view, &integrator, &reporter);
            outputs.write(&film, pictures, &view, &metadata, self.args.exposure)?;
            one_sided.extend(statistics);
        }
        let mut statistics = self.statistics_of(prepared, &view, &integrator, &stats, &written.path, path, start);
        statistics.one_sided = one_sided;
        if self.args.profile {
            statistics.profile = Some(self.profile(prepared, &view, &integrator, &stats)?);
        }
        reporter.result(&statistics);
        if let Some(profile) = &statistics.profile {
            reporter.say(&profile.to_string());
        }
        match written.instead_because {
            Some(reason) => Err(reason),
            None => Ok(statistics),
        }
    }

    /// The scene's integrator, as changed by the command line.
    pub(super) fn integrator(&self, desc: &SceneDesc) -> Result<Integrator> {
        let mut integrator = Integrator::from_desc(&desc.integrator);
        if let Some(name) = &self.args.integrator {
            integrator = integrator.named(name);
        }
        if let Some(max_depth) = self.args.max_depth {
            integrator = integrator.with_max_depth(max_depth.0);
        }
        if !self.args.terms.is_empty() {
            let name = integrator.name();
            let terms = self
                .args
                .terms
                .iter()
                .fold(Terms::NONE, |terms, &term| terms.with(term.into()));
            integrator = integrator.with_terms(terms).ok_or_else(|| {
                let message = "--terms is for the integrators `photon` and `sppm`";
                Error::Usage(format!("{message}: `{name}` does not take light apart"))
            })?;
        }
        if let Some(map) = self.args.photon_map {
            let name = integrator.name();
            integrator = integrator.with_shown(map.into()).ok_or_else(|| {
                Error::Usage(format!(
                    "--photon-map is for the integrator `photon`: `{name}` has no maps of that kind"
                ))
            })?;
        }
        if self.args.time.is_some() || self.args.noise.is_some() {
            let name = integrator.name();
            let limits = Limits {
                time: self.args.time.map(Duration::from_secs_f64),
                noise: self.args.noise,
            };
            integrator = integrator.with_limits(limits).ok_or_else(|| {
                let message = "--time and --noise are for the integrator `sppm`";
                Error::Usage(format!("{message}: `{name}` does not work in passes"))
            })?;
        }
        let Some(strategy) = self.args.strategy else {
            return Ok(integrator);
        };
        integrator.with_strategy(strategy.into()).ok_or_else(|| {
            let name = integrator.name();
            Error::Usage(format!(
                "--strategy is for the integrator `path`: `{name}` has no strategies"
            ))
        })
    }

    #[expect(clippy::too_many_arguments, reason = "gathers what the parts of a render know")]
    fn statistics_of(
        &self,
        prepared: &Prepared,
        view: &View,
        integrator: &Integrator,
        stats: &RenderStats,
        output: &Path,
        scene: &Path,
        start: Instant,
    ) -> Statistics {
        let accel = prepared.scene.accel().info();
        let render_seconds = stats.render_time.as_secs_f64();
        Statistics {
            scene: scene.display().to_string(),
            camera: view.name.clone(),
            output: output.display().to_string(),
            resolution: view.resolution,
            crop: [view.crop.x0, view.crop.y0, view.crop.x1, view.crop.y1],
            integrator: integrator.name(),
            color: match prepared.scene.color() {
                crate::spectrum::ColorMode::Spectral => "spectral",
                crate::spectrum::ColorMode::Rgb => "rgb",
            },
            backend: accel.backend.to_string(),
            backend_version: accel.version,
            threads: self.pool.current_num_threads(),
            seed: self.args.seed,
            spp: samples_of(view, stats),
            wall_seconds: start.elapsed().as_secs_f64(),
            load_seconds: prepared.load_seconds,
            build_seconds: prepared.scene.build_seconds(),
            render_seconds,
            backend_thread_seconds: stats.times.backend().as_secs_f64(),
            camera_rays: stats.camera_rays,
            shadow_rays: stats.shadow_rays,
            rays: stats.rays(),
            rays_per_second: stats.rays() as f64 / render_seconds.max(1e-9),
            peak_memory_bytes: peak_memory_bytes(),
            profile: None,
            photons: Photons::of(stats),
            one_sided: Vec::new(),
            dropped_samples: stats.dropped_samples,
        }
    }
}

/// The picture of a film, with what it keeps beside colours.
fn image_of(film: &Film, view: &View, pixels: Vec<f32>) -> Result<Image> {
    let layers = film.layer_channels();
    if layers.is_empty() {
        return Image::rgb(data_window(view), display_window(view), pixels);
    }
    let count = layers.len();
    let values = film.develop_layers();
    let both = pixels.chunks_exact(3).zip(values.chunks_exact(count));
    let data = both.flat_map(|(rgb, layers)| rgb.iter().chain(layers)).copied();
    let channels = ["R", "G", "B"].map(str::to_owned).into_iter().chain(layers);
    Image::new(
        data_window(view),
        display_window(view),
        channels.collect(),
        data.collect(),
    )
}

/// Samples of each pixel: those that were planned, unless the render ended early.
fn samples_of(view: &View, stats: &RenderStats) -> u32 {
    stats.stopped_after.unwrap_or(view.sampler.samples_per_pixel())
}

/// Red, green, blue and white of a colour space.
fn chromaticities(space: ColorSpace) -> [[f32; 2]; 4] {
    let [red, green, blue] = space.primaries();
    [red, green, blue, space.white()].map(|xy| xy.map(|c| c as f32))
}

/// The pixels rendered.
pub(super) fn data_window(view: &View) -> Window {
    let [x0, y0, x1, y1] =
        [view.crop.x0, view.crop.y0, view.crop.x1, view.crop.y1].map(|edge| i32::try_from(edge).unwrap_or(i32::MAX));
    Window { x0, y0, x1, y1 }
}

/// The whole picture.
pub(super) fn display_window(view: &View) -> Window {
    let [width, height] = view.resolution.map(|size| i32::try_from(size).unwrap_or(i32::MAX));
    Window::of_size(width, height)
}
