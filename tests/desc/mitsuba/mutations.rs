//! No bytes make the reader of XML panic: mutations of a valid file, from fixed seeds.

use std::path::Path;

use lucerna::desc::{ParseOptions, mitsuba};

use super::super::mutations::{Random, mutate};

const SCENE: &str = r#"<?xml version="1.0"?><!-- all sorts of things -->
<scene version="3.1.0"><default name="spp" value="16"/><integrator type="volpath"><integer name="max_depth" value="5"/></integrator>
<sensor type="thinlens"><float name="fov" value="40"/><float name="aperture_radius" value="0.1"/><string name="fov_axis" value="smaller"/>
<transform name="to_world"><lookat origin="0,1,5" target="0, 0, 0" up="0 1 0"/><scale value="2"/><rotate y="1" angle="20"/></transform>
<film type="hdrfilm"><integer name="width" value="64"/><integer name="crop_width" value="9"/><rfilter type="mitchell"/></film>
<sampler type="multijitter"><integer name="sample_count" value="$spp"/></sampler></sensor>
<bsdf type="twosided" id="red"><bsdf type="roughplastic"><rgb name="diffuse_reflectance" value=".6, .1, .1"/></bsdf></bsdf>
<bsdf type="blendbsdf" id="b"><float name="weight" value="0.3"/><bsdf type="diffuse"><texture type="checkerboard" name="reflectance">
<transform name="to_uv"><scale x="4" y="4"/></transform></texture></bsdf><bsdf type="conductor"><string name="material" value="Au"/></bsdf></bsdf>
<alias id="red" as="rouge"/><shape type="shapegroup" id="g"><shape type="cube"><ref id="rouge"/></shape></shape>
<shape type="instance"><ref id="g"/><transform name="to_world"><matrix value="1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1"/></transform></shape>
<shape type="sphere"><point name="center" x="1" y="2" z="3"/><emitter type="area"><spectrum name="radiance" value="400:1, 700:2.5"/></emitter></shape>
<shape type="cylinder"><ref id="b"/></shape><emitter type="constant"><spectrum type="blackbody" name="radiance"><float name="temperature" value="4000"/></spectrum></emitter>
<medium type="homogeneous" id="fog"><rgb name="sigma_t" value="1 2 3"/><volume type="constvolume" name="albedo"><float name="value" value="0.5"/></volume>
<phase type="hg"><float name="g" value="0.4"/></phase></medium><shape type="disk"><bsdf type="null"/><ref id="fog" name="interior"/></shape>
<shape type="cube"><bsdf type="mask"><float name="opacity" value="0.5"/><bsdf type="principled"><float name="flatness" value="1"/></bsdf></bsdf></shape></scene>"#;

#[test]
fn no_text_makes_the_reader_panic() {
    let read = |text: &[u8], lenient| {
        let options = ParseOptions {
            lenient,
            ..ParseOptions::default()
        };
        mitsuba::parse_str(text, Path::new("no/such/directory/scene.xml"), &options)
    };
    read(SCENE.as_bytes(), false).unwrap_or_else(|e| panic!("{e}"));
    let mut random = Random(3);
    let mut refused = 0;
    for round in 0..6_000 {
        let text = mutate(SCENE.as_bytes(), 0, &mut random);
        match read(&text, round % 2 == 0) {
            Ok(scene) => scene.warnings.iter().for_each(|w| drop(w.to_string())),
            Err(error) => {
                assert!(!error.to_string().is_empty());
                refused += 1;
            }
        }
    }
    // Mutations that break nothing, and those that do, both occur.
    assert!((1000..5990).contains(&refused), "{refused}");
}
