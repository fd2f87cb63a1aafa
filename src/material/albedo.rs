//! How much a rough dielectric boundary reflects of light from one direction, by tables: what is left is for the layers under it.

use std::sync::OnceLock;

use super::{Microfacets, fresnel_dielectric};
use crate::math::{Vec2, Vec3};

/// Entries by the root of the slope, from 0 to 1, and by the cosine, from 0 to 1.
const SLOPES: usize = 16;
const COSINES: usize = 32;
/// Strata of the quadrature, each way.
const STRATA: usize = 24;

/// The reflected share of light from a direction, by slope, for one index of refraction.
#[derive(Clone, Debug)]
pub(super) struct ReflectionAlbedo {
    /// By slope, then cosine.
    values: Vec<[f32; COSINES]>,
    /// The cosine-weighted mean of what is not reflected, by slope.
    rest: Vec<f32>,
}

/// A table cut at one slope.
#[derive(Clone, Copy, Debug)]
pub(super) struct AlbedoRow<'a> {
    rows: [&'a [f32; COSINES]; 2],
    t: f32,
}

impl ReflectionAlbedo {
    /// For GGX facets of index `eta` (1 or more).
    pub fn new(eta: f32) -> Self {
        let slope = |i: usize| (i as f32 / (SLOPES - 1) as f32).powi(2).max(2e-3);
        let values: Vec<[f32; COSINES]> = (0..SLOPES)
            .map(|i| std::array::from_fn(|j| reflected(slope(i), cosine(j), eta)))
            .collect();
        let rest = values.iter().map(mean_rest).collect();
        Self { values, rest }
    }

    /// For the index 1.5 of lacquer.
    pub fn of_lacquer() -> &'static Self {
        static TABLE: OnceLock<ReflectionAlbedo> = OnceLock::new();
        TABLE.get_or_init(|| Self::new(1.5))
    }

    /// The table for a slope in [0, 1], and the cosine-weighted mean of what is not reflected.
    pub fn row(&self, alpha: f32) -> (AlbedoRow<'_>, f32) {
        let (i, t) = cell(alpha.sqrt(), SLOPES);
        let row = AlbedoRow {
            rows: [&self.values[i], &self.values[i + 1]],
            t,
        };
        (row, self.rest[i] * (1.0 - t) + self.rest[i + 1] * t)
    }
}

impl AlbedoRow<'_> {
    /// The reflected share of light from a cosine.
    pub fn at(&self, cos: f32) -> f32 {
        // Cosines are spaced by their roots.
        let (j, s) = cell(cos.sqrt(), COSINES);
        let along = |row: &[f32; COSINES]| row[j] * (1.0 - s) + row[j + 1] * s;
        along(self.rows[0]) * (1.0 - self.t) + along(self.rows[1]) * self.t
    }
}

fn cosine(j: usize) -> f32 {
    (j as f32 / (COSINES - 1) as f32).powi(2).max(1e-4)
}

/// The cell of `x` in [0, 1] among `count` entries, and the place in it.
fn cell(x: f32, count: usize) -> (usize, f32) {
    let scaled = x.clamp(0.0, 1.0) * (count - 1) as f32;
    let i = (scaled as usize).min(count - 2);
    (i, scaled - i as f32)
}

/// The mean over visible normals of Fresnel's reflectance and what is not shadowed.
fn reflected(alpha: f32, cos: f32, eta: f32) -> f32 {
    let Some(facets) = Microfacets::ggx(alpha, alpha) else {
        return fresnel_dielectric(cos, eta);
    };
    let wo = Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos);
    let g1 = facets.g1(wo);
    let mut sum = 0.0;
    for i in 0..STRATA * STRATA {
        let (x, y) = (i % STRATA, i / STRATA);
        let u = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / STRATA as f32;
        let m = facets.sample_visible_normal(wo, u);
        let wi = m * (2.0 * wo.dot(m)) - wo;
        if wi.z > 0.0 {
            sum += fresnel_dielectric(wo.dot(m), eta) * facets.g(wo, wi) / g1;
        }
    }
    sum / (STRATA * STRATA) as f32
}

/// The mean of 1 - row over the hemisphere, weighted by the cosine: exact for the linear interpolation in the root of the cosine.
fn mean_rest(row: &[f32; COSINES]) -> f32 {
    let steps = 4 * (COSINES - 1);
    let whole = AlbedoRow {
        rows: [row, row],
        t: 0.0,
    };
    // 2 cos d cos, with cos = x².
    let terms = (0..steps).map(|i| {
        let x = (i as f32 + 0.5) / steps as f32;
        4.0 * x * x * x * (1.0 - whole.at(x * x)) / steps as f32
    });
    terms.sum()
}
