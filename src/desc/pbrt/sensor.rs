//! The sensor of a `Film`: a name, or a file of responses.

use std::path::Path;

use super::reader::ParamReader;
use super::suggest;
use crate::desc::SensorDesc;
use crate::error::Span;
use crate::spectrum::sensor_names;

/// Reads `sensor`; `cie1931` by default, and in the place of what is not there.
pub(super) fn read(reader: &mut ParamReader<'_>) -> SensorDesc {
    let Some((name, span)) = reader.string("sensor") else {
        return SensorDesc::Cie1931;
    };
    if name == "cie1931" {
        return SensorDesc::Cie1931;
    }
    if sensor_names().any(|known| known == name) {
        return SensorDesc::Named(name);
    }
    let path = reader.context.resolve(&name, span);
    if !path.exists() {
        let known: Vec<&str> = sensor_names().chain(["cie1931"]).collect();
        let help = suggest::closest(&name, &known).map(|n| format!("did you mean `{n}`?"));
        let help = help.unwrap_or_else(|| format!("the names are {}", known.join(", ")));
        let message = format!("`{name}` is neither the name of a sensor nor a file of responses");
        reader.report().error_with_help(span, message, Some(help));
        return SensorDesc::Cie1931;
    }
    file(reader, &path, span).map_or(SensorDesc::Cie1931, SensorDesc::Curves)
}

/// The rows of a file of responses. `None`, reported, if it is not one.
fn file(reader: &mut ParamReader<'_>, path: &Path, span: Span) -> Option<Vec<[f32; 4]>> {
    let rows = match reader.context.read_text(path) {
        Ok(text) => rows(&text),
        Err(e) => Err(format!("cannot be read: {e}")),
    };
    match rows {
        Ok(rows) => Some(rows),
        Err(message) => {
            let message = format!("{}: {message}", path.display());
            reader.report().error(span, message);
            None
        }
    }
}

/// Wavelength, r, g, b in each line, with spaces or commas in between; `#` starts a comment.
fn rows(text: &[u8]) -> Result<Vec<[f32; 4]>, String> {
    let mut rows: Vec<[f32; 4]> = Vec::new();
    for (index, line) in text.split(|&b| b == b'\n').enumerate() {
        let line = line.split(|&b| b == b'#').next().unwrap_or_default();
        let words = line.split(|&b| b.is_ascii_whitespace() || b == b',');
        let numbers: Option<Vec<f32>> = words
            .filter(|word| !word.is_empty())
            .map(|word| fast_float2::parse::<f32, _>(word).ok().filter(|v| v.is_finite()))
            .collect();
        let wrong = |what: &str| format!("its line {} {what}", index + 1);
        let numbers = numbers.ok_or_else(|| wrong("has something that is not a finite number"))?;
        if numbers.is_empty() {
            continue;
        }
        let row = <[f32; 4]>::try_from(numbers).map_err(|_| {
            wrong("must have four numbers: a wavelength in nm and the responses of red, green and blue")
        })?;
        if rows.last().is_some_and(|last| last[0] >= row[0]) {
            return Err(wrong("must have a greater wavelength than the one before"));
        }
        rows.push(row);
    }
    if rows.len() < 2 {
        return Err("a file of responses has two lines at least".to_owned());
    }
    Ok(rows)
}
