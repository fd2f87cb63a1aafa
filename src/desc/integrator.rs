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

impl Default for IntegratorDesc {
    /// Path tracing with 5 bounces, as in pbrt-v4.
    fn default() -> Self {
        Self {
            max_depth: Some(5),
            light_sampler: LightSamplerKind::default(),
            kind: IntegratorKind::Path(PathDesc::default()),
        }
    }
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
    /// Photon mapping in two passes.
    Photon(PhotonDesc),
    /// Photon mapping in ever finer passes.
    Sppm(SppmDesc),
    /// How open surfaces are, instead of light.
    Occlusion(OcclusionDesc),
}

/// Parameters of [`IntegratorKind::Occlusion`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OcclusionDesc {
    /// Whether directions are drawn in proportion to the cosine; if not, all alike.
    pub cosine: bool,
    /// How far away things may be that block, in scene units, positive; `None`: any distance.
    pub max_distance: Option<f32>,
}

impl Default for OcclusionDesc {
    fn default() -> Self {
        Self {
            cosine: true,
            max_distance: None,
        }
    }
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

/// Parameters of [`IntegratorKind::Photon`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhotonDesc {
    /// Photons stored in the caustic map of a pass, at most; `None`: as many as the program thinks right.
    pub caustic_photons: Option<u32>,
    /// Photons stored in the global map of a pass, at most; `None` as above.
    pub global_photons: Option<u32>,
    /// Photons of a radiance estimate, at most; at least 1.
    pub used: u32,
    /// How far away these may be, in scene units; `None`: 2 % of the radius of the scene.
    pub max_distance: Option<f32>,
    /// Directions of a final gather, for each camera sample; at least 1.
    pub final_gather_samples: u32,
    /// Passes, each with maps of its own; at least 1.
    pub passes: u32,
    /// How photons count by their distance.
    pub filter: PhotonFilter,
    /// Which parts of the light are shown.
    pub terms: Terms,
}

impl Default for PhotonDesc {
    fn default() -> Self {
        Self {
            caustic_photons: None,
            global_photons: None,
            used: 50,
            max_distance: None,
            final_gather_samples: 32,
            passes: 16,
            filter: PhotonFilter::default(),
            terms: Terms::ALL,
        }
    }
}

/// Parameters of [`IntegratorKind::Sppm`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SppmDesc {
    /// Photons emitted in a pass; `None`: as many as the picture has pixels.
    pub photons: Option<u32>,
    /// Radius of the first pass's radiance estimates, in scene units; `None`: in proportion to what a pixel sees.
    pub radius: Option<f32>,
    /// How photons count by their distance.
    pub filter: PhotonFilter,
    /// Which parts of the light are shown.
    pub terms: Terms,
}

impl Default for SppmDesc {
    fn default() -> Self {
        Self {
            photons: None,
            radius: None,
            filter: PhotonFilter::default(),
            terms: Terms::ALL,
        }
    }
}

/// How photons count by their distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum PhotonFilter {
    /// The less, the farther away they are.
    #[default]
    Cone,
    /// By a Gaussian.
    Gaussian,
    /// All alike.
    Constant,
}

/// The parts that photon mapping takes light apart into; each path belongs to one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Term {
    /// What is lit straight by lights, and lights themselves.
    Direct,
    /// The same, seen in mirrors and through glass.
    Specular,
    /// Light that mirrors and glass throw on other surfaces.
    Caustic,
    /// What surfaces that are not specular throw on others.
    Indirect,
}

/// A set of [`Term`]s.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "see Term")]
pub struct Terms {
    pub direct: bool,
    pub specular: bool,
    pub caustic: bool,
    pub indirect: bool,
}

impl Terms {
    /// All of the light.
    pub const ALL: Self = Self {
        direct: true,
        specular: true,
        caustic: true,
        indirect: true,
    };
    /// None of it.
    pub const NONE: Self = Self {
        direct: false,
        specular: false,
        caustic: false,
        indirect: false,
    };

    /// These and `term`.
    #[must_use]
    pub fn with(mut self, term: Term) -> Self {
        match term {
            Term::Direct => self.direct = true,
            Term::Specular => self.specular = true,
            Term::Caustic => self.caustic = true,
            Term::Indirect => self.indirect = true,
        }
        self
    }

    /// Whether `term` is among them.
    #[inline]
    pub fn has(&self, term: Term) -> bool {
        match term {
            Term::Direct => self.direct,
            Term::Specular => self.specular,
            Term::Caustic => self.caustic,
            Term::Indirect => self.indirect,
        }
    }
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
