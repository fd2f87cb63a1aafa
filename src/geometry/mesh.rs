//! Indexed triangle meshes, with vertices that may move.

use super::triangle::Corners;
use super::vertices::{Attributes, MeshError, check_faces, check_positions};
use crate::math::{Bounds3, Vec2, Vec3};

/// What stands for the normals of a triangle's corners in a mesh without any.
pub(super) const NO_NORMALS: [Vec3; 3] = [Vec3::ZERO; 3];
/// The texture coordinates of a triangle's corners in a mesh without any, as in pbrt.
pub(super) const PLAIN_UVS: [Vec2; 3] = [Vec2::ZERO, Vec2::X, Vec2::ONE];

/// An indexed triangle mesh. Vertices are given at one or more scene times, evenly spaced over [0, 1], and move linearly
/// between them; normals and texture coordinates do not change with time.
#[derive(Clone, Debug)]
pub struct TriangleMesh {
    /// One array a time step, each with one vertex more than the mesh has: Embree reads 16 bytes at the last one.
    positions: Vec<Vec<Vec3>>,
    indices: Vec<[u32; 3]>,
    attributes: Attributes,
    flip_normal: bool,
}

impl TriangleMesh {
    /// A mesh of `indices` into `positions`, one array of world or object space positions for each time step.
    pub fn new(mut positions: Vec<Vec<Vec3>>, indices: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        let vertices = positions.first().ok_or(MeshError::TimeSteps)?.len();
        for step in &mut positions {
            if step.len() != vertices {
                return Err(MeshError::TimeSteps);
            }
            check_positions(step)?;
            step.reserve_exact(1);
            step.push(Vec3::ZERO);
        }
        check_faces(&indices, vertices)?;
        Ok(Self {
            positions,
            indices,
            attributes: Attributes::default(),
            flip_normal: false,
        })
    }

    /// With shading normals, one a vertex, of any length; or with none.
    pub fn with_normals(mut self, normals: Vec<Vec3>) -> Result<Self, MeshError> {
        self.attributes.set_normals(normals, self.vertex_count())?;
        Ok(self)
    }

    /// With texture coordinates, one a vertex; or with none.
    pub fn with_uvs(mut self, uvs: Vec<Vec2>) -> Result<Self, MeshError> {
        self.attributes.set_uvs(uvs, self.vertex_count())?;
        Ok(self)
    }

    /// With the geometric normal on the side from which the vertices go round clockwise, instead of counterclockwise.
    #[must_use]
    pub fn with_flipped_normal(mut self, flip: bool) -> Self {
        self.flip_normal = flip;
        self
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.positions[0].len() - 1
    }

    /// Number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.indices.len()
    }

    /// Number of time steps, at least 1.
    pub fn time_steps(&self) -> usize {
        self.positions.len()
    }

    /// Whether vertices move.
    pub fn is_moving(&self) -> bool {
        self.positions.len() > 1
    }

    /// The vertices at a time step, followed by one that pads the buffer.
    pub fn padded_positions(&self, step: usize) -> &[Vec3] {
        &self.positions[step]
    }

    /// The vertices at a time step.
    pub fn positions(&self, step: usize) -> &[Vec3] {
        let padded = &self.positions[step];
        &padded[..padded.len() - 1]
    }

    /// The corners of each triangle.
    pub fn indices(&self) -> &[[u32; 3]] {
        &self.indices
    }

    /// Shading normals, one a vertex.
    pub fn normals(&self) -> Option<&[Vec3]> {
        self.attributes.normals.as_deref()
    }

    /// Texture coordinates, one a vertex.
    pub fn uvs(&self) -> Option<&[Vec2]> {
        self.attributes.uvs.as_deref()
    }

    /// Whether the geometric normal is on the clockwise side.
    pub fn has_flipped_normal(&self) -> bool {
        self.flip_normal
    }

    /// The corners of a triangle at scene time `time`.
    #[inline]
    pub fn triangle(&self, triangle: usize, time: f32) -> [Vec3; 3] {
        let corners = self.indices[triangle];
        let (step, fraction) = self.time_step(time);
        let now = corners.map(|v| self.positions[step][v as usize]);
        if fraction == 0.0 {
            return now;
        }
        self.moved(triangle, step, fraction, now)
    }

    /// The corners of a triangle, which at a time step are `now`, at a fraction of the way to the next.
    #[inline(never)]
    fn moved(&self, triangle: usize, step: usize, fraction: f32, now: [Vec3; 3]) -> [Vec3; 3] {
        let next = self.indices[triangle].map(|v| self.positions[step + 1][v as usize]);
        std::array::from_fn(|i| now[i] * (1.0 - fraction) + next[i] * fraction)
    }

    /// What the mesh says of the corners of a triangle.
    #[inline]
    pub(super) fn corners(&self, triangle: usize) -> Corners {
        let [a, b, c] = self.indices[triangle].map(|v| v as usize);
        Corners {
            normals: match self.normals() {
                Some(normals) => [normals[a], normals[b], normals[c]],
                None => NO_NORMALS,
            },
            uvs: match self.uvs() {
                Some(uvs) => [uvs[a], uvs[b], uvs[c]],
                None => PLAIN_UVS,
            },
            side: self.side(),
        }
    }

    /// See [`Corners::side`].
    #[inline]
    pub(super) fn side(&self) -> f32 {
        if self.flip_normal { -1.0 } else { 1.0 }
    }

    /// The unit geometric normal of a triangle at scene time 0, on the side of its shading normals if it has any; zero if the
    /// triangle has no area.
    pub fn geometric_normal(&self, triangle: usize) -> Vec3 {
        let [a, b, c] = self.triangle(triangle, 0.0).map(Vec3::as_dvec3);
        let ng = (b - a).cross(c - a);
        let flip = match self.normals() {
            None => self.flip_normal,
            Some(normals) => {
                let mean: Vec3 = self.indices[triangle].iter().map(|&v| normals[v as usize]).sum();
                let cos = ng.dot(mean.as_dvec3());
                cos < 0.0 || (cos == 0.0 && self.flip_normal)
            }
        };
        let ng = ng.normalize_or_zero().as_vec3();
        if flip { -ng } else { ng }
    }

    /// The time step at or before `time`, and how far towards the next one it is, in [0, 1]. 0 and 0 if nothing moves.
    #[inline(always)]
    pub fn time_step(&self, time: f32) -> (usize, f32) {
        let segments = self.positions.len() - 1;
        if segments == 0 {
            return (0, 0.0);
        }
        let scaled = time * segments as f32;
        let step = (scaled as usize).min(segments - 1);
        (step, scaled - step as f32)
    }

    /// A box around a triangle at a time step.
    #[inline(always)]
    pub fn triangle_bounds(&self, triangle: usize, step: usize) -> Bounds3 {
        let [a, b, c] = self.indices[triangle];
        let positions = self.positions[step].as_slice();
        let [a, b, c] = [positions[a as usize], positions[b as usize], positions[c as usize]];
        Bounds3 {
            min: a.min(b).min(c),
            max: a.max(b).max(c),
        }
    }

    /// A box around all used and unused vertices over all times.
    pub fn bounds(&self) -> Bounds3 {
        (0..self.time_steps())
            .map(|step| Bounds3::from_points(self.positions(step).iter().copied()))
            .fold(Bounds3::EMPTY, Bounds3::union)
    }

    /// Bytes of its arrays.
    pub fn memory(&self) -> usize {
        self.positions.iter().map(|p| size_of_val(p.as_slice())).sum::<usize>()
            + size_of_val(self.indices.as_slice())
            + self.attributes.memory()
    }
}
