//! `lucerna list`.

use std::fmt::{Display, Formatter};
use std::io::Write;
use std::path::Path;

use serde::Serialize;

use super::args::{ListArgs, ListKind};
use super::report::print_json;
use crate::desc::{Entry, INTEGRATORS, LIGHTS, MATERIALS, MEDIA, Parameter, SAMPLERS, TEXTURES};
use crate::error::{Error, Result};

/// An [`Entry`], ready to print.
#[derive(Debug, Serialize)]
struct Listed {
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
    r#type: String,
    range: String,
    /// Empty if there is none.
    default: String,
    /// Empty if there is none.
    unit: &'static str,
    description: &'static str,
}

/// Prints the tables that the scene reader goes by.
pub fn run(args: &ListArgs) -> Result<()> {
    let table = table(args.what);
    let of_name = |entry: &&Entry| args.name.as_ref().is_none_or(|name| name == entry.name);
    let listed: Vec<_> = table.iter().filter(of_name).map(Listed::new).collect();
    if let (Some(name), []) = (&args.name, &listed[..]) {
        let names: Vec<_> = table.iter().map(|entry| entry.name).collect();
        let message = format!("nothing is called `{name}` there: expected one of {}", names.join(", "));
        return Err(Error::Usage(message));
    }
    if args.json {
        return print_json(&listed);
    }
    let mut out = std::io::stdout().lock();
    listed
        .iter()
        .try_for_each(|entry| write!(out, "{entry}"))
        .map_err(|e| Error::io("write", Path::new("stdout"), e))
}

fn table(what: ListKind) -> &'static [Entry] {
    match what {
        ListKind::Materials => &MATERIALS,
        ListKind::Media => &MEDIA,
        ListKind::Lights => &LIGHTS,
        ListKind::Textures => &TEXTURES,
        ListKind::Samplers => &SAMPLERS,
        ListKind::Integrators => &INTEGRATORS,
    }
}

impl Listed {
    fn new(entry: &Entry) -> Self {
        let row = |parameter: &&'static Parameter| Row {
            name: parameter.name,
            r#type: parameter.kind.types().join(" | "),
            range: parameter.kind.range_text(),
            default: parameter.kind.default_text(),
            unit: parameter.unit,
            description: parameter.doc,
        };
        Self {
            name: entry.name,
            directive: entry.directive,
            classes: entry.classes.iter().map(|class| class.name()).collect(),
            description: entry.doc,
            parameters: entry.parameters.iter().map(row).collect(),
        }
    }
}

impl Display for Listed {
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
            let unit = if row.unit.is_empty() {
                String::new()
            } else {
                format!(" [{}]", row.unit)
            };
            writeln!(f, "  \"{} {}\"{unit}: {}; {default}", row.r#type, row.name, row.range)?;
            writeln!(f, "      {}", row.description)?;
        }
        writeln!(f)
    }
}
