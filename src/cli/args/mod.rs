//! The arguments as typed. Nothing here opens a file or knows a default that a scene could override.

mod bench;
mod render;
mod values;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};

pub use bench::BenchArgs;
pub use render::RenderArgs;
pub use values::ListKind;

use crate::accel::Backend;
use values::{parse_backend, parse_define};

/// What `--version` says: the program, and the Embree that it was built with.
const VERSION: &str = concat!(
    env!("CARGO_PKG_VERSION"),
    " (Embree: ",
    env!("LUCERNA_EMBREE_VERSION"),
    ")"
);

/// A physically based renderer: pbrt-v4 and Mitsuba 3 scenes in, EXR or PNG pictures out.
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

/// The subcommands. What their helps say is here: clap passes over what the structures of their arguments say of themselves.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render scenes to image files
    ///
    /// Several scenes, and several cameras of one scene (a `Camera` directive for each, with "string name"), are rendered one after
    /// the other in one process. One that fails does not stop the rest.
    Render(Box<RenderArgs>),
    /// Tell what is in a scene: counts, bounds, lights, materials, memory
    Info(InfoArgs),
    /// Measure how far image A is from the reference B
    ///
    /// Prints one JSON object: mse, relmse (the mean of (A-B)^2 / (B^2 + 0.01)), mean_a, mean_b, mean_difference ((mean_a - mean_b) /
    /// mean_b) and flip (LDR-FLIP of the clamped sRGB images at 67 pixels a degree).
    Compare(CompareArgs),
    /// Write a scene as a pbrt-v4 file
    ///
    /// The file, read back, is the same scene, number for number. Meshes of some size and images that have no file of their own go into
    /// a folder NAME-parts beside NAME.pbrt. What pbrt-v4 cannot say is written as an extension of Lucerna's, which is said.
    Convert(ConvertArgs),
    /// List what scene files may use, with every parameter: type, range, unit, default
    ///
    /// Of each parameter: type, name, unit, allowed values, default, and what it means. The scene reader goes by the same tables.
    List(ListArgs),
    /// Measure intersection backends on the rays of renders
    ///
    /// Records what a render of each scene asks of its backend: camera rays, bounces by depth, shadow rays, photons. Then traces the same
    /// rays through Embree and through Lucerna's own BVH, by every call and way that they have, side by side.
    Bench(Box<BenchArgs>),
}

/// The arguments of `lucerna info`.
#[derive(Debug, Args)]
pub struct InfoArgs {
    /// A scene file, or a mesh (.ply, .obj)
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,

    /// What answers ray queries, `embree` or `bvh` [default: the one that is better for the scene]
    ///
    /// Without it Lucerna's own BVH answers where there are a million primitives or more, and no instances: there it takes less
    /// memory, and on average less time; and where there are spheres among few primitives, which it traces several times as
    /// fast. Embree answers elsewhere.
    #[arg(long, value_name = "NAME", value_parser = parse_backend)]
    pub backend: Option<Backend>,

    /// Let Embree build what takes least memory, and is slower; Lucerna's BVH has one form
    #[arg(long)]
    pub compact: bool,

    /// In a Mitsuba scene, what `$NAME` stands for instead of its default; may be given several times
    #[arg(short = 'D', long = "define", value_name = "NAME=VALUE", value_parser = parse_define)]
    pub defines: Vec<(String, String)>,

    /// Take unknown and unsupported parameters as warnings where something can stand in for them
    #[arg(long)]
    pub lenient: bool,

    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
}

/// The arguments of `lucerna convert`.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  lucerna convert kitchen.xml kitchen.pbrt")]
pub struct ConvertArgs {
    /// A scene file, or a mesh (.ply, .obj) on its stage
    #[arg(value_name = "IN")]
    pub scene: PathBuf,

    /// The file to write
    #[arg(value_name = "OUT.pbrt")]
    pub output: PathBuf,

    /// In a Mitsuba scene, what `$NAME` stands for instead of its default; may be given several times
    #[arg(short = 'D', long = "define", value_name = "NAME=VALUE", value_parser = parse_define)]
    pub defines: Vec<(String, String)>,

    /// Take unknown and unsupported parameters as warnings where something can stand in for them
    #[arg(long)]
    pub lenient: bool,
}

/// The arguments of `lucerna list`.
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

/// The arguments of `lucerna compare`.
#[derive(Debug, Args)]
pub struct CompareArgs {
    /// The image to judge (EXR or PNG)
    #[arg(value_name = "A")]
    pub a: PathBuf,

    /// The reference (EXR or PNG)
    #[arg(value_name = "B")]
    pub b: PathBuf,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_is_well_formed() {
        Cli::command().debug_assert();
    }
}
