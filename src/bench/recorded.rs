//! The rays that a render really shoots.

use std::sync::Arc;

use super::streams::{Stream, StreamKind, sort};
use crate::accel::record::{RayStreams, Recorder};
use crate::geometry::LANES;
use crate::integrator::{Integrator, Silent};
use crate::scene::{Scene, View};

/// Renders `view` and returns the streams, of about `most` rays each, and the scene as it was. If the integrator follows no paths from
/// lights and the scene has lights, photons are those of a second render by `lightpath`.
///
/// What cut-outs let through is not recorded: replayed, they are solid.
pub fn record(scene: Scene, view: &View, integrator: &Integrator, most: usize) -> (Scene, Vec<Stream>) {
    let recorded = RayStreams::new(most.div_ceil(LANES));
    let mut inner = None;
    let scene = scene.map_accel(|accel| {
        inner = Some(Arc::clone(&accel));
        Arc::new(Recorder::new(accel, recorded.clone()))
    });
    let take = || {
        let named = |(kind, origin, waves)| (StreamKind::of(kind, origin), waves);
        recorded.take().into_iter().map(named)
    };
    integrator.render(&scene, view, &integrator.film(view), &Silent);
    let mut waves: Vec<_> = take().collect();
    if waves.iter().all(|(kind, _)| *kind != StreamKind::Photon) && !scene.lights().is_empty() {
        let lights = integrator.named("lightpath");
        lights.render(&scene, view, &lights.film(view), &Silent);
        waves.extend(take().filter(|(kind, _)| *kind == StreamKind::Photon));
    }
    let scene = scene.map_accel(|recorder| inner.unwrap_or(recorder));
    (scene, sort(waves, most))
}
