//! Lucerna, a physically based renderer that traces packets of rays.
//!
//! # The flow
//!
//! ```text
//! scene file -> SceneDesc -> Scene(backend) + View -> Integrator -> Film -> image file
//!   desc/                     scene/                  integrator/   film/   image_io/
//!                               |  accel/ (Embree | BVH), by packets of rays
//!                               |  material/  light/  camera/  texture/  medium/
//! ```
//!
//! Imports go upward only in this list; modules on one line do not import each other (`tests/architecture.rs` checks it):
//!
//! 1. [`error`] [`math`]
//! 2. [`sampling`] [`spectrum`] [`image_io`]
//! 3. [`desc`] [`geometry`]
//! 4. [`texture`]
//! 5. [`accel`] [`medium`]
//! 6. [`material`] [`light`] [`camera`] [`film`]
//! 7. [`scene`]
//! 8. [`integrator`]
//! 9. [`cli`] and `main`
//!
//! An integrator sees a scene, a view and a film: never a file format, never Embree. An [`accel`] backend answers "which
//! primitive, at what distance" and knows no material and no light.
//!
//! # Conventions
//!
//! - `wo` points back along the path already built, `wi` is the direction sampled; both leave the surface, have unit length and
//!   are in world space unless the name ends in `_local`. `ng` is the geometric normal, `ns` the shading normal.
//! - A density names its measure: [`sampling::SolidAnglePdf`], [`sampling::AreaPdf`] at interfaces, `_w` and `_a` for locals.
//!   A delta lobe is an enum arm, never a large number. Sampling returns an `Option`; a sample's value is never divided by its
//!   density beforehand.
//! - Radiance is in W·m⁻²·sr⁻¹·nm⁻¹, lengths in scene units, wavelengths in nm. A ray's time is scene time: 0 to 1 over the
//!   scene's transform times.
//! - Every random number is a pure function of (seed, pixel, sample, dimension), and every sum of a film is exact, so that an
//!   image has the same bits for any number of threads.

#![deny(unsafe_code)]

pub mod accel;
pub mod bench;
pub mod camera;
pub mod cli;
pub mod desc;
pub mod error;
pub mod film;
pub mod geometry;
pub mod image_io;
pub mod integrator;
pub mod light;
pub mod material;
pub mod math;
pub mod medium;
pub mod sampling;
pub mod scene;
pub mod spectrum;
pub mod texture;

pub use error::{Error, Result};
