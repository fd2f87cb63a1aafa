//! `Sampler`.

use super::reader::{ParamReader, unknown_type};
use crate::desc::kinds::samplers as kinds;
use crate::desc::{SAMPLERS, SamplerDesc, SamplerKind};
use crate::sampling::Strata;

/// The sampler of a file without one, as in pbrt-v4.
pub(super) const DEFAULT: SamplerDesc = SamplerDesc {
    kind: SamplerKind::ZSobol,
    pixel_samples: 16,
};

/// The same in pbrt-v3.
pub(super) const OLD_DEFAULT: SamplerDesc = SamplerDesc {
    kind: SamplerKind::Halton,
    pixel_samples: 16,
};

/// Reads a sampler. Those that pbrt has and Lucerna has not are replaced: what they converge to is the same.
pub(super) fn read(mut reader: ParamReader<'_>, kind: &str) -> SamplerDesc {
    let span = reader.span;
    let kind = match kind {
        // Its points, pair by pair, are what `sobol` has here.
        "paddedsobol" => "sobol",
        "pmj02bn" => {
            let message = "the sampler `pmj02bn` is not there: `zsobol` is used, which converges to the same image";
            reader.report().warning(span, message);
            "zsobol"
        }
        _ => kind,
    };
    let entry = SAMPLERS.iter().find(|entry| entry.name == kind).unwrap_or_else(|| {
        let known: Vec<_> = SAMPLERS.iter().map(|entry| entry.name).chain(REPLACED).collect();
        unknown_type(
            reader.report(),
            "sampler",
            kind,
            span,
            (&known, &[]),
            "`zsobol` is used",
        );
        &kinds::Z_SOBOL
    });
    let samples = |reader: &mut ParamReader<'_>, by| reader.integer_by(by).unsigned_abs();
    let (kind, pixel_samples) = match entry.name {
        "independent" => (
            SamplerKind::Independent,
            samples(&mut reader, &kinds::INDEPENDENT_SAMPLES),
        ),
        "stratified" => {
            let [columns, rows] = [&kinds::X_SAMPLES, &kinds::Y_SAMPLES].map(|side| samples(&mut reader, side));
            let jitter = reader.bool_by(&kinds::JITTER);
            let strata = Strata { columns, rows, jitter };
            (SamplerKind::Stratified(strata), columns * rows)
        }
        "halton" => (SamplerKind::Halton, samples(&mut reader, &kinds::HALTON_SAMPLES)),
        "sobol" => (SamplerKind::Sobol, samples(&mut reader, &kinds::PIXEL_SAMPLES)),
        _ => (SamplerKind::ZSobol, samples(&mut reader, &kinds::PIXEL_SAMPLES)),
    };
    reader.inert_by(&[&kinds::RANDOMIZATION, &kinds::SEED]);
    reader.finish_by(entry);
    SamplerDesc { kind, pixel_samples }
}

/// Names of pbrt that stand for one of Lucerna's.
const REPLACED: [&str; 2] = ["paddedsobol", "pmj02bn"];
