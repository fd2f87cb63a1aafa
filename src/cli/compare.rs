//! `lucerna compare`.

use super::args::CompareArgs;
use super::report::print_json;
use crate::error::Result;
use crate::image_io::Comparison;

/// Prints how far A is from B.
pub fn run(args: &CompareArgs) -> Result<()> {
    print_json(&Comparison::of_files(&args.a, &args.b)?)
}
