//! `lucerna render`: scenes times views to image files.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::time::Instant;

use super::args::RenderArgs;
use super::report::{Channel, Reporter};
use super::stats::{Statistics, peak_memory_bytes};
use crate::accel::BuildOptions;
use crate::desc::{self, ParseOptions, SceneDesc};
use crate::error::{Error, Result};
use crate::image_io::{Image, ImageFormat, ImageMetadata, PendingOutput, Window};
use crate::integrator::{Integrator, RenderStats};
use crate::scene::{Scene, SceneOptions, View, ViewOverrides};
use crate::spectrum::ColorSpace;

/// The whole job.
struct Job<'a> {
    args: &'a RenderArgs,
    print_error: &'a dyn Fn(&Error),
    channel: Channel,
    pool: rayon::ThreadPool,
    /// Files that an earlier picture of this job was written to.
    outputs: HashSet<PathBuf>,
    statistics: Vec<Statistics>,
    exit_code: u8,
}

/// Renders everything; returns the highest exit code.
pub fn run(args: &RenderArgs, print_error: &dyn Fn(&Error)) -> u8 {
    match Job::new(args, print_error) {
        Ok(mut job) => {
            for scene in &args.scenes {
                job.render_scene(scene);
            }
            job.write_statistics();
            job.exit_code
        }
        Err(error) => {
            print_error(&error);
            error.exit_code()
        }
    }
}

impl<'a> Job<'a> {
    /// Checks what can be checked before any scene is read.
    fn new(args: &'a RenderArgs, print_error: &'a dyn Fn(&Error)) -> Result<Self> {
        if let Some(name) = &args.integrator
            && !Integrator::NAMES.contains(&name.as_str())
        {
            let known = Integrator::NAMES.join(", ");
            return Err(Error::Usage(format!(
                "unknown integrator `{name}`: expected one of {known}"
            )));
        }
        if let Some(output) = &args.output {
            ImageFormat::of_path(output)?;
            let template = output.to_string_lossy();
            check_placeholders(&template)?;
            if args.scenes.len() > 1 && !template.contains("{scene}") {
                return Err(Error::Usage(format!(
                    "{template}: several scenes cannot be written to one file; put {{scene}} into its name"
                )));
            }
        }
        if let Some(stats) = &args.stats {
            std::fs::File::create(stats).map_err(|e| Error::io("create", stats, e))?;
        }
        let threads = args.threads.map_or_else(
            || std::thread::available_parallelism().map_or(1, usize::from),
            |threads| threads as usize,
        );
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .map_err(|e| Error::Usage(format!("cannot start {threads} threads: {e}")))?;
        let channel = match (args.json, args.quiet) {
            (true, _) => Channel::Json,
            (false, true) => Channel::Nobody,
            (false, false) => Channel::Person,
        };
        Ok(Self {
            args,
            print_error,
            channel,
            pool,
            outputs: HashSet::new(),
            statistics: Vec::new(),
            exit_code: 0,
        })
    }

    /// Notes a failure and goes on.
    fn fail(&mut self, scene: &Path, camera: &str, error: &Error) {
        Reporter {
            channel: self.channel,
            scene,
            camera,
        }
        .error(error);
        (self.print_error)(error);
        self.exit_code = self.exit_code.max(error.exit_code());
    }

    /// Renders all views of one scene file.
    fn render_scene(&mut self, path: &Path) {
        let start = Instant::now();
        match self.prepare(path, start) {
            Ok((prepared, pictures)) => {
                let mut start = start;
                for picture in pictures {
                    let name = picture.view.name.clone();
                    match self.render_picture(path, &prepared, picture, start) {
                        Ok(statistics) => self.statistics.push(statistics),
                        Err(error) => self.fail(path, &name, &error),
                    }
                    start = Instant::now();
                }
            }
            Err(error) => self.fail(path, "", &error),
        }
    }

    /// Reads a scene, opens the outputs of its views, and builds the backend: whatever is wrong with any of them is said before
    /// anything is rendered.
    fn prepare(&mut self, path: &Path, start: Instant) -> Result<(Prepared, Vec<Picture>)> {
        let args = self.args;
        let desc = self
            .pool
            .install(|| desc::load(path, &ParseOptions { lenient: args.lenient }))?;
        Reporter {
            channel: self.channel,
            scene: path,
            camera: "",
        }
        .warnings(&desc.warnings);
        let overrides = ViewOverrides {
            resolution: args.resolution,
            crop: args.crop.or(args.pixel),
            spp: args.spp,
            sampler: args.sampler.map(Into::into),
            sample: args.sample,
            seed: args.seed,
        };
        let mut pictures = Vec::new();
        for view in &desc.views {
            let view = View::build(&desc, view, args.color.into(), &overrides)?;
            let file = self.output_path(path, &view, desc.views.len())?;
            pictures.push(Picture {
                output: PendingOutput::create(&file)?,
                view,
            });
        }
        let load_seconds = start.elapsed().as_secs_f64();
        let options = SceneOptions {
            backend: args.backend,
            build: BuildOptions {
                quality: args.build_quality.into(),
                robust: !args.not_robust,
                threads: self.pool.current_num_threads(),
            },
            color: args.color.into(),
        };
        let scene = self.pool.install(|| Scene::build(&desc, &options))?;
        if scene.lights().is_empty() {
            Reporter {
                channel: self.channel,
                scene: path,
                camera: "",
            }
            .say(&format!(
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

    /// The file for a view: distinct from that of every other picture of this job.
    fn output_path(&mut self, scene: &Path, view: &View, views: usize) -> Result<PathBuf> {
        let file_name = scene.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let stem = file_name.trim_end_matches(".gz").trim_end_matches(".pbrt");
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

    fn render_picture(&self, path: &Path, prepared: &Prepared, picture: Picture, start: Instant) -> Result<Statistics> {
        let Picture { view, output } = picture;
        let reporter = Reporter {
            channel: self.channel,
            scene: path,
            camera: &view.name,
        };
        let integrator = self.integrator(&prepared.desc)?;
        let film = view.film();
        let progress = reporter.progress();
        let stats = self
            .pool
            .install(|| integrator.render(&prepared.scene, &view, &film, &progress));
        progress.finish();

        let accel = prepared.scene.accel().info();
        let metadata = ImageMetadata {
            seed: self.args.seed,
            spp: i32::try_from(view.sampler.samples_per_pixel()).unwrap_or(i32::MAX),
            integrator: integrator.name().to_owned(),
            backend: accel.backend.to_string(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            render_seconds: stats.render_time.as_secs_f64(),
            scene_hash: prepared.desc.hash.clone(),
            chromaticities: chromaticities(view.color_space),
        };
        let image = Image::rgb(data_window(&view), display_window(&view), film.develop())?;
        let written = output.commit(&image, Some(&metadata), self.args.exposure)?;
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
        report_dropped(&reporter, &stats, self.args.seed, path);
        let statistics = self.statistics_of(prepared, &view, &integrator, &stats, &written.path, path, start);
        reporter.result(&statistics);
        match written.instead_because {
            Some(reason) => Err(reason),
            None => Ok(statistics),
        }
    }

    /// The scene's integrator, as changed by the command line.
    fn integrator(&self, desc: &SceneDesc) -> Result<Integrator> {
        let mut integrator = Integrator::from_desc(&desc.integrator);
        if let Some(name) = &self.args.integrator {
            integrator = integrator.named(name);
        }
        if let Some(max_depth) = self.args.max_depth {
            integrator = integrator.with_max_depth(max_depth.0);
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
            spp: view.sampler.samples_per_pixel(),
            wall_seconds: start.elapsed().as_secs_f64(),
            load_seconds: prepared.load_seconds,
            build_seconds: prepared.scene.build_seconds(),
            render_seconds,
            backend_thread_seconds: stats.backend_time.as_secs_f64(),
            camera_rays: stats.camera_rays,
            shadow_rays: stats.shadow_rays,
            rays: stats.rays(),
            rays_per_second: stats.rays() as f64 / render_seconds.max(1e-9),
            peak_memory_bytes: peak_memory_bytes(),
            dropped_samples: stats.dropped_samples,
        }
    }

    /// Writes the statistics of all renders that ended well.
    fn write_statistics(&mut self) {
        let Some(path) = &self.args.stats else { return };
        let several = self.args.scenes.len() > 1 || self.statistics.len() > 1;
        let text = match self.statistics.as_slice() {
            [one] if !several => serde_json::to_string_pretty(one),
            all => serde_json::to_string_pretty(all),
        };
        let written = text
            .map_err(std::io::Error::other)
            .and_then(|text| std::fs::write(path, text + "\n"));
        if let Err(source) = written {
            let error = Error::io("write", path, source);
            (self.print_error)(&error);
            self.exit_code = self.exit_code.max(error.exit_code());
        }
    }
}

/// Checks that only `{scene}` and `{camera}` stand in a name.
fn check_placeholders(template: &str) -> Result<()> {
    let known = template.replace("{scene}", "").replace("{camera}", "");
    match known.split_once('{').and_then(|(_, rest)| rest.split_once('}')) {
        Some((name, _)) => Err(Error::Usage(format!(
            "{template}: unknown placeholder {{{name}}}: expected {{scene}} or {{camera}}"
        ))),
        None => Ok(()),
    }
}

/// A scene, read and built.
struct Prepared {
    scene: Scene,
    desc: SceneDesc,
    load_seconds: f64,
}

/// A view and its open output.
struct Picture {
    view: View,
    output: PendingOutput,
}

/// Red, green, blue and white of a colour space.
fn chromaticities(space: ColorSpace) -> [[f32; 2]; 4] {
    let [red, green, blue] = space.primaries();
    [red, green, blue, space.white()].map(|xy| xy.map(|c| c as f32))
}

/// The pixels rendered.
fn data_window(view: &View) -> Window {
    let [x0, y0, x1, y1] =
        [view.crop.x0, view.crop.y0, view.crop.x1, view.crop.y1].map(|edge| i32::try_from(edge).unwrap_or(i32::MAX));
    Window { x0, y0, x1, y1 }
}

/// The whole picture.
fn display_window(view: &View) -> Window {
    let [width, height] = view.resolution.map(|size| i32::try_from(size).unwrap_or(i32::MAX));
    Window::of_size(width, height)
}

/// Says which samples were dropped, and how to render them again.
fn report_dropped(reporter: &Reporter, stats: &RenderStats, seed: u64, scene: &Path) {
    if stats.dropped_samples == 0 {
        return;
    }
    reporter.say(&format!(
        "warning: {} samples were not finite or negative and count as black; to look into one:",
        stats.dropped_samples
    ));
    for dropped in stats.dropped.iter().take(4) {
        let [x, y] = dropped.pixel;
        reporter.say(&format!(
            "  lucerna render {} --seed {seed} --pixel {x},{y} --sample {} (and the options of this render)",
            scene.display(),
            dropped.sample
        ));
    }
}
