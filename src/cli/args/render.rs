//! `lucerna render` as typed.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::values::{
    ColorArg, MOST_THREADS, MaxDepth, PhotonMapArg, QualityArg, SamplerArg, StrategyArg, TermArg, parse_backend,
    parse_crop, parse_define, parse_finite, parse_max_depth, parse_pixel, parse_positive, parse_positive_whole,
    parse_resolution, parse_seed, parse_whole, parse_within,
};
use crate::accel::Backend;
use crate::film::PixelRect;
use crate::integrator::Integrator;

/// The arguments of `lucerna render`.
#[derive(Debug, Args)]
#[command(after_help = "\
Exit codes: 0 done, 1 a render or a file failed, 2 bad usage or a bad scene; the highest, if there are several.

Examples:
  lucerna render cornell-box.pbrt -o cornell-box.png --spp 256
  lucerna render frame-*.pbrt -o 'out/{scene}.exr' --quiet
  lucerna render hall.pbrt -o 'hall-{camera}.exr' --json --stats hall.json
  lucerna render box.xml -o box.exr -D spp=256 -D max_depth=8
  lucerna render hall.pbrt -o corner.exr --resolution 1920x1080 --crop 0,0,200,100")]
pub struct RenderArgs {
    /// Scene files (.pbrt; .xml of Mitsuba), or meshes (.ply, .obj), which are put on a neutral stage; each may be compressed (.gz)
    #[arg(required = true, value_name = "SCENE")]
    pub scenes: Vec<PathBuf>,

    /// With meshes: an image all around that lights them, instead of a lamp over a floor
    ///
    /// Equal-area octahedral (square) or equirectangular (twice as wide as high), upright: .exr, .hdr, .pfm, .png and others.
    #[arg(long, value_name = "IMAGE")]
    pub env: Option<PathBuf>,

    /// The image: .exr (32-bit float, linear) or .png (8-bit sRGB)
    ///
    /// May hold {scene} (the scene file's name without extension) and {camera}. Without it: the film's filename, else SCENE.exr,
    /// in the working directory.
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,

    /// How light transport is estimated [default: the scene's]
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(Integrator::NAMES))]
    pub integrator: Option<String>,

    /// How `path` looks for light: by directions drawn from BSDFs, by points of lights, or by both [default: the scene's]
    #[arg(long, value_name = "NAME")]
    pub strategy: Option<StrategyArg>,

    /// Parts of the light that `photon` and `sppm` show, separated by commas [default: all]
    #[arg(long, value_name = "TERM", value_delimiter = ',')]
    pub terms: Vec<TermArg>,

    /// With `photon`: show in false colors how much light one of its maps has
    ///
    /// Blue, cyan, green, yellow, red and white stand for a thousandth of the brightest (of all but the brightest pixel in a thousand)
    /// up to that, by its logarithm; black for less.
    #[arg(long, value_name = "MAP")]
    pub photon_map: Option<PhotonMapArg>,

    /// With `sppm`: begin no pass after so many seconds
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = parse_positive)]
    pub time: Option<f64>,

    /// With `sppm`: stop when the picture's relative error is expected to be at most this (0.05 is hardly visible)
    #[arg(long, value_name = "ERROR", allow_negative_numbers = true, value_parser = parse_positive)]
    pub noise: Option<f64>,

    /// With the integrator `bdpt`: write what each strategy (s, t) found into this directory
    ///
    /// SCENE-strategies.exr has a layer for each, without its weight and with it (s2.t3.unweighted, s2.t3.weighted), one for all longer
    /// paths, and what is found from one side alone, with as many samples (eye-only, by `path`; light-only, by `lightpath`). SCENE-strategies.png
    /// shows these two and the picture, and below them the strategies, in rows by path length and columns by s. It takes memory, which is
    /// checked first.
    #[arg(long, value_name = "DIR")]
    pub strategies: Option<PathBuf>,

    /// The greatest number of edges of paths whose strategies are told apart
    #[arg(long, value_name = "N", default_value_t = 5, requires = "strategies",
        allow_negative_numbers = true, value_parser = |text: &str| parse_within(text, 1..=10))]
    pub strategies_depth: u32,

    /// Samples a pixel [default: the scene's]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = parse_positive_whole)]
    pub spp: Option<u32>,

    /// Seed of all random numbers
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = parse_seed)]
    pub seed: u64,

    /// Where sample points come from [default: the scene's]
    #[arg(long, value_name = "NAME")]
    pub sampler: Option<SamplerArg>,

    /// Greatest number of scattering events of a path, or `unlimited` [default: the scene's]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = parse_max_depth)]
    pub max_depth: Option<MaxDepth>,

    /// Pixels of the whole picture [default: the scene's]
    #[arg(long, value_name = "WxH", value_parser = parse_resolution)]
    pub resolution: Option<[u32; 2]>,

    /// Render only the pixels x0 <= x < x1, y0 <= y < y1, counted from the top left
    ///
    /// They are exactly the pixels that the whole picture has there. In an EXR file the crop is the data window, the picture the
    /// display window.
    #[arg(long, value_name = "x0,y0,x1,y1", value_parser = parse_crop)]
    pub crop: Option<PixelRect>,

    /// Render only this pixel; with --sample, to look into a sample that was dropped
    #[arg(long, value_name = "x,y", value_parser = parse_pixel, conflicts_with = "crop")]
    pub pixel: Option<PixelRect>,

    /// Render only this sample of each pixel, counted from 0
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = parse_whole)]
    pub sample: Option<u32>,

    /// Carry wavelengths along paths, or linear sRGB
    #[arg(long, value_name = "MODE", default_value = "spectral")]
    pub color: ColorArg,

    /// Brightness of a PNG, in stops
    #[arg(long, value_name = "STOPS", default_value_t = 0.0, allow_negative_numbers = true, value_parser = parse_finite)]
    pub exposure: f32,

    /// Threads [default: as many as the machine runs at once]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = |text: &str| parse_within(text, 1..=MOST_THREADS as u32))]
    pub threads: Option<u32>,

    /// What answers ray queries, `embree` or `bvh` [default: the one that is better for the scene]
    ///
    /// Without it Lucerna's own BVH answers where there are a million primitives or more, and no instances: there it takes less
    /// memory, and on average less time; and where there are spheres among few primitives, which it traces several times as
    /// fast. Embree answers elsewhere.
    #[arg(long, value_name = "NAME", value_parser = parse_backend)]
    pub backend: Option<Backend>,

    /// Build time of the backend against its speed
    #[arg(long, value_name = "QUALITY", default_value = "medium")]
    pub build_quality: QualityArg,

    /// Let Embree use its fast triangle test, which is not watertight
    #[arg(long)]
    pub not_robust: bool,

    /// Let Embree build what takes least memory, and is slower; Lucerna's BVH has one form
    #[arg(long, conflicts_with = "not_robust")]
    pub compact: bool,

    /// In a Mitsuba scene, what `$NAME` stands for instead of its default; may be given several times
    #[arg(short = 'D', long = "define", value_name = "NAME=VALUE", value_parser = parse_define)]
    pub defines: Vec<(String, String)>,

    /// Take unknown and unsupported parameters of a scene as warnings where something can stand in for them
    #[arg(long)]
    pub lenient: bool,

    /// Write statistics to this file: a JSON object, or an array if there are several renders
    #[arg(long, value_name = "FILE.json")]
    pub stats: Option<PathBuf>,

    /// Say where the time went, and how much of it the fastest backend would need for the same rays
    ///
    /// By kind of ray, shading, sampling and film; printed, and put into the statistics. Some of the rays are recorded in a short second render
    /// and traced by every way that each backend has.
    #[arg(long)]
    pub profile: bool,

    /// Write events to stdout, a JSON object a line
    ///
    /// {"event": "progress", "scene", "camera", "done" (0 to 1), "seconds_left"}, {"event": "result", "scene", "camera", and the
    /// statistics}, {"event": "error", "scene", "camera", "message"}.
    #[arg(long)]
    pub json: bool,

    /// Write nothing but errors
    #[arg(long, short)]
    pub quiet: bool,
}
