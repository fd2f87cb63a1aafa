//! The `lucerna` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    lucerna::cli::run(std::env::args_os(), &|error| eprintln!("lucerna: {error}"))
}
