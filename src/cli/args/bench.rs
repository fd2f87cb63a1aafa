//! `lucerna bench` as typed.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::values::{Threads, parse_resolution, parse_seed, parse_threads, parse_within};
use crate::bench::synthetic::Recipe;
use crate::integrator::Integrator;

/// The arguments of `lucerna bench`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  lucerna bench scenes/cornell-box.pbrt
  lucerna bench --synthetic terrain:50k --synthetic terrain:1M --pin 1 --html terrain.html
  lucerna bench scenes/pool.pbrt --rays pool.rays      (records and saves)
  lucerna bench --rays pool.rays --only bvh            (replays)
  lucerna bench scenes/*.pbrt --threads 1..4 --only high --json rates.json")]
pub struct BenchArgs {
    /// Scene files, or meshes (.ply, .obj)
    #[arg(value_name = "SCENE")]
    pub scenes: Vec<PathBuf>,

    /// A world made for measuring, with about N triangles in a box
    ///
    /// KIND is box, terrain, soup, spheres, hair, slivers, diagonals (to 10M triangles) or instances (to 100M). N may be 50000, 50k, 2M or 1e6.
    #[arg(long, value_name = "KIND:N", value_parser = str::parse::<Recipe>)]
    pub synthetic: Vec<Recipe>,

    /// Replay the rays of this file; if there is none, save there what is recorded, of one scene
    ///
    /// The format is in docs/rays.md. It holds the triangles of the scene too, unless something moves or is no triangle: then name the scene
    /// again to replay its rays.
    #[arg(long, value_name = "FILE")]
    pub rays: Option<PathBuf>,

    /// Write the report to this file, as JSON
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,

    /// Write the report to this file, as a page with plots
    #[arg(long, value_name = "FILE")]
    pub html: Option<PathBuf>,

    /// Numbers of threads, as in 4, 1..8 or 1,2,4
    #[arg(long, value_name = "N", default_value = "1", allow_negative_numbers = true, value_parser = parse_threads)]
    pub threads: Threads,

    /// Run on these processors only, as in 0,2-3
    #[arg(long, value_name = "CPUS")]
    pub pin: Option<String>,

    /// How often each backend traces each ray
    #[arg(long, value_name = "N", default_value_t = 5, allow_negative_numbers = true, value_parser = |text: &str| parse_within(text, 1..=1000))]
    pub turns: u32,

    /// About so many rays of each kind
    #[arg(long, value_name = "N", default_value_t = 1 << 17, allow_negative_numbers = true,
        value_parser = |text: &str| parse_within(text, 1..=1 << 26))]
    pub count: u32,

    /// Every way to trace with builds of every quality; else only with those of high quality, and others as renders trace
    #[arg(long)]
    pub all: bool,

    /// Only what has this in its name, as in `high`, `bvh` or `8 wide`; several: all of them
    #[arg(long, value_name = "WORDS")]
    pub only: Vec<String>,

    /// How light transport is estimated in the recorded render [default: the scene's]
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(Integrator::NAMES))]
    pub integrator: Option<String>,

    /// Pixels of the recorded picture [default: the scene's]
    #[arg(long, value_name = "WxH", value_parser = parse_resolution)]
    pub resolution: Option<[u32; 2]>,

    /// Seed of all random numbers
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = parse_seed)]
    pub seed: u64,

    /// Take unknown and unsupported parameters of a scene as warnings where something can stand in for them
    #[arg(long)]
    pub lenient: bool,

    /// Do not say what is being done
    #[arg(long, short)]
    pub quiet: bool,
}
