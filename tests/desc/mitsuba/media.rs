//! Media: what they become, and what is said about bad ones.

use lucerna::desc::{CoefficientsDesc, MaterialKind, MediumId, MediumInterfaceDesc, SpectrumValue};

use super::super::STRICT;
use super::{read, scene};

const FOG: &str = r#"<medium type="homogeneous" id="fog"><rgb name="sigma_t" value="1 2 3"/>
    <volume type="constvolume" name="albedo"><float name="value" value="0.5"/></volume><float name="scale" value="2"/>
    <phase type="hg"><float name="g" value="0.4"/></phase></medium>"#;

#[test]
fn media_are_translated_once_and_stand_on_their_sides() {
    let scene = scene(&format!(
        r#"<integrator type="volpath"/>{FOG}
        <shape type="cube"><bsdf type="null"/><ref id="fog" name="interior"/></shape>
        <shape type="sphere"><bsdf type="dielectric"/><medium type="homogeneous" name="interior"/><ref id="fog" name="exterior"/></shape>
        <shape type="sphere"><ref id="fog" name="interior"/><ref id="fog" name="exterior"/></shape>"#
    ));
    let interface = |interior, exterior| {
        Some(MediumInterfaceDesc {
            interior: Some(MediumId(interior)),
            exterior,
        })
    };
    let media: Vec<_> = scene.shapes.iter().map(|shape| shape.media).collect();
    assert_eq!(media, [interface(0, None), interface(1, Some(MediumId(0))), None]);
    assert!(matches!(
        scene.materials[scene.shapes[0].material.0 as usize].kind,
        MaterialKind::Interface
    ));
    let values = |medium: usize| match &scene.media[medium].coefficients {
        CoefficientsDesc::Whole { sigma_t, albedo } => (sigma_t.value.clone(), albedo.value.clone()),
        CoefficientsDesc::Parts { .. } => panic!("Mitsuba has an extinction"),
    };
    let (sigma_t, albedo) = values(0);
    assert!(matches!(sigma_t, SpectrumValue::Rgb([1.0, 2.0, 3.0], _)));
    assert_eq!(albedo, SpectrumValue::Constant(0.5));
    let defaults = (SpectrumValue::Constant(1.0), SpectrumValue::Constant(0.75));
    assert_eq!(values(1), defaults);
    let rest: Vec<_> = scene.media.iter().map(|m| (m.name.as_str(), m.scale, m.g)).collect();
    assert_eq!(rest, [("fog", 2.0, 0.4), ("medium2", 1.0, 0.0)]);
}

#[test]
fn cameras_stand_in_media() {
    let text = format!(
        r#"<scene version="3.0.0"><integrator type="volpathmis"/>{FOG}
        <sensor type="perspective"><float name="fov" value="40"/><ref id="fog"/></sensor></scene>"#
    );
    let scene = read(&text, &STRICT).expect("nothing is wrong");
    assert_eq!(scene.views[0].camera.medium, Some(MediumId(0)));
}

#[test]
fn integrators_that_see_no_media_are_named() {
    let scene = scene(&format!(
        r#"<integrator type="path"/>{FOG}<shape type="cube"><bsdf type="null"/><ref id="fog" name="interior"/></shape>
        <shape type="sphere"><ref id="fog" name="interior"/></shape>"#
    ));
    assert!(scene.media.is_empty() && scene.shapes.len() == 1 && scene.shapes[0].media.is_none());
    let warnings: Vec<_> = scene.warnings.iter().map(|warning| warning.message.as_str()).collect();
    assert!(
        warnings.len() == 2 && warnings.iter().any(|w| w.contains("`volpath`")),
        "{warnings:?}"
    );
}
