//! Several problems at once: how many are shown, in what form, and which are forgiven.

use lucerna::error::Severity;

use crate::{LENIENT, errors, read, scene};

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
        Film "gbufer"
        Sampler "new" Integrator "mlt" PixelFilter "new" Camera "new"
        ColorSpace "rec2021"
        WorldBegin
        Texture "a" "spectrum" "ptex" "string filename" "x"
        MakeNamedMedium "m" "string type" "cloud" MediumInterface "m"
        Material "diffuse" "texture reflectance" "b"
        Material "subsurface" "float thickness" 3
        Shape "sphere" "float what" 3 "float zmin" 0
        Shape "cone"
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
        "Material \"subsurface\"\n".repeat(4)
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
