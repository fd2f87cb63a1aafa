//! Hands the version of the Embree that is linked on to the program, for `lucerna --version`.

use std::env;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // embree-sys says these; they are absent in a build without the feature `embree`.
    let part = |name: &str| env::var(format!("DEP_EMBREE_{name}")).ok();
    let version = match (part("VERSION_MAJOR"), part("VERSION_MINOR"), part("VERSION_PATCH")) {
        (Some(major), Some(minor), Some(patch)) => format!("{major}.{minor}.{patch}"),
        _ => "none".to_owned(),
    };
    println!("cargo::rustc-env=LUCERNA_EMBREE_VERSION={version}");
    // An Embree outside the places that the dynamic linker knows.
    if let Some(rpath) = part("RPATH") {
        println!("cargo::rustc-link-arg=-Wl,-rpath,{rpath}");
    }
}
