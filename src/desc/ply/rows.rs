//! Rows of a binary file that all have the same length, decoded in parallel.

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::Columns;
use super::cursor::decode;
use super::header::{Element, Encoding, Scalar};
use crate::desc::MeshDesc;

/// Rows that one task decodes, at least.
const SPAN: usize = 1 << 14;

/// Puts the vertices of `rows` into the mesh, which has none, and their attributes into those of the mesh from the given one on.
pub(super) fn vertices(
    rows: &[u8],
    row: usize,
    element: &Element,
    columns: &Columns,
    encoding: Encoding,
    mesh: &mut MeshDesc,
    first_attribute: usize,
) {
    let at = numbers(element, encoding);
    let vectors = |columns: [usize; 3], into: &mut Vec<Vec3>| {
        let tuple = tuples(element, encoding, columns);
        rows.par_chunks_exact(row)
            .with_min_len(SPAN)
            .map(|row| Vec3::from_array(tuple(row)))
            .collect_into_vec(into);
    };
    vectors(columns.position, &mut mesh.positions);
    if let Some(normal) = columns.normal {
        vectors(normal, &mut mesh.normals);
    }
    if let Some(uv) = columns.uv {
        let tuple = tuples(element, encoding, uv);
        rows.par_chunks_exact(row)
            .with_min_len(SPAN)
            .map(|row| Vec2::from_array(tuple(row)))
            .collect_into_vec(&mut mesh.uvs);
    }
    for (attribute, columns) in mesh.attributes[first_attribute..].iter_mut().zip(&columns.attributes) {
        let values = |row| columns.values(|i| at(row, i)).collect::<Vec<_>>();
        let rows = rows.par_chunks_exact(row).with_min_len(SPAN);
        attribute.values = rows.flat_map_iter(values).collect();
    }
}

/// The number in a column of a row.
fn numbers(element: &Element, encoding: Encoding) -> impl Fn(&[u8], usize) -> f32 + Sync + '_ {
    let offsets: Vec<usize> = element
        .properties
        .iter()
        .scan(0, |end, p| {
            let start = *end;
            *end += p.value.bytes();
            Some(start)
        })
        .collect();
    move |row, i| decode(&row[offsets[i]..], element.properties[i].value, encoding) as f32
}

/// The numbers in some columns of a row.
pub(super) fn tuples<const N: usize>(
    element: &Element,
    encoding: Encoding,
    columns: [usize; N],
) -> impl Fn(&[u8]) -> [f32; N] + Sync + '_ {
    let at = numbers(element, encoding);
    let offset = |column| {
        element.properties[..column]
            .iter()
            .map(|p| p.value.bytes())
            .sum::<usize>()
    };
    let offsets = columns.map(offset);
    // Nearly all files have these, and a decision for each number takes longer than all the rest.
    let are_floats = columns.iter().all(|&i| element.properties[i].value == Scalar::F32);
    let is_plain = are_floats && encoding == Encoding::LittleEndian;
    move |row| {
        if is_plain {
            offsets.map(|i| f32::from_le_bytes([row[i], row[i + 1], row[i + 2], row[i + 3]]))
        } else {
            columns.map(|i| at(row, i))
        }
    }
}

/// The bytes of a triangle, if faces are nothing but a list with a length of one byte and corners of four.
pub(super) fn triangle_row(element: &Element) -> Option<usize> {
    match &element.properties[..] {
        [corners]
            if matches!(corners.length, Some(Scalar::U8 | Scalar::I8))
                && matches!(corners.value, Scalar::I32 | Scalar::U32) =>
        {
            Some(1 + 3 * 4)
        }
        _ => None,
    }
}

/// The triangles of `rows`; `None` unless all faces are triangles whose corners are not negative.
pub(super) fn triangles(rows: &[u8], row: usize, encoding: Encoding) -> Option<Vec<[u32; 3]>> {
    let faces = || rows.par_chunks_exact(row).with_min_len(SPAN);
    if !faces().all(|face| triangle(face, encoding).is_some()) {
        return None;
    }
    let mut triangles = Vec::new();
    faces()
        .map(|face| triangle(face, encoding).unwrap_or_default())
        .collect_into_vec(&mut triangles);
    Some(triangles)
}

/// The corners of a face that is a triangle. A negative number, or one that is larger than any number of vertices that there can be, is
/// told of elsewhere, with its place.
#[inline]
pub(super) fn triangle(face: &[u8], encoding: Encoding) -> Option<[u32; 3]> {
    let &[length, ref bytes @ ..] = face.first_chunk::<13>()?;
    let corner = |i: usize| {
        let bytes = [bytes[4 * i], bytes[4 * i + 1], bytes[4 * i + 2], bytes[4 * i + 3]];
        match encoding {
            Encoding::BigEndian => u32::from_be_bytes(bytes),
            _ => u32::from_le_bytes(bytes),
        }
    };
    let [a, b, c] = [corner(0), corner(1), corner(2)];
    (length == 3 && (a | b | c) <= i32::MAX as u32).then_some([a, b, c])
}
