//! `--strategies`: what each strategy (s, t) of a bidirectional render found, and what is found from one side alone, as the layers of one file
//! and as one overview.

use std::path::Path;

use super::Job;
use super::picture::{data_window, display_window};
use crate::cli::memory;
use crate::cli::report::Reporter;
use crate::cli::stats::OneSided;
use crate::desc::SceneDesc;
use crate::error::{Error, Result};
use crate::film::Film;
use crate::image_io::{Image, ImageMetadata, PendingOutput, Window};
use crate::integrator::{Integrator, Pyramid, Strategies, StrategyLayer};
use crate::scene::{Scene, View};

/// The files for the strategies of a picture.
pub(super) struct StrategyOutputs {
    pub(super) pyramid: Pyramid,
    layers: PendingOutput,
    overview: PendingOutput,
}

/// What is found from one side alone: the name of the layer, and the integrator.
const ONE_SIDED: [(&str, &str); 2] = [("eye-only", "path"), ("light-only", "lightpath")];

/// Bytes for each pixel of a layer while files are written: its values in the image, in the file's order, and compressed.
const BYTES_TO_WRITE: u64 = 3 * 12;

impl Job<'_> {
    /// Opens the files for a view's strategies, if they are asked for: errors are those of an integrator that has none, of too little
    /// memory, and of files that cannot be written.
    pub(super) fn strategy_outputs(
        &mut self,
        scene: &Path,
        desc: &SceneDesc,
        view: &View,
    ) -> Result<Option<StrategyOutputs>> {
        let Some(directory) = &self.args.strategies else {
            return Ok(None);
        };
        let integrator = self.integrator(desc)?;
        if !matches!(integrator, Integrator::Bdpt(bdpt) if bdpt.strategies == Strategies::All) {
            return Err(Error::Usage(format!(
                "--strategies is for the integrator `bdpt`: `{}` has no strategies (s, t)",
                integrator.name()
            )));
        }
        let depth = self.args.strategies_depth;
        let pyramid = Pyramid::new(depth).ok_or_else(|| {
            Error::Usage(format!(
                "--strategies-depth is {depth}: expected 1 to {}",
                Pyramid::LARGEST
            ))
        })?;
        check_memory(pyramid, view)?;
        std::fs::create_dir_all(directory).map_err(|e| Error::io("create", directory, e))?;
        let file_name = scene.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let stem = file_name.trim_end_matches(".gz").trim_end_matches(".pbrt");
        let name = match desc.views.len() {
            1 => format!("{stem}-strategies"),
            _ => format!("{stem}-{}-strategies", view.name),
        };
        let mut open = |extension: &str| {
            let path = directory.join(format!("{name}.{extension}"));
            self.outputs.insert(path.clone()).then_some(path).map_or_else(
                || {
                    Err(Error::Usage(format!(
                        "{name}.{extension}: the strategies of two pictures would be written to this file"
                    )))
                },
                |path| PendingOutput::create(&path),
            )
        };
        Ok(Some(StrategyOutputs {
            pyramid,
            layers: open("exr")?,
            overview: open("png")?,
        }))
    }

    /// The pictures by paths from the eye alone and from the lights alone, with as many samples, and what their renders say about
    /// themselves.
    pub(super) fn one_sided(
        &self,
        scene: &Scene,
        view: &View,
        integrator: &Integrator,
        reporter: &Reporter<'_>,
    ) -> ([Vec<f32>; ONE_SIDED.len()], [OneSided; ONE_SIDED.len()]) {
        let rendered = ONE_SIDED.map(|(layer, name)| {
            let integrator = integrator.named(name);
            let film = integrator.film(view);
            let progress = reporter.progress(Some(layer));
            let stats = self.pool.install(|| integrator.render(scene, view, &film, &progress));
            progress.finish();
            let options = format!("--integrator {name} (and the options of this render but --strategies)");
            reporter.dropped(&stats, self.args.seed, &options);
            (film.develop(), OneSided::of(layer, integrator.name(), &stats))
        });
        let [(eye, of_eye), (light, of_light)] = rendered;
        ([eye, light], [of_eye, of_light])
    }
}

/// Refuses films that memory cannot hold.
fn check_memory(pyramid: Pyramid, view: &View) -> Result<()> {
    let layers = (1 + ONE_SIDED.len() + pyramid.layers().len()) as u64;
    // A picture from one side is made when the film with all layers is there.
    let films = pyramid.bytes_per_pixel() + Film::bytes_per_pixel(true);
    let wanted = view.crop.area() * (films + layers * BYTES_TO_WRITE);
    match memory::available_bytes() {
        Some(available) if wanted > available => Err(Error::Usage(format!(
            "the strategies of {}x{} pixels for paths of up to {} edges take {} of memory, and there are {}: \
             a smaller --strategies-depth, --resolution or --crop takes less",
            view.crop.width(),
            view.crop.y1 - view.crop.y0,
            pyramid.edges(),
            memory::in_words(wanted),
            memory::in_words(available)
        ))),
        _ => Ok(()),
    }
}

impl StrategyOutputs {
    /// Writes both files. `film` is one of [`Integrator::film_of_strategies`], rendered; `one_sided` are the pictures of
    /// [`Job::one_sided`]; `exposure` is that of the overview.
    pub(super) fn write(
        self,
        film: &Film,
        one_sided: [Vec<f32>; ONE_SIDED.len()],
        view: &View,
        metadata: &ImageMetadata,
        exposure: f32,
    ) -> Result<()> {
        let layers = self.pyramid.layers();
        let mut pictures = Vec::from(one_sided);
        pictures.push(film.develop());
        pictures.extend(film.layers().iter().map(Film::develop));
        let overview = overview(self.pyramid, &layers, &pictures, view.crop.width() as usize)?;
        let one_sided = ONE_SIDED.iter().map(|(layer, _)| format!("{layer}."));
        let names = one_sided
            .chain([String::new()])
            .chain(layers.iter().map(|layer| layer.name() + "."));
        let channels = names.flat_map(|layer| ["R", "G", "B"].map(|channel| format!("{layer}{channel}")));
        let channels: Vec<String> = channels.collect();
        let values = pictures.iter().map(Vec::len).sum();
        let mut data = Vec::with_capacity(values);
        for first in (0..values / pictures.len()).step_by(3) {
            for source in &pictures {
                data.extend_from_slice(&source[first..first + 3]);
            }
        }
        drop(pictures);
        let image = Image::new(data_window(view), display_window(view), channels, data)?;
        for (output, image) in [(self.layers, &image), (self.overview, &overview)] {
            if let Some(reason) = output.commit(image, Some(metadata), exposure)?.instead_because {
                return Err(reason);
            }
        }
        Ok(())
    }
}

/// Columns of a picture in the overview, at most.
const CELL: usize = 160;
/// Pixels between pictures.
const GAP: usize = 3;
/// What there is no picture in.
const BACKGROUND: f32 = 0.02;

/// What is found from the eye alone, from the lights alone, and from both; below them the pyramid in full above the one that is weighted: a row
/// for each path length, a column for each s. Longer paths are the last row. The first `pictures` are those of the first row, the others
/// those of `layers`.
fn overview(pyramid: Pyramid, layers: &[StrategyLayer], pictures: &[Vec<f32>], width: usize) -> Result<Image> {
    let height = pictures.first().map_or(0, |picture| picture.len() / 3 / width);
    let step = width.max(height).div_ceil(CELL);
    let (cell_width, cell_height) = (width.div_ceil(step), height.div_ceil(step));
    let edges = pyramid.edges() as usize;
    let views = ONE_SIDED.len() + 1;
    let (columns, rows) = (views.max(edges + 1), 2 * edges + 2);
    let total_width = columns * (cell_width + GAP) + GAP;
    let total_height = rows * (cell_height + GAP) + GAP;
    let mut data = vec![BACKGROUND; 3 * total_width * total_height];
    let of_layer = |&layer: &StrategyLayer| match layer {
        StrategyLayer::Strategy { s, t, weighted } => {
            let row = (s + t) as usize - 1;
            (if weighted { edges + row } else { row }, s as usize)
        }
        StrategyLayer::Longer => (2 * edges + 1, 0),
    };
    let places = (0..views).map(|column| (0, column)).chain(layers.iter().map(of_layer));
    for ((row, column), picture) in places.zip(pictures) {
        let corner = [GAP + column * (cell_width + GAP), GAP + row * (cell_height + GAP)];
        for y in 0..cell_height {
            for x in 0..cell_width {
                let first = 3 * ((corner[1] + y) * total_width + corner[0] + x);
                let pixel = mean_of_block(picture, [width, height], [x * step, y * step], step);
                data[first..first + 3].copy_from_slice(&pixel);
            }
        }
    }
    let size = |n: usize| i32::try_from(n).unwrap_or(i32::MAX);
    let window = Window::of_size(size(total_width), size(total_height));
    Image::rgb(window, window, data)
}

/// The mean colour of `step` x `step` pixels from a corner on, as far as they are in the picture.
fn mean_of_block(picture: &[f32], [width, height]: [usize; 2], [x0, y0]: [usize; 2], step: usize) -> [f32; 3] {
    let (x1, y1) = ((x0 + step).min(width), (y0 + step).min(height));
    let mut sum = [0.0; 3];
    for y in y0..y1 {
        for pixel in picture[3 * (y * width + x0)..3 * (y * width + x1)].chunks_exact(3) {
            for (sum, value) in sum.iter_mut().zip(pixel) {
                *sum += value;
            }
        }
    }
    sum.map(|sum| sum / ((x1 - x0) * (y1 - y0)) as f32)
}
