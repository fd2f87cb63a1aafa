//! Textures from what meshes have at their vertices or on their triangles.

use std::sync::Arc;

use super::TextureContext;
use crate::math::Vec3;

/// An attribute of meshes by its name: what each geometry has of it.
#[derive(Clone, Debug)]
pub struct AttributeTexture {
    /// By geometry; none, or beyond the end, for those that do not have it.
    pub tables: Arc<[Option<Arc<AttributeTable>>]>,
    /// Factor of the values.
    pub scale: f32,
}

/// The attribute of one mesh.
#[derive(Clone, Debug)]
pub struct AttributeTable {
    /// The values that each triangle is between; none if there is a value for each triangle.
    corners: Option<Vec<[u32; 3]>>,
    /// Three numbers a value, all of them the same if it has one only.
    values: Vec<[f32; 3]>,
}

impl AttributeTable {
    /// A value for each vertex, linear over triangles with these corners; `None` if a corner has none.
    pub fn of_vertices(values: Vec<[f32; 3]>, corners: Vec<[u32; 3]>) -> Option<Self> {
        let has_value = |&vertex: &u32| (vertex as usize) < values.len();
        corners.iter().flatten().all(has_value).then_some(Self {
            corners: Some(corners),
            values,
        })
    }

    /// A value for each triangle.
    pub fn of_triangles(values: Vec<[f32; 3]>) -> Self {
        Self { corners: None, values }
    }

    /// On a triangle; 0 if there is none.
    fn at(&self, triangle: usize, [v, w]: [f32; 2]) -> Vec3 {
        let value = |i: usize| self.values.get(i).map_or(Vec3::ZERO, |value| Vec3::from_array(*value));
        match &self.corners {
            None => value(triangle),
            Some(corners) => corners.get(triangle).map_or(Vec3::ZERO, |corners| {
                let [a, b, c] = corners.map(|corner| value(corner as usize));
                a * (1.0 - v - w) + b * v + c * w
            }),
        }
    }
}

impl AttributeTexture {
    fn lookup(&self, context: &TextureContext) -> Vec3 {
        let Some(place) = &context.place else {
            return Vec3::ZERO;
        };
        let table = self.tables.get(place.geometry.index()).and_then(Option::as_ref);
        table.map_or(Vec3::ZERO, |table| {
            table.at(place.primitive.index(), place.barycentrics.to_array()) * self.scale
        })
    }

    /// A number.
    pub(super) fn evaluate(&self, context: &TextureContext) -> f32 {
        self.lookup(context).x
    }

    /// A colour in linear sRGB, no component negative.
    pub(super) fn evaluate_rgb(&self, context: &TextureContext) -> [f32; 3] {
        self.lookup(context).max(Vec3::ZERO).into()
    }
}

#[cfg(test)]
mod tests {
    use super::super::context::MeshPlace;
    use super::*;
    use crate::geometry::{GeometryId, PrimitiveId};
    use crate::math::Vec2;

    fn at(geometry: u32, primitive: u32, barycentrics: Vec2) -> TextureContext {
        TextureContext {
            place: Some(MeshPlace {
                geometry: GeometryId(geometry),
                primitive: PrimitiveId(primitive),
                barycentrics,
            }),
            ..TextureContext::at_point(Vec3::ZERO, Vec3::Z, Vec2::ZERO)
        }
    }

    #[test]
    fn values_are_those_of_the_mesh_that_is_asked() {
        let red_green_blue = vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.5; 3]];
        let vertices = AttributeTable::of_vertices(red_green_blue, vec![[0, 1, 2], [3, 1, 2]]).unwrap();
        let triangles = AttributeTable::of_triangles(vec![[0.25; 3], [0.75; 3]]);
        let texture = AttributeTexture {
            tables: [Some(vertices), None, Some(triangles)].map(|t| t.map(Arc::new)).into(),
            scale: 2.0,
        };
        let inside = Vec2::new(0.25, 0.5);
        assert_eq!(texture.evaluate_rgb(&at(0, 0, inside)), [0.5, 0.5, 1.0]);
        assert_eq!(texture.evaluate_rgb(&at(0, 1, Vec2::ZERO)), [1.0; 3]);
        assert_eq!(texture.evaluate(&at(2, 1, inside)), 1.5);
        // No attribute, no mesh, no triangle, no place.
        for (geometry, primitive) in [(1, 0), (3, 0), (2, 2), (0, 2)] {
            assert_eq!(texture.evaluate_rgb(&at(geometry, primitive, inside)), [0.0; 3]);
        }
        let nowhere = TextureContext::at_point(Vec3::ZERO, Vec3::Z, Vec2::ZERO);
        assert_eq!(texture.evaluate(&nowhere), 0.0);
        assert!(AttributeTable::of_vertices(vec![[0.0; 3]], vec![[0, 0, 1]]).is_none());
    }
}
