//! Materials of pbrt-v3.

use super::super::params::{Param, ParamType, Values};
use super::Old;

/// The material of a name: its type is a parameter.
pub(super) fn named(old: &mut Old<'_>) {
    let Some(mut kind) = old.string("type") else { return };
    old.span = old.span_of("type");
    material(old, &mut kind);
    if let Some(Values::Strings(words)) = old.params.iter_mut().find(|p| p.name == "type").map(|p| &mut p.values) {
        *words = vec![kind];
    }
}

pub(super) fn material(old: &mut Old<'_>, kind: &mut String) {
    old.rename("bumpmap", "displacement");
    let new = match kind.as_str() {
        "matte" => matte(old),
        "plastic" => plastic(old, "plastic"),
        "uber" => uber(old),
        "substrate" => substrate(old),
        "metal" => metal(old),
        "mirror" => mirror(old),
        "glass" => glass(old),
        "translucent" => translucent(old),
        "disney" => disney(old),
        "mix" => mix(old),
        "kdsubsurface" => "subsurface",
        "fourier" => {
            let message =
                "the material `fourier` of pbrt-v3 has no counterpart (`measured` has files of another format)";
            old.refuse(old.span, message, "a diffuse one stands in");
            old.params.retain(|p| p.name == "type");
            "diffuse"
        }
        _ => return,
    };
    new.clone_into(kind);
}

fn matte(old: &mut Old<'_>) -> &'static str {
    old.note("the material `matte` is `diffuse` in pbrt-v4");
    old.rename("Kd", "reflectance");
    let sigma = "the `sigma` of a matte material is left out, as by pbrt-v4: it is Lambertian";
    match old.float("sigma") {
        Some(0.0) => _ = old.take("sigma"),
        _ => _ = old.drop("sigma", sigma),
    }
    "diffuse"
}

/// `plastic`, and what is left of `uber` beside its mirrors.
fn plastic(old: &mut Old<'_>, name: &str) -> &'static str {
    old.note(match name {
        "uber" => "the material `uber` is `coateddiffuse` in pbrt-v4, or `diffuse` without `Ks`: highlights differ",
        _ => "the material `plastic` is `coateddiffuse` in pbrt-v4, or `diffuse` without `Ks`: highlights differ",
    });
    old.rename("Kd", "reflectance");
    old.default_grey("reflectance", 0.25);
    let is_matte = old.grey("Ks") == Some(0.0);
    old.take("Ks");
    if is_matte {
        let of_coat = [
            "eta",
            "index",
            "roughness",
            "uroughness",
            "vroughness",
            "remaproughness",
        ];
        old.params.retain(|p| !of_coat.contains(&p.name.as_str()));
        return "diffuse";
    }
    roughness(old, 0.1);
    "coateddiffuse"
}

fn uber(old: &mut Old<'_>) -> &'static str {
    index(old);
    for name in ["Kr", "Kt"] {
        if old.grey(name) == Some(0.0) {
            old.take(name);
        } else {
            old.drop(
                name,
                "the `Kr` and `Kt` of an uber material are left out, as by pbrt-v4",
            );
        }
    }
    let opacity = old.take("opacity");
    if let Some(Param { span, values, .. }) = opacity
        && !matches!(&values, Values::Numbers(v) if v.iter().all(|&v| v == 1.0))
    {
        let message = "the `opacity` of an uber material has no counterpart in pbrt-v4: give the shapes an `alpha`";
        old.refuse(span, message, "it is opaque");
    }
    plastic(old, "uber")
}

fn substrate(old: &mut Old<'_>) -> &'static str {
    old.note("the material `substrate` is `coateddiffuse` in pbrt-v4: highlights differ");
    old.rename("Kd", "reflectance");
    old.default_grey("reflectance", 0.5);
    old.take("Ks");
    roughness(old, 0.1);
    "coateddiffuse"
}

fn metal(old: &mut Old<'_>) -> &'static str {
    old.note("the material `metal` is `conductor` in pbrt-v4");
    roughness(old, 0.01);
    "conductor"
}

fn mirror(old: &mut Old<'_>) -> &'static str {
    old.note("the material `mirror` is a smooth `conductor` in pbrt-v4, whose `reflectance` head on is `Kr`");
    old.rename("Kr", "reflectance");
    old.default_grey("reflectance", 0.9);
    "conductor"
}

fn glass(old: &mut Old<'_>) -> &'static str {
    old.note("the material `glass` is `dielectric` in pbrt-v4");
    index(old);
    for name in ["Kr", "Kt"] {
        if old.grey(name) == Some(1.0) {
            old.take(name);
        } else {
            old.drop(
                name,
                "the `Kr` and `Kt` of glass are left out, as by pbrt-v4: it absorbs nothing",
            );
        }
    }
    if old.get("roughness").is_none() {
        // Glass has a roughness for each direction only; what is not given is smooth.
        let rough = ["uroughness", "vroughness"].iter().any(|name| old.get(name).is_some());
        if rough {
            roughness(old, 0.0);
        }
    }
    "dielectric"
}

fn translucent(old: &mut Old<'_>) -> &'static str {
    old.note("the material `translucent` is `diffusetransmission` in pbrt-v4: its highlights are left out");
    let parts = ["reflect", "transmit"].map(|name| {
        let value = if old.get(name).is_some() {
            old.grey(name)
        } else {
            Some(0.5)
        };
        let span = old.span_of(name);
        old.take(name);
        if value.is_none() {
            old.refuse(
                span,
                "a coloured `reflect` or `transmit` has no counterpart in pbrt-v4",
                "it is 0.5",
            );
        }
        value.unwrap_or(0.5)
    });
    for name in ["Ks", "roughness", "remaproughness"] {
        old.take(name);
    }
    old.default_grey("Kd", 0.25);
    let Some(kd) = old.take("Kd") else {
        return "diffusetransmission";
    };
    let scale = parts[0].max(parts[1]);
    for (name, part) in ["reflectance", "transmittance"].into_iter().zip(parts) {
        let share = if scale > 0.0 { part / scale } else { 0.0 };
        let mut param = Param {
            name: name.to_owned(),
            ..kd.clone()
        };
        match &mut param.values {
            _ if share == 1.0 => {}
            _ if share == 0.0 => {
                old.add_grey(name, 0.0);
                continue;
            }
            Values::Numbers(numbers) if param.kind == ParamType::Rgb => {
                for number in numbers {
                    *number *= share;
                }
            }
            _ => {
                let message =
                    "a texture that is reflected and transmitted in different parts has no counterpart in pbrt-v4";
                old.refuse(kd.span, message, "both parts are the same");
            }
        }
        old.params.push(param);
    }
    old.add_float("scale", scale);
    "diffusetransmission"
}

fn disney(old: &mut Old<'_>) -> &'static str {
    old.note("the material `disney` is taken for `principled`, which is nearly the same");
    for (from, to) in [
        ("color", "base_color"),
        ("spectrans", "spec_trans"),
        ("speculartint", "spec_tint"),
        ("sheentint", "sheen_tint"),
        ("clearcoatgloss", "clearcoat_gloss"),
    ] {
        old.rename(from, to);
    }
    old.default_float("sheen_tint", 0.5);
    old.default_float("clearcoat_gloss", 1.0);
    for name in ["flatness", "difftrans", "scatterdistance", "thin"] {
        let is_off = old.grey(name) == Some(0.0) || old.bool(name) == Some(false);
        if let Some(param) = old.take(name).filter(|_| !is_off) {
            let message = format!("`{name}` of the material `disney` has no counterpart");
            old.refuse(param.span, &message, "it is ignored");
        }
    }
    "principled"
}

fn mix(old: &mut Old<'_>) -> &'static str {
    if old.get("namedmaterial1").is_none() && old.get("namedmaterial2").is_none() {
        return "mix";
    }
    old.note("the `namedmaterial1` and `namedmaterial2` of a mix are its `materials` in pbrt-v4, in the other order");
    let names = ["namedmaterial2", "namedmaterial1"].map(|name| {
        let value = old.string(name);
        let param = old.take(name);
        (value, param.map(|p| p.span))
    });
    if let [(Some(second), span), (Some(first), _)] = names {
        let span = span.unwrap_or(old.span);
        let values = Values::Strings(vec![second, first]);
        old.add(ParamType::String, "materials", values, span);
    }
    if let Some([r, g, b]) = old.rgb("amount") {
        if r != g || g != b {
            old.note("the coloured `amount` of a mix is its mean in pbrt-v4");
        }
        old.take("amount");
        old.add_float("amount", (r + g + b) / 3.0);
    }
    "mix"
}

/// The index of refraction, which had two names.
fn index(old: &mut Old<'_>) {
    if old.get("index").is_none() {
        return;
    }
    if old.get("eta").is_some() {
        let span = old.span_of("index");
        old.report
            .error(span, "`index` and `eta` say the same thing: give one of them");
        old.take("index");
        return;
    }
    old.rename("index", "eta");
}

/// Roughness by numbers so that facets have the slopes that they had in pbrt-v3; `default` where nothing is given.
fn roughness(old: &mut Old<'_>, default: f64) {
    let both_given = ["uroughness", "vroughness"].iter().all(|name| old.get(name).is_some());
    if !both_given {
        old.default_float("roughness", default);
    }
    if old.bool("remaproughness") == Some(false) {
        return;
    }
    for name in ["roughness", "uroughness", "vroughness"] {
        if let Some(value) = old.float(name) {
            let slope = slope(value);
            let param = old.params.iter_mut().find(|p| p.name == name);
            if let Some(param) = param {
                param.values = Values::Numbers(vec![slope * slope]);
            }
            old.note("a roughness is converted: in pbrt-v4 its square root is the slope of facets");
        } else if old.get(name).is_some() {
            let message = "the roughness of a texture is taken as in pbrt-v4, where its square root is the slope of facets: highlights differ";
            old.note(message);
        }
    }
}

/// The slope of facets for a roughness of pbrt-v3 (its `RoughnessToAlpha`, a polynomial of the logarithm).
fn slope(roughness: f64) -> f64 {
    let x = roughness.max(1e-3).ln();
    1.62142 + x * (0.819_955 + x * (0.1734 + x * (0.017_120_1 + x * 0.000_640_711)))
}

#[cfg(test)]
mod tests {
    use super::slope;

    #[test]
    fn slopes_are_those_of_the_polynomial() {
        assert!((slope(1.0) - 1.62142).abs() < 1e-12);
        assert!((slope(0.1) - 0.4617).abs() < 1e-3);
        assert_eq!(slope(0.0), slope(1e-3));
    }
}
