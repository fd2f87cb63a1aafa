//! Measured materials (Dupuy and Jakob 2018): reflection in a parameterisation that follows the facets.
//!
//! The direction of the path, `wo`, is the one that the tables are indexed by; measured data are reciprocal up to their noise.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_2, PI};

use super::conductor::reflect;
use super::measured_warp::{DensityTable, Table};
use super::{LocalSample, LocalValue};
use crate::desc::{MeasuredDesc, Tensor};
use crate::math::{Vec2, Vec3};
use crate::spectrum::{ColorMode, LANES, SampledSpectrum, Spectrum, SpectrumRole, Wavelengths};

/// The tables of a material, for one colour mode.
#[derive(Clone, Debug)]
pub struct MeasuredTables {
    isotropic: bool,
    mode: ColorMode,
    ndf: Table,
    sigma: Table,
    vndf: DensityTable,
    luminance: DensityTable,
    /// By azimuth, polar angle and wavelength; in rgb mode the last counts channels.
    spectra: Table,
}

/// A measured material at the wavelengths of a path.
#[derive(Clone, Copy, Debug)]
pub struct Measured<'a> {
    tables: &'a MeasuredTables,
    /// Where in the tables of spectra the lanes are.
    lanes: [f32; LANES],
}

fn grid(tensor: &Tensor) -> [usize; 2] {
    let axes = tensor.shape.len();
    [tensor.shape[axes - 2], tensor.shape[axes - 1]]
}

impl MeasuredTables {
    /// From a description.
    pub fn new(desc: &MeasuredDesc, mode: ColorMode) -> Self {
        let plain = |tensor: &Tensor| Table::new(grid(tensor), Vec::new(), tensor.values.clone());
        let density = |tensor: &Tensor| {
            let values = tensor.values.iter().map(|v| v.max(0.0)).collect();
            let parameters = vec![desc.phi.clone(), desc.theta.clone()];
            DensityTable::new(Table::new(grid(tensor), parameters, values))
        };
        Self {
            isotropic: desc.phi.len() <= 2,
            mode,
            ndf: plain(&desc.ndf),
            sigma: plain(&desc.sigma),
            vndf: density(&desc.vndf),
            luminance: density(&desc.luminance),
            spectra: spectra(desc, mode),
        }
    }
}

/// The reflectances; in rgb mode turned into three channels under the film's white.
fn spectra(desc: &MeasuredDesc, mode: ColorMode) -> Table {
    let mut parameters = vec![desc.phi.clone(), desc.theta.clone()];
    let [rows, columns] = grid(&desc.spectra);
    let (area, lines) = (rows * columns, desc.wavelengths.len());
    if mode == ColorMode::Spectral {
        parameters.push(desc.wavelengths.clone());
        return Table::new([rows, columns], parameters, desc.spectra.values.clone());
    }
    parameters.push(vec![0.0, 1.0, 2.0]);
    let mut values = Vec::new();
    for slices in desc.spectra.values.chunks_exact(lines * area) {
        let start = values.len();
        values.resize(start + 3 * area, 0.0);
        for cell in 0..area {
            let samples = desc.wavelengths.iter().enumerate();
            let samples = samples.map(|(line, &nm)| (nm, slices[line * area + cell].max(0.0)));
            let spectrum = Spectrum::tabulated(samples.collect(), crate::spectrum::Outside::Constant);
            let rgb = spectrum
                .compile(mode, SpectrumRole::Reflectance)
                .sample(&Wavelengths::rgb());
            for channel in 0..3 {
                values[start + channel * area + cell] = rgb.0[channel].max(0.0);
            }
        }
    }
    Table::new([rows, columns], parameters, values)
}

/// The unit square of directions: u = sqrt(2 theta / pi), v = phi / 2 pi + 1 / 2, modulo 1.
fn square(w: Vec3, azimuth: f32) -> Vec2 {
    // The polar angle with digits left near the pole.
    let theta = w.truncate().length().atan2(w.z);
    let v = 0.5 + 0.5 * FRAC_1_PI * azimuth;
    Vec2::new((theta / FRAC_PI_2).max(0.0).sqrt(), v - v.floor())
}

impl<'a> Measured<'a> {
    /// For the wavelengths of a path.
    pub fn new(tables: &'a MeasuredTables, lambda: &Wavelengths) -> Self {
        let lanes = match tables.mode {
            ColorMode::Spectral => lambda.lambda,
            ColorMode::Rgb => [0.0, 1.0, 2.0, -1.0],
        };
        Self { tables, lanes }
    }

    /// See [`Bsdf::eval`](super::Bsdf::eval).
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Option<LocalValue> {
        if wo.z * wi.z <= 0.0 {
            return None;
        }
        let (wo, wi) = if wo.z < 0.0 { (-wo, -wi) } else { (wo, wi) };
        let m = (wo + wi).try_normalize()?;
        let phi = wo.y.atan2(wo.x);
        let phi_m = m.y.atan2(m.x) - if self.tables.isotropic { phi } else { 0.0 };
        let u_m = square(m, phi_m);
        let vndf = self.tables.vndf.slices(&[phi, polar(wo)]);
        let u = self.tables.vndf.invert(&vndf, u_m);
        let density = self.tables.vndf.pdf(&vndf, u_m);
        Some(self.value(wo, wi, m, u_m, u, density))
    }

    /// Value and density where the sample `u` is, with the density `visible`, the normal at `u_m`.
    fn value(&self, wo: Vec3, wi: Vec3, m: Vec3, u_m: Vec2, u: Vec2, visible: f32) -> LocalValue {
        let tables = self.tables;
        let (phi, theta) = (wo.y.atan2(wo.x), polar(wo));
        let none = tables.ndf.slices(&[]);
        let area = tables.sigma.at(&none, square(wo, phi)).max(1e-6);
        let scale = tables.ndf.at(&none, u_m) / (4.0 * area * wi.z);
        let reflectance = self.lanes.map(|lane| {
            if lane < 0.0 {
                return 0.0;
            }
            let slices = tables.spectra.slices(&[phi, theta, lane]);
            tables.spectra.at(&slices, u).max(0.0)
        });
        let luminance = tables.luminance.pdf(&tables.luminance.slices(&[phi, theta]), u);
        let sin = m.truncate().length();
        let jacobian = 4.0 * wo.dot(m) * (2.0 * PI * PI * u_m.x * sin).max(1e-6);
        LocalValue {
            f: SampledSpectrum(reflectance) * scale,
            pdf: visible * luminance / jacobian,
        }
    }

    /// See [`Bsdf::sample_f`](super::Bsdf::sample_f).
    pub fn sample_f(&self, wo: Vec3, u: Vec2) -> Option<LocalSample> {
        let flip = if wo.z < 0.0 { -1.0 } else { 1.0 };
        let wo = wo * flip;
        let at = [wo.y.atan2(wo.x), polar(wo)];
        let u = self.tables.luminance.sample(&self.tables.luminance.slices(&at), u);
        let vndf = self.tables.vndf.slices(&at);
        let u_m = self.tables.vndf.sample(&vndf, u);
        let theta = u_m.x * u_m.x * FRAC_PI_2;
        let phi = (2.0 * u_m.y - 1.0) * PI + if self.tables.isotropic { at[0] } else { 0.0 };
        let (sin, cos) = theta.sin_cos();
        let m = Vec3::new(sin * phi.cos(), sin * phi.sin(), cos);
        let wi = reflect(wo, m);
        if wi.z <= 0.0 || wo.dot(m) <= 0.0 {
            return None;
        }
        let value = self.value(wo, wi, m, u_m, u, self.tables.vndf.pdf(&vndf, u_m));
        (value.pdf > 0.0).then(|| LocalSample::continuous(value, wi * flip, 1.0))
    }
}

/// The angle to the normal.
fn polar(w: Vec3) -> f32 {
    w.truncate().length().atan2(w.z)
}
