//! Every kind of light and its parameters, for the reader and for `lucerna list lights`.

use super::Entry;
use super::parameter::{FloatRange, Parameter, ParameterKind};

/// All kinds.
pub static LIGHTS: [Entry; 7] = [
    Entry::new(
        "LightSource",
        "point",
        "The same intensity in all directions from a point",
        &[&FROM, &INTENSITY, &POWER, &SCALE],
    ),
    Entry::new(
        "LightSource",
        "spot",
        "From a point into a cone with a smooth rim",
        &[
            &FROM,
            &TO,
            &CONE_ANGLE,
            &CONE_DELTA,
            &FALLOFF,
            &INTENSITY,
            &POWER,
            &SCALE,
        ],
    ),
    Entry::new(
        "LightSource",
        "goniometric",
        "From the origin with an intensity by direction, given by an image",
        &[&GONIOMETRIC_IMAGE, &INTENSITY, &POWER, &SCALE],
    ),
    Entry::new(
        "LightSource",
        "projection",
        "A picture thrown from the origin towards +z",
        &[&PROJECTION_IMAGE, &FOV, &POWER, &SCALE],
    ),
    Entry::new(
        "LightSource",
        "distant",
        "Parallel light",
        &[&FROM, &TO, &IRRADIANCE, &ILLUMINANCE, &SCALE],
    ),
    Entry::new(
        "LightSource",
        "infinite",
        "Light from all around the scene, constant or by an image",
        &[&RADIANCE, &INFINITE_IMAGE, &PORTAL, &ILLUMINANCE, &SCALE],
    ),
    Entry::new(
        "AreaLightSource",
        "diffuse",
        "A shape that emits the same radiance in all directions",
        &[&RADIANCE, &AREA_IMAGE, &TWO_SIDED, &SPREAD, &POWER, &SCALE],
    ),
];

pub static FROM: Parameter = Parameter::new(
    "from",
    ParameterKind::Point([0.0, 0.0, 0.0]),
    "Where the light is, or where it comes from",
)
.unit("scene units");
pub static TO: Parameter = Parameter::new(
    "to",
    ParameterKind::Point([0.0, 0.0, 1.0]),
    "Where it shines to; not `from`",
)
.unit("scene units");
pub static INTENSITY: Parameter = Parameter::new(
    "I",
    ParameterKind::Emission,
    "Intensity, scaled to a luminance of 1 unless rgb",
)
.unit("W/(sr nm)");
pub static RADIANCE: Parameter = Parameter::new(
    "L",
    ParameterKind::Emission,
    "Radiance, scaled to a luminance of 1 unless rgb",
)
.unit("W/(m2 sr nm)");
pub static IRRADIANCE: Parameter = Parameter::new(
    "L",
    ParameterKind::Emission,
    "Irradiance of a surface that faces the light, scaled to a luminance of 1 unless rgb",
)
.unit("W/(m2 nm)");
pub static SCALE: Parameter = Parameter::float("scale", 1.0, FloatRange::NotNegative, "A factor");
pub static POWER: Parameter = Parameter::new(
    "power",
    ParameterKind::Photometric,
    "Emitted power (of each triangle of a mesh) before `scale`, instead of what the spectrum says",
)
.unit("lm");
pub static ILLUMINANCE: Parameter = Parameter::new("illuminance", ParameterKind::Photometric, "Before `scale`, of a surface that faces the light, instead of what the spectrum says; of an image as pbrt-v4 counts it").unit("lx");
pub static CONE_ANGLE: Parameter =
    Parameter::float("coneangle", 30.0, FloatRange::HalfTurn, "Between the axis and the rim").unit("degrees");
pub static CONE_DELTA: Parameter = Parameter::float(
    "conedeltaangle",
    5.0,
    FloatRange::NotNegative,
    "The part of `coneangle` over which the light falls off; no more than that",
)
.unit("degrees");
pub static FALLOFF: Parameter = Parameter::choice(
    "falloff",
    &["smooth", "linear"],
    "By a smooth step over the cosine, or in proportion to the angle to the rim, as in Mitsuba (an extension)",
);
pub static FOV: Parameter = Parameter::float(
    "fov",
    90.0,
    FloatRange::FieldOfView,
    "The angle of the picture's shorter side",
)
.unit("degrees");
pub static GONIOMETRIC_IMAGE: Parameter = Parameter::file(
    "filename",
    "Factors of the intensity: square, equal-area octahedral, pole +y; required",
);
pub static PROJECTION_IMAGE: Parameter = Parameter::file("filename", "The picture; required");
pub static INFINITE_IMAGE: Parameter = Parameter::file(
    "filename",
    "Radiance instead of `L`: equal-area octahedral if square, latitude and longitude if twice as wide as high; pole +z",
);
pub static AREA_IMAGE: Parameter = Parameter::file("filename", "Radiance by texture coordinates, instead of `L`");
pub static PORTAL: Parameter = Parameter::new(
    "portal",
    ParameterKind::Points(4),
    "Corners, in world space, of the rectangle that all light comes through",
)
.unit("scene units");
pub static TWO_SIDED: Parameter = Parameter::flag("twosided", false, "Whether both sides emit");
pub static SPREAD: Parameter = Parameter::choice(
    "spread",
    &["diffuse", "normal"],
    "In all directions, or along the normal only, `L` being power by area, which only paths from lights find (an extension)",
);
