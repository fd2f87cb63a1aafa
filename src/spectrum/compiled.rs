//! Spectra in the form that rendering samples.

use std::sync::Arc;

use super::cie::{self, DenseTable};
use super::description::{Kind, RgbSpectrum, Shape, Spectrum};
use super::rgb2spec::SigmoidPolynomial;
use super::{ColorMode, ColorSpace, LAMBDA_D, LANES, SampledSpectrum, SpectrumRole, Wavelengths, named};

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
            _ => self.sample_varying(wavelengths),
        }
    }

    /// Its values at any wavelengths, if those are the same; in rgb mode they are.
    #[inline]
    pub fn constant(&self) -> Option<SampledSpectrum> {
        match self.form {
            Form::Constant(lanes) => Some(lanes),
            _ => None,
        }
    }

    fn sample_varying(&self, wavelengths: &Wavelengths) -> SampledSpectrum {
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
    /// - [`SpectrumRole::Reflectance`]: an rgb albedo or unbounded rgb of sRGB as given; anything else by its colour under D65 (of a
    ///   constant c that is (c, c, c)).
    /// - [`SpectrumRole::Emission`]: the XYZ integrals, as a film's sensor takes them (not divided by the integral of ȳ), in
    ///   linear sRGB. For an rgb illuminant that is rgb times [`Spectrum::photometric`], the integral of ȳ times D65; so a
    ///   light that is scaled by 1 / photometric() has the lanes (r, g, b), and the luminance 1 where it is any other light.
    /// - [`SpectrumRole::Ior`]: the value at 587.6 nm, in all four lanes.
    ///
    /// Colours outside the gamut of sRGB lose what is negative in them, and a reflectance what exceeds 1 or, if that is more, the
    /// spectrum's largest value.
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
            (SpectrumRole::Reflectance, Kind::Rgb(rgb)) if !rgb.illuminant && rgb.space == ColorSpace::Srgb => {
                lanes(rgb.rgb)
            }
            (SpectrumRole::Reflectance, _) => {
                let d65 = named::d65();
                let xyz = cie::integrate_xyz(|nm| self.value(nm) * d65.at(nm));
                let white = cie::integrate_y(|nm| d65.at(nm));
                let largest = self.max_value().max(1.0);
                lanes(cie::xyz_to_srgb(xyz).map(|c| ((c / white) as f32).min(largest).max(0.0)))
            }
            (SpectrumRole::Emission, Kind::Rgb(rgb)) if rgb.illuminant && rgb.space == ColorSpace::Srgb => {
                lanes(rgb.rgb) * self.photometric()
            }
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
        (Shape::Grey(value), true) => Form::Dense(value * rgb.scale, rgb.space.illuminant().clone()),
        (Shape::Sigmoid(polynomial), true) => Form::Illuminant(rgb.scale, polynomial, rgb.space.illuminant().clone()),
        (Shape::Sigmoid(polynomial), false) if rgb.scale == 1.0 => Form::Sigmoid(polynomial),
        (Shape::Sigmoid(polynomial), false) => Form::ScaledSigmoid(rgb.scale, polynomial),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::{Outside, named_spectra};

    fn examples() -> Vec<Spectrum> {
        let mut all: Vec<_> = named_spectra().filter_map(Spectrum::named).collect();
        all.extend([
            Spectrum::constant(0.7),
            Spectrum::rgb_albedo([0.9, 0.1, 0.05]),
            Spectrum::rgb_unbounded([0.2, 3.0, 7.0]),
            Spectrum::rgb_illuminant([17.0, 12.0, 4.0]),
            Spectrum::rgb_illuminant([2.0; 3]),
            Spectrum::blackbody(3000.0),
            Spectrum::tabulated(
                vec![(400.0, 0.0), (500.0, 8.0), (600.0, 15.6), (700.0, 18.4)],
                Outside::Zero,
            ),
        ]);
        all
    }

    #[test]
    fn samples_are_values_and_average_to_the_integral() {
        for spectrum in examples() {
            let compiled = spectrum
                .compile(ColorMode::Spectral, SpectrumRole::Emission)
                .scaled(3.0);
            let (mut luminance, n) = (0.0, 1 << 16);
            for i in 0..n {
                let w = Wavelengths::sample_visible((i as f32 + 0.5) / n as f32);
                let s = compiled.sample(&w);
                let y = s * cie::xyz_bar(&w)[1];
                luminance += f64::from(y.safe_div(w.pdf()).mean()) / f64::from(n);
                if i % 64 == 0 {
                    // Tables are looked up at the nearest nm, and D65 in the value of an rgb illuminant too.
                    let [exact, nearest] = [w.lambda[0], w.lambda[0].round()].map(|nm| 3.0 * spectrum.value(nm));
                    let close = |v: f32| (s.0[0] - v).abs() <= 1e-5 * v.abs() + 1e-6;
                    assert!(close(nearest) || close(exact), "{spectrum:?} at {}: {s:?}", w.lambda[0]);
                }
            }
            // The midpoint rule, some 250 points a nm, against steps at every nm; half an entry at either end is never
            // sampled.
            let expected = f64::from(3.0 * spectrum.luminance());
            let ends = 3.0 * spectrum.max_value() * cie::y_integral() * 1e-6;
            let bound = 1e-4 * expected + f64::from(ends);
            assert!(
                (luminance - expected).abs() < bound,
                "{spectrum:?}: {luminance} and {expected}"
            );
            assert!((f64::from(compiled.photometric_luminance()) / expected - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn rgb_emission_is_what_the_sensor_sees_of_the_spectral_one() {
        for spectrum in examples() {
            let lanes = spectrum.compile(ColorMode::Rgb, SpectrumRole::Emission);
            let SampledSpectrum([r, g, b, unused]) = lanes.sample(&Wavelengths::rgb());
            assert_eq!(unused, 0.0);
            let seen = cie::xyz_to_srgb(cie::integrate_xyz(|nm| spectrum.value(nm)));
            for (lane, expected) in [r, g, b].into_iter().zip(seen) {
                let expected = expected.max(0.0) as f32;
                assert!(
                    (lane - expected).abs() <= 1e-5 * expected + 1e-3,
                    "{spectrum:?}: {lane} and {expected}"
                );
            }
        }
    }

    #[test]
    fn an_rgb_light_over_its_photometric_has_its_rgb() {
        let light = Spectrum::rgb_illuminant([17.0, 12.0, 4.0]);
        let lanes = light.compile(ColorMode::Rgb, SpectrumRole::Emission);
        let SampledSpectrum(scaled) = lanes.scaled(1.0 / light.photometric()).sample(&Wavelengths::rgb());
        for (a, b) in scaled.into_iter().zip([17.0, 12.0, 4.0, 0.0]) {
            assert!((a - b).abs() <= 2.0 * f32::EPSILON * b, "{scaled:?}");
        }
    }

    #[test]
    fn rgb_reflectance_is_the_colour_under_d65() {
        let compile = |s: &Spectrum| {
            let compiled = s.compile(ColorMode::Rgb, SpectrumRole::Reflectance);
            compiled.sample(&Wavelengths::rgb()).0
        };
        assert_eq!(compile(&Spectrum::constant(0.3)), [0.3, 0.3, 0.3, 0.0]);
        assert_eq!(compile(&Spectrum::rgb_albedo([0.9, 0.1, 0.0])), [0.9, 0.1, 0.0, 0.0]);
        // A table of an rgb albedo's own spectrum gives the rgb back.
        let albedo = Spectrum::rgb_albedo([0.7, 0.2, 0.1]);
        let table = (360..=830).map(|nm| (nm as f32, albedo.value(nm as f32))).collect();
        let lanes = compile(&Spectrum::tabulated(table, Outside::Constant));
        for (a, b) in lanes.into_iter().zip([0.7, 0.2, 0.1, 0.0]) {
            assert!((a - b).abs() < 2e-6, "{lanes:?}");
        }
        // Red may be more than the spectrum is anywhere: its primary is not that narrow. By Mitsuba 3's tables of x, y, z and D65.
        let samples = vec![(400.0, 0.1), (500.0, 0.2), (600.0, 0.8), (700.0, 0.6)];
        let lanes = compile(&Spectrum::tabulated(samples, Outside::Constant));
        for (a, b) in lanes.into_iter().zip([0.8987, 0.4513, 0.1069, 0.0]) {
            assert!((a - b).abs() < 1e-3, "{lanes:?}");
        }
    }

    #[test]
    fn indices_are_those_of_the_d_line_in_rgb() {
        let glass = Spectrum::named("glass-F11").expect("known");
        let spectral = glass.compile(ColorMode::Spectral, SpectrumRole::Ior);
        let rgb = glass.compile(ColorMode::Rgb, SpectrumRole::Ior);
        assert!(!spectral.is_constant_over_wavelengths() && rgb.is_constant_over_wavelengths());
        assert_eq!(
            rgb.sample(&Wavelengths::rgb()),
            SampledSpectrum::splat(glass.value(LAMBDA_D))
        );
        let flat = Spectrum::tabulated(vec![(400.0, 1.5), (700.0, 1.5)], Outside::Constant);
        for s in [flat, Spectrum::constant(1.5)] {
            assert!(
                s.compile(ColorMode::Spectral, SpectrumRole::Ior)
                    .is_constant_over_wavelengths()
            );
        }
    }

    #[test]
    fn black_is_recognised() {
        let compile = |s: Spectrum| s.compile(ColorMode::Spectral, SpectrumRole::Emission);
        assert!(compile(Spectrum::rgb_illuminant([0.0; 3])).is_black());
        assert!(compile(Spectrum::tabulated(vec![], Outside::Zero)).is_black());
        assert!(
            compile(Spectrum::rgb_illuminant([1.0, 0.0, 0.0]))
                .scaled(0.0)
                .is_black()
        );
        assert!(!compile(Spectrum::rgb_illuminant([1.0, 0.0, 0.0])).is_black());
    }
}
