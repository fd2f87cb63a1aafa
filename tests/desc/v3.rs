//! Files of pbrt-v3 are taken for what they mean in pbrt-v4.

use lucerna::desc::{
    ClassedTexture, ConductorDesc, FilterKind, ImageFilterDesc, IntegratorKind, LightKind, MaterialKind, PathDesc,
    SamplerKind, ShapeKind, SpectrumDesc, SpectrumValue, TextureKind, Textured,
};
use lucerna::spectrum::ColorSpace;

use crate::{STRICT, errors, read, scene, shared};

/// A scene of pbrt-v3.
fn old(text: &str) -> lucerna::desc::SceneDesc {
    scene(&format!("{text}\nWorldEnd\n# exported long ago\n"))
}

/// The material of a text.
fn material(text: &str) -> MaterialKind {
    let scene = old(&format!("WorldBegin {text} Shape \"sphere\""));
    scene.materials[scene.shapes[0].material.0 as usize].kind.clone()
}

fn rgb(v: f32) -> SpectrumValue {
    SpectrumValue::Rgb([v; 3], ColorSpace::Srgb)
}

#[track_caller]
fn value(spectrum: &Textured<SpectrumDesc>) -> &SpectrumValue {
    match spectrum {
        Textured::Value(desc) => &desc.value,
        Textured::Texture(_) => panic!("a texture"),
    }
}

#[track_caller]
fn number(value: &Textured<f32>) -> f32 {
    match value {
        Textured::Value(value) => *value,
        Textured::Texture(_) => panic!("a texture"),
    }
}

#[test]
fn options_are_translated() {
    let scene = old(r#"
        Film "image" "integer xresolution" 64 "float scale" 2 "float maxsampleluminance" 10
        Camera "perspective" "float halffov" 20 "float shutterclose" .5
        Sampler "random" "integer pixelsamples" 9
        PixelFilter "gaussian" "float xwidth" 3 "float alpha" 8
        Integrator "directlighting" "string strategy" "all" "string lightsamplestrategy" "spatial"
        WorldBegin"#);
    let view = &scene.views[0];
    assert_eq!(view.film.resolution, [64, 720]);
    // The shutter counts for nothing in pbrt-v3.
    assert_eq!((view.film.imaging_ratio(), view.film.max_component), (2.0, 10.0));
    assert!(matches!(
        view.camera.kind,
        lucerna::desc::CameraKind::Perspective { fov: 40.0, .. }
    ));
    assert_eq!(
        (view.sampler.kind, view.sampler.pixel_samples),
        (SamplerKind::Independent, 9)
    );
    assert_eq!(
        (view.filter.kind, view.filter.radius),
        (FilterKind::Gaussian { sigma: 0.25 }, [3.0, 2.0])
    );
    assert_eq!(scene.integrator.kind, IntegratorKind::Path(PathDesc::default()));
    assert_eq!(scene.integrator.max_depth, Some(1));
    assert!(scene.warnings.iter().any(|w| w.message.contains("pbrt-v3")));
}

#[test]
fn what_is_left_out_is_as_it_was() {
    let scene = old("WorldBegin");
    let view = &scene.views[0];
    assert_eq!((view.filter.kind, view.filter.radius), (FilterKind::Box, [0.5, 0.5]));
    assert_eq!(
        (view.sampler.kind, view.sampler.pixel_samples),
        (SamplerKind::Halton, 16)
    );
    assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
    // A film says it too, and says so once.
    let scene = read("Film \"image\" WorldBegin", &STRICT).expect("a scene");
    assert_eq!(scene.views[0].filter.kind, FilterKind::Box);
    assert_eq!(scene.warnings.len(), 2, "{:?}", scene.warnings);
}

#[test]
fn materials_are_translated() {
    let MaterialKind::Diffuse { reflectance, .. } =
        material("Material \"matte\" \"color Kd\" [.3 .3 .3] \"float sigma\" 0")
    else {
        panic!("matte")
    };
    assert_eq!(value(&reflectance), &rgb(0.3));
    let MaterialKind::CoatedDiffuse { reflectance, coat } =
        material("Material \"plastic\" \"bool remaproughness\" \"false\"")
    else {
        panic!("plastic")
    };
    assert_eq!((value(&reflectance), number(&coat.roughness.u)), (&rgb(0.25), 0.1));
    assert!(!coat.roughness.remap);
    // A roughness of 0.1 is a slope of 0.4617 in pbrt-v3.
    let MaterialKind::CoatedDiffuse { coat, .. } = material("Material \"substrate\"") else {
        panic!("substrate")
    };
    assert!((number(&coat.roughness.v).sqrt() - 0.4617).abs() < 1e-3);
    let plain = "Material \"uber\" \"rgb Ks\" [0 0 0] \"rgb Kr\" [0 0 0] \"rgb opacity\" [1 1 1] \"float index\" 1.3";
    assert!(matches!(material(plain), MaterialKind::Diffuse { .. }));
    let MaterialKind::Conductor {
        interface: ConductorDesc::Reflectance(r),
        roughness,
        ..
    } = material("Material \"mirror\"")
    else {
        panic!("mirror")
    };
    assert_eq!((value(&r), number(&roughness.u)), (&rgb(0.9), 0.0));
    let MaterialKind::Dielectric { eta, roughness, .. } =
        material("Material \"glass\" \"float index\" 1.7 \"float uroughness\" 1")
    else {
        panic!("glass")
    };
    assert_eq!(eta.value, SpectrumValue::Constant(1.7));
    assert!((number(&roughness.u).sqrt() - 1.62142).abs() < 1e-5 && number(&roughness.v).sqrt() < 0.05);
    let MaterialKind::DiffuseTransmission {
        reflectance,
        transmittance,
        scale,
    } = material(
        "Material \"translucent\" \"rgb Kd\" [.4 .4 .4] \"rgb reflect\" [.2 .2 .2] \"rgb transmit\" [.8 .8 .8]",
    )
    else {
        panic!("translucent")
    };
    assert_eq!(
        (value(&reflectance), value(&transmittance), scale),
        (&rgb(0.1), &rgb(0.4), 0.8)
    );
    assert!(matches!(
        material("Material \"disney\" \"float metallic\" .5"),
        MaterialKind::Principled(_)
    ));
}

#[test]
fn a_mix_keeps_its_shares() {
    let scene = old(r#"WorldBegin
        MakeNamedMaterial "a" "string type" "matte" MakeNamedMaterial "b" "string type" "mirror"
        Material "mix" "string namedmaterial1" "a" "string namedmaterial2" "b" "rgb amount" [.1 .2 .3]
        Shape "sphere""#);
    let MaterialKind::Mix { materials, amount } = &scene.materials[scene.shapes[0].material.0 as usize].kind else {
        panic!("a mix")
    };
    // The amount was that of the first.
    let names = materials.map(|id| scene.materials[id.0 as usize].name.clone().unwrap_or_default());
    assert_eq!(names, ["b", "a"]);
    assert!((number(amount) - 0.2).abs() < 1e-6);
}

#[test]
fn lights_are_translated() {
    let scene = old(r#"WorldBegin
        LightSource "point" "rgb I" [1 2 3] "rgb scale" [2 2 2] "integer samples" 4
        LightSource "distant" "rgb L" [1 2 3] "rgb scale" [1 2 3]
        LightSource "infinite" "blackbody L" [5000 3]
        AreaLightSource "area" "rgb L" [1 1 1] "bool twosided" "true" "integer nsamples" 4
        Shape "sphere""#);
    assert_eq!(scene.lights[0].scale, 2.0);
    let color = scene.lights[1].spectrum.as_ref().map(|s| &s.value);
    assert_eq!(color, Some(&SpectrumValue::Rgb([1.0, 4.0, 9.0], ColorSpace::Srgb)));
    // Planck's law at 5000 K, with a maximum of 1, has a luminance of nearly 1.
    let scale = scene.lights[2].scale;
    assert!((2.8..3.0).contains(&scale), "{scale}");
    let lamp = scene.shapes[0].area_light.as_ref().expect("a lamp");
    assert!(lamp.two_sided);
}

#[test]
fn images_are_translated() {
    let directory = tempfile::tempdir().expect("a directory");
    let pixel = lucerna::image_io::Window::of_size(2, 1);
    let image = lucerna::image_io::Image::rgb(pixel, pixel, vec![0.5; 6]).expect("an image");
    let path = directory.path().join("a.exr");
    let output = lucerna::image_io::PendingOutput::create(&path).expect("a file");
    output.commit(&image, None, 0.0).expect("written");
    let path = path.display();
    let scene = old(&format!(
        r#"WorldBegin
        Texture "t" "color" "imagemap" "string filename" "{path}" "bool gamma" "false"
        Texture "u" "color" "imagemap" "string filename" "{path}" "bool trilinear" "true"
        Texture "twice" "color" "scale" "texture tex1" "t" "rgb tex2" [2 2 2]
        Texture "t" "color" "constant" "rgb value" [.5 .5 .5]
        LightSource "infinite" "string mapname" "{path}" "rgb L" [3 3 3]"#
    ));
    let ClassedTexture::Spectrum(TextureKind::Image(map)) = &scene.textures[0].kind else {
        panic!("an image")
    };
    assert!(matches!(map.filter, ImageFilterDesc::Ewa { .. }));
    let ClassedTexture::Spectrum(TextureKind::Image(map)) = &scene.textures[1].kind else {
        panic!("an image")
    };
    assert_eq!(map.filter, ImageFilterDesc::Trilinear);
    // The second `t` is another texture.
    assert_eq!(scene.textures.len(), 4);
    assert!(matches!(
        &scene.textures[2].kind,
        ClassedTexture::Spectrum(TextureKind::Scale { tex: Textured::Texture(id), scale: Textured::Value(2.0) }) if id.0 == 0
    ));
    assert!(matches!(
        &scene.lights[0].kind,
        LightKind::Infinite { image: Some(_), .. }
    ));
    assert_eq!(scene.lights[0].scale, 3.0);
}

#[test]
fn meshes_are_translated() {
    let scene = old(r#"WorldBegin
        Shape "trianglemesh" "point P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 2] "float st" [0 0 1 0 0 1]
            "bool discarddegenerateUVs" "true""#);
    let ShapeKind::TriangleMesh(mesh) = &scene.shapes[0].kind else {
        panic!("a mesh")
    };
    assert_eq!((mesh.positions.len(), mesh.uvs.len()), (3, 3));
}

#[test]
fn what_has_no_counterpart_is_an_error() {
    for (text, message) in [
        ("Material \"fourier\" \"string bsdffile\" \"x\"", "`fourier`"),
        ("Material \"uber\" \"rgb opacity\" [.5 .5 .5]", "`opacity`"),
        ("Material \"kdsubsurface\"", "`subsurface` is not supported"),
        (
            "Material \"disney\" \"rgb scatterdistance\" [1 1 1]",
            "`scatterdistance`",
        ),
        ("Shape \"cone\"", "`cone`"),
        (
            "LightSource \"infinite\" \"string mapname\" \"x\" \"rgb L\" [1 2 3]",
            "beside an image",
        ),
    ] {
        let errors = errors(&format!("WorldBegin {text}\nWorldEnd"));
        assert!(errors.iter().any(|e| e.message.contains(message)), "{text}: {errors:?}");
    }
    // In a file of pbrt-v4 nothing is translated.
    let errors = errors("WorldBegin Material \"matte\"\nShape \"trianglemesh\" \"point P\" [0 0 0]");
    assert_eq!(errors.len(), 3, "{errors:?}");
}

/// The same scene, as pbrt-v3 and as pbrt-v4 has it.
#[test]
fn the_cornell_box_is_the_same() {
    let (Some(old), Some(new)) = (
        shared("scenes/cornell-box/scene.pbrt"),
        shared("scenes/cornell-box/scene-v4.pbrt"),
    ) else {
        return;
    };
    let [old, new] = [old, new].map(|path| lucerna::desc::load(&path, &STRICT).unwrap_or_else(|e| panic!("{e}")));
    assert_eq!(old.shapes.len(), new.shapes.len());
    for (a, b) in old.shapes.iter().zip(&new.shapes) {
        let (ShapeKind::TriangleMesh(a), ShapeKind::TriangleMesh(b)) = (&a.kind, &b.kind) else {
            panic!("meshes")
        };
        assert_eq!((&a.positions, &a.uvs, &a.indices), (&b.positions, &b.uvs, &b.indices));
    }
    assert!(old.warnings.len() > 2 && new.warnings.is_empty());
}
