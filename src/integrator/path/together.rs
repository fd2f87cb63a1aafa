//! The commonest scattering events, of eight paths at once: by Lambertian surfaces and by conductors. Paths that leave a scene without
//! an environment end here too, and those that come to their last event where nothing emits.
//! The bits are those of [`PathIntegrator::scatter`], which takes the other paths.

mod lobes;
mod scatter;
mod send;

use std::marker::PhantomData;

use super::{FIRST_ROULETTE_DEPTH, PathIntegrator, PathStage};
use crate::desc::{Heuristic, Strategy};
use crate::geometry::Hit;
use crate::integrator::direct::{DirectLight, Origin};
use crate::integrator::fault::Fault;
use crate::integrator::lane::Slot;
use crate::integrator::numbers::OneLobeLanes;
use crate::integrator::queue::Packet;
use crate::integrator::stage::PacketVertices;
use crate::light::{ChosenLight, LightLanes, SampledLight};
use crate::math::{LANES, LaneSet, Lanes, VectorLanes, Vectorizer};
use crate::scene::Scene;
use lobes::{Kind, KindLanes, Lambertian, Lobes, Mirror, RoughConductor};
use scatter::Scatter;

/// What eight paths are computed with. Made once and used again and again.
#[derive(Debug, Default)]
pub(in crate::integrator) struct Together {
    vectorizer: Vectorizer,
    lights: LightLanes,
    paths: Paths,
}

/// The paths, at the surfaces that they have come to.
#[derive(Debug, Default)]
struct Paths {
    kinds: KindLanes,
    /// Of the light that each samples; 1 without.
    pmf: Lanes,
}

/// Which lanes are at surfaces of each kind.
#[derive(Clone, Copy, Debug)]
struct Taken([LaneSet; Kind::COUNT]);

impl Default for Taken {
    fn default() -> Self {
        Self([LaneSet::NONE; Kind::COUNT])
    }
}

impl Taken {
    #[inline(always)]
    fn add(&mut self, kind: Kind, lanes: LaneSet) {
        // In registers: a set that is stored at a place which is not known beforehand is waited for.
        for (i, taken) in self.0.iter_mut().enumerate() {
            let more = if i == kind as usize { lanes } else { LaneSet::NONE };
            *taken = taken.or(more);
        }
    }

    #[inline]
    fn of(self, kind: Kind) -> LaneSet {
        self.0[kind as usize]
    }

    #[inline]
    fn all(self) -> LaneSet {
        self.0.into_iter().fold(LaneSet::NONE, LaneSet::or)
    }
}

impl PathIntegrator {
    /// Takes the paths of `packet` to their next events that are such as above, or into the dark, and says which those are.
    #[inline]
    pub(super) fn scatter_together(
        &self,
        stage: &mut PathStage<'_, '_>,
        packet: &PacketVertices<'_, Origin>,
    ) -> LaneSet {
        // Of a path that has been split the order of what it brings would depend on the packets that its parts are in.
        let is_usual = self.strategy == Strategy::Mis && self.splitting == 1 && self.fault == Fault::None;
        if !is_usual {
            return LaneSet::NONE;
        }
        let scene = stage.scene;
        let hit = packet.active.and(packet.hits.hit_lanes());
        let left = if scene.has_environment() {
            LaneSet::NONE
        } else {
            packet.active.without(hit)
        };
        if self.max_depth == Some(stage.depth) {
            return left.or(in_the_dark(scene, packet, hit));
        }
        let Together { lights, paths, .. } = &mut *stage.memory;
        let taken = paths.gather(&self.direct_light(), scene, stage.slots, packet, hit);
        let all = taken.all();
        if all.is_empty() {
            return left;
        }
        let only_light = scene.light_sampler().only();
        let may_end = stage.depth >= FIRST_ROULETTE_DEPTH;
        let has_others = !hit.without(all).is_empty();
        let drawn;
        let numbers = &OneLobeLanes::of(if has_others {
            // They are likely to ask for all numbers.
            packet.numbers.all()
        } else {
            drawn = packet.numbers.of_one_lobe(only_light.is_none(), may_end);
            &drawn
        });
        let looking = all.without(taken.of(Kind::Mirror));
        if !looking.is_empty() {
            paths.sample_lights(lights, scene, stage.slots, packet, looking, numbers);
        }
        self.send::<Lambertian>(stage, packet, numbers, taken.of(Kind::Lambertian));
        self.send::<RoughConductor<false>>(stage, packet, numbers, taken.of(Kind::Ggx));
        self.send::<RoughConductor<true>>(stage, packet, numbers, taken.of(Kind::Beckmann));
        self.send::<Mirror>(stage, packet, numbers, taken.of(Kind::Mirror));
        all.or(left)
    }

    /// Sends the chosen lanes, which are at surfaces with such lobes, on their ways.
    #[inline]
    fn send<L: Lobes>(
        &self,
        stage: &mut PathStage<'_, '_>,
        packet: &PacketVertices<'_, Origin>,
        numbers: &OneLobeLanes<'_>,
        chosen: LaneSet,
    ) {
        if chosen.is_empty() {
            return;
        }
        let Together {
            vectorizer,
            lights,
            paths,
        } = &*stage.memory;
        let scattered = vectorizer.run(Scatter::<L> {
            rays: packet.rays,
            lanes: packet.lanes,
            surfaces: packet.surfaces.all(),
            numbers,
            paths,
            lights: lights.samples(),
            is_power: self.heuristic == Heuristic::Power,
            depth: stage.depth,
            is_unlimited: self.max_depth.is_none(),
            lobes: PhantomData,
        });
        scattered.send(stage, packet, chosen);
    }
}

/// Which of `hit` have nothing more to bring after their last scattering event, as nothing emits where they are.
fn in_the_dark(scene: &Scene, packet: &PacketVertices<'_, Origin>, hit: LaneSet) -> LaneSet {
    let mut dark = [false; LANES];
    for i in hit.lanes() {
        let is_dark = |hit: Hit| scene.light_of(hit.geometry, hit.primitive).is_none();
        dark[i] = packet.hits.get(i).is_some_and(is_dark);
    }
    dark.into()
}

impl Paths {
    /// Takes up the paths of `packet` that have `hit` surfaces of some kind, and adds what these emit; says which kinds.
    #[inline]
    fn gather(
        &mut self,
        direct_light: &DirectLight,
        scene: &Scene,
        slots: &mut [Slot],
        packet: &PacketVertices<'_, Origin>,
        hit: LaneSet,
    ) -> Taken {
        let mut taken = Taken::default();
        let mut known = LaneSet::NONE;
        for i in 0..LANES {
            if let Some(albedo) = scene.known_albedo(packet.hits.geometry[i]) {
                self.kinds.set_lambertian(i, albedo);
                known = known.or(LaneSet::of(i));
            }
        }
        let known = known.and(hit);
        taken.add(Kind::Lambertian, known);
        for i in hit.without(known).lanes() {
            if let Some(kind) = self.look_up(direct_light, scene, slots, packet, i) {
                taken.add(kind, LaneSet::of(i));
            }
        }
        taken
    }

    /// The same of one path, at a surface of which nothing is known beforehand.
    #[inline]
    fn look_up(
        &mut self,
        direct_light: &DirectLight,
        scene: &Scene,
        slots: &mut [Slot],
        packet: &PacketVertices<'_, Origin>,
        i: usize,
    ) -> Option<Kind> {
        let hit = packet.hits.get(i)?;
        let slot = &mut slots[packet.lanes.slot[i] as usize];
        let surface = || packet.surface(i, hit);
        let kind = self.kinds.set(i, scene.material(hit.geometry), surface, &slot.lambda)?;
        if scene.light_of(hit.geometry, hit.primitive).is_some() {
            let lane = packet.lanes.get(i);
            if let Some(le) = direct_light.emission(scene, &lane.state, &surface(), &slot.lambda) {
                slot.l += lane.beta * le;
            }
        }
        Some(kind)
    }

    /// Finds a point of a light for each of the paths `looking`.
    #[inline]
    fn sample_lights(
        &mut self,
        lights: &mut LightLanes,
        scene: &Scene,
        slots: &[Slot],
        packet: &PacketVertices<'_, Origin>,
        looking: LaneSet,
        numbers: &OneLobeLanes<'_>,
    ) {
        let surfaces = packet.surfaces.all();
        if let Some(SampledLight { light, pmf }) = scene.light_sampler().only()
            && lights.sample_one(light, scene.light(light), &surfaces.p, numbers.light)
        {
            self.pmf = [pmf; LANES];
            return;
        }
        let mut chosen: [Option<ChosenLight<'_>>; LANES] = [None; LANES];
        for i in looking.lanes() {
            let (p, n) = (surfaces.p.get(i), surfaces.ns.get(i));
            let light = scene.light_sampler().sample(p, n, numbers.which_light[i]);
            self.pmf[i] = light.map_or(1.0, |light| light.pmf);
            let lambda = &slots[packet.lanes.slot[i] as usize].lambda;
            chosen[i] = light.map(|light| (light.light, scene.light(light.light), lambda));
        }
        lights.sample(&chosen, &surfaces.p, &packet.rays.time, numbers.light);
    }
}
