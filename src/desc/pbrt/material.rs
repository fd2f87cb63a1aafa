//! `Material` and `MakeNamedMaterial`.

use std::sync::Arc;

use super::params::{ParamType, Values};
use super::reader::{ParamReader, unknown_type};
use super::world::{Materials, default_material};
use crate::desc::kinds::materials as kinds;
use crate::desc::{
    CoatDesc, ConductorDesc, DistributionDesc, HairColorDesc, HairDesc, MATERIALS, MaterialDesc, MaterialId,
    MaterialKind, MeasuredDesc, Parameter, PlasticDesc, PrincipledDesc, ReliefDesc, RoughnessDesc, Textured, rgl,
};
use crate::error::Span;
use crate::image_io::Encoding;

/// The pigment of hair of which nothing is said: brown.
const DEFAULT_EUMELANIN: f32 = 1.3;

/// Reads a material that says its type by `"string type"`; see [`read`].
pub(super) fn read_named(mut reader: ParamReader<'_>, materials: &mut Materials) -> MaterialDesc {
    match reader.string("type") {
        Some((kind, span)) => read(reader, materials, &kind, Some(span)),
        None => {
            if !reader.has("type") {
                let span = reader.span;
                let message = "this material has no type: `\"string type\" \"diffuse\"`, for one";
                reader.report().error(span, message);
            }
            default_material(reader.span)
        }
    }
}

/// Reads a material of type `kind`, which stands at `span` unless where the reader has it. What cannot be
/// read becomes the default material.
pub(super) fn read(
    mut reader: ParamReader<'_>,
    materials: &mut Materials,
    kind: &str,
    span: Option<Span>,
) -> MaterialDesc {
    let span = span.unwrap_or(reader.span);
    let Some(entry) = MATERIALS.iter().find(|entry| entry.name == kind) else {
        return unknown(reader, kind, span);
    };
    let kind = read_kind(&mut reader, materials, entry.name);
    let can_have_relief = entry.has(kinds::DISPLACEMENT.name);
    let relief = if can_have_relief { relief(&mut reader) } else { None };
    reader.finish_by(entry);
    MaterialDesc {
        name: None,
        kind,
        relief,
        span,
    }
}

/// A normal map or a displacement; as in pbrt-v4 the former counts if both are given.
fn relief(reader: &mut ParamReader<'_>) -> Option<ReliefDesc> {
    let displacement = match reader.float_textured(kinds::DISPLACEMENT.name) {
        Some(Textured::Texture(id)) => Some(ReliefDesc::Displacement(id)),
        // The same height everywhere bends nothing.
        Some(Textured::Value(_)) | None => None,
    };
    if !reader.has(kinds::NORMAL_MAP.name) {
        return displacement;
    }
    if displacement.is_some() {
        let span = reader.span_of(kinds::DISPLACEMENT.name);
        let message = "`displacement` has no effect: there is a normal map";
        reader.report().warning(span, message);
    }
    let image = reader.image(kinds::NORMAL_MAP.name, Encoding::Linear)?;
    Some(ReliefDesc::Normals(image))
}

fn unknown(mut reader: ParamReader<'_>, kind: &str, span: Span) -> MaterialDesc {
    if matches!(kind, "" | "none") {
        let message = format!("the material `{kind}` is deprecated: it is taken for `interface`");
        reader.report().warning(span, message);
        reader.finish();
        return MaterialDesc {
            kind: MaterialKind::Interface,
            ..default_material(span)
        };
    }
    if kind == "subsurface" {
        let message = "the material `subsurface` is not supported: light does not travel under surfaces here";
        reader.report().unsupported(span, message, "a diffuse one stands in");
        return default_material(span);
    }
    let known = MATERIALS.each_ref().map(|entry| entry.name);
    let classes = (&known[..], &[][..]);
    unknown_type(
        reader.report(),
        "material",
        kind,
        span,
        classes,
        "a diffuse one stands in",
    );
    default_material(span)
}

/// The material of one of the kinds in [`MATERIALS`].
fn read_kind(reader: &mut ParamReader<'_>, materials: &mut Materials, kind: &str) -> MaterialKind {
    match kind {
        "diffuse" => MaterialKind::Diffuse {
            reflectance: reader.spectrum_textured_by(&kinds::REFLECTANCE),
            roughness: reader.float_textured_by(&kinds::DIFFUSE_ROUGHNESS),
        },
        "diffusetransmission" => MaterialKind::DiffuseTransmission {
            reflectance: reader.spectrum_textured_by(&kinds::REFLECTED),
            transmittance: reader.spectrum_textured_by(&kinds::TRANSMITTED),
            scale: reader.float_by(&kinds::TRANSMISSION_SCALE) as f32,
        },
        "conductor" => MaterialKind::Conductor {
            interface: metal(reader, &kinds::ETA_METAL, &kinds::K),
            roughness: roughness(reader, &PLAIN),
            multiple_scattering: reader.bool_by(&kinds::MULTIPLE_SCATTERING),
        },
        "dielectric" => MaterialKind::Dielectric {
            eta: reader.glass_index_by(&kinds::ETA),
            roughness: roughness(reader, &PLAIN),
            multiple_scattering: reader.bool_by(&kinds::MULTIPLE_SCATTERING),
        },
        "thindielectric" => MaterialKind::ThinDielectric {
            eta: reader.glass_index_by(&kinds::ETA),
        },
        "coateddiffuse" => MaterialKind::CoatedDiffuse {
            reflectance: reader.spectrum_textured_by(&kinds::REFLECTANCE),
            coat: coat(reader, &kinds::ETA, &PLAIN),
        },
        "coatedconductor" => MaterialKind::CoatedConductor {
            interface: metal(reader, &kinds::CONDUCTOR_ETA, &kinds::CONDUCTOR_K),
            roughness: roughness(reader, &CONDUCTOR),
            coat: coat(reader, &kinds::INTERFACE_ETA, &INTERFACE),
        },
        "hair" => MaterialKind::Hair(hair(reader)),
        "mix" => mix(reader, materials),
        "principled" => MaterialKind::Principled(principled(reader)),
        "measured" => match measured(reader) {
            Some(desc) => MaterialKind::Measured(Arc::new(desc)),
            None => default_material(reader.span).kind,
        },
        "plastic" => MaterialKind::Plastic(PlasticDesc {
            diffuse_reflectance: reader.spectrum_textured_by(&kinds::REFLECTANCE),
            specular_reflectance: reader.spectrum_textured_by(&kinds::SPECULAR_REFLECTANCE),
            eta: reader.float_by(&kinds::PLASTIC_ETA) as f32,
            nonlinear: reader.bool_by(&kinds::NONLINEAR),
            roughness: roughness(reader, &PLAIN),
        }),
        "sided" => MaterialKind::Sided {
            front: part(reader, materials, &kinds::FRONT),
            back: part(reader, materials, &kinds::BACK),
        },
        "tinted" => tinted(reader, materials),
        "interface" => MaterialKind::Interface,
        _ => default_material(reader.span).kind,
    }
}

fn metal(reader: &mut ParamReader<'_>, eta: &'static Parameter, k: &'static Parameter) -> ConductorDesc {
    let Some(reflectance) = reader.reflectance_by(&kinds::METAL_REFLECTANCE) else {
        return ConductorDesc::Ior {
            eta: reader.spectrum_textured_by(eta),
            k: reader.spectrum_textured_by(k),
        };
    };
    if reader.has(eta.name) || reader.has(k.name) {
        let span = reader.span_of(kinds::METAL_REFLECTANCE.name);
        let message = format!(
            "a conductor has either `reflectance` or `{}` and `{}`",
            eta.name, k.name
        );
        reader.report().error(span, message);
        reader.spectrum_textured_by(eta);
        reader.spectrum_textured_by(k);
    }
    ConductorDesc::Reflectance(reflectance)
}

/// The parameters that say how rough something is: both ways, along u, along v.
type RoughnessNames = [&'static Parameter; 3];

static PLAIN: RoughnessNames = [&kinds::ROUGHNESS, &kinds::U_ROUGHNESS, &kinds::V_ROUGHNESS];
static CONDUCTOR: RoughnessNames = [
    &kinds::CONDUCTOR_ROUGHNESS,
    &kinds::CONDUCTOR_U_ROUGHNESS,
    &kinds::CONDUCTOR_V_ROUGHNESS,
];
static INTERFACE: RoughnessNames = [
    &kinds::INTERFACE_ROUGHNESS,
    &kinds::INTERFACE_U_ROUGHNESS,
    &kinds::INTERFACE_V_ROUGHNESS,
];

fn roughness(reader: &mut ParamReader<'_>, [both, u, v]: &RoughnessNames) -> RoughnessDesc {
    let both = reader.float_textured_by(both);
    RoughnessDesc {
        u: reader.float_textured_or(u, both.clone()),
        v: reader.float_textured_or(v, both),
        remap: reader.bool_by(&kinds::REMAP_ROUGHNESS),
        distribution: match reader.choice_by(&kinds::DISTRIBUTION) {
            "beckmann" => DistributionDesc::Beckmann,
            _ => DistributionDesc::Ggx,
        },
        separable_masking: reader.choice_by(&kinds::MASKING) == "separable",
    }
}

fn coat(reader: &mut ParamReader<'_>, eta: &'static Parameter, names: &RoughnessNames) -> CoatDesc {
    CoatDesc {
        eta: reader.glass_index_by(eta),
        roughness: roughness(reader, names),
        thickness: reader.float_textured_by(&kinds::THICKNESS),
        albedo: reader.spectrum_textured_by(&kinds::ALBEDO),
        g: reader.float_textured_by(&kinds::G),
        max_depth: reader.integer_by(&kinds::MAX_DEPTH).unsigned_abs(),
        samples: reader.integer_by(&kinds::N_SAMPLES).unsigned_abs(),
    }
}

fn mix(reader: &mut ParamReader<'_>, materials: &mut Materials) -> MaterialKind {
    let name = kinds::MIX_MATERIALS.name;
    let missing = !reader.has(name);
    let span = reader.span;
    let slots = reader.take(name, &[ParamType::String]).and_then(|param| {
        let Values::Strings(names) = &param.values else {
            return None;
        };
        reader.check_count(&param, names.len(), 2)?;
        // Names get slots now and materials at the end: until then an id counts slots.
        Some([0, 1].map(|i| MaterialId(materials.named(names[i].clone(), param.values_span) as u32)))
    });
    if missing {
        let message = "a mix names its two `materials`: `\"string materials\" [ \"one\" \"other\" ]`";
        reader.report().error(span, message);
    }
    MaterialKind::Mix {
        materials: slots.unwrap_or([MaterialId(0); 2]),
        amount: reader.float_textured_by(&kinds::MIX_AMOUNT),
    }
}

/// A material by its name, if there is one. As in a mix, the id counts slots until the end.
fn part(reader: &mut ParamReader<'_>, materials: &mut Materials, parameter: &'static Parameter) -> Option<MaterialId> {
    let (name, span) = reader.string(parameter.name)?;
    Some(MaterialId(materials.named(name, span) as u32))
}

fn tinted(reader: &mut ParamReader<'_>, materials: &mut Materials) -> MaterialKind {
    if !reader.has(kinds::TINTED.name) {
        let span = reader.span;
        let message = "a tinted material names the one that it tints: `\"string material\" \"glass\"`";
        reader.report().error(span, message);
    }
    let material = part(reader, materials, &kinds::TINTED);
    let [reflectance, transmittance] =
        [&kinds::TINT_REFLECTED, &kinds::TINT_TRANSMITTED].map(|tint| reader.spectrum_textured_by(tint));
    match material {
        Some(material) => MaterialKind::Tinted {
            material,
            reflectance,
            transmittance,
        },
        None => default_material(reader.span).kind,
    }
}

/// As in pbrt-v4, what is said of the colour counts in this order.
fn hair(reader: &mut ParamReader<'_>) -> HairDesc {
    let names = [
        kinds::SIGMA_A.name,
        kinds::HAIR_REFLECTANCE.name,
        kinds::HAIR_COLOR.name,
        kinds::EUMELANIN.name,
        kinds::PHEOMELANIN.name,
    ];
    let given: Vec<&str> = names.into_iter().filter(|name| reader.has(name)).collect();
    if let [first, rest @ ..] = &given[..]
        && *first != kinds::EUMELANIN.name
    {
        for name in rest {
            let span = reader.span_of(name);
            let message = format!("`{name}` has no effect: there is `{first}`");
            reader.report().warning(span, message);
        }
    }
    let absorption = reader.absorption_by(&kinds::SIGMA_A);
    let colors = [&kinds::HAIR_REFLECTANCE, &kinds::HAIR_COLOR].map(|color| reader.reflectance_by(color));
    let [reflectance, color] = colors;
    let color = reflectance.or(color);
    let pigments = [&kinds::EUMELANIN, &kinds::PHEOMELANIN].map(|pigment| reader.pigment_by(pigment));
    HairDesc {
        color: match (absorption, color, pigments) {
            (Some(sigma), ..) => HairColorDesc::Absorption(sigma),
            (None, Some(color), _) => HairColorDesc::Reflectance(color),
            (None, None, [None, None]) => HairColorDesc::Pigments {
                eumelanin: Textured::Value(DEFAULT_EUMELANIN),
                pheomelanin: Textured::Value(0.0),
            },
            (None, None, [eumelanin, pheomelanin]) => HairColorDesc::Pigments {
                eumelanin: eumelanin.unwrap_or(Textured::Value(0.0)),
                pheomelanin: pheomelanin.unwrap_or(Textured::Value(0.0)),
            },
        },
        eta: reader.float_by(&kinds::HAIR_ETA) as f32,
        beta_m: reader.float_textured_by(&kinds::BETA_M),
        beta_n: reader.float_textured_by(&kinds::BETA_N),
        alpha: reader.float_textured_by(&kinds::HAIR_ALPHA),
    }
}

fn principled(reader: &mut ParamReader<'_>) -> PrincipledDesc {
    if reader.has(kinds::PRINCIPLED_ETA.name) && reader.has(kinds::SPECULAR.name) {
        let span = reader.span_of(kinds::SPECULAR.name);
        reader
            .report()
            .error(span, "a principled material has either `eta` or `specular`");
    }
    let given = reader.has(kinds::SPECULAR.name);
    let (eta, specular) = (
        reader.float_by(&kinds::PRINCIPLED_ETA),
        reader.float_by(&kinds::SPECULAR),
    );
    let reflected = (0.08 * specular).sqrt();
    let mut textured = |parameter: &'static Parameter| -> Textured<f32> { reader.float_textured_by(parameter) };
    PrincipledDesc {
        roughness: textured(&kinds::PRINCIPLED_ROUGHNESS),
        anisotropic: textured(&kinds::ANISOTROPIC),
        metallic: textured(&kinds::METALLIC),
        spec_trans: textured(&kinds::SPEC_TRANS),
        spec_tint: textured(&kinds::SPEC_TINT),
        sheen: textured(&kinds::SHEEN),
        sheen_tint: textured(&kinds::SHEEN_TINT),
        clearcoat: textured(&kinds::CLEARCOAT),
        clearcoat_gloss: textured(&kinds::CLEARCOAT_GLOSS),
        flatness: textured(&kinds::FLATNESS),
        base_color: reader.spectrum_textured_by(&kinds::BASE_COLOR),
        as_in_mitsuba: reader.bool_by(&kinds::ADDITIVE),
        eta: if given {
            ((1.0 + reflected) / (1.0 - reflected)) as f32
        } else {
            eta as f32
        },
    }
}

fn measured(reader: &mut ParamReader<'_>) -> Option<MeasuredDesc> {
    let name = kinds::MEASURED_FILE.name;
    if !reader.has(name) {
        let span = reader.span;
        let message = "a measured material names its file: `\"string filename\" \"metal.bsdf\"`";
        reader.report().error(span, message);
    }
    let (file, span) = reader.string(name)?;
    let path = reader.context.resolve(&file, span);
    let read = reader.context.read_text(&path).map_err(|e| e.to_string());
    match read.and_then(|bytes| rgl::parse(&bytes)) {
        Ok(desc) => Some(MeasuredDesc { path, ..desc }),
        Err(problem) => {
            let message = format!("cannot read the measured material {}: {problem}", path.display());
            reader.report().error(span, message);
            None
        }
    }
}
