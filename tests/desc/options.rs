//! What stands before `WorldBegin`: views and the integrator.

use std::path::Path;

use glam::{DAffine3, DVec3};
use lucerna::desc::{
    ApertureDesc, CameraKind, ColorSpace, CropDesc, Distribution, FilmKind, FilterKind, GBufferSpace, Heuristic,
    IntegratorDesc, IntegratorKind, KajiyaDesc, LightSamplerKind, MeasureDesc, MotionDesc, OcclusionDesc, PathDesc,
    PixelRect, SAMPLERS, SamplerKind, SensorDesc, SpectralBins, SpectrumValue, Strategy, Termination,
};
use lucerna::sampling::Strata;

use crate::scene;

#[test]
fn defaults_are_those_of_pbrt() {
    let scene = scene("WorldBegin");
    assert_eq!(scene.views.len(), 1);
    let view = &scene.views[0];
    assert_eq!(view.name, "camera");
    let perspective = CameraKind::Perspective {
        fov: 90.0,
        near_clip: 0.0,
    };
    assert_eq!(view.camera.kind, perspective);
    assert_eq!(view.camera.lens_radius, 0.0);
    assert_eq!(view.camera.focal_distance, 1e6);
    assert_eq!(view.camera.shutter, [0.0, 1.0]);
    assert_eq!(view.camera.world_from_camera(), MotionDesc::IDENTITY);
    assert_eq!(view.film.resolution, [1280, 720]);
    assert_eq!(view.film.crop, CropDesc::Full);
    assert_eq!(view.film.filename, None);
    assert_eq!(view.film.imaging_ratio(), 1.0);
    assert_eq!(view.filter.kind, FilterKind::Gaussian { sigma: 0.5 });
    assert_eq!(view.filter.radius, [1.5, 1.5]);
    assert_eq!(view.sampler.kind, SamplerKind::ZSobol);
    assert_eq!(view.sampler.pixel_samples, 16);
    let path = IntegratorDesc {
        max_depth: Some(5),
        light_sampler: LightSamplerKind::Bvh,
        kind: IntegratorKind::Path(PathDesc {
            strategy: Strategy::Mis,
            heuristic: Heuristic::Power,
            splitting: 1,
        }),
    };
    assert_eq!(scene.integrator, path);
    assert_eq!(scene.transform_times, [0.0, 1.0]);
    assert_eq!(scene.materials.len(), 1);
    assert!(scene.shapes.is_empty() && scene.lights.is_empty() && scene.warnings.is_empty());
}

#[test]
fn every_parameter_arrives() {
    let scene = scene(
        r#"
        TransformTimes 1 3
        Camera "orthographic" "float screenwindow" [-2 3 -1 1] "float lensradius" .5 "float focaldistance" [ 7 ]
            "float shutteropen" 1.5 "float shutterclose" 2 "string name" "from above"
        Film "rgb" "integer xresolution" 200 "integer yresolution" [100] "string filename" "a/b.exr" "float iso" 400
            "float cropwindow" [ .75 .25 0 1 ]
        PixelFilter "mitchell" "float xradius" 3 "float B" .5 "float C" .25
        Sampler "independent"
        Integrator "path" "integer maxdepth" -1 "string lightsampler" "power" "bool regularize" false
            "string strategy" "light" "string heuristic" "balance" "integer splitting" 4
        WorldBegin"#,
    );
    let view = &scene.views[0];
    assert_eq!(view.name, "from above");
    assert_eq!(view.camera.kind, CameraKind::Orthographic);
    assert_eq!(view.camera.screen_window([200, 100]), [-2.0, 3.0, -1.0, 1.0]);
    assert_eq!(view.camera.lens_radius, 0.5);
    assert_eq!(view.camera.focal_distance, 7.0);
    assert_eq!(view.camera.shutter, [1.5, 2.0]);
    assert_eq!(view.film.resolution, [200, 100]);
    assert_eq!(view.film.filename.as_deref(), Some(Path::new("a/b.exr")));
    // The exposure time is the shutter's: 0.5 * 400 / 100.
    assert_eq!(view.film.imaging_ratio(), 2.0);
    let crop = PixelRect {
        x0: 50,
        y0: 0,
        x1: 150,
        y1: 100,
    };
    assert_eq!(view.film.crop.pixels([200, 100]), crop);
    assert_eq!(view.filter.kind, FilterKind::Mitchell { b: 0.5, c: 0.25 });
    assert_eq!(view.filter.radius, [3.0, 2.0]);
    assert_eq!(view.sampler.kind, SamplerKind::Independent);
    assert_eq!(view.sampler.pixel_samples, 4);
    let path = IntegratorDesc {
        max_depth: None,
        light_sampler: LightSamplerKind::Power,
        kind: IntegratorKind::Path(PathDesc {
            strategy: Strategy::Light,
            heuristic: Heuristic::Balance,
            splitting: 4,
        }),
    };
    assert_eq!(scene.integrator, path);
    assert_eq!(scene.transform_times, [1.0, 3.0]);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn the_oracle_has_its_parameters() {
    let kind = |parameters: &str| {
        scene(&format!("Integrator \"kajiya\" {parameters}\nWorldBegin"))
            .integrator
            .kind
    };
    assert_eq!(kind(""), IntegratorKind::Kajiya(KajiyaDesc::default()));
    let all = kind(
        r#""float alpha" 0.25 "integer branching" 3 "string distribution" "uniform" "string termination" "albedo""#,
    );
    let expected = KajiyaDesc {
        termination: Termination::Albedo,
        branching: 3,
        distribution: Distribution::Uniform,
    };
    assert_eq!(all, IntegratorKind::Kajiya(expected));
    let IntegratorKind::Kajiya(constant) = kind(r#""float alpha" 0.25 "string distribution" "cosine""#) else {
        panic!("another integrator");
    };
    assert_eq!(constant.termination, Termination::Constant(0.25));
    assert_eq!(constant.distribution, Distribution::Cosine);
}

#[test]
fn filters_have_the_radii_of_pbrt() {
    for (name, radius, kind) in [
        ("box", 0.5, FilterKind::Box),
        ("triangle", 2.0, FilterKind::Triangle),
        ("sinc", 4.0, FilterKind::LanczosSinc { tau: 3.0 }),
        ("blackmanharris", 2.0, FilterKind::BlackmanHarris),
    ] {
        let filter = scene(&format!("PixelFilter \"{name}\" WorldBegin")).views[0].filter;
        assert_eq!((filter.radius, filter.kind), ([radius; 2], kind));
    }
}

#[test]
fn the_screen_window_follows_the_aspect_ratio() {
    let camera = |text: &str| {
        scene(&format!("Camera \"perspective\" {text} WorldBegin")).views[0]
            .camera
            .clone()
    };
    let plain = camera("\"float nearclip\" .25 \"float fov\" 40");
    assert_eq!(plain.screen_window([200, 100]), [-2.0, 2.0, -1.0, 1.0]);
    assert_eq!(plain.screen_window([100, 200]), [-1.0, 1.0, -2.0, 2.0]);
    assert_eq!(plain.screen_window([7, 7]), [-1.0, 1.0, -1.0, 1.0]);
    let kind = CameraKind::Perspective {
        fov: 40.0,
        near_clip: 0.25,
    };
    assert_eq!(plain.kind, kind);
    let squeezed = camera("\"float frameaspectratio\" 4");
    assert_eq!(squeezed.screen_window([7, 7]), [-4.0, 4.0, -1.0, 1.0]);
}

#[test]
fn crops_are_rounded_up_and_clamped_as_in_pbrt() {
    let film = |text: &str| {
        let text = format!("Film \"rgb\" \"integer xresolution\" 10 \"integer yresolution\" 8 {text} WorldBegin");
        let film = scene(&text).views[0].film.clone();
        let PixelRect { x0, y0, x1, y1 } = film.crop.pixels(film.resolution);
        [x0, x1, y0, y1]
    };
    assert_eq!(film("\"float cropwindow\" [.11 .52 0 .5]"), [2, 6, 0, 4]);
    assert_eq!(film("\"integer pixelbounds\" [2 5 -3 900]"), [2, 5, 0, 8]);
    assert_eq!(
        film("\"integer pixelbounds\" [2 5 1 3] \"float cropwindow\" [0 .5 0 1]"),
        [0, 5, 0, 8]
    );
}

#[test]
fn repeated_cameras_are_views_that_share_the_rest() {
    let scene = scene(
        r#"
        Translate 0 0 5
        Camera "perspective" "float shutterclose" .5
        Identity
        Camera "perspective" "string name" "side"
        Film "rgb" "integer xresolution" 10
        Camera "orthographic"
        WorldBegin"#,
    );
    let names: Vec<&str> = scene.views.iter().map(|v| v.name.as_str()).collect();
    assert_eq!(names, ["camera1", "side", "camera3"]);
    let eye = |i: usize| scene.views[i].camera.world_from_camera().start.translation;
    assert_eq!(eye(0), DVec3::new(0.0, 0.0, -5.0));
    assert_eq!(eye(1), DVec3::ZERO);
    assert!(scene.views.iter().all(|v| v.film.resolution == [10, 720]));
    let exposure: Vec<f64> = scene.views.iter().map(|v| v.film.exposure_time).collect();
    assert_eq!(exposure, [0.5, 1.0, 1.0]);
}

#[test]
fn the_camera_is_where_look_at_puts_it() {
    let scene = scene(
        "LookAt 1 2 3  4 2 3  0 1 0 Camera \"perspective\" WorldBegin CoordSysTransform \"camera\" Shape \"sphere\"",
    );
    let world_from_camera = scene.views[0].camera.world_from_camera();
    assert!(world_from_camera.is_static());
    let at = |p| world_from_camera.start.transform_vector3(p);
    // It looks along +x with y up; pbrt's camera space is left-handed, so right is up x forward, towards -z.
    let near = |a: DVec3, b: DVec3| a.distance(b) < 1e-12;
    assert!(near(world_from_camera.start.translation, DVec3::new(1.0, 2.0, 3.0)));
    assert!(near(at(DVec3::Z), DVec3::X) && near(at(DVec3::Y), DVec3::Y) && near(at(DVec3::X), DVec3::NEG_Z));
    assert_eq!(scene.shapes[0].world_from_object, world_from_camera);
}

#[test]
fn a_camera_may_move() {
    let scene = scene(
        "ActiveTransform StartTime Translate 1 0 0 ActiveTransform EndTime Translate 0 1 0 ActiveTransform All Scale 2 2 2
         Camera \"perspective\" WorldBegin",
    );
    let motion = scene.views[0].camera.world_from_camera();
    assert!(!motion.is_static());
    // The inverse of a translation after a scale by 2.
    let half = |x, y| {
        DAffine3::from_scale_rotation_translation(DVec3::splat(0.5), glam::DQuat::IDENTITY, DVec3::new(x, y, 0.0))
    };
    assert!(motion.start.abs_diff_eq(half(-0.5, 0.0), 1e-15));
    assert!(motion.end.abs_diff_eq(half(0.0, -0.5), 1e-15));
}

#[test]
fn what_cannot_change_the_image_is_a_warning() {
    let scene = scene(
        r#"
        Accelerator "bvh" "integer maxnodeprims" 4
        Film "rgb" "float diagonal" 35 "bool savefp16" false "string sensor" "cie1931" "float whitebalance" 0
        Sampler "halton" "string randomization" "owen" "integer seed" 3
        Integrator "volpath"
        Option "seed" 7
        Option "disable-pixel-jitter" false
        Integrator "path" "bool regularize" true
        WorldBegin
        Attribute "shape" "float alhpa" 1
        Shape "sphere"
        "#,
    );
    let lines: Vec<usize> = scene.warnings.iter().map(|w| w.line).collect();
    assert_eq!(lines, [2, 3, 4, 4, 6, 8, 8, 10]);
    assert!(scene.warnings[0].message.contains("--backend"));
    assert_eq!(scene.views[0].sampler.kind, SamplerKind::Halton);
}

#[test]
fn each_integrator_of_pbrt_has_one_that_stands_for_it() {
    let path = IntegratorKind::Path(PathDesc::default());
    let blind = IntegratorKind::Path(PathDesc {
        strategy: Strategy::Bsdf,
        ..PathDesc::default()
    });
    let mlt = "\"mlt\" \"integer chains\" 10 \"integer bootstrapsamples\" 10 \"integer mutationsperpixel\" 3 \"float sigma\" .1
        \"float largestepprobability\" .3 \"integer maxdepth\" 7";
    let cases = [
        ("\"volpath\" \"integer maxdepth\" 7", path, 0),
        ("\"simplevolpath\" \"integer maxdepth\" 7", path, 1),
        (
            "\"simplepath\" \"integer maxdepth\" 7 \"bool samplebsdf\" false",
            path,
            1,
        ),
        (
            "\"simplepath\" \"bool samplelights\" false \"integer maxdepth\" 7",
            blind,
            1,
        ),
        ("\"randomwalk\" \"integer maxdepth\" 7", blind, 1),
        (mlt, IntegratorKind::Bdpt(Heuristic::Power), 6),
    ];
    let occlusion =
        scene("Integrator \"ambientocclusion\" \"bool cossample\" false \"float maxdistance\" 3 WorldBegin");
    let desc = OcclusionDesc {
        cosine: false,
        max_distance: Some(3.0),
    };
    assert_eq!(occlusion.integrator.kind, IntegratorKind::Occlusion(desc));
    assert!(occlusion.warnings.is_empty());
    for (text, kind, warnings) in cases {
        let scene = scene(&format!("Integrator {text} WorldBegin"));
        assert_eq!(
            (scene.integrator.kind, scene.integrator.max_depth),
            (kind, Some(7)),
            "{text}"
        );
        assert_eq!(scene.warnings.len(), warnings, "{text}");
    }
}

#[test]
fn films_keep_what_they_are_asked_for() {
    let of = |text: &str| scene(&format!("Film {text} WorldBegin")).views[0].film.kind;
    assert_eq!(of("\"rgb\""), FilmKind::Rgb);
    assert_eq!(of("\"gbuffer\""), FilmKind::GBuffer(GBufferSpace::Camera));
    let world = of("\"gbuffer\" \"string coordinatesystem\" \"world\" \"float iso\" 200");
    assert_eq!(world, FilmKind::GBuffer(GBufferSpace::World));
    let bins = |range, count| FilmKind::Spectral(SpectralBins { range, count });
    assert_eq!(of("\"spectral\""), bins([360.0, 830.0], 16));
    let some = of("\"spectral\" \"integer nbuckets\" 3 \"float lambdamin\" 400 \"float lambdamax\" 700");
    assert_eq!(some, bins([400.0, 700.0], 3));
}

#[test]
fn samplers_are_read_by_their_names() {
    let of = |text: &str| {
        let scene = scene(&format!("Sampler {text}\nWorldBegin"));
        let sampler = scene.views[0].sampler;
        (sampler.kind, sampler.pixel_samples, scene.warnings.len())
    };
    let stratified = |columns, rows, jitter| SamplerKind::Stratified(Strata { columns, rows, jitter });
    assert_eq!(of(r#""stratified""#), (stratified(4, 4, true), 16, 0));
    let given = of(r#""stratified" "integer xsamples" 3 "integer ysamples" 5 "bool jitter" false"#);
    assert_eq!(given, (stratified(3, 5, false), 15, 0));
    assert_eq!(of(r#""halton" "integer pixelsamples" 9"#), (SamplerKind::Halton, 9, 0));
    assert_eq!(of(r#""zsobol""#), (SamplerKind::ZSobol, 16, 0));
    assert_eq!(of(r#""sobol""#), (SamplerKind::Sobol, 16, 0));
    assert_eq!(of(r#""paddedsobol""#), (SamplerKind::Sobol, 16, 0));
    assert_eq!(of(r#""pmj02bn""#), (SamplerKind::ZSobol, 16, 1));
    for entry in &SAMPLERS {
        assert_eq!(of(&format!("\"{}\"", entry.name)).2, 0);
    }
}

#[test]
fn a_file_without_options_has_those_of_the_tables() {
    let plain = scene("WorldBegin");
    let named = scene("Sampler \"zsobol\" Integrator \"path\"\nWorldBegin");
    assert_eq!(plain.integrator, named.integrator);
    assert_eq!(plain.views[0].sampler, named.views[0].sampler);
}

#[test]
fn films_know_their_sensor_and_lenses_their_blades() {
    let read = scene(
        r#"
        ColorSpace "rec2020"
        Film "rgb" "string sensor" "nikon_d850" "float whitebalance" 5000 "float maxcomponentvalue" 10 "string measure" "irradiance"
        ColorSpace "srgb"
        Camera "perspective" "integer blades" 6 "float bladerotation" 15
        WorldBegin
        AttributeBegin
        ColorSpace "dci-p3"
        Attribute "light" "rgb L" [1 2 3]
        LightSource "point" "rgb I" [3 2 1]
        ColorSpace "srgb"
        LightSource "infinite"
        AttributeEnd
        LightSource "point" "rgb I" [3 2 1]
        "#,
    );
    let view = &read.views[0];
    assert_eq!(view.film.sensor, SensorDesc::Named("nikon_d850".to_owned()));
    assert_eq!((view.film.white_balance, view.film.max_component), (Some(5000.0), 10.0));
    assert_eq!(
        (view.film.measure, view.film.color_space),
        (MeasureDesc::Irradiance, ColorSpace::Rec2020)
    );
    let blades = ApertureDesc::Polygon {
        blades: 6,
        rotation: 15.0,
    };
    assert_eq!(view.camera.aperture, blades);
    // A colour is in the space at its own directive, also where `Attribute` gives it.
    let colors: Vec<SpectrumValue> = read
        .lights
        .iter()
        .filter_map(|light| light.spectrum.as_ref().map(|spectrum| spectrum.value.clone()))
        .collect();
    let expected = [
        ([3.0, 2.0, 1.0], ColorSpace::DciP3),
        ([1.0, 2.0, 3.0], ColorSpace::DciP3),
        ([3.0, 2.0, 1.0], ColorSpace::Srgb),
    ];
    assert_eq!(colors, expected.map(|(rgb, space)| SpectrumValue::Rgb(rgb, space)));
}
