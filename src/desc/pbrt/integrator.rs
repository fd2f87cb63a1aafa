//! `Integrator`. Beside pbrt-v4's parameters there are Lucerna's: see docs/extensions.md.

use super::reader::{ParamReader, unknown_type};
use crate::desc::kinds::Parameter;
use crate::desc::kinds::{integrators as kinds, samplers};
use crate::desc::{
    Distribution, Heuristic, INTEGRATORS, IntegratorDesc, IntegratorKind, KajiyaDesc, LightSamplerKind, OcclusionDesc,
    PathDesc, PhotonDesc, PhotonFilter, SppmDesc, Strategy, Termination, Terms,
};

/// pbrt's integrators that one of Lucerna's stands for: its name and what to say. All converge to
/// the same image.
const STAND_INS: [(&str, &str, &str); 4] = [
    (
        "mlt",
        "bdpt",
        "`mlt` is not there: `bdpt` is used, which has the same paths but samples them independently",
    ),
    (
        "simplevolpath",
        "path",
        "`simplevolpath` is taken for `path`, which is less noisy",
    ),
    (
        "simplepath",
        "path",
        "`simplepath` is taken for `path`, which is less noisy",
    ),
    (
        "randomwalk",
        "path",
        "`randomwalk` is taken for `path` with the strategy `bsdf`, which meets the same light with less noise",
    ),
];

/// Those that render something else than light.
const OTHERS: [(&str, &str); 1] = [("function", "integrates a function, not light")];

/// Reads an integrator of type `kind`.
pub(super) fn read(mut reader: ParamReader<'_>, kind: &str) -> IntegratorDesc {
    // One integrator here, with and without media.
    let kind = if kind == "volpath" { "path" } else { kind };
    let stand_in = STAND_INS.iter().find(|&&(name, ..)| name == kind);
    let name = stand_in.map_or(kind, |&(_, name, _)| name);
    let entry = INTEGRATORS.iter().find(|entry| entry.name == name).unwrap_or_else(|| {
        unknown(&mut reader, kind);
        &kinds::PATH
    });
    if let Some((_, _, message)) = stand_in {
        let span = reader.span;
        reader.report().warning(span, *message);
    }
    let max_depth = if entry.has(kinds::MAX_DEPTH.name) {
        u32::try_from(reader.integer_by(&kinds::MAX_DEPTH)).ok()
    } else {
        IntegratorDesc::default().max_depth
    };
    // The oracle chooses no lights.
    let (light_sampler, kind) = match entry.name {
        "kajiya" => {
            let kajiya = kajiya(&mut reader, max_depth);
            (LightSamplerKind::default(), IntegratorKind::Kajiya(kajiya))
        }
        "photon" => (light_sampler(&mut reader), IntegratorKind::Photon(photon(&mut reader))),
        "sppm" => (light_sampler(&mut reader), IntegratorKind::Sppm(sppm(&mut reader))),
        "lightpath" => (LightSamplerKind::default(), IntegratorKind::LightTracer),
        "ambientocclusion" => {
            let desc = OcclusionDesc {
                cosine: reader.bool_by(&kinds::COS_SAMPLE),
                max_distance: positive(reader.float_by(&kinds::OCCLUSION_DISTANCE)),
            };
            (LightSamplerKind::default(), IntegratorKind::Occlusion(desc))
        }
        "bdpt" => {
            flag_without_effect(&mut reader, &kinds::REGULARIZE, UNREGULARIZED);
            for flag in [&kinds::VISUALIZE_STRATEGIES, &kinds::VISUALIZE_WEIGHTS] {
                flag_without_effect(&mut reader, flag, "see --strategies");
            }
            (light_sampler(&mut reader), IntegratorKind::Bdpt(heuristic(&mut reader)))
        }
        _ => (light_sampler(&mut reader), IntegratorKind::Path(path(&mut reader))),
    };
    let kind = match stand_in {
        Some(&(name, ..)) => {
            let kind = of_stand_in(&mut reader, name, kind);
            reader.finish();
            kind
        }
        None => {
            reader.finish_by(entry);
            kind
        }
    };
    IntegratorDesc {
        max_depth,
        light_sampler,
        kind,
    }
}

/// What the parameters of `name`, one of [`STAND_INS`], make of the integrator that stands for it.
fn of_stand_in(reader: &mut ParamReader<'_>, name: &str, kind: IntegratorKind) -> IntegratorKind {
    const MLT: &str = "paths are independent; --spp says how many";
    let without_lights = match name {
        "simplepath" => {
            reader.boolean("samplebsdf", true);
            !reader.boolean("samplelights", true)
        }
        "randomwalk" => true,
        "mlt" => {
            reader.inert(&[
                ("bootstrapsamples", MLT),
                ("chains", MLT),
                ("mutationsperpixel", MLT),
                ("largestepprobability", MLT),
                ("sigma", MLT),
            ]);
            false
        }
        _ => false,
    };
    match kind {
        IntegratorKind::Path(path) if without_lights => IntegratorKind::Path(PathDesc {
            strategy: Strategy::Bsdf,
            ..path
        }),
        kind => kind,
    }
}

/// Complains about an integrator that nothing stands for.
fn unknown(reader: &mut ParamReader<'_>, kind: &str) {
    let span = reader.span;
    if let Some((_, what)) = OTHERS.iter().find(|&&(name, _)| name == kind) {
        let message = format!("the integrator `{kind}` is not supported: it {what}");
        reader.report().unsupported(span, message, "`path` is used");
        return;
    }
    let own = INTEGRATORS.iter().map(|entry| entry.name);
    let known: Vec<_> = own.chain(STAND_INS.iter().map(|&(name, ..)| name)).collect();
    let classes = (&known[..], &[][..]);
    unknown_type(reader.report(), "integrator", kind, span, classes, "`path` is used");
}

/// What is said of `regularize`.
const UNREGULARIZED: &str = "surfaces stay as rough as they are";

fn path(reader: &mut ParamReader<'_>) -> PathDesc {
    flag_without_effect(reader, &kinds::REGULARIZE, UNREGULARIZED);
    PathDesc {
        strategy: match reader.choice_by(&kinds::STRATEGY) {
            "bsdf" => Strategy::Bsdf,
            "light" => Strategy::Light,
            _ => Strategy::Mis,
        },
        heuristic: heuristic(reader),
        splitting: reader.integer_by(&kinds::SPLITTING).unsigned_abs(),
    }
}

fn photon(reader: &mut ParamReader<'_>) -> PhotonDesc {
    PhotonDesc {
        caustic_photons: u32::try_from(reader.integer_by(&kinds::CAUSTIC_PHOTONS)).ok(),
        global_photons: u32::try_from(reader.integer_by(&kinds::GLOBAL_PHOTONS)).ok(),
        used: reader.integer_by(&kinds::PHOTONS_USED).unsigned_abs(),
        max_distance: positive(reader.float_by(&kinds::MAX_DISTANCE)),
        final_gather_samples: reader.integer_by(&kinds::FINAL_GATHER_SAMPLES).unsigned_abs(),
        passes: reader.integer_by(&kinds::PASSES).unsigned_abs(),
        filter: photon_filter(reader),
        terms: Terms::ALL,
    }
}

fn sppm(reader: &mut ParamReader<'_>) -> SppmDesc {
    reader.inert_by(&[&samplers::SEED]);
    SppmDesc {
        photons: u32::try_from(reader.integer_by(&kinds::PHOTONS_PER_ITERATION)).ok(),
        radius: positive(reader.float_by(&kinds::RADIUS)),
        filter: photon_filter(reader),
        terms: Terms::ALL,
    }
}

fn photon_filter(reader: &mut ParamReader<'_>) -> PhotonFilter {
    match reader.choice_by(&kinds::PHOTON_FILTER) {
        "gaussian" => PhotonFilter::Gaussian,
        "constant" => PhotonFilter::Constant,
        _ => PhotonFilter::Cone,
    }
}

/// A length, unless it is 0, which asks for the program's choice.
fn positive(length: f64) -> Option<f32> {
    (length > 0.0).then_some(length as f32)
}

fn heuristic(reader: &mut ParamReader<'_>) -> Heuristic {
    match reader.choice_by(&kinds::HEURISTIC) {
        "balance" => Heuristic::Balance,
        _ => Heuristic::Power,
    }
}

/// Says so if something of pbrt's that is not there is asked for; without it pictures converge to what is right.
fn flag_without_effect(reader: &mut ParamReader<'_>, flag: &'static Parameter, why: &str) {
    if reader.bool_by(flag) {
        let span = reader.span_of(flag.name);
        let message = format!("`{}` has no effect: {why}", flag.name);
        reader.report().warning(span, message);
    }
}

fn kajiya(reader: &mut ParamReader<'_>, max_depth: Option<u32>) -> KajiyaDesc {
    let alpha = reader.float_by(&kinds::ALPHA) as f32;
    let desc = KajiyaDesc {
        termination: match reader.choice_by(&kinds::TERMINATION) {
            "albedo" => Termination::Albedo,
            _ => Termination::Constant(alpha),
        },
        branching: reader.integer_by(&kinds::BRANCHING).unsigned_abs(),
        distribution: match reader.choice_by(&kinds::DISTRIBUTION) {
            "cosine" => Distribution::Cosine,
            "uniform" => Distribution::Uniform,
            _ => Distribution::Bsdf,
        },
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

fn light_sampler(reader: &mut ParamReader<'_>) -> LightSamplerKind {
    match reader.choice_by(&kinds::LIGHT_SAMPLER) {
        "power" => LightSamplerKind::Power,
        "uniform" => LightSamplerKind::Uniform,
        "exhaustive" => {
            let span = reader.span_of(kinds::LIGHT_SAMPLER.name);
            let message =
                "the light sampler `exhaustive` is not there: `bvh` is used, which converges to the same image";
            reader.report().warning(span, message);
            LightSamplerKind::Bvh
        }
        _ => LightSamplerKind::Bvh,
    }
}
