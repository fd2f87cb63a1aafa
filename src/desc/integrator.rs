//! How light transport is to be estimated.

/// How light transport is to be estimated.
#[derive(Clone, Debug, PartialEq)]
pub struct IntegratorDesc {
    /// The greatest number of scattering events of a path (pbrt's count; default 5); `None`: as many as Russian roulette grants.
    pub max_depth: Option<u32>,
    /// How the light of next-event estimation is chosen; the expectation is the same for all.
    pub light_sampler: LightSamplerKind,
    /// The estimator.
    pub kind: IntegratorKind,
}

/// The estimators, with the parameters that are theirs alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum IntegratorKind {
    /// Unidirectional path tracing.
    Path(PathDesc),
    /// The rendering equation taken literally, the oracle.
    Kajiya(KajiyaDesc),
    /// Bidirectional path tracing, its strategies weighed by this.
    Bdpt(Heuristic),
    /// From the lights to the camera.
    LightTracer,
}

/// Parameters of [`IntegratorKind::Path`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathDesc {
    /// Which of its two ways of finding light it uses.
    pub strategy: Strategy,
    /// How the two are weighed.
    pub heuristic: Heuristic,
    /// Into how many paths one is split where it first meets a surface that is not specular, at least 1.
    pub splitting: u32,
}

impl Default for PathDesc {
    fn default() -> Self {
        Self {
            strategy: Strategy::default(),
            heuristic: Heuristic::default(),
            splitting: 1,
        }
    }
}

/// How a path tracer finds light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Strategy {
    /// By directions drawn from BSDFs only: lights without extent are not found.
    Bsdf,
    /// By points of lights only, but where a path is specular.
    Light,
    /// Both, by multiple importance sampling.
    #[default]
    Mis,
}

/// Weights of multiple importance sampling (Veach 1997, section 9.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Heuristic {
    /// In proportion to the densities.
    Balance,
    /// In proportion to their squares.
    #[default]
    Power,
}

/// Parameters of [`IntegratorKind::Kajiya`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KajiyaDesc {
    /// The probability of ending a path at a surface.
    pub termination: Termination,
    /// Directions that a path goes on in, at least 1.
    pub branching: u32,
    /// What they are drawn from.
    pub distribution: Distribution,
}

impl Default for KajiyaDesc {
    fn default() -> Self {
        Self {
            termination: Termination::Constant(0.5),
            branching: 1,
            distribution: Distribution::Bsdf,
        }
    }
}

/// The probability alpha of ending a path at a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Termination {
    /// The same everywhere, in [0.05, 0.95].
    Constant(f32),
    /// One minus the surface's albedo, in [0.05, 0.95].
    Albedo,
}

/// What directions are drawn from where a surface is not specular.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Distribution {
    /// All alike.
    Uniform,
    /// In proportion to the cosine to the normal.
    Cosine,
    /// The BSDF's own.
    Bsdf,
}

/// How one of many lights is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum LightSamplerKind {
    /// By a bounding volume hierarchy over the lights (pbrt's default).
    #[default]
    Bvh,
    /// In proportion to emitted power.
    Power,
    /// All alike.
    Uniform,
}
