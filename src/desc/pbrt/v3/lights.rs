//! Lights of pbrt-v3.

use super::super::params::{ParamType, Values};
use super::Old;

pub(super) fn light(old: &mut Old<'_>, kind: &mut String) {
    if kind == "area" {
        "diffuse".clone_into(kind);
        old.note("the area light `area` is `diffuse` in pbrt-v4");
    }
    for name in ["samples", "nsamples"] {
        old.drop(
            name,
            "the number of samples of a light has no effect: the sampler's count",
        );
    }
    let mut scale = old.float("scale").unwrap_or(1.0);
    if old.get("scale").is_some_and(|p| p.kind == ParamType::Float) {
        old.take("scale");
    }
    scale *= grey_scale(old);
    if old.get("mapname").is_some() {
        scale *= map(old, kind);
    }
    for name in ["I", "L"] {
        scale *= blackbody_scale(old, name);
    }
    if kind == "projection" {
        old.default_float("fov", 45.0);
    }
    if scale != 1.0 {
        old.add_float("scale", scale);
    }
}

/// `scale` as a colour: a number if it is grey, else a factor of the light's colour.
fn grey_scale(old: &mut Old<'_>) -> f64 {
    let Some(scale) = old.rgb("scale") else { return 1.0 };
    let span = old.span_of("scale");
    if scale[0] == scale[1] && scale[1] == scale[2] {
        old.take("scale");
        old.note("the `scale` of a light is a number in pbrt-v4");
        return scale[0];
    }
    old.take("scale");
    for param in old.params.iter_mut().filter(|p| matches!(p.name.as_str(), "I" | "L")) {
        if param.kind == ParamType::Rgb
            && let Values::Numbers(values) = &mut param.values
        {
            for (value, factor) in values.iter_mut().zip(scale) {
                *value *= factor;
            }
            old.note("the `scale` of a light is a number in pbrt-v4: a coloured one is multiplied into its colour");
            return 1.0;
        }
    }
    if old.get("mapname").is_none() && old.get("I").is_none() && old.get("L").is_none() {
        let name = if old.get("from").is_some() { "I" } else { "L" };
        old.add(ParamType::Rgb, name, Values::Numbers(scale.to_vec()), span);
        return 1.0;
    }
    old.refuse(
        span,
        "a coloured `scale` of an image or a spectrum has no counterpart in pbrt-v4",
        "it is ignored",
    );
    1.0
}

/// `mapname`, beside which there is no colour in pbrt-v4; the factor that it is.
fn map(old: &mut Old<'_>, kind: &str) -> f64 {
    old.rename("mapname", "filename");
    old.note("the `mapname` of a light is `filename` in pbrt-v4");
    let color = match kind {
        "infinite" | "exinfinite" => "L",
        "projection" => "I",
        _ => return 1.0,
    };
    if old.get(color).is_none() {
        return 1.0;
    }
    if let Some(grey) = old.grey(color) {
        old.take(color);
        return grey;
    }
    let span = old.span_of(color);
    old.take(color);
    old.refuse(
        span,
        "a colour beside an image has no counterpart in pbrt-v4",
        "it is ignored",
    );
    1.0
}

/// A blackbody of pbrt-v3 has a factor beside its temperature.
fn blackbody_scale(old: &mut Old<'_>, name: &str) -> f64 {
    let param = old
        .params
        .iter_mut()
        .find(|p| p.name == name && p.kind == ParamType::Blackbody);
    let Some(Values::Numbers(values)) = param.map(|p| &mut p.values) else {
        return 1.0;
    };
    if values.len() != 2 {
        return 1.0;
    }
    let scale = values.pop().unwrap_or(1.0);
    old.note("the factor of a `blackbody` is the light's `scale` in pbrt-v4");
    scale
}
