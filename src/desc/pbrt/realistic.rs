//! The lenses of `Camera "realistic"`.

use std::path::Path;
use std::sync::Arc;

use super::reader::ParamReader;
use crate::desc::{LensSurface, RealisticDesc, StopShape};
use crate::error::Span;
use crate::image_io::{self, Image};

/// Reads the lens table and what is set on it; none, reported, without one.
pub(super) fn read(reader: &mut ParamReader<'_>) -> Option<RealisticDesc> {
    let diameter = reader.positive("aperturediameter", 1.0);
    let focus_distance = reader.positive("focusdistance", 10.0);
    let shape = shape(reader);
    let Some((name, span)) = reader.string("lensfile") else {
        if !reader.has("lensfile") {
            let span = reader.span;
            reader
                .report()
                .error(span, "this camera has no table of lenses, `\"string lensfile\"`");
        }
        return None;
    };
    let path = reader.context.resolve(&name, span);
    let table = match reader.context.read_text(&path) {
        Ok(text) => surfaces(&text),
        Err(e) => Err(format!("cannot be read: {e}")),
    };
    let mut surfaces = table
        .map_err(|problem| {
            let message = format!("{}: {problem}", path.display());
            reader.report().error(span, message);
        })
        .ok()?;
    set_stop(reader, &mut surfaces, diameter);
    Some(RealisticDesc {
        surfaces,
        focus_distance,
        shape,
    })
}

/// Gives the stop its diameter, which the table says the most for.
fn set_stop(reader: &mut ParamReader<'_>, surfaces: &mut [LensSurface], diameter: f64) {
    let span = reader.span_of("aperturediameter");
    match surfaces.iter_mut().find(|surface| surface.radius == 0.0) {
        Some(stop) if diameter > stop.diameter => {
            let message = format!(
                "an aperture of {diameter} mm is more than there is, {} mm, which is taken",
                stop.diameter
            );
            reader.report().warning(span, message);
        }
        Some(stop) => stop.diameter = diameter,
        None if reader.has("aperturediameter") => {
            let message = "`aperturediameter` has no effect: the table has no aperture stop, a line with the radius 0";
            reader.report().warning(span, message);
        }
        None => {}
    }
}

/// Four numbers a surface, in whatever lines; `#` starts a comment.
fn surfaces(text: &[u8]) -> Result<Vec<LensSurface>, String> {
    const MOST: usize = 1000;
    let mut numbers = Vec::new();
    let mut lines = Vec::new();
    for (index, line) in text.split(|&b| b == b'\n').enumerate() {
        let line = line.split(|&b| b == b'#').next().unwrap_or_default();
        for word in line.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty()) {
            let number = fast_float2::parse::<f64, _>(word).ok().filter(|v| v.abs() < 1e6);
            numbers.push(number.ok_or_else(|| {
                format!(
                    "its line {} has something that is not a length in millimetres",
                    index + 1
                )
            })?);
            lines.push(index + 1);
        }
    }
    let (groups, rest) = numbers.as_chunks::<4>();
    if !rest.is_empty() || groups.is_empty() || groups.len() > MOST {
        return Err(format!(
            "a table of lenses has four numbers for each surface, radius, thickness, index of refraction and diameter; this one has {}",
            numbers.len()
        ));
    }
    let mut surfaces = Vec::with_capacity(groups.len());
    for (i, &[radius, thickness, eta, diameter]) in groups.iter().enumerate() {
        let wrong = |what: &str| Err(format!("the surface in its line {} {what}", lines[4 * i]));
        if diameter <= 0.0 {
            return wrong("has an opening that is not positive (the fourth number)");
        }
        if thickness < 0.0 {
            return wrong("has a negative thickness (the second number)");
        }
        if eta != 0.0 && !(1.0..10.0).contains(&eta) {
            return wrong("has an index of refraction that is not between 1 and 10, nor 0 for air (the third number)");
        }
        if radius == 0.0 && surfaces.iter().any(|surface: &LensSurface| surface.radius == 0.0) {
            return wrong("is a second aperture stop, with the radius 0");
        }
        surfaces.push(LensSurface {
            radius,
            thickness,
            eta,
            diameter,
        });
    }
    Ok(surfaces)
}

/// The shape of the stop: a name, or an image.
fn shape(reader: &mut ParamReader<'_>) -> StopShape {
    let Some((name, span)) = reader.string("aperture") else {
        return StopShape::Round;
    };
    match name.as_str() {
        "" => StopShape::Round,
        "gaussian" => StopShape::Gaussian,
        "square" => StopShape::Square,
        "pentagon" => StopShape::Pentagon,
        "star" => StopShape::Star,
        _ => image(reader, &name, span).map_or(StopShape::Round, |image| StopShape::Image(Arc::new(image))),
    }
}

/// The image in a file; none, reported, if it lets nothing through.
fn image(reader: &mut ParamReader<'_>, name: &str, span: Span) -> Option<Image> {
    let path = reader.context.resolve(name, span);
    let read = |path: &Path| {
        let content = std::fs::read(path).map_err(|error| {
            format!(
                "the shape `{name}` is neither gaussian, square, pentagon or star, nor an image that can be read: {error}"
            )
        })?;
        let image = image_io::read(path).map_err(|error| error.to_string())?;
        Ok::<_, String>((content, image))
    };
    let checked = read(&path).and_then(|(content, image)| {
        let sum: f64 = image.data().iter().map(|&v| f64::from(v)).sum();
        if image.data().iter().any(|&v| !v.is_finite() || v < 0.0) || sum <= 0.0 {
            return Err(format!(
                "{}: an aperture has values of 0 or more, and some of more",
                path.display()
            ));
        }
        Ok((content, image))
    });
    match checked {
        Ok((content, image)) => {
            reader.context.count(&content);
            Some(image)
        }
        Err(problem) => {
            reader.report().error(span, problem);
            None
        }
    }
}
