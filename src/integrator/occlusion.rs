//! How open surfaces are to what is around them: ambient occlusion, as pbrt-v4's `ambientocclusion`.
//!
//! The value of a camera sample is the white of the picture times the share of the cosine-weighted hemisphere over the surface that is not
//! blocked within some distance; it is 0 where nothing is seen. Lights and materials do not matter.

use std::f32::consts::PI;

use super::shadow::{Contribution, NO_NOTE};
use super::stage::{Estimator, Stage, Vertex};
use crate::geometry::Ray;
use crate::math::{Frame, Vec3};
use crate::sampling::warp;
use crate::scene::View;
use crate::spectrum::{ColorMode, SampledSpectrum, cie};

/// The estimator of ambient occlusion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OcclusionIntegrator {
    /// Whether directions are drawn in proportion to the cosine; if not, all alike.
    pub cosine: bool,
    /// How far away things may be that block; infinite for any distance.
    pub max_distance: f32,
}

impl Estimator for OcclusionIntegrator {
    type State = ();
    type Memory<'s> = ();

    fn camera_state(&self, _view: &View, _ray: &Ray) {}

    fn shade<'s>(&self, stage: &mut Stage<'_, 's, Self>, vertex: Vertex<'_, ()>) {
        let Some(si) = vertex.surface else { return };
        let n = if si.ng.dot(si.wo) < 0.0 { -si.ng } else { si.ng };
        // The share is the mean of cos / (pi p).
        let (local, share) = if self.cosine {
            (warp::sample_cosine_hemisphere(vertex.numbers().bsdf), 1.0)
        } else {
            let local = warp::sample_uniform_hemisphere(vertex.numbers().bsdf);
            (local, local.z / (PI * warp::uniform_hemisphere_pdf().0))
        };
        let wi: Vec3 = Frame::from_normal(n).to_world(local).normalize();
        let ray = Ray {
            tfar: self.max_distance,
            ..si.spawn_ray(wi)
        };
        let lambda = &stage.slots[vertex.lane.slot as usize].lambda;
        let white = match stage.scene.color() {
            ColorMode::Rgb => SampledSpectrum::ONE,
            ColorMode::Spectral => {
                let space = stage.view.color_space;
                SampledSpectrum(lambda.lambda.map(|nm| space.white_at(nm) / cie::y_integral()))
            }
        };
        let contribution = Contribution {
            slot: vertex.lane.slot,
            note: NO_NOTE,
            value: white * share,
        };
        stage.add_unless_occluded(&ray, contribution);
    }
}
