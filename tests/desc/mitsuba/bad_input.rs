//! What is said about bad files, and where.

use super::super::{LENIENT, STRICT};
use super::{file, read};

/// Content with `@` before the place of its one error (or the quote before it), a part of the message, and of the help.
type Case = (&'static str, &'static str, &'static str);

fn check(cases: &[Case]) {
    for &(text, message, help) in cases {
        let mark = text.find('@').expect("a place");
        // Attributes are without their quotes.
        let at = mark + usize::from(text[mark + 1..].starts_with('"'));
        let content = file(&text.replace('@', ""));
        let line_start = content.find('\n').expect("two lines") + 1;
        let errors = read(&content, &STRICT)
            .err()
            .unwrap_or_else(|| panic!("no error in {text}"));
        assert_eq!(errors.len(), 1, "{text}: {errors:#?}");
        let error = &errors[0];
        assert!(error.message.contains(message), "{text}: {}", error.message);
        assert!(
            error.help.as_deref().unwrap_or_default().contains(help),
            "{text}: {:?}",
            error.help
        );
        assert_eq!((error.line, error.column), (2, at + 1), "{text}: {error}");
        assert!(content[line_start..].starts_with(&error.source_line));
    }
}

#[test]
fn structure() {
    check(&[
        ("@<shap type=\"sphere\"/>", "no element <shap>", "<shape>"),
        ("<shape type=@\"spere\"/>", "no shape of the type `spere`", "`sphere`"),
        ("@<shape/>", "needs the attribute `type`", ""),
        ("<shape type=\"sphere\" @nam=\"x\"/>", "no attribute `nam`", "`name`"),
        ("@<float name=\"x\" value=\"1\"/>", "no property `x`", ""),
        (
            "<shape type=\"sphere\">@<float name=\"raduis\" value=\"1\"/></shape>",
            "no property `raduis`",
            "`radius`",
        ),
        (
            "<shape type=\"sphere\"><bsdf type=\"diffuse\" name=\"x\"/><bsdf type=@\"diffuse\" id=\"b\"/></shape>",
            "only one bsdf",
            "",
        ),
        (
            "<shape type=\"sphere\"><ref id=@\"gld\"/></shape><bsdf type=\"diffuse\" id=\"gold\"/>",
            "no object with the id `gld`",
            "`gold`",
        ),
        (
            "<bsdf type=\"diffuse\" id=\"a\"/><bsdf type=\"diffuse\" id=@\"a\"/>",
            "already an object",
            "",
        ),
        (
            "<bsdf type=@\"twosided\" id=\"a\"><ref id=\"a\"/></bsdf>",
            "contains itself",
            "",
        ),
        ("@text", "text inside <scene>", ""),
        ("@<translate x=\"1\"/>", "only be inside <transform>", ""),
        (
            "<shape type=\"sphere\"><float name=\"radius\" value=\"1\"/><float name=@\"radius\" value=\"1\"/></shape>",
            "given twice",
            "",
        ),
        (
            "<shape type=\"sphere\"><float name=\"radius\" value=@\"$r\"/></shape>",
            "no parameter `r`",
            "-D r=VALUE",
        ),
        (
            "<default name=\"radius\" value=\"1\"/><shape type=\"sphere\"><float name=\"radius\" value=@\"$raduis\"/></shape>",
            "no parameter",
            "`$radius`",
        ),
        ("<include filename=@\"no/such.xml\"/>", "cannot read", ""),
    ]);
}

#[test]
fn values() {
    check(&[
        (
            "<shape type=\"sphere\"><float name=\"radius\" value=@\"1x\"/></shape>",
            "`1x` is no number",
            "",
        ),
        (
            "<shape type=\"sphere\"><float name=\"radius\" value=@\"nan\"/></shape>",
            "`nan` is no number",
            "",
        ),
        (
            "<shape type=\"sphere\">@<float name=\"radius\" value=\"-1\"/></shape>",
            "expected a positive number",
            "",
        ),
        (
            "<shape type=\"sphere\">@<string name=\"radius\" value=\"1\"/></shape>",
            "`radius` is a string; expected a float",
            "",
        ),
        (
            "<shape type=\"sphere\"><point name=\"center\" value=@\"1, 2\"/></shape>",
            "expected 1 or 3 numbers, found 2",
            "",
        ),
        (
            "<shape type=\"sphere\"><medium type=\"homogeneous\" name=\"interior\">@<float name=\"albedo\" value=\"2\"/></medium></shape>",
            "in [0, 1]",
            "",
        ),
        (
            "<shape type=\"sphere\"><medium type=\"homogeneous\" name=\"exterior\"><phase type=\"hg\">@<float name=\"g\" value=\"1\"/></phase></medium></shape>",
            "between -1 and 1",
            "",
        ),
        (
            "<shape type=\"sphere\"><boolean name=\"flip_normals\" value=@\"yes\"/></shape>",
            "neither `true` nor `false`",
            "",
        ),
        (
            "<integrator type=\"path\"><integer name=\"max_depth\" value=@\"5.5\"/></integrator>",
            "is no integer",
            "",
        ),
        (
            "<integrator type=\"path\">@<integer name=\"max_depth\" value=\"-2\"/></integrator>",
            "expected -1",
            "",
        ),
        (
            "<bsdf type=\"diffuse\" id=\"x\"/><shape type=\"sphere\"><bsdf type=\"diffuse\">@<rgb name=\"reflectance\" value=\"1.5\"/></bsdf></shape>",
            "in [0, 1]",
            "",
        ),
        (
            "<emitter type=\"constant\"><spectrum name=\"radiance\" value=@\"500:1, 400:2\"/></emitter>",
            "increase",
            "",
        ),
        (
            "<emitter type=\"constant\"><spectrum name=\"radiance\" value=@\"500:1, x\"/></emitter>",
            "`nm: value`",
            "",
        ),
        (
            "<emitter type=\"constant\">@<rgb name=\"radiance\" value=\"-1\"/></emitter>",
            "not negative",
            "",
        ),
        (
            "<shape type=\"sphere\">@<transform name=\"to_world\"><scale x=\"0\"/></transform></shape>",
            "invertible",
            "",
        ),
        (
            "<shape type=\"sphere\"><transform name=\"to_world\">@<rotate angle=\"5\"/></transform></shape>",
            "axis",
            "",
        ),
        (
            "<shape type=\"sphere\"><transform name=\"to_world\">@<rotat x=\"1\" angle=\"5\"/></transform></shape>",
            "no step",
            "<rotate>",
        ),
        (
            "<shape type=\"sphere\"><transform name=\"to_world\"><matrix value=@\"1 2 3\"/></transform></shape>",
            "9 or 16",
            "",
        ),
        (
            "<shape type=\"sphere\"><transform name=\"to_world\">@<lookat origin=\"0,0,0\" target=\"0,0,0\"/></transform></shape>",
            "must differ",
            "",
        ),
        (
            "<shape type=\"ply\">@<string name=\"filename\" value=\"no.ply\"/></shape>",
            "cannot read the mesh no.ply",
            "",
        ),
        ("<shape type=@\"obj\"/>", "has no `<string name=\"filename\"", ""),
        (
            "<shape type=\"sphere\"><bsdf type=\"dielectric\">@<string name=\"int_ior\" value=\"bk8\"/></bsdf></shape>",
            "`bk7`",
            "",
        ),
        (
            "<shape type=\"sphere\"><bsdf type=\"twosided\"><bsdf type=@\"dielectric\"/></bsdf></shape>",
            "cannot be inside `twosided`",
            "",
        ),
    ]);
}

/// What Mitsuba has and this program has not: named, and a warning with `--lenient`.
#[test]
fn unsupported() {
    let cases: [Case; 9] = [
        (
            "<shape type=@\"sdfgrid\"/>",
            "the shape `sdfgrid` is not supported",
            "rectangle",
        ),
        (
            "<emitter type=@\"sunsky\"/>",
            "the emitter `sunsky` is not supported",
            "envmap",
        ),
        (
            "<shape type=\"sphere\"><bsdf type=@\"hair\"/></shape>",
            "the bsdf `hair` is not supported",
            "diffuse",
        ),
        (
            "<shape type=\"sphere\"><medium type=@\"heterogeneous\" name=\"interior\"/></shape>",
            "the medium `heterogeneous` is not supported",
            "homogeneous",
        ),
        (
            "<shape type=\"sphere\"><medium type=\"homogeneous\" name=\"interior\"><phase type=@\"rayleigh\"/></medium></shape>",
            "the phase `rayleigh` is not supported",
            "isotropic",
        ),
        (
            "<shape type=\"sphere\"><medium type=\"homogeneous\" name=\"interior\"><volume type=@\"gridvolume\" name=\"albedo\"/></medium></shape>",
            "the volume `gridvolume` is not supported",
            "constvolume",
        ),
        (
            "<integrator type=@\"aov\"/>",
            "the integrator `aov` is not supported",
            "path",
        ),
        (
            "<integrator type=\"path\">@<boolean name=\"hide_emitters\" value=\"true\"/></integrator>",
            "hide_emitters",
            "",
        ),
        (
            "<shape type=\"sphere\"><bsdf type=\"conductor\">@<string name=\"material\" value=\"HgTe\"/></bsdf></shape>",
            "no data for the metal `HgTe`",
            "",
        ),
    ];
    check(&cases);
    for (text, message, _) in cases {
        let scene = read(&file(&text.replace('@', "")), &LENIENT).unwrap_or_else(|e| panic!("{text}: {e:?}"));
        assert!(
            scene.warnings.iter().any(|w| w.message.contains(message)),
            "{text}: {:?}",
            scene.warnings
        );
    }
}

#[test]
fn files_that_are_no_scenes() {
    for (text, message) in [
        ("", "not well-formed"),
        ("<scene version=\"3.0.0\">", "not well-formed"),
        ("<scene version=\"3.0.0\"></scen>", "not well-formed"),
        ("<bsdf type=\"diffuse\" version=\"3.0.0\"/>", "not a <scene>"),
        ("<scene version=\"three\"/>", "no version"),
        ("<scene version=\"3.0.0\"/>", "no <sensor>"),
        (
            "<!DOCTYPE s [<!ENTITY a \"b\">]><scene version=\"3.0.0\">&a;</scene>",
            "not well-formed",
        ),
    ] {
        let errors = read(text, &STRICT)
            .err()
            .unwrap_or_else(|| panic!("no error in {text}"));
        assert!(errors[0].message.contains(message), "{text}: {}", errors[0].message);
    }
    let deep = format!("{}{}", "<a>".repeat(200_000), "</a>".repeat(200_000));
    assert!(
        read(&deep, &STRICT).expect_err("too deep")[0]
            .message
            .contains("nested deeper")
    );
    let utf16 = super::mitsuba::parse_str(b"\xff\xfe<\0", std::path::Path::new("x.xml"), &STRICT);
    assert!(utf16.expect_err("not UTF-8").to_string().contains("UTF-8"));
}
