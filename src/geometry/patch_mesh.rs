//! Meshes of bilinear patches.

use super::patch::{Patch, mix};
use super::surface::LocalSurface;
use super::triangle::LEAST_ERROR;
use super::vertices::{Attributes, MeshError, check_faces, check_positions};
use crate::math::{DAffine3, DVec2, DVec3, Vec2, Vec3};

/// Bilinear patches over shared vertices.
#[derive(Clone, Debug)]
pub struct PatchMesh {
    positions: Vec<Vec3>,
    /// p00, p10, p01, p11 of each patch.
    indices: Vec<[u32; 4]>,
    attributes: Attributes,
    flip_normal: bool,
}

impl PatchMesh {
    /// Patches of `indices` into `positions`.
    ///
    /// # Errors
    /// Positions that are not finite, indices that name none.
    pub fn new(positions: Vec<Vec3>, indices: Vec<[u32; 4]>) -> Result<Self, MeshError> {
        check_positions(&positions)?;
        check_faces(&indices, positions.len())?;
        Ok(Self {
            positions,
            indices,
            attributes: Attributes::default(),
            flip_normal: false,
        })
    }

    /// With shading normals, one a vertex, of any length; or with none.
    ///
    /// # Errors
    /// If there are some, but not one for each vertex.
    pub fn with_normals(mut self, normals: Vec<Vec3>) -> Result<Self, MeshError> {
        self.attributes.set_normals(normals, self.positions.len())?;
        Ok(self)
    }

    /// With texture coordinates, one a vertex; or with none: then they are the parameters u and v.
    ///
    /// # Errors
    /// If there are some, but not one for each vertex.
    pub fn with_uvs(mut self, uvs: Vec<Vec2>) -> Result<Self, MeshError> {
        self.attributes.set_uvs(uvs, self.positions.len())?;
        Ok(self)
    }

    /// With the geometric normal against the cross product of the derivatives by u and v.
    #[must_use]
    pub fn with_flipped_normal(mut self, flip: bool) -> Self {
        self.flip_normal = flip;
        self
    }

    /// Number of patches.
    pub fn patch_count(&self) -> usize {
        self.indices.len()
    }

    /// One of them.
    #[inline]
    pub fn patch(&self, index: usize) -> Patch {
        Patch {
            corners: self.indices[index].map(|v| self.positions[v as usize].as_dvec3()),
        }
    }

    /// One of them, with what the mesh says of its corners.
    pub fn surface(&self, index: usize) -> PatchSurface {
        let corners = self.indices[index].map(|v| v as usize);
        PatchSurface {
            patch: self.patch(index),
            normals: self
                .attributes
                .normals
                .as_ref()
                .map_or([DVec3::ZERO; 4], |normals| corners.map(|v| normals[v].as_dvec3())),
            uvs: self
                .attributes
                .uvs
                .as_ref()
                .map_or(UNIT_SQUARE, |uvs| corners.map(|v| uvs[v].as_dvec2())),
            flip_normal: self.flip_normal,
        }
    }

    /// Bytes of its arrays.
    pub fn memory(&self) -> usize {
        size_of_val(self.positions.as_slice()) + size_of_val(self.indices.as_slice()) + self.attributes.memory()
    }
}

/// Texture coordinates that are the parameters.
const UNIT_SQUARE: [DVec2; 4] = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE];

/// A patch with normals and texture coordinates at its corners.
#[derive(Clone, Debug)]
pub struct PatchSurface {
    /// Its points.
    pub patch: Patch,
    /// All zero if there are none.
    normals: [DVec3; 4],
    uvs: [DVec2; 4],
    flip_normal: bool,
}

impl PatchSurface {
    /// This one, transformed. The transform must not be singular.
    #[must_use]
    pub fn transformed(&self, transform: &DAffine3) -> Self {
        let normal_matrix = transform.matrix3.inverse().transpose();
        Self {
            patch: Patch {
                corners: self.patch.corners.map(|p| transform.transform_point3(p)),
            },
            normals: self.normals.map(|n| normal_matrix * n),
            uvs: self.uvs,
            flip_normal: self.flip_normal ^ (transform.matrix3.determinant() < 0.0),
        }
    }

    /// The unit geometric normal at the parameters: on the side of the shading normals if there are any, as in pbrt; zero where the
    /// patch has none.
    pub fn ng(&self, uv: DVec2) -> DVec3 {
        let cross = self.patch.cross(uv);
        let cos = cross.dot(mix(&self.normals, uv));
        let is_flipped = if cos == 0.0 { self.flip_normal } else { cos < 0.0 };
        let ng = cross.normalize_or_zero();
        if is_flipped { -ng } else { ng }
    }

    /// The texture coordinates at the parameters.
    pub fn texture_coordinates(&self, uv: DVec2) -> Vec2 {
        mix(&self.uvs, uv).as_vec2()
    }

    /// The surface where a ray meets it at `tnear` or behind, or nearly does.
    pub(super) fn at(&self, origin: DVec3, direction: DVec3, tnear: f64) -> LocalSurface {
        let hits = self.patch.intersect(origin, direction);
        let behind = |t: f64| if t >= tnear { t } else { f64::INFINITY };
        let hit = hits.into_iter().flatten().min_by(|a, b| {
            let by_place = behind(a.t).total_cmp(&behind(b.t));
            by_place.then(b.t.total_cmp(&a.t))
        });
        // Where a backend saw a hit through an instance's rounded transform: the point of the patch nearest to the line.
        let uv = hit.map_or_else(|| self.patch.nearest_to_line(origin, direction), |hit| hit.uv);
        let [dpds, dpdt] = self.derivatives(uv);
        LocalSurface {
            p: self.patch.point(uv),
            error: self.error(),
            ng: self.ng(uv),
            ns: mix(&self.normals, uv).normalize_or_zero().as_vec3(),
            dpdu: dpds.as_vec3(),
            dpdv: dpdt.as_vec3(),
            uv: self.texture_coordinates(uv),
            barycentrics: Vec2::ZERO,
        }
    }

    /// How far from a point a backend may see the surface, beside the rounding of the point: its test is in double precision.
    pub fn error(&self) -> f64 {
        LEAST_ERROR * f64::from(self.patch.bounds().extent().length())
    }

    /// The derivatives of the point by the texture coordinates; zero where these are degenerate.
    fn derivatives(&self, uv: DVec2) -> [DVec3; 2] {
        let [dpdu, dpdv] = self.patch.derivatives(uv);
        let [a, b, c, d] = self.uvs;
        let (by_u, by_v) = ((b - a).lerp(d - c, uv.y), (c - a).lerp(d - b, uv.x));
        let inverse = 1.0 / by_u.perp_dot(by_v);
        let inverse = if inverse.is_finite() { inverse } else { 0.0 };
        [
            (dpdu * by_v.y - dpdv * by_u.y) * inverse,
            (dpdv * by_u.x - dpdu * by_v.x) * inverse,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texture_coordinates_and_normals_are_interpolated() {
        let positions = [
            Vec3::new(-1.0, -1.0, 0.3),
            Vec3::new(1.2, -0.8, -0.5),
            Vec3::new(-0.9, 1.1, -0.6),
            Vec3::new(1.0, 0.9, 0.7),
        ]
        .to_vec();
        let mesh = PatchMesh::new(positions, vec![[0, 1, 2, 3]]).unwrap();
        let (origin, direction) = (DVec3::new(0.1, 0.2, 5.0), DVec3::NEG_Z);
        let bare = mesh.surface(0).at(origin, direction, 0.0);
        assert!(bare.ng.z > 0.0 && bare.ns == Vec3::ZERO);
        let uvs = vec![
            Vec2::new(1.0, 1.0),
            Vec2::new(3.0, 1.0),
            Vec2::new(1.0, 2.0),
            Vec2::new(3.0, 2.0),
        ];
        let normals = vec![Vec3::NEG_Z; 4];
        let mesh = mesh.with_uvs(uvs).unwrap().with_normals(normals).unwrap();
        let surface = mesh.surface(0).at(origin, direction, 0.0);
        assert!((surface.uv - (Vec2::ONE + bare.uv * Vec2::new(2.0, 1.0))).length() < 1e-6);
        assert!((surface.dpdu * 2.0 - bare.dpdu).length() < 1e-6 && (surface.dpdv - bare.dpdv).length() < 1e-6);
        assert!((surface.ng + bare.ng).length() < 1e-12 && surface.ns == Vec3::NEG_Z);
    }
}
