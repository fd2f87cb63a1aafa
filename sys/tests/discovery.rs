//! Where the build script looks for Embree, on trees made for the purpose.

#[path = "../build/find.rs"]
mod find;

use std::fs;
use std::path::{Path, PathBuf};

/// An empty directory of this test process.
fn fresh(name: &str) -> PathBuf {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{}-{name}", std::process::id()));
    fs::create_dir_all(&directory).expect("create");
    directory
}

fn install(prefix: &Path, major: u32, library_directory: &str) {
    let include = prefix.join(format!("include/embree{major}"));
    let library = prefix.join(library_directory);
    fs::create_dir_all(&include).expect("create");
    fs::create_dir_all(&library).expect("create");
    fs::write(include.join("rtcore.h"), "").expect("write");
    fs::write(library.join(format!("libembree{major}.so")), "").expect("write");
}

#[test]
fn the_newer_of_two_is_taken() {
    let prefix = fresh("both");
    install(&prefix, 3, "lib");
    install(&prefix, 4, "lib/x86_64-linux-gnu");
    let found = find::find(Some(&prefix), "x86_64").expect("found");
    assert_eq!(found.major, 4);
    assert_eq!(found.include, prefix.join("include/embree4"));
    assert_eq!(found.library, prefix.join("lib/x86_64-linux-gnu/libembree4.so"));
    fs::remove_dir_all(prefix).expect("remove");
}

#[test]
fn headers_without_a_library_do_not_count() {
    let prefix = fresh("headers");
    install(&prefix, 3, "lib64");
    fs::create_dir_all(prefix.join("include/embree4")).expect("create");
    fs::write(prefix.join("include/embree4/rtcore.h"), "").expect("write");
    let found = find::find(Some(&prefix), "x86_64").expect("found");
    assert_eq!((found.major, found.library), (3, prefix.join("lib64/libembree3.so")));
    fs::remove_dir_all(prefix).expect("remove");
}

#[test]
fn a_given_prefix_without_embree_is_an_error_that_names_every_place() {
    let prefix = fresh("nothing");
    let message = find::find(Some(&prefix), "aarch64").expect_err("nothing there");
    for place in [
        "include/embree4/rtcore.h",
        "include/embree3/rtcore.h",
        "lib/libembree4.so",
        "lib64/libembree3.so",
        "lib/aarch64-linux-gnu/libembree4.so",
    ] {
        let place = prefix.join(place);
        assert!(
            message.contains(place.to_str().expect("UTF-8")),
            "{place:?} in {message}"
        );
    }
    assert!(message.contains("EMBREE_DIR"), "{message}");
    fs::remove_dir_all(prefix).expect("remove");
}

#[test]
fn without_a_prefix_the_error_names_the_packages() {
    // No machine has libraries of this architecture in the multiarch place; the plain places may have Embree, then it is found.
    match find::find(None, "no-such-architecture") {
        Ok(found) => assert!(found.library.exists()),
        Err(message) => {
            assert!(message.contains("apt install libembree-dev libclang-dev"), "{message}");
            assert!(message.contains("/usr/local/include/embree4/rtcore.h"), "{message}");
        }
    }
}
