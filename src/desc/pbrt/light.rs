//! `LightSource` and `AreaLightSource`.

use glam::DVec3;

use super::reader::{ParamReader, unknown_type};
use super::spectrum::Use;
use crate::desc::{AreaLightDesc, LightDesc, LightKind, MotionDesc, SpectrumDesc, SpectrumValue};

const KNOWN: [&str; 3] = ["point", "distant", "infinite"];
const LATER: [&str; 3] = ["spot", "goniometric", "projection"];

/// Reads a light; none if its type is not known or not supported.
pub(super) fn read(mut reader: ParamReader<'_>, kind: &str, world_from_light: MotionDesc) -> Option<LightDesc> {
    let span = reader.span;
    let (kind, spectrum, photometric) = match kind {
        "point" => {
            let from = reader.point3("from", DVec3::ZERO);
            (
                LightKind::Point { from },
                emission(&mut reader, "I"),
                photometric(&mut reader, "power"),
            )
        }
        "distant" => {
            let from = reader.point3("from", DVec3::ZERO);
            let to = reader.point3("to", DVec3::Z);
            if from == to {
                let span = reader.span_of("to");
                reader
                    .report()
                    .error(span, "`from` and `to` of a distant light must differ");
            }
            let kind = LightKind::Distant { from, to };
            (
                kind,
                emission(&mut reader, "L"),
                photometric(&mut reader, "illuminance"),
            )
        }
        "infinite" => {
            reader.unsupported(&["filename", "portal"]);
            let spectrum = emission(&mut reader, "L");
            (LightKind::Infinite, spectrum, photometric(&mut reader, "illuminance"))
        }
        _ => {
            let classes = (&KNOWN[..], &LATER[..]);
            unknown_type(reader.report(), "light", kind, span, classes, "it is left out");
            return None;
        }
    };
    let scale = reader.not_negative("scale", 1.0) as f32;
    reader.finish();
    Some(LightDesc {
        span,
        kind,
        spectrum,
        scale,
        photometric,
        world_from_light,
    })
}

/// Reads what shapes are to emit; nothing if the type is not known.
pub(super) fn read_area(mut reader: ParamReader<'_>, kind: &str) -> Option<AreaLightDesc> {
    let span = reader.span;
    if kind != "diffuse" {
        let classes = (&["diffuse"][..], &[][..]);
        unknown_type(reader.report(), "area light", kind, span, classes, "nothing emits");
        return None;
    }
    reader.unsupported(&["filename"]);
    let light = AreaLightDesc {
        span,
        l: emission(&mut reader, "L"),
        scale: reader.not_negative("scale", 1.0) as f32,
        power: photometric(&mut reader, "power"),
        two_sided: reader.boolean("twosided", false),
    };
    reader.finish();
    Some(light)
}

/// The spectrum of a light. Unless RGB, it is normalised by its luminance, which must not be 0.
fn emission(reader: &mut ParamReader<'_>, name: &'static str) -> Option<SpectrumDesc> {
    let spectrum = reader.spectrum(name, Use::Emission)?;
    if let SpectrumValue::Samples(samples) = &spectrum.value
        && samples.iter().all(|&(_, value)| value == 0.0)
    {
        let message = format!(
            "`{name}` is 0 everywhere: it has no luminance to be scaled to (`\"rgb {name}\" [0 0 0]` is black)"
        );
        reader.report().error(spectrum.span, message);
        return None;
    }
    Some(spectrum)
}

/// A power or an illuminance; as in pbrt-v4 it counts only if it is positive.
fn photometric(reader: &mut ParamReader<'_>, name: &'static str) -> Option<f32> {
    let value = reader.float(name)?;
    if value > 0.0 {
        return Some(value as f32);
    }
    let span = reader.span_of(name);
    reader
        .report()
        .warning(span, format!("`{name}` has no effect: it is not positive"));
    None
}
