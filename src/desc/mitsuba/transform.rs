//! `<transform>`: its steps in order, each applied after those before it.

use glam::{DMat4, DVec3, DVec4};

use super::values::{number, numbers};
use super::xml::Element;
use crate::desc::report::Report;
use crate::desc::suggest;

const STEPS: [&str; 5] = ["translate", "rotate", "scale", "lookat", "matrix"];

/// The matrix of all steps; none if anything is wrong with one, which is said.
pub(super) fn read(element: &Element, report: &mut Report) -> Option<DMat4> {
    let mut matrix = Some(DMat4::IDENTITY);
    for child in &element.children {
        if let Some(inner) = child.children.first() {
            report.error(inner.span, format!("<{}> cannot be inside <{}>", inner.tag, child.tag));
        }
        let step = match child.tag.as_str() {
            "translate" => vector(child, 0.0, &[], report).map(DMat4::from_translation),
            "scale" => vector(child, 1.0, &[], report).map(DMat4::from_scale),
            "rotate" => rotate(child, report),
            "lookat" | "lookAt" => look_at(child, report),
            "matrix" => explicit(child, report),
            tag => {
                let help = suggest::closest(tag, &STEPS).map(|tag| format!("did you mean <{tag}>?"));
                report.error_with_help(child.span, format!("<{tag}> is no step of a transform"), help);
                None
            }
        };
        matrix = matrix.zip(step).map(|(matrix, step)| step * matrix);
    }
    if matrix.is_some_and(|matrix| !matrix.is_finite()) {
        report.error(element.span, "this transform is not finite");
        return None;
    }
    matrix
}

/// `x`, `y` and `z`, or `value` with one number or three.
fn vector(element: &Element, default: f64, others: &[&str], report: &mut Report) -> Option<DVec3> {
    if let Some(value) = element.attribute("value") {
        let optional: Vec<&str> = others.iter().copied().chain(["value"]).collect();
        element.check(report, &[], &optional).then_some(())?;
        let values = numbers(value, &[1, 3], report)?;
        let at = |i: usize| values[i.min(values.len() - 1)];
        return Some(DVec3::new(at(0), at(1), at(2)));
    }
    let optional: Vec<&str> = others.iter().copied().chain(["x", "y", "z", "value"]).collect();
    element.check(report, &[], &optional).then_some(())?;
    let mut axis = |name: &str| match element.attribute(name) {
        Some(value) => number(value, report),
        None => Some(default),
    };
    Some(DVec3::new(axis("x")?, axis("y")?, axis("z")?))
}

fn rotate(element: &Element, report: &mut Report) -> Option<DMat4> {
    let axis = vector(element, 0.0, &["angle"], report)?;
    let Some(angle) = element.attribute("angle") else {
        report.error(element.span, "<rotate> needs the attribute `angle`, in degrees");
        return None;
    };
    let angle = number(angle, report)?;
    let Some(axis) = axis.try_normalize() else {
        report.error(element.span, "<rotate> needs an axis that is not zero");
        return None;
    };
    Some(DMat4::from_axis_angle(axis, angle.to_radians()))
}

/// From a camera's space, whose x is to the left, to the world.
fn look_at(element: &Element, report: &mut Report) -> Option<DMat4> {
    element.check(report, &["origin", "target"], &["up"]).then_some(())?;
    let mut point = |name: &str| {
        let values = numbers(element.attribute(name)?, &[3], report)?;
        Some(DVec3::new(values[0], values[1], values[2]))
    };
    let (origin, target) = (point("origin")?, point("target")?);
    let up = if element.attribute("up").is_some() {
        Some(point("up")?)
    } else {
        None
    };
    let Some(forward) = (target - origin).try_normalize() else {
        report.error(element.span, "`origin` and `target` of <lookat> must differ");
        return None;
    };
    let up = up
        .filter(|up| *up != DVec3::ZERO)
        .unwrap_or_else(|| forward.any_orthogonal_vector());
    let left = up.normalize().cross(forward);
    if left.length() < 1e-9 {
        report.error(element.span, "`up` of <lookat> must not be along the view");
        return None;
    }
    let left = left.normalize();
    Some(DMat4::from_cols(
        left.extend(0.0),
        forward.cross(left).extend(0.0),
        forward.extend(0.0),
        origin.extend(1.0),
    ))
}

fn explicit(element: &Element, report: &mut Report) -> Option<DMat4> {
    element.check(report, &["value"], &[]).then_some(())?;
    let values = numbers(element.attribute("value")?, &[9, 16], report)?;
    let size = if values.len() == 16 { 4 } else { 3 };
    let at = |row: usize, column: usize| {
        if row < size && column < size {
            values[row * size + column]
        } else {
            f64::from(u8::from(row == column))
        }
    };
    let column = |c: usize| DVec4::new(at(0, c), at(1, c), at(2, c), at(3, c));
    Some(DMat4::from_cols(column(0), column(1), column(2), column(3)))
}
