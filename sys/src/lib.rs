//! Bindings to the installed Embree 3 or 4.
//!
//! What the two versions declare alike keeps Embree's own name (`rtcNewScene`); what they declare differently, foremost the
//! calls that trace rays, goes through a C shim with one signature for both (`embree_intersect8`), documented in `src/shim.h`.
//! So code above this crate needs no condition on the version: it may ask [`VERSION`], [`EMBREE_HAS_STREAMS`] and
//! [`RTC_MAX_INSTANCE_LEVEL_COUNT`], which are constants.
//!
//! C enums are integer constants here. Everything is unsafe as in C; nothing checks or owns.

#[allow(
    missing_docs,
    non_camel_case_types,
    non_snake_case,
    non_upper_case_globals,
    reason = "generated from C headers, whose names are kept"
)]
mod bindings {
    include!(concat!(env!("OUT_DIR"), "/bindings.rs"));
}

pub use bindings::*;

/// Version of the headers that this crate was built with: major, minor, patch.
pub const VERSION: (u32, u32, u32) = (RTC_VERSION_MAJOR, RTC_VERSION_MINOR, RTC_VERSION_PATCH);
