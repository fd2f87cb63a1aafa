//! Every integrator and its parameters, for the reader and for `lucerna list integrators`.

use super::Entry;
use super::parameter::{FloatRange, Parameter};

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
pub static INTEGRATORS: [Entry; 4] = [
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
pub static VISUALIZE_STRATEGIES: Parameter =
    Parameter::flag("visualizestrategies", false, "pbrt's; not supported if true");
pub static VISUALIZE_WEIGHTS: Parameter = Parameter::flag("visualizeweights", false, "pbrt's; not supported if true");
pub static REGULARIZE: Parameter = Parameter::flag("regularize", false, "pbrt's; not supported if true");
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
