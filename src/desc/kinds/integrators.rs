//! Every integrator and its parameters, for the reader and for `lucerna list integrators`.

use super::Entry;
use super::parameter::{FloatRange, Parameter};
use super::samplers;

/// A map of them takes some 100 bytes each.
const MOST_PHOTONS: i32 = 100_000_000;

/// What is used if none is given.
pub static PATH: Entry = Entry::new(
    "Integrator",
    "path",
    "Path tracing with multiple importance sampling",
    &[
        &MAX_DEPTH,
        &LIGHT_SAMPLER,
        &STRATEGY,
        &HEURISTIC,
        &SPLITTING,
        &REGULARIZE,
    ],
);

/// All of them.
pub static INTEGRATORS: [Entry; 7] = [
    PATH,
    Entry::new(
        "Integrator",
        "kajiya",
        "The rendering equation taken literally: the oracle that others are tested against",
        &[&MAX_DEPTH, &TERMINATION, &ALPHA, &BRANCHING, &DISTRIBUTION],
    ),
    Entry::new(
        "Integrator",
        "bdpt",
        "Bidirectional path tracing with multiple importance sampling over all strategies",
        &[
            &MAX_DEPTH,
            &LIGHT_SAMPLER,
            &HEURISTIC,
            &REGULARIZE,
            &VISUALIZE_STRATEGIES,
            &VISUALIZE_WEIGHTS,
        ],
    ),
    Entry::new(
        "Integrator",
        "lightpath",
        "Paths from the lights to the camera; lights seen directly from the camera to the light",
        &[&MAX_DEPTH],
    ),
    Entry::new(
        "Integrator",
        "photon",
        "Photon mapping in two passes: caustic and global maps, final gathering",
        &[
            &MAX_DEPTH,
            &LIGHT_SAMPLER,
            &CAUSTIC_PHOTONS,
            &GLOBAL_PHOTONS,
            &PHOTONS_USED,
            &MAX_DISTANCE,
            &FINAL_GATHER_SAMPLES,
            &PASSES,
            &PHOTON_FILTER,
        ],
    ),
    Entry::new(
        "Integrator",
        "sppm",
        "Stochastic progressive photon mapping: as many passes as samples, each finer than the one before",
        &[
            &MAX_DEPTH,
            &LIGHT_SAMPLER,
            &PHOTONS_PER_ITERATION,
            &RADIUS,
            &PHOTON_FILTER,
            &samplers::SEED,
        ],
    ),
    Entry::new(
        "Integrator",
        "ambientocclusion",
        "How open surfaces are to what is around them, whatever lights and materials there are",
        &[&COS_SAMPLE, &OCCLUSION_DISTANCE],
    ),
];

pub static MAX_DEPTH: Parameter = Parameter::integer(
    "maxdepth",
    5,
    (-1, i32::MAX),
    "Scattering events of a path at most; -1 for no limit",
);
pub static LIGHT_SAMPLER: Parameter = Parameter::choice(
    "lightsampler",
    &["bvh", "power", "uniform", "exhaustive"],
    "How one of many lights is chosen; `exhaustive` is taken for `bvh`",
);
pub static STRATEGY: Parameter = Parameter::choice(
    "strategy",
    &["mis", "bsdf", "light"],
    "How light is looked for: by directions drawn from BSDFs, by points of lights, or by both",
);
pub static HEURISTIC: Parameter = Parameter::choice(
    "heuristic",
    &["power", "balance"],
    "How several ways of finding light are weighed",
);
pub static SPLITTING: Parameter = Parameter::integer(
    "splitting",
    1,
    (1, 1024),
    "Paths that one becomes at its first surface that is not specular",
);
pub static CAUSTIC_PHOTONS: Parameter = Parameter::integer(
    "causticphotons",
    -1,
    (-1, MOST_PHOTONS),
    "Photons that a pass keeps in the caustic map at most; 0 for none; -1 for 200000",
);
pub static GLOBAL_PHOTONS: Parameter = Parameter::integer(
    "globalphotons",
    -1,
    (-1, MOST_PHOTONS),
    "Photons that a pass keeps in the global map at most; 0 for none; -1 for 50000",
);
pub static PHOTONS_USED: Parameter = Parameter::integer(
    "nused",
    50,
    (1, 100_000),
    "Photons that a radiance estimate uses at most",
);
pub static MAX_DISTANCE: Parameter = Parameter::float(
    "maxdist",
    0.0,
    FloatRange::NotNegative,
    "How far away photons of an estimate may be; 0 for 2 % of the scene's radius",
)
.unit("scene units");
pub static FINAL_GATHER_SAMPLES: Parameter = Parameter::integer(
    "finalgathersamples",
    32,
    (1, 4096),
    "Directions in which a camera sample looks for indirect light",
);
pub static PASSES: Parameter = Parameter::integer(
    "passes",
    16,
    (1, 1 << 20),
    "Passes, each with photons of its own; pixel samples are rounded up to a multiple of them",
);
pub static PHOTON_FILTER: Parameter = Parameter::choice(
    "filter",
    &["cone", "gaussian", "constant"],
    "How photons count by their distance",
);
pub static PHOTONS_PER_ITERATION: Parameter = Parameter::integer(
    "photonsperiteration",
    -1,
    (-1, MOST_PHOTONS),
    "Photons emitted in a pass; -1 for as many as the picture has pixels",
);
pub static RADIUS: Parameter = Parameter::float(
    "radius",
    0.0,
    FloatRange::NotNegative,
    "Radius of the estimates of the first pass; 0 for three pixels, and six for indirect light",
)
.unit("scene units");
pub static COS_SAMPLE: Parameter = Parameter::flag(
    "cossample",
    true,
    "Whether directions are drawn in proportion to the cosine; if not, all alike",
);
pub static OCCLUSION_DISTANCE: Parameter = Parameter::float(
    "maxdistance",
    0.0,
    FloatRange::NotNegative,
    "How far away things may be that block; 0 for any distance",
)
.unit("scene units");
pub static VISUALIZE_STRATEGIES: Parameter =
    Parameter::flag("visualizestrategies", false, "pbrt's; no effect, see --strategies");
pub static VISUALIZE_WEIGHTS: Parameter =
    Parameter::flag("visualizeweights", false, "pbrt's; no effect, see --strategies");
pub static REGULARIZE: Parameter = Parameter::flag(
    "regularize",
    false,
    "pbrt's; no effect: surfaces stay as rough as they are",
);
pub static TERMINATION: Parameter = Parameter::choice(
    "termination",
    &["constant", "albedo"],
    "The probability of ending a path at a surface: `alpha`, or 1 - albedo within 0.05 and 0.95",
);
pub static ALPHA: Parameter = Parameter::float(
    "alpha",
    0.5,
    FloatRange::Ending,
    "The probability of ending a path at a surface",
);
pub static BRANCHING: Parameter = Parameter::integer("branching", 1, (1, 256), "Directions that a path goes on in");
pub static DISTRIBUTION: Parameter = Parameter::choice(
    "distribution",
    &["bsdf", "cosine", "uniform"],
    "What directions are drawn from where a surface is not specular",
);
