//! The parameters of a directive of pbrt-v3, while they are translated.

use super::super::params::{Param, ParamType, Values};
use super::super::report::Report;
use crate::error::Span;

/// A directive's parameters and where complaints about them go.
pub(super) struct Old<'a> {
    pub report: &'a mut Report,
    pub params: &'a mut Vec<Param>,
    /// The type of the entity.
    pub span: Span,
}

impl Old<'_> {
    /// Says what was translated, once for each message.
    pub fn note(&mut self, message: &'static str) {
        self.report.translated(self.span, message);
    }

    /// What has no counterpart in pbrt-v4.
    pub fn refuse(&mut self, span: Span, message: &str, instead: &str) {
        self.report.unsupported(span, message, instead);
    }

    /// The parameter of a name.
    pub fn get(&self, name: &str) -> Option<&Param> {
        self.params.iter().find(|p| p.name == name)
    }

    /// Where a parameter is; the entity if it is not there.
    pub fn span_of(&self, name: &str) -> Span {
        self.get(name).map_or(self.span, |p| p.span)
    }

    /// Takes the parameter of a name away.
    pub fn take(&mut self, name: &str) -> Option<Param> {
        let index = self.params.iter().position(|p| p.name == name)?;
        Some(self.params.remove(index))
    }

    /// Takes away what no longer does anything, with a warning; whether it was there.
    pub fn drop(&mut self, name: &str, message: &'static str) -> bool {
        let Some(param) = self.take(name) else {
            return false;
        };
        self.report.translated(param.span, message);
        true
    }

    /// Gives a parameter another name.
    pub fn rename(&mut self, from: &str, to: &str) {
        for param in self.params.iter_mut().filter(|p| p.name == from) {
            to.clone_into(&mut param.name);
        }
    }

    /// The number of a `float`, if it has one.
    pub fn float(&self, name: &str) -> Option<f64> {
        match self.get(name) {
            Some(Param {
                kind: ParamType::Float,
                values: Values::Numbers(v),
                ..
            }) if v.len() == 1 => Some(v[0]),
            _ => None,
        }
    }

    /// The word of a `string`, if it has one.
    pub fn string(&self, name: &str) -> Option<String> {
        match self.get(name) {
            Some(Param {
                kind: ParamType::String,
                values: Values::Strings(v),
                ..
            }) if v.len() == 1 => Some(v[0].clone()),
            _ => None,
        }
    }

    /// The truth of a `bool`, if it has one.
    pub fn bool(&self, name: &str) -> Option<bool> {
        match self.get(name) {
            Some(Param {
                kind: ParamType::Bool,
                values: Values::Bools(v),
                ..
            }) if v.len() == 1 => Some(v[0]),
            _ => None,
        }
    }

    /// The three numbers of an `rgb`.
    pub fn rgb(&self, name: &str) -> Option<[f64; 3]> {
        match self.get(name) {
            Some(Param {
                kind: ParamType::Rgb,
                values: Values::Numbers(v),
                ..
            }) => v[..].try_into().ok(),
            _ => None,
        }
    }

    /// The number that a grey `rgb`, or a `float`, is.
    pub fn grey(&self, name: &str) -> Option<f64> {
        match self.rgb(name) {
            Some([r, g, b]) => (r == g && g == b).then_some(r),
            None => self.float(name),
        }
    }

    /// Adds a parameter, at the place `span`.
    pub fn add(&mut self, kind: ParamType, name: &str, values: Values, span: Span) {
        self.params.push(Param {
            kind,
            name: name.to_owned(),
            span,
            values_span: span,
            values,
            default: None,
            color_space: None,
        });
    }

    /// Adds a `float`.
    pub fn add_float(&mut self, name: &str, value: f64) {
        self.add(ParamType::Float, name, Values::Numbers(vec![value]), self.span);
    }

    /// Adds a `string`.
    pub fn add_string(&mut self, name: &str, value: &str) {
        self.add(
            ParamType::String,
            name,
            Values::Strings(vec![value.to_owned()]),
            self.span,
        );
    }

    /// Adds a grey `rgb`.
    pub fn add_grey(&mut self, name: &str, value: f64) {
        self.add(ParamType::Rgb, name, Values::Numbers(vec![value; 3]), self.span);
    }

    /// Adds a default of pbrt-v3 where nothing is given.
    pub fn default_float(&mut self, name: &str, value: f64) {
        if self.get(name).is_none() {
            self.add_float(name, value);
        }
    }

    /// Adds a grey default of pbrt-v3 where nothing is given.
    pub fn default_grey(&mut self, name: &str, value: f64) {
        if self.get(name).is_none() {
            self.add_grey(name, value);
        }
    }
}
