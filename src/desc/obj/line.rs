//! One line of an OBJ file.

use glam::{Vec2, Vec3};

/// What a line says.
#[derive(Clone, Copy, Debug)]
pub(super) enum Line<'a> {
    Position(Vec3),
    TextureCoordinates(Vec2),
    Normal(Vec3),
    /// The corners.
    Face(&'a [u8]),
    /// Nothing that matters to the mesh.
    Other,
}

/// The line cut into its keyword and the rest, and numbers read.
pub(super) fn statement(line: &[u8]) -> Result<Line<'_>, String> {
    let line = line.trim_ascii();
    let keyword_end = line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len());
    let (keyword, rest) = line.split_at(keyword_end);
    // A comment may end a line; nothing that is read has the character in it.
    let rest = rest.split(|&b| b == b'#').next().unwrap_or_default();
    Ok(match keyword {
        b"v" => Line::Position(numbers::<3>(rest)?.into()),
        b"vn" => Line::Normal(numbers::<3>(rest)?.into()),
        b"vt" => Line::TextureCoordinates(numbers::<2>(rest)?.into()),
        b"f" => Line::Face(rest),
        _ => Line::Other,
    })
}

/// The first `N` numbers; what comes after them (weights, colors) is passed over.
fn numbers<const N: usize>(text: &[u8]) -> Result<[f32; N], String> {
    let mut words = text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    let mut values = [0.0; N];
    for value in &mut values {
        let word = words.next().ok_or_else(|| format!("expected {N} numbers"))?;
        let parsed = fast_float2::parse::<f32, _>(word.strip_prefix(b"+").unwrap_or(word));
        *value = parsed
            .ok()
            .filter(|v: &f32| v.is_finite())
            .ok_or_else(|| format!("`{}` is no finite number", String::from_utf8_lossy(word)))?;
    }
    Ok(values)
}

/// A place in a list of `count`, counted from 1; negative ones count from its end.
pub(super) fn index(word: &[u8], count: usize, what: &str) -> Result<u32, String> {
    let parsed = std::str::from_utf8(word).ok().and_then(|word| word.parse::<i64>().ok());
    let Some(place) = parsed else {
        return Err(format!("`{}` is no index", String::from_utf8_lossy(word)));
    };
    let at = if place < 0 { count as i64 + 1 + place } else { place };
    match u32::try_from(at) {
        Ok(at) if at >= 1 && at as usize <= count => Ok(at),
        _ => Err(format!("there is no {what} {place}: there are {count} so far")),
    }
}
