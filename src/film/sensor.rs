//! From spectral radiance to the linear RGB of a picture, as in pbrt-v4.
//!
//! A sensor integrates radiance over wavelength by three responses: of the CIE 1931 observer (XYZ), or of the pixels of a camera. A
//! matrix takes what they say to XYZ. For the observer it is a white balance by the Bradford transform, if one is asked for; for a
//! camera it is fitted by least squares so that the patches of a ColorChecker under the light that the camera is balanced for
//! look as they do under the white of the picture's colour space. Another matrix goes on to that space.

use std::sync::Arc;

use glam::{DMat3, DVec3, Mat3, Vec3};

use crate::spectrum::{
    ColorMode, ColorSpace, ResponseTable, SampledSpectrum, Spectrum, Wavelengths, cie, color_checker, daylight,
};

/// What a film records of light.
#[derive(Clone, Debug)]
pub struct SensorSpec {
    /// Of red, green and blue pixels; `None` is the CIE 1931 observer.
    pub curves: Option<[Spectrum; 3]>,
    /// The temperature, in kelvin, of the daylight that is to look white. `None`: no balance for the observer, 6500 K for a camera.
    pub white_balance: Option<f64>,
    /// Of the picture.
    pub color_space: ColorSpace,
    /// What radiance is multiplied by; see [`crate::desc::FilmDesc::imaging_ratio`].
    pub imaging_ratio: f64,
    /// Samples whose largest sensor value (for the observer: of X, Y, Z) exceeds this are scaled down to it; positive, may be infinite.
    pub max_component: f64,
}

/// A [`SensorSpec`] ready for one colour mode.
#[derive(Clone, Debug)]
pub struct Sensor {
    response: Response,
    /// From the sensor's values to the picture's, the imaging ratio included.
    rgb_from_sensor: Mat3,
    imaging_ratio: f32,
    max_component: f32,
    color_space: ColorSpace,
}

/// A [`Sensor`] of rgb mode.
#[derive(Clone, Copy, Debug)]
pub struct LinearSensor {
    response: Mat3,
    rgb_from_sensor: Mat3,
    imaging_ratio: f32,
    max_component: f32,
}

#[derive(Clone, Debug)]
enum Response {
    /// Rgb mode: a matrix from linear sRGB.
    Lanes(Mat3),
    Observer,
    Curves(Arc<[ResponseTable; 3]>),
}

impl Sensor {
    /// A sensor for spectral or rgb transport. Colours of rgb transport have no spectra: there a camera is an observer with the
    /// same white balance.
    ///
    /// # Errors
    /// A message if no matrix fits the curves of a camera: they are not independent of each other, or see nothing.
    pub fn new(mode: ColorMode, spec: &SensorSpec) -> Result<Self, String> {
        let target = spec.color_space;
        let balanced = |kelvin: Option<f64>| kelvin.map_or(DMat3::IDENTITY, |kelvin| white_balance(kelvin, target));
        let camera_white = spec.white_balance.unwrap_or(6500.0);
        let (response, xyz_from_sensor) = match (mode, &spec.curves) {
            (ColorMode::Spectral, None) => (Response::Observer, balanced(spec.white_balance)),
            (ColorMode::Spectral, Some(curves)) => {
                let tables = curves.each_ref().map(ResponseTable::new);
                let matrix = fit(&tables, camera_white, target)
                    .ok_or("the sensor's responses are zero or not independent: no colours can be told from them")?;
                (Response::Curves(Arc::new(tables)), matrix)
            }
            (ColorMode::Rgb, curves) => {
                let kelvin = spec.white_balance.or(curves.as_ref().map(|_| camera_white));
                let xyz_from_lanes = ColorSpace::Srgb.xyz_from_rgb();
                (Response::Lanes(xyz_from_lanes.as_mat3()), balanced(kelvin))
            }
        };
        let ratio = spec.imaging_ratio;
        let mut sensor = Self {
            response,
            rgb_from_sensor: (target.rgb_from_xyz() * xyz_from_sensor * ratio).as_mat3(),
            imaging_ratio: ratio as f32,
            max_component: spec.max_component as f32,
            color_space: target,
        };
        if mode == ColorMode::Rgb && sensor.max_component == f32::INFINITY {
            // Nobody asks for XYZ on the way, and sRGB of sRGB is exactly the same.
            let through = target.rgb_from_xyz() * xyz_from_sensor * ColorSpace::Srgb.xyz_from_rgb();
            let same = through.abs_diff_eq(DMat3::IDENTITY, 1e-12);
            let through = if same { DMat3::IDENTITY } else { through };
            sensor.response = Response::Lanes(Mat3::IDENTITY);
            sensor.rgb_from_sensor = (through * ratio).as_mat3();
        }
        Ok(sensor)
    }

    /// Linear RGB, in the picture's colour space, of the spectral radiance `l` of one sample: an estimate of its integral against the
    /// responses. Negative where the colour lies outside of the space.
    #[inline]
    pub fn to_rgb(&self, l: SampledSpectrum, lambda: &Wavelengths) -> [f32; 3] {
        self.to_rgb_within(l, lambda, self.max_component)
    }

    /// The same of what a light path brings to a picture of `pixels` pixels, for a unit area of film. Where there are as many light paths
    /// as camera samples, a `pixels`-th of it counts as much as a sample: that is what the limit is for, as in pbrt-v4.
    #[inline]
    pub fn splat_to_rgb(&self, l: SampledSpectrum, lambda: &Wavelengths, pixels: f32) -> [f32; 3] {
        self.to_rgb_within(l, lambda, self.max_component * pixels)
    }

    /// Linear RGB, in the picture's colour space, of a reflectance at the wavelengths of a path under the white of that space.
    pub fn albedo_to_rgb(&self, albedo: SampledSpectrum, lambda: &Wavelengths) -> [f32; 3] {
        let space = self.color_space;
        let rgb = if let Response::Lanes(_) = self.response {
            let [r, g, b, _] = albedo.0.map(f64::from);
            if space == ColorSpace::Srgb {
                return [r, g, b].map(|c| c as f32);
            }
            space.rgb_from_xyz() * ColorSpace::Srgb.xyz_from_rgb() * DVec3::new(r, g, b)
        } else {
            let white = SampledSpectrum(lambda.lambda.map(|nm| space.white_at(nm)));
            let light = (albedo * white).safe_div(lambda.pdf());
            let xyz = cie::xyz_bar(lambda).map(|bar| f64::from((bar * light).mean() / cie::y_integral()));
            space.rgb_from_xyz() * DVec3::from(xyz)
        };
        rgb.as_vec3().into()
    }

    /// Radiance within the limit of the sensor's values.
    pub fn limit(&self, l: SampledSpectrum) -> SampledSpectrum {
        let largest = l.max_value();
        if largest > self.max_component {
            l * (self.max_component / largest)
        } else {
            l
        }
    }

    /// It for kernels, if it looks at no wavelengths.
    #[inline]
    pub fn linear(&self) -> Option<LinearSensor> {
        match self.response {
            Response::Lanes(response) => Some(LinearSensor {
                response,
                rgb_from_sensor: self.rgb_from_sensor,
                imaging_ratio: self.imaging_ratio,
                max_component: self.max_component,
            }),
            Response::Observer | Response::Curves(_) => None,
        }
    }

    #[inline]
    fn to_rgb_within(&self, l: SampledSpectrum, lambda: &Wavelengths, max_component: f32) -> [f32; 3] {
        let sensor = match &self.response {
            Response::Lanes(matrix) => from_lanes(matrix, l),
            Response::Observer => {
                let l = l.safe_div(lambda.pdf());
                cie::xyz_bar(lambda).map(|bar| (bar * l).mean()).into()
            }
            Response::Curves(tables) => {
                let l = l.safe_div(lambda.pdf());
                tables.each_ref().map(|table| (table.sample(lambda) * l).mean()).into()
            }
        };
        limited(sensor, self.imaging_ratio, max_component, &self.rgb_from_sensor).into()
    }
}

impl LinearSensor {
    /// [`Sensor::to_rgb`] at any wavelengths.
    #[inline(always)]
    pub fn to_rgb(&self, l: SampledSpectrum) -> Vec3 {
        let sensor = from_lanes(&self.response, l);
        limited(sensor, self.imaging_ratio, self.max_component, &self.rgb_from_sensor)
    }
}

/// What the sensor says of the lanes of rgb mode.
#[inline(always)]
fn from_lanes(response: &Mat3, l: SampledSpectrum) -> Vec3 {
    *response * Vec3::new(l.0[0], l.0[1], l.0[2])
}

/// Linear RGB of what the sensor says, which is scaled down if it says too much.
#[inline(always)]
fn limited(sensor: Vec3, imaging_ratio: f32, max_component: f32, rgb_from_sensor: &Mat3) -> Vec3 {
    let largest = sensor.max_element() * imaging_ratio;
    let scale = if largest > max_component {
        max_component / largest
    } else {
        1.0
    };
    *rgb_from_sensor * (sensor * scale)
}

/// From XYZ to XYZ: what has the colour of daylight of a temperature gets that of the white of a space. Bradford's cone responses, as
/// in pbrt-v4.
fn white_balance(kelvin: f64, target: ColorSpace) -> DMat3 {
    let cones_from_xyz = DMat3::from_cols(
        DVec3::new(0.8951, -0.7502, 0.0389),
        DVec3::new(0.2664, 1.7135, -0.0685),
        DVec3::new(-0.1614, 0.0367, 1.0296),
    );
    let light = daylight(kelvin);
    let source = DVec3::from(cie::integrate_xyz(|nm| light.value(nm)));
    let white = DVec3::from(target.rgb_to_xyz([1.0; 3]));
    let scale = (cones_from_xyz * white) / (cones_from_xyz * (source / source.y));
    cones_from_xyz.inverse() * DMat3::from_diagonal(scale) * cones_from_xyz
}

/// The matrix from what a camera sees of patches under its own light to their XYZ under the white of a space, least squares of all.
/// Both are scaled as pbrt-v4 does: the light itself keeps its luminance. `None` if there is none.
fn fit(curves: &[ResponseTable; 3], kelvin: f64, target: ColorSpace) -> Option<DMat3> {
    let light = daylight(kelvin);
    let sums = |response: &dyn Fn(f32) -> DVec3| -> DVec3 { (360..=830).map(|nm| response(nm as f32)).sum() };
    let seen = |nm: f32| DVec3::from(curves.each_ref().map(|curve| f64::from(curve.at(nm))));
    let white_seen = sums(&|nm| seen(nm) * f64::from(light.value(nm)));
    let white_y = cie::integrate_y(|nm| light.value(nm));
    let target_y = cie::integrate_y(|nm| target.white_at(nm));
    let (mut normal, mut right) = (DMat3::ZERO, DMat3::ZERO);
    for patch in color_checker() {
        let camera = sums(&|nm| seen(nm) * f64::from(light.value(nm) * patch.value(nm))) / white_seen.y;
        let xyz = cie::integrate_xyz(|nm| target.white_at(nm) * patch.value(nm));
        let xyz = DVec3::from(xyz) / target_y * (white_y / white_seen.y);
        let outer = |a: DVec3, b: DVec3| DMat3::from_cols(a * b.x, a * b.y, a * b.z);
        normal += outer(camera, camera);
        right += outer(xyz, camera);
    }
    // By Hadamard's inequality the determinant is at most the product of the diagonal.
    let diagonal = normal.x_axis.x * normal.y_axis.y * normal.z_axis.z;
    let independent = normal.is_finite() && right.is_finite() && normal.determinant() > 1e-12 * diagonal;
    independent.then(|| right * normal.inverse())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::{Outside, sensor_curves, sensor_names};

    const PLAIN: SensorSpec = SensorSpec {
        curves: None,
        white_balance: None,
        color_space: ColorSpace::Srgb,
        imaging_ratio: 1.0,
        max_component: f64::INFINITY,
    };

    /// What a sensor makes of a spectrum, without noise.
    fn seen(sensor: &Sensor, spectrum: &Spectrum) -> [f64; 3] {
        const STEPS: usize = 1 << 12;
        let mut sum = [0.0; 3];
        for i in 0..STEPS {
            let lambda = Wavelengths::sample_visible((i as f32 + 0.5) / STEPS as f32);
            let l = SampledSpectrum(lambda.lambda.map(|nm| spectrum.value(nm)));
            for (sum, c) in sum.iter_mut().zip(sensor.to_rgb(l, &lambda)) {
                *sum += f64::from(c) / STEPS as f64;
            }
        }
        sum
    }

    fn spectral(spec: &SensorSpec) -> Sensor {
        Sensor::new(ColorMode::Spectral, spec).expect("independent curves")
    }

    #[test]
    fn white_balance_makes_daylight_white() {
        for space in ColorSpace::ALL {
            for kelvin in [2800.0, 5000.0, 6500.0, 9000.0] {
                let sensor = spectral(&SensorSpec {
                    white_balance: Some(kelvin),
                    color_space: space,
                    ..PLAIN
                });
                let rgb = seen(&sensor, &daylight(kelvin)).map(|c| c / f64::from(cie::y_integral()));
                assert!(
                    rgb.iter().all(|c| (c - 1.0).abs() < 2e-3),
                    "{space:?} at {kelvin}: {rgb:?}"
                );
            }
        }
    }

    /// Cameras see greys as grey and as bright as the observer does, and colours as well as three responses can.
    #[test]
    fn cameras_are_calibrated() {
        for name in sensor_names() {
            for kelvin in [3200.0, 6500.0] {
                let light = daylight(kelvin);
                let sensor = spectral(&SensorSpec {
                    curves: sensor_curves(name),
                    white_balance: Some(kelvin),
                    ..PLAIN
                });
                let mut squares = 0.0;
                for patch in color_checker() {
                    let points = (360..=830).map(|nm| (nm as f32, patch.value(nm as f32) * light.value(nm as f32)));
                    let rgb = seen(&sensor, &Spectrum::tabulated(points.collect(), Outside::Zero));
                    let white = ColorSpace::Srgb;
                    let expected = cie::integrate_xyz(|nm| patch.value(nm) * white.white_at(nm));
                    let expected = cie::xyz_to_srgb(expected);
                    for (a, b) in rgb.iter().zip(expected) {
                        squares += ((a - b) / f64::from(cie::y_integral())).powi(2) / 72.0;
                    }
                }
                assert!(squares.sqrt() < 0.06, "{name} at {kelvin}: {}", squares.sqrt());
            }
        }
    }

    /// Responses that are mixtures of the observer's see all colours as it does.
    #[test]
    fn a_camera_that_is_an_observer_sees_what_the_observer_sees() {
        let bar = |weights: [f32; 3]| {
            let points = (360..=830).map(|nm| {
                let lambda = Wavelengths {
                    lambda: [nm as f32; 4],
                    pdf: [1.0; 4],
                };
                let bars = cie::xyz_bar(&lambda).map(|bar| bar.0[0]);
                (nm as f32, bars.iter().zip(weights).map(|(bar, w)| bar * w).sum())
            });
            Spectrum::tabulated(points.collect(), Outside::Zero)
        };
        let curves = [bar([0.3, 0.1, 0.0]), bar([0.0, 0.2, 0.1]), bar([0.1, 0.0, 0.3])];
        let camera = spectral(&SensorSpec {
            curves: Some(curves),
            ..PLAIN
        });
        let observer = spectral(&PLAIN);
        for spectrum in [Spectrum::blackbody(4000.0), Spectrum::rgb_illuminant([0.2, 0.9, 0.4])] {
            let (a, b) = (seen(&camera, &spectrum), seen(&observer, &spectrum));
            let largest = b.iter().copied().fold(0.0, f64::max);
            // 6500 K is D65 to four digits.
            assert!(
                a.iter().zip(b).all(|(a, b)| (a - b).abs() < 2e-3 * largest),
                "{a:?} and {b:?}"
            );
        }
    }

    #[test]
    fn dependent_curves_are_refused() {
        let [r, g, _] = sensor_curves("nikon_d810").expect("known");
        for curves in [[r.clone(), g.clone(), g], [r.clone(), r, Spectrum::constant(0.0)]] {
            let spec = SensorSpec {
                curves: Some(curves),
                ..PLAIN
            };
            assert!(Sensor::new(ColorMode::Spectral, &spec).is_err());
        }
    }

    #[test]
    fn bright_samples_are_scaled_down_to_the_largest_value() {
        for mode in [ColorMode::Spectral, ColorMode::Rgb] {
            let lambda = match mode {
                ColorMode::Spectral => Wavelengths::sample_visible(0.3),
                ColorMode::Rgb => Wavelengths::rgb(),
            };
            let at_most = |max_component: f64| {
                let spec = SensorSpec {
                    max_component,
                    imaging_ratio: 2.0,
                    ..PLAIN
                };
                let sensor = Sensor::new(mode, &spec).expect("an observer");
                sensor.to_rgb(SampledSpectrum([5.0, 4.0, 2.0, 1.0]), &lambda)
            };
            let (free, limited) = (at_most(f64::INFINITY), at_most(1.5));
            let xyz = ColorSpace::Srgb.rgb_to_xyz(limited.map(f64::from));
            let largest = xyz.into_iter().fold(0.0, f64::max);
            assert!((largest - 1.5).abs() < 1e-5, "{mode:?}: {xyz:?}");
            // The colour stays.
            assert!((free[0] / free[1] - limited[0] / limited[1]).abs() < 1e-4, "{mode:?}");
            let wide = at_most(1e9);
            assert!(
                wide.iter().zip(free).all(|(a, b)| (a - b).abs() < 1e-4 * b.abs()),
                "{wide:?} {free:?}"
            );
        }
    }

    #[test]
    fn modes_agree_on_the_white_of_the_picture() {
        for space in ColorSpace::ALL {
            let spec = SensorSpec {
                color_space: space,
                white_balance: Some(4500.0),
                ..PLAIN
            };
            let white = Spectrum::illuminant_d65();
            let rgb_mode = Sensor::new(ColorMode::Rgb, &spec).expect("an observer");
            let y = cie::y_integral();
            let rgb = rgb_mode.to_rgb(SampledSpectrum([y, y, y, 0.0]), &Wavelengths::rgb());
            for (a, b) in seen(&spectral(&spec), &white).iter().zip(rgb) {
                assert!((a / f64::from(b) - 1.0).abs() < 2e-3, "{space:?}: {a} and {b}");
            }
        }
    }
}
