//! The values of arguments: words that stand for kinds, and numbers in the forms that the command line has for them.

use std::ops::RangeInclusive;

use clap::ValueEnum;

use crate::accel::{Backend, BuildQuality};
use crate::desc::{Strategy, Term};
use crate::film::PixelRect;
use crate::integrator::ShownMap;
use crate::sampling::{SamplerKind, Strata};
use crate::spectrum::ColorMode;

/// What `lucerna list` knows of.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum ListKind {
    /// `Material`
    Materials,
    /// `MakeNamedMedium`
    Media,
    /// `LightSource`, `AreaLightSource`
    Lights,
    /// `Texture`
    Textures,
    /// `Sampler`
    Samplers,
    /// `Integrator`
    Integrators,
}

/// `--max-depth`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MaxDepth(pub Option<u32>);

/// `--strategy`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum StrategyArg {
    /// Directions drawn from BSDFs: lights without extent are not found
    Bsdf,
    /// Points of lights, but where a path is specular
    Light,
    /// Both, by multiple importance sampling
    Mis,
}

impl From<StrategyArg> for Strategy {
    fn from(arg: StrategyArg) -> Self {
        match arg {
            StrategyArg::Bsdf => Self::Bsdf,
            StrategyArg::Light => Self::Light,
            StrategyArg::Mis => Self::Mis,
        }
    }
}

/// One of `--terms`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum TermArg {
    /// Lights, and what they light straight
    Direct,
    /// The same, seen in mirrors and through glass
    Specular,
    /// What mirrors and glass throw on other surfaces
    Caustic,
    /// What other surfaces throw on each other
    Indirect,
}

impl From<TermArg> for Term {
    fn from(arg: TermArg) -> Self {
        match arg {
            TermArg::Direct => Self::Direct,
            TermArg::Specular => Self::Specular,
            TermArg::Caustic => Self::Caustic,
            TermArg::Indirect => Self::Indirect,
        }
    }
}

/// `--photon-map`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum PhotonMapArg {
    /// Of photons that come by way of mirrors and glass only
    Caustic,
    /// Of all photons
    Global,
}

impl From<PhotonMapArg> for ShownMap {
    fn from(arg: PhotonMapArg) -> Self {
        match arg {
            PhotonMapArg::Caustic => Self::Caustic,
            PhotonMapArg::Global => Self::Global,
        }
    }
}

/// `--sampler`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum SamplerArg {
    /// Independent random numbers
    Independent,
    /// A point in each cell of a grid
    Stratified,
    /// Owen-scrambled Halton points
    Halton,
    /// Owen-scrambled Sobol points
    Sobol,
    /// The same, with blue noise over the picture
    Zsobol,
}

impl From<SamplerArg> for SamplerKind {
    fn from(arg: SamplerArg) -> Self {
        match arg {
            SamplerArg::Independent => Self::Independent,
            SamplerArg::Stratified => Self::Stratified(Strata::default()),
            SamplerArg::Halton => Self::Halton,
            SamplerArg::Sobol => Self::Sobol,
            SamplerArg::Zsobol => Self::ZSobol,
        }
    }
}

/// `--color`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum ColorArg {
    /// Four wavelengths a path
    Spectral,
    /// Linear sRGB
    Rgb,
}

impl From<ColorArg> for ColorMode {
    fn from(arg: ColorArg) -> Self {
        match arg {
            ColorArg::Spectral => Self::Spectral,
            ColorArg::Rgb => Self::Rgb,
        }
    }
}

/// `--build-quality`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum QualityArg {
    /// Fast builds
    Low,
    /// In between
    Medium,
    /// Fast queries
    High,
}

impl From<QualityArg> for BuildQuality {
    fn from(arg: QualityArg) -> Self {
        match arg {
            QualityArg::Low => Self::Low,
            QualityArg::Medium => Self::Medium,
            QualityArg::High => Self::High,
        }
    }
}

/// `--threads` of `lucerna bench`: distinct numbers, in the order given.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Threads(pub Vec<usize>);

/// The greatest number of threads.
pub(super) const MOST_THREADS: usize = 4096;

pub(super) fn parse_threads(text: &str) -> Result<Threads, String> {
    let expected = || format!("expected numbers of threads, 1 to {MOST_THREADS}, as in 4, 1..8 or 1,2,4");
    let number = |text: &str| {
        text.trim()
            .parse()
            .ok()
            .filter(|n| (1..=MOST_THREADS).contains(n))
            .ok_or_else(expected)
    };
    let mut all = Vec::new();
    for part in text.split(',') {
        let (first, last) = part.split_once("..").unwrap_or((part, part));
        all.extend(number(first)?..=number(last.trim_start_matches('='))?);
    }
    let mut seen = std::collections::HashSet::new();
    all.retain(|n| seen.insert(*n));
    if all.is_empty() {
        Err(expected())
    } else {
        Ok(Threads(all))
    }
}

/// `NAME=VALUE`.
pub(super) fn parse_define(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.is_empty() => Ok((name.to_owned(), value.to_owned())),
        _ => Err("expected NAME=VALUE".to_owned()),
    }
}

pub(super) fn parse_backend(text: &str) -> Result<Backend, String> {
    text.parse().map_err(|error: crate::Error| error.to_string())
}

pub(super) fn parse_max_depth(text: &str) -> Result<MaxDepth, String> {
    match text {
        "unlimited" => Ok(MaxDepth(None)),
        _ => text
            .parse()
            .map(|depth| MaxDepth(Some(depth)))
            .map_err(|_| "expected a number, 0 or more, or `unlimited`".to_owned()),
    }
}

pub(super) fn parse_seed(text: &str) -> Result<u64, String> {
    text.parse()
        .map_err(|_| format!("expected an integer from 0 to {}", u64::MAX))
}

pub(super) fn parse_whole(text: &str) -> Result<u32, String> {
    text.parse()
        .map_err(|_| format!("expected a whole number from 0 to {}", u32::MAX))
}

pub(super) fn parse_positive_whole(text: &str) -> Result<u32, String> {
    text.parse()
        .ok()
        .filter(|&n| n > 0)
        .ok_or_else(|| format!("expected a whole number from 1 to {}", u32::MAX))
}

pub(super) fn parse_within(text: &str, range: RangeInclusive<u32>) -> Result<u32, String> {
    text.parse()
        .ok()
        .filter(|n| range.contains(n))
        .ok_or_else(|| format!("expected a whole number from {} to {}", range.start(), range.end()))
}

pub(super) fn parse_finite(text: &str) -> Result<f32, String> {
    text.parse()
        .ok()
        .filter(|x: &f32| x.is_finite())
        .ok_or_else(|| "expected a number".to_owned())
}

pub(super) fn parse_positive(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|x: &f64| *x > 0.0 && *x <= 1e9)
        .ok_or_else(|| "expected a number of more than 0".to_owned())
}

/// The largest picture: 2^28 pixels.
const LARGEST_PICTURE: u64 = 1 << 28;

pub(super) fn parse_resolution(text: &str) -> Result<[u32; 2], String> {
    let expected = || "expected width x height in pixels, as in 1920x1080".to_owned();
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(expected)?;
    let size: [u32; 2] = [
        width.parse().map_err(|_| expected())?,
        height.parse().map_err(|_| expected())?,
    ];
    match u64::from(size[0]) * u64::from(size[1]) {
        0 => Err("neither width nor height may be 0".to_owned()),
        pixels if pixels > LARGEST_PICTURE => Err("more than 2^28 pixels".to_owned()),
        _ => Ok(size),
    }
}

pub(super) fn parse_crop(text: &str) -> Result<PixelRect, String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x0, y0, x1, y1]) if x0 < x1 && y0 < y1 => Ok(PixelRect { x0, y0, x1, y1 }),
        Some([_, _, _, _]) => Err("the crop is empty: expected x0 < x1 and y0 < y1".to_owned()),
        _ => Err("expected four pixel coordinates, as in 0,0,200,100".to_owned()),
    }
}

pub(super) fn parse_pixel(text: &str) -> Result<PixelRect, String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x, y]) if x < u32::MAX && y < u32::MAX => Ok(PixelRect {
            x0: x,
            y0: y,
            x1: x + 1,
            y1: y + 1,
        }),
        _ => Err("expected two pixel coordinates, as in 12,34".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_are_numbers_and_ranges() {
        assert_eq!(parse_threads("1..4,2,8"), Ok(Threads(vec![1, 2, 3, 4, 8])));
        for bad in ["", "0", "4..1", "1..", "x", "1..99999999999"] {
            assert!(parse_threads(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn sizes_and_crops_are_checked() {
        assert_eq!(parse_resolution("640x480"), Ok([640, 480]));
        for bad in ["640", "0x480", "640x-1", "axb", "99999999x99999999"] {
            assert!(parse_resolution(bad).is_err(), "{bad}");
        }
        assert_eq!(
            parse_crop("1,2,3,4"),
            Ok(PixelRect {
                x0: 1,
                y0: 2,
                x1: 3,
                y1: 4
            })
        );
        for bad in ["1,2,3", "3,2,3,4", "1,2,3,4,5", "-1,2,3,4", ""] {
            assert!(parse_crop(bad).is_err(), "{bad}");
        }
    }
}
