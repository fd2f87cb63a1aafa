//! What stands after `WorldBegin`: shapes, materials, lights, instances.

use glam::{DAffine3, DMat4, DVec3, Vec2, Vec3};
use lucerna::desc::{
    ColorSpace, ConductorDesc, DistributionDesc, LightKind, MaterialId, MaterialKind, ObjectId, RoughnessDesc,
    ShapeDesc, ShapeKind, SpectrumDesc, SpectrumValue, Textured, load,
};

use crate::{STRICT, shared, world};

/// Where the origin of a shape that stands still is.
fn place(shape: &ShapeDesc) -> DVec3 {
    assert!(shape.world_from_object.is_static());
    shape.world_from_object.start.translation
}

#[test]
fn attributes_are_restored() {
    let scene = world(
        r#"
        AttributeBegin
            Translate 1 2 3
            ReverseOrientation
            Material "conductor"
            AreaLightSource "diffuse" "rgb L" [1 2 3] "float scale" 2 "bool twosided" true "float power" 60
            Shape "sphere" "float radius" 2
        AttributeEnd
        Shape "sphere""#,
    );
    let [inner, outer] = &scene.shapes[..] else { panic!() };
    assert_eq!(place(inner), DVec3::new(1.0, 2.0, 3.0));
    assert!(inner.reverse_orientation);
    assert_eq!(inner.material, MaterialId(1));
    assert!(matches!(inner.kind, ShapeKind::Sphere { radius: 2.0 }));
    let light = inner.area_light.as_ref().expect("a light");
    assert_eq!(
        light.l.as_ref().map(|l| &l.value),
        Some(&SpectrumValue::Rgb([1.0, 2.0, 3.0], ColorSpace::Srgb))
    );
    assert_eq!((light.scale, light.power, light.two_sided), (2.0, Some(60.0), true));
    assert_eq!(place(outer), DVec3::ZERO);
    assert!(!outer.reverse_orientation && outer.area_light.is_none());
    assert_eq!(outer.material, MaterialId(0));
}

#[test]
fn transforms_apply_in_the_order_of_pbrt() {
    let shape = |text: &str| {
        world(&format!("{text} Shape \"sphere\""))
            .shapes
            .remove(0)
            .world_from_object
            .start
    };
    let near = |a: DAffine3, b: DMat4| DMat4::from(a).abs_diff_eq(b, 1e-14);
    let t = DMat4::from_translation(DVec3::new(1.0, 2.0, 3.0));
    let s = DMat4::from_scale(DVec3::new(2.0, 3.0, 4.0));
    let r = DMat4::from_rotation_z(90_f64.to_radians());
    assert!(near(shape("Translate 1 2 3 Scale 2 3 4 Rotate 90 0 0 2"), t * s * r));
    // Turning by 90 degrees around z takes x to y.
    assert!(shape("Rotate 90 0 0 1").transform_point3(DVec3::X).distance(DVec3::Y) < 1e-15);
    let numbers = "[1 0 0 0  0 0 1 0  0 -1 0 0  5 6 7 1]";
    let m = DMat4::from_cols_array(&[1., 0., 0., 0., 0., 0., 1., 0., 0., -1., 0., 0., 5., 6., 7., 1.]);
    assert!(near(shape(&format!("Translate 9 9 9 Transform {numbers}")), m));
    assert!(near(
        shape(&format!("Translate 1 2 3 ConcatTransform {numbers}")),
        t * m
    ));
    assert!(near(shape("Translate 1 2 3 Identity Scale 2 3 4"), s));
    assert!(near(
        shape("Translate 1 2 3 CoordinateSystem \"here\" Scale 2 3 4 CoordSysTransform \"here\""),
        t
    ));
    assert!(near(
        shape("Translate 1 2 3 CoordSysTransform \"world\""),
        DMat4::IDENTITY
    ));
    // LookAt maps the eye to the origin and the target to +z.
    let look = shape("LookAt 1 2 3  1 2 8  0 1 0");
    assert!(
        look.transform_point3(DVec3::new(1.0, 2.0, 8.0))
            .distance(DVec3::new(0.0, 0.0, 5.0))
            < 1e-14
    );
}

#[test]
fn transforms_may_move() {
    let scene = world(
        "ActiveTransform EndTime Translate 0 0 2 Shape \"sphere\" ActiveTransform All Scale 2 2 2 Shape \"sphere\"
         LightSource \"point\"",
    );
    let motion = scene.shapes[1].world_from_object;
    assert_eq!(motion.start.translation, DVec3::ZERO);
    assert_eq!(motion.end.translation, DVec3::new(0.0, 0.0, 2.0));
    assert_eq!(motion.start.matrix3, motion.end.matrix3);
    assert!(!scene.shapes[0].world_from_object.is_static() && !scene.lights[0].world_from_light.is_static());
}

/// The spectrum of a parameter that has no texture.
fn value(parameter: &Textured<SpectrumDesc>) -> &SpectrumValue {
    match parameter {
        Textured::Value(desc) => &desc.value,
        Textured::Texture(id) => panic!("{id:?}"),
    }
}

#[test]
fn materials_have_the_parameters_of_pbrt() {
    let scene = world(
        r#"
        Material "diffuse" "spectrum reflectance" [400 .1 500 .25 700 .5]
        Material "diffuse"
        Material "conductor"
        Material "conductor" "rgb reflectance" [.1 .2 .3] "float roughness" .5 "float vroughness" .25
        Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k" "bool remaproughness" false
        Material "dielectric" "float eta" 1.33
        Material "dielectric" "spectrum eta" "glass-BK7" "float uroughness" .1
        Material "dielectric""#,
    );
    let kinds: Vec<&MaterialKind> = scene.materials.iter().skip(1).map(|m| &m.kind).collect();
    let reflectance = |i: usize| match kinds[i] {
        MaterialKind::Diffuse { reflectance, .. } => value(reflectance),
        other => panic!("{other:?}"),
    };
    let samples = SpectrumValue::Samples(vec![(400.0, 0.1), (500.0, 0.25), (700.0, 0.5)]);
    assert_eq!(*reflectance(0), samples);
    assert_eq!(*reflectance(1), SpectrumValue::Constant(0.5));
    let ior = |i: usize| match kinds[i] {
        MaterialKind::Conductor {
            interface: ConductorDesc::Ior { eta, k },
            roughness,
            ..
        } => (value(eta).clone(), value(k).clone(), roughness.clone()),
        other => panic!("{other:?}"),
    };
    let named = |name: &str| SpectrumValue::Named(name.to_owned());
    let rough = |u, v, remap| RoughnessDesc {
        u: Textured::Value(u),
        v: Textured::Value(v),
        remap,
        distribution: DistributionDesc::Ggx,
        separable_masking: false,
    };
    assert_eq!(
        ior(2),
        (named("metal-Cu-eta"), named("metal-Cu-k"), rough(0.0, 0.0, true))
    );
    assert_eq!(
        ior(4),
        (named("metal-Au-eta"), named("metal-Au-k"), rough(0.0, 0.0, false))
    );
    let MaterialKind::Conductor {
        interface: ConductorDesc::Reflectance(r),
        roughness,
        ..
    } = kinds[3]
    else {
        panic!()
    };
    assert_eq!(
        (value(r), roughness.clone()),
        (
            &SpectrumValue::Rgb([0.1, 0.2, 0.3], ColorSpace::Srgb),
            rough(0.5, 0.25, true)
        )
    );
    let eta = |i: usize| match kinds[i] {
        MaterialKind::Dielectric { eta, roughness, .. } => (eta.value.clone(), roughness.u.clone()),
        other => panic!("{other:?}"),
    };
    assert_eq!(eta(5), (SpectrumValue::Constant(1.33), Textured::Value(0.0)));
    assert_eq!(eta(6), (named("glass-BK7"), Textured::Value(0.1)));
    assert_eq!(eta(7), (SpectrumValue::Constant(1.5), Textured::Value(0.0)));
}

#[test]
fn named_materials_may_be_used_before_they_are_defined() {
    let scene = world(
        r#"
        NamedMaterial "b" Shape "sphere"
        MakeNamedMaterial "a" "string type" "dielectric"
        MakeNamedMaterial "b" "string type" "conductor"
        NamedMaterial "a" Shape "sphere"
        Material "diffuse" Shape "sphere"
        NamedMaterial "b" Shape "sphere""#,
    );
    let names: Vec<Option<&str>> = scene
        .shapes
        .iter()
        .map(|s| scene.materials[s.material.0 as usize].name.as_deref())
        .collect();
    assert_eq!(names, [Some("b"), Some("a"), None, Some("b")]);
}

#[test]
fn a_shape_of_the_interface_material_is_left_out() {
    let scene = world(
        r#"
        MakeNamedMaterial "none" "string type" "interface"
        Material "conductor"
        NamedMaterial "none" Shape "sphere"
        Material "dielectric" Shape "sphere""#,
    );
    assert_eq!(scene.shapes.len(), 1);
    let material = &scene.materials[scene.shapes[0].material.0 as usize];
    assert!(matches!(material.kind, MaterialKind::Dielectric { .. }));
    assert_eq!(scene.warnings.len(), 1);
}

#[test]
fn lights_have_the_parameters_of_pbrt() {
    let scene = world(
        r#"
        Translate 1 0 0
        LightSource "point" "rgb I" [1 2 3] "point3 from" [4 5 6] "float power" 100
        LightSource "distant" "blackbody L" 5000 "point3 to" [0 -1 0] "float illuminance" 10 "float scale" 3
        LightSource "infinite""#,
    );
    let [point, distant, infinite] = &scene.lights[..] else {
        panic!()
    };
    let value = |light: &lucerna::desc::LightDesc| light.spectrum.as_ref().map(|s| s.value.clone());
    let from = DVec3::new(4.0, 5.0, 6.0);
    assert_eq!(point.kind, LightKind::Point { from });
    assert_eq!(
        value(point),
        Some(SpectrumValue::Rgb([1.0, 2.0, 3.0], ColorSpace::Srgb))
    );
    assert_eq!((point.scale, point.photometric), (1.0, Some(100.0)));
    let (from, to) = (DVec3::ZERO, DVec3::NEG_Y);
    assert_eq!(distant.kind, LightKind::Distant { from, to });
    assert_eq!(value(distant), Some(SpectrumValue::Blackbody(5000.0)));
    assert_eq!((distant.scale, distant.photometric), (3.0, Some(10.0)));
    let (image, portal) = (None, None);
    assert_eq!(infinite.kind, LightKind::Infinite { image, portal });
    assert_eq!((value(infinite), infinite.photometric), (None, None));
    assert!(
        scene
            .lights
            .iter()
            .all(|l| l.world_from_light.start.translation == DVec3::X)
    );
}

#[test]
fn meshes_arrive_whole() {
    let scene = world(
        r#"
        Shape "trianglemesh" "point3 P" [0 0 0  1 0 0  0 1 0  0 0 1] "integer indices" [0 1 2  3 2 1]
            "normal N" [0 0 1  0 0 1  0 0 1  1 0 0] "vector3 S" [1 0 0  1 0 0  1 0 0  0 1 0]
            "point2 uv" [0 0  1 0  0 1  1 1] "point3 P1" [0 0 1  1 0 1  0 1 1  0 0 2]
        Shape "trianglemesh" "point3 P" [0 0 0  1 0 0  0 1 0]"#,
    );
    let mesh = |i: usize| match &scene.shapes[i].kind {
        ShapeKind::TriangleMesh(mesh) => mesh.clone(),
        other => panic!("{other:?}"),
    };
    let full = mesh(0);
    assert_eq!(full.positions, [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z]);
    assert_eq!(full.indices, [[0, 1, 2], [3, 2, 1]]);
    assert_eq!(full.normals[3], Vec3::X);
    assert_eq!(full.tangents[3], Vec3::Y);
    assert_eq!(full.uvs, [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::ONE]);
    let end = full.positions_end.as_ref().expect("moving vertices");
    assert!(full.positions.iter().zip(end).all(|(&a, &b)| b == a + Vec3::Z));
    let small = mesh(1);
    assert_eq!(small.indices, [[0, 1, 2]]);
    assert!(small.positions_end.is_none() && small.normals.is_empty() && small.uvs.is_empty());
}

#[test]
fn attribute_sets_defaults_for_what_follows() {
    let scene = world(
        r#"
        AttributeBegin
            Attribute "shape" "float radius" 3 "float alpha" 1
            Attribute "light" "float scale" 4
            Attribute "material" "rgb reflectance" [.1 .1 .1] "float uroughness" .2
            Shape "sphere"
            Shape "sphere" "float radius" 2
            Attribute "shape" "float radius" 5
            Shape "sphere"
            Material "diffuse"
            LightSource "infinite"
        AttributeEnd
        Shape "sphere""#,
    );
    let radii: Vec<f64> = scene
        .shapes
        .iter()
        .map(|s| match s.kind {
            ShapeKind::Sphere { radius } => radius,
            _ => 0.0,
        })
        .collect();
    assert_eq!(radii, [3.0, 2.0, 5.0, 1.0]);
    assert_eq!(scene.lights[0].scale, 4.0);
    let MaterialKind::Diffuse { reflectance, .. } = &scene.materials[1].kind else {
        panic!()
    };
    assert_eq!(*value(reflectance), SpectrumValue::Rgb([0.1; 3], ColorSpace::Srgb));
    // Nothing rough follows.
    assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
}

#[test]
fn instances_go_on_top_of_the_transforms_of_their_shapes() {
    let scene = world(
        r#"
        Translate 1 0 0
        ObjectInstance "thing"
        ObjectBegin "thing"
            Translate 0 1 0
            Material "conductor"
            Shape "sphere"
            AttributeBegin Translate 0 0 1 Shape "sphere" AttributeEnd
        ObjectEnd
        Shape "sphere"
        ActiveTransform EndTime Scale 2 2 2
        ObjectInstance "thing""#,
    );
    assert_eq!(scene.objects.len(), 1);
    let object = &scene.objects[0];
    assert_eq!(object.name, "thing");
    let places: Vec<DVec3> = object.shapes.iter().map(place).collect();
    assert_eq!(places, [DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, 1.0, 1.0)]);
    // The graphics state from before is back, material included.
    assert_eq!(scene.shapes.len(), 1);
    assert_eq!(
        (place(&scene.shapes[0]), scene.shapes[0].material),
        (DVec3::X, MaterialId(0))
    );
    let [first, second] = &scene.instances[..] else {
        panic!()
    };
    assert_eq!((first.object, second.object), (ObjectId(0), ObjectId(0)));
    assert!(first.world_from_instance.is_static());
    assert_eq!(first.world_from_instance.start.translation, DVec3::X);
    assert!(!second.world_from_instance.is_static());
    assert_eq!(second.world_from_instance.end.matrix3.x_axis, DVec3::new(2.0, 0.0, 0.0));
}

#[test]
fn nesting_is_as_deep_as_memory_is() {
    let depth = 100_000;
    let text = format!(
        "{}Shape \"sphere\"{}",
        "AttributeBegin ".repeat(depth),
        " AttributeEnd".repeat(depth)
    );
    assert_eq!(world(&text).shapes.len(), 1);
}

#[test]
fn the_cornell_box_is_read() {
    let Some(path) = shared("scenes/cornell-box/scene-v4.pbrt") else {
        return;
    };
    let scene = load(&path, &STRICT).unwrap_or_else(|e| panic!("{e}"));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    assert_eq!(scene.views[0].film.resolution, [1024, 1024]);
    assert_eq!(scene.views[0].sampler.pixel_samples, 64);
    let eye = scene.views[0].camera.world_from_camera().start.translation;
    assert!(eye.distance(DVec3::new(0.0, 1.0, 6.8)) < 1e-12, "{eye}");
    assert_eq!(scene.shapes.len(), 8);
    assert_eq!(scene.materials.len(), 9);
    let triangles: usize = scene
        .shapes
        .iter()
        .map(|s| match &s.kind {
            ShapeKind::TriangleMesh(mesh) => mesh.indices.len(),
            _ => 0,
        })
        .sum();
    assert_eq!(triangles, 5 * 2 + 2 * 12 + 2);
    let lights: Vec<&ShapeDesc> = scene.shapes.iter().filter(|s| s.area_light.is_some()).collect();
    let [light] = lights[..] else {
        panic!("{} lights", lights.len())
    };
    let l = light.area_light.as_ref().and_then(|a| a.l.as_ref()).map(|l| &l.value);
    assert_eq!(l, Some(&SpectrumValue::Rgb([17.0, 12.0, 4.0], ColorSpace::Srgb)));
    assert_eq!(
        scene.materials[light.material.0 as usize].name.as_deref(),
        Some("Light")
    );
    assert_eq!(scene.hash.len(), 64);
}
