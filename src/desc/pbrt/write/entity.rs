//! The text of one directive: a type and parameters.

use std::fmt::Write as _;

use glam::{DAffine3, DMat4, DVec3};

use crate::desc::{ColorSpace, SpectrumDesc, SpectrumValue, Textured};

/// A directive in the making.
pub(super) struct Entity {
    text: String,
    /// What the `rgb` parameters are in; the first one's counts.
    space: Option<ColorSpace>,
    /// Whether they are not all in one space, which a file cannot say.
    is_mixed: bool,
}

impl Entity {
    /// `directive "kind"`.
    pub fn new(directive: &str, kind: &str) -> Self {
        Self {
            text: format!("{directive} {}", quoted(kind)),
            space: None,
            is_mixed: false,
        }
    }

    /// `Texture "name" "class" "kind"`.
    pub fn texture(name: &str, class: &str, kind: &str) -> Self {
        Self {
            text: format!("Texture {} {} {}", quoted(name), quoted(class), quoted(kind)),
            space: None,
            is_mixed: false,
        }
    }

    /// The color space that must be in force, and the text.
    pub fn finish(self) -> (ColorSpace, bool, String) {
        (self.space.unwrap_or_default(), self.is_mixed, self.text)
    }

    fn put(&mut self, kind: &str, name: &str, value: &str) -> &mut Self {
        // Writing to a string does not fail.
        let _ = write!(self.text, "\n    \"{kind} {name}\" [{value}]");
        self
    }

    pub fn float(&mut self, name: &str, value: f64) -> &mut Self {
        self.put("float", name, &value.to_string())
    }

    pub fn single(&mut self, name: &str, value: f32) -> &mut Self {
        self.put("float", name, &single(value))
    }

    pub fn floats(&mut self, name: &str, values: &[f64]) -> &mut Self {
        self.put("float", name, &join(values.iter()))
    }

    pub fn numbers(&mut self, kind: &str, name: &str, values: &[f64]) -> &mut Self {
        self.put(kind, name, &join(values.iter()))
    }

    pub fn integer(&mut self, name: &str, value: i64) -> &mut Self {
        self.put("integer", name, &value.to_string())
    }

    pub fn integers(&mut self, name: &str, values: impl Iterator<Item = i64>) -> &mut Self {
        self.put("integer", name, &join(values))
    }

    pub fn boolean(&mut self, name: &str, value: bool) -> &mut Self {
        self.put("bool", name, if value { "true" } else { "false" })
    }

    pub fn string(&mut self, name: &str, value: &str) -> &mut Self {
        self.put("string", name, &quoted(value))
    }

    pub fn strings(&mut self, name: &str, values: [&str; 2]) -> &mut Self {
        self.put("string", name, &values.map(quoted).join(" "))
    }

    pub fn point(&mut self, kind: &str, name: &str, value: DVec3) -> &mut Self {
        self.put(kind, name, &join(value.to_array().iter()))
    }

    /// A list of numbers by vertex.
    pub fn singles(&mut self, kind: &str, name: &str, values: impl Iterator<Item = f32>) -> &mut Self {
        let values: Vec<_> = values.map(single).collect();
        self.put(kind, name, &values.join(" "))
    }

    /// What a parameter of the class of numbers is: a number, or the name that `texture` gives to a texture.
    pub fn float_textured(&mut self, name: &str, value: &Textured<f32>, names: &[String]) -> &mut Self {
        match value {
            Textured::Value(value) => self.single(name, *value),
            Textured::Texture(id) => self.put("texture", name, &quoted(&names[id.0 as usize])),
        }
    }

    /// The same of spectra.
    pub fn spectrum_textured(&mut self, name: &str, value: &Textured<SpectrumDesc>, names: &[String]) -> &mut Self {
        match value {
            Textured::Value(value) => self.spectrum(name, value),
            Textured::Texture(id) => self.put("texture", name, &quoted(&names[id.0 as usize])),
        }
    }

    pub fn spectrum(&mut self, name: &str, spectrum: &SpectrumDesc) -> &mut Self {
        match &spectrum.value {
            // Of which the value is the same at all wavelengths, within and beyond those that are given.
            SpectrumValue::Constant(value) => {
                let value = single(*value);
                self.put("spectrum", name, &format!("200 {value} 1000 {value}"))
            }
            SpectrumValue::Rgb(rgb, space) => {
                self.is_mixed |= self.space.is_some_and(|first| first != *space);
                self.space.get_or_insert(*space);
                self.singles("rgb", name, rgb.iter().copied())
            }
            SpectrumValue::Named(known) => self.put("spectrum", name, &quoted(known)),
            SpectrumValue::Samples(samples) => {
                let numbers = samples.iter().flat_map(|&(lambda, value)| [lambda, value]);
                self.singles("spectrum", name, numbers)
            }
            SpectrumValue::Blackbody(kelvin) => self.put("blackbody", name, &single(*kelvin)),
        }
    }
}

/// A string as a token.
pub(super) fn quoted(text: &str) -> String {
    let mut token = String::with_capacity(text.len() + 2);
    token.push('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => token.extend(['\\', c]),
            '\n' => token.push_str("\\n"),
            _ => token.push(c),
        }
    }
    token.push('"');
    token
}

/// A number that reads back as the same one, by way of double precision.
fn single(value: f32) -> String {
    let short = value.to_string();
    match short.parse::<f64>() {
        Ok(read) if (read as f32).to_bits() == value.to_bits() => short,
        _ => f64::from(value).to_string(),
    }
}

fn join<T: ToString>(values: impl Iterator<Item = T>) -> String {
    values.map(|value| value.to_string()).collect::<Vec<_>>().join(" ")
}

/// `Transform` with the matrix of `transform`, as pbrt has it: transposed.
pub(super) fn transform(transform: &DAffine3) -> String {
    let matrix = DMat4::from_mat3_translation(transform.matrix3, transform.translation);
    format!("Transform [{}]", join(matrix.to_cols_array().iter()))
}
