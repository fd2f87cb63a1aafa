//! The program as scripts see it: exit codes, files, streams.

mod bench;
mod compare;
mod info;
mod list;
mod photons;
mod render;
mod streams;
mod usage;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

/// A working directory with a small scene.
struct Sandbox {
    directory: TempDir,
}

const SCENE: &str = "\
Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 16
Camera \"perspective\" \"float fov\" 60
Sampler \"sobol\" \"integer pixelsamples\" 4
WorldBegin
LightSource \"point\" \"point3 from\" [ 1 1 0 ]
Translate 0 0 4
Shape \"sphere\"
";

impl Sandbox {
    fn new() -> Self {
        let sandbox = Self {
            directory: tempfile::tempdir().expect("a directory for a test"),
        };
        sandbox.write("ball.pbrt", SCENE);
        sandbox
    }

    fn path(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).expect("a file of a test");
    }

    /// Runs the program here.
    fn lucerna(&self, arguments: &[&str]) -> Run {
        let output = Command::new(env!("CARGO_BIN_EXE_lucerna"))
            .args(arguments)
            .current_dir(self.directory.path())
            .output()
            .expect("the program runs");
        Run(output)
    }

    /// Everything here but scenes, sorted.
    fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.directory.path()).expect("the sandbox is there");
        let names = entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned());
        let mut names: Vec<_> = names
            .filter(|name| Path::new(name).extension().is_none_or(|e| e != "pbrt"))
            .collect();
        names.sort();
        names
    }
}

/// What a run of the program left.
struct Run(Output);

impl Run {
    fn stdout(&self) -> String {
        String::from_utf8_lossy(&self.0.stdout).into_owned()
    }

    fn stderr(&self) -> String {
        String::from_utf8_lossy(&self.0.stderr).into_owned()
    }

    /// Panics unless the exit code is `code`.
    #[track_caller]
    fn expect(self, code: i32) -> Self {
        assert_eq!(
            self.0.status.code(),
            Some(code),
            "stdout:\n{}\nstderr:\n{}",
            self.stdout(),
            self.stderr()
        );
        self
    }

    /// Panics unless standard error holds `text`.
    #[track_caller]
    fn says(self, text: &str) -> Self {
        assert!(self.stderr().contains(text), "`{text}` is not in:\n{}", self.stderr());
        self
    }
}
