//! `Shape "curve"`.

use std::sync::Arc;

use glam::Vec3;

use super::arrays::{vectors3, vertices};
use crate::desc::pbrt::params::ParamType;
use crate::desc::pbrt::reader::ParamReader;
use crate::desc::{CurveDesc, CurveKindDesc, ShapeKind};

/// The finest that curves are divided in advance.
const DEEPEST: i32 = 10;

pub(super) fn curve(reader: &mut ParamReader<'_>) -> Option<ShapeKind> {
    let kinds = [
        ("flat", CurveKindDesc::Flat),
        ("cylinder", CurveKindDesc::Cylinder),
        ("ribbon", CurveKindDesc::Ribbon),
    ];
    let kind = one_of(reader, "type", &kinds);
    let is_spline = one_of(reader, "basis", &[("bezier", false), ("bspline", true)]);
    let degree = reader.integer_in("degree", 3, |d| d == 2 || d == 3, "2 or 3");
    let split_depth = reader.integer_in("splitdepth", 3, |d| (0..=DEEPEST).contains(&d), "from 0 to 10");
    let width = reader.not_negative("width", 1.0);
    let widths = ["width0", "width1"].map(|name| reader.not_negative(name, width));
    let normals = vectors3(reader, "N", ParamType::Normal);
    let points = vertices(reader, "curve");
    let (kind, is_spline, points) = (kind?, is_spline?, points?);
    let segments = if is_spline {
        spline_segments(&points, degree)
    } else {
        bezier_segments(&points, degree)
    };
    let Some(segments) = segments else {
        let expected = if is_spline {
            format!("{} or more", degree + 1)
        } else {
            format!("{} and {degree} for each further segment", degree + 1)
        };
        complain(
            reader,
            "P",
            &format!("`P` has {} points, expected {expected}", points.len()),
        );
        return None;
    };
    let normals = match (kind, normals) {
        (CurveKindDesc::Ribbon, Some((normals, _))) if normals.len() == segments.len() + 1 => normals,
        (CurveKindDesc::Ribbon, Some((normals, _))) => {
            let count = segments.len() + 1;
            complain(
                reader,
                "N",
                &format!(
                    "`N` is given {} times, expected {count}, at both ends of each segment",
                    normals.len()
                ),
            );
            return None;
        }
        (CurveKindDesc::Ribbon, None) => {
            if !reader.has("N") {
                complain(
                    reader,
                    "type",
                    "a ribbon needs normals `\"normal N\"` at both ends of each segment",
                );
            }
            return None;
        }
        (_, Some((_, span))) => {
            reader
                .report()
                .warning(span, "`N` has no effect: only ribbons have normals");
            Vec::new()
        }
        (_, None) => Vec::new(),
    };
    if let Some(index) = normals.iter().position(|n| n.length_squared() == 0.0) {
        complain(reader, "N", &format!("normal {index} of `N` is zero"));
        return None;
    }
    if widths == [0.0; 2] {
        complain(reader, "width", "the curve has no width");
        return None;
    }
    Some(ShapeKind::Curve(Arc::new(CurveDesc {
        kind,
        segments,
        widths,
        normals,
        split_depth: split_depth.unsigned_abs(),
    })))
}

pub(super) fn complain(reader: &mut ParamReader<'_>, name: &str, message: &str) {
    let span = reader.span_of(name);
    reader.report().error(span, message);
}

/// The meaning of a word, the first by default.
pub(super) fn one_of<T: Copy>(reader: &mut ParamReader<'_>, name: &'static str, words: &[(&str, T)]) -> Option<T> {
    let Some((word, span)) = reader.string(name) else {
        return (!reader.has(name)).then(|| words[0].1);
    };
    if let Some((_, meaning)) = words.iter().find(|(known, _)| *known == word) {
        return Some(*meaning);
    }
    let known: Vec<&str> = words.iter().map(|(known, _)| *known).collect();
    let message = format!("`{name}` is `{word}`, expected {}", known.join(", "));
    reader.report().error(span, message);
    None
}

/// Each segment begins where the one before ends.
fn bezier_segments(points: &[Vec3], degree: i32) -> Option<Vec<[Vec3; 4]>> {
    let degree = degree.unsigned_abs() as usize;
    if points.len() <= degree || !(points.len() - 1).is_multiple_of(degree) {
        return None;
    }
    let starts = (0..points.len() - 1).step_by(degree);
    Some(starts.map(|i| cubic(&points[i..=i + degree])).collect())
}

/// Uniform B-splines: each point begins a segment that the next ones shape.
fn spline_segments(points: &[Vec3], degree: i32) -> Option<Vec<[Vec3; 4]>> {
    let degree = degree.unsigned_abs() as usize;
    if points.len() <= degree {
        return None;
    }
    let segment = |p: &[Vec3]| match *p {
        [a, b, c] => cubic(&[(a + b) * 0.5, b, (b + c) * 0.5]),
        _ => {
            let [a, b, c, d] = [p[0], p[1], p[2], p[3]];
            [
                (a + b * 4.0 + c) / 6.0,
                (b * 2.0 + c) / 3.0,
                (b + c * 2.0) / 3.0,
                (b + c * 4.0 + d) / 6.0,
            ]
        }
    };
    Some(points.windows(degree + 1).map(segment).collect())
}

/// The cubic that a Bézier curve of three or four points is.
fn cubic(points: &[Vec3]) -> [Vec3; 4] {
    match *points {
        [a, b, c] => [a, (a + b * 2.0) / 3.0, (b * 2.0 + c) / 3.0, c],
        _ => [points[0], points[1], points[2], points[3]],
    }
}
