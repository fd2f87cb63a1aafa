//! Path tracing through participating media: between surfaces a path may be scattered by what fills the space there.
//!
//! At each event, of a surface or of a medium, light is looked for as `path` does it: by points of lights, whose light is weakened on its
//! way (`shadows.rs`), and by the direction that the path takes anyway. How far a path flies is drawn by its optical depth
//! (`flight.rs`); what comes from points is looked for between its ends as well (`equiangular.rs`). Emission of media is added in closed form along each flight, not only where it ends. A boundary without a surface
//! does not count as an event.

mod equiangular;
mod flight;
mod shadows;

use equiangular::{Passage, Segment, density_along};
use flight::{Arrival, Chances, Collision, Flight};
use shadows::{LightOnItsWay, MediaShadows};

use super::RenderStats;
use super::direct::{Origin, Viewpoint};
use super::lane::{Lane, LaneState, Slot};
use super::numbers::{DETECTOR_GROUP, EventNumbers};
use super::path::PathIntegrator;
use super::shadow::shadow_ray;
use super::stage::{Estimator, Stage, Vertex};
use crate::desc::Strategy;
use crate::geometry::{Ray, RayCone, SurfaceInteraction};
use crate::light::LightEnd;
use crate::material::{Bsdf, Density, TransportMode};
use crate::math::{Each, Vec3};
use crate::medium::{HenyeyGreenstein, MediumId};
use crate::sampling::power_heuristic;
use crate::scene::{Scene, View};
use crate::spectrum::SampledSpectrum;

/// [`PathIntegrator`] in a scene with media.
#[derive(Clone, Copy, Debug)]
pub(super) struct VolumePath(pub PathIntegrator);

/// What a path carries.
#[derive(Clone, Copy, Debug)]
pub(super) struct Traveller {
    origin: Origin,
    /// What its ray goes through.
    medium: Option<MediumId>,
    /// None before its first stage.
    flight: Option<Flight>,
}

impl LaneState for Traveller {
    type Lanes = Each<Self>;
}

type TravelLane = Lane<Traveller>;
type VolumeStage<'a, 's> = Stage<'a, 's, VolumePath>;

/// What scatters a path, and where.
#[derive(Clone, Copy)]
enum Scatterer<'a> {
    Surface(&'a SurfaceInteraction, &'a Bsdf<'a>),
    Medium(&'a Encounter),
}

/// A flight that ended in a medium.
struct Encounter {
    segment: Segment,
    collision: Collision,
    phase: HenyeyGreenstein,
}

impl Encounter {
    fn p(&self) -> Vec3 {
        self.segment.at(self.collision.t)
    }

    fn wo(&self) -> Vec3 {
        -self.segment.direction
    }
}

/// A scattering event.
#[derive(Clone, Copy)]
struct Event<'a> {
    /// The path; of a split one, with its part of the throughput.
    lane: &'a TravelLane,
    flight: Flight,
    by: Scatterer<'a>,
    numbers: &'a EventNumbers,
    time: f32,
    /// The cone of the ray from here on.
    cone: RayCone,
}

impl Estimator for VolumePath {
    type State = Traveller;
    type Memory<'s> = MediaShadows;

    fn camera_state(&self, view: &View, _ray: &Ray) -> Traveller {
        Traveller {
            origin: Origin::Delta,
            medium: view.medium,
            flight: None,
        }
    }

    fn own_shadows(memory: &MediaShadows) -> usize {
        memory.len()
    }

    fn flush_own_shadows(&self, scene: &Scene, memory: &mut MediaShadows, slots: &mut [Slot], stats: &mut RenderStats) {
        let (traced, elapsed) = memory.flush(scene, &self.0.direct_light(), slots);
        stats.shadow_rays += traced;
        stats.times.shadow += elapsed;
    }

    fn shade<'s>(&self, stage: &mut VolumeStage<'_, 's>, vertex: Vertex<'_, Traveller>) {
        let Vertex { ray, cone, .. } = vertex;
        let numbers = &vertex.numbers();
        let scene = stage.scene;
        let mut lane = *vertex.lane;
        let slot = &mut stage.slots[lane.slot as usize];
        let mut flight = lane.state.flight.unwrap_or_else(|| start_flight(scene, slot, &lane));
        let distance = vertex.surface.map_or(f32::INFINITY, |si| si.p.distance(ray.origin));
        let segment = Segment::of(ray, distance);
        if let Some(encounter) = self.cross(stage, &mut lane, &mut flight, &segment, &vertex) {
            let event = Event {
                lane: &lane,
                flight,
                by: Scatterer::Medium(&encounter),
                numbers,
                time: ray.time,
                cone: lane.cone.after(encounter.collision.t),
            };
            return self.scatter(stage, &event);
        }
        if lane.beta.is_black() {
            return;
        }
        let (slot, direct) = (&mut stage.slots[lane.slot as usize], self.0.direct_light());
        let origin = lane.state.origin.after(flight.chances.passed());
        let Some(si) = vertex.surface else {
            slot.l += lane.beta * direct.environment(scene, &origin, ray, &slot.lambda);
            return;
        };
        if scene.is_interface(si.hit.geometry) {
            lane.state.medium = scene.medium_beyond(si, ray.direction, lane.state.medium);
            lane.state.flight = Some(flight);
            lane.cone = cone;
            return stage.pass_on(&lane, &si.rest_of_ray(ray));
        }
        if let Some(le) = direct.emission(scene, &origin, si, &slot.lambda) {
            slot.l += lane.beta * le;
        }
        if self.0.max_depth == Some(stage.depth) {
            return;
        }
        let bsdf = scene.material(si.hit.geometry).bsdf(si, &mut slot.lambda);
        let event = Event {
            lane: &lane,
            flight,
            by: Scatterer::Surface(si, &bsdf),
            numbers,
            time: ray.time,
            cone,
        };
        self.scatter(stage, &event);
    }
}

impl VolumePath {
    /// Flies along a segment, through a medium if there is one: adds what that emits and what it scatters of the light of points, and
    /// weakens what the path carries. Where it ends, unless that is at the end of the segment.
    fn cross(
        &self,
        stage: &mut VolumeStage<'_, '_>,
        lane: &mut TravelLane,
        flight: &mut Flight,
        segment: &Segment,
        vertex: &Vertex<'_, Traveller>,
    ) -> Option<Encounter> {
        let medium = stage.scene.medium(lane.state.medium?);
        let slot = &mut stage.slots[lane.slot as usize];
        let at = medium.at(&slot.lambda);
        let numbers = &vertex.numbers();
        slot.l += lane.beta * at.emission(segment.length);
        if let Some(phase) = medium.phase {
            let passage = Passage {
                lane,
                flight: *flight,
                at: &at,
                phase,
                segment: *segment,
                numbers,
                time: vertex.ray.time,
            };
            self.look_along(stage, &passage);
        }
        match flight.fly(medium, &at, segment.length, numbers.connections) {
            Arrival::Through(factor) => {
                lane.beta *= factor;
                None
            }
            Arrival::Collision(collision) => {
                lane.beta *= collision.factor;
                medium.phase.map(|phase| Encounter {
                    segment: *segment,
                    collision,
                    phase,
                })
            }
        }
    }

    /// Goes on from a scattering event, once or, where the path splits, several times.
    fn scatter(&self, stage: &mut VolumeStage<'_, '_>, event: &Event<'_>) {
        if self.0.max_depth == Some(stage.depth) {
            return;
        }
        let lane = event.lane;
        let is_delta = matches!(event.by, Scatterer::Surface(_, bsdf) if bsdf.is_delta());
        if self.0.splitting == 1 || lane.split || is_delta {
            self.look_for_light(stage, event);
            return self.go_on(stage, event);
        }
        for branch in 0..self.0.splitting {
            let stream = lane.stream.branch(branch);
            let lane = &Lane {
                split: true,
                stream,
                beta: lane.beta * (1.0 / self.0.splitting as f32),
                ..*lane
            };
            let numbers = &EventNumbers::draw(&stream, stage.depth);
            let event = &Event {
                lane,
                numbers,
                ..*event
            };
            self.look_for_light(stage, event);
            self.go_on(stage, event);
        }
    }

    /// A point of a light, whose light starts on its way to the event.
    fn look_for_light(&self, stage: &mut VolumeStage<'_, '_>, event: &Event<'_>) {
        let is_delta = matches!(event.by, Scatterer::Surface(_, bsdf) if bsdf.is_delta());
        if self.0.strategy == Strategy::Bsdf || is_delta {
            return;
        }
        let Event {
            lane, numbers, time, ..
        } = *event;
        let (scene, direct) = (stage.scene, self.0.direct_light());
        let lambda = &stage.slots[lane.slot as usize].lambda;
        let found = match event.by {
            Scatterer::Surface(si, bsdf) => direct.look_from_surface(scene, si, bsdf, numbers, lambda),
            Scatterer::Medium(encounter) => {
                let (p, n) = (encounter.p(), Vec3::ZERO);
                direct.look(scene, &Viewpoint { p, n, time }, numbers, lambda, |wi| {
                    let pdf = encounter.phase.pdf(encounter.wo(), wi);
                    Some((SampledSpectrum::splat(pdf.0), pdf))
                })
            }
        };
        let Some(mut found) = found else { return };
        let wi = found.sample.wi;
        let (ray, medium) = match event.by {
            Scatterer::Surface(si, _) => (
                shadow_ray(si, wi, found.sample.end),
                scene.medium_beyond(si, wi, lane.state.medium),
            ),
            Scatterer::Medium(encounter) => {
                let Collision { t, density, .. } = encounter.collision;
                let along = density_along(scene, &encounter.segment, t, found.chosen.light, time);
                found.value *= power_heuristic(density * found.chosen.pmf, along);
                let ray = ray_through_space(encounter.p(), wi, found.sample.end, time);
                (ray, lane.state.medium)
            }
        };
        if !ray.is_valid() {
            stage.slot(lane).broken = true;
            return;
        }
        let light = LightOnItsWay {
            slot: lane.slot,
            value: lane.beta * found.value,
            medium,
            chances: event.flight.scattered().chances,
            pdf_light: found.pdf_light,
            pdf_scatter: found.pdf_scatter,
        };
        stage.memory.push(&ray, light);
    }

    /// Draws where the path goes from an event.
    fn go_on(&self, stage: &mut VolumeStage<'_, '_>, event: &Event<'_>) {
        let Event { lane, numbers, .. } = *event;
        let mut next = Lane {
            cone: event.cone,
            ..*lane
        };
        next.state.flight = Some(event.flight.scattered());
        let ray = match event.by {
            Scatterer::Surface(si, bsdf) => {
                let sample = bsdf.sample_f(si.wo, numbers.lobe, numbers.bsdf, TransportMode::Radiance);
                let Some(sample) = sample else { return };
                next.beta *= sample.weight();
                next.eta_scale *= sample.eta * sample.eta;
                next.state.origin = match sample.density {
                    Density::Delta(_) => Origin::Delta,
                    Density::Continuous(pdf) => Origin::Sampled { p: si.p, n: si.ns, pdf },
                };
                next.state.medium = stage.scene.medium_beyond(si, sample.wi, lane.state.medium);
                si.spawn_ray(sample.wi)
            }
            Scatterer::Medium(encounter) => {
                // The value is the density: the weight is 1.
                let (wi, pdf) = encounter.phase.sample(encounter.wo(), numbers.bsdf);
                let (p, n) = (encounter.p(), Vec3::ZERO);
                next.state.origin = Origin::Sampled { p, n, pdf };
                Ray::new(p, wi, event.time)
            }
        };
        if self.0.survives(&mut next, stage.depth, numbers) {
            stage.go_on(&next, &ray);
        }
    }
}

/// The ray from a point in space in direction `wi` to where a light was sampled.
fn ray_through_space(p: Vec3, wi: Vec3, end: LightEnd, time: f32) -> Ray {
    match end {
        LightEnd::Point { p: to, error, ng } => Ray::between(p, to, error, ng, time),
        LightEnd::Infinity => Ray::new(p, wi, time),
    }
}

/// The first flight of a path.
fn start_flight(scene: &Scene, slot: &mut Slot, lane: &TravelLane) -> Flight {
    // A path on which glass may part the wavelengths later is one of its hero from the start: who decides on flights until then would
    // have had other wavelengths with it than who decides after.
    if scene.disperses() {
        slot.lambda.terminate_secondary();
    }
    let [u, ..] = lane.stream.draw4(DETECTOR_GROUP);
    Flight::start(Chances::start(scene.color(), &slot.lambda, u))
}
