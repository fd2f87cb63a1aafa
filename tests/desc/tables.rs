//! The tables that `lucerna list` prints are what scene files are read by: names, types and defaults, in both directions. (The reader
//! itself checks, in builds with debug assertions, that it asks for nothing that a table lacks: each kind is read here.)

use lucerna::desc::{
    Entry, INTEGRATORS, LIGHTS, MATERIALS, MEDIA, Parameter, ParameterDefault, ParameterKind, SAMPLERS, SceneDesc,
    TEXTURES, TextureClass,
};
use lucerna::error::Error;
use tempfile::TempDir;

use crate::lights::{images, load_text};

/// All types of pbrt-v4 with a value of each, where a parameter wants nothing particular.
const TYPES: [(&str, &str); 13] = [
    ("bool", "false"),
    ("float", "0.5"),
    ("integer", "2"),
    ("point2", "[1 2]"),
    ("vector2", "[1 2]"),
    ("point3", "[3 1 2]"),
    ("vector3", "[3 1 2]"),
    ("normal", "[0 0 1]"),
    ("string", "\"square.exr\""),
    ("texture", "\"t\""),
    ("rgb", "[.5 .5 .5]"),
    ("spectrum", "[400 .5 700 .6]"),
    ("blackbody", "4000"),
];

/// With an attribute.
const MESH: &str = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"float vertex_heat\" [1 2 3]";

/// An entry as it is used: a texture of a class, anything else of none.
#[derive(Clone, Copy)]
struct Case {
    entry: &'static Entry,
    class: Option<TextureClass>,
}

fn cases() -> Vec<Case> {
    let tables: [&'static [Entry]; 6] = [&MATERIALS, &MEDIA, &LIGHTS, &TEXTURES, &SAMPLERS, &INTEGRATORS];
    let entries = tables.into_iter().flatten();
    let of_entry = |entry: &'static Entry| match entry.classes {
        [] => vec![Case { entry, class: None }],
        classes => classes
            .iter()
            .map(|&class| Case {
                entry,
                class: Some(class),
            })
            .collect(),
    };
    entries.flat_map(of_entry).collect()
}

impl Case {
    /// A scene that uses the entry with `parameters` and those that it cannot do without.
    fn text(self, parameters: &str) -> String {
        let Entry { directive, name, .. } = *self.entry;
        let needed = match name {
            "mix" if directive == "Material" => "\"string materials\" [\"a\" \"a\"]".to_owned(),
            "meshattribute" => "\"string name\" \"vertex_heat\"".to_owned(),
            "tinted" => "\"string material\" \"gold\"".to_owned(),
            "measured" | "imagemap" | "goniometric" | "projection" => {
                format!("\"string filename\" {}", self.file("filename"))
            }
            _ => String::new(),
        };
        let is_given = |needed: &str| {
            needed
                .split('"')
                .nth(1)
                .is_some_and(|declared| parameters.contains(declared))
        };
        let needed = if is_given(&needed) { "" } else { &needed };
        let used = match self.class {
            Some(class) => format!("Texture \"used\" \"{}\" \"{name}\" {needed} {parameters}", class.name()),
            None if directive == "MakeNamedMedium" => {
                format!("{directive} \"m\" \"string type\" \"{name}\" {parameters}")
            }
            None => format!("{directive} \"{name}\" {needed} {parameters}"),
        };
        let world = "WorldBegin Texture \"t\" \"float\" \"constant\" Texture \"t\" \"spectrum\" \"constant\"
            MakeNamedMaterial \"a\" \"string type\" \"diffuse\" MakeNamedMaterial \"gold\" \"string type\" \"conductor\"";
        match directive {
            "Sampler" | "Integrator" => format!("{used} WorldBegin"),
            "Texture" => format!("{world}\n{used} {MESH}"),
            _ => format!("{world}\n{used} Shape \"sphere\""),
        }
    }

    fn file(self, parameter: &str) -> &'static str {
        match self.entry.name {
            "measured" if parameter == "filename" => {
                concat!("\"", env!("CARGO_MANIFEST_DIR"), "/scenes/parts/measured-ggx.bsdf\"")
            }
            _ => "\"square.exr\"",
        }
    }

    /// Whether the table says that a parameter may have a type.
    fn takes(self, parameter: &Parameter, kind: &str) -> bool {
        let is_number = kind == "float";
        let is_of_class = match (parameter.kind, self.class) {
            (ParameterKind::Value { .. } | ParameterKind::Textured { .. }, Some(class)) => {
                kind == "texture" || is_number == (class == TextureClass::Float)
            }
            _ => true,
        };
        is_of_class && parameter.kind.types().contains(&kind)
    }

    /// A value of a type that the parameter may have.
    fn value(self, parameter: &Parameter, kind: &str, value: &str) -> String {
        match (parameter.kind, kind) {
            (ParameterKind::Integer { default, .. }, _) => default.to_string(),
            (ParameterKind::Float { default, .. }, _) => default.to_string(),
            (ParameterKind::Choice { default, .. }, _) => format!("\"{default}\""),
            (ParameterKind::Encoding { default }, _) => format!("\"{default}\""),
            (ParameterKind::File, _) => self.file(parameter.name).to_owned(),
            (ParameterKind::Material, _) => "\"gold\"".to_owned(),
            (ParameterKind::Attribute, _) => "\"vertex_heat\"".to_owned(),
            (ParameterKind::TwoMaterials, _) => "[\"a\" \"a\"]".to_owned(),
            (ParameterKind::Points(4), _) => "[0 0 0  0 1 0  1 1 0  1 0 0]".to_owned(),
            _ => value.to_owned(),
        }
    }
}

fn problems(result: Result<SceneDesc, Error>) -> Vec<String> {
    match result {
        Ok(_) => Vec::new(),
        Err(Error::Scene(diagnostics)) => diagnostics.iter().map(ToString::to_string).collect(),
        Err(other) => panic!("{other}"),
    }
}

#[test]
fn a_parameter_has_the_types_of_its_table_and_no_others() {
    let directory = images();
    let mut accepted = 0;
    for case in cases() {
        for parameter in case.entry.parameters {
            for (kind, value) in TYPES {
                let takes = case.takes(parameter, kind);
                // Nobody looks at what has no effect.
                if matches!(parameter.kind, ParameterKind::Inert(_)) && !takes {
                    continue;
                }
                let value = if takes {
                    case.value(parameter, kind, value)
                } else {
                    value.to_owned()
                };
                let text = case.text(&format!("\"{kind} {}\" {value}", parameter.name));
                let found = problems(load_text(&directory, &text));
                assert_eq!(found.is_empty(), takes, "{text}\n{}", found.join("\n"));
                accepted += usize::from(takes);
            }
        }
    }
    assert!(accepted > 300, "{accepted}");
}

#[test]
fn a_kind_has_no_parameters_beside_those_of_its_table() {
    let directory = images();
    for case in cases() {
        let other = problems(load_text(&directory, &case.text("\"float sparkle\" 1")));
        assert!(
            matches!(&other[..], [one] if one.contains("has no parameter `sparkle`")),
            "{other:?}"
        );
    }
}

/// A parameter that is given its default changes nothing.
#[test]
fn defaults_are_those_of_the_tables() {
    let directory = images();
    let described = |text: &str| described(&directory, text);
    let mut checked = 0;
    for case in cases() {
        for parameter in case.entry.parameters {
            let name = parameter.name;
            if let ParameterKind::FloatTexturedIn {
                default: ParameterDefault::Of(other),
                ..
            } = parameter.kind
            {
                let given = case.text(&format!("\"float {other}\" .25 \"float {name}\" .25"));
                assert_eq!(
                    described(&given),
                    described(&case.text(&format!("\"float {other}\" .25"))),
                    "{given}"
                );
                continue;
            }
            let default = parameter.kind.default_text();
            let numbers = case.class != Some(TextureClass::Spectrum);
            let given = match parameter.kind {
                ParameterKind::Bool(_) => format!("\"bool {name}\" {default}"),
                ParameterKind::Integer { .. } => format!("\"integer {name}\" {default}"),
                ParameterKind::Float { .. }
                | ParameterKind::FloatTextured { .. }
                | ParameterKind::FloatTexturedIn { .. }
                | ParameterKind::GlassIndex { .. } => format!("\"float {name}\" {default}"),
                ParameterKind::Value { .. } | ParameterKind::Textured { .. } if numbers => {
                    format!("\"float {name}\" {default}")
                }
                ParameterKind::Value { .. } | ParameterKind::Textured { .. } | ParameterKind::Reflectance { .. }
                    if !default.is_empty() =>
                {
                    format!("\"spectrum {name}\" [400 {default}]")
                }
                ParameterKind::Vector(_) => format!("\"vector3 {name}\" {default}"),
                ParameterKind::Point(_) => format!("\"point3 {name}\" {default}"),
                ParameterKind::Choice { .. } | ParameterKind::Encoding { .. } => {
                    format!("\"string {name}\" \"{default}\"")
                }
                ParameterKind::MetalIndex { .. } | ParameterKind::MetalAbsorption { .. } => {
                    format!("\"spectrum {name}\" \"{default}\"")
                }
                _ => continue,
            };
            let given = case.text(&given);
            assert_eq!(described(&given), described(&case.text("")), "{given}");
            checked += 1;
        }
    }
    assert!(checked > 150, "{checked}");
}

/// All that a text says, without the places where it says so; one sample of a spectrum is the same as a constant.
fn described(directory: &TempDir, text: &str) -> String {
    let scene = load_text(directory, text).unwrap_or_else(|e| panic!("{text}\n{e}"));
    let SceneDesc {
        views,
        integrator,
        materials,
        textures,
        shapes,
        lights,
        ..
    } = scene;
    let all = format!("{views:?} {integrator:?} {materials:?} {textures:?} {shapes:?} {lights:?}");
    let mut parts = all.split("Span {");
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        text += part.split_once('}').map_or("", |(_, rest)| rest);
    }
    text.replace("Samples([(400.0, ", "Constant(").replace(")])", ")")
}

#[test]
fn tables_are_complete_sentences_without_repetition() {
    for case in cases() {
        let Entry {
            name, doc, parameters, ..
        } = *case.entry;
        assert!(!doc.is_empty() && !doc.ends_with('.'), "{name}: {doc}");
        for (i, parameter) in parameters.iter().enumerate() {
            assert!(
                parameters[..i].iter().all(|other| other.name != parameter.name),
                "{name}"
            );
            assert!(
                !parameter.doc.is_empty() && !parameter.doc.ends_with('.'),
                "{name}: {}",
                parameter.doc
            );
            assert!(!parameter.kind.range_text().is_empty());
        }
    }
}

/// What is measured in a unit says in which.
#[test]
fn quantities_have_units() {
    for case in cases()
        .iter()
        .filter(|case| case.entry.directive.ends_with("LightSource"))
    {
        for parameter in case.entry.parameters {
            let is_quantity = !matches!(
                parameter.kind,
                ParameterKind::Bool(_) | ParameterKind::File | ParameterKind::Choice { .. }
            );
            let is_factor = parameter.name == "scale";
            assert_eq!(
                !parameter.unit.is_empty(),
                is_quantity && !is_factor,
                "{}",
                parameter.name
            );
        }
    }
}
