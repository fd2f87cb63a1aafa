//! Indices of refraction by name.

use super::graph::Value;
use super::loader::Loader;
use super::props::Props;
use crate::desc::suggest;
use crate::desc::{SpectrumDesc, SpectrumValue};

/// Mitsuba's names of dielectrics and their indices.
const DIELECTRICS: &[(&str, f64)] = &[
    ("vacuum", 1.0),
    ("helium", 1.000_036),
    ("hydrogen", 1.000_132),
    ("air", 1.000_277),
    ("carbon dioxide", 1.000_45),
    ("water", 1.333),
    ("acetone", 1.36),
    ("ethanol", 1.361),
    ("carbon tetrachloride", 1.461),
    ("glycerol", 1.4729),
    ("benzene", 1.501),
    ("silicone oil", 1.520_45),
    ("bromine", 1.661),
    ("water ice", 1.31),
    ("fused quartz", 1.458),
    ("pyrex", 1.47),
    ("acrylic glass", 1.49),
    ("polypropylene", 1.49),
    ("bk7", 1.5046),
    ("sodium chloride", 1.544),
    ("amber", 1.55),
    ("pet", 1.575),
    ("diamond", 2.419),
];

/// The names of metals that there are data for, in Mitsuba and here.
const METALS: &[(&str, &str)] = &[
    ("Ag", "metal-Ag"),
    ("Al", "metal-Al"),
    ("Au", "metal-Au"),
    ("Cr", "metal-Cr"),
    ("Cu", "metal-Cu"),
    ("MgO", "metal-MgO"),
    ("TiO2", "metal-TiO2"),
    ("W", "metal-W"),
];

impl<'g> Loader<'g> {
    /// The index inside over that outside.
    pub fn relative_ior(&mut self, props: &mut Props<'g>, inside: &str) -> f64 {
        let [int, ext] = [("int_ior", inside), ("ext_ior", "air")].map(|(name, default)| ior(props, name, default));
        int / ext
    }

    /// Real and imaginary part of a metal: `material`, or `eta` and `k`.
    pub fn metal(&mut self, props: &mut Props<'g>) -> Metal<'g> {
        let span = props.object.span;
        let material = props.string("material");
        let (eta, k) = (props.take("eta"), props.take("k"));
        if let Some(name) = material.filter(|name| *name != "none") {
            if eta.is_some() || k.is_some() {
                props.error(
                    props.span_of("material"),
                    "`material` and `eta` or `k` exclude each other",
                );
            }
            if let Some((_, found)) = METALS.iter().find(|(metal, _)| *metal == name) {
                let part = |which: &str| SpectrumDesc {
                    value: SpectrumValue::Named(format!("{found}-{which}")),
                    span: props.span_of("material"),
                };
                return Metal::Named(part("eta"), part("k"));
            }
            let known: Vec<&str> = METALS.iter().map(|(metal, _)| *metal).collect();
            let close = suggest::closest(name, &known).map(|name| format!(", did you mean `{name}`?"));
            let message = format!(
                "there are no data for the metal `{name}`; there are some for {}{}",
                known.join(", "),
                close.unwrap_or_default()
            );
            props.unsupported(props.span_of("material"), message, "it is copper");
            return Metal::Named(copper("eta", span), copper("k", span));
        }
        match (eta, k) {
            (None, None) => Metal::Mirror,
            (Some(eta), Some(k)) => Metal::Typed(eta, k),
            _ => {
                props.error(span, "a metal has either both of `eta` and `k`, or neither");
                Metal::Mirror
            }
        }
    }
}

/// What a metal is made of.
pub(super) enum Metal<'g> {
    /// It reflects everything.
    Mirror,
    /// Spectra with names.
    Named(SpectrumDesc, SpectrumDesc),
    /// Properties.
    Typed(&'g super::graph::Property, &'g super::graph::Property),
}

fn copper(which: &str, span: crate::error::Span) -> SpectrumDesc {
    SpectrumDesc {
        value: SpectrumValue::Named(format!("metal-Cu-{which}")),
        span,
    }
}

fn ior(props: &mut Props<'_>, name: &'static str, default: &str) -> f64 {
    let by_name = |name: &str| {
        let found = DIELECTRICS.iter().find(|(known, _)| *known == name);
        found.map(|(_, ior)| *ior)
    };
    let Some(property) = props.take(name) else {
        return by_name(default).unwrap_or(1.0);
    };
    let problem = match &property.value {
        Value::Float(value) if *value > 0.0 => return *value,
        Value::Integer(value) if *value > 0 => return *value as f64,
        Value::String(text) => match by_name(text) {
            Some(ior) => return ior,
            None => {
                let known: Vec<&str> = DIELECTRICS.iter().map(|(known, _)| *known).collect();
                let close = suggest::closest(text, &known).map(|name| format!("; did you mean `{name}`?"));
                format!("there is no dielectric `{text}`{}", close.unwrap_or_default())
            }
        },
        other => format!("`{name}` is {}; expected a positive number or a name", other.kind()),
    };
    props.error(property.span, problem);
    1.0
}
