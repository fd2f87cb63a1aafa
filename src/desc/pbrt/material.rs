//! `Material` and `MakeNamedMaterial`.

use super::reader::{ParamReader, unknown_type};
use super::spectrum::Use;
use super::world::default_material;
use crate::desc::{ConductorDesc, MaterialDesc, MaterialKind, RoughnessDesc, SpectrumDesc, SpectrumValue, Textured};
use crate::error::Span;

const KNOWN: [&str; 4] = ["diffuse", "conductor", "dielectric", "interface"];
const LATER: [&str; 8] = [
    "coateddiffuse",
    "coatedconductor",
    "diffusetransmission",
    "thindielectric",
    "hair",
    "measured",
    "mix",
    "subsurface",
];

/// Reads a material that says its type by `"string type"`; see [`read`].
pub(super) fn read_named(mut reader: ParamReader<'_>) -> Option<MaterialDesc> {
    match reader.string("type") {
        Some((kind, span)) => read(reader, &kind, Some(span)),
        None => {
            if !reader.has("type") {
                let span = reader.span;
                let message = "this material has no type: `\"string type\" \"diffuse\"`, for one";
                reader.report().error(span, message);
            }
            Some(default_material(reader.span))
        }
    }
}

/// Reads a material of type `kind`, which stands at `span` unless where the reader has it. `None`: no surface at all. What cannot
/// be read becomes the default material.
pub(super) fn read(mut reader: ParamReader<'_>, kind: &str, span: Option<Span>) -> Option<MaterialDesc> {
    let span = span.unwrap_or(reader.span);
    let kind = match kind {
        "diffuse" => diffuse(&mut reader),
        "conductor" => conductor(&mut reader),
        "dielectric" => dielectric(&mut reader),
        "interface" => {
            reader.finish();
            return None;
        }
        "" | "none" => {
            let message = format!("the material `{kind}` is deprecated: it is taken for `interface`");
            reader.report().warning(span, message);
            reader.finish();
            return None;
        }
        _ => {
            let classes = (&KNOWN[..], &LATER[..]);
            unknown_type(
                reader.report(),
                "material",
                kind,
                span,
                classes,
                "a diffuse one stands in",
            );
            return Some(default_material(span));
        }
    };
    reader.unsupported(&["displacement", "normalmap"]);
    reader.finish();
    Some(MaterialDesc { name: None, kind, span })
}

fn diffuse(reader: &mut ParamReader<'_>) -> MaterialKind {
    MaterialKind::Diffuse {
        reflectance: textured_or(reader, "reflectance", Use::Albedo, SpectrumValue::Constant(0.5)),
    }
}

fn conductor(reader: &mut ParamReader<'_>) -> MaterialKind {
    let reflectance = reader.spectrum_textured("reflectance", Use::Albedo);
    let interface = match reflectance {
        Some(reflectance) => {
            if reader.has("eta") || reader.has("k") {
                let span = reader.span_of("reflectance");
                let message = "a conductor has either `reflectance` or `eta` and `k`";
                reader.report().error(span, message);
                reader.spectrum_textured("eta", Use::Ior);
                reader.spectrum_textured("k", Use::Absorption);
            }
            ConductorDesc::Reflectance(reflectance)
        }
        None => {
            let copper = |part: &str| SpectrumValue::Named(format!("metal-Cu-{part}"));
            ConductorDesc::Ior {
                eta: textured_or(reader, "eta", Use::Ior, copper("eta")),
                k: textured_or(reader, "k", Use::Absorption, copper("k")),
            }
        }
    };
    MaterialKind::Conductor {
        interface,
        roughness: roughness(reader),
    }
}

fn dielectric(reader: &mut ParamReader<'_>) -> MaterialKind {
    let eta = reader.spectrum_or_float("eta", Use::Ior).unwrap_or(SpectrumDesc {
        value: SpectrumValue::Constant(1.5),
        span: reader.span,
    });
    if let SpectrumValue::Rgb(_) | SpectrumValue::Blackbody(_) = eta.value {
        let message = "the index of refraction of a dielectric is a number or a spectrum, not a colour";
        reader.report().error(eta.span, message);
    }
    MaterialKind::Dielectric {
        eta,
        roughness: roughness(reader),
    }
}

/// `roughness`, overridden by `uroughness` and `vroughness`; smooth by default.
fn roughness(reader: &mut ParamReader<'_>) -> RoughnessDesc {
    let both = reader.not_negative_textured("roughness", Textured::Value(0.0));
    RoughnessDesc {
        u: reader.not_negative_textured("uroughness", both.clone()),
        v: reader.not_negative_textured("vroughness", both),
        remap: reader.boolean("remaproughness", true),
    }
}

fn textured_or(
    reader: &mut ParamReader<'_>,
    name: &'static str,
    usage: Use,
    value: SpectrumValue,
) -> Textured<SpectrumDesc> {
    let span = reader.span;
    reader
        .spectrum_textured(name, usage)
        .unwrap_or(Textured::Value(SpectrumDesc { value, span }))
}
