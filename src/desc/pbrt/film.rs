//! `Film` and `PixelFilter`.

use std::path::PathBuf;

use super::params::ParamType;
use super::reader::{ParamReader, unknown_type};
use super::sensor;
use crate::desc::{
    ColorSpace, CropDesc, FilmDesc, FilmKind, FilterDesc, FilterKind, GBufferSpace, MeasureDesc, PixelRect, SensorDesc,
    SpectralBins,
};
use crate::error::Span;
use crate::spectrum::{LAMBDA_MAX, LAMBDA_MIN};

/// The film of a file without one.
pub(super) fn default_film(span: Span) -> FilmDesc {
    FilmDesc {
        resolution: [1280, 720],
        crop: CropDesc::Full,
        diagonal: 35.0,
        filename: None,
        iso: 100.0,
        exposure_time: 1.0,
        sensor: SensorDesc::default(),
        white_balance: None,
        max_component: f64::INFINITY,
        color_space: ColorSpace::default(),
        measure: MeasureDesc::default(),
        kind: FilmKind::default(),
        span,
    }
}

const KINDS: [&str; 3] = ["rgb", "gbuffer", "spectral"];

/// Reads a film; one of another type becomes an RGB one. The exposure time is the camera's to say.
pub(super) fn read_film(mut reader: ParamReader<'_>, kind: &str) -> FilmDesc {
    let span = reader.span;
    let kind = match kind {
        "gbuffer" => FilmKind::GBuffer(gbuffer_space(&mut reader)),
        "spectral" => FilmKind::Spectral(spectral_bins(&mut reader)),
        "rgb" => FilmKind::Rgb,
        _ => {
            let classes = (&KINDS[..], &[][..]);
            unknown_type(reader.report(), "film", kind, span, classes, "an RGB film stands in");
            FilmKind::Rgb
        }
    };
    let mut side = |name, default| {
        let valid = |v: i32| (1..=1 << 20).contains(&v);
        let value = reader.integer_in(name, default, valid, "between 1 and 1048576");
        value.unsigned_abs()
    };
    let resolution = [side("xresolution", 1280), side("yresolution", 720)];
    let film = FilmDesc {
        resolution,
        crop: crop(&mut reader, resolution),
        diagonal: reader.positive("diagonal", 35.0),
        filename: reader.string("filename").map(|(name, _)| PathBuf::from(name)),
        iso: reader.positive("iso", 100.0),
        exposure_time: 1.0,
        sensor: sensor::read(&mut reader),
        white_balance: white_balance(&mut reader),
        max_component: reader.positive("maxcomponentvalue", f64::INFINITY),
        color_space: reader.context.color_space,
        measure: measure(&mut reader),
        kind,
        span,
    };
    reader.inert(&[("savefp16", "images are saved with 32 bits")]);
    reader.finish();
    film
}

fn gbuffer_space(reader: &mut ParamReader<'_>) -> GBufferSpace {
    let Some((name, span)) = reader.string("coordinatesystem") else {
        return GBufferSpace::Camera;
    };
    match name.as_str() {
        "camera" => GBufferSpace::Camera,
        "world" => GBufferSpace::World,
        _ => {
            let message = format!("a coordinate system is `camera` or `world`, not `{name}`");
            let known = ["camera", "world"];
            reader
                .report()
                .unknown(span, message, "it is that of the camera", &name, &known);
            GBufferSpace::Camera
        }
    }
}

fn spectral_bins(reader: &mut ParamReader<'_>) -> SpectralBins {
    let all = [LAMBDA_MIN, LAMBDA_MAX];
    let valid = |v: f64| (f64::from(LAMBDA_MIN)..=f64::from(LAMBDA_MAX)).contains(&v);
    let mut end = |name, default: f32| reader.float_in(name, default.into(), valid, "between 360 and 830 nm") as f32;
    let range = [end("lambdamin", all[0]), end("lambdamax", all[1])];
    let count = reader.integer_in("nbuckets", 16, |v| (1..=1024).contains(&v), "between 1 and 1024");
    if range[0] >= range[1] {
        let span = reader.span_of("lambdamax");
        reader.report().error(span, "`lambdamax` must be more than `lambdamin`");
    }
    SpectralBins {
        range: if range[0] < range[1] { range } else { all },
        count: count.unsigned_abs(),
    }
}

/// As in pbrt-v4, 0 is none. Below 1000 K nothing glows that could be white.
fn white_balance(reader: &mut ParamReader<'_>) -> Option<f64> {
    let valid = |v: f64| v == 0.0 || (1000.0..=1e6).contains(&v);
    let range = "a temperature between 1000 and 1000000 K, or 0 for none";
    let kelvin = reader.float_in("whitebalance", 0.0, valid, range);
    (kelvin != 0.0).then_some(kelvin)
}

fn measure(reader: &mut ParamReader<'_>) -> MeasureDesc {
    let Some((name, span)) = reader.string("measure") else {
        return MeasureDesc::default();
    };
    match name.as_str() {
        "radiance" => MeasureDesc::Radiance,
        "irradiance" => MeasureDesc::Irradiance,
        _ => {
            let known = ["radiance", "irradiance"];
            let message = format!("a film measures `radiance` or `irradiance`, not `{name}`");
            let instead = "it measures radiance";
            reader.report().unknown(span, message, instead, &name, &known);
            MeasureDesc::default()
        }
    }
}

/// As in pbrt-v4, a crop window goes before pixel bounds, and both are clamped.
fn crop(reader: &mut ParamReader<'_>, resolution: [u32; 2]) -> CropDesc {
    let bounds = reader.integers("pixelbounds", 4);
    let window = reader.numbers("cropwindow", ParamType::Float, 4);
    let (name, crop) = match (window, bounds) {
        (Some(w), bounds) => {
            if bounds.is_some() {
                let span = reader.span_of("pixelbounds");
                reader
                    .report()
                    .warning(span, "`pixelbounds` has no effect: `cropwindow` goes first");
            }
            if w.iter().any(|v| !(0.0..=1.0).contains(v)) {
                let span = reader.span_of("cropwindow");
                let message = "`cropwindow` is clamped to between 0 and 1; did you mean `pixelbounds`?";
                reader.report().warning(span, message);
            }
            let v = [0, 1, 2, 3].map(|i| w[i].clamp(0.0, 1.0) as f32);
            let window = [v[0].min(v[1]), v[0].max(v[1]), v[2].min(v[3]), v[2].max(v[3])];
            ("cropwindow", CropDesc::Window(window))
        }
        (None, Some(b)) => {
            let [width, height] = resolution;
            if b[0].min(b[2]) < 0 || i64::from(b[1]) > i64::from(width) || i64::from(b[3]) > i64::from(height) {
                let span = reader.span_of("pixelbounds");
                let message = "`pixelbounds` goes beyond the image and is clamped to it";
                reader.report().warning(span, message);
            }
            let edge = |i: usize| b[i].max(0).unsigned_abs();
            let rect = PixelRect {
                x0: edge(0),
                x1: edge(1).min(width),
                y0: edge(2),
                y1: edge(3).min(height),
            };
            ("pixelbounds", CropDesc::Pixels(rect))
        }
        (None, None) => return CropDesc::Full,
    };
    let pixels = crop.pixels(resolution);
    if pixels.x0 >= pixels.x1 || pixels.y0 >= pixels.y1 {
        let span = reader.span_of(name);
        let message = format!("`{name}` leaves no pixel (its order is x0 x1 y0 y1)");
        reader.report().error(span, message);
        return CropDesc::Full;
    }
    crop
}

/// The filter of a file without one.
pub(super) const DEFAULT_FILTER: FilterDesc = FilterDesc {
    kind: FilterKind::Gaussian { sigma: 0.5 },
    radius: [1.5, 1.5],
};

/// The same in pbrt-v3.
pub(super) const OLD_DEFAULT_FILTER: FilterDesc = FilterDesc {
    kind: FilterKind::Box,
    radius: [0.5, 0.5],
};

/// Reads a pixel filter; one of another type becomes the default.
pub(super) fn read_filter(mut reader: ParamReader<'_>, kind: &str) -> FilterDesc {
    const KNOWN: [&str; 6] = ["box", "triangle", "gaussian", "mitchell", "sinc", "blackmanharris"];
    let third = 1.0 / 3.0;
    let (radius, kind) = match kind {
        "box" => (0.5, FilterKind::Box),
        "triangle" => (2.0, FilterKind::Triangle),
        "gaussian" => {
            let sigma = reader.positive("sigma", 0.5);
            (1.5, FilterKind::Gaussian { sigma })
        }
        "mitchell" => {
            let b = reader.float("B").unwrap_or(third);
            let c = reader.float("C").unwrap_or(third);
            (2.0, FilterKind::Mitchell { b, c })
        }
        "sinc" => {
            let tau = reader.positive("tau", 3.0);
            (4.0, FilterKind::LanczosSinc { tau })
        }
        "blackmanharris" => (2.0, FilterKind::BlackmanHarris),
        _ => {
            let span = reader.span;
            let instead = "a Gaussian stands in";
            unknown_type(reader.report(), "filter", kind, span, (&KNOWN, &[]), instead);
            return DEFAULT_FILTER;
        }
    };
    let valid = |v: f64| v > 0.0 && v <= 64.0;
    let mut side = |name| reader.float_in(name, radius, valid, "positive and at most 64 pixels");
    let radius = [side("xradius"), side("yradius")];
    reader.finish();
    FilterDesc { kind, radius }
}
