//! Random numbers and what is made of them: samplers, warps, discrete distributions, densities and their measures.

/// A probability density with respect to solid angle, in sr⁻¹.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct SolidAnglePdf(pub f32);

/// A probability density with respect to area, in scene units⁻².
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct AreaPdf(pub f32);
