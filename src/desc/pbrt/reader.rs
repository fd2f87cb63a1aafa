//! Typed access to the parameters of one entity.
//!
//! Every name that is asked for is known from then on; [`ParamReader::finish`] complains about the others.

use glam::DVec3;

use super::files::Context;
use super::params::{Param, ParamType, Values, value_span};
use super::report::Report;
use crate::desc::{Entry, Parameter, TextureId, suggest};
use crate::error::Span;

/// The parameters of one entity, being read.
pub(super) struct ParamReader<'a> {
    pub context: &'a mut Context,
    /// What they belong to, for messages: camera `perspective`.
    pub entity: String,
    /// The type of the entity in the file.
    pub span: Span,
    /// The textures that were named, and where.
    pub textures: Vec<(TextureId, Span)>,
    params: Vec<Param>,
    used: Vec<bool>,
    known: Vec<&'static str>,
}

impl<'a> ParamReader<'a> {
    /// For the entity `class` of type `name` at `span`, with its own parameters and the defaults that `Attribute` set.
    pub fn new(
        context: &'a mut Context,
        class: &str,
        name: &str,
        span: Span,
        params: Vec<Param>,
        defaults: &[Param],
    ) -> Self {
        let mut all = params;
        for default in defaults.iter().rev() {
            if !all.iter().any(|p| p.name == default.name) {
                all.push(default.clone());
            }
        }
        Self {
            context,
            entity: format!("{class} `{name}`"),
            span,
            textures: Vec::new(),
            used: vec![false; all.len()],
            params: all,
            known: Vec::new(),
        }
    }

    /// The report, to complain to.
    pub fn report(&mut self) -> &mut Report {
        &mut self.context.report
    }

    /// Takes the parameter `name` if it is there and of one of the types `kinds`; complains if it is of another one. `None` too if
    /// its values are broken.
    pub fn take(&mut self, name: &'static str, kinds: &[ParamType]) -> Option<Param> {
        self.known.push(name);
        self.take_named(name, kinds)
    }

    /// Takes the parameters whose names begin so, as [`ParamReader::take`] does, in the order of the file.
    pub fn take_beginning(&mut self, beginning: &str, kinds: &[ParamType]) -> Vec<Param> {
        let mut names: Vec<String> = Vec::new();
        for param in self.params.iter().filter(|param| param.name.starts_with(beginning)) {
            if !names.contains(&param.name) {
                names.push(param.name.clone());
            }
        }
        names.iter().filter_map(|name| self.take_named(name, kinds)).collect()
    }

    fn take_named(&mut self, name: &str, kinds: &[ParamType]) -> Option<Param> {
        let mut found: Option<Param> = None;
        for i in 0..self.params.len() {
            let param = &self.params[i];
            if param.name != name || std::mem::replace(&mut self.used[i], true) {
                continue;
            }
            if let Some(number) = param.default {
                self.context.use_default(number);
            }
            let param = &mut self.params[i];
            let (span, kind) = (param.span, param.kind);
            if !kinds.contains(&kind) {
                let expected: Vec<String> = kinds.iter().map(|k| format!("`{}`", k.name())).collect();
                let message = format!(
                    "`{name}` has the type `{}`, expected {}",
                    kind.name(),
                    expected.join(" or ")
                );
                self.report().error(span, message);
            } else if found.is_some() {
                self.report()
                    .error(span, format!("the parameter `{name}` is given a second time"));
            } else if param.values != Values::Broken {
                let values = std::mem::replace(&mut param.values, Values::Broken);
                found = Some(Param {
                    values,
                    name: param.name.clone(),
                    ..*param
                });
            }
        }
        found
    }

    /// Whether the parameter is there, of whatever type.
    pub fn has(&self, name: &str) -> bool {
        self.params.iter().any(|p| p.name == name)
    }

    /// Where the parameter is declared; the entity if it is not.
    pub fn span_of(&self, name: &str) -> Span {
        self.params
            .iter()
            .find(|p| p.name == name)
            .map_or(self.span, |p| p.span)
    }

    /// The numbers of a parameter, if there are `count` of them; else a complaint.
    pub fn numbers(&mut self, name: &'static str, kind: ParamType, count: usize) -> Option<Vec<f64>> {
        let param = self.take(name, &[kind])?;
        let Values::Numbers(numbers) = &param.values else {
            return None;
        };
        self.check_count(&param, numbers.len(), count)?;
        if let Some(bad) = numbers.iter().position(|v| v.abs() > f64::from(f32::MAX)) {
            let span = value_span(self.report(), &param, bad);
            self.report()
                .error(span, format!("`{name}` does not fit into 32-bit floating point"));
            return None;
        }
        Some(numbers.clone())
    }

    /// Says so unless a parameter has `count` values.
    pub fn check_count(&mut self, param: &Param, found: usize, count: usize) -> Option<()> {
        if found == count {
            return Some(());
        }
        let plural = if count == 1 { "" } else { "s" };
        self.report().error(
            param.values_span,
            format!("`{}` takes {count} value{plural}, found {found}", param.name),
        );
        None
    }

    /// A number.
    pub fn float(&mut self, name: &'static str) -> Option<f64> {
        self.numbers(name, ParamType::Float, 1).map(|values| values[0])
    }

    /// A number for which `valid` holds, or `default`; `range` completes "must be".
    pub fn float_in(&mut self, name: &'static str, default: f64, valid: impl Fn(f64) -> bool, range: &str) -> f64 {
        match self.float(name) {
            Some(value) if valid(value) => value,
            Some(value) => {
                self.out_of_range(name, &value.to_string(), range);
                default
            }
            None => default,
        }
    }

    /// A positive number, or `default`.
    pub fn positive(&mut self, name: &'static str, default: f64) -> f64 {
        self.float_in(name, default, |v| v > 0.0, "positive")
    }

    /// A number that is not negative, or `default`.
    pub fn not_negative(&mut self, name: &'static str, default: f64) -> f64 {
        self.float_in(name, default, |v| v >= 0.0, "0 or more")
    }

    /// An integer for which `valid` holds, or `default`; `range` completes "must be".
    pub fn integer_in(&mut self, name: &'static str, default: i32, valid: impl Fn(i32) -> bool, range: &str) -> i32 {
        let Some(param) = self.take(name, &[ParamType::Integer]) else {
            return default;
        };
        let Values::Integers(values) = &param.values else {
            return default;
        };
        if self.check_count(&param, values.len(), 1).is_none() {
            return default;
        }
        if !valid(values[0]) {
            self.out_of_range(name, &values[0].to_string(), range);
            return default;
        }
        values[0]
    }

    /// `count` integers.
    pub fn integers(&mut self, name: &'static str, count: usize) -> Option<Vec<i32>> {
        let param = self.take(name, &[ParamType::Integer])?;
        let Values::Integers(values) = &param.values else {
            return None;
        };
        self.check_count(&param, values.len(), count)?;
        Some(values.clone())
    }

    /// A truth value, or `default`.
    pub fn boolean(&mut self, name: &'static str, default: bool) -> bool {
        let Some(param) = self.take(name, &[ParamType::Bool]) else {
            return default;
        };
        match &param.values {
            Values::Bools(values) if self.check_count(&param, values.len(), 1).is_some() => values[0],
            _ => default,
        }
    }

    /// A string and the place of its value.
    pub fn string(&mut self, name: &'static str) -> Option<(String, Span)> {
        let param = self.take(name, &[ParamType::String])?;
        let Values::Strings(values) = &param.values else {
            return None;
        };
        self.check_count(&param, values.len(), 1)?;
        let span = value_span(self.report(), &param, 0);
        Some((values[0].clone(), span))
    }

    /// A point, or `default`.
    pub fn point3(&mut self, name: &'static str, default: DVec3) -> DVec3 {
        self.numbers(name, ParamType::Point3, 3)
            .map_or(default, |v| DVec3::new(v[0], v[1], v[2]))
    }

    /// Complains about a value; `range` completes "must be".
    pub fn out_of_range(&mut self, name: &str, value: &str, range: &str) {
        let span = self
            .params
            .iter()
            .find(|p| p.name == name)
            .map_or(self.span, |p| p.values_span);
        self.report()
            .error(span, format!("`{name}` is {value}, it must be {range}"));
    }

    /// Parameters that pbrt has and that cannot change the image here: (name, why).
    pub fn inert(&mut self, names: &[(&'static str, &str)]) {
        for &(name, why) in names {
            for span in self.use_up(name) {
                self.report().warning(span, format!("`{name}` has no effect: {why}"));
            }
        }
    }

    /// Those that a table says have no effect.
    pub fn inert_by(&mut self, parameters: &[&'static Parameter]) {
        for parameter in parameters {
            self.inert(&[(parameter.name, parameter.doc)]);
        }
    }

    fn use_up(&mut self, name: &'static str) -> Vec<Span> {
        self.known.push(name);
        let mut spans = Vec::new();
        for (param, used) in self.params.iter().zip(&mut self.used) {
            if param.name == name && !std::mem::replace(used, true) {
                spans.push(param.span);
                if let Some(number) = param.default {
                    self.context.use_default(number);
                }
            }
        }
        spans
    }

    /// As [`ParamReader::finish`], of an entity that is in a table: all that has been asked for is there.
    pub fn finish_by(self, entry: &Entry) {
        // A named material says besides what it is.
        let missing = self.known.iter().find(|&&name| !entry.has(name) && name != "type");
        debug_assert!(missing.is_none(), "{} lacks `{missing:?}` in its table", self.entity);
        self.finish();
    }

    /// Complains about what nobody asked for.
    pub fn finish(self) {
        for (param, used) in self.params.iter().zip(&self.used) {
            if *used || param.default.is_some() {
                continue;
            }
            let message = format!("{} has no parameter `{}`", self.entity, param.name);
            let known = &self.known;
            self.context
                .report
                .unknown(param.span, message, "it is ignored", &param.name, known);
        }
    }
}

/// Complains about a type that is not among `known`; those in `later` are pbrt's but not supported yet.
pub(super) fn unknown_type(
    report: &mut Report,
    class: &str,
    name: &str,
    span: Span,
    (known, later): (&[&str], &[&str]),
    instead: &str,
) {
    if later.contains(&name) {
        report.unsupported(span, format!("the {class} `{name}` is not supported yet"), instead);
    } else {
        let all: Vec<&str> = known.iter().chain(later).copied().collect();
        let help = match suggest::closest(name, &all) {
            Some(name) => format!("did you mean `{name}`?"),
            None => format!("supported are {}", known.join(", ")),
        };
        report.unsupported_with_help(span, format!("unknown {class} `{name}`"), instead, Some(help));
    }
}
