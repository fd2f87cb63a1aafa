//! Arrays of vectors and of vertex indices.

use glam::Vec3;

use crate::desc::pbrt::params::{Param, ParamType, Values, value_span};
use crate::desc::pbrt::reader::ParamReader;
use crate::error::Span;

/// The values of a vertex attribute, if there are as many as there are vertices; else a complaint.
pub(super) fn as_many<T>(
    reader: &mut ParamReader<'_>,
    name: &str,
    values: Option<(Vec<T>, Span)>,
    count: usize,
) -> Option<Vec<T>> {
    let (values, span) = values?;
    if values.len() == count {
        return Some(values);
    }
    let message = format!("`{name}` is given for {} vertices, but there are {count}", values.len());
    reader.report().error(span, message);
    None
}

/// The vectors of a parameter, and their place.
pub(super) fn vectors3(reader: &mut ParamReader<'_>, name: &'static str, kind: ParamType) -> Option<(Vec<Vec3>, Span)> {
    vectors(reader, name, kind, |[x, y, z]: [f32; 3]| Vec3::new(x, y, z))
}

/// The numbers of a parameter by groups of `N`, and their place.
pub(super) fn vectors<T, const N: usize>(
    reader: &mut ParamReader<'_>,
    name: &'static str,
    kind: ParamType,
    make: impl Fn([f32; N]) -> T,
) -> Option<(Vec<T>, Span)> {
    let param = reader.take(name, &[kind])?;
    let Values::Numbers(numbers) = &param.values else {
        return None;
    };
    let (groups, rest) = numbers.as_chunks::<N>();
    if !rest.is_empty() || groups.is_empty() {
        let message = format!("`{name}` takes {N} numbers a vertex, found {} in all", numbers.len());
        reader.report().error(param.values_span, message);
        return None;
    }
    let mut values = Vec::with_capacity(groups.len());
    for (i, group) in groups.iter().enumerate() {
        let group = group.map(|v| v as f32);
        if let Some(j) = group.iter().position(|v| !v.is_finite()) {
            let span = value_span(reader.report(), &param, i * N + j);
            let message = format!("this number of `{name}` does not fit into 32-bit floating point");
            reader.report().error(span, message);
            return None;
        }
        values.push(make(group));
    }
    Some((values, param.values_span))
}

/// The vertices `P`; complains if there are none.
pub(super) fn vertices(reader: &mut ParamReader<'_>, shape: &str) -> Option<Vec<Vec3>> {
    let positions = vectors3(reader, "P", ParamType::Point3);
    if positions.is_none() && !reader.has("P") {
        let span = reader.span;
        let message = format!("this `{shape}` has no vertices `\"point3 P\"`");
        reader.report().error(span, message);
    }
    positions.map(|(positions, _)| positions)
}

/// Vertex indices by groups of `N`, all below `count`. `face` is what such a group is called.
pub(super) fn corners<const N: usize>(
    reader: &mut ParamReader<'_>,
    param: &Param,
    count: usize,
    face: &str,
) -> Option<Vec<[u32; N]>> {
    let Values::Integers(indices) = &param.values else {
        return None;
    };
    let (groups, rest) = indices.as_chunks::<N>();
    if !rest.is_empty() || groups.is_empty() {
        let message = format!("`indices` takes {N} integers a {face}, found {} in all", indices.len());
        reader.report().error(param.values_span, message);
        return None;
    }
    let valid = |i: &i32| usize::try_from(*i).is_ok_and(|i| i < count);
    if let Some(bad) = indices.iter().position(|i| !valid(i)) {
        let span = value_span(reader.report(), param, bad);
        let message = format!("there is no vertex {}: `P` has {count}, counted from 0", indices[bad]);
        reader.report().error(span, message);
        return None;
    }
    Some(groups.iter().map(|t| t.map(i32::cast_unsigned)).collect())
}

/// The indices of a mesh of `count` vertices; one of `N` needs none. Without vertices, of which something else is wrong, they are passed over.
pub(super) fn indices<const N: usize>(
    reader: &mut ParamReader<'_>,
    shape: &str,
    count: Option<usize>,
    face: &str,
) -> Option<Vec<[u32; N]>> {
    let param = reader.take("indices", &[ParamType::Integer]);
    let count = count?;
    match param {
        Some(param) => corners(reader, &param, count, face),
        None if count == N && !reader.has("indices") => Some(vec![std::array::from_fn(|i| i as u32)]),
        None => {
            if !reader.has("indices") {
                let span = reader.span;
                let message =
                    format!("this `{shape}` has no `\"integer indices\"`; only one of {N} vertices needs none");
                reader.report().error(span, message);
            }
            None
        }
    }
}
