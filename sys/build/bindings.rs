//! The Rust declarations, made by bindgen from the installed headers: a name is bound because it is listed here.

use std::env;
use std::path::Path;

use bindgen::{Builder, EnumVariation, RustEdition, RustTarget};

/// Embree's own functions that Rust calls and that both versions declare alike, and the shim's for the rest.
const FUNCTIONS: &[&str] = &[
    // Device
    "rtcNewDevice",
    "rtcReleaseDevice",
    "rtcGetDeviceProperty",
    "rtcGetDeviceError",
    "rtcSetDeviceErrorFunction",
    "rtcSetDeviceMemoryMonitorFunction",
    // Scene
    "rtcNewScene",
    "rtcReleaseScene",
    "rtcAttachGeometryByID",
    "rtcCommitScene",
    "rtcSetSceneBuildQuality",
    "rtcSetSceneFlags",
    // Geometry
    "rtcNewGeometry",
    "rtcReleaseGeometry",
    "rtcCommitGeometry",
    "rtcSetGeometryTimeStepCount",
    "rtcSetGeometryMask",
    "rtcSetGeometryBuildQuality",
    "rtcSetSharedGeometryBuffer",
    "rtcSetNewGeometryBuffer",
    "rtcSetGeometryTessellationRate",
    "rtcSetGeometryUserData",
    "rtcSetGeometryUserPrimitiveCount",
    "rtcSetGeometryBoundsFunction",
    "rtcSetGeometryIntersectFunction",
    "rtcSetGeometryOccludedFunction",
    "rtcSetGeometryIntersectFilterFunction",
    "rtcSetGeometryOccludedFilterFunction",
    "rtcSetGeometryInstancedScene",
    "rtcSetGeometryTransform",
    "rtcGetGeometryTransform",
    "rtcSetGeometryTransformQuaternion",
    // src/shim.h
    "embree_.*",
];

/// The enums, whose members come as constants, and the packets that queries take. What these name comes along.
const TYPES: &[&str] = &[
    "RTCBufferType",
    "RTCBuildQuality",
    "RTCDeviceProperty",
    "RTCError",
    "RTCFormat",
    "RTCGeometryType",
    "RTCSceneFlags",
    "RTCRayHit",
    "RTCRayHit4",
    "RTCRayHit8",
    "RTCRayHit16",
    "EmbreeConstant",
    "EmbreeContext",
    "EmbreeQuery",
];

/// Macros.
const VARIABLES: &[&str] = &[
    "RTC_MAX_INSTANCE_LEVEL_COUNT",
    "RTC_MAX_TIME_STEP_COUNT",
    "RTC_VERSION_MAJOR",
    "RTC_VERSION_MINOR",
    "RTC_VERSION_PATCH",
];

/// Writes the bindings of `src/shim.h`, which includes Embree's headers, to `path`.
pub fn generate(include: &Path, path: &Path) -> Result<(), String> {
    // bindgen loads libclang when it first needs it, and panics where there is none.
    std::panic::catch_unwind(bindgen::clang_version).map_err(|_| {
        "bindgen found no libclang\n  on Debian: apt install libembree-dev libclang-dev\n  elsewhere: set LIBCLANG_PATH to \
         its directory\n  without Embree: cargo build --no-default-features"
            .to_owned()
    })?;
    let mut builder = Builder::default()
        .header("src/shim.h")
        .clang_arg(format!("-I{}", include.display()))
        .rust_edition(RustEdition::Edition2024)
        .rust_target(rust_target()?)
        // A value that the headers did not list would make a Rust enum undefined behaviour.
        .default_enum_style(EnumVariation::Consts)
        .prepend_enum_name(false)
        .generate_comments(false)
        .layout_tests(true)
        .allowlist_recursively(true)
        .parse_callbacks(Box::new(bindgen::CargoCallbacks::new()));
    builder = FUNCTIONS.iter().fold(builder, Builder::allowlist_function);
    builder = TYPES.iter().fold(builder, Builder::allowlist_type);
    builder = VARIABLES.iter().fold(builder, Builder::allowlist_var);
    let bindings = builder
        .generate()
        .map_err(|error| format!("bindgen cannot read the headers in {}: {error}", include.display()))?;
    bindings
        .write_to_file(path)
        .map_err(|error| format!("cannot write {}: {error}", path.display()))
}

/// The oldest compiler that this package promises to build with.
fn rust_target() -> Result<RustTarget, String> {
    let version = env::var("CARGO_PKG_RUST_VERSION").map_err(|_| "sys/Cargo.toml has no rust-version")?;
    let minor = version.split('.').nth(1).and_then(|minor| minor.parse().ok());
    let minor = minor.ok_or_else(|| format!("rust-version {version} is not of the form 1.N"))?;
    RustTarget::stable(minor, 0).map_err(|error| error.to_string())
}
