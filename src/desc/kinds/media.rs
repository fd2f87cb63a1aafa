//! Every kind of medium and its parameters, for the reader and for `lucerna list media`.

use super::Entry;
use super::parameter::{FloatRange, Parameter, ParameterKind};
use crate::desc::measured_media::MEASURED_MEDIA;

/// All kinds.
pub static MEDIA: [Entry; 1] = [Entry::new(
    "MakeNamedMedium",
    "homogeneous",
    "The same everywhere: absorbs, scatters by Henyey and Greenstein's phase function, and emits; `path` renders it",
    &[
        &SIGMA_A, &SIGMA_S, &SIGMA_T, &ALBEDO, &SCALE, &PRESET, &G, &LE, &LE_SCALE,
    ],
)];

const PER_UNIT: &str = "1 / scene units";

pub static SIGMA_A: Parameter = Parameter::new(
    "sigma_a",
    ParameterKind::Spectrum { default: 1.0 },
    "Absorption coefficient",
)
.unit(PER_UNIT);
pub static SIGMA_S: Parameter = Parameter::new(
    "sigma_s",
    ParameterKind::Spectrum { default: 1.0 },
    "Scattering coefficient",
)
.unit(PER_UNIT);
pub static SIGMA_T: Parameter = Parameter::new(
    "sigma_t",
    ParameterKind::Spectrum { default: 1.0 },
    "Extinction coefficient; with it or with albedo there is no sigma_a and no sigma_s",
)
.unit(PER_UNIT);
pub static ALBEDO: Parameter = Parameter::new(
    "albedo",
    ParameterKind::Spectrum { default: 0.75 },
    "The part of extinction that is scattering, in [0, 1]",
);
pub static SCALE: Parameter = Parameter::float("scale", 1.0, FloatRange::NotNegative, "A factor of the coefficients");
pub static PRESET: Parameter = Parameter::new(
    "preset",
    ParameterKind::Choice {
        default: "",
        choices: &PRESETS,
    },
    "Measured coefficients, per mm, in the place of both; scattering is reduced by 1 - g",
);
pub static G: Parameter = Parameter::float(
    "g",
    0.0,
    FloatRange::Asymmetry,
    "Mean cosine of the angle by which scattered light turns",
);
pub static LE: Parameter = Parameter::new(
    "Le",
    ParameterKind::Spectrum { default: 0.0 },
    "Radiance that it emits: along a ray, the absorption coefficient times this",
);
pub static LE_SCALE: Parameter = Parameter::float(
    "Lescale",
    1.0,
    FloatRange::NotNegative,
    "The luminance of Le, whatever its own",
)
.unit("cd/m^2 / 683");

static PRESETS: [&str; MEASURED_MEDIA.len() + 1] = {
    let mut names = [""; MEASURED_MEDIA.len() + 1];
    let mut i = 0;
    while i < MEASURED_MEDIA.len() {
        names[i + 1] = MEASURED_MEDIA[i].name;
        i += 1;
    }
    names
};
