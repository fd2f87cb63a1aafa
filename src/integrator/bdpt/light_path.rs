//! Light subpaths: they start at lights, keep their vertices, and are connected to the lens.

use super::connect::Connection;
use super::mis::{Exponent, LightStart, Partial};
use super::pyramid::Record;
use super::{BdptIntegrator, Event, Origin, State, Strategies, SubpathStage};
use crate::geometry::{Ray, SurfaceInteraction};
use crate::integrator::adjoint::bend;
use crate::integrator::emission::sample_emission;
use crate::integrator::lane::Lane;
use crate::integrator::numbers::EmissionNumbers;
use crate::integrator::shadow::{NO_NOTE, SplatContribution};
use crate::integrator::stage::Vertex;
use crate::light::{EmissionOrigin, Light, LightDensity, LightId};
use crate::material::{Bsdf, TransportMode};
use crate::math::Vec3;
use crate::sampling::SampleStream;
use crate::scene::Scene;
use crate::spectrum::{SampledSpectrum, Wavelengths};

/// The first ray of a light subpath.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightRay {
    light: LightId,
    origin: EmissionOrigin,
    cos_theta: f32,
    /// See [`LightStart::emission`].
    emission: f64,
    has_delta_position: bool,
    is_delta: bool,
}

/// A vertex that camera subpaths may be connected to.
#[derive(Debug)]
pub(super) struct LightVertex<'s> {
    pub p: Vec3,
    /// As in [`SurfaceInteraction`], and so are the normal and the direction.
    pub error: f32,
    pub ng: Vec3,
    pub wo: Vec3,
    pub bsdf: Bsdf<'s>,
    /// [`bend`] of `wo`.
    pub bend: f32,
    /// Power over the density of the subpath, before it is scattered here.
    pub beta: SampledSpectrum,
    pub partial: Partial,
}

/// What is looked at first of a [`LightVertex`].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Seat {
    p: Vec3,
    /// The shading normal, on the side that alone scatters light; 0 if both do.
    side: Vec3,
    /// Scattering events before this one.
    pub depth: u32,
    /// Which it is.
    vertex: u32,
}

impl Seat {
    /// Whether light may be scattered to the point `p`, as far as sides tell.
    #[inline]
    pub fn may_see(&self, p: Vec3) -> bool {
        self.side.dot(p - self.p) > 0.0 || self.side == Vec3::ZERO
    }
}

/// The vertices of the light subpaths of a wave.
#[derive(Debug, Default)]
pub(in crate::integrator) struct LightVertices<'s> {
    /// By slot.
    starts: Vec<Option<LightRay>>,
    vertices: Vec<LightVertex<'s>>,
    /// In the same order: slots, and what is looked at first.
    made: Vec<(u32, Seat)>,
    /// The latter by slot, if they have been arranged: those of slot i are `seats[ends[i - 1]..ends[i]]`.
    seats: Vec<Seat>,
    ends: Vec<u32>,
    is_arranged: bool,
    /// Memory for those of a vertex.
    pub(super) connections: Vec<Connection>,
    /// What each strategy finds, if that is wanted.
    pub(super) record: Option<Box<Record>>,
}

impl<'s> LightVertices<'s> {
    /// None, and where to note what each strategy finds.
    pub(super) fn recording(record: Option<Box<Record>>) -> Self {
        Self {
            record,
            ..Self::default()
        }
    }

    /// Forgets all, for a wave of so many slots.
    pub fn restart(&mut self, slots: usize) {
        self.starts.clear();
        self.starts.resize(slots, None);
        self.vertices.clear();
        self.made.clear();
        self.ends.clear();
        self.ends.resize(slots, 0);
        self.is_arranged = false;
        if let Some(record) = &mut self.record {
            record.restart(slots);
        }
    }

    /// How the light subpath of a slot began; `None` if it has none.
    pub(super) fn start(&self, slot: u32) -> Option<&LightRay> {
        self.starts[slot as usize].as_ref()
    }

    fn push(&mut self, slot: u32, depth: u32, si: &SurfaceInteraction, vertex: LightVertex<'s>) {
        let (normal, vertex_index) = (vertex.bsdf.frame().n, self.vertices.len() as u32);
        let side = match vertex.bsdf.transmits() {
            true => Vec3::ZERO,
            false if normal.dot(si.wo) < 0.0 => -normal,
            false => normal,
        };
        let seat = Seat {
            p: vertex.p,
            side,
            depth,
            vertex: vertex_index,
        };
        self.ends[slot as usize] += 1;
        self.made.push((slot, seat));
        self.vertices.push(vertex);
    }

    /// Makes them ready to be asked for, once all have been made: those of a slot were made one after the other, with all others between
    /// them, and would each be waited for.
    pub(super) fn arrange(&mut self) {
        if std::mem::replace(&mut self.is_arranged, true) {
            return;
        }
        let mut first = 0;
        for end in &mut self.ends {
            first += std::mem::replace(end, first);
        }
        self.seats.resize(self.made.len(), Seat::default());
        for (slot, seat) in &self.made {
            let end = &mut self.ends[*slot as usize];
            self.seats[*end as usize] = *seat;
            *end += 1;
        }
    }

    /// Those of a slot, the first one first. They have been [arranged](LightVertices::arrange).
    pub(super) fn of(&self, slot: u32) -> impl Iterator<Item = (&Seat, &LightVertex<'s>)> {
        let slot = slot as usize;
        let first = if slot == 0 { 0 } else { self.ends[slot - 1] };
        let seats = &self.seats[first as usize..self.ends[slot] as usize];
        seats.iter().map(|seat| (seat, &self.vertices[seat.vertex as usize]))
    }
}

impl BdptIntegrator {
    /// Draws a light by its power, and a ray from it.
    pub(super) fn start_light_path(&self, stage: &mut SubpathStage<'_, '_>, slot: u32, stream: SampleStream) {
        let numbers = EmissionNumbers::draw(&stream);
        let of_slot = &stage.slots[slot as usize];
        let Some((chosen, sample)) = sample_emission(stage.scene, of_slot, &numbers) else {
            return;
        };
        let emission = f64::from(chosen.pmf) * sample.density.product();
        let has_delta_position = sample.density.position == LightDensity::Delta;
        let ray = sample.ray(of_slot.time);
        stage.memory.starts[slot as usize] = Some(LightRay {
            light: chosen.light,
            origin: sample.origin,
            cos_theta: sample.cos_theta,
            emission,
            has_delta_position,
            is_delta: has_delta_position || sample.density.direction == LightDensity::Delta,
        });
        let lane = Lane {
            slot,
            split: false,
            stream,
            beta: sample.le * ((f64::from(sample.cos_theta) / emission) as f32),
            eta_scale: 1.0,
            cone: Default::default(),
            state: State {
                origin: Origin::Light,
                p: ray.origin,
                n: Vec3::ZERO,
                partial: Partial { vcm: 0.0, vc: 0.0 },
                throughput: 1.0,
                found: 0.0,
            },
        };
        stage.go_on(&lane, &ray);
    }

    /// A light subpath meets a surface.
    pub(super) fn light_vertex<'s>(&self, stage: &mut SubpathStage<'_, 's>, vertex: &Vertex<'_, State>) {
        let Some(si) = vertex.surface else { return };
        if !self.allows(stage.depth + 1) {
            return;
        }
        let Some(partial) = self.arrive(stage, vertex, si) else {
            return;
        };
        let event = self.event(stage, vertex, si, partial);
        let goes_on = self.allows(stage.depth + 2);
        if !event.bsdf.is_delta() {
            self.connect_to_lens(stage, &event);
            if self.strategies == Strategies::All && goes_on {
                let vertex = LightVertex {
                    p: si.p,
                    error: si.error,
                    ng: si.ng,
                    wo: si.wo,
                    bsdf: event.bsdf,
                    bend: bend(si.ng, &event.bsdf, si.wo),
                    beta: event.lane.beta,
                    partial,
                };
                stage.memory.push(event.lane.slot, stage.depth, si, vertex);
            }
        }
        if goes_on {
            self.scatter(stage, &event, 0.0);
        }
    }

    /// t = 1.
    fn connect_to_lens(&self, stage: &mut SubpathStage<'_, '_>, event: &Event<'_, '_>) {
        let Event { lane, si, bsdf, .. } = event;
        let (view, slot) = (stage.view, lane.slot);
        let domain = view.domain();
        let Some(lens) = view.camera.sample_wi(si.p, si.time, event.numbers.light, &domain) else {
            return;
        };
        let Some((value, reverse)) = bsdf.eval_both_ways(si.wo, lens.wi, TransportMode::Importance) else {
            return;
        };
        let f = value.f * (value.cos_theta * self.adjoint_correction(si, bsdf, lens.wi) * lens.weight());
        if f.is_black() {
            return;
        }
        let weight = match self.strategies {
            Strategies::LightTracer => 1.0,
            Strategies::All => {
                let arrival = f64::from(lens.ray.arrival.0) * f64::from(si.ng.dot(lens.wi).abs());
                let density = arrival / Self::light_paths(view);
                Exponent::weight(self.exponent().sum(event.partial, density, f64::from(reverse.0)), 0.0)
            }
        };
        let in_full = lane.beta * f;
        let value = in_full * (weight as f32);
        let ray = si.spawn_ray_to(lens.end, 0.0, Vec3::ZERO);
        let film = lens.ray.film;
        let note = match &mut stage.memory.record {
            Some(record) => record.note_splat(slot, stage.depth + 2, value, in_full, film),
            None => NO_NOTE,
        };
        stage.splat_unless_occluded(
            &ray,
            SplatContribution {
                slot,
                note,
                film,
                value,
            },
        );
    }
}

/// How the first vertex of a light subpath came about, where light samples choose lights by the light sampler of `path`. `None` if the
/// light does not shine there: what comes through a portal does not light what is in front of it.
pub(super) fn light_start(
    scene: &Scene,
    start: &LightRay,
    si: &SurfaceInteraction,
    ray: &Ray,
    lambda: &Wavelengths,
) -> Option<LightStart> {
    let pmf = scene.light_sampler().pmf(si.p, si.ns, start.light);
    let density = match (scene.light(start.light), start.origin) {
        _ if start.has_delta_position => f64::from(si.p.distance_squared(ray.origin)),
        (light, _) if light.is_along_normals() => 0.0,
        (Light::Area(light), EmissionOrigin::Surface { p, ng, .. }) => {
            f64::from(light.pdf_li(si.p, p, ng, ray.time).0) * f64::from(start.cos_theta)
        }
        (Light::Environment(light), _) => {
            if light.le(si.p, -ray.direction, ray.time, lambda).is_black() {
                return None;
            }
            f64::from(light.pdf_li(si.p, -ray.direction, ray.time).0)
        }
        _ => 1.0,
    };
    Some(LightStart {
        direct: f64::from(pmf) * density,
        emission: start.emission,
        cos_light: f64::from(start.cos_theta),
        is_delta: start.is_delta,
    })
}
