//! What a scene says about a spectrum.

use std::sync::{Arc, OnceLock};

use super::cie::{self, DenseTable};
use super::color_space::ColorSpace;
use super::named;
use super::rgb2spec::{self, SigmoidPolynomial};

/// What a tabulated spectrum is outside its table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outside {
    /// Zero, for illuminants and responses.
    Zero,
    /// The value at the nearest end, for refractive indices and reflectances.
    Constant,
}

/// A function of wavelength as a scene describes it. Evaluating it is slow: rendering uses what [`Spectrum::compile`] makes
/// of it.
#[derive(Clone, Debug)]
pub struct Spectrum(pub(super) Kind);

#[derive(Clone, Debug)]
pub(super) enum Kind {
    Constant(f32),
    Rgb(RgbSpectrum),
    Tabulated {
        points: Arc<[(f32, f32)]>,
        outside: Outside,
    },
    Blackbody {
        kelvin: f32,
    },
}

/// A spectrum for linear RGB: `scale` times a reflectance in [0, 1], times the white of the colour space if `illuminant`.
#[derive(Clone, Debug)]
pub(super) struct RgbSpectrum {
    pub rgb: [f32; 3],
    pub scale: f32,
    pub illuminant: bool,
    pub space: ColorSpace,
    /// Found when first needed: rgb mode never does.
    shape: OnceLock<Shape>,
}

/// The reflectance of an rgb colour.
#[derive(Clone, Copy, Debug)]
pub(super) enum Shape {
    /// Greys, black and white are the same at every wavelength, exactly.
    Grey(f32),
    Sigmoid(SigmoidPolynomial),
}

impl RgbSpectrum {
    fn new(rgb: [f32; 3], scale: f32, illuminant: bool) -> Self {
        Self {
            rgb,
            scale,
            illuminant,
            space: ColorSpace::Srgb,
            shape: OnceLock::new(),
        }
    }

    /// The reflectance of rgb / scale.
    pub fn shape(&self) -> Shape {
        *self.shape.get_or_init(|| {
            let [r, g, b] = self.rgb;
            if self.scale == 0.0 {
                Shape::Grey(0.0)
            } else if r == g && g == b {
                Shape::Grey(r / self.scale)
            } else {
                Shape::Sigmoid(rgb2spec::solve(self.space, self.rgb.map(|c| c / self.scale)))
            }
        })
    }

    fn value(&self, nm: f32) -> f32 {
        let reflectance = match self.shape() {
            Shape::Grey(value) => value,
            Shape::Sigmoid(polynomial) => polynomial.at(nm),
        };
        let light = if self.illuminant {
            self.space.illuminant().at(nm)
        } else {
            1.0
        };
        self.scale * reflectance * light
    }
}

impl Spectrum {
    /// The same value at every wavelength.
    pub fn constant(value: f32) -> Self {
        Self(Kind::Constant(value))
    }

    /// The reflectance of a colour in linear sRGB. Each component is in [0, 1]; anything else is the caller's error.
    pub fn rgb_albedo(rgb: [f32; 3]) -> Self {
        Self(Kind::Rgb(RgbSpectrum::new(rgb, 1.0, false)))
    }

    /// A quantity that is not bounded by 1 (an absorption coefficient), given in linear sRGB, no component negative: twice
    /// the largest component times the reflectance of the rest.
    pub fn rgb_unbounded(rgb: [f32; 3]) -> Self {
        Self(Kind::Rgb(RgbSpectrum::new(rgb, twice_largest(rgb), false)))
    }

    /// The emission of a light given in linear sRGB, no component negative: [`Self::rgb_unbounded`] times D65. Scaled by 1 /
    /// [`Self::photometric`], the light has exactly the colour `rgb`.
    pub fn rgb_illuminant(rgb: [f32; 3]) -> Self {
        Self(Kind::Rgb(RgbSpectrum::new(rgb, twice_largest(rgb), true)))
    }

    /// This spectrum with its rgb taken as linear in `space` instead of sRGB; its white is what an rgb illuminant is multiplied by.
    /// Spectra that are not of an rgb stay as they are.
    #[must_use]
    pub fn in_space(self, space: ColorSpace) -> Self {
        match self.0 {
            Kind::Rgb(rgb) => Self(Kind::Rgb(RgbSpectrum {
                space,
                shape: OnceLock::new(),
                ..rgb
            })),
            kind => Self(kind),
        }
    }

    /// Values at wavelengths in nm, which increase strictly, linear between them. Without any the spectrum is zero.
    pub fn tabulated(points: Vec<(f32, f32)>, outside: Outside) -> Self {
        Self(Kind::Tabulated {
            points: points.into(),
            outside,
        })
    }

    /// Emission of a black body at a temperature in kelvin, scaled so that the largest value over all wavelengths is 1. Zero
    /// for a temperature that is not positive.
    pub fn blackbody(kelvin: f32) -> Self {
        Self(Kind::Blackbody { kelvin })
    }

    /// The CIE standard illuminant D65, with the luminance of a constant 1.
    pub fn illuminant_d65() -> Self {
        Self::of_named(named::find("stdillum-D65").expect("the tables have D65"))
    }

    /// The spectrum of this name: pbrt-v4's (`glass-BK7`, `metal-Au-k`, `stdillum-F2`), more metals (`metal-W-eta`) and glasses by
    /// Sellmeier's equation (`sellmeier-N-SF11`); [`named_spectra`] lists them all. Illuminants are scaled to the luminance of a constant 1.
    ///
    /// [`named_spectra`]: super::named_spectra
    pub fn named(name: &str) -> Option<Self> {
        named::find(name).map(Self::of_named)
    }

    fn of_named(table: &named::Named) -> Self {
        Self(Kind::Tabulated {
            points: table.points.clone(),
            outside: table.outside,
        })
    }

    /// The value at a wavelength in nm.
    pub fn value(&self, nm: f32) -> f32 {
        match &self.0 {
            Kind::Constant(value) => *value,
            Kind::Rgb(rgb) => rgb.value(nm),
            Kind::Tabulated { points, outside } => interpolate(points, *outside, nm),
            Kind::Blackbody { kelvin } => blackbody(nm, *kelvin),
        }
    }

    /// The integral of ȳ times the spectrum, the luminance in units where K_m is left out. For an rgb illuminant it is that
    /// of the white alone, without the colour, as in pbrt-v4: lights divide by it, and an rgb light keeps the brightness of its rgb.
    pub fn photometric(&self) -> f32 {
        match &self.0 {
            Kind::Rgb(rgb) if rgb.illuminant => cie::integrate_y(|nm| rgb.space.illuminant().at(nm)) as f32,
            _ => self.luminance(),
        }
    }

    /// The integral of ȳ times the whole spectrum.
    pub(super) fn luminance(&self) -> f32 {
        cie::integrate_y(|nm| self.value(nm)) as f32
    }

    /// The largest value over 360 to 830 nm, looked at in steps of 1 nm.
    pub fn max_value(&self) -> f32 {
        match &self.0 {
            Kind::Constant(value) => *value,
            _ => self.dense().values().iter().copied().fold(f32::NEG_INFINITY, f32::max),
        }
    }

    pub(super) fn dense(&self) -> DenseTable {
        DenseTable::from_fn(|nm| self.value(nm))
    }
}

fn twice_largest([r, g, b]: [f32; 3]) -> f32 {
    2.0 * r.max(g).max(b)
}

/// The piecewise linear function through `points` at `nm`.
pub(super) fn interpolate(points: &[(f32, f32)], outside: Outside, nm: f32) -> f32 {
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else {
        return 0.0;
    };
    if nm < first.0 || nm > last.0 {
        let nearest = if nm < first.0 { first.1 } else { last.1 };
        return match outside {
            Outside::Zero => 0.0,
            Outside::Constant => nearest,
        };
    }
    let above = points.partition_point(|p| p.0 <= nm);
    if above == points.len() {
        return last.1;
    }
    let ((x0, y0), (x1, y1)) = (points[above.saturating_sub(1)], points[above]);
    let t = (nm - x0) / (x1 - x0);
    y0 + (y1 - y0) * t
}

/// Planck's law over its largest value at this temperature.
fn blackbody(nm: f32, kelvin: f32) -> f32 {
    /// hc / k, in nm K.
    const SECOND_RADIATION: f64 = 1.438_776_877e7;
    /// Wien's displacement constant, in nm K.
    const WIEN: f64 = 2.897_771_955e6;
    let kelvin = f64::from(kelvin);
    if kelvin.is_nan() || kelvin <= 0.0 {
        return 0.0;
    }
    let planck = |nm: f64| 1.0 / (nm.powi(5) * (SECOND_RADIATION / (nm * kelvin)).exp_m1());
    (planck(f64::from(nm)) / planck(WIEN / kelvin)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::{LAMBDA_D, named_spectra};

    #[test]
    fn tables_are_linear_inside_and_as_told_outside() {
        let points = vec![(400.0, 1.0), (500.0, 3.0), (600.0, 0.0)];
        let zero = Spectrum::tabulated(points.clone(), Outside::Zero);
        let constant = Spectrum::tabulated(points, Outside::Constant);
        for (nm, expected) in [(400.0, 1.0), (450.0, 2.0), (500.0, 3.0), (575.0, 0.75), (600.0, 0.0)] {
            assert_eq!(zero.value(nm), expected);
            assert_eq!(constant.value(nm), expected);
        }
        assert_eq!((zero.value(399.0), constant.value(399.0)), (0.0, 1.0));
        assert_eq!((zero.value(601.0), constant.value(601.0)), (0.0, 0.0));
        assert_eq!(Spectrum::tabulated(vec![], Outside::Constant).value(500.0), 0.0);
        assert_eq!(
            Spectrum::tabulated(vec![(500.0, 2.0)], Outside::Constant).value(500.0),
            2.0
        );
        assert_eq!(zero.max_value(), 3.0);
    }

    #[test]
    fn named_spectra_have_their_known_values() {
        let bk7 = Spectrum::named("glass-BK7").expect("known");
        assert!((bk7.value(LAMBDA_D) - 1.5168).abs() < 1e-4);
        assert_eq!(Spectrum::named("metal-Cu-eta").expect("known").value(302.4), 1.38);
        assert!(Spectrum::named("glass-BK8").is_none());
        assert_eq!(named_spectra().count(), 37 + 2 * 2 + 10);
        for name in named_spectra() {
            let spectrum = Spectrum::named(name).expect("listed");
            assert!(spectrum.max_value() > 0.0, "{name}");
            if name.contains("illum") {
                assert!(
                    (spectrum.photometric() / cie::y_integral() - 1.0).abs() < 1e-5,
                    "{name}"
                );
            }
        }
    }

    /// Catalogues print the index at the d line.
    #[test]
    fn sellmeier_glasses_have_their_index_at_the_d_line() {
        for (glass, n_d) in [
            ("N-BK7", 1.51680),
            ("N-SF11", 1.78472),
            ("N-LAK14", 1.69680),
            ("N-FK51A", 1.48656),
            ("fused-silica", 1.45846),
            ("diamond", 2.4175),
        ] {
            let found = Spectrum::named(&format!("sellmeier-{glass}")).map(|s| s.value(LAMBDA_D));
            assert!(
                found.is_some_and(|n| (n - n_d).abs() < 3e-4),
                "{glass}: {found:?} and {n_d}"
            );
        }
    }

    /// The lights of a wide space have their colour in it, and white is the space's own.
    #[test]
    fn rgb_lights_of_wide_spaces_have_their_colour() {
        for space in ColorSpace::ALL {
            for rgb in [[1.0, 1.0, 1.0], [3.0, 2.0, 1.0], [0.4, 0.7, 0.5]] {
                let light = Spectrum::rgb_illuminant(rgb).in_space(space);
                let xyz = cie::integrate_xyz(|nm| light.value(nm) / light.photometric());
                for (a, b) in space.xyz_to_rgb(xyz).iter().zip(rgb) {
                    assert!((a - f64::from(b)).abs() < 1e-5, "{space:?} {rgb:?}: {a}");
                }
            }
        }
    }

    #[test]
    fn blackbodies_peak_where_wien_says() {
        for kelvin in [3600.0, 5000.0, 6504.0, 7900.0] {
            let body = Spectrum::blackbody(kelvin);
            let peak = 2.897_772e6 / kelvin;
            assert!((body.value(peak) - 1.0).abs() < 1e-6);
            assert!(body.value(peak - 5.0) < 1.0 && body.value(peak + 5.0) < 1.0);
        }
        // The ratio of two wavelengths by Planck's law, worked out by hand at 4000 K:
        // (700/450)^5 (exp(c2 / (700 T)) - 1) / (exp(c2 / (450 T)) - 1) = 9.1088 x 169.47 / 2963.4.
        let body = Spectrum::blackbody(4000.0);
        assert!((body.value(450.0) / body.value(700.0) - 0.5209).abs() < 1e-3);
        assert_eq!(Spectrum::blackbody(0.0).value(500.0), 0.0);
    }

    #[test]
    fn greys_are_exact() {
        for grey in [0.0, 0.18, 0.5, 1.0] {
            let albedo = Spectrum::rgb_albedo([grey; 3]);
            assert!([360.0, 500.0, 830.0].iter().all(|&nm| albedo.value(nm) == grey));
            assert_eq!(Spectrum::rgb_unbounded([grey; 3]).value(500.0), grey);
        }
        let white = Spectrum::rgb_illuminant([1.0; 3]);
        assert_eq!(white.value(560.0), Spectrum::illuminant_d65().value(560.0));
    }

    #[test]
    fn rgb_lights_have_their_colour() {
        for rgb in [[1.0, 1.0, 1.0], [17.0, 12.0, 4.0], [0.0, 0.3, 1.0], [0.0; 3]] {
            let light = Spectrum::rgb_illuminant(rgb);
            let xyz = cie::integrate_xyz(|nm| light.value(nm) / light.photometric());
            for (a, b) in cie::xyz_to_srgb(xyz).iter().zip(rgb) {
                assert!((a - f64::from(b)).abs() < 2e-6 * 17.0, "{rgb:?}: {a}");
            }
        }
    }
}
