//! Integrators, of Mitsuba 3 and those of 0.6 that this program has.

use super::graph::Object;
use super::loader::Loader;
use super::plugins::Class;
use super::props::Props;
use crate::desc::{Heuristic, IntegratorDesc, IntegratorKind, LightSamplerKind, PathDesc, PhotonDesc, SppmDesc};

/// Paths of any length.
pub(super) fn default() -> IntegratorDesc {
    IntegratorDesc {
        max_depth: None,
        light_sampler: LightSamplerKind::default(),
        kind: IntegratorKind::Path(PathDesc::default()),
    }
}

/// Reads an integrator.
pub(super) fn read<'g>(loader: &mut Loader<'g>, object: &'g Object) -> IntegratorDesc {
    let mut props = Props::new(object);
    let mut desc = default();
    const TECHNICAL: [(&str, &str); 3] = [
        ("rr_depth", "Russian roulette goes by the throughput of a path"),
        ("block_size", "it is a matter of speed"),
        ("samples_per_pass", "it is a matter of memory"),
    ];
    props.inert(&TECHNICAL);
    props.ignore(&["timeout"]);
    if props.boolean("hide_emitters", false) {
        props.unsupported(
            props.span_of("hide_emitters"),
            "`hide_emitters` is not supported",
            "emitters are seen",
        );
    }
    desc.kind = match object.plugin.as_str() {
        "path" => IntegratorKind::Path(PathDesc::default()),
        "volpath" | "volpathmis" => IntegratorKind::Path(PathDesc::default()),
        "direct" => {
            props.inert(&[
                ("shading_samples", ONE_EACH),
                ("emitter_samples", ONE_EACH),
                ("bsdf_samples", ONE_EACH),
            ]);
            desc.max_depth = Some(1);
            IntegratorKind::Path(PathDesc::default())
        }
        "ptracer" => IntegratorKind::LightTracer,
        "bdpt" => {
            props.inert(&[("light_image", "it always is"), ("sample_direct", "they always are")]);
            IntegratorKind::Bdpt(Heuristic::default())
        }
        "photonmapper" => IntegratorKind::Photon(photon_map(&mut props)),
        "sppm" => IntegratorKind::Sppm(sppm(&mut props)),
        _ => {
            loader.refuse(object, "`path` is used");
            props.objects(|_| true);
            props.finish(loader.report());
            return desc;
        }
    };
    if object.plugin != "direct" {
        desc.max_depth = max_depth(&mut props);
    }
    for (_, nested) in loader.children(&mut props, Class::Integrator) {
        props.error(
            nested.span,
            format!("`{}` has no other integrator inside", object.plugin),
        );
    }
    props.finish(loader.report());
    desc
}

const ONE_EACH: &str = "a camera sample takes one light and one direction";

/// Mitsuba counts edges: 1 shows lights alone.
fn max_depth(props: &mut Props<'_>) -> Option<u32> {
    let depth = props.integer("max_depth")?;
    match depth {
        -1 => None,
        0 => {
            props.unsupported(
                props.span_of("max_depth"),
                "`max_depth` 0 shows nothing at all",
                "it is 1",
            );
            Some(0)
        }
        1.. if depth <= i64::from(i32::MAX) => Some(depth as u32 - 1),
        _ => {
            let message = format!("`max_depth` is {depth}; expected -1 (no limit), or 1 or more");
            props.error(props.span_of("max_depth"), message);
            None
        }
    }
}

fn photon_map(props: &mut Props<'_>) -> PhotonDesc {
    let mut desc = PhotonDesc::default();
    let counts = ["global_photons", "caustic_photons"].map(|name| {
        let given = props.has(name);
        let count = props.count(name, 1, 1);
        given.then_some(count)
    });
    [desc.global_photons, desc.caustic_photons] = counts;
    desc.used = props.count("lookup_size", 1, desc.used);
    props.inert(&[
        ("direct_samples", ONE_EACH),
        ("glossy_samples", ONE_EACH),
        ("volume_photons", "there are no media"),
        ("volume_lookup_size", "there are no media"),
        ("global_lookup_radius", "estimates go by the number of photons"),
        ("caustic_lookup_radius", "estimates go by the number of photons"),
        ("volume_lookup_radius", "there are no media"),
        ("granularity", "it is a matter of speed"),
        ("auto_cancel_gathering", "gathering ends when it is done"),
    ]);
    desc
}

fn sppm(props: &mut Props<'_>) -> SppmDesc {
    let given = props.has("photon_count");
    let photons = props.count("photon_count", 1, 1);
    props.inert(&[
        ("alpha", "the radius shrinks by a law of its own"),
        (
            "initial_radius",
            "the first radius is in proportion to what a pixel sees",
        ),
        ("max_passes", "there are as many passes as samples"),
        ("granularity", "it is a matter of speed"),
    ]);
    SppmDesc {
        photons: given.then_some(photons),
        ..SppmDesc::default()
    }
}
