//! Hands the version of the Embree that is linked on to the program, for `lucerna --version`; writes the table of spectra of sRGB
//! colours that textures are looked up in.

use std::env;
use std::fs;
use std::path::Path;
use std::time::Instant;

/// The solver and the tables that it needs are those of the program; the rest of them is not used here.
#[path = "src/spectrum"]
#[allow(dead_code, unused_imports, missing_docs)]
mod spectrum {
    mod cie;
    mod color_space;
    mod description;
    mod named;
    mod rgb2spec;
    mod sampled;
    pub mod table_builder;
    mod wavelengths;

    pub use color_space::ColorSpace;
    pub use sampled::{LANES, SampledSpectrum};
    pub use wavelengths::{LAMBDA_D, LAMBDA_MAX, LAMBDA_MIN, Wavelengths};
}

fn main() {
    for source in [
        "build.rs",
        "src/spectrum/table_builder.rs",
        "src/spectrum/cie.rs",
        "src/spectrum/color_space.rs",
        "src/spectrum/data",
        "src/spectrum/named.rs",
        "src/spectrum/rgb2spec.rs",
    ] {
        println!("cargo::rerun-if-changed={source}");
    }
    // embree-sys says these; they are absent in a build without the feature `embree`.
    let part = |name: &str| env::var(format!("DEP_EMBREE_{name}")).ok();
    let version = match (part("VERSION_MAJOR"), part("VERSION_MINOR"), part("VERSION_PATCH")) {
        (Some(major), Some(minor), Some(patch)) => format!("{major}.{minor}.{patch}"),
        _ => "none".to_owned(),
    };
    println!("cargo::rustc-env=LUCERNA_EMBREE_VERSION={version}");
    println!("cargo::rustc-env=LUCERNA_COMPILER={}", compiler());
    // An Embree outside the places that the dynamic linker knows.
    if let Some(rpath) = part("RPATH") {
        println!("cargo::rustc-link-arg=-Wl,-rpath,{rpath}");
    }
    write_table();
}

/// The compiler, the profile and the flags of this build, for reports of measurements.
fn compiler() -> String {
    let variable = |name: &str| env::var(name).unwrap_or_default();
    let rustc = std::process::Command::new(variable("RUSTC")).arg("--version").output();
    let version = rustc.map_or_else(
        |_| "rustc".to_owned(),
        |out| String::from_utf8_lossy(&out.stdout).trim().to_owned(),
    );
    let flags = variable("CARGO_ENCODED_RUSTFLAGS").replace('\u{1f}', " ");
    let profile = format!("profile {}, opt-level {}", variable("PROFILE"), variable("OPT_LEVEL"));
    [version, profile, flags]
        .into_iter()
        .filter(|part| !part.is_empty())
        .collect::<Vec<_>>()
        .join(", ")
}

/// Writes the table beside the program's objects.
fn write_table() {
    let directory = env::var("OUT_DIR").expect("cargo sets OUT_DIR");
    let start = Instant::now();
    let bytes: Vec<u8> = spectrum::table_builder::exact::<64>(spectrum::ColorSpace::Srgb)
        .iter()
        .flat_map(|c| c.to_le_bytes())
        .collect();
    fs::write(Path::new(&directory).join("rgb_table.bin"), bytes).expect("the build directory can be written");
    println!(
        "spectra of sRGB colours solved for in {:.1} s",
        start.elapsed().as_secs_f64()
    );
}
