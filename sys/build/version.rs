//! The version of the installed headers, read by preprocessing a file that includes them: what the compiler will see, not what
//! a path suggests.

use std::path::Path;

/// As `rtcore_config.h` defines it.
pub struct Version {
    /// 3 or 4.
    pub major: u32,
    /// Minor version.
    pub minor: u32,
    /// Patch level.
    pub patch: u32,
}

/// The line of `probe.c` that the preprocessor fills in starts with this word.
const MARK: &str = "embree_sys_version";

/// Preprocesses `build/probe.c` with the headers in `include`.
pub fn probe(include: &Path) -> Result<Version, String> {
    let expanded = cc::Build::new()
        .include(include)
        .file("build/probe.c")
        .try_expand()
        .map_err(|error| {
            format!(
                "cannot preprocess {}: {error}",
                include.join("rtcore_config.h").display()
            )
        })?;
    let text = String::from_utf8_lossy(&expanded);
    parse(&text).ok_or_else(|| {
        format!(
            "{} does not define RTC_VERSION_MAJOR, _MINOR and _PATCH as numbers",
            include.join("rtcore_config.h").display()
        )
    })
}

/// The three numbers after the mark.
fn parse(expanded: &str) -> Option<Version> {
    let line = expanded.lines().find_map(|line| line.trim().strip_prefix(MARK))?;
    let mut numbers = line.split_whitespace().map(|word| word.parse().ok());
    Some(Version {
        major: numbers.next()??,
        minor: numbers.next()??,
        patch: numbers.next()??,
    })
}
