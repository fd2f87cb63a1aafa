//! The command line: one file a subcommand. [`args`] holds what was typed; a subcommand turns it into what is meant.

pub mod args;
mod bench;
mod compare;
mod convert;
mod info;
mod list;
mod memory;
mod pin;
mod render;
mod report;
mod stats;

use std::ffi::OsString;
use std::fs::OpenOptions;
use std::path::Path;
use std::process::ExitCode;

use clap::Parser;

use crate::error::{Error, Result};
use args::{Cli, Command};

/// Parses `args` and does what they say. Each error goes to `print_error` as it happens: one failed scene does not stop the
/// others. The exit code is 0 if all went well, 1 if a render or a file failed, 2 for bad usage or a bad scene; the highest, if
/// there are several.
pub fn run(args: impl IntoIterator<Item = OsString>, print_error: &dyn Fn(&Error)) -> ExitCode {
    let cli = match Cli::try_parse_from(args) {
        Ok(cli) => cli,
        Err(error) => {
            // Help and version go to stdout with code 0, errors to stderr with code 2. A closed pipe is not worth a panic.
            let _ = error.print();
            return ExitCode::from(error.exit_code() as u8);
        }
    };
    let result = match cli.command {
        Command::Render(args) => return ExitCode::from(render::run(&args, print_error)),
        Command::Info(args) => info::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Convert(args) => convert::run(&args),
        Command::List(args) => list::run(&args),
        Command::Bench(args) => bench::run(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            print_error(&error);
            ExitCode::from(error.exit_code())
        }
    }
}

/// Checks that a file can be written, and leaves what is in it until there is something else to be written.
fn check_writable(path: &Path) -> Result<()> {
    let opened = OpenOptions::new().write(true).create(true).truncate(false).open(path);
    opened.map(drop).map_err(|e| Error::io("create", path, e))
}
