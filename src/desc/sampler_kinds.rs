//! Every kind of sampler and its parameters, for the reader and for `lucerna list samplers`.

use super::parameter::{Parameter, ParameterKind};

/// A kind of sampler.
#[derive(Clone, Copy, Debug)]
pub struct SamplerEntry {
    /// As in a scene file, and on the command line.
    pub name: &'static str,
    /// What it is, in a sentence without a full stop.
    pub doc: &'static str,
    /// Its parameters.
    pub parameters: &'static [&'static Parameter],
}

/// All kinds.
pub static SAMPLERS: [SamplerEntry; 5] = [
    SamplerEntry {
        name: "independent",
        doc: "Independent uniform numbers",
        parameters: &[&INDEPENDENT_SAMPLES],
    },
    SamplerEntry {
        name: "stratified",
        doc: "One point in each cell of a grid, and in each slice of either axis",
        parameters: &[&X_SAMPLES, &Y_SAMPLES, &JITTER],
    },
    SamplerEntry {
        name: "halton",
        doc: "Owen-scrambled Halton points, a prime base for each dimension",
        parameters: &[&HALTON_SAMPLES],
    },
    SamplerEntry {
        name: "sobol",
        doc: "Owen-scrambled Sobol points, by four dimensions; pixels are independent",
        parameters: &[&PIXEL_SAMPLES],
    },
    SamplerEntry {
        name: "zsobol",
        doc: "The same along a Morton curve over the pixels, so that noise is of high frequency; the default",
        parameters: &[&PIXEL_SAMPLES],
    },
];

const fn integer(name: &'static str, default: i32, most: i32, doc: &'static str) -> Parameter {
    let range = (1, most);
    let kind = ParameterKind::Integer { default, range };
    Parameter { name, kind, doc }
}

const SAMPLES_DOC: &str = "Samples a pixel";
const MOST_SAMPLES: i32 = 1 << 24;

pub(super) static INDEPENDENT_SAMPLES: Parameter = integer("pixelsamples", 4, MOST_SAMPLES, SAMPLES_DOC);
pub(super) static HALTON_SAMPLES: Parameter = integer("pixelsamples", 16, MOST_SAMPLES, SAMPLES_DOC);
pub(super) static PIXEL_SAMPLES: Parameter = integer(
    "pixelsamples",
    16,
    MOST_SAMPLES,
    "Samples a pixel; Sobol points want a power of two",
);
pub(super) static X_SAMPLES: Parameter = integer("xsamples", 4, 4096, "Columns of the grid");
pub(super) static Y_SAMPLES: Parameter = integer(
    "ysamples",
    4,
    4096,
    "Rows of the grid; a pixel has columns times rows samples",
);
pub(super) static JITTER: Parameter = Parameter {
    name: "jitter",
    kind: ParameterKind::Bool(true),
    doc: "Whether points are at random places of their cells; if not, estimates have a bias",
};
