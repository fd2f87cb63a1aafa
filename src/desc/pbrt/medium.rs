//! `MakeNamedMedium` and the names that `MediumInterface` uses.

use std::collections::HashMap;

use super::reader::{ParamReader, unknown_type};
use super::report::Report;
use super::spectrum::Use;
use crate::desc::kinds::media as kinds;
use crate::desc::measured_media::MEASURED_MEDIA;
use crate::desc::{
    CoefficientsDesc, ColorSpace, MEDIA, MediumDesc, MediumId, Parameter, ParameterKind, SpectrumDesc, SpectrumValue,
};
use crate::error::Span;

const LATER: [&str; 4] = ["uniformgrid", "rgbgrid", "cloud", "nanovdb"];

/// Reads the medium `name`; what cannot be read becomes a vacuum.
pub(super) fn read(mut reader: ParamReader<'_>, name: String) -> MediumDesc {
    let span = reader.span;
    let Some((kind, kind_span)) = reader.string("type") else {
        if !reader.has("type") {
            let message = "this medium has no type: `\"string type\" \"homogeneous\"`, for one";
            reader.report().error(span, message);
        }
        return vacuum(name, span);
    };
    let Some(entry) = MEDIA.iter().find(|entry| entry.name == kind) else {
        let known = MEDIA.each_ref().map(|entry| entry.name);
        let classes = (&known[..], &LATER[..]);
        let instead = "a vacuum stands in";
        unknown_type(reader.report(), "medium", &kind, kind_span, classes, instead);
        return vacuum(name, span);
    };
    let coefficients = coefficients(&mut reader);
    let le = spectrum_by(&mut reader, &kinds::LE, Use::Emission);
    let medium = MediumDesc {
        coefficients,
        scale: reader.float_by(&kinds::SCALE),
        g: reader.float_by(&kinds::G),
        le: reader.has(kinds::LE.name).then_some(le),
        le_scale: reader.float_by(&kinds::LE_SCALE),
        ..vacuum(name, span)
    };
    reader.finish_by(entry);
    medium
}

/// Those of the preset if there is one.
fn coefficients(reader: &mut ParamReader<'_>) -> CoefficientsDesc {
    let whole = [&kinds::SIGMA_T, &kinds::ALBEDO];
    let parts = [&kinds::SIGMA_A, &kinds::SIGMA_S, &kinds::PRESET];
    if let Some(given) = whole.iter().find(|parameter| reader.has(parameter.name)) {
        let sigma_t = spectrum_by(reader, &kinds::SIGMA_T, Use::Absorption);
        let albedo = spectrum_by(reader, &kinds::ALBEDO, Use::Albedo);
        // Taken so that each is complained about once.
        absorption_and_scattering(reader);
        for other in parts {
            if !reader.has(other.name) {
                continue;
            }
            let message = format!("`{}` and `{}` exclude each other", given.name, other.name);
            let span = reader.span_of(other.name);
            reader.report().error(span, message);
        }
        return CoefficientsDesc::Whole { sigma_t, albedo };
    }
    let [sigma_a, sigma_s] = absorption_and_scattering(reader);
    CoefficientsDesc::Parts { sigma_a, sigma_s }
}

fn absorption_and_scattering(reader: &mut ParamReader<'_>) -> [SpectrumDesc; 2] {
    let preset = reader.choice_by(&kinds::PRESET);
    let span = reader.span_of(kinds::PRESET.name);
    let given = [&kinds::SIGMA_A, &kinds::SIGMA_S].map(|parameter| spectrum_by(reader, parameter, Use::Absorption));
    let Some(measured) = MEASURED_MEDIA.iter().find(|medium| medium.name == preset) else {
        return given;
    };
    for name in [kinds::SIGMA_A.name, kinds::SIGMA_S.name] {
        if reader.has(name) {
            let span = reader.span_of(name);
            let message = format!("`{name}` has no effect: the preset says what it is");
            reader.report().warning(span, message);
        }
    }
    [measured.sigma_a, measured.sigma_prime_s].map(|rgb| SpectrumDesc {
        value: SpectrumValue::Rgb(rgb, ColorSpace::default()),
        span,
    })
}

fn spectrum_by(reader: &mut ParamReader<'_>, parameter: &'static Parameter, usage: Use) -> SpectrumDesc {
    let span = reader.span;
    let default = match parameter.kind {
        ParameterKind::Spectrum { default } => default,
        _ => 0.0,
    };
    let given = reader.spectrum(parameter.name, usage);
    given.unwrap_or_else(|| constant(default as f32, span))
}

fn vacuum(name: String, span: Span) -> MediumDesc {
    MediumDesc {
        name,
        coefficients: CoefficientsDesc::Parts {
            sigma_a: constant(0.0, span),
            sigma_s: constant(0.0, span),
        },
        scale: 1.0,
        g: 0.0,
        le: None,
        le_scale: 1.0,
        span,
    }
}

fn constant(value: f32, span: Span) -> SpectrumDesc {
    SpectrumDesc {
        value: SpectrumValue::Constant(value),
        span,
    }
}

/// Media by name: a name gets its number when it is first mentioned, which may be before its definition.
#[derive(Debug, Default)]
pub(super) struct Media {
    /// The definition, or where the name was first used.
    slots: Vec<Result<MediumDesc, (String, Span)>>,
    names: HashMap<String, usize>,
}

impl Media {
    /// The medium of a name used at `span`; the empty name is that of the vacuum.
    pub fn named(&mut self, name: String, span: Span) -> Option<MediumId> {
        // There are fewer media than bytes in a file.
        (!name.is_empty()).then(|| MediumId(self.slot(name, span) as u32))
    }

    fn slot(&mut self, name: String, span: Span) -> usize {
        let slots = &mut self.slots;
        *self.names.entry(name).or_insert_with_key(|name| {
            slots.push(Err((name.clone(), span)));
            slots.len() - 1
        })
    }

    /// Defines a medium; what is wrong with that, if anything is.
    pub fn define(&mut self, medium: MediumDesc) -> Option<String> {
        if medium.name.is_empty() {
            return Some("a medium needs a name".to_owned());
        }
        let slot = self.slot(medium.name.clone(), medium.span);
        if self.slots[slot].is_ok() {
            return Some(format!("there is a medium `{}` already", medium.name));
        }
        self.slots[slot] = Ok(medium);
        None
    }

    /// All media by their numbers. Complains about those that are not defined.
    pub fn finish(self, report: &mut Report) -> Vec<MediumDesc> {
        let defined: Vec<String> = self.slots.iter().flatten().map(|medium| medium.name.clone()).collect();
        let known: Vec<&str> = defined.iter().map(String::as_str).collect();
        let mut media = Vec::with_capacity(self.slots.len());
        for slot in self.slots {
            media.push(slot.unwrap_or_else(|(name, span)| {
                let message = format!("there is no medium `{name}`");
                report.unknown(span, message, "a vacuum stands in", &name, &known);
                vacuum(name, span)
            }));
        }
        media
    }
}
