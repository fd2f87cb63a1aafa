//! `Integrator`. Beside pbrt-v4's parameters there are Lucerna's: see docs/extensions.md.

use super::reader::{ParamReader, unknown_type};
use crate::desc::{
    Distribution, Heuristic, IntegratorDesc, IntegratorKind, KajiyaDesc, LightSamplerKind, PathDesc, Strategy,
    Termination,
};

const DEFAULT_MAX_DEPTH: i32 = 5;

const KNOWN: [&str; 3] = ["path", "volpath", "kajiya"];
const LATER: [&str; 9] = [
    "ambientocclusion",
    "bdpt",
    "function",
    "lightpath",
    "mlt",
    "randomwalk",
    "simplepath",
    "simplevolpath",
    "sppm",
];

/// Path tracing with 5 bounces, as in pbrt-v4.
pub(super) fn default() -> IntegratorDesc {
    IntegratorDesc {
        max_depth: Some(DEFAULT_MAX_DEPTH.unsigned_abs()),
        light_sampler: LightSamplerKind::default(),
        kind: IntegratorKind::Path(PathDesc::default()),
    }
}

/// Reads an integrator of type `kind`.
pub(super) fn read(mut reader: ParamReader<'_>, kind: &str) -> IntegratorDesc {
    let span = reader.span;
    match kind {
        "path" | "kajiya" => {}
        "volpath" => {
            let message = "`volpath` is taken for `path`, which is the same without participating media";
            reader.report().warning(span, message);
        }
        _ => {
            let classes = (&KNOWN[..], &LATER[..]);
            unknown_type(reader.report(), "integrator", kind, span, classes, "`path` is used");
        }
    }
    let max_depth = reader.integer_in(
        "maxdepth",
        DEFAULT_MAX_DEPTH,
        |v| v >= -1,
        "0 or more, or -1 for no limit",
    );
    let max_depth = u32::try_from(max_depth).ok();
    let light_sampler = light_sampler(&mut reader);
    let kind = if kind == "kajiya" {
        IntegratorKind::Kajiya(kajiya(&mut reader, max_depth))
    } else {
        IntegratorKind::Path(path(&mut reader))
    };
    reader.finish();
    IntegratorDesc {
        max_depth,
        light_sampler,
        kind,
    }
}

fn path(reader: &mut ParamReader<'_>) -> PathDesc {
    if reader.boolean("regularize", false) {
        let span = reader.span_of("regularize");
        let message = "regularization is not supported";
        reader.report().unsupported(span, message, "it is left out");
    }
    let strategies = [
        ("mis", Strategy::Mis),
        ("bsdf", Strategy::Bsdf),
        ("light", Strategy::Light),
    ];
    let heuristics = [("power", Heuristic::Power), ("balance", Heuristic::Balance)];
    PathDesc {
        strategy: one_of(reader, "strategy", &strategies),
        heuristic: one_of(reader, "heuristic", &heuristics),
        splitting: reader
            .integer_in("splitting", 1, |n| (1..=1024).contains(&n), "between 1 and 1024")
            .unsigned_abs(),
    }
}

fn kajiya(reader: &mut ParamReader<'_>, max_depth: Option<u32>) -> KajiyaDesc {
    let alpha = reader.float_in(
        "alpha",
        0.5,
        |alpha| (0.05..=0.95).contains(&alpha),
        "between 0.05 and 0.95",
    ) as f32;
    let terminations = [
        ("constant", Termination::Constant(alpha)),
        ("albedo", Termination::Albedo),
    ];
    let distributions = [
        ("bsdf", Distribution::Bsdf),
        ("cosine", Distribution::Cosine),
        ("uniform", Distribution::Uniform),
    ];
    let desc = KajiyaDesc {
        termination: one_of(reader, "termination", &terminations),
        branching: reader
            .integer_in("branching", 1, |n| (1..=256).contains(&n), "between 1 and 256")
            .unsigned_abs(),
        distribution: one_of(reader, "distribution", &distributions),
    };
    // What survives at most, whatever the albedo.
    let survival = match desc.termination {
        Termination::Constant(alpha) => 1.0 - alpha,
        Termination::Albedo => 0.95,
    };
    let growth = desc.branching as f32 * survival;
    if max_depth.is_none() && desc.branching > 1 && growth >= 1.0 {
        let span = reader.span_of("branching");
        let message = format!(
            "paths of any length that branch into {} and survive with a probability of up to {survival} have no end: each makes {growth} \
             on average; bound `maxdepth`, or make `branching` less than {}",
            desc.branching,
            1.0 / survival
        );
        reader.report().error(span, message);
    }
    desc
}

/// The value of the string parameter `name`; the first of `values` is the default.
fn one_of<T: Copy>(reader: &mut ParamReader<'_>, name: &'static str, values: &[(&str, T)]) -> T {
    let Some((word, span)) = reader.string(name) else {
        return values[0].1;
    };
    if let Some((_, value)) = values.iter().find(|(known, _)| *known == word) {
        return *value;
    }
    let names: Vec<_> = values.iter().map(|(known, _)| format!("`{known}`")).collect();
    let message = format!("unknown {name} `{word}`: expected {}", names.join(", "));
    reader.report().error(span, message);
    values[0].1
}

fn light_sampler(reader: &mut ParamReader<'_>) -> LightSamplerKind {
    const KNOWN: [&str; 4] = ["bvh", "power", "uniform", "exhaustive"];
    let Some((name, span)) = reader.string("lightsampler") else {
        return LightSamplerKind::default();
    };
    match name.as_str() {
        "bvh" => LightSamplerKind::Bvh,
        "power" => LightSamplerKind::Power,
        "uniform" => LightSamplerKind::Uniform,
        "exhaustive" => {
            let message =
                "the light sampler `exhaustive` is not there: `bvh` is used, which converges to the same image";
            reader.report().warning(span, message);
            LightSamplerKind::Bvh
        }
        _ => {
            let message = format!("unknown light sampler `{name}`");
            reader.report().unknown(span, message, "`bvh` is used", &name, &KNOWN);
            LightSamplerKind::Bvh
        }
    }
}
