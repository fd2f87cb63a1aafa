//! Spectra: `rgb`, `blackbody`, and `spectrum` as samples, a name or a file.

use super::params::{Param, ParamType, Values, value_span};
use super::reader::ParamReader;
use super::suggest;
use crate::desc::{SpectrumDesc, SpectrumValue};
use crate::error::Span;
use crate::spectrum::{LAMBDA_MAX, LAMBDA_MIN, named_spectra};

/// What a spectrum is for, which says what values it may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Use {
    /// A reflectance, in [0, 1].
    Albedo,
    /// An emission, not negative.
    Emission,
    /// An index of refraction, positive.
    Ior,
    /// An absorption coefficient, not negative.
    Absorption,
    /// A value of a texture, not negative: who uses the texture says what it is.
    Texture,
}

impl Use {
    /// Whether a value is possible, and the end of the sentence that says so.
    fn allows(self, value: f64) -> Result<(), &'static str> {
        let (fine, range) = match self {
            Self::Albedo => ((0.0..=1.0).contains(&value), "between 0 and 1"),
            Self::Ior => (value > 0.0, "positive"),
            Self::Emission | Self::Absorption | Self::Texture => (value >= 0.0, "0 or more"),
        };
        if fine { Ok(()) } else { Err(range) }
    }
}

impl ParamReader<'_> {
    /// A spectrum, if the parameter is there.
    pub fn spectrum(&mut self, name: &'static str, usage: Use) -> Option<SpectrumDesc> {
        self.spectrum_or(name, usage, &[])
    }

    /// A spectrum or, as pbrt has it for the index of dielectrics, a plain number.
    pub fn spectrum_or_float(&mut self, name: &'static str, usage: Use) -> Option<SpectrumDesc> {
        self.spectrum_or(name, usage, &[ParamType::Float])
    }

    fn spectrum_or(&mut self, name: &'static str, usage: Use, more: &[ParamType]) -> Option<SpectrumDesc> {
        let kinds = [&[ParamType::Rgb, ParamType::Spectrum, ParamType::Blackbody], more].concat();
        let param = self.take(name, &kinds)?;
        self.spectrum_of(&param, usage)
    }

    /// The spectrum that a parameter is.
    pub fn spectrum_of(&mut self, param: &Param, usage: Use) -> Option<SpectrumDesc> {
        let value = match (param.kind, &param.values) {
            (ParamType::Spectrum, Values::Strings(strings)) => self.named(param, strings, usage)?,
            (ParamType::Spectrum, Values::Numbers(numbers)) => self.samples(param, numbers, usage)?,
            (ParamType::Rgb, Values::Numbers(v)) => {
                self.check_count(param, v.len(), 3)?;
                self.check_values(param, v, usage, 1)?;
                let space = param.color_space.unwrap_or(self.context.color_space);
                SpectrumValue::Rgb([v[0] as f32, v[1] as f32, v[2] as f32], space)
            }
            (ParamType::Blackbody, Values::Numbers(v)) => {
                self.check_count(param, v.len(), 1)?;
                if v[0] <= 0.0 || v[0] > f64::from(f32::MAX) {
                    self.out_of_range(&param.name, &v[0].to_string(), "a positive temperature in kelvin");
                    return None;
                }
                SpectrumValue::Blackbody(v[0] as f32)
            }
            (_, Values::Numbers(v)) => {
                self.check_count(param, v.len(), 1)?;
                self.check_values(param, v, usage, 1)?;
                SpectrumValue::Constant(v[0] as f32)
            }
            _ => return None,
        };
        Some(SpectrumDesc {
            value,
            span: param.values_span,
        })
    }

    /// A name, or the name of a file of samples.
    fn named(&mut self, param: &Param, strings: &[String], usage: Use) -> Option<SpectrumValue> {
        self.check_count(param, strings.len(), 1)?;
        let name = &strings[0];
        if named_spectra().any(|known| known == name) {
            return Some(SpectrumValue::Named(name.clone()));
        }
        let span = value_span(self.report(), param, 0);
        let path = self.context.resolve(name, span);
        if !path.exists() {
            let known: Vec<&str> = named_spectra().collect();
            let help = suggest::closest(name, &known).map(|n| format!("did you mean `{n}`?"));
            let message = format!("`{name}` is neither the name of a spectrum nor a file");
            let help = help.unwrap_or_else(|| format!("the names are {}", known.join(", ")));
            self.report().error_with_help(span, message, Some(help));
            return None;
        }
        match self.context.read_text(&path) {
            Ok(text) => self.file(param, span, &text, usage),
            Err(e) => {
                self.report()
                    .error(span, format!("cannot read {}: {e}", path.display()));
                None
            }
        }
    }

    /// A file of numbers, wavelengths and values in turn; `#` starts a comment.
    fn file(&mut self, param: &Param, span: Span, text: &[u8], usage: Use) -> Option<SpectrumValue> {
        let mut numbers = Vec::new();
        for (index, line) in text.split(|&b| b == b'\n').enumerate() {
            let line = line.split(|&b| b == b'#').next().unwrap_or_default();
            for word in line.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty()) {
                match fast_float2::parse::<f64, _>(word) {
                    Ok(value) if value.is_finite() => numbers.push(value),
                    _ => {
                        let message = format!("this spectrum's file has no finite number in its line {}", index + 1);
                        self.report().error(span, message);
                        return None;
                    }
                }
            }
        }
        let in_file = Param {
            values_span: span,
            span,
            ..param.clone()
        };
        self.samples(&in_file, &numbers, usage)
    }

    /// Wavelengths and values in turn.
    fn samples(&mut self, param: &Param, numbers: &[f64], usage: Use) -> Option<SpectrumValue> {
        let name = &param.name;
        if numbers.len() < 2 || !numbers.len().is_multiple_of(2) {
            let message = format!(
                "`{name}` wants pairs of a wavelength in nm and a value, found {} numbers",
                numbers.len()
            );
            self.report().error(param.values_span, message);
            return None;
        }
        if numbers.iter().any(|v| v.abs() > f64::from(f32::MAX)) {
            let message = format!("a number of `{name}` does not fit into 32-bit floating point");
            self.report().error(param.values_span, message);
            return None;
        }
        let rising = |pair: &[f64]| (pair[2] as f32) > pair[0] as f32;
        let unordered = numbers.windows(3).step_by(2).position(|pair| !rising(pair));
        if let Some(i) = unordered {
            let span = value_span(self.report(), param, 2 * i + 2);
            self.report().error(
                span,
                format!("the wavelengths of `{name}` must increase from pair to pair"),
            );
            return None;
        }
        self.check_values(param, &numbers[1..], usage, 2)?;
        // The same all over what can be seen.
        let (first, last) = (numbers[0] as f32, numbers[numbers.len() - 2] as f32);
        if numbers.chunks_exact(2).all(|pair| pair[1] == numbers[1]) && first <= LAMBDA_MIN && last >= LAMBDA_MAX {
            return Some(SpectrumValue::Constant(numbers[1] as f32));
        }
        Some(SpectrumValue::Samples(
            numbers
                .chunks_exact(2)
                .map(|pair| (pair[0] as f32, pair[1] as f32))
                .collect(),
        ))
    }

    /// Checks the first and every `step`-th value.
    fn check_values(&mut self, param: &Param, values: &[f64], usage: Use, step: usize) -> Option<()> {
        for (i, &value) in values.iter().enumerate().step_by(step) {
            let range = match usage.allows(value) {
                Ok(()) if value <= f64::from(f32::MAX) => continue,
                Ok(()) => "within 32-bit floating point",
                Err(range) => range,
            };
            let span = value_span(self.report(), param, i + step - 1);
            let message = format!("`{}` has the value {value}, it must be {range}", param.name);
            self.report().error(span, message);
            return None;
        }
        Some(())
    }
}
