//! The plugins of Mitsuba: those that are read, and those that are known and refused.

use super::xml::Element;
use crate::desc::report::Report;
use crate::desc::suggest;
use crate::error::Span;

/// The classes of objects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Class {
    Scene,
    Bsdf,
    Emitter,
    Film,
    Integrator,
    Medium,
    Phase,
    Filter,
    Sampler,
    Sensor,
    Shape,
    Texture,
    Volume,
    /// Fields, which nothing reads.
    Other,
}

/// All elements outside transforms.
pub(super) const TAGS: &[&str] = &[
    "boolean",
    "integer",
    "float",
    "string",
    "point",
    "vector",
    "rgb",
    "spectrum",
    "transform",
    "ref",
    "alias",
    "default",
    "include",
    "path",
    "bsdf",
    "emitter",
    "film",
    "integrator",
    "medium",
    "phase",
    "rfilter",
    "sampler",
    "sensor",
    "shape",
    "texture",
    "volume",
];

impl Class {
    /// As in a file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scene => "scene",
            Self::Bsdf => "bsdf",
            Self::Emitter => "emitter",
            Self::Film => "film",
            Self::Integrator => "integrator",
            Self::Medium => "medium",
            Self::Phase => "phase",
            Self::Filter => "rfilter",
            Self::Sampler => "sampler",
            Self::Sensor => "sensor",
            Self::Shape => "shape",
            Self::Texture => "texture",
            Self::Volume => "volume",
            Self::Other => "object",
        }
    }

    /// The types that are read, and those that Mitsuba has beside them.
    fn plugins(self) -> (&'static [&'static str], &'static [&'static str]) {
        match self {
            Self::Bsdf => (BSDFS, BSDFS_REFUSED),
            Self::Emitter => (EMITTERS, EMITTERS_REFUSED),
            Self::Film => (&["hdrfilm"], &["specfilm", "ldrfilm", "mfilm", "tiledhdrfilm"]),
            Self::Integrator => (INTEGRATORS, INTEGRATORS_REFUSED),
            Self::Filter => (&["box", "tent", "gaussian", "mitchell", "catmullrom", "lanczos"], &[]),
            Self::Sampler => (SAMPLERS, &[]),
            Self::Sensor => (
                &["perspective", "thinlens", "orthographic"],
                &[
                    "batch",
                    "distant",
                    "irradiancemeter",
                    "radiancemeter",
                    "volprim_rf_basic",
                    "telecentric",
                    "spherical",
                ],
            ),
            Self::Shape => (SHAPES, SHAPES_REFUSED),
            Self::Texture => (TEXTURES, TEXTURES_REFUSED),
            Self::Medium => (&["homogeneous"], &["heterogeneous"]),
            Self::Phase => (&["isotropic", "hg"], &["rayleigh", "blendphase", "tabphase", "sggx"]),
            Self::Volume => (&["constvolume"], &["gridvolume"]),
            Self::Scene | Self::Other => (&[], &[]),
        }
    }
}

const BSDFS: &[&str] = &[
    "diffuse",
    "conductor",
    "dielectric",
    "thindielectric",
    "roughconductor",
    "roughdielectric",
    "plastic",
    "roughplastic",
    "principled",
    "mask",
    "twosided",
    "blendbsdf",
    "bumpmap",
    "normalmap",
    "null",
];
const BSDFS_REFUSED: &[&str] = &[
    "principledthin",
    "measured",
    "measured_polarized",
    "pplastic",
    "polarizer",
    "retarder",
    "circular",
    "hair",
    "bsdf",
];
const EMITTERS: &[&str] = &[
    "area",
    "directionalarea",
    "point",
    "spot",
    "directional",
    "constant",
    "envmap",
    "projector",
];
const EMITTERS_REFUSED: &[&str] = &["sunsky", "sky", "sun", "timed_sunsky", "volumelight", "collimated"];
const INTEGRATORS: &[&str] = &[
    "path",
    "direct",
    "ptracer",
    "volpath",
    "volpathmis",
    "bdpt",
    "photonmapper",
    "sppm",
];
const INTEGRATORS_REFUSED: &[&str] = &[
    "aov",
    "depth",
    "moment",
    "stokes",
    "prb",
    "prb_basic",
    "prb_projective",
    "prbvolpath",
    "direct_projective",
    "direct_reparam",
    "prb_reparam",
    "emission_reparam",
    "pssmlt",
    "mlt",
    "erpt",
    "ppm",
    "irrcache",
    "adaptive",
    "vpl",
    "ao",
];
const SAMPLERS: &[&str] = &[
    "independent",
    "stratified",
    "multijitter",
    "orthogonal",
    "ldsampler",
    "sobol",
    "halton",
    "hammersley",
];
const SHAPES: &[&str] = &[
    "rectangle",
    "cube",
    "sphere",
    "disk",
    "cylinder",
    "linearcurve",
    "bsplinecurve",
    "obj",
    "ply",
    "serialized",
    "shapegroup",
    "instance",
];
const SHAPES_REFUSED: &[&str] = &[
    "sdfgrid",
    "ellipsoids",
    "ellipsoidsmesh",
    "merge",
    "blender",
    "hair",
    "heightfield",
];
const TEXTURES: &[&str] = &[
    "bitmap",
    "checkerboard",
    "mesh_attribute",
    "rgb",
    "srgb",
    "srgb_d65",
    "uniform",
    "regular",
    "irregular",
    "blackbody",
    "d65",
];
const TEXTURES_REFUSED: &[&str] = &[
    "volume",
    "rawconstant",
    "raw_constant",
    "curvature",
    "vertexcolors",
    "wireframe",
    "scale",
];

/// The class that an element makes an object of.
pub(super) fn class_of(element: &Element) -> Option<Class> {
    Some(match element.tag.as_str() {
        "scene" => Class::Scene,
        "bsdf" => Class::Bsdf,
        "emitter" => Class::Emitter,
        "film" => Class::Film,
        "integrator" => Class::Integrator,
        "medium" => Class::Medium,
        "rfilter" => Class::Filter,
        "sampler" => Class::Sampler,
        "sensor" => Class::Sensor,
        "shape" => Class::Shape,
        "texture" => Class::Texture,
        "phase" => Class::Phase,
        "volume" => Class::Volume,
        "field" => Class::Other,
        "spectrum" if element.attribute("type").is_some() => Class::Texture,
        _ => return None,
    })
}

/// Complains about a type that Mitsuba does not have. Those that are not supported are complained about where they are used.
pub(super) fn check(report: &mut Report, class: Class, plugin: &str, span: Span) {
    let (read, refused) = class.plugins();
    if read.is_empty() && refused.is_empty() || read.contains(&plugin) || refused.contains(&plugin) {
        return;
    }
    let known: Vec<&str> = read.iter().chain(refused).copied().collect();
    let help = match suggest::closest(plugin, &known) {
        Some(name) => format!("did you mean `{name}`?"),
        None => format!("supported are {}", read.join(", ")),
    };
    let message = format!("there is no {} of the type `{plugin}`", class.name());
    report.error_with_help(span, message, Some(help));
}

/// Complains about an object of a type that is known and not supported.
pub(super) fn refuse(report: &mut Report, class: Class, plugin: &str, span: Span, instead: &str) {
    let (read, refused) = class.plugins();
    // Others have been complained about.
    if refused.contains(&plugin) {
        let message = format!("the {} `{plugin}` is not supported", class.name());
        let help = (!read.is_empty()).then(|| format!("supported are {}", read.join(", ")));
        report.unsupported_with_help(span, message, instead, help);
    }
}
