//! `linearcurve` and `bsplinecurve`: text files of control points, one a line, with empty lines between curves.

use std::sync::Arc;

use glam::{DAffine3, Vec3};

use super::loader::Loader;
use super::props::Props;
use crate::desc::{ShapeKind, TubeBasis, TubesDesc, bytes};

/// The longest file that is read.
const LONGEST: u64 = 1 << 34;

impl<'g> Loader<'g> {
    /// The curves of a file, in the world: their points are moved there, and their radii stay as they are.
    pub fn curves(&mut self, props: &mut Props<'g>, to_world: &DAffine3) -> Option<ShapeKind> {
        let basis = match props.object.plugin.as_str() {
            "linearcurve" => TubeBasis::Linear,
            _ => TubeBasis::CubicBSpline,
        };
        let Some(name) = props.string("filename") else {
            if !props.has("filename") {
                let message = format!(
                    "this `{}` has no `<string name=\"filename\" .../>`",
                    props.object.plugin
                );
                props.error(props.object.span, message);
            }
            return None;
        };
        let path = self.xml.resolve(name);
        let read = bytes::read(&path, LONGEST).map_err(|e| e.to_string());
        let curves = read.and_then(|text| {
            self.xml.count(&text);
            parse(&text, basis, to_world)
        });
        match curves {
            Ok(curves) => Some(ShapeKind::Tubes(Arc::new(curves))),
            Err(problem) => {
                let message = format!("cannot read the curves {}: {problem}", path.display());
                props.error(props.span_of("filename"), message);
                None
            }
        }
    }
}

/// Reads curves; what is wrong, and in which line.
fn parse(text: &[u8], basis: TubeBasis, to_world: &DAffine3) -> Result<TubesDesc, String> {
    let mut curves = TubesDesc {
        basis,
        points: Vec::new(),
        radii: Vec::new(),
        counts: Vec::new(),
    };
    let mut count = 0;
    for (i, line) in text.split(|&b| b == b'\n').enumerate() {
        let mut words = line
            .split(u8::is_ascii_whitespace)
            .filter(|word| !word.is_empty())
            .peekable();
        if words.peek().is_none() {
            finish(&mut curves, &mut count).map_err(|problem| format!("line {}: {problem}", i + 1))?;
            continue;
        }
        let mut number = || fast_float2::parse::<f64, _>(words.next()?).ok();
        let (Some(x), Some(y), Some(z), Some(radius)) = (number(), number(), number(), number()) else {
            return Err(format!("line {}: expected `x y z radius`", i + 1));
        };
        let point: Vec3 = to_world.transform_point3([x, y, z].into()).as_vec3();
        let radius = radius as f32;
        if !(point.is_finite() && radius.is_finite()) {
            return Err(format!(
                "line {}: a number is not finite in 32-bit floating point",
                i + 1
            ));
        }
        if radius < 0.0 {
            return Err(format!("line {}: the radius is negative", i + 1));
        }
        curves.points.push(point);
        curves.radii.push(radius);
        count += 1;
    }
    finish(&mut curves, &mut count)?;
    if curves.counts.is_empty() {
        return Err("there are no control points".to_owned());
    }
    Ok(curves)
}

/// Ends a curve of so many points, if it has any.
fn finish(curves: &mut TubesDesc, count: &mut u32) -> Result<(), String> {
    let least = curves.basis.least_points();
    match std::mem::take(count) {
        0 => Ok(()),
        few if few < least => Err(format!(
            "a curve of {few} control points ends here; it has {least} at least"
        )),
        points => {
            curves.counts.push(points);
            Ok(())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn curves(text: &str, basis: TubeBasis) -> Result<TubesDesc, String> {
        parse(text.as_bytes(), basis, &DAffine3::from_scale(DVec3::splat(2.0)))
    }

    #[test]
    fn empty_lines_separate_curves() {
        let text = "\n0 0 0 .5\n 1 0 0 .25\r\n\n\n 0 1 0 1\n0 2 0 1\n0 3 0 0";
        let read = curves(text, TubeBasis::Linear).unwrap();
        assert_eq!(read.counts, [2, 3]);
        // Radii are not scaled.
        assert_eq!((read.points[1], read.radii[1]), (Vec3::new(2.0, 0.0, 0.0), 0.25));
        assert_eq!(read.points.len(), 5);
    }

    #[test]
    fn bad_files_are_refused_with_the_line() {
        for (text, basis, message) in [
            ("", TubeBasis::Linear, "no control points"),
            ("0 0 0 1\n", TubeBasis::Linear, "1 control points"),
            (
                "0 0 0 1\n1 0 0 1\n\n",
                TubeBasis::CubicBSpline,
                "line 3: a curve of 2 control points",
            ),
            ("0 0 0 1\n1 0 0\n", TubeBasis::Linear, "line 2: expected `x y z radius`"),
            ("0 0 0 1\n1 0 x 1\n", TubeBasis::Linear, "line 2: expected"),
            (
                "0 0 0 1\n1 0 inf 1\n",
                TubeBasis::Linear,
                "line 2: a number is not finite",
            ),
            (
                "0 0 0 1\n1 0 0 1e40\n",
                TubeBasis::Linear,
                "line 2: a number is not finite",
            ),
            (
                "0 0 0 1\n1 0 0 -1\n",
                TubeBasis::Linear,
                "line 2: the radius is negative",
            ),
        ] {
            let error = curves(text, basis).unwrap_err();
            assert!(error.contains(message), "{text:?}: {error}");
        }
    }
}
