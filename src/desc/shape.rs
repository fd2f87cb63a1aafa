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
    /// A part of a sphere, a cylinder or a disk, from the x axis of object space counterclockwise around the z axis.
    Quadric {
        /// Which.
        surface: QuadricDesc,
        /// How far it goes around, in degrees: in (0, 360].
        phi_max: f64,
    },
    /// Bilinear patches; there is at least one.
    BilinearMesh(Arc<PatchMeshDesc>),
    /// The limit surface of Loop's subdivision.
    LoopSubdivision {
        /// Positions and triangles, at least one.
        cage: Arc<MeshDesc>,
        /// How many times each triangle becomes four.
        levels: u32,
    },
    /// Triangles that a texture moves along their normals.
    DisplacedMesh {
        /// Before that; there is at least one triangle.
        mesh: Arc<MeshDesc>,
        /// How.
        displacement: DisplacementDesc,
    },
    /// A curve with a width.
    Curve(Arc<CurveDesc>),
    /// Round curves.
    Tubes(Arc<TubesDesc>),
}

/// Round curves in object space, with a radius at each control point; seen from outside only. Linear ones are closed by balls, others
/// are open at their ends.
#[derive(Clone, Debug)]
pub struct TubesDesc {
    /// How points and radii are connected.
    pub basis: TubeBasis,
    /// The control points of all curves, one after another.
    pub points: Vec<Vec3>,
    /// As many, not negative. The transform moves the points before the radii are laid around them, unless it is that of an instance.
    pub radii: Vec<f32>,
    /// How many control points each curve has: [`TubeBasis::least_points`] at least, and together as many as there are.
    pub counts: Vec<u32>,
}

/// How the control points of a round curve are connected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TubeBasis {
    /// By straight lines.
    Linear,
    /// By a uniform cubic B-spline.
    CubicBSpline,
}

impl TubeBasis {
    /// How many control points a curve has at least.
    pub fn least_points(self) -> u32 {
        match self {
            Self::Linear => 2,
            Self::CubicBSpline => 4,
        }
    }
}

impl TubesDesc {
    /// How many segments there are, of all curves.
    pub fn segment_count(&self) -> usize {
        let least = self.basis.least_points();
        self.counts
            .iter()
            .map(|count| (count + 1).saturating_sub(least) as usize)
            .sum()
    }
}

/// How the width of a curve lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveKindDesc {
    /// Facing each ray.
    Flat,
    /// Facing each ray, with the normals of a cylinder.
    Cylinder,
    /// As its normals say.
    Ribbon,
}

/// A curve in object space, whatever basis and degree it had in the file.
#[derive(Clone, Debug)]
pub struct CurveDesc {
    /// How its width lies.
    pub kind: CurveKindDesc,
    /// Cubic Bézier segments, one after another; there is at least one.
    pub segments: Vec<[Vec3; 4]>,
    /// Width at the start and at the end, and linear between, each segment taking an equal share; not negative, not both zero.
    pub widths: [f64; 2],
    /// Of a ribbon: at both ends of each segment, one more than there are segments; not zero, not normalised. Of other kinds none.
    pub normals: Vec<Vec3>,
    /// Each segment is divided 2 to this times in advance, for tighter boxes; at most 10.
    pub split_depth: u32,
}

/// Surfaces of revolution around the z axis, object space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum QuadricDesc {
    /// The part of a sphere around the origin between two heights.
    Sphere {
        /// Positive.
        radius: f64,
        /// Ascending, within the sphere.
        z: [f64; 2],
    },
    /// A cylinder without lids.
    Cylinder {
        /// Positive.
        radius: f64,
        /// Ascending.
        z: [f64; 2],
    },
    /// A disk, or a ring.
    Disk {
        /// Where it crosses the z axis.
        height: f64,
        /// Positive.
        radius: f64,
        /// Of its hole: not negative, less than `radius`.
        inner_radius: f64,
        /// Whether its texture coordinates are radius and angle, as in Mitsuba: (1 - v, 1 - u) of pbrt's.
        radial_uv: bool,
    },
}

/// How a mesh is displaced: its triangles are halved until their edges are short enough, then each vertex is moved along its
/// normal, in object space, by the value of a texture there.
#[derive(Clone, Debug)]
pub struct DisplacementDesc {
    /// In units of object space.
    pub texture: Textured<f32>,
    /// Longest edge, in the space of `world_from_object`; positive.
    pub edge_length: f64,
}

/// A mesh of bilinear patches, in object space.
#[derive(Clone, Debug, Default)]
pub struct PatchMeshDesc {
    /// Vertices, all finite.
    pub positions: Vec<Vec3>,
    /// Shading normals (`N`), not normalised; as many as `positions`, or none.
    pub normals: Vec<Vec3>,
    /// Texture coordinates; as many as `positions`, or none.
    pub uvs: Vec<Vec2>,
    /// The corners (u, v) = (0, 0), (1, 0), (0, 1), (1, 1) of each patch, all below `positions.len()`.
    pub indices: Vec<[u32; 4]>,
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
    /// Further values, which textures ask for by name ([`TextureKind::MeshAttribute`](super::TextureKind::MeshAttribute)); names are
    /// distinct.
    pub attributes: Vec<MeshAttributeDesc>,
}

/// Values that a mesh has at its vertices or on its triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshAttributeDesc {
    /// What textures call it: it begins with the [`AttributeDomain::prefix`] of its domain.
    pub name: String,
    /// What it has values for.
    pub domain: AttributeDomain,
    /// Numbers a value: 1, or 3 of a colour in linear sRGB.
    pub channels: usize,
    /// As many values as vertices or triangles, one after another; finite.
    pub values: Vec<f32>,
}

/// What an attribute of a mesh has values for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AttributeDomain {
    /// Each vertex; linear between.
    Vertices,
    /// Each triangle.
    Triangles,
}

impl AttributeDomain {
    /// What the names of such attributes begin with, as in Mitsuba.
    pub fn prefix(self) -> &'static str {
        match self {
            Self::Vertices => "vertex_",
            Self::Triangles => "face_",
        }
    }
}
