//! Mistakes to make on purpose.

/// A mistake, of those that renderers are known to make: tests show that they notice each. Builds without debug assertions make none.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fault {
    #[default]
    None,
    /// Light samples without the cosine at the surface.
    MissingCosine,
    /// Light samples whose density by area becomes one by solid angle without the light's cosine.
    WrongJacobian,
    /// Light found by both techniques counts in full for each.
    LightTwice,
    /// Radiance that is refracted is not scaled by the square of the relative index.
    EtaForgotten,
    /// The weight of a BSDF sample takes the light's density by area for that by solid angle.
    PdfInWrongMeasure,
    /// Bidirectional weights without the strategies of light samples and light subpaths.
    StrategyLeftOut,
    /// Light subpaths are scattered by the BSDF of shading normals, not by its adjoint.
    AdjointForgotten,
    /// Bidirectional weights count connections of vertices that scatter by delta lobes.
    DeltaConnected,
    /// No mistake: paths are taken one by one that are otherwise taken together. In all builds.
    OneByOne,
}

impl Fault {
    /// Whether this is the mistake to make.
    #[inline(always)]
    pub(super) fn is(self, fault: Self) -> bool {
        cfg!(debug_assertions) && self == fault
    }
}
