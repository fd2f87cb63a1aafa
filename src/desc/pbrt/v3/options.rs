//! What stands before `WorldBegin` in pbrt-v3.

use super::super::params::{ParamType, Values};
use super::Old;

pub(super) fn film(old: &mut Old<'_>, kind: &mut String) {
    if kind == "image" {
        "rgb".clone_into(kind);
        old.note("the film `image` is `rgb` in pbrt-v4");
    }
    if let Some(scale) = old.float("scale") {
        old.take("scale");
        old.note("the `scale` of a film is its `iso` over 100 in pbrt-v4");
        old.add_float("iso", 100.0 * scale);
    }
    if old.get("maxsampleluminance").is_some() {
        old.rename("maxsampleluminance", "maxcomponentvalue");
        old.note("`maxsampleluminance` is taken for `maxcomponentvalue`, which limits the largest channel instead of the luminance");
    }
}

pub(super) fn sampler(old: &mut Old<'_>, kind: &mut String) {
    old.drop("dimensions", "the `dimensions` of a sampler have no effect");
    let centers = "`samplepixelcenter` has no effect: samples are spread over pixels";
    old.drop("samplepixelcenter", centers);
    let new = match kind.as_str() {
        "lowdiscrepancy" | "02sequence" => "paddedsobol",
        "maxmindist" => "pmj02bn",
        "random" => "independent",
        _ => return,
    };
    new.clone_into(kind);
    old.note("pbrt-v4 has other names of samplers: `paddedsobol`, `pmj02bn`, `independent`");
}

pub(super) fn filter(old: &mut Old<'_>, kind: &str) {
    for (from, to) in [("xwidth", "xradius"), ("ywidth", "yradius")] {
        if old.get(from).is_some() {
            old.rename(from, to);
            old.note("the `xwidth` and `ywidth` of a filter are `xradius` and `yradius` in pbrt-v4");
        }
    }
    if kind == "gaussian" {
        let alpha = old.float("alpha").unwrap_or(2.0);
        if alpha > 0.0 {
            if old.take("alpha").is_some() {
                old.note("the `alpha` of a Gaussian filter is `sigma` in pbrt-v4: 1 / sqrt(2 alpha)");
            }
            old.add_float("sigma", 1.0 / (2.0 * alpha).sqrt());
        }
        for radius in ["xradius", "yradius"] {
            old.default_float(radius, 2.0);
        }
    }
}

pub(super) fn integrator(old: &mut Old<'_>, kind: &mut String) {
    match kind.as_str() {
        "directlighting" => {
            "path".clone_into(kind);
            old.note("the integrator `directlighting` is `path` with a `maxdepth` of 1 in pbrt-v4: mirrors show nothing but lights");
            old.take("maxdepth");
            old.take("strategy");
            old.add(ParamType::Integer, "maxdepth", Values::Integers(vec![1]), old.span);
        }
        "ao" => {
            "ambientocclusion".clone_into(kind);
            old.note("the integrator `ao` is `ambientocclusion` in pbrt-v4");
            old.drop(
                "nsamples",
                "the `nsamples` of ambient occlusion have no effect: the sampler's count",
            );
        }
        "whitted" => {
            let message = "the integrator `whitted` of pbrt-v3 has no counterpart";
            old.refuse(old.span, message, "`path` is used");
            "path".clone_into(kind);
        }
        "sppm" => {
            old.drop(
                "imagewritefrequency",
                "`imagewritefrequency` has no effect: images are written at the end",
            );
            let message = "`numiterations` has no effect: as in pbrt-v4 the passes are as many as the sampler's samples, or by --spp";
            old.drop("numiterations", message);
        }
        _ => {}
    }
    old.drop(
        "rrthreshold",
        "`rrthreshold` has no effect: Russian roulette goes by throughput",
    );
    let pixels = "`pixelbounds` of an integrator have no effect: give those of the film";
    old.drop("pixelbounds", pixels);
    if let Some(strategy) = old.string("lightsamplestrategy") {
        old.take("lightsamplestrategy");
        if matches!(kind.as_str(), "path" | "volpath" | "bdpt") {
            old.note("`lightsamplestrategy` is `lightsampler` in pbrt-v4, and `spatial` is taken for `bvh`");
            let new = if strategy == "spatial" { "bvh" } else { &strategy };
            old.add_string("lightsampler", new);
        }
    }
}

pub(super) fn camera(old: &mut Old<'_>, kind: &mut String) {
    if kind == "environment" {
        "spherical".clone_into(kind);
        old.note("the camera `environment` is `spherical` with the mapping `equirectangular` in pbrt-v4");
        old.add_string("mapping", "equirectangular");
    }
    if kind == "perspective"
        && let Some(half) = old.float("halffov")
    {
        old.take("halffov");
        old.take("fov");
        old.note("the `halffov` of a camera is half of its `fov`");
        old.add_float("fov", 2.0 * half);
    }
    if kind == "realistic" {
        old.drop(
            "simpleweighting",
            "the `simpleweighting` of a realistic camera has no effect",
        );
    }
}
