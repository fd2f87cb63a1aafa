//! Materials: every parameter of the table is read, has the range that the table says, and each bad value its own error.

use lucerna::desc::{DistributionDesc, MATERIALS, MaterialId, MaterialKind, Parameter, ParameterKind, Textured};

use crate::{errors, scene, world};

/// A material that has what it needs and besides `parameters`.
fn text(material: &str, parameters: &str) -> String {
    let needed = match material {
        "mix" if !parameters.contains("materials") => "\"string materials\" [\"a\" \"a\"]",
        "tinted" if !parameters.contains(" material\"") => "\"string material\" \"gold\"",
        "measured" if !parameters.contains("filename") => concat!(
            "\"string filename\" \"",
            env!("CARGO_MANIFEST_DIR"),
            "/scenes/parts/measured-ggx.bsdf\""
        ),
        _ => "",
    };
    format!(
        "WorldBegin MakeNamedMaterial \"a\" \"string type\" \"diffuse\" MakeNamedMaterial \"gold\" \"string type\" \"conductor\"\nMaterial \"{material}\" {needed} {parameters} Shape \"sphere\""
    )
}

/// Declarations of a parameter that are wrong, and a part of what is to be said.
fn wrong(parameter: &Parameter) -> Vec<(String, String)> {
    let name = parameter.name;
    let declare = |kind: &str, value: &str| format!("\"{kind} {name}\" {value}");
    let range = parameter.kind.range_text();
    let case = |kind: &str, value: &str, part: &str| (declare(kind, value), part.to_owned());
    let mut cases = vec![case("point3", "[1 2 3]", "has the type `point3`")];
    match parameter.kind {
        ParameterKind::Bool(_) => cases.push(case("bool", "[true false]", "takes 1 value")),
        ParameterKind::Integer { range: (low, high), .. } => {
            cases.push(case("integer", &(low - 1).to_string(), &range));
            cases.push(case("integer", &(high + 1).to_string(), &range));
        }
        ParameterKind::Float { .. } | ParameterKind::FloatTexturedIn { .. } => {
            cases.push(case("float", "[1 2]", "takes 1 value"));
            cases.push(case("float", "-1", &format!("must be {range}")));
        }
        ParameterKind::Choice { choices, .. } => {
            let part = format!("is one of {}, not `gxg`", choices.join(", "));
            cases.push(case("string", "\"gxg\"", &part));
        }
        ParameterKind::Reflectance { .. } => {
            cases.push(case("rgb", "[.5 1.5 .5]", "must be between 0 and 1"));
            cases.push(case("rgb", "[.5 .5]", "takes 3 values"));
            cases.push(case(
                "spectrum",
                "\"none\"",
                "neither the name of a spectrum nor a file",
            ));
        }
        ParameterKind::MetalIndex { .. } | ParameterKind::MetalAbsorption { .. } => {
            cases.push(case("rgb", "[1 -1 1]", "must be 0 or more"));
        }
        ParameterKind::GlassIndex { .. } => {
            cases.push(case("float", "0", "must be positive"));
            cases.push(case("rgb", "[1 1 1]", "not a colour"));
        }
        ParameterKind::Material => {
            cases.push(case("string", "[\"a\" \"b\"]", "takes 1 value, found 2"));
            cases.push(case("string", "\"b\"", "there is no named material `b`"));
        }
        ParameterKind::TwoMaterials => {
            cases.push(case("string", "\"a\"", "takes 2 values, found 1"));
            cases.push(case("string", "[\"a\" \"b\"]", "there is no named material `b`"));
        }
        ParameterKind::File => {
            let what = if parameter.name == "normalmap" {
                "image"
            } else {
                "measured material"
            };
            cases.push(case("string", "\"missing.bsdf\"", &format!("cannot read the {what}")));
        }
        _ => {}
    }
    if matches!(parameter.kind, ParameterKind::FloatTexturedIn { .. }) {
        cases.push(case("texture", "\"t\"", "there is no float texture `t`"));
    }
    cases
}

#[test]
fn hair_is_colored_by_the_first_that_is_given() {
    use lucerna::desc::HairColorDesc;
    let of = |text: &str| {
        let scene = world(&format!("Material \"hair\" {text} Shape \"sphere\""));
        let MaterialKind::Hair(hair) = scene.materials[scene.shapes[0].material.0 as usize].kind.clone() else {
            panic!("hair")
        };
        (hair, scene.warnings.len())
    };
    let pigments = |color: &HairColorDesc| match color {
        HairColorDesc::Pigments {
            eumelanin: Textured::Value(brown),
            pheomelanin: Textured::Value(red),
        } => Some([*brown, *red]),
        _ => None,
    };
    let (hair, warnings) = of("");
    assert_eq!((pigments(&hair.color), hair.eta, warnings), (Some([1.3, 0.0]), 1.55, 0));
    let (hair, warnings) = of("\"float pheomelanin\" .5 \"float beta_m\" .2 \"float alpha\" 3");
    assert_eq!((pigments(&hair.color), warnings), (Some([0.0, 0.5]), 0));
    assert_eq!((hair.beta_m, hair.beta_n), (Textured::Value(0.2), Textured::Value(0.3)));
    let (hair, warnings) = of("\"float eumelanin\" 1 \"rgb color\" [.3 .2 .1]");
    assert!(matches!(hair.color, HairColorDesc::Reflectance(_)) && warnings == 1);
    let (hair, warnings) = of("\"rgb sigma_a\" [3 2 1] \"rgb color\" [.3 .2 .1] \"float eumelanin\" 1");
    assert!(matches!(hair.color, HairColorDesc::Absorption(_)) && warnings == 2);
}

#[test]
fn each_bad_value_has_its_own_error() {
    let mut tried = 0;
    for material in &MATERIALS {
        for parameter in material.parameters {
            for (declaration, part) in wrong(parameter) {
                let text = text(material.name, &declaration);
                let errors = errors(&text);
                let all: Vec<String> = errors.iter().map(ToString::to_string).collect();
                assert_eq!(errors.len(), 1, "{text}\n{}", all.join("\n"));
                assert!(
                    errors[0].message.contains(&part),
                    "{text}\n{}\nwithout `{part}`",
                    all[0]
                );
                assert_eq!(errors[0].line, 2, "{}", all[0]);
                tried += 1;
            }
        }
    }
    assert!(tried > 150, "{tried}");
}

#[test]
fn what_excludes_each_other_is_an_error() {
    for (text, part) in [
        (
            text("coatedconductor", "\"rgb reflectance\" [1 1 1] \"rgb conductor.eta\" [1 1 1]"),
            "either `reflectance` or `conductor.eta`",
        ),
        (text("principled", "\"float eta\" 1.4 \"float specular\" .5"), "either `eta` or `specular`"),
        (text("mix", "").replace("\"string materials\" [\"a\" \"a\"]", ""), "names its two `materials`"),
        ("WorldBegin Material \"measured\"".to_owned(), "names its file"),
        (
            "WorldBegin MakeNamedMaterial \"m\" \"string type\" \"mix\" \"string materials\" [\"m\" \"m\"]".to_owned(),
            "contains itself",
        ),
        (
            "WorldBegin MakeNamedMaterial \"i\" \"string type\" \"interface\" Material \"mix\" \"string materials\" [\"i\" \"i\"]"
                .to_owned(),
            "cannot contain the material `interface`",
        ),
    ] {
        let errors = errors(&text);
        assert_eq!(errors.len(), 1, "{text}: {errors:?}");
        assert!(errors[0].message.contains(part), "{text}\n{}", errors[0]);
    }
}

#[test]
fn mixes_may_name_what_is_defined_later() {
    let scene = scene(
        r#"WorldBegin
        Material "mix" "string materials" ["later" "mixed"] "float amount" .25
        Shape "sphere"
        MakeNamedMaterial "mixed" "string type" "mix" "string materials" ["later" "later"]
        MakeNamedMaterial "later" "string type" "diffuse""#,
    );
    let kind = |id: MaterialId| &scene.materials[id.0 as usize].kind;
    let MaterialKind::Mix { materials, amount } = kind(scene.shapes[0].material) else {
        panic!("{:?}", scene.materials)
    };
    assert_eq!(*amount, Textured::Value(0.25));
    assert!(matches!(kind(materials[0]), MaterialKind::Diffuse { .. }));
    let MaterialKind::Mix { materials: inner, .. } = kind(materials[1]) else {
        panic!("{:?}", scene.materials)
    };
    assert_eq!(*inner, [materials[0]; 2]);
}

/// pbrt-v4's defaults, and what is given instead.
#[test]
fn coats_have_the_parameters_of_pbrt() {
    let scene = scene(
        r#"WorldBegin
        Material "coateddiffuse" Shape "sphere"
        Material "coatedconductor" "float interface.roughness" .1 "float conductor.uroughness" .2 "float thickness" 2
            "float g" -.5 "rgb albedo" [.1 .2 .3] "integer maxdepth" 50 "integer nsamples" 4 "string distribution" "beckmann"
        Shape "sphere""#,
    );
    let kind = |i: usize| &scene.materials[scene.shapes[i].material.0 as usize].kind;
    let MaterialKind::CoatedDiffuse { coat, .. } = kind(0) else {
        panic!("{:?}", kind(0))
    };
    let number = |value: &Textured<f32>| match value {
        Textured::Value(value) => *value,
        Textured::Texture(_) => f32::NAN,
    };
    assert_eq!((number(&coat.thickness), number(&coat.g)), (0.01, 0.0));
    assert_eq!((coat.max_depth, coat.samples), (10, 1));
    assert_eq!((number(&coat.roughness.u), coat.roughness.remap), (0.0, true));
    let MaterialKind::CoatedConductor { coat, roughness, .. } = kind(1) else {
        panic!("{:?}", kind(1))
    };
    assert_eq!((number(&coat.thickness), number(&coat.g)), (2.0, -0.5));
    assert_eq!((coat.max_depth, coat.samples), (50, 4));
    assert_eq!((number(&coat.roughness.u), number(&coat.roughness.v)), (0.1, 0.1));
    assert_eq!((number(&roughness.u), number(&roughness.v)), (0.2, 0.0));
    assert_eq!(roughness.distribution, DistributionDesc::Beckmann);
}
