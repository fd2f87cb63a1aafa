//! `lucerna render`: scenes times views to image files.

mod picture;
mod prepare;
mod profile;
mod strategies;

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::time::Instant;

use super::args::RenderArgs;
use super::check_writable;
use super::report::{Channel, Reporter};
use super::stats::Statistics;
use crate::error::{Error, Result};
use crate::image_io::ImageFormat;
use prepare::check_placeholders;

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
            check_writable(stats)?;
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
