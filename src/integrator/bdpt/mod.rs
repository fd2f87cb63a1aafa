//! Bidirectional path tracing (Lafortune and Willems 1993; Veach and Guibas 1994; Veach 1997, chapter 10).
//!
//! Each pixel sample has a light subpath and a camera subpath, which share its wavelengths and its time. All light subpaths of a wave
//! are traced first, and their vertices kept (`light_path.rs`); then the camera subpaths, which keep nothing (`camera_path.rs`):
//!
//! | strategy | how | where |
//! |---|---|---|
//! | t = 1, s > 1 | vertices of light subpaths are connected to the lens, and splatted | `light_path.rs` |
//! | s = 0 | a camera subpath meets a light | `camera_path.rs` |
//! | s = 1 | its vertices are connected to points of lights, chosen as in `path` | `connect.rs` |
//! | s > 1, t > 1 | and to all vertices of the light subpath | `connect.rs` |
//!
//! Lights seen directly are left to s = 0. What each is worth is in `mis.rs`. All connections of a stage are one stream of shadow rays.
//!
//! The light tracer is the first row alone, unweighted, with lights seen directly by s = 0: Dutre, Lafortune and Willems 1993.

mod camera_path;
mod connect;
mod light_path;
mod mis;
mod pyramid;

use self::light_path::{LightVertices, light_start};
use self::mis::{Exponent, Partial};
use self::pyramid::Record;
pub use self::pyramid::{Pyramid, StrategyLayer};
use super::adjoint::adjoint_correction;
use super::fault::Fault;
use super::lane::{Lane, LaneState};
use super::numbers::EventNumbers;
use super::path::survival;
use super::stage::{Estimator, Retiring, Stage, Vertex};
use crate::desc::Heuristic;
use crate::film::Film;
use crate::geometry::{Ray, RayCone, SurfaceInteraction};
use crate::material::{Bsdf, Density, TransportMode};
use crate::math::{Each, Vec3};
use crate::sampling::SampleStream;
use crate::scene::{Scene, View};

/// The bidirectional path tracer, or a part of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BdptIntegrator {
    /// The greatest number of scattering events; `None` for any number.
    pub max_depth: Option<u32>,
    /// How the strategies are weighed.
    pub heuristic: Heuristic,
    /// Which of them there are.
    pub strategies: Strategies,
    #[doc(hidden)]
    pub fault: Fault,
}

/// Which strategies make paths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Strategies {
    /// All, weighed.
    All,
    /// Light subpaths that are connected to the lens, and lights seen directly.
    LightTracer,
}

/// What a subpath knows of its last vertex.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    origin: Origin,
    /// The point that its ray left, and the shading normal there.
    p: Vec3,
    n: Vec3,
    /// Of the vertex that the ray will find, before it has arrived.
    partial: Partial,
    /// What all scattering left of the light: the greatest of the wavelengths, for Russian roulette.
    throughput: f32,
    /// What connections could have brought to the camera subpath so far.
    found: f32,
}

impl LaneState for State {
    type Lanes = Each<Self>;
}

/// How a ray began.
#[derive(Clone, Copy, Debug)]
enum Origin {
    /// At the lens.
    Camera,
    /// At a light: see [`LightVertices::start`].
    Light,
    /// At a surface.
    Surface,
}

type SubpathLane = Lane<State>;
type SubpathStage<'a, 's> = Stage<'a, 's, BdptIntegrator>;

/// A vertex of a subpath on a surface.
struct Event<'a, 's> {
    lane: &'a SubpathLane,
    si: &'a SurfaceInteraction,
    bsdf: Bsdf<'s>,
    partial: Partial,
    numbers: EventNumbers,
    cone: RayCone,
}

impl Estimator for BdptIntegrator {
    type State = State;
    type Memory<'s> = LightVertices<'s>;
    const LIGHT_PATHS: bool = true;

    fn camera_state(&self, _view: &View, ray: &Ray) -> State {
        State {
            origin: Origin::Camera,
            p: ray.origin,
            n: Vec3::ZERO,
            partial: Partial { vcm: 0.0, vc: 0.0 },
            throughput: 1.0,
            found: 0.0,
        }
    }

    fn memory<'s>(&self, film: &Film) -> LightVertices<'s> {
        LightVertices::recording(Record::for_film(film))
    }

    fn retire_layers(&self, memory: &mut LightVertices<'_>, wave: &Retiring<'_>) {
        if let Some(record) = &mut memory.record {
            record.retire(wave);
        }
    }

    fn arrived(memory: &mut LightVertices<'_>, note: u32) {
        if let Some(record) = &mut memory.record {
            record.arrived(note);
        }
    }

    fn emit<'s>(&self, stage: &mut SubpathStage<'_, 's>, slot: u32, stream: SampleStream) {
        if slot == 0 {
            stage.memory.restart(stage.slots.len());
        }
        self.start_light_path(stage, slot, stream);
    }

    fn shade<'s>(&self, stage: &mut SubpathStage<'_, 's>, vertex: Vertex<'_, State>) {
        match stage.mode {
            TransportMode::Importance => self.light_vertex(stage, &vertex),
            TransportMode::Radiance => self.camera_vertex(stage, &vertex),
        }
    }
}

impl BdptIntegrator {
    fn exponent(&self) -> Exponent {
        Exponent(self.heuristic)
    }

    /// Whether paths of so many scattering events count.
    fn allows(&self, events: u32) -> bool {
        self.max_depth.is_none_or(|max_depth| events <= max_depth)
    }

    /// Light subpaths for each sample of a pixel: one for each pixel of the picture.
    fn light_paths(view: &View) -> f64 {
        f64::from(view.resolution[0]) * f64::from(view.resolution[1])
    }

    /// What a subpath that meets a surface keeps of the strategies before. `None` if its light does not shine there.
    fn arrive(
        &self,
        stage: &SubpathStage<'_, '_>,
        vertex: &Vertex<'_, State>,
        si: &SurfaceInteraction,
    ) -> Option<Partial> {
        let Vertex { lane, ray, .. } = *vertex;
        let cos = f64::from(si.ng.dot(ray.direction).abs());
        Some(match lane.state.origin {
            Origin::Camera => {
                let arrival = stage.view.camera.pdf_we(si.p, ray.direction, ray.time);
                let arrival = arrival.map_or(0.0, |ray| f64::from(ray.arrival.0));
                self.exponent()
                    .camera_start(Self::light_paths(stage.view), arrival, cos)
            }
            Origin::Light => {
                let lambda = &stage.slots[lane.slot as usize].lambda;
                let start = light_start(stage.scene, stage.memory.start(lane.slot)?, si, ray, lambda)?;
                self.exponent().light_start(&start, cos)
            }
            Origin::Surface => {
                let distance_squared = f64::from(lane.state.p.distance_squared(si.p));
                self.exponent().arrive(lane.state.partial, distance_squared, cos)
            }
        })
    }

    /// The vertex of a subpath that meets a surface.
    fn event<'a, 's>(
        &self,
        stage: &mut SubpathStage<'_, 's>,
        vertex: &Vertex<'a, State>,
        si: &'a SurfaceInteraction,
        partial: Partial,
    ) -> Event<'a, 's> {
        let scene: &'s Scene = stage.scene;
        let lambda = &mut stage.slots[vertex.lane.slot as usize].lambda;
        Event {
            lane: vertex.lane,
            si,
            bsdf: scene.material(si.hit.geometry).bsdf(si, lambda),
            partial,
            numbers: vertex.numbers(),
            cone: vertex.cone,
        }
    }

    /// Goes on from a vertex, either way. `found` is that of the next [`State`].
    fn scatter<'s>(&self, stage: &mut SubpathStage<'_, 's>, event: &Event<'_, 's>, found: f32) {
        let Event { lane, si, numbers, .. } = event;
        let mode = stage.mode;
        let Some(sample) = event.bsdf.sample_f(si.wo, numbers.lobe, numbers.bsdf, mode) else {
            return;
        };
        let cos = f64::from(si.ng.dot(sample.wi).abs());
        let partial = match sample.density {
            Density::Delta(probability) if self.fault.is(Fault::DeltaConnected) => {
                let probability = f64::from(probability);
                self.exponent().scatter(event.partial, probability, probability, cos)
            }
            Density::Delta(_) => self.exponent().scatter_delta(event.partial, cos),
            Density::Continuous(forward) => {
                let reverse = event.bsdf.pdf(sample.wi, si.wo, mode.reversed());
                self.exponent()
                    .scatter(event.partial, f64::from(forward.0), f64::from(reverse.0), cos)
            }
        };
        let mut weight = sample.weight();
        if mode == TransportMode::Importance {
            weight *= self.adjoint_correction(si, &event.bsdf, sample.wi);
        }
        let throughput = lane.state.throughput * weight.max_value();
        let eta_scale = match mode {
            TransportMode::Radiance => lane.eta_scale * sample.eta * sample.eta,
            // Refraction squeezes radiance, not what light paths carry.
            TransportMode::Importance => 1.0,
        };
        let survival = self.survival(mode, stage.depth, throughput * eta_scale);
        if numbers.roulette >= survival {
            return;
        }
        let next = Lane {
            beta: lane.beta * weight * (1.0 / survival),
            eta_scale,
            cone: event.cone,
            state: State {
                origin: Origin::Surface,
                p: si.p,
                n: si.ns,
                partial,
                throughput: throughput / survival,
                found,
            },
            ..**lane
        };
        stage.go_on(&next, &si.spawn_ray(sample.wi));
    }

    /// The probability with which a subpath of this throughput goes on after the scattering event `depth`. Each vertex of a light subpath
    /// costs a splat, and connections to all vertices of the camera subpath: where there are such, light subpaths end earlier, with
    /// their throughput itself and from the second event on, which on the Cornell box takes a tenth off error times time.
    fn survival(&self, mode: TransportMode, depth: u32, throughput: f32) -> f32 {
        let is_unlimited = self.max_depth.is_none();
        match (mode, self.strategies) {
            (TransportMode::Importance, Strategies::All) => survival(depth + 1, throughput * throughput, is_unlimited),
            _ => survival(depth, throughput, is_unlimited),
        }
    }

    /// See [`adjoint_correction`].
    fn adjoint_correction(&self, si: &SurfaceInteraction, bsdf: &Bsdf, wi: Vec3) -> f32 {
        if self.fault.is(Fault::AdjointForgotten) {
            return 1.0;
        }
        adjoint_correction(si, bsdf, wi)
    }
}
