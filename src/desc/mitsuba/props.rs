//! The properties of an object as its reader asks for them. What nobody has asked for is an error, as in Mitsuba.

use glam::{DAffine3, DMat4, DVec3};

use super::graph::{Object, Property, Value};
use crate::desc::report::Report;
use crate::desc::suggest;
use crate::error::Span;

/// The properties of one object, and what was wrong with them.
pub(super) struct Props<'g> {
    pub object: &'g Object,
    taken: Vec<bool>,
    known: Vec<&'static str>,
    problems: Vec<(Span, String)>,
    warnings: Vec<(Span, String)>,
    unsupported: Vec<(Span, String, &'static str)>,
}

impl<'g> Props<'g> {
    pub fn new(object: &'g Object) -> Self {
        Self {
            object,
            taken: vec![false; object.properties.len()],
            known: Vec::new(),
            problems: Vec::new(),
            warnings: Vec::new(),
            unsupported: Vec::new(),
        }
    }

    /// The property of this name, which is then taken.
    pub fn take(&mut self, name: &'static str) -> Option<&'g Property> {
        self.known.push(name);
        let at = self.object.properties.iter().position(|p| p.name == name)?;
        self.taken[at] = true;
        Some(&self.object.properties[at])
    }

    /// Whether the file gives it.
    pub fn has(&self, name: &str) -> bool {
        self.object.properties.iter().any(|p| p.name == name)
    }

    /// Where it is; where the object is if it is not given.
    pub fn span_of(&self, name: &str) -> Span {
        let property = self.object.properties.iter().find(|p| p.name == name);
        property.map_or(self.object.span, |p| p.span)
    }

    pub fn error(&mut self, span: Span, message: impl Into<String>) {
        self.problems.push((span, message.into()));
    }

    pub fn warning(&mut self, span: Span, message: impl Into<String>) {
        self.warnings.push((span, message.into()));
    }

    /// Something that Mitsuba has and that would change the picture; `instead` says what stands in with `--lenient`.
    pub fn unsupported(&mut self, span: Span, message: impl Into<String>, instead: &'static str) {
        self.unsupported.push((span, message.into(), instead));
    }

    fn wrong_type(&mut self, property: &Property, expected: &str) {
        let message = format!("`{}` is {}; expected {expected}", property.name, property.value.kind());
        self.problems.push((property.span, message));
    }

    /// A number.
    pub fn float(&mut self, name: &'static str) -> Option<f64> {
        let property = self.take(name)?;
        match property.value {
            Value::Float(value) => Some(value),
            Value::Integer(value) => Some(value as f64),
            _ => {
                self.wrong_type(property, "a float");
                None
            }
        }
    }

    /// A number that `fine` accepts; `range` says which do.
    pub fn float_in(&mut self, name: &'static str, default: f64, range: &str, fine: impl Fn(f64) -> bool) -> f64 {
        match self.float(name) {
            Some(value) if fine(value) => value,
            Some(value) => {
                let span = self.span_of(name);
                self.error(span, format!("`{name}` is {value}; expected {range}"));
                default
            }
            None => default,
        }
    }

    /// A number above 0.
    pub fn positive(&mut self, name: &'static str, default: f64) -> f64 {
        self.float_in(name, default, "a positive number", |v| v > 0.0)
    }

    /// An integer.
    pub fn integer(&mut self, name: &'static str) -> Option<i64> {
        let property = self.take(name)?;
        if let Value::Integer(value) = property.value {
            return Some(value);
        }
        self.wrong_type(property, "an integer");
        None
    }

    /// An integer from `least` that fits into 31 bits.
    pub fn count(&mut self, name: &'static str, least: u32, default: u32) -> u32 {
        match self.integer(name) {
            Some(value) => match u32::try_from(value) {
                Ok(count) if count >= least && count <= i32::MAX as u32 => count,
                _ => {
                    let span = self.span_of(name);
                    self.error(span, format!("`{name}` is {value}; expected {least} to {}", i32::MAX));
                    default
                }
            },
            None => default,
        }
    }

    /// A boolean.
    pub fn boolean(&mut self, name: &'static str, default: bool) -> bool {
        let Some(property) = self.take(name) else {
            return default;
        };
        if let Value::Boolean(value) = property.value {
            return value;
        }
        self.wrong_type(property, "a boolean");
        default
    }

    /// A string.
    pub fn string(&mut self, name: &'static str) -> Option<&'g str> {
        let property = self.take(name)?;
        if let Value::String(value) = &property.value {
            return Some(value);
        }
        self.wrong_type(property, "a string");
        None
    }

    /// One of `choices`, the first by default.
    pub fn choice(&mut self, name: &'static str, choices: &[&'static str]) -> &'static str {
        let Some(value) = self.string(name) else {
            return choices[0];
        };
        if let Some(choice) = choices.iter().find(|choice| **choice == value) {
            return choice;
        }
        let span = self.span_of(name);
        let mut message = format!("`{name}` is `{value}`; expected {}", choices.join(", "));
        if let Some(close) = suggest::closest(value, choices) {
            message.push_str(&format!(" (did you mean `{close}`?)"));
        }
        self.error(span, message);
        choices[0]
    }

    /// A vector or point.
    pub fn vector(&mut self, name: &'static str) -> Option<DVec3> {
        let property = self.take(name)?;
        if let Value::Vector(value) = property.value {
            return Some(value);
        }
        self.wrong_type(property, "a point or vector");
        None
    }

    /// A matrix; the identity if none is given.
    pub fn matrix(&mut self, name: &'static str) -> DMat4 {
        let Some(property) = self.take(name) else {
            return DMat4::IDENTITY;
        };
        if let Value::Transform(matrix) = property.value {
            return matrix;
        }
        self.wrong_type(property, "a transform");
        DMat4::IDENTITY
    }

    /// An invertible affine transform; the identity if none is given.
    pub fn transform(&mut self, name: &'static str) -> DAffine3 {
        let matrix = self.matrix(name);
        let last = matrix.row(3);
        let affine = DAffine3::from_mat4(matrix * (1.0 / last.w));
        let determinant = affine.matrix3.determinant();
        let fine = last.truncate() == DVec3::ZERO
            && affine.is_finite()
            && determinant.is_finite()
            && determinant != 0.0
            && affine.inverse().is_finite();
        if fine {
            return affine;
        }
        let span = self.span_of(name);
        self.error(span, format!("`{name}` must be affine and invertible"));
        DAffine3::IDENTITY
    }

    /// The objects that `wanted` accepts, whatever their names: all are taken.
    pub fn objects(&mut self, wanted: impl Fn(&Property) -> bool) -> Vec<&'g Property> {
        let properties = &self.object.properties;
        let found = properties.iter().zip(&mut self.taken).filter(|(p, _)| wanted(p));
        found
            .map(|(property, taken)| {
                *taken = true;
                property
            })
            .collect()
    }

    /// These properties are Mitsuba's and have no effect here; each with the reason.
    pub fn inert(&mut self, names: &[(&'static str, &str)]) {
        for (name, why) in names {
            if let Some(property) = self.take(name) {
                self.warnings
                    .push((property.span, format!("`{name}` has no effect: {why}")));
            }
        }
    }

    /// These properties are Mitsuba's and change nothing that a picture shows.
    pub fn ignore(&mut self, names: &[&'static str]) {
        for name in names {
            self.take(name);
        }
    }

    /// Hands over what was found wrong, and complains about what was not asked for.
    pub fn finish(mut self, report: &mut Report) {
        let entity = format!("the {} `{}`", self.object.class.name(), self.object.plugin);
        for (property, _) in self
            .object
            .properties
            .iter()
            .zip(&self.taken)
            .filter(|(_, taken)| !**taken)
        {
            let name = &property.name;
            let help = suggest::closest(name, &self.known).map(|name| format!("did you mean `{name}`?"));
            let message = match (&property.value, name.is_empty()) {
                (Value::Object(_), true) => format!("{entity} has no place for this object"),
                _ => format!("{entity} has no property `{name}`"),
            };
            report.unsupported_with_help(property.span, message, "it is ignored", help);
        }
        for (span, message) in self.problems.drain(..) {
            report.error(span, message);
        }
        for (span, message) in self.warnings.drain(..) {
            report.warning(span, message);
        }
        for (span, message, instead) in self.unsupported.drain(..) {
            report.unsupported(span, message, instead);
        }
    }
}
