//! Every kind of light and its parameters, for the reader and for `lucerna list lights`.

use super::parameter::{FloatRange, Parameter, ParameterKind};

/// A kind of light.
#[derive(Clone, Copy, Debug)]
pub struct LightEntry {
    /// As in a scene file.
    pub name: &'static str,
    /// The directive: `LightSource` or `AreaLightSource`.
    pub directive: &'static str,
    /// What it is, in a sentence without a full stop.
    pub doc: &'static str,
    /// Its parameters.
    pub parameters: &'static [&'static Parameter],
}

/// All kinds.
pub static LIGHTS: [LightEntry; 7] = [
    LightEntry {
        name: "point",
        directive: "LightSource",
        doc: "The same intensity in all directions from a point",
        parameters: &[&FROM, &INTENSITY, &POWER, &SCALE],
    },
    LightEntry {
        name: "spot",
        directive: "LightSource",
        doc: "From a point into a cone with a smooth rim",
        parameters: &[&FROM, &TO, &CONE_ANGLE, &CONE_DELTA, &INTENSITY, &POWER, &SCALE],
    },
    LightEntry {
        name: "goniometric",
        directive: "LightSource",
        doc: "From the origin with an intensity by direction, given by an image",
        parameters: &[&GONIOMETRIC_IMAGE, &INTENSITY, &POWER, &SCALE],
    },
    LightEntry {
        name: "projection",
        directive: "LightSource",
        doc: "A picture thrown from the origin towards +z",
        parameters: &[&PROJECTION_IMAGE, &FOV, &POWER, &SCALE],
    },
    LightEntry {
        name: "distant",
        directive: "LightSource",
        doc: "Parallel light",
        parameters: &[&FROM, &TO, &RADIANCE, &ILLUMINANCE, &SCALE],
    },
    LightEntry {
        name: "infinite",
        directive: "LightSource",
        doc: "Light from all around the scene, constant or by an image",
        parameters: &[&RADIANCE, &INFINITE_IMAGE, &PORTAL, &ILLUMINANCE, &SCALE],
    },
    LightEntry {
        name: "diffuse",
        directive: "AreaLightSource",
        doc: "A shape that emits the same radiance in all directions",
        parameters: &[&RADIANCE, &AREA_IMAGE, &TWO_SIDED, &POWER, &SCALE],
    },
];

const fn float(name: &'static str, default: f64, range: FloatRange, doc: &'static str) -> Parameter {
    let kind = ParameterKind::Float { default, range };
    Parameter { name, kind, doc }
}

const fn file(doc: &'static str) -> Parameter {
    Parameter {
        name: "filename",
        kind: ParameterKind::File,
        doc,
    }
}

const fn emission(name: &'static str, doc: &'static str) -> Parameter {
    let kind = ParameterKind::Emission;
    Parameter { name, kind, doc }
}

const fn photometric(name: &'static str, doc: &'static str) -> Parameter {
    let kind = ParameterKind::Photometric;
    Parameter { name, kind, doc }
}

pub(super) static FROM: Parameter = Parameter {
    name: "from",
    kind: ParameterKind::Point([0.0, 0.0, 0.0]),
    doc: "Where the light is, or where it comes from",
};
pub(super) static TO: Parameter = Parameter {
    name: "to",
    kind: ParameterKind::Point([0.0, 0.0, 1.0]),
    doc: "Where it shines to; not `from`",
};
pub(super) static INTENSITY: Parameter = emission("I", "Intensity in W/(sr nm), scaled to a luminance of 1 unless rgb");
pub(super) static RADIANCE: Parameter = emission(
    "L",
    "Radiance in W/(m2 sr nm), of a distant light irradiance in W/(m2 nm), scaled to a luminance of 1 unless rgb",
);
pub(super) static SCALE: Parameter = float("scale", 1.0, FloatRange::NotNegative, "A factor");
pub(super) static POWER: Parameter = photometric(
    "power",
    "Emitted power in lm (of each triangle of a mesh) before `scale`",
);
pub(super) static ILLUMINANCE: Parameter = photometric(
    "illuminance",
    "In lx before `scale`, of a surface that faces the light; of an image as pbrt-v4 counts it",
);
pub(super) static CONE_ANGLE: Parameter = float(
    "coneangle",
    30.0,
    FloatRange::HalfTurn,
    "Between the axis and the rim, in degrees",
);
pub(super) static CONE_DELTA: Parameter = float(
    "conedeltaangle",
    5.0,
    FloatRange::NotNegative,
    "The part of `coneangle` over which the light falls off, in degrees; no more than that",
);
pub(super) static FOV: Parameter = float(
    "fov",
    90.0,
    FloatRange::FieldOfView,
    "The angle of the picture's shorter side, in degrees",
);
pub(super) static GONIOMETRIC_IMAGE: Parameter =
    file("Factors of the intensity: square, equal-area octahedral, pole +y; required");
pub(super) static PROJECTION_IMAGE: Parameter = file("The picture; required");
pub(super) static INFINITE_IMAGE: Parameter = file(
    "Radiance instead of `L`: equal-area octahedral if square, latitude and longitude if twice as wide as high; pole +z",
);
pub(super) static AREA_IMAGE: Parameter = file("Radiance by texture coordinates, instead of `L`");
pub(super) static PORTAL: Parameter = Parameter {
    name: "portal",
    kind: ParameterKind::Points(4),
    doc: "Corners, in world space, of the rectangle that all light comes through",
};
pub(super) static TWO_SIDED: Parameter = Parameter {
    name: "twosided",
    kind: ParameterKind::Bool(false),
    doc: "Whether both sides emit",
};
