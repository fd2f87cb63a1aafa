//! `Shape "tubes"`: round curves, an extension.

use std::sync::Arc;

use super::arrays::{as_many, vectors, vertices};
use super::curve::{complain, one_of};
use crate::desc::pbrt::params::{Param, ParamType, Values, value_span};
use crate::desc::pbrt::reader::ParamReader;
use crate::desc::{ShapeKind, TubeBasis, TubesDesc};

pub(super) fn tubes(reader: &mut ParamReader<'_>) -> Option<ShapeKind> {
    let bases = [("linear", TubeBasis::Linear), ("bspline", TubeBasis::CubicBSpline)];
    let basis = one_of(reader, "basis", &bases);
    let radii = vectors(reader, "radius", ParamType::Float, |[radius]: [f32; 1]| radius);
    let counts = reader.take("counts", &[ParamType::Integer]);
    let points = vertices(reader, "tubes");
    let (basis, points) = (basis?, points?);
    let radii = match radii {
        // One for all; a curve has two points at least.
        Some((radii, _)) if radii.len() == 1 => vec![radii[0]; points.len()],
        None if !reader.has("radius") => vec![1.0; points.len()],
        radii => as_many(reader, "radius", radii, points.len())?,
    };
    if let Some(negative) = radii.iter().find(|radius| **radius < 0.0) {
        reader.out_of_range("radius", &negative.to_string(), "0 or more");
        return None;
    }
    let counts = match counts {
        Some(param) => several(reader, &param, basis, points.len())?,
        None if reader.has("counts") => return None,
        None if points.len() < basis.least_points() as usize => {
            let message = format!(
                "`P` has {} points, expected {} or more",
                points.len(),
                basis.least_points()
            );
            complain(reader, "P", &message);
            return None;
        }
        // There are fewer points than bytes in a file.
        None => vec![points.len() as u32],
    };
    Some(ShapeKind::Tubes(Arc::new(TubesDesc {
        basis,
        points,
        radii,
        counts,
    })))
}

/// How many of the `total` points each curve has.
fn several(reader: &mut ParamReader<'_>, param: &Param, basis: TubeBasis, total: usize) -> Option<Vec<u32>> {
    let Values::Integers(counts) = &param.values else {
        return None;
    };
    let least = basis.least_points();
    let is_few = |count: &i32| u32::try_from(*count).map_or(true, |count| count < least);
    if let Some(index) = counts.iter().position(is_few) {
        let span = value_span(reader.report(), param, index);
        let message = format!("a curve of {} points, expected {least} or more", counts[index]);
        reader.report().error(span, message);
        return None;
    }
    let sum: u64 = counts.iter().map(|count| u64::from(count.unsigned_abs())).sum();
    if sum != total as u64 {
        let message = format!("`counts` are {sum} points together, but `P` has {total}");
        reader.report().error(param.values_span, message);
        return None;
    }
    Some(counts.iter().map(|count| count.unsigned_abs()).collect())
}
