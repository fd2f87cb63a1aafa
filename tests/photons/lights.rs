//! Every kind of light, in both integrators, on every backend and in both colour modes: each pair of these against `path`.

use lucerna::accel::Backend;
use lucerna::integrator::Integrator;

use crate::common::covering::Covering;
use crate::common::render::{Built, MODES, parse};
use crate::lamps::LAMPS;
use crate::{assert_agree, film, photon, quad, runs, sppm};

/// Two walls and a floor in the light.
fn scene(lamp: usize) -> String {
    format!(
        "LookAt 0 1.6 -4.5  0 0.6 0  0 1 0\nCamera \"perspective\" \"float fov\" 24\n{}WorldBegin\n{}\n\
         Material \"diffuse\" \"rgb reflectance\" [0.75 0.7 0.6]\n{}{}{}",
        film([8, 8]),
        LAMPS[lamp].text(""),
        quad([-2.0, 0.0, -1.5], [0.0, 0.0, 2.5], [4.0, 0.0, 0.0]),
        quad([-2.0, 0.0, 1.0], [0.0, 2.0, 0.0], [4.0, 0.0, 0.0]),
        quad([-2.0, 0.0, -1.5], [0.0, 2.0, 0.0], [0.0, 0.0, 2.5]),
    )
}

#[test]
fn every_light_is_what_path_finds() {
    let covering = Covering {
        levels: &[LAMPS.len(), 2, MODES.len(), Backend::AVAILABLE.len()],
        strength: 2,
        allowed: &|_| true,
    };
    let depth = Some(3);
    for row in covering.rows() {
        let [lamp, kind, mode, backend] = row[..] else {
            unreachable!("four factors")
        };
        let (mode, backend) = (MODES[mode], Backend::AVAILABLE[backend]);
        let built = Built::new(parse(&scene(lamp)), backend, mode);
        let path = Integrator::from_desc(&built.desc.integrator).with_max_depth(depth);
        let reference = runs(&built, path, 64, 101, [8, 8]);
        let two_pass = photon(depth, |p| {
            p.global_photons = Some(5000);
            p.max_distance = Some(0.12);
            p.passes = 8;
            p.final_gather_samples = 4;
        });
        let (integrator, spp) = [(two_pass, 8), (sppm(depth, 8000, 0.12), 12)][kind];
        let ours = runs(&built, integrator, spp, 1, [8, 8]);
        let name = format!("{} by {}, {backend}, {mode:?}", LAMPS[lamp].name, integrator.name());
        // Where a lamp shines past the room few photons arrive in it.
        let power = 0.25;
        assert_agree(&name, &ours, &reference, 0.01, power);
    }
}

/// Light along the normals of a surface, which no light sample finds, counts as a caustic: it is in both maps, once.
#[test]
fn light_along_normals_is_a_caustic() {
    let beam = "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [4 3 2] \"string spread\" \"normal\"\n\
                Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [-5 4 -3  5 4 -3  5 3.5 3  -5 3.5 3] AttributeEnd";
    let lamp = LAMPS[0].text("");
    let text = scene(0).replace(&lamp, beam);
    assert!(text.contains("spread"));
    let depth = Some(3);
    let built = Built::new(parse(&text), Backend::Bvh, MODES[0]);
    let bdpt = Integrator::from_desc(&built.desc.integrator)
        .named("bdpt")
        .with_max_depth(depth);
    let reference = runs(&built, bdpt, 256, 101, [8, 8]);
    let two_pass = photon(depth, |p| {
        p.global_photons = Some(10_000);
        p.max_distance = Some(0.12);
        p.passes = 8;
        p.final_gather_samples = 4;
    });
    for (integrator, spp) in [(two_pass, 8), (sppm(depth, 8000, 0.12), 12)] {
        let ours = runs(&built, integrator, spp, 1, [8, 8]);
        let name = format!("beam by {}", integrator.name());
        assert_agree(&name, &ours, &reference, 0.01, 0.25);
    }
}
