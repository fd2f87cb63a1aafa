//! Spheres, cylinders and disks, whole or in part.

use crate::desc::pbrt::reader::ParamReader;
use crate::desc::{QuadricDesc, ShapeKind};

pub(super) fn sphere(reader: &mut ParamReader<'_>) -> Option<ShapeKind> {
    let radius = reader.positive("radius", 1.0);
    let ends = heights(reader, [-radius, radius]);
    let phi_max = angle(reader);
    let (ends, phi_max) = (ends?, phi_max?);
    // As in pbrt, what is beyond the sphere is its pole.
    let z = ends.map(|z| z.clamp(-radius, radius));
    if z == [-radius, radius] && phi_max == 360.0 {
        return Some(ShapeKind::Sphere { radius });
    }
    let surface = QuadricDesc::Sphere { radius, z };
    (z[0] < z[1])
        .then_some(ShapeKind::Quadric { surface, phi_max })
        .or_else(|| {
            no_extent(
                reader,
                "zmin",
                "between `zmin` and `zmax` there is nothing of the sphere",
            );
            None
        })
}

pub(super) fn cylinder(reader: &mut ParamReader<'_>) -> Option<ShapeKind> {
    let radius = reader.positive("radius", 1.0);
    let z = heights(reader, [-1.0, 1.0]);
    let phi_max = angle(reader);
    let (z, phi_max) = (z?, phi_max?);
    let surface = QuadricDesc::Cylinder { radius, z };
    Some(ShapeKind::Quadric { surface, phi_max })
}

pub(super) fn disk(reader: &mut ParamReader<'_>) -> Option<ShapeKind> {
    let height = reader.float("height").unwrap_or(0.0);
    let radius = reader.positive("radius", 1.0);
    let inner_radius = reader.not_negative("innerradius", 0.0);
    let radial_uv = reader.boolean("radialuv", false);
    let phi_max = angle(reader)?;
    if inner_radius >= radius {
        no_extent(reader, "innerradius", "the hole of the disk is as large as the disk");
        return None;
    }
    let surface = QuadricDesc::Disk {
        height,
        radius,
        inner_radius,
        radial_uv,
    };
    Some(ShapeKind::Quadric { surface, phi_max })
}

/// `zmin` and `zmax` in ascending order, whichever is which, as in pbrt; a complaint if they are equal.
fn heights(reader: &mut ParamReader<'_>, default: [f64; 2]) -> Option<[f64; 2]> {
    let low = reader.float("zmin").unwrap_or(default[0]);
    let high = reader.float("zmax").unwrap_or(default[1]);
    if low == high {
        no_extent(reader, "zmin", "`zmin` and `zmax` are equal: the shape has no extent");
        return None;
    }
    Some([low.min(high), low.max(high)])
}

/// Degrees in (0, 360]. As in pbrt more is all the way round; a complaint if it is nothing.
fn angle(reader: &mut ParamReader<'_>) -> Option<f64> {
    let angle = reader.float("phimax").unwrap_or(360.0).min(360.0);
    if angle > 0.0 {
        return Some(angle);
    }
    no_extent(
        reader,
        "phimax",
        "`phimax` must be more than 0 degrees: the shape has no extent",
    );
    None
}

fn no_extent(reader: &mut ParamReader<'_>, name: &str, message: &str) {
    let span = reader.span_of(name);
    reader.report().error(span, message);
}
