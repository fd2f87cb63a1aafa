//! Spectra of surfaces and of lights.

use super::graph::{Object, Property, Value};
use super::loader::Loader;
use super::plugins::Class;
use super::props::Props;
use super::values::{Spectrum as Typed, samples};
use crate::desc::{ColorSpace, SpectrumDesc, SpectrumValue};
use crate::error::Span;
use crate::spectrum::{Outside, Spectrum};

/// What a spectrum is for, which says what values it may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Use {
    /// A reflectance, in [0, 1].
    Albedo,
    /// An index of refraction or an absorption, not negative.
    Unbounded,
    /// A radiance, not negative.
    Emission,
}

impl Use {
    /// What is wrong with a value, if anything.
    fn problem(self, value: f64) -> Option<&'static str> {
        match self {
            Self::Albedo if !(0.0..=1.0).contains(&value) => Some("in [0, 1]"),
            _ if value < 0.0 => Some("not negative"),
            _ if value > f64::from(f32::MAX) => Some("within single precision"),
            _ => None,
        }
    }
}

impl<'g> Loader<'g> {
    /// The spectrum that a property is; none if it is a texture proper, or wrong, which is said.
    pub fn spectrum(&mut self, property: &'g Property, usage: Use) -> Option<SpectrumDesc> {
        let value = match &property.value {
            Value::Float(value) => SpectrumValue::Constant(*value as f32),
            Value::Integer(value) => SpectrumValue::Constant(*value as f32),
            Value::Rgb(rgb) => SpectrumValue::Rgb(rgb.map(|c| c as f32), ColorSpace::Srgb),
            Value::Spectrum(typed) => of_typed(typed),
            Value::Object(_) => {
                let (_, object) = self.object_of(property, Class::Texture)?;
                self.spectrum_plugin(object)?
            }
            other => {
                let message = format!(
                    "`{}` is {}; expected a spectrum or texture",
                    property.name,
                    other.kind()
                );
                self.report().error(property.span, message);
                return None;
            }
        };
        let values: Vec<f64> = match &value {
            SpectrumValue::Constant(value) => vec![f64::from(*value)],
            SpectrumValue::Rgb(rgb, _) => rgb.map(f64::from).to_vec(),
            SpectrumValue::Samples(samples) => samples.iter().map(|&(_, value)| f64::from(value)).collect(),
            SpectrumValue::Named(_) | SpectrumValue::Blackbody(_) => Vec::new(),
        };
        if let Some((value, range)) = values.iter().find_map(|&v| Some((v, usage.problem(v)?))) {
            let message = format!("`{}` has the value {value}, which must be {range}", property.name);
            self.report().error(property.span, message);
            return None;
        }
        Some(SpectrumDesc {
            value,
            span: property.span,
        })
    }

    /// The spectrum that a plugin is; none for a texture proper.
    fn spectrum_plugin(&mut self, object: &'g Object) -> Option<SpectrumValue> {
        let mut props = Props::new(object);
        let value = match object.plugin.as_str() {
            "uniform" => {
                props.inert(&[("lambda_min", SAME_EVERYWHERE), ("lambda_max", SAME_EVERYWHERE)]);
                Some(SpectrumValue::Constant(props.float("value").unwrap_or(1.0) as f32))
            }
            "rgb" | "srgb" | "srgb_d65" => {
                let name = if object.plugin == "rgb" { "value" } else { "color" };
                props.ignore(&["unbounded"]);
                match props.take(name).map(|p| (&p.value, p.span)) {
                    Some((Value::Rgb(rgb), _)) => Some(SpectrumValue::Rgb(rgb.map(|c| c as f32), ColorSpace::Srgb)),
                    _ => {
                        props.error(object.span, format!("this spectrum needs `<rgb name=\"{name}\" .../>`"));
                        None
                    }
                }
            }
            "d65" => {
                let scale = props.float("scale").unwrap_or(1.0) as f32;
                Some(SpectrumValue::Rgb([scale; 3], ColorSpace::Srgb))
            }
            "blackbody" => {
                props.ignore(&["wavelength_min", "wavelength_max"]);
                let kelvin = props.positive("temperature", 5000.0);
                Some(SpectrumValue::Blackbody(kelvin as f32))
            }
            "regular" | "irregular" => self.tabulated(&mut props),
            _ => return None,
        };
        props.finish(self.report());
        value
    }

    fn tabulated(&mut self, props: &mut Props<'g>) -> Option<SpectrumValue> {
        let span = props.object.span;
        let list = |props: &mut Props<'g>, name: &'static str| -> Option<Vec<f64>> {
            let text = props.string(name)?;
            let words = text
                .split(|c: char| c == ',' || c.is_whitespace())
                .filter(|w| !w.is_empty());
            let numbers: Option<Vec<f64>> = words.map(|word| word.parse().ok()).collect();
            if numbers.is_none() {
                props.error(span, format!("`{name}` is no list of numbers"));
            }
            numbers
        };
        let values = list(props, "values");
        let wavelengths = if props.object.plugin == "irregular" {
            list(props, "wavelengths")
        } else {
            let (first, last) = (
                props.positive("wavelength_min", 360.0),
                props.positive("wavelength_max", 830.0),
            );
            let count = values.as_ref().map_or(0, Vec::len);
            let step = |i: usize| first + (last - first) * i as f64 / (count.max(2) - 1) as f64;
            Some((0..count).map(step).collect())
        };
        let (Some(wavelengths), Some(values)) = (wavelengths, values) else {
            props.error(span, "this spectrum needs lists of wavelengths and values");
            return None;
        };
        if wavelengths.len() != values.len() {
            let message = format!(
                "there are {} wavelengths and {} values",
                wavelengths.len(),
                values.len()
            );
            props.error(span, message);
            return None;
        }
        let pairs = wavelengths.into_iter().zip(values).collect();
        samples(pairs, span, self.report()).map(|typed| of_typed(&typed))
    }

    /// The spectrum that a property of a light is, and the scale that gives the light the same brightness as in Mitsuba; `None` for
    /// nothing at all and for what is wrong. Without the property it is white.
    pub fn emission(&mut self, property: Option<&'g Property>, span: Span) -> Option<(SpectrumDesc, f32)> {
        let Some(property) = property else {
            let value = SpectrumValue::Rgb([1.0; 3], ColorSpace::Srgb);
            return Some((SpectrumDesc { value, span }, 1.0));
        };
        let mut desc = self.spectrum(property, Use::Emission)?;
        // A plain number is so much of D65.
        if let Value::Float(_) | Value::Integer(_) = property.value
            && let SpectrumValue::Constant(value) = desc.value
        {
            desc.value = SpectrumValue::Rgb([value; 3], ColorSpace::Srgb);
        }
        let scale = brightness(&desc.value);
        if scale == 0.0 {
            // A spectrum of no luminance cannot be scaled to any.
            desc.value = SpectrumValue::Rgb([0.0; 3], ColorSpace::Srgb);
        }
        Some((desc, scale))
    }
}

const SAME_EVERYWHERE: &str = "it is the same at all wavelengths";

fn of_typed(typed: &Typed) -> SpectrumValue {
    match typed {
        Typed::Constant(value) => SpectrumValue::Constant(*value as f32),
        Typed::Samples(samples) => SpectrumValue::Samples(samples.clone()),
    }
}

/// The luminance of a spectrum relative to that of a constant 1, which a description of lights leaves out (but not for an rgb value);
/// that of a black body is in W·m⁻²·sr⁻¹·nm⁻¹.
fn brightness(value: &SpectrumValue) -> f32 {
    /// 2 h c² in W·m²·sr⁻¹, hc / k in nm K, and Wien's displacement constant in nm K.
    const FIRST: f64 = 1.191_042_972e-16;
    const SECOND: f64 = 1.438_776_877e7;
    const WIEN: f64 = 2.897_771_955e6;
    let over_constant = |spectrum: Spectrum| spectrum.photometric() / Spectrum::constant(1.0).photometric();
    match value {
        SpectrumValue::Rgb(..) | SpectrumValue::Named(_) => 1.0,
        SpectrumValue::Constant(value) => *value,
        SpectrumValue::Samples(samples) => over_constant(Spectrum::tabulated(samples.clone(), Outside::Zero)),
        SpectrumValue::Blackbody(kelvin) => {
            let peak_nm = WIEN / f64::from(*kelvin);
            let per_metre = FIRST / (peak_nm * 1e-9).powi(5) / (SECOND / WIEN).exp_m1();
            over_constant(Spectrum::blackbody(*kelvin)) * (per_metre * 1e-9) as f32
        }
    }
}
