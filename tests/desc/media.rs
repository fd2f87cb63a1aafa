//! Participating media and the boundaries between them.

use lucerna::desc::{CoefficientsDesc, MaterialKind, MediumId, MediumInterfaceDesc, SpectrumValue};

use super::{STRICT, read, scene};

#[test]
fn media_stand_on_the_two_sides_of_shapes() {
    let scene = scene(
        r#"MediumInterface "" "air"
        Camera "perspective"
        MakeNamedMedium "air" "string type" "homogeneous" "rgb sigma_s" [1 2 3] "float scale" 0.5 "float g" -0.25
        WorldBegin
        Shape "sphere"
        MakeNamedMedium "wine" "string type" "homogeneous" "string preset" "Merlot"
        MediumInterface "wine" "air" Shape "sphere"
        MediumInterface "wine" Shape "sphere"
        MediumInterface "" "" Shape "sphere""#,
    );
    let names: Vec<_> = scene.media.iter().map(|medium| medium.name.as_str()).collect();
    assert_eq!(names, ["air", "wine"]);
    assert_eq!(scene.views[0].camera.medium, Some(MediumId(0)));
    let [air, wine] = [0, 1].map(|i| Some(MediumId(i)));
    let media: Vec<_> = scene.shapes.iter().map(|shape| shape.media).collect();
    let interface = |interior, exterior| Some(MediumInterfaceDesc { interior, exterior });
    // `MediumInterface` before `WorldBegin` holds on after it; one name stands for both sides, where nothing changes.
    assert_eq!(media, [interface(None, air), interface(wine, air), None, None]);
    assert_eq!((scene.media[0].scale, scene.media[0].g), (0.5, -0.25));
    let sigma_a = |medium: usize| match &scene.media[medium].coefficients {
        CoefficientsDesc::Parts { sigma_a, .. } => sigma_a.value.clone(),
        CoefficientsDesc::Whole { .. } => panic!("no extinction was given"),
    };
    assert_eq!(sigma_a(0), SpectrumValue::Constant(1.0));
    assert!(matches!(sigma_a(1), SpectrumValue::Rgb([0.11632, ..], _)));
}

#[test]
fn an_interface_between_media_is_a_shape_without_a_surface() {
    let text = r#"MakeNamedMedium "m" "string type" "homogeneous"
        WorldBegin Material "interface" MediumInterface "m" ""
        AreaLightSource "diffuse" Shape "sphere" MediumInterface "" "" Shape "sphere""#;
    let scene = read(text, &STRICT).expect("nothing is wrong");
    let [shape] = &scene.shapes[..] else {
        panic!("{} shapes", scene.shapes.len())
    };
    assert!(matches!(
        scene.materials[shape.material.0 as usize].kind,
        MaterialKind::Interface
    ));
    assert!(shape.area_light.is_none());
    let warnings: Vec<_> = scene.warnings.iter().map(|warning| warning.message.as_str()).collect();
    assert!(
        warnings.len() == 2 && warnings[0].contains("does not emit") && warnings[1].contains("left out"),
        "{warnings:?}"
    );
}
