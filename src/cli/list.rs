//! `lucerna list`.

use std::fmt::{Display, Formatter};
use std::io::Write;
use std::path::Path;

use serde::Serialize;

use super::args::{ListArgs, ListKind};
use super::report::print_json;
use crate::desc::{INTEGRATORS, LIGHTS, MATERIALS, Parameter, SAMPLERS, TEXTURES, TextureClass};
use crate::error::{Error, Result};

/// Something that a scene file may use.
#[derive(Debug, Serialize)]
struct Entry {
    name: &'static str,
    directive: &'static str,
    /// Of a texture: `float`, `spectrum` or both.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    classes: Vec<&'static str>,
    description: &'static str,
    parameters: Vec<Row>,
}

/// One of its parameters.
#[derive(Debug, Serialize)]
struct Row {
    name: &'static str,
    r#type: &'static str,
    range: String,
    /// Empty if there is none.
    default: String,
    description: &'static str,
}

/// Prints the tables that the scene reader goes by.
pub fn run(args: &ListArgs) -> Result<()> {
    let mut entries = entries(args.what);
    if let Some(name) = &args.name {
        let names: Vec<_> = entries.iter().map(|entry| entry.name).collect();
        if !names.contains(&name.as_str()) {
            let message = format!("nothing is called `{name}` there: expected one of {}", names.join(", "));
            return Err(Error::Usage(message));
        }
        entries.retain(|entry| entry.name == name);
    }
    if args.json {
        return print_json(&entries);
    }
    let mut out = std::io::stdout().lock();
    entries
        .iter()
        .try_for_each(|entry| write!(out, "{entry}"))
        .map_err(|e| Error::io("write", Path::new("stdout"), e))
}

fn entries(what: ListKind) -> Vec<Entry> {
    match what {
        ListKind::Materials => MATERIALS
            .iter()
            .map(|e| Entry::new(e.name, "Material", e.doc, e.parameters))
            .collect(),
        ListKind::Lights => LIGHTS
            .iter()
            .map(|e| Entry::new(e.name, e.directive, e.doc, e.parameters))
            .collect(),
        ListKind::Textures => TEXTURES
            .iter()
            .map(|e| Entry {
                classes: e.classes.iter().map(|&class| class_name(class)).collect(),
                ..Entry::new(e.name, "Texture", e.doc, e.parameters)
            })
            .collect(),
        ListKind::Samplers => SAMPLERS
            .iter()
            .map(|e| Entry::new(e.name, "Sampler", e.doc, e.parameters))
            .collect(),
        ListKind::Integrators => INTEGRATORS
            .iter()
            .map(|e| Entry::new(e.name, "Integrator", e.doc, e.parameters))
            .collect(),
    }
}

fn class_name(class: TextureClass) -> &'static str {
    match class {
        TextureClass::Float => "float",
        TextureClass::Spectrum => "spectrum",
    }
}

impl Entry {
    fn new(
        name: &'static str,
        directive: &'static str,
        description: &'static str,
        parameters: &[&'static Parameter],
    ) -> Self {
        let row = |parameter: &&'static Parameter| Row {
            name: parameter.name,
            r#type: parameter.kind.type_text(),
            range: parameter.kind.range_text(),
            default: parameter.kind.default_text(),
            description: parameter.doc,
        };
        Self {
            name,
            directive,
            classes: Vec::new(),
            description,
            parameters: parameters.iter().map(row).collect(),
        }
    }
}

impl Display for Entry {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let classes = match self.classes.as_slice() {
            [] => String::new(),
            classes => format!(" ({})", classes.join(", ")),
        };
        writeln!(f, "{} \"{}\"{classes}: {}", self.directive, self.name, self.description)?;
        for row in &self.parameters {
            let default = match row.default.as_str() {
                "" => "no default".to_owned(),
                default => format!("default {default}"),
            };
            writeln!(f, "  \"{} {}\": {}; {default}", row.r#type, row.name, row.range)?;
            writeln!(f, "      {}", row.description)?;
        }
        writeln!(f)
    }
}
