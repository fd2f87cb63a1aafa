//! Every kind of sampler and its parameters, for the reader and for `lucerna list samplers`.

use super::Entry;
use super::parameter::Parameter;

/// What is used if none is given.
pub static Z_SOBOL: Entry = Entry::new(
    "Sampler",
    "zsobol",
    "The same along a Morton curve over the pixels, so that noise is of high frequency; the default",
    &[&PIXEL_SAMPLES, &RANDOMIZATION, &SEED],
);

/// All kinds.
pub static SAMPLERS: [Entry; 5] = [
    Entry::new(
        "Sampler",
        "independent",
        "Independent uniform numbers",
        &[&INDEPENDENT_SAMPLES, &RANDOMIZATION, &SEED],
    ),
    Entry::new(
        "Sampler",
        "stratified",
        "One point in each cell of a grid, and in each slice of either axis",
        &[&X_SAMPLES, &Y_SAMPLES, &JITTER, &RANDOMIZATION, &SEED],
    ),
    Entry::new(
        "Sampler",
        "halton",
        "Owen-scrambled Halton points, a prime base for each dimension",
        &[&HALTON_SAMPLES, &RANDOMIZATION, &SEED],
    ),
    Entry::new(
        "Sampler",
        "sobol",
        "Owen-scrambled Sobol points, by four dimensions; pixels are independent",
        &[&PIXEL_SAMPLES, &RANDOMIZATION, &SEED],
    ),
    Z_SOBOL,
];

const SAMPLES_DOC: &str = "Samples a pixel";
const MOST_SAMPLES: i32 = 1 << 24;

pub static INDEPENDENT_SAMPLES: Parameter = Parameter::integer("pixelsamples", 4, (1, MOST_SAMPLES), SAMPLES_DOC);
pub static HALTON_SAMPLES: Parameter = Parameter::integer("pixelsamples", 16, (1, MOST_SAMPLES), SAMPLES_DOC);
pub static PIXEL_SAMPLES: Parameter = Parameter::integer(
    "pixelsamples",
    16,
    (1, MOST_SAMPLES),
    "Samples a pixel; Sobol points want a power of two",
);
pub static X_SAMPLES: Parameter = Parameter::integer("xsamples", 4, (1, 4096), "Columns of the grid");
pub static Y_SAMPLES: Parameter = Parameter::integer(
    "ysamples",
    4,
    (1, 4096),
    "Rows of the grid; a pixel has columns times rows samples",
);
pub static JITTER: Parameter = Parameter::flag(
    "jitter",
    true,
    "Whether points are at random places of their cells; if not, estimates have a bias",
);
pub static RANDOMIZATION: Parameter = Parameter::inert("randomization", "string", "points are always Owen-scrambled");
pub static SEED: Parameter = Parameter::inert("seed", "integer", "give the seed on the command line, by --seed");
