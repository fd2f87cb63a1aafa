//! Finds the installed Embree, makes bindings of its headers, and compiles the C shim that gives versions 3 and 4 one
//! signature.
//!
//! What it hands on: `DEP_EMBREE_VERSION_MAJOR`, `_MINOR` and `_PATCH`, and `DEP_EMBREE_RPATH` where the library lies outside the
//! places that the dynamic linker searches by itself.

mod bindings;
mod find;
mod version;

use std::env;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), String> {
    for source in ["shim.c", "shim.h", "layout.c"] {
        println!("cargo::rerun-if-changed=src/{source}");
    }
    println!("cargo::rerun-if-changed=build");
    let arch = required("CARGO_CFG_TARGET_ARCH")?;
    let prefix = variable("EMBREE_DIR").map(PathBuf::from);
    let found = find::find(prefix.as_deref(), &arch)?;
    // An upgrade in place must be noticed.
    println!("cargo::rerun-if-changed={}", found.include.display());
    println!("cargo::rerun-if-changed={}", found.library.display());

    let version = version::probe(&found.include)?;
    if version.major != found.major {
        return Err(format!(
            "{} says that it is Embree {}, but lies beside {}",
            found.include.display(),
            version.major,
            found.library.display()
        ));
    }
    println!("cargo::metadata=version_major={}", version.major);
    println!("cargo::metadata=version_minor={}", version.minor);
    println!("cargo::metadata=version_patch={}", version.patch);

    let out_dir = PathBuf::from(required("OUT_DIR")?);
    bindings::generate(&found.include, &out_dir.join("bindings.rs"))?;
    compile_shim(&found.include)?;
    link(&found, prefix.is_some())
}

/// The layout table is an object of its own in the archive: only the test that names it links it.
fn compile_shim(include: &Path) -> Result<(), String> {
    cc::Build::new()
        .std("c11")
        .include(include)
        .files(["src/shim.c", "src/layout.c"])
        .try_compile("embree_shim")
        .map_err(|error| format!("cannot compile sys/src/shim.c: {error}; a C compiler comes with `apt install gcc`"))
}

/// After the shim, which needs it: a static archive's symbols are looked up in what follows it.
fn link(found: &find::Embree, by_prefix: bool) -> Result<(), String> {
    let directory = found.library.parent().ok_or("the library lies in no directory")?;
    println!("cargo::rustc-link-search=native={}", directory.display());
    println!("cargo::rustc-link-lib=dylib=embree{}", found.major);
    if by_prefix {
        println!("cargo::rustc-link-arg=-Wl,-rpath,{}", directory.display());
        println!("cargo::metadata=rpath={}", directory.display());
    }
    Ok(())
}

/// The only reader of variables that a person may set: cargo is told to come back when one changes.
fn variable(name: &str) -> Option<String> {
    println!("cargo::rerun-if-env-changed={name}");
    env::var(name).ok().filter(|value| !value.is_empty())
}

/// A variable that cargo itself sets for build scripts.
fn required(name: &str) -> Result<String, String> {
    env::var(name).map_err(|_| format!("cargo did not set {name}: this is a build script"))
}
