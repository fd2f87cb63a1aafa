//! Shapes: what rays can meet.

use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::{AreaLightDesc, MaterialId, MediumInterfaceDesc, MotionDesc, Textured};
use crate::error::Span;

/// One shape.
#[derive(Clone, Debug)]
pub struct ShapeDesc {
    /// The type in the `Shape` directive.
    pub span: Span,
    /// What it is.
    pub kind: ShapeKind,
    /// Into the world; for the shapes of an object into the space of the group.
    pub world_from_object: MotionDesc,
    /// Whether the file asks for the normals to be flipped (pbrt's `ReverseOrientation`). Independently of it, pbrt flips the
    /// geometric normal if `world_from_object` swaps handedness.
    pub reverse_orientation: bool,
    /// What it is made of.
    pub material: MaterialId,
    /// What is on its two sides, if that differs; else whatever a ray comes through goes on.
    pub media: Option<MediumInterfaceDesc>,
    /// How much of it there is: rays pass it with the probability 1 - alpha. In [0, 1] unless from a texture; default 1.
    pub alpha: Textured<f32>,
    /// What it emits.
    pub area_light: Option<AreaLightDesc>,
}

/// The kinds of shapes.
#[derive(Clone, Debug)]
pub enum ShapeKind {
    /// Triangles; there is at least one.
    TriangleMesh(Arc<MeshDesc>),
    /// A whole sphere around the origin of object space.
    Sphere {
        /// Positive.
        radius: f64,
    },
}

/// A mesh of triangles, in object space.
#[derive(Clone, Debug, Default)]
pub struct MeshDesc {
    /// Vertices, all finite.
    pub positions: Vec<Vec3>,
    /// Where they are at scene time 1 (`"point3 P1"`, Lucerna's extension): each vertex moves on a straight line from its
    /// position at scene time 0. As many as `positions`.
    pub positions_end: Option<Vec<Vec3>>,
    /// Shading normals (`N`), not normalised; as many as `positions`, or none.
    pub normals: Vec<Vec3>,
    /// Shading tangents (`S`), not normalised; as many as `positions`, or none.
    pub tangents: Vec<Vec3>,
    /// Texture coordinates; as many as `positions`, or none.
    pub uvs: Vec<Vec2>,
    /// Three vertices a triangle, all below `positions.len()`.
    pub indices: Vec<[u32; 3]>,
}
