//! Bad input: what is said, and where. `@` in a text marks the first character that is meant.

use lucerna::error::Severity;

use crate::{LENIENT, errors, read, scene};

/// (text with one `@`, part of the message, part of the help).
type Case = (&'static str, &'static str, &'static str);

/// Checks that a text gives one error, with this message and help at the mark.
fn check(&(marked, message, help): &Case) {
    let at = marked.find('@').unwrap_or_else(|| panic!("no mark in {marked}"));
    let before = &marked[..at];
    let line = 1 + before.matches('\n').count();
    let column = 1 + before.rsplit('\n').next().map_or(0, |l| l.chars().count());
    let errors = errors(&marked.replacen('@', "", 1));
    let all: Vec<String> = errors.iter().map(ToString::to_string).collect();
    let [error] = &errors[..] else {
        panic!("{marked}\ngives {} errors:\n{}", errors.len(), all.join("\n"))
    };
    assert!(
        error.message.contains(message),
        "{marked}\ngives\n{error}\nwithout `{message}`"
    );
    assert_eq!((error.line, error.column), (line, column), "{marked}\ngives\n{error}");
    let found = error.help.as_deref().unwrap_or_default();
    assert!(found.contains(help), "{marked}\ngives\n{error}\nwithout `{help}`");
    assert!(!help.is_empty() || found.is_empty(), "{marked}\ngives\n{error}");
}

#[test]
fn syntax() {
    let cases: [Case; 20] = [
        (
            "WorldBegin\n @Shappe \"sphere\" \"float radius\" 1",
            "unknown directive `Shappe`",
            "`Shape`",
        ),
        ("WorldBegin @\"sphere\"", "expected a directive", ""),
        ("WorldBegin @] Shape \"sphere\"", "expected a directive, found `]`", ""),
        (
            "WorldBegin Shape @Translate 1 2 3",
            "expected a string in double quotes, found `Translate`",
            "",
        ),
        ("WorldBegin @Shape", "found the end of the file", ""),
        (
            "WorldBegin\n\tTranslate 1 2 @Shape \"sphere\"",
            "expected 3 finite numbers, found `Shape` after 2",
            "",
        ),
        (
            "WorldBegin Translate 1 2 @1e999",
            "expected 3 finite numbers, found `1e999`",
            "",
        ),
        ("WorldBegin Transform @1 2 3", "expected `[`", ""),
        ("WorldBegin Transform [ 1 2 3 @]", "expected 16 finite numbers", ""),
        ("WorldBegin Shape @\"sphere", "not closed", ""),
        ("WorldBegin Shape @\"sph\\qere\"", "unknown escape", ""),
        ("WorldBegin Shape \"sphere\" @\"float radius\"", "no value", ""),
        (
            "WorldBegin Shape \"sphere\" \"float radius\" @[ 1",
            "not closed by `]`",
            "",
        ),
        ("WorldBegin Shape \"sphere\" @\"radius\" 1", "type and its name", ""),
        (
            "WorldBegin Shape \"sphere\" @\"flaot radius\" 1",
            "unknown parameter type `flaot`",
            "`float`",
        ),
        (
            "WorldBegin Shape \"sphere\" @\"point P\" [1 2 3]",
            "unknown parameter type `point`",
            "`point3`",
        ),
        (
            "WorldBegin Shape \"sphere\" \"float radius\" 1 @\"float radius\" 2",
            "a second time",
            "",
        ),
        (
            "WorldBegin ActiveTransform @Both",
            "expected `All`, `StartTime` or `EndTime`, found `Both`",
            "",
        ),
        (
            "WorldBegin Shape \"sphere\" \"float radius\" [ 1 @Shape \"sphere\"",
            "expected a finite number, found `Shape`",
            "",
        ),
        ("@WorldBegn", "unknown directive", "`WorldBegin`"),
    ];
    for case in &cases[..19] {
        check(case);
    }
    // Besides, there is no world then.
    let errors = errors("WorldBegn");
    assert_eq!(errors.len(), 2);
    assert!(errors[0].message.contains(cases[19].1) && errors[1].message.contains("before `WorldBegin`"));
}

#[test]
fn values() {
    let cases: [Case; 34] = [
        (
            "WorldBegin Shape \"sphere\" \"float radius\" @\"big\"",
            "expected a finite number, found `\"big\"`",
            "",
        ),
        (
            "WorldBegin Shape \"sphere\" \"float radius\" [1 @x]",
            "expected a finite number, found `x`",
            "",
        ),
        (
            "WorldBegin Shape \"sphere\" \"float radius\" @[1 2]",
            "takes 1 value, found 2",
            "",
        ),
        (
            "WorldBegin Shape \"sphere\" \"float radius\" @[]",
            "takes 1 value, found 0",
            "",
        ),
        (
            "WorldBegin Shape \"sphere\" @\"integer radius\" 1",
            "has the type `integer`, expected `float`",
            "",
        ),
        (
            "WorldBegin Shape \"sphere\" \"float radius\" @-2",
            "`radius` is -2, it must be positive",
            "",
        ),
        (
            "WorldBegin Shape \"sphere\" \"float radius\" @0",
            "must be positive",
            "",
        ),
        (
            "WorldBegin Shape \"sphere\" \"float radius\" @1e39",
            "does not fit into 32-bit",
            "",
        ),
        (
            "WorldBegin Shape \"sphere\" @\"float raduis\" 2",
            "shape `sphere` has no parameter `raduis`",
            "`radius`",
        ),
        ("WorldBegin Shape \"sphere\" @\"float zmin\" 0", "parts of spheres", ""),
        (
            "Camera \"perspective\" \"float fov\" @[ 180 ] WorldBegin",
            "between 0 and 180",
            "",
        ),
        (
            "Camera \"perspective\" @\"float shutterclose\" 0 WorldBegin",
            "shutter closes at 0",
            "",
        ),
        (
            "Camera \"perspective\" \"string name\" @\"a/b\" WorldBegin",
            "the name of a view",
            "",
        ),
        (
            "Camera \"perspective\" \"float screenwindow\" @[1 2 3] WorldBegin",
            "takes 4 values, found 3",
            "",
        ),
        (
            "Film \"rgb\" \"integer xresolution\" @0 WorldBegin",
            "between 1 and",
            "",
        ),
        (
            "Film \"rgb\" \"integer xresolution\" @99999999999 WorldBegin",
            "32 bits",
            "",
        ),
        (
            "Film \"rgb\" \"integer xresolution\" @1.5 WorldBegin",
            "expected an integer, found `1.5`",
            "",
        ),
        (
            "Film \"rgb\" \"bool savefp16\" @\"true\" WorldBegin",
            "expected `true` or `false`",
            "",
        ),
        (
            "Film \"rgb\" @\"float cropwindow\" [.5 .5 0 1] WorldBegin",
            "leaves no pixel",
            "",
        ),
        (
            "Film \"rgb\" \"float maxcomponentvalue\" @0 WorldBegin",
            "`maxcomponentvalue` is 0, it must be positive",
            "",
        ),
        (
            "Film \"rgb\" \"float whitebalance\" @12 WorldBegin",
            "must be a temperature between 1000 and 1000000 K, or 0",
            "",
        ),
        (
            "Film \"rgb\" \"string sensor\" @\"nikon_d800\" WorldBegin",
            "neither the name of a sensor nor a file",
            "`nikon_d810`",
        ),
        (
            "Film \"rgb\" \"string measure\" @\"flux\" WorldBegin",
            "`radiance` or `irradiance`, not `flux`",
            "",
        ),
        (
            "Camera \"perspective\" \"integer blades\" @2 WorldBegin",
            "`blades` is 2, it must be between 3 and 64, or 0",
            "",
        ),
        (
            "Camera \"perspective\" @\"integer bladerotation\" 10 WorldBegin",
            "expected `float`",
            "",
        ),
        (
            "WorldBegin Material \"dielectric\" \"spectrum eta\" @\"sellmeier-N-BK8\"",
            "neither the name of a spectrum nor a file",
            "`sellmeier-N-BK7`",
        ),
        (
            "Sampler \"sobol\" \"integer pixelsamples\" @0 WorldBegin",
            "must be 1 to 16777216",
            "",
        ),
        (
            "Integrator \"path\" \"integer maxdepth\" @-2 WorldBegin",
            "must be -1 or more",
            "",
        ),
        (
            "Integrator \"path\" \"string lightsampler\" @\"pwoer\" WorldBegin",
            "`lightsampler` is one of",
            "`power`",
        ),
        (
            "Sampler \"stratified\" \"integer xsamples\" @0 WorldBegin",
            "must be 1 to 4096",
            "",
        ),
        (
            "Sampler \"sobol\" @\"bool jitter\" false WorldBegin",
            "no parameter `jitter`",
            "",
        ),
        (
            "Integrator \"kajiya\" \"float alpha\" @1 WorldBegin",
            "must be between 0.05 and 0.95",
            "",
        ),
        ("@TransformTimes 1 1 WorldBegin", "must come before", ""),
        ("@Option \"sead\" 1 WorldBegin", "unknown option `sead`", "`seed`"),
    ];
    cases.iter().for_each(check);
}

#[test]
fn spectra() {
    let cases: [Case; 14] = [
        (
            "WorldBegin Material \"diffuse\" \"rgb reflectance\" [.5 @1.5 .5]",
            "has the value 1.5, it must be between 0 and 1",
            "",
        ),
        (
            "WorldBegin Material \"diffuse\" \"rgb reflectance\" @[.5 .5]",
            "takes 3 values, found 2",
            "",
        ),
        (
            "WorldBegin Material \"diffuse\" @\"float reflectance\" .5",
            "has the type `float`, expected `rgb` or",
            "",
        ),
        (
            "WorldBegin Material \"diffuse\" \"texture reflectance\" @\"wood\"",
            "no spectrum texture `wood`",
            "",
        ),
        (
            "WorldBegin Material \"diffuse\" \"spectrum reflectance\" @[400 .5 500]",
            "pairs",
            "",
        ),
        (
            "WorldBegin Material \"diffuse\" \"spectrum reflectance\" [400 .5 @400 .5]",
            "must increase",
            "",
        ),
        (
            "WorldBegin Material \"diffuse\" \"spectrum reflectance\" [400 .5 500 @-1]",
            "between 0 and 1",
            "",
        ),
        (
            "WorldBegin Material \"conductor\" \"spectrum eta\" @\"metal-Cu-eat\"",
            "neither the name",
            "`metal-Cu-eta`",
        ),
        (
            "WorldBegin Material \"conductor\" @\"rgb reflectance\" [0 0 0] \"rgb k\" [1 1 1]",
            "either",
            "",
        ),
        (
            "WorldBegin Material \"dielectric\" \"float eta\" @0",
            "must be positive",
            "",
        ),
        (
            "WorldBegin Material \"dielectric\" \"rgb eta\" @[1 1.1 1.2]",
            "not a colour",
            "",
        ),
        (
            "WorldBegin LightSource \"infinite\" \"rgb L\" [1 1 @-1]",
            "0 or more",
            "",
        ),
        ("WorldBegin LightSource \"infinite\" \"blackbody L\" @0", "kelvin", ""),
        (
            "WorldBegin LightSource \"infinite\" \"spectrum L\" @[400 0 500 0]",
            "luminance",
            "",
        ),
    ];
    cases.iter().for_each(check);
}

#[test]
fn entities() {
    let cases: [Case; 26] = [
        ("WorldBegin Shape @\"spere\"", "unknown shape `spere`", "`sphere`"),
        (
            "WorldBegin Shape @\"disk\" \"float radius\" 3",
            "the shape `disk` is not supported yet",
            "",
        ),
        (
            "WorldBegin Material @\"hair\"",
            "the material `hair` is not supported yet",
            "",
        ),
        ("WorldBegin Material @\"difuse\"", "unknown material", "`diffuse`"),
        ("WorldBegin LightSource @\"sopt\"", "unknown light `sopt`", "`spot`"),
        (
            "WorldBegin AreaLightSource @\"difuse\"",
            "unknown area light",
            "`diffuse`",
        ),
        (
            "WorldBegin AreaLightSource \"diffuse\" \"string filename\" @\"x\"",
            "cannot read x",
            "",
        ),
        (
            "WorldBegin AreaLightSource \"diffuse\" @\"float L\" 3",
            "has the type `float`",
            "",
        ),
        (
            "WorldBegin LightSource \"distant\" @\"point3 to\" [0 0 0]",
            "must differ",
            "",
        ),
        ("Camera @\"spherical\" WorldBegin", "not supported yet", ""),
        ("Film @\"gbuffer\" WorldBegin", "not supported yet", ""),
        ("Integrator @\"bdpt\" WorldBegin", "not supported yet", ""),
        ("Sampler @\"sobl\" WorldBegin", "unknown sampler", "`sobol`"),
        ("PixelFilter @\"gausian\" WorldBegin", "unknown filter", "`gaussian`"),
        ("ColorSpace @\"rec2021\" WorldBegin", "unknown color space", "`rec2020`"),
        (
            "WorldBegin Texture \"a\" \"spectrum\" @\"ptex\" \"string filename\" \"x\"",
            "spectrum texture `ptex` is not supported yet",
            "",
        ),
        (
            "WorldBegin @MakeNamedMedium \"a\" \"string type\" \"homogeneous\"",
            "media",
            "",
        ),
        ("WorldBegin @MediumInterface \"a\" \"\"", "media", ""),
        (
            "WorldBegin Attribute @\"sape\" \"float radius\" 1",
            "unknown target `sape`",
            "`shape`",
        ),
        ("WorldBegin MakeNamedMaterial @\"a\"", "no type", ""),
        (
            "WorldBegin MakeNamedMaterial \"a\" \"string type\" @\"difuse\"",
            "unknown material `difuse`",
            "`diffuse`",
        ),
        (
            "WorldBegin MakeNamedMaterial \"Wall\" \"string type\" \"diffuse\"\nNamedMaterial @\"Wal\" Shape \"sphere\"",
            "there is no named material `Wal`",
            "`Wall`",
        ),
        (
            "WorldBegin MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\nMakeNamedMaterial @\"a\" \"string type\" \"diffuse\"",
            "there is a named material `a` already",
            "",
        ),
        (
            "Camera \"perspective\" \"string name\" \"a\"\nCamera \"perspective\" \"string name\" @\"a\" WorldBegin",
            "a view `a`",
            "",
        ),
        ("@Option \"forcediffuse\" true WorldBegin", "not supported", ""),
        (
            "Integrator \"path\" @\"bool regularize\" true WorldBegin",
            "regularization",
            "",
        ),
    ];
    cases.iter().for_each(check);
}

#[test]
fn meshes() {
    let cases: [Case; 12] = [
        ("WorldBegin Shape @\"trianglemesh\"", "no vertices", ""),
        (
            "WorldBegin Shape @\"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1]",
            "no `\"integer indices\"`",
            "",
        ),
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" @[0 0 0 1 0 0 0 1]",
            "3 numbers a vertex, found 8",
            "",
        ),
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 @nan 0]",
            "finite",
            "",
        ),
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0\n 0 @1e40 0]",
            "32-bit",
            "",
        ),
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 # three\n @3 2 1 0]",
            "there is no vertex 3: `P` has 3",
            "",
        ),
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 @-1]",
            "there is no vertex -1",
            "",
        ),
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" @[0 1]",
            "3 integers a triangle, found 2",
            "",
        ),
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"normal N\" @[0 0 1 0 0 1]",
            "`N` is given for 2 vertices, but there are 3",
            "",
        ),
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] @\"vector3 N\" [0 0 1]",
            "has the type `vector3`, expected `normal`",
            "",
        ),
        ("WorldBegin Shape @\"plymesh\"", "no `\"string filename\"`", ""),
        (
            "WorldBegin Shape \"plymesh\" \"string filename\" @\"no/such.ply\"",
            "cannot read the mesh",
            "",
        ),
    ];
    cases.iter().for_each(check);
}

#[test]
fn structure() {
    let cases: [Case; 20] = [
        ("@Shape \"sphere\" WorldBegin", "only after `WorldBegin`", ""),
        ("@AttributeBegin WorldBegin", "only after `WorldBegin`", ""),
        ("WorldBegin @Camera \"perspective\"", "only before `WorldBegin`", ""),
        ("WorldBegin @WorldBegin", "only before `WorldBegin`", ""),
        ("WorldBegin @AttributeEnd", "nothing has been begun", ""),
        ("WorldBegin @AttributeBegin", "`AttributeEnd` for this is missing", ""),
        ("WorldBegin @ObjectBegin \"a\"", "`ObjectEnd` for this is missing", ""),
        (
            "WorldBegin ObjectBegin \"a\" @AttributeEnd ObjectEnd",
            "begun last is `ObjectBegin`",
            "",
        ),
        (
            "WorldBegin ObjectBegin \"a\" AttributeBegin @ObjectEnd AttributeEnd ObjectEnd",
            "last is `AttributeBegin`",
            "",
        ),
        (
            "WorldBegin ObjectBegin \"a\" ObjectBegin @\"b\" ObjectEnd ObjectEnd",
            "not allowed between",
            "",
        ),
        (
            "WorldBegin ObjectBegin \"a\" ObjectEnd ObjectBegin @\"a\" ObjectEnd",
            "an object `a` already",
            "",
        ),
        (
            "WorldBegin ObjectBegin \"tree\" ObjectEnd ObjectInstance @\"trea\"",
            "no object `trea`",
            "`tree`",
        ),
        (
            "WorldBegin ObjectBegin \"a\" ObjectInstance @\"a\" ObjectEnd",
            "not allowed between",
            "",
        ),
        (
            "WorldBegin AreaLightSource \"diffuse\" ObjectBegin \"a\" Shape @\"sphere\" ObjectEnd",
            "lights in an object",
            "",
        ),
        ("WorldBegin @Scale 1 0 1", "singular", ""),
        ("WorldBegin @Rotate 30 0 0 0", "axis", ""),
        ("WorldBegin @LookAt 0 0 0 0 0 1 0 0 2", "parallel", ""),
        (
            "WorldBegin @Transform [1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1]",
            "not affine",
            "",
        ),
        ("WorldBegin Scale 1e200 1 1 @Scale 1e200 1 1", "not finite", ""),
        (
            "WorldBegin CoordSysTransform @\"cmera\"",
            "no coordinate system `cmera`",
            "",
        ),
    ];
    cases.iter().for_each(check);
    check(&(
        "Camera \"perspective\" WorldBegin CoordSysTransform @\"cmera\"",
        "no coordinate system `cmera`",
        "`camera`",
    ));
}

#[test]
fn many_errors_are_found_in_one_run() {
    let text = "Film \"rgb\" \"integer xresolution\" -1 \"float iso\" -1 \"float iso2\" 3\n\
                Camera \"perspective\" \"float fov\" \"wide\"\n\
                WorldBegin\n\
                Shape \"sphere\" \"float radius\" -1\n\
                Shap \"sphere\"\n\
                Translate 1 2\n\
                Shape \"sphere\"\n\
                NamedMaterial \"none\"";
    let lines: Vec<usize> = errors(text).iter().map(|e| e.line).collect();
    // `Translate` meets the `Shape` of the next line.
    assert_eq!(lines, [1, 1, 1, 2, 4, 5, 7, 8]);
    let endless = format!("WorldBegin {}", "Shape \"spere\"\n".repeat(1000));
    assert_eq!(errors(&endless).len(), 50);
}

#[test]
fn an_error_is_shown_with_its_line() {
    let shown = errors("WorldBegin\n  Shape \"sphere\" \"float raduis\" 2")[0].to_string();
    let expected = "scene.pbrt:2:18: error: shape `sphere` has no parameter `raduis`\n  \
                    |\n\
                    2 |   Shape \"sphere\" \"float raduis\" 2\n  \
                    |                  ^^^^^^^^^^^^^^\n  \
                    = help: did you mean `radius`?";
    assert_eq!(shown, expected);
}

#[test]
fn lenient_reading_turns_the_unknown_into_warnings() {
    let text = r#"
        Film "gbuffer"
        Sampler "new" Integrator "bdpt" PixelFilter "new" Camera "spherical"
        ColorSpace "rec2021"
        WorldBegin
        Texture "a" "spectrum" "ptex" "string filename" "x"
        MakeNamedMedium "m" "string type" "homogeneous" MediumInterface "m"
        Material "diffuse" "texture reflectance" "b"
        Material "subsurface" "float thickness" 3
        Shape "sphere" "float what" 3 "float zmin" 0
        Shape "disk"
        LightSource "laser"
        Wibble 1 2 3 "float x" [ 1 ]
        NamedMaterial "nobody"
        AttributeBegin AreaLightSource "diffuse" ObjectBegin "o" Shape "sphere" ObjectEnd AttributeEnd"#;
    let scene = read(text, &LENIENT).unwrap_or_else(|e| panic!("{e:?}"));
    assert_eq!((scene.shapes.len(), scene.lights.len()), (1, 0));
    assert!(scene.objects[0].shapes[0].area_light.is_none());
    assert!(
        scene
            .warnings
            .iter()
            .all(|w| w.severity == Severity::Warning && w.message.contains(": "))
    );
    let mut lines: Vec<usize> = scene.warnings.iter().map(|w| w.line).collect();
    lines.dedup();
    assert_eq!(lines, [2, 3, 4, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15]);
    // What is wrong beyond doubt stays an error.
    assert!(read("WorldBegin Shape \"sphere\" \"float radius\" -1", &LENIENT).is_err());
    assert!(read("WorldBegin Shape \"sphere\" \"integer radius\" 1", &LENIENT).is_err());
}

#[test]
fn warnings_are_capped_too() {
    let text = format!(
        "WorldBegin {}",
        "Shape \"trianglemesh\" \"integer faceIndices\" 0 \"point3 P\" [0 0 0 1 0 0 0 1 0]\n".repeat(80)
    );
    let warnings = scene(&text).warnings;
    assert_eq!(warnings.len(), 50);
    assert_eq!(warnings[49].help.as_deref(), Some("30 more warnings are not shown"));
}

#[test]
fn long_lists_end_with_a_count_and_what_would_be_forgiven() {
    let text = format!(
        "WorldBegin {}Shape \"sphere\" \"float radius\" -1",
        "Material \"hair\"\n".repeat(4)
    );
    let errors = errors(&text);
    assert_eq!(errors.len(), 5);
    let help = errors[4].help.as_deref().unwrap_or_default();
    assert!(
        help.ends_with("4 of these 5 errors are warnings with --lenient"),
        "{help}"
    );
    let printed = lucerna::Error::Scene(errors).to_string();
    assert!(printed.ends_with("\n5 errors"), "{printed}");
}

#[test]
fn textures() {
    let cases: [Case; 14] = [
        (
            "WorldBegin Texture \"a\" @\"color\" \"constant\"",
            "`float` or `spectrum`, not `color`",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" @\"mixx\"",
            "unknown float texture `mixx`",
            "`mix`",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"constant\" Texture @\"a\" \"float\" \"constant\"",
            "already",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"constant\" @\"rgb value\" [1 1 1]",
            "has the type `rgb`, expected `float`",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"spectrum\" \"constant\" @\"float value\" 1",
            "has the type `float`, expected `rgb`",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"scale\" @\"float amount\" 1",
            "float texture `scale` has no parameter `amount`",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"scale\" \"texture tex\" @\"b\" Texture \"b\" \"float\" \"constant\"",
            "defined before it",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"scale\" \"texture tex\" @\"a\"",
            "defined before it",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"directionmix\" @\"vector3 dir\" [0 0 0]",
            "must not be zero",
            "",
        ),
        (
            "WorldBegin Texture \"wood\" \"spectrum\" \"constant\" Material \"diffuse\" \"texture reflectance\" @\"wod\"",
            "no spectrum texture `wod`",
            "`wood`",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"constant\" Material \"diffuse\" \"texture reflectance\" @\"a\"",
            "no spectrum texture `a`",
            "there is a float texture of that name",
        ),
        (
            "WorldBegin Material \"diffuse\" \"texture reflectance\" @[\"a\" \"b\"]",
            "takes 1 value, found 2",
            "",
        ),
        (
            "@Texture \"a\" \"float\" \"constant\" WorldBegin",
            "only after `WorldBegin`",
            "",
        ),
        (
            "WorldBegin Material \"conductor\" \"float roughness\" @-1",
            "must be 0 or more",
            "",
        ),
    ];
    cases.iter().for_each(check);
}

#[test]
fn textures_may_not_be_stacked_without_end() {
    let chain = |n: usize| {
        let mut text = "WorldBegin Texture \"t0\" \"float\" \"constant\"\n".to_owned();
        for i in 1..n {
            text += &format!("Texture \"t{i}\" \"float\" \"scale\" \"texture tex\" \"t{}\"\n", i - 1);
        }
        text
    };
    assert_eq!(scene(&chain(64)).textures.len(), 64);
    let errors = errors(&chain(65));
    assert_eq!((errors.len(), errors[0].line), (1, 65), "{errors:?}");
    assert!(errors[0].message.contains("more than 64"));
}

#[test]
fn a_material_may_name_a_texture_that_is_defined_later() {
    let later = "WorldBegin Material \"diffuse\" \"texture reflectance\" \"a\" Texture \"a\" \"spectrum\" \"constant\"";
    assert_eq!(scene(later).textures[0].name, "a");
}

#[test]
fn image_textures() {
    let cases: [Case; 9] = [
        (
            "WorldBegin Texture \"a\" \"float\" @\"imagemap\"",
            "has no `\"string filename\"`",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"imagemap\" \"string filename\" @\"no-such.png\"",
            "cannot read the image",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"x.png\" \"string filter\" @\"ewa\"",
            "`filter` is one of point, bilinear, trilinear, EWA, not `ewa`",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"x.png\" \"string wrap\" @\"repeet\"",
            "`wrap` is one of",
            "`repeat`",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"imagemap\" \"string encoding\" @\"gamma 0\" \"string filename\" \"x.png\"",
            "`gamma` with a positive exponent",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"imagemap\" \"float maxanisotropy\" @0.5 \"string filename\" \"x.png\"",
            "must be 1 or more",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"checkerboard\" \"integer dimension\" @4",
            "must be 2 to 3",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"spectrum\" @\"fbm\"",
            "unknown spectrum texture `fbm`",
            "",
        ),
        (
            "WorldBegin Shape \"sphere\" \"float alpha\" @1.5",
            "`alpha` is 1.5, it must be between 0 and 1",
            "",
        ),
    ];
    for case @ (marked, message, _) in &cases {
        if message.contains("one of") || message.contains("gamma") || message.contains("1 or more") {
            // The file is not there either.
            let (text, _) = (marked.replace('@', ""), ());
            assert!(errors(&text).iter().any(|e| e.message.contains(message)), "{marked}");
        } else {
            check(case);
        }
    }
}

/// Every parameter of the tables is one that the reader asks for: with a type that none has, it says so.
#[test]
fn the_tables_of_textures_are_what_is_read() {
    for entry in &lucerna::desc::TEXTURES {
        for class in entry.classes {
            for parameter in entry.parameters {
                let text = format!(
                    "WorldBegin Texture \"a\" \"{}\" \"{}\" \"normal {}\" [0 0 1]",
                    class.name(),
                    entry.name,
                    parameter.name
                );
                let found = errors(&text);
                let expected = format!("`{}` has the type `normal`", parameter.name);
                assert!(found.iter().any(|e| e.message.contains(&expected)), "{text}: {found:?}");
                assert!(!parameter.doc.is_empty() && !parameter.kind.range_text().is_empty());
            }
        }
    }
}
