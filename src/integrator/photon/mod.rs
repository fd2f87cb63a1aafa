//! Photon mapping (Jensen 1996; 2001), and its progressive form (Hachisuka and Jensen 2009; Knaus and Zwicker 2011).
//!
//! A render is a number of passes (`passes.rs`), each with wavelengths and a time that its photons and its camera paths share. First
//! photons leave the lights in proportion to power (`shoot.rs`, `tracer.rs`; those for caustics are aimed, `guide.rs`) and are kept where
//! they meet surfaces that are not specular (`stored.rs`, `map.rs`, `kd_tree.rs`). Then camera paths are followed by way of specular
//! surfaces to the first one that is not (`eye.rs`), where photons are asked:
//!
//! - the two-pass renderer (`gather.rs`) takes caustics from their own map, and looks for indirect light by rays that ask the global map
//!   where they end (final gathering), mostly for irradiance that was worked out beforehand (`irradiance.rs`);
//! - the progressive one (`progressive.rs`) takes both from photons within a radius that shrinks from pass to pass.
//!
//! Each path belongs to one term. With E the camera, L a light, S specular scattering, D any other (Heckbert 1990):
//!
//! | term | paths | found by |
//! |---|---|---|
//! | direct | E L, E D L | camera rays and light samples |
//! | specular | E S+ L, E S+ D L | the same, behind specular surfaces |
//! | caustic | E S* D S+ L | photons of the caustic map (L S+) |
//! | indirect | E S* D S* D (S\|D)* L | photons that have met a D, or final gathering |
//!
//! Light that leaves a surface along its normals only, which light samples do not find, counts as if it had been scattered by an S.
//! Scattering is S if the surface [is specular](crate::material::Bsdf::is_specular), or if a surface that is not did it by a delta lobe.

mod carried;
mod eye;
#[cfg(test)]
mod flux_tests;
mod gather;
mod guide;
mod irradiance;
mod kd_tree;
mod kernel;
mod limits;
mod map;
mod passes;
mod progressive;
mod shoot;
mod stored;
mod tracer;

use std::ops::AddAssign;

use crate::desc::{PhotonDesc, SppmDesc};

#[doc(hidden)]
pub use kd_tree::{KdTree, Nearest};
pub use limits::Limits;
pub(super) use shoot::Stand;

/// The two-pass renderer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhotonIntegrator {
    /// The greatest number of scattering events; `None` for any number.
    pub max_depth: Option<u32>,
    /// Its parameters.
    pub parameters: PhotonDesc,
    /// Only the irradiance of this map is shown, if any.
    pub shown: Option<ShownMap>,
}

/// A photon map to look at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShownMap {
    /// Of photons that come by way of specular surfaces only.
    Caustic,
    /// Of all.
    Global,
}

/// The progressive renderer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SppmIntegrator {
    /// The greatest number of scattering events; `None` for any number.
    pub max_depth: Option<u32>,
    /// Its parameters.
    pub parameters: SppmDesc,
    /// What may end it early.
    pub limits: Limits,
}

/// Photons of all passes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PhotonCount {
    /// That left a light.
    pub emitted: u64,
    /// That were kept: a photon may be kept several times on its way.
    pub stored: u64,
}

impl AddAssign for PhotonCount {
    fn add_assign(&mut self, other: Self) {
        self.emitted += other.emitted;
        self.stored += other.stored;
    }
}
