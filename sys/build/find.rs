//! Where Embree is installed. Debian has no pkg-config file for it, so known places are looked at, version 4 before 3.

use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Newest first: where both are installed, the newer one is taken.
const MAJORS: [u32; 2] = [4, 3];

/// Where distributions and `make install` put things.
const USUAL_PREFIXES: [&str; 2] = ["/usr", "/usr/local"];

/// One installed Embree.
#[derive(Debug, PartialEq, Eq)]
pub struct Embree {
    /// 3 or 4, as its directory and its library are called.
    pub major: u32,
    /// The directory that holds `rtcore.h`.
    pub include: PathBuf,
    /// The shared library that the linker will take.
    pub library: PathBuf,
}

/// The newest Embree under `prefix` (from `EMBREE_DIR`), or, without one, under the usual prefixes.
///
/// A prefix that was given and holds no Embree is an error: another one in its place would surprise.
///
/// # Errors
/// The message names every place looked at, and the packages to install.
pub fn find(prefix: Option<&Path>, arch: &str) -> Result<Embree, String> {
    match prefix {
        Some(prefix) => find_under(&[prefix], arch).map_err(|looked_at| {
            format!(
                "EMBREE_DIR is {}, and there is no Embree 3 or 4 there; it is the directory above include/ and lib/, and \
                 without it the usual places are searched\n{looked_at}",
                prefix.display()
            )
        }),
        None => find_under(&USUAL_PREFIXES.map(Path::new), arch).map_err(|looked_at| {
            format!(
                "Embree 3 or 4 is not installed\n  on Debian: apt install libembree-dev libclang-dev\n  elsewhere: set \
                 EMBREE_DIR to the directory above its include/ and lib/\n  without any: cargo build \
                 --no-default-features\n{looked_at}"
            )
        }),
    }
}

/// The first of the candidates that is there, or the list of all that are not.
fn find_under(prefixes: &[&Path], arch: &str) -> Result<Embree, String> {
    let mut looked_at = String::from("  looked at:");
    for major in MAJORS {
        for prefix in prefixes {
            let include = prefix.join(format!("include/embree{major}"));
            let libraries = library_candidates(prefix, major, arch);
            let library = libraries.iter().find(|path| path.exists());
            if let (true, Some(library)) = (include.join("rtcore.h").exists(), library) {
                return Ok(Embree {
                    major,
                    include,
                    library: library.clone(),
                });
            }
            // Writing to a String cannot fail.
            let _ = write!(looked_at, "\n    {}", include.join("rtcore.h").display());
            for path in &libraries {
                let _ = write!(looked_at, "\n    {}", path.display());
            }
        }
    }
    Err(looked_at)
}

fn library_candidates(prefix: &Path, major: u32, arch: &str) -> Vec<PathBuf> {
    ["lib".to_owned(), "lib64".to_owned(), format!("lib/{arch}-linux-gnu")]
        .iter()
        .map(|directory| prefix.join(directory).join(format!("libembree{major}.so")))
        .collect()
}
