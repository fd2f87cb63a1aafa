//! Points sampled on bilinear patches.

use crate::geometry::{Patch, PatchSurface};
use crate::math::{DVec2, DVec3, Vec2};
use crate::sampling::warp;

/// A bilinear patch to sample points of: nearly uniformly by area, as the area element, which is the length of the cross product of
/// the derivatives, is taken to be bilinear between the corners.
#[derive(Clone, Debug)]
pub struct PatchEmitter {
    /// The patch.
    pub surface: PatchSurface,
    /// Area elements at the corners, relative to the largest.
    weights: [f32; 4],
    area: f64,
}

impl PatchEmitter {
    /// `None` if the patch has no area.
    pub fn new(surface: PatchSurface) -> Option<Self> {
        let corners = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE];
        let elements = corners.map(|uv| element(&surface.patch, uv));
        let largest = elements.into_iter().fold(0.0, f64::max);
        let area = area(&surface.patch);
        (area > 0.0 && area.is_finite()).then(|| Self {
            surface,
            // A corner without area may have points with some beside it.
            weights: elements.map(|e| ((e / largest) as f32).max(1e-3)),
            area,
        })
    }

    /// One side.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// The parameters of a point for `u` in [0, 1)², and its density by area.
    pub fn sample(&self, u: Vec2) -> (DVec2, f64) {
        let [a, b, c, d] = self.weights;
        let v = warp::sample_linear(u.y, a + b, c + d);
        let u = warp::sample_linear(u.x, a + (c - a) * v, b + (d - b) * v);
        let uv = Vec2::new(u, v).as_dvec2();
        (uv, self.density(uv))
    }

    /// The density by area of [`PatchEmitter::sample`] at a point where the geometric normal is `ng`.
    pub fn pdf(&self, p: DVec3, ng: DVec3) -> f64 {
        self.density(self.surface.patch.invert(p, ng))
    }

    fn density(&self, uv: DVec2) -> f64 {
        let [a, b, c, d] = self.weights.map(f64::from);
        let weight = (a * (1.0 - uv.x) + b * uv.x) * (1.0 - uv.y) + (c * (1.0 - uv.x) + d * uv.x) * uv.y;
        let density = weight / (0.25 * (a + b + c + d)) / element(&self.surface.patch, uv);
        // A point of a corner that is none.
        if density.is_finite() { density } else { 0.0 }
    }
}

/// Area of the patch for area of its parameters.
fn element(patch: &Patch, uv: DVec2) -> f64 {
    let [dpdu, dpdv] = patch.derivatives(uv);
    dpdu.cross(dpdv).length()
}

/// By Gauss and Legendre's rule of six points along each parameter: exact for flat patches.
fn area(patch: &Patch) -> f64 {
    const NODES: [(f64, f64); 3] = [
        (0.238_619_186_083_196_9, 0.467_913_934_572_691_05),
        (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
        (0.932_469_514_203_152, 0.171_324_492_379_170_35),
    ];
    let nodes = NODES
        .iter()
        .flat_map(|&(x, w)| [(0.5 - 0.5 * x, 0.5 * w), (0.5 + 0.5 * x, 0.5 * w)]);
    let row = |v: f64| {
        nodes
            .clone()
            .map(|(u, w)| w * element(patch, DVec2::new(u, v)))
            .sum::<f64>()
    };
    nodes.clone().map(|(v, w)| w * row(v)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::PatchMesh;
    use crate::math::Vec3;

    #[test]
    fn the_density_is_that_of_the_points_and_integrates_to_one() {
        let twisted = [
            Vec3::new(-1.0, -1.0, 0.3),
            Vec3::new(1.2, -0.8, -0.5),
            Vec3::new(-0.9, 0.1, -0.6),
            Vec3::new(1.0, 0.9, 0.7),
        ];
        let triangle = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Y];
        for (corners, flat_area) in [(twisted, None), (triangle, Some(0.5))] {
            let mesh = PatchMesh::new(corners.to_vec(), vec![[0, 1, 2, 3]]).unwrap();
            let emitter = PatchEmitter::new(mesh.surface(0)).unwrap();
            if let Some(area) = flat_area {
                assert!((emitter.area() - area).abs() < 1e-9);
            }
            let (mut area, mut count) = (0.0, 0.0);
            for i in 0..256 * 256 {
                let u = (Vec2::new((i % 256) as f32, (i / 256) as f32) + 0.5) / 256.0;
                let (uv, pdf) = emitter.sample(u);
                let surface = &emitter.surface;
                let again = emitter.pdf(surface.patch.point(uv), surface.ng(uv));
                assert!((again / pdf - 1.0).abs() < 1e-5, "{uv} {again} {pdf}");
                area += 1.0 / pdf;
                count += 1.0;
            }
            // The area is the mean of 1 / pdf.
            assert!(
                (area / count / emitter.area() - 1.0).abs() < 1e-3,
                "{} {}",
                area / count,
                emitter.area()
            );
        }
    }
}
