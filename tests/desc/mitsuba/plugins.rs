//! What plugins become.

use glam::{DAffine3, DVec3};
use lucerna::desc::{
    AreaSpread, CameraKind, FilterKind, IntegratorKind, LightKind, MaterialId, MaterialKind, ParseOptions, SamplerKind,
    SceneDesc, ShapeKind, SpectrumValue, Textured,
};

use super::super::STRICT;
use super::{file, read, scene};

fn kind(scene: &SceneDesc, id: MaterialId) -> &MaterialKind {
    &scene.materials[id.0 as usize].kind
}

/// The material of the only shape, with a bsdf in it.
fn material(bsdf: &str) -> SceneDesc {
    scene(&format!("<shape type=\"sphere\">{bsdf}</shape>"))
}

#[test]
fn steps_of_transforms_apply_in_order() {
    let scene = scene(
        r#"<shape type="sphere"><transform name="to_world"><translate x="1"/><scale value="2"/><rotate z="1" angle="90"/>
        <matrix value="1 0 0 0 0 1 0 0 0 0 1 5 0 0 0 1"/></transform></shape>"#,
    );
    let placed = scene.shapes[0].world_from_object.start;
    // (0, 0, 0) -> (1, 0, 0) -> (2, 0, 0) -> (0, 2, 0) -> (0, 2, 5)
    assert!((placed.transform_point3(DVec3::ZERO) - DVec3::new(0.0, 2.0, 5.0)).length() < 1e-12);
}

#[test]
fn cameras_see_the_left_at_plus_x_and_span_their_width() {
    let text = |axis: &str| {
        format!(
            r#"<scene version="3.0.0"><sensor type="perspective"><float name="fov" value="90"/>{axis}
            <transform name="to_world"><lookat origin="0,0,-3" target="0,0,0" up="0,1,0"/></transform>
            <film type="hdrfilm"><integer name="width" value="200"/><integer name="height" value="100"/>
            <rfilter type="tent"/></film><sampler type="independent"><integer name="sample_count" value="7"/></sampler>
            </sensor></scene>"#
        )
    };
    let fov = |axis: &str| match read(&text(axis), &STRICT).expect("a scene").views[0].camera.kind {
        CameraKind::Perspective { fov, .. } => fov,
        _ => panic!("not perspective"),
    };
    // By half the height at distance 1: of the width 1 it is 1/2.
    let of_half_height = |half: f64| (2.0 * half.atan()).to_degrees();
    for (axis, half) in [
        ("x", 0.5),
        ("y", 1.0),
        ("smaller", 1.0),
        ("larger", 0.5),
        ("diagonal", 0.2_f64.sqrt()),
    ] {
        let found = fov(&format!("<string name=\"fov_axis\" value=\"{axis}\"/>"));
        assert!((found - of_half_height(half)).abs() < 1e-9, "{axis}: {found}");
    }
    // Of 50 mm before 35 mm film, if nothing is said.
    let plain = |focal_length: &str| {
        let text = format!(r#"<scene version="3.0.0"><sensor type="perspective">{focal_length}</sensor></scene>"#);
        match read(&text, &STRICT).expect("a scene").views[0].camera.kind {
            CameraKind::Perspective { fov, .. } => fov,
            _ => panic!("not perspective"),
        }
    };
    // The film is 768 x 576: its width is 4/5 of its diagonal, and the angle is of its height.
    let half_diagonal = 0.5 * 36.0_f64.hypot(24.0) / 50.0;
    assert!(
        (plain("") - of_half_height(0.6 * half_diagonal)).abs() < 1e-9,
        "{}",
        plain("")
    );
    assert_eq!(plain(""), plain("<string name=\"focal_length\" value=\"50mm\"/>"));
    let scene = read(&text(""), &STRICT).expect("a scene");
    let view = &scene.views[0];
    // Looking along +z with y up, +x of the world is to the left.
    let right = view.camera.world_from_camera().start.transform_vector3(DVec3::X);
    assert!((right - DVec3::NEG_X).length() < 1e-12);
    assert_eq!((view.filter.kind, view.filter.radius), (FilterKind::Triangle, [1.0; 2]));
    assert_eq!(
        (view.sampler.kind, view.sampler.pixel_samples),
        (SamplerKind::Independent, 7)
    );
}

#[test]
fn depth_counts_one_more() {
    let depth = |text: &str| scene(text).integrator.max_depth;
    assert_eq!(depth(""), None);
    assert_eq!(depth("<integrator type=\"path\"/>"), None);
    assert_eq!(depth("<integrator type=\"direct\"/>"), Some(1));
    let path = |n: i32| {
        depth(&format!(
            "<integrator type=\"path\"><integer name=\"max_depth\" value=\"{n}\"/></integrator>"
        ))
    };
    assert_eq!([path(-1), path(1), path(6)], [None, Some(0), Some(5)]);
    let kind = |name: &str| scene(&format!("<integrator type=\"{name}\"/>")).integrator.kind;
    assert!(matches!(kind("ptracer"), IntegratorKind::LightTracer));
    assert!(matches!(kind("bdpt"), IntegratorKind::Bdpt(_)));
    assert!(matches!(kind("photonmapper"), IntegratorKind::Photon(_)));
    assert!(matches!(kind("sppm"), IntegratorKind::Sppm(_)));
    assert!(matches!(kind("volpath"), IntegratorKind::Path(_)));
}

#[test]
fn bsdfs_are_black_from_behind_unless_two_sided() {
    let scene = material("<bsdf type=\"diffuse\"/>");
    let MaterialKind::Sided {
        front: Some(front),
        back: None,
    } = kind(&scene, scene.shapes[0].material)
    else {
        panic!("{:?}", scene.materials);
    };
    assert!(matches!(kind(&scene, *front), MaterialKind::Diffuse { .. }));
    let scene = material("<bsdf type=\"twosided\"><bsdf type=\"diffuse\"/></bsdf>");
    assert!(matches!(
        kind(&scene, scene.shapes[0].material),
        MaterialKind::Diffuse { .. }
    ));
    let scene = material("<bsdf type=\"twosided\"><bsdf type=\"diffuse\"/><bsdf type=\"plastic\"/></bsdf>");
    let MaterialKind::Sided {
        front: Some(_),
        back: Some(back),
    } = kind(&scene, scene.shapes[0].material)
    else {
        panic!("{:?}", scene.materials);
    };
    assert!(matches!(kind(&scene, *back), MaterialKind::Plastic(_)));
    let scene = material("<bsdf type=\"dielectric\"/>");
    assert!(matches!(
        kind(&scene, scene.shapes[0].material),
        MaterialKind::Dielectric { .. }
    ));
    let scene = material("<bsdf type=\"mask\"><float name=\"opacity\" value=\"0.3\"/><bsdf type=\"diffuse\"/></bsdf>");
    assert_eq!(scene.shapes[0].alpha, Textured::Value(0.3));
    assert!(material("<bsdf type=\"null\"/>").shapes.is_empty());
}

#[test]
fn masks_multiply_and_nothing_is_a_mask() {
    let number = |name: &str, value: f32| format!("<float name=\"{name}\" value=\"{value}\"/>");
    let alpha = |bsdf: &str| material(bsdf).shapes[0].alpha.clone();
    let diffuse = "<bsdf type=\"diffuse\"/>";
    let inner = format!("<bsdf type=\"mask\">{}{diffuse}</bsdf>", number("opacity", 0.5));
    let outer = format!("<bsdf type=\"mask\">{}{inner}</bsdf>", number("opacity", 0.5));
    assert_eq!(alpha(&outer), Textured::Value(0.25));
    let blend = |first: &str, second: &str| {
        let weight = number("weight", 0.25);
        alpha(&format!("<bsdf type=\"blendbsdf\">{weight}{first}{second}</bsdf>"))
    };
    let null = "<bsdf type=\"null\"/>";
    assert_eq!(blend(null, diffuse), Textured::Value(0.25));
    assert_eq!(blend(diffuse, null), Textured::Value(0.75));
    assert_eq!(blend(null, &inner), Textured::Value(0.125));
    let textured = material(&format!(
        "<bsdf type=\"blendbsdf\"><texture type=\"checkerboard\" name=\"weight\"/>{diffuse}{null}</bsdf>"
    ));
    assert!(matches!(textured.shapes[0].alpha, Textured::Texture(_)) && textured.warnings.is_empty());
}

#[test]
fn lights_keep_their_brightness() {
    let light = |spectrum: &str| {
        let scene = scene(&format!("<emitter type=\"constant\">{spectrum}</emitter>"));
        let light = scene.lights[0].clone();
        (light.spectrum.expect("a spectrum").value, light.scale)
    };
    let (value, scale) = light("<rgb name=\"radiance\" value=\"1 2 3\"/>");
    assert!(matches!(value, SpectrumValue::Rgb([1.0, 2.0, 3.0], _)) && scale == 1.0);
    let (value, scale) = light("<float name=\"radiance\" value=\"2\"/>");
    assert!(matches!(value, SpectrumValue::Rgb([2.0, 2.0, 2.0], _)) && scale == 1.0);
    let (_, scale) = light("<spectrum name=\"radiance\" value=\"2\"/>");
    assert_eq!(scale, 2.0);
    let (_, scale) = light("<spectrum name=\"radiance\" value=\"300:2, 900:2\"/>");
    assert!((scale - 2.0).abs() < 1e-5, "{scale}");
    // Planck's law for 5000 K at the peak of the eye's sensitivity is 1.21e4 W·m⁻²·sr⁻¹·nm⁻¹.
    let (_, scale) =
        light("<spectrum name=\"radiance\" type=\"blackbody\"><float name=\"temperature\" value=\"5000\"/></spectrum>");
    assert!((1.18e4..1.28e4).contains(&scale), "{scale}");
}

#[test]
fn emitters_are_placed() {
    let scene = scene(
        r#"<emitter type="point"><point name="position" x="1" y="2" z="3"/></emitter>
        <emitter type="directional"><vector name="direction" x="0" y="0" z="-2"/></emitter>
        <emitter type="spot"><float name="cutoff_angle" value="30"/></emitter>"#,
    );
    assert_eq!(
        scene.lights[0].kind,
        LightKind::Point {
            from: DVec3::new(1.0, 2.0, 3.0)
        }
    );
    assert_eq!(
        scene.lights[1].kind,
        LightKind::Distant {
            from: DVec3::ZERO,
            to: DVec3::NEG_Z
        }
    );
    assert!(matches!(
        scene.lights[2].kind,
        LightKind::Spot {
            angle: 30.0,
            delta: 7.5,
            ..
        }
    ));
}

#[test]
fn surfaces_emit_along_their_normals() {
    let scene = scene(
        r#"<shape type="disk"><emitter type="directionalarea"><rgb name="radiance" value="2, 2, 2"/></emitter></shape>
        <shape type="disk"><emitter type="area"/></shape>"#,
    );
    let spreads = scene
        .shapes
        .iter()
        .map(|shape| shape.area_light.as_ref().map(|light| light.spread));
    assert!(spreads.eq([Some(AreaSpread::Normal), Some(AreaSpread::Diffuse)]));
}

#[test]
fn groups_are_instanced() {
    let scene = scene(
        r#"<shape type="shapegroup" id="g"><shape type="cube"/><shape type="sphere"/></shape>
        <shape type="instance"><ref id="g"/><transform name="to_world"><translate y="4"/></transform></shape>
        <shape type="instance"><ref id="g"/></shape>"#,
    );
    assert_eq!(
        (
            scene.objects.len(),
            scene.objects[0].shapes.len(),
            scene.instances.len()
        ),
        (1, 2, 2)
    );
    assert!(matches!(
        scene.objects[0].shapes[1].kind,
        ShapeKind::Sphere { radius: 1.0 }
    ));
    let moved = scene.instances[0].world_from_instance.start;
    assert_eq!(moved, DAffine3::from_translation(DVec3::new(0.0, 4.0, 0.0)));
}

#[test]
fn defines_come_before_defaults() {
    let text = file(
        r#"<default name="r" value="1"/><default name="r" value="9"/><shape type="sphere"><float name="radius" value="$r"/></shape>"#,
    );
    let radius = |defines: &[(&str, &str)]| {
        let options = ParseOptions {
            lenient: false,
            defines: defines
                .iter()
                .map(|(a, b)| ((*a).to_owned(), (*b).to_owned()))
                .collect(),
        };
        read(&text, &options).map(|scene| match scene.shapes[0].kind {
            ShapeKind::Sphere { radius } => radius,
            _ => 0.0,
        })
    };
    assert_eq!(radius(&[]).expect("a scene"), 1.0);
    assert_eq!(radius(&[("r", "5")]).expect("a scene"), 5.0);
    let errors = radius(&[("s", "5")]).expect_err("nobody asks for it");
    assert!(errors[0].message.contains("no parameter $s"));
}

/// Names of Mitsuba 0.6 are read as those of today.
#[test]
fn old_names_are_understood() {
    let text = r#"<scene version="0.6.0"><sensor type="perspective"><float name="fov" value="40"/>
        <transform name="toWorld"><lookAt origin="0,0,5" target="0,0,0" up="0,1,0"/></transform></sensor>
        <integrator type="bdpt"><integer name="maxDepth" value="4"/></integrator>
        <shape type="sphere"><bsdf type="dielectric"><float name="intIOR" value="1.5"/><float name="extIOR" value="1"/></bsdf></shape></scene>"#;
    let scene = read(text, &STRICT).unwrap_or_else(|e| panic!("{e:?}"));
    assert_eq!(scene.integrator.max_depth, Some(3));
    let MaterialKind::Dielectric { eta, .. } = kind(&scene, scene.shapes[0].material) else {
        panic!("{:?}", scene.materials);
    };
    assert_eq!(eta.value, SpectrumValue::Constant(1.5));
}
