//! Parameters by their [`Parameter`] tables, and those that may be given a texture.

use glam::DVec3;

use super::params::{Param, ParamType, Values, value_span};
use super::reader::ParamReader;
use super::spectrum::Use;
use super::suggest;
use crate::desc::{
    ImageId, Parameter, ParameterDefault, ParameterKind, SpectrumDesc, SpectrumValue, TextureClass, TextureId, Textured,
};
use crate::error::Span;
use crate::image_io::Encoding;

impl ParamReader<'_> {
    /// A number that may come from a texture.
    pub fn float_textured(&mut self, name: &'static str) -> Option<Textured<f32>> {
        let param = self.take(name, &[ParamType::Float, ParamType::Texture])?;
        match &param.values {
            Values::Numbers(numbers) => {
                self.check_count(&param, numbers.len(), 1)?;
                let value = numbers[0] as f32;
                if value.is_finite() {
                    return Some(Textured::Value(value));
                }
                self.report().error(
                    param.values_span,
                    format!("`{name}` does not fit into 32-bit floating point"),
                );
                None
            }
            Values::Strings(_) => Some(Textured::Texture(self.texture(&param, TextureClass::Float)?)),
            _ => None,
        }
    }

    /// A spectrum that may come from a texture.
    pub fn spectrum_textured(&mut self, name: &'static str, usage: Use) -> Option<Textured<SpectrumDesc>> {
        let kinds = [
            ParamType::Rgb,
            ParamType::Spectrum,
            ParamType::Blackbody,
            ParamType::Texture,
        ];
        let param = self.take(name, &kinds)?;
        if param.kind == ParamType::Texture {
            return Some(Textured::Texture(self.texture(&param, TextureClass::Spectrum)?));
        }
        self.spectrum_of(&param, usage).map(Textured::Value)
    }

    /// The texture that a parameter names.
    fn texture(&mut self, param: &Param, class: TextureClass) -> Option<TextureId> {
        let Values::Strings(names) = &param.values else {
            return None;
        };
        self.check_count(param, names.len(), 1)?;
        let span = value_span(self.report(), param, 0);
        let id = self.context.textures.named(class, &names[0], span);
        self.textures.push((id, span));
        Some(id)
    }

    /// A truth value by its table.
    pub fn bool_by(&mut self, parameter: &'static Parameter) -> bool {
        match parameter.kind {
            ParameterKind::Bool(default) => self.boolean(parameter.name, default),
            _ => false,
        }
    }

    /// A number by its table.
    pub fn float_by(&mut self, parameter: &'static Parameter) -> f64 {
        match parameter.kind {
            ParameterKind::Float { default, range } => {
                self.float_in(parameter.name, default, |value| range.contains(value), range.text())
            }
            _ => 0.0,
        }
    }

    /// An integer by its table.
    pub fn integer_by(&mut self, parameter: &'static Parameter) -> i32 {
        match parameter.kind {
            ParameterKind::Integer { default, range } => {
                let valid = |value| (range.0..=range.1).contains(&value);
                self.integer_in(parameter.name, default, valid, &parameter.kind.range_text())
            }
            _ => 0,
        }
    }

    /// One of a few words by its table.
    pub fn choice_by(&mut self, parameter: &'static Parameter) -> &'static str {
        let ParameterKind::Choice { default, choices } = parameter.kind else {
            return "";
        };
        let Some((word, span)) = self.string(parameter.name) else {
            return default;
        };
        choices
            .iter()
            .copied()
            .find(|&choice| choice == word)
            .unwrap_or_else(|| {
                let message = format!("`{}` is one of {}, not `{word}`", parameter.name, choices.join(", "));
                let help = suggest::closest(&word, choices).map(|word| format!("did you mean `{word}`?"));
                self.report().error_with_help(span, message, help);
                default
            })
    }

    /// The encoding of an image's samples by its table.
    pub fn encoding_by(&mut self, parameter: &'static Parameter) -> Encoding {
        let ParameterKind::Encoding { default } = parameter.kind else {
            return Encoding::Srgb;
        };
        let Some((name, span)) = self.string(parameter.name) else {
            return default;
        };
        Encoding::from_name(&name).unwrap_or_else(|| {
            let message = format!(
                "`{}` is `sRGB`, `linear` or `gamma` with a positive exponent, not `{name}`",
                parameter.name
            );
            self.report().error(span, message);
            default
        })
    }

    /// The image that a parameter names, which is read when all of the scene has been; complains if it is not given.
    pub fn image(&mut self, name: &'static str, encoding: Encoding) -> Option<ImageId> {
        let Some((file, span)) = self.string(name) else {
            if !self.has(name) {
                let (span, message) = (self.span, format!("{} has no `\"string {name}\"`", self.entity));
                self.report().error(span, message);
            }
            return None;
        };
        let path = self.context.resolve(&file, span);
        Some(self.context.images.add(path, encoding, span))
    }

    /// A vector by its table.
    pub fn vector_by(&mut self, parameter: &'static Parameter) -> DVec3 {
        match parameter.kind {
            ParameterKind::Vector(default) => self
                .numbers(parameter.name, ParamType::Vector3, 3)
                .map_or(DVec3::from(default), |v| DVec3::new(v[0], v[1], v[2])),
            _ => DVec3::ZERO,
        }
    }

    /// A number that may come from a texture, by its table.
    pub fn float_textured_by(&mut self, parameter: &'static Parameter) -> Textured<f32> {
        match parameter.kind {
            ParameterKind::FloatTextured { default } | ParameterKind::Textured { default } => self
                .float_textured(parameter.name)
                .unwrap_or(Textured::Value(default as f32)),
            ParameterKind::FloatTexturedIn {
                default: ParameterDefault::Number(default),
                ..
            } => self.float_textured_or(parameter, Textured::Value(default as f32)),
            _ => Textured::Value(0.0),
        }
    }

    /// A number that may come from a texture, within the range of its table; else `default`.
    pub fn float_textured_or(&mut self, parameter: &'static Parameter, default: Textured<f32>) -> Textured<f32> {
        let ParameterKind::FloatTexturedIn { range, .. } = parameter.kind else {
            return default;
        };
        match self.float_textured(parameter.name) {
            Some(Textured::Value(value)) if !range.contains(value.into()) => {
                self.out_of_range(parameter.name, &value.to_string(), range.text());
                default
            }
            Some(value) => value,
            None => default,
        }
    }

    /// A reflectance by its table, if one is given.
    pub fn reflectance_by(&mut self, parameter: &'static Parameter) -> Option<Textured<SpectrumDesc>> {
        self.spectrum_textured(parameter.name, Use::Albedo)
    }

    /// An absorption by its table, if one is given.
    pub fn absorption_by(&mut self, parameter: &'static Parameter) -> Option<Textured<SpectrumDesc>> {
        self.spectrum_textured(parameter.name, Use::Absorption)
    }

    /// An amount of a pigment by its table, if one is given.
    pub fn pigment_by(&mut self, parameter: &'static Parameter) -> Option<Textured<f32>> {
        match self.float_textured(parameter.name)? {
            Textured::Value(value) if value < 0.0 => {
                self.out_of_range(parameter.name, &value.to_string(), &parameter.kind.range_text());
                None
            }
            amount => Some(amount),
        }
    }

    /// The index of refraction of a dielectric by its table.
    pub fn glass_index_by(&mut self, parameter: &'static Parameter) -> SpectrumDesc {
        let default = match parameter.kind {
            ParameterKind::GlassIndex { default } => default,
            _ => 1.0,
        };
        let span = self.span;
        let eta = self
            .spectrum_or_float(parameter.name, Use::Ior)
            .unwrap_or_else(|| constant(default, span));
        if let SpectrumValue::Rgb(..) | SpectrumValue::Blackbody(_) = eta.value {
            let message = "the index of refraction of a dielectric is a number or a spectrum, not a colour";
            self.report().error(eta.span, message);
        }
        eta
    }

    /// A spectrum that may come from a texture, by its table.
    pub fn spectrum_textured_by(&mut self, parameter: &'static Parameter) -> Textured<SpectrumDesc> {
        let span = self.span;
        match parameter.kind {
            ParameterKind::Textured { default } => self
                .spectrum_textured(parameter.name, Use::Texture)
                .unwrap_or_else(|| Textured::Value(constant(default, span))),
            ParameterKind::Reflectance { default } => self
                .reflectance_by(parameter)
                .unwrap_or_else(|| Textured::Value(constant(default.unwrap_or_default(), span))),
            // An index of 0 + i, for one, reflects everything.
            ParameterKind::MetalIndex { default } | ParameterKind::MetalAbsorption { default } => self
                .spectrum_textured(parameter.name, Use::Absorption)
                .unwrap_or_else(|| Textured::Value(named(default, span))),
            _ => Textured::Value(constant(0.0, span)),
        }
    }

    /// A number of a texture's class, by its table.
    pub fn value_by(&mut self, parameter: &'static Parameter) -> f32 {
        match parameter.kind {
            ParameterKind::Value { default } => self.float(parameter.name).unwrap_or(default) as f32,
            _ => 0.0,
        }
    }

    /// A spectrum of a texture's class, by its table.
    pub fn spectrum_value_by(&mut self, parameter: &'static Parameter) -> SpectrumDesc {
        let span = self.span;
        match parameter.kind {
            ParameterKind::Value { default } => self
                .spectrum(parameter.name, Use::Texture)
                .unwrap_or_else(|| constant(default, span)),
            _ => constant(0.0, span),
        }
    }
}

fn constant(value: f64, span: Span) -> SpectrumDesc {
    SpectrumDesc {
        value: SpectrumValue::Constant(value as f32),
        span,
    }
}

fn named(name: &str, span: Span) -> SpectrumDesc {
    SpectrumDesc {
        value: SpectrumValue::Named(name.to_owned()),
        span,
    }
}
