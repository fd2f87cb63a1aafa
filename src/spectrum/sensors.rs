//! What film sensors are made of: the responses of cameras, the patches that their colours are fitted to, daylight.

use std::sync::LazyLock;

use super::cie::{self, DenseTable};
use super::{Outside, SampledSpectrum, Spectrum, Wavelengths};

/// A response over wavelength, by nm from 360 to 830, constant around each.
#[derive(Clone, Debug, PartialEq)]
pub struct ResponseTable(DenseTable);

impl ResponseTable {
    /// The table of a spectrum.
    pub fn new(spectrum: &Spectrum) -> Self {
        Self(spectrum.dense())
    }

    /// The value at the nm nearest to `lambda`; beyond the ends that of the end.
    pub fn at(&self, lambda: f32) -> f32 {
        self.0.at(lambda)
    }

    /// The values at the wavelengths of a path.
    #[inline]
    pub fn sample(&self, wavelengths: &Wavelengths) -> SampledSpectrum {
        self.0.sample(wavelengths)
    }
}

/// The message of a table that cannot be read, which no input can cause.
const VALID: &str = "the table that is compiled in is valid";

/// A tabulated function and its key.
type Function = (&'static str, Vec<(f32, f32)>);

/// Rows of (first fields, then wavelength and value), as one tabulated function for each run of equal first fields.
fn functions(table: &'static str) -> Vec<Function> {
    let mut functions: Vec<Function> = Vec::new();
    for row in table.lines().skip(1) {
        let (rest, value) = row.rsplit_once(',').expect(VALID);
        let (key, nm) = rest.rsplit_once(',').expect(VALID);
        let point = (nm.parse().expect(VALID), value.parse().expect(VALID));
        match functions.last_mut() {
            Some((last, points)) if *last == key => points.push(point),
            _ => functions.push((key, vec![point])),
        }
    }
    functions
}

/// By name and channel: `canon_eos_5d,r`.
static SENSORS: LazyLock<Vec<Function>> = LazyLock::new(|| functions(include_str!("data/camera_sensors.csv")));

/// The cameras that a film may be: pbrt-v4's names of sensors, without `cie1931`.
pub fn sensor_names() -> impl Iterator<Item = &'static str> {
    SENSORS.iter().filter_map(|(key, _)| key.strip_suffix(",r"))
}

/// The responses of a camera's red, green and blue pixels over wavelength, in a common unit; zero outside their tables. `None` if
/// there is no camera of that name.
pub fn sensor_curves(name: &str) -> Option<[Spectrum; 3]> {
    let curve = |channel: &str| {
        let of_channel = |key: &str| key.strip_suffix(channel).and_then(|k| k.strip_suffix(',')) == Some(name);
        let (_, points) = SENSORS.iter().find(|(key, _)| of_channel(key))?;
        Some(Spectrum::tabulated(points.clone(), Outside::Zero))
    };
    Some([curve("r")?, curve("g")?, curve("b")?])
}

/// The reflectances of the 24 patches of a ColorChecker, the colours by which a camera is calibrated; zero outside 380 to 730 nm,
/// as in pbrt-v4.
pub fn color_checker() -> Vec<Spectrum> {
    let patches = functions(include_str!("data/color_checker_10nm.csv")).into_iter();
    patches
        .map(|(_, points)| Spectrum::tabulated(points, Outside::Zero))
        .collect()
}

/// The phase of daylight of a nominal temperature in kelvin (CIE 15), scaled to the luminance of a constant 1; below 4000 K, where
/// daylight is not defined, a black body. As in pbrt-v4 the nominal temperature is that of a time when the constant of
/// radiation was less well known: 6500 K is D65.
///
/// Zero for a temperature that is not positive.
pub fn daylight(kelvin: f64) -> Spectrum {
    let kelvin = kelvin * 1.4388 / 1.4380;
    let spectrum = if kelvin < 4000.0 {
        Spectrum::blackbody(kelvin as f32)
    } else {
        components(kelvin)
    };
    let scale = f64::from(cie::y_integral()) / f64::from(spectrum.photometric());
    let point = |nm: u16| {
        let nm = f32::from(nm);
        let value = (f64::from(spectrum.value(nm)) * scale) as f32;
        (nm, if value.is_finite() { value } else { 0.0 })
    };
    Spectrum::tabulated((360..=830).map(point).collect(), Outside::Zero)
}

/// The sum of the components of daylight for a correlated colour temperature.
fn components(kelvin: f64) -> Spectrum {
    let per = |power: i32| 1e3_f64.powi(power) / kelvin.powi(power);
    let x = if kelvin <= 7000.0 {
        -4.607 * per(3) + 2.9678 * per(2) + 0.09911 * per(1) + 0.244_063
    } else {
        -2.0064 * per(3) + 1.9018 * per(2) + 0.24748 * per(1) + 0.23704
    };
    let y = -3.0 * x * x + 2.87 * x - 0.275;
    let m = 0.0241 + 0.2562 * x - 0.7341 * y;
    let m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / m;
    let m2 = (0.03 - 31.4424 * x + 30.0717 * y) / m;
    let rows = include_str!("data/cie_daylight_components_5nm.csv").lines().skip(1);
    let point = |row: &str| {
        let mut fields = row.split(',').map(|field| field.parse::<f64>().expect(VALID));
        let [nm, s0, s1, s2] = [(); 4].map(|()| fields.next().expect(VALID));
        (nm as f32, (0.01 * (s0 + m1 * s1 + m2 * s2)).max(0.0) as f32)
    };
    Spectrum::tabulated(rows.map(point).collect(), Outside::Zero)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_tables_are_whole() {
        assert_eq!(sensor_names().count(), 17);
        for name in sensor_names() {
            let curves = sensor_curves(name).expect("listed");
            let peaks = curves.map(|curve| {
                (360..830)
                    .max_by(|&a, &b| curve.value(a as f32).total_cmp(&curve.value(b as f32)))
                    .unwrap_or(0)
            });
            assert!(peaks[0] > peaks[1] && peaks[1] > peaks[2], "{name}: {peaks:?}");
        }
        assert!(sensor_curves("canon_eos").is_none());
        let patches = color_checker();
        assert_eq!(patches.len(), 24);
        assert!(
            patches
                .iter()
                .all(|patch| patch.value(550.0) > 0.02 && patch.value(550.0) < 0.95)
        );
    }

    #[test]
    fn daylight_has_its_chromaticity() {
        // CIE 15 prints these for the 2 degree observer.
        for (kelvin, x, y) in [
            (5000.0, 0.3457, 0.3585),
            (6500.0, 0.3127, 0.3290),
            (7500.0, 0.2990, 0.3149),
        ] {
            let light = daylight(kelvin);
            let [a, b, c] = cie::integrate_xyz(|nm| light.value(nm));
            let (found_x, found_y) = (a / (a + b + c), b / (a + b + c));
            assert!(
                (found_x - x).abs() < 2e-4 && (found_y - y).abs() < 2e-4,
                "{kelvin}: {found_x}, {found_y}"
            );
            assert!((b / f64::from(cie::y_integral()) - 1.0).abs() < 1e-5);
        }
        // Warm light is redder.
        let warm = daylight(2856.0);
        assert!(warm.value(700.0) > 2.0 * warm.value(450.0));
    }
}
