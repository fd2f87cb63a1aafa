//! Attributes of meshes that are written out in the scene, an extension: parameters that textures ask for by name.

use crate::desc::pbrt::params::{Param, ParamType, Values, value_span};
use crate::desc::pbrt::reader::ParamReader;
use crate::desc::{AttributeDomain, ColorSpace, MeshAttributeDesc};

/// The parameters that are attributes of a mesh of so many vertices and triangles, one after another; those of what there is no
/// telling how many there are, as they are wrong themselves, are passed over.
pub(super) fn attributes(
    reader: &mut ParamReader<'_>,
    vertices: Option<usize>,
    triangles: Option<usize>,
) -> Vec<MeshAttributeDesc> {
    let mut attributes = Vec::new();
    for (domain, count) in [
        (AttributeDomain::Vertices, vertices),
        (AttributeDomain::Triangles, triangles),
    ] {
        let kinds = [ParamType::Float, ParamType::Rgb];
        for param in reader.take_beginning(domain.prefix(), &kinds) {
            attributes.extend(count.and_then(|count| attribute(reader, &param, domain, count)));
        }
    }
    attributes
}

/// An attribute; none, having said so, if something is wrong with it.
fn attribute(
    reader: &mut ParamReader<'_>,
    param: &Param,
    domain: AttributeDomain,
    count: usize,
) -> Option<MeshAttributeDesc> {
    let Values::Numbers(numbers) = &param.values else {
        return None;
    };
    let name = &param.name;
    // PLY files must be able to say it.
    if !name[domain.prefix().len()..].bytes().all(|b| b.is_ascii_graphic()) || name.len() == domain.prefix().len() {
        let message = format!(
            "`{name}` cannot be the name of an attribute: `{}` and ASCII",
            domain.prefix()
        );
        reader.report().error(param.span, message);
        return None;
    }
    let is_color = param.kind == ParamType::Rgb;
    let space = param.color_space.unwrap_or(reader.context.color_space);
    if is_color && space != ColorSpace::Srgb {
        let message = format!(
            "`{name}` is in the color space {}: colors of meshes are in srgb",
            space.name()
        );
        reader.report().error(param.span, message);
        return None;
    }
    let channels = if is_color { 3 } else { 1 };
    if Some(numbers.len()) != count.checked_mul(channels) {
        let message = format!(
            "`{name}` has {} numbers, expected {channels} for each of {count} {}",
            numbers.len(),
            match domain {
                AttributeDomain::Vertices => "vertices",
                AttributeDomain::Triangles => "triangles",
            }
        );
        reader.report().error(param.values_span, message);
        return None;
    }
    let values: Vec<f32> = numbers.iter().map(|&number| number as f32).collect();
    if let Some(bad) = values.iter().position(|value| !value.is_finite()) {
        let span = value_span(reader.report(), param, bad);
        let message = format!("this number of `{name}` does not fit into 32-bit floating point");
        reader.report().error(span, message);
        return None;
    }
    Some(MeshAttributeDesc {
        name: name.clone(),
        domain,
        channels,
        values,
    })
}
