//! The arguments as typed. Nothing here opens a file or knows a default that a scene could override.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

use crate::accel::{Backend, BuildQuality};
use crate::desc::Strategy;
use crate::film::PixelRect;
use crate::sampling::{SamplerKind, Strata};
use crate::spectrum::ColorMode;

/// What `--version` says: the program, and the Embree that it was built with.
const VERSION: &str = concat!(
    env!("CARGO_PKG_VERSION"),
    " (Embree: ",
    env!("LUCERNA_EMBREE_VERSION"),
    ")"
);

/// A physically based renderer: pbrt-v4 scenes in, EXR or PNG pictures out.
///
/// Rays are traced in packets through Embree, or through Lucerna's own BVH. A picture depends on the scene, the options and the
/// seed, and not on the number of threads: the same command gives the same bits.
#[derive(Debug, Parser)]
#[command(name = "lucerna", version = VERSION, after_help = "\
Exit codes: 0 done, 1 a render or a file failed, 2 bad usage or a bad scene.

Example:
  lucerna render scenes/cornell-box.pbrt -o cornell-box.png")]
pub struct Cli {
    /// The subcommand.
    #[command(subcommand)]
    pub command: Command,
}

/// The subcommands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render scenes to image files
    Render(Box<RenderArgs>),
    /// Tell what is in a scene: counts, bounds, lights, materials, memory
    Info(InfoArgs),
    /// Measure how far image A is from the reference B
    Compare(CompareArgs),
    /// List what scene files may use, with every parameter: type, range, unit, default
    List(ListArgs),
}

/// Render scenes to image files.
///
/// Several scenes, and several cameras of one scene (a `Camera` directive for each, with "string name"), are rendered one after
/// the other in one process. One that fails does not stop the rest.
#[derive(Debug, Args)]
#[command(after_help = "\
Exit codes: 0 done, 1 a render or a file failed, 2 bad usage or a bad scene; the highest, if there are several.

Examples:
  lucerna render cornell-box.pbrt -o cornell-box.png --spp 256
  lucerna render frame-*.pbrt -o 'out/{scene}.exr' --quiet
  lucerna render hall.pbrt -o 'hall-{camera}.exr' --json --stats hall.json
  lucerna render hall.pbrt -o corner.exr --resolution 1920x1080 --crop 0,0,200,100")]
pub struct RenderArgs {
    /// Scene files (.pbrt, .pbrt.gz)
    #[arg(required = true, value_name = "SCENE")]
    pub scenes: Vec<PathBuf>,

    /// The image: .exr (32-bit float, linear) or .png (8-bit sRGB)
    ///
    /// May hold {scene} (the scene file's name without extension) and {camera}. Without it: the film's filename, else SCENE.exr,
    /// in the working directory.
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,

    /// How light transport is estimated [default: the scene's] [possible values: path, kajiya]
    #[arg(long, value_name = "NAME")]
    pub integrator: Option<String>,

    /// How `path` looks for light: by directions drawn from BSDFs, by points of lights, or by both [default: the scene's]
    #[arg(long, value_name = "NAME")]
    pub strategy: Option<StrategyArg>,

    /// Samples a pixel [default: the scene's]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
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
    #[arg(long, value_name = "N")]
    pub sample: Option<u32>,

    /// Carry wavelengths along paths, or linear sRGB
    #[arg(long, value_name = "MODE", default_value = "spectral")]
    pub color: ColorArg,

    /// Brightness of a PNG, in stops
    #[arg(long, value_name = "STOPS", default_value_t = 0.0, allow_negative_numbers = true, value_parser = parse_finite)]
    pub exposure: f32,

    /// Threads [default: as many as the machine runs at once]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub threads: Option<u32>,

    /// What answers ray queries: `embree` or `bvh`
    #[arg(long, value_name = "NAME", default_value_t = Backend::default(), value_parser = parse_backend)]
    pub backend: Backend,

    /// Build time of the backend against its speed
    #[arg(long, value_name = "QUALITY", default_value = "medium")]
    pub build_quality: QualityArg,

    /// Let Embree use its fast triangle test, which is not watertight
    #[arg(long)]
    pub not_robust: bool,

    /// Take unknown and unsupported parameters of a scene as warnings where something can stand in for them
    #[arg(long)]
    pub lenient: bool,

    /// Write statistics to this file: a JSON object, or an array if there are several renders
    #[arg(long, value_name = "FILE.json")]
    pub stats: Option<PathBuf>,

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

/// Tell what is in a scene.
#[derive(Debug, Args)]
pub struct InfoArgs {
    /// A scene file
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,

    /// What answers ray queries: `embree` or `bvh`
    #[arg(long, value_name = "NAME", default_value_t = Backend::default(), value_parser = parse_backend)]
    pub backend: Backend,

    /// Take unknown and unsupported parameters as warnings where something can stand in for them
    #[arg(long)]
    pub lenient: bool,

    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
}

/// List what scene files may use, with every parameter.
///
/// Of each parameter: name, type, default, allowed values, and what it means, with its unit. A scene reader goes by the same table.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  lucerna list materials
  lucerna list lights spot
  lucerna list samplers --json")]
pub struct ListArgs {
    /// What to list
    #[arg(value_name = "WHAT")]
    pub what: ListKind,

    /// Only the one of this name
    #[arg(value_name = "NAME")]
    pub name: Option<String>,

    /// Print one JSON array
    #[arg(long)]
    pub json: bool,
}

/// What `lucerna list` knows of.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum ListKind {
    /// `Material`
    Materials,
    /// `LightSource`, `AreaLightSource`
    Lights,
    /// `Texture`
    Textures,
    /// `Sampler`
    Samplers,
    /// `Integrator`
    Integrators,
}

/// Measure how far image A is from the reference B.
///
/// Prints one JSON object: mse, relmse (the mean of (A-B)^2 / (B^2 + 0.01)), mean_a, mean_b, mean_difference ((mean_a - mean_b) /
/// mean_b) and flip (LDR-FLIP of the clamped sRGB images at 67 pixels a degree).
#[derive(Debug, Args)]
pub struct CompareArgs {
    /// The image to judge (EXR or PNG)
    #[arg(value_name = "A")]
    pub a: PathBuf,

    /// The reference (EXR or PNG)
    #[arg(value_name = "B")]
    pub b: PathBuf,
}

/// `--max-depth`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MaxDepth(pub Option<u32>);

/// `--strategy`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum StrategyArg {
    /// Directions drawn from BSDFs: lights without extent are not found
    Bsdf,
    /// Points of lights, but where a path is specular
    Light,
    /// Both, by multiple importance sampling
    Mis,
}

impl From<StrategyArg> for Strategy {
    fn from(arg: StrategyArg) -> Self {
        match arg {
            StrategyArg::Bsdf => Self::Bsdf,
            StrategyArg::Light => Self::Light,
            StrategyArg::Mis => Self::Mis,
        }
    }
}

/// `--sampler`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum SamplerArg {
    /// Independent random numbers
    Independent,
    /// A point in each cell of a grid
    Stratified,
    /// Owen-scrambled Halton points
    Halton,
    /// Owen-scrambled Sobol points
    Sobol,
    /// The same, with blue noise over the picture
    Zsobol,
}

impl From<SamplerArg> for SamplerKind {
    fn from(arg: SamplerArg) -> Self {
        match arg {
            SamplerArg::Independent => Self::Independent,
            SamplerArg::Stratified => Self::Stratified(Strata::default()),
            SamplerArg::Halton => Self::Halton,
            SamplerArg::Sobol => Self::Sobol,
            SamplerArg::Zsobol => Self::ZSobol,
        }
    }
}

/// `--color`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum ColorArg {
    /// Four wavelengths a path
    Spectral,
    /// Linear sRGB
    Rgb,
}

impl From<ColorArg> for ColorMode {
    fn from(arg: ColorArg) -> Self {
        match arg {
            ColorArg::Spectral => Self::Spectral,
            ColorArg::Rgb => Self::Rgb,
        }
    }
}

/// `--build-quality`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum QualityArg {
    /// Fast builds
    Low,
    /// In between
    Medium,
    /// Fast queries
    High,
}

impl From<QualityArg> for BuildQuality {
    fn from(arg: QualityArg) -> Self {
        match arg {
            QualityArg::Low => Self::Low,
            QualityArg::Medium => Self::Medium,
            QualityArg::High => Self::High,
        }
    }
}

fn parse_backend(text: &str) -> Result<Backend, String> {
    text.parse().map_err(|error: crate::Error| error.to_string())
}

fn parse_max_depth(text: &str) -> Result<MaxDepth, String> {
    match text {
        "unlimited" => Ok(MaxDepth(None)),
        _ => text
            .parse()
            .map(|depth| MaxDepth(Some(depth)))
            .map_err(|_| "expected a number, 0 or more, or `unlimited`".to_owned()),
    }
}

fn parse_seed(text: &str) -> Result<u64, String> {
    text.parse()
        .map_err(|_| format!("expected an integer from 0 to {}", u64::MAX))
}

fn parse_finite(text: &str) -> Result<f32, String> {
    text.parse()
        .ok()
        .filter(|x: &f32| x.is_finite())
        .ok_or_else(|| "expected a number".to_owned())
}

/// The largest picture: 2^28 pixels.
const LARGEST_PICTURE: u64 = 1 << 28;

fn parse_resolution(text: &str) -> Result<[u32; 2], String> {
    let expected = || "expected width x height in pixels, as in 1920x1080".to_owned();
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(expected)?;
    let size: [u32; 2] = [
        width.parse().map_err(|_| expected())?,
        height.parse().map_err(|_| expected())?,
    ];
    match u64::from(size[0]) * u64::from(size[1]) {
        0 => Err("neither width nor height may be 0".to_owned()),
        pixels if pixels > LARGEST_PICTURE => Err("more than 2^28 pixels".to_owned()),
        _ => Ok(size),
    }
}

fn parse_crop(text: &str) -> Result<PixelRect, String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x0, y0, x1, y1]) if x0 < x1 && y0 < y1 => Ok(PixelRect { x0, y0, x1, y1 }),
        Some([_, _, _, _]) => Err("the crop is empty: expected x0 < x1 and y0 < y1".to_owned()),
        _ => Err("expected four pixel coordinates, as in 0,0,200,100".to_owned()),
    }
}

fn parse_pixel(text: &str) -> Result<PixelRect, String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x, y]) if x < u32::MAX && y < u32::MAX => Ok(PixelRect {
            x0: x,
            y0: y,
            x1: x + 1,
            y1: y + 1,
        }),
        _ => Err("expected two pixel coordinates, as in 12,34".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_is_well_formed() {
        Cli::command().debug_assert();
    }

    #[test]
    fn sizes_and_crops_are_checked() {
        assert_eq!(parse_resolution("640x480"), Ok([640, 480]));
        for bad in ["640", "0x480", "640x-1", "axb", "99999999x99999999"] {
            assert!(parse_resolution(bad).is_err(), "{bad}");
        }
        assert_eq!(
            parse_crop("1,2,3,4"),
            Ok(PixelRect {
                x0: 1,
                y0: 2,
                x1: 3,
                y1: 4
            })
        );
        for bad in ["1,2,3", "3,2,3,4", "1,2,3,4,5", "-1,2,3,4", ""] {
            assert!(parse_crop(bad).is_err(), "{bad}");
        }
    }
}
