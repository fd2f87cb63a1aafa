//! Textures and shapes of pbrt-v3.

use super::super::params::ParamType;
use super::Old;

pub(super) fn texture(old: &mut Old<'_>, kind: &str) {
    match kind {
        "scale" => scale(old),
        "imagemap" => image_map(old),
        "checkerboard" => {
            old.drop("aamode", "the `aamode` of a checkerboard has no effect");
        }
        _ => {}
    }
}

/// The product of two textures; in pbrt-v4 one of them is a number.
fn scale(old: &mut Old<'_>) {
    old.note("the `tex1` and `tex2` of a `scale` texture are `tex` and `scale` in pbrt-v4");
    let factor = ["tex1", "tex2"]
        .into_iter()
        .find(|name| old.get(name).is_some_and(|p| p.kind == ParamType::Float) || old.grey(name).is_some());
    let (texture, factor) = match factor {
        Some("tex1") => ("tex2", "tex1"),
        // If it is the name of a texture, that must be of class float.
        _ => ("tex1", "tex2"),
    };
    if let Some(grey) = old.grey(factor) {
        old.take(factor);
        old.add_float("scale", grey);
    } else {
        old.rename(factor, "scale");
    }
    old.rename(texture, "tex");
}

fn image_map(old: &mut Old<'_>) {
    let filter = match old.bool("trilinear") {
        Some(true) => "trilinear",
        // What pbrt-v3 does if it is not trilinear.
        _ => "EWA",
    };
    old.take("trilinear");
    if old.get("filter").is_none() {
        old.add_string("filter", filter);
    }
    let encoding = match (old.bool("gamma"), old.float("gamma")) {
        (Some(true), _) => "sRGB".to_owned(),
        (Some(false), _) => "linear".to_owned(),
        (None, Some(gamma)) => format!("gamma {gamma}"),
        (None, None) => return,
    };
    old.take("gamma");
    old.note("the `gamma` of an image is its `encoding` in pbrt-v4");
    old.add_string("encoding", &encoding);
}

/// Whether there is such a shape.
pub(super) fn shape(old: &mut Old<'_>, kind: &str) -> bool {
    if matches!(
        kind,
        "cone" | "hyperboloid" | "paraboloid" | "heightfield" | "heightfield2" | "nurbs"
    ) {
        let message = format!("the shape `{kind}` of pbrt-v3 has no counterpart in pbrt-v4");
        old.refuse(old.span, &message, "it is left out");
        return false;
    }
    if kind == "loopsubdiv" && old.get("nlevels").is_some() {
        old.rename("nlevels", "levels");
        old.note("the `nlevels` of a subdivision surface are `levels` in pbrt-v4");
    }
    if matches!(kind, "trianglemesh" | "plymesh") {
        old.drop("discarddegenerateUVs", "`discarddegenerateUVs` has no effect");
        let message = "`shadowalpha` is left out: light passes where `alpha` says so";
        old.drop("shadowalpha", message);
    }
    if kind == "trianglemesh" {
        if old.get("st").is_some() && old.get("uv").is_none() {
            old.rename("st", "uv");
        }
        if let Some(uv) = old
            .params
            .iter_mut()
            .find(|p| p.name == "uv" && p.kind == ParamType::Float)
        {
            uv.kind = ParamType::Point2;
            old.note("the texture coordinates of a mesh are `\"point2 uv\"` in pbrt-v4");
        }
    }
    true
}
