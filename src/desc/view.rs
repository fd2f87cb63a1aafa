//! Views: a camera with its film, filter and sampler.

use super::{CameraDesc, FilmDesc};
use crate::error::Span;
use crate::sampling::SamplerKind;

/// One picture to be taken of the scene.
#[derive(Clone, Debug)]
pub struct ViewDesc {
    /// Distinct among the views of a scene, fit to be a part of a file name. A single camera without a name is `camera`, several
    /// are `camera1`, `camera2`, ...
    pub name: String,
    /// Where from.
    pub camera: CameraDesc,
    /// Onto what.
    pub film: FilmDesc,
    /// How much of its surroundings a pixel sees.
    pub filter: FilterDesc,
    /// With which sample points.
    pub sampler: SamplerDesc,
    /// The `Camera` directive; the whole file's first byte if there is none.
    pub span: Span,
}

/// A pixel's reconstruction filter, a product of one function of x and the same of y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterDesc {
    /// The function.
    pub kind: FilterKind,
    /// Half the width of its support in x and y, in pixels; positive.
    pub radius: [f64; 2],
}

/// The shape of a pixel filter. The default is a Gaussian of radius 1.5.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilterKind {
    /// Constant; default radius 0.5.
    Box,
    /// A tent; default radius 2.
    Triangle,
    /// A Gaussian, less its value at the radius; default radius 1.5.
    Gaussian {
        /// Standard deviation in pixels, default 0.5; positive.
        sigma: f64,
    },
    /// Mitchell and Netravali's cubic, stretched to the radius; default radius 2.
    Mitchell {
        /// Default 1/3.
        b: f64,
        /// Default 1/3.
        c: f64,
    },
    /// A sinc under a Lanczos window; default radius 4.
    LanczosSinc {
        /// How many of its cycles fit into the radius, default 3; positive.
        tau: f64,
    },
    /// The four-term Blackman-Harris window (Lucerna's extension); default radius 2.
    BlackmanHarris,
}

/// Where sample points come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SamplerDesc {
    /// The sequence.
    pub kind: SamplerKind,
    /// Samples a pixel, positive; of strata as many as those. Default 16, for `independent` 4.
    pub pixel_samples: u32,
}
