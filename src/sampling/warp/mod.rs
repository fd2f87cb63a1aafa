//! Maps from uniform numbers to points and directions: each one a triple of sample, density and inverse.
//!
//! Uniform numbers are in [0, 1). `sample_x(u)` maps them to a point, `x_pdf` is the density of that point in the measure
//! that its type or its contract names, `invert_x` gives the numbers back (in [0, 1), up to rounding). Directions are of
//! unit length and relative to +z. A density may be zero at the rim of a domain, which rounding can reach: such a sample
//! contributes nothing and must be skipped, not divided by.

use super::BELOW_ONE;

mod direction;
mod interval;
mod octahedral;
mod phase;
mod plane;

pub use direction::{
    cosine_hemisphere_pdf, invert_cosine_hemisphere, invert_uniform_cone, invert_uniform_hemisphere,
    invert_uniform_sphere, one_minus_cos, sample_cosine_hemisphere, sample_uniform_cone, sample_uniform_hemisphere,
    sample_uniform_sphere, sin_cos_of_turn, uniform_cone_pdf, uniform_hemisphere_pdf, uniform_sphere_pdf,
};
pub use interval::{invert_linear, invert_tent, linear_pdf, sample_linear, sample_tent, tent_pdf};
pub use octahedral::{equal_area_square_to_sphere, invert_equal_area_square_to_sphere};
pub use phase::{henyey_greenstein_pdf, invert_henyey_greenstein, sample_henyey_greenstein};
pub use plane::{
    invert_regular_polygon, invert_uniform_disk, invert_uniform_triangle, regular_polygon_pdf, sample_regular_polygon,
    sample_uniform_disk, sample_uniform_triangle, uniform_disk_pdf, uniform_triangle_pdf,
};

/// Rounds what should be in [0, 1) into it.
#[inline]
fn into_unit(u: f32) -> f32 {
    u.clamp(0.0, BELOW_ONE)
}
