//! Camera subpaths: they meet lights (s = 0), and are connected (`connect.rs`).

use super::mis::{Exponent, Partial};
use super::{BdptIntegrator, State, Strategies, SubpathStage};
use crate::geometry::SurfaceInteraction;
use crate::integrator::fault::Fault;
use crate::integrator::stage::Vertex;

impl BdptIntegrator {
    /// A camera subpath meets a surface, or leaves the scene.
    pub(super) fn camera_vertex<'s>(&self, stage: &mut SubpathStage<'_, 's>, vertex: &Vertex<'_, State>) {
        let Some(si) = vertex.surface else {
            self.add_environment(stage, vertex);
            return;
        };
        let Some(partial) = self.arrive(stage, vertex, si) else {
            return;
        };
        self.add_emission(stage, vertex, si, partial);
        if self.strategies == Strategies::LightTracer || !self.allows(stage.depth + 1) {
            return;
        }
        let event = self.event(stage, vertex, si, partial);
        let found = if event.bsdf.is_delta() {
            event.lane.state.found
        } else {
            self.connect(stage, &event)
        };
        self.scatter(stage, &event, found);
    }

    /// s = 0, at a surface.
    fn add_emission(
        &self,
        stage: &mut SubpathStage<'_, '_>,
        vertex: &Vertex<'_, State>,
        si: &SurfaceInteraction,
        partial: Partial,
    ) {
        let (scene, lane) = (stage.scene, vertex.lane);
        let Some(id) = scene.light_of(si.hit.geometry, si.hit.primitive) else {
            return;
        };
        let light = scene.light(id);
        let slot = &mut stage.slots[lane.slot as usize];
        let le = light.le(si, si.wo, &slot.lambda);
        if le.is_black() {
            return;
        }
        let State { p, n, .. } = lane.state;
        let weight = if stage.depth == 0 {
            1.0
        } else {
            let pmf = f64::from(scene.light_sampler().pmf(p, n, id));
            let cos = f64::from(si.ng.dot(vertex.ray.direction).abs());
            let direct = pmf * f64::from(light.pdf_li(p, si).0) * cos / f64::from(p.distance_squared(si.p));
            let (position, direction) = light.pdf_le(si, si.wo);
            let chosen = f64::from(scene.emission_sampler().pmf(p, n, id));
            let emission = chosen * f64::from(position.0) * f64::from(direction.0);
            self.weight_of_met_light(partial, direct, emission)
        };
        let l = lane.beta * le * (weight as f32);
        slot.l += l;
        if let Some(record) = &mut stage.memory.record {
            record.add(lane.slot, stage.depth + 2, l, lane.beta * le);
        }
    }

    /// s = 0, of what is infinitely far away: "densities by area" there are by solid angle.
    fn add_environment(&self, stage: &mut SubpathStage<'_, '_>, vertex: &Vertex<'_, State>) {
        let Vertex { lane, ray, .. } = *vertex;
        let (scene, depth) = (stage.scene, stage.depth);
        let State { p, n, partial, .. } = lane.state;
        let slot = &mut stage.slots[lane.slot as usize];
        for (id, light) in scene.environments() {
            let le = light.le(ray.origin, ray.direction, ray.time, &slot.lambda);
            if le.is_black() {
                continue;
            }
            let weight = if depth == 0 {
                1.0
            } else {
                let pmf = f64::from(scene.light_sampler().pmf(p, n, id));
                let direct = pmf * f64::from(light.pdf_li(p, ray.direction, ray.time).0);
                let (position, direction) = light.pdf_le(p, ray.direction, ray.time, &scene.bounds());
                let chosen = f64::from(scene.emission_sampler().pmf(p, n, id));
                let emission = chosen * f64::from(position.0) * f64::from(direction.0);
                self.weight_of_met_light(partial, direct, emission)
            };
            let l = lane.beta * le * (weight as f32);
            slot.l += l;
            if let Some(record) = &mut stage.memory.record {
                record.add(lane.slot, depth + 2, l, lane.beta * le);
            }
        }
    }

    /// s = 1 has the density `direct` for the point of the light instead of that in `partial`, s > 1 has that of a whole ray.
    fn weight_of_met_light(&self, partial: Partial, direct: f64, emission: f64) -> f64 {
        if self.fault.is(Fault::StrategyLeftOut) {
            return 1.0;
        }
        let exponent = self.exponent();
        let w_camera = exponent.of(direct) * partial.vcm + exponent.of(emission) * partial.vc;
        Exponent::weight(0.0, w_camera)
    }
}
