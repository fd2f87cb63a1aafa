//! `Camera`.

use std::sync::Arc;

use super::options::Surroundings;
use super::params::ParamType;
use super::reader::{ParamReader, unknown_type};
use super::realistic;
use crate::desc::{ApertureDesc, CameraDesc, CameraKind, MotionDesc};
use crate::error::Span;
use crate::sampling::SphereMap;

const KNOWN: [&str; 4] = ["perspective", "orthographic", "spherical", "realistic"];

/// A camera and the name of its view, if it has one.
#[derive(Clone, Debug)]
pub(super) struct NamedCamera {
    pub name: Option<(String, Span)>,
    pub camera: CameraDesc,
    pub span: Span,
}

/// The camera of a file without one.
pub(super) fn default_camera(camera_from_world: MotionDesc) -> CameraDesc {
    CameraDesc {
        kind: CameraKind::Perspective {
            fov: 90.0,
            near_clip: 0.0,
        },
        screen: None,
        frame_aspect: None,
        lens_radius: 0.0,
        focal_distance: 1e6,
        aperture: ApertureDesc::Round,
        shutter: [0.0, 1.0],
        medium: None,
        camera_from_world,
    }
}

/// Reads a camera; one of another type becomes a perspective one.
pub(super) fn read(mut reader: ParamReader<'_>, kind: &str, around: Surroundings) -> NamedCamera {
    let span = reader.span;
    let default = CameraDesc {
        medium: around.medium,
        ..default_camera(around.ctm)
    };
    let kind = match kind {
        "perspective" => Some(CameraKind::Perspective {
            fov: reader.float_in(
                "fov",
                90.0,
                |v| v > 0.0 && v < 180.0,
                "more than 0 and less than 180 degrees",
            ),
            near_clip: reader.not_negative("nearclip", 0.0),
        }),
        "orthographic" => Some(CameraKind::Orthographic),
        "spherical" => Some(CameraKind::Spherical(sphere_map(&mut reader))),
        "realistic" => realistic::read(&mut reader).map(|desc| CameraKind::Realistic(Arc::new(desc))),
        _ => {
            let instead = "a perspective one with default parameters stands in";
            unknown_type(reader.report(), "camera", kind, span, (&KNOWN, &[]), instead);
            return NamedCamera {
                name: None,
                camera: default,
                span,
            };
        }
    };
    let common = CameraDesc {
        shutter: shutter(&mut reader),
        kind: kind.clone().unwrap_or_else(|| default.kind.clone()),
        ..default
    };
    let camera = match kind {
        Some(CameraKind::Perspective { .. } | CameraKind::Orthographic) => CameraDesc {
            screen: screen_window(&mut reader),
            frame_aspect: reader
                .has("frameaspectratio")
                .then(|| reader.positive("frameaspectratio", 1.0)),
            lens_radius: reader.not_negative("lensradius", 0.0),
            focal_distance: reader.positive("focaldistance", common.focal_distance),
            aperture: aperture(&mut reader),
            ..common
        },
        Some(CameraKind::Spherical(_)) => {
            let why = "a spherical camera has neither a screen nor a lens";
            let names = ["screenwindow", "frameaspectratio", "lensradius", "focaldistance"];
            reader.inert(&names.map(|name| (name, why)));
            common
        }
        Some(CameraKind::Realistic(_)) | None => common,
    };
    let name = view_name(&mut reader);
    reader.finish();
    NamedCamera { name, camera, span }
}

fn sphere_map(reader: &mut ParamReader<'_>) -> SphereMap {
    let Some((name, span)) = reader.string("mapping") else {
        return SphereMap::EqualArea;
    };
    match name.as_str() {
        "equalarea" => SphereMap::EqualArea,
        "equirectangular" => SphereMap::LatLong,
        _ => {
            let known = ["equalarea", "equirectangular"];
            let message = format!("a spherical camera's `mapping` is `equalarea` or `equirectangular`, not `{name}`");
            reader
                .report()
                .unknown(span, message, "it is `equalarea`", &name, &known);
            SphereMap::EqualArea
        }
    }
}

fn screen_window(reader: &mut ParamReader<'_>) -> Option<[f64; 4]> {
    let v = reader.numbers("screenwindow", ParamType::Float, 4)?;
    let window = [v[0], v[1], v[2], v[3]];
    if window[0] == window[1] || window[2] == window[3] {
        let span = reader.span_of("screenwindow");
        reader.report().error(span, "the screen window is empty");
        return None;
    }
    Some(window)
}

fn aperture(reader: &mut ParamReader<'_>) -> ApertureDesc {
    let valid = |v: i32| v == 0 || (3..=64).contains(&v);
    let blades = reader.integer_in("blades", 0, valid, "between 3 and 64, or 0 for a round lens");
    let rotation = reader.float("bladerotation").unwrap_or(0.0);
    match blades.unsigned_abs() {
        0 => ApertureDesc::Round,
        blades => ApertureDesc::Polygon { blades, rotation },
    }
}

fn shutter(reader: &mut ParamReader<'_>) -> [f64; 2] {
    let open = reader.float("shutteropen").unwrap_or(0.0);
    let close = reader.float("shutterclose").unwrap_or(1.0);
    if open < close {
        return [open, close];
    }
    let span = reader.span_of("shutterclose");
    let message = format!("the shutter closes at {close}, which must be after it opens, at {open}");
    reader.report().error(span, message);
    [0.0, 1.0]
}

/// The name of the view; it may become a part of a file name.
fn view_name(reader: &mut ParamReader<'_>) -> Option<(String, Span)> {
    let (name, span) = reader.string("name")?;
    let fit = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.' | ' ');
    if name.trim().is_empty() || name.starts_with('.') || !name.chars().all(fit) {
        let message =
            "the name of a view has letters, digits, spaces, `-`, `_` and `.` only, and does not start with `.`";
        reader.report().error(span, message);
        return None;
    }
    Some((name, span))
}
