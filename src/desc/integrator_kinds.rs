//! Every integrator and its parameters, for the reader and for `lucerna list integrators`.

use super::parameter::{FloatRange, Parameter, ParameterKind};

/// An integrator.
#[derive(Clone, Copy, Debug)]
pub struct IntegratorEntry {
    /// As in a scene file, and on the command line.
    pub name: &'static str,
    /// What it is, in a sentence without a full stop.
    pub doc: &'static str,
    /// Its parameters.
    pub parameters: &'static [&'static Parameter],
}

/// All of them.
pub static INTEGRATORS: [IntegratorEntry; 2] = [
    IntegratorEntry {
        name: "path",
        doc: "Path tracing with multiple importance sampling",
        parameters: &[
            &MAX_DEPTH,
            &LIGHT_SAMPLER,
            &STRATEGY,
            &HEURISTIC,
            &SPLITTING,
            &REGULARIZE,
        ],
    },
    IntegratorEntry {
        name: "kajiya",
        doc: "The rendering equation taken literally: the oracle that others are tested against",
        parameters: &[&MAX_DEPTH, &TERMINATION, &ALPHA, &BRANCHING, &DISTRIBUTION],
    },
];

const fn integer(name: &'static str, default: i32, range: (i32, i32), doc: &'static str) -> Parameter {
    let kind = ParameterKind::Integer { default, range };
    Parameter { name, kind, doc }
}

const fn choice(name: &'static str, choices: &'static [&'static str], doc: &'static str) -> Parameter {
    let default = choices[0];
    let kind = ParameterKind::Choice { default, choices };
    Parameter { name, kind, doc }
}

pub(super) static MAX_DEPTH: Parameter = integer(
    "maxdepth",
    5,
    (-1, i32::MAX),
    "Scattering events of a path at most; -1 for no limit",
);
pub(super) static LIGHT_SAMPLER: Parameter = choice(
    "lightsampler",
    &["bvh", "power", "uniform", "exhaustive"],
    "How one of many lights is chosen; `exhaustive` is taken for `bvh`",
);
pub(super) static STRATEGY: Parameter = choice(
    "strategy",
    &["mis", "bsdf", "light"],
    "How light is looked for: by directions drawn from BSDFs, by points of lights, or by both",
);
pub(super) static HEURISTIC: Parameter = choice("heuristic", &["power", "balance"], "How the two of `mis` are weighed");
pub(super) static SPLITTING: Parameter = integer(
    "splitting",
    1,
    (1, 1024),
    "Paths that one becomes at its first surface that is not specular",
);
pub(super) static REGULARIZE: Parameter = Parameter {
    name: "regularize",
    kind: ParameterKind::Bool(false),
    doc: "pbrt's; not supported if true",
};
pub(super) static TERMINATION: Parameter = choice(
    "termination",
    &["constant", "albedo"],
    "The probability of ending a path at a surface: `alpha`, or 1 - albedo within 0.05 and 0.95",
);
pub(super) static ALPHA: Parameter = Parameter {
    name: "alpha",
    kind: ParameterKind::Float {
        default: 0.5,
        range: FloatRange::Ending,
    },
    doc: "The probability of ending a path at a surface",
};
pub(super) static BRANCHING: Parameter = integer("branching", 1, (1, 256), "Directions that a path goes on in");
pub(super) static DISTRIBUTION: Parameter = choice(
    "distribution",
    &["bsdf", "cosine", "uniform"],
    "What directions are drawn from where a surface is not specular",
);
