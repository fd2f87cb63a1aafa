//! Spectra in the form that rendering samples.

use std::sync::Arc;

use super::cie::{self, DenseTable};
use super::description::{Kind, RgbSpectrum, Shape, Spectrum};
use super::rgb2spec::SigmoidPolynomial;
use super::{ColorMode, LAMBDA_D, LANES, SampledSpectrum, SpectrumRole, Wavelengths, named};

/// A [`Spectrum`] made ready for one [`ColorMode`] and [`SpectrumRole`]. Cheap to clone and to sample.
#[derive(Clone, Debug)]
pub struct CompiledSpectrum {
    form: Form,
    luminance: f32,
}

#[derive(Clone, Debug)]
enum Form {
    Constant(SampledSpectrum),
    Sigmoid(SigmoidPolynomial),
    ScaledSigmoid(f32, SigmoidPolynomial),
    /// Scale, reflectance, illuminant.
    Illuminant(f32, SigmoidPolynomial, Arc<DenseTable>),
    Dense(f32, Arc<DenseTable>),
}

impl CompiledSpectrum {
    /// The values at the wavelengths of a path; in rgb mode the lanes (r, g, b, 0), whatever the wavelengths.
    #[inline]
    pub fn sample(&self, wavelengths: &Wavelengths) -> SampledSpectrum {
        match &self.form {
            Form::Constant(lanes) => *lanes,
            Form::Sigmoid(polynomial) => polynomial.sample(wavelengths),
            Form::ScaledSigmoid(scale, polynomial) => polynomial.sample(wavelengths) * *scale,
            Form::Illuminant(scale, polynomial, light) => {
                polynomial.sample(wavelengths) * light.sample(wavelengths) * *scale
            }
            Form::Dense(scale, table) => table.sample(wavelengths) * *scale,
        }
    }

    /// This spectrum times `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f32) -> Self {
        let form = match self.form.clone() {
            Form::Constant(lanes) => Form::Constant(lanes * factor),
            Form::Sigmoid(polynomial) => Form::ScaledSigmoid(factor, polynomial),
            Form::ScaledSigmoid(scale, polynomial) => Form::ScaledSigmoid(scale * factor, polynomial),
            Form::Illuminant(scale, polynomial, light) => Form::Illuminant(scale * factor, polynomial, light),
            Form::Dense(scale, table) => Form::Dense(scale * factor, table),
        };
        Self {
            form,
            luminance: self.luminance * factor,
        }
    }

    /// Whether every sample has the same value in all four lanes: true of a refractive index without dispersion, which
    /// leaves secondary wavelengths alive, and of all of them in rgb mode.
    #[inline]
    pub fn is_constant_over_wavelengths(&self) -> bool {
        matches!(self.form, Form::Constant(SampledSpectrum(lanes)) if lanes == [lanes[0]; LANES])
    }

    /// Whether it is zero at every wavelength.
    #[inline]
    pub fn is_black(&self) -> bool {
        match &self.form {
            Form::Constant(lanes) => lanes.is_black(),
            Form::Sigmoid(_) => false,
            Form::ScaledSigmoid(scale, _) | Form::Illuminant(scale, ..) => *scale == 0.0,
            Form::Dense(scale, table) => *scale == 0.0 || table.values().iter().all(|&v| v == 0.0),
        }
    }

    /// The integral of ȳ times the spectrum, all of it, in both modes the same: what lights are weighed by. (Not
    /// [`Spectrum::photometric`], which leaves the colour of an rgb illuminant out.)
    pub fn photometric_luminance(&self) -> f32 {
        self.luminance
    }
}

impl Spectrum {
    /// Makes the spectrum ready for rendering.
    ///
    /// In spectral mode a sample is the value at each wavelength; tables are sampled at the nearest nm.
    ///
    /// In rgb mode the lanes are linear sRGB and a zero:
    /// - [`SpectrumRole::Reflectance`]: an rgb albedo or unbounded rgb as given; anything else by its colour under D65 (of a
    ///   constant c that is (c, c, c)).
    /// - [`SpectrumRole::Emission`]: the XYZ integrals, as a film's sensor takes them (not divided by the integral of ȳ), in
    ///   linear sRGB. For an rgb illuminant that is rgb times [`Spectrum::photometric`], the integral of ȳ times D65; so a
    ///   light that is scaled by 1 / photometric() has the lanes (r, g, b), and the luminance 1 where it is any other light.
    /// - [`SpectrumRole::Ior`]: the value at 587.6 nm, in all four lanes.
    ///
    /// Colours outside the gamut of sRGB lose what is negative in them, and a reflectance what exceeds the spectrum's
    /// largest value.
    pub fn compile(&self, mode: ColorMode, role: SpectrumRole) -> CompiledSpectrum {
        let form = match mode {
            ColorMode::Spectral => self.spectral_form(),
            ColorMode::Rgb => Form::Constant(self.rgb_lanes(role)),
        };
        CompiledSpectrum {
            form,
            luminance: self.luminance(),
        }
    }

    fn spectral_form(&self) -> Form {
        match &self.0 {
            Kind::Constant(value) => Form::Constant(SampledSpectrum::splat(*value)),
            Kind::Rgb(rgb) => spectral_rgb(rgb),
            Kind::Tabulated { .. } | Kind::Blackbody { .. } => {
                let table = self.dense();
                let first = table.values()[0];
                if table.values().iter().all(|&v| v == first) {
                    Form::Constant(SampledSpectrum::splat(first))
                } else {
                    Form::Dense(1.0, Arc::new(table))
                }
            }
        }
    }

    fn rgb_lanes(&self, role: SpectrumRole) -> SampledSpectrum {
        let lanes = |[r, g, b]: [f32; 3]| SampledSpectrum([r, g, b, 0.0]);
        match (role, &self.0) {
            (SpectrumRole::Ior, _) => SampledSpectrum::splat(self.value(LAMBDA_D)),
            (SpectrumRole::Reflectance, Kind::Constant(value)) => lanes([*value; 3]),
            (SpectrumRole::Reflectance, Kind::Rgb(rgb)) if !rgb.illuminant => lanes(rgb.rgb),
            (SpectrumRole::Reflectance, _) => {
                let d65 = named::d65();
                let xyz = cie::integrate_xyz(|nm| self.value(nm) * d65.at(nm));
                let white = cie::integrate_y(|nm| d65.at(nm));
                let largest = self.max_value();
                lanes(cie::xyz_to_srgb(xyz).map(|c| ((c / white) as f32).max(0.0).min(largest)))
            }
            (SpectrumRole::Emission, Kind::Rgb(rgb)) if rgb.illuminant => lanes(rgb.rgb) * self.photometric(),
            (SpectrumRole::Emission, _) => {
                let xyz = cie::integrate_xyz(|nm| self.value(nm));
                lanes(cie::xyz_to_srgb(xyz).map(|c| (c as f32).max(0.0)))
            }
        }
    }
}

fn spectral_rgb(rgb: &RgbSpectrum) -> Form {
    match (rgb.shape(), rgb.illuminant) {
        (Shape::Grey(value), false) => Form::Constant(SampledSpectrum::splat(value * rgb.scale)),
        (Shape::Grey(value), true) => Form::Dense(value * rgb.scale, named::d65().clone()),
        (Shape::Sigmoid(polynomial), true) => Form::Illuminant(rgb.scale, polynomial, named::d65().clone()),
        (Shape::Sigmoid(polynomial), false) if rgb.scale == 1.0 => Form::Sigmoid(polynomial),
        (Shape::Sigmoid(polynomial), false) => Form::ScaledSigmoid(rgb.scale, polynomial),
    }
}
