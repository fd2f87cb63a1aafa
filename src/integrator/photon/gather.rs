//! Camera paths of the two-pass renderer: caustics from their map, indirect light by final gathering over the global map.

use std::f32::consts::FRAC_1_PI;

use super::ShownMap;
use super::carried::Carried;
use super::eye::{Event, Eye, EyeState, Phase, Way};
use super::irradiance::{IrradianceMap, PHOTONS_PER_RECORD};
use super::kd_tree::Nearest;
use super::map::{Gathering, PhotonMap, Receiver};
use crate::desc::Term;
use crate::geometry::Ray;
use crate::integrator::lane::Lane;
use crate::integrator::numbers::EventNumbers;
use crate::integrator::stage::{Estimator, Moment, Stage, Vertex};
use crate::material::{Density, TransportMode};
use crate::math::Vec2;
use crate::scene::View;
use crate::spectrum::SampledSpectrum;

/// The camera's side of a pass.
pub(super) struct GatherPass<'m> {
    pub eye: Eye,
    /// Only the irradiance of this map is shown, where camera paths first meet a surface that is not specular.
    pub shown: Option<ShownMap>,
    pub moment: Moment,
    pub maps: &'m Maps,
    pub gathering: Gathering,
    /// Directions of a final gather.
    pub directions: Strata,
}

/// The maps of a pass.
#[derive(Debug, Default)]
pub(super) struct Maps {
    pub caustic: PhotonMap,
    pub global: PhotonMap,
    pub irradiance: IrradianceMap,
    /// Scattering events before photons of `irradiance` arrived, at most.
    pub irradiance_depth: u32,
}

/// A grid of `columns` x `rows` cells of the unit square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Strata {
    columns: u32,
    rows: u32,
}

impl Strata {
    /// So many cells, as nearly square as can be.
    pub fn new(count: u32) -> Self {
        let most = f64::from(count).sqrt() as u32;
        let rows = (1..=most.max(1))
            .rev()
            .find(|rows| count.is_multiple_of(*rows))
            .unwrap_or(1);
        Self {
            columns: count / rows,
            rows,
        }
    }

    pub fn count(self) -> u32 {
        self.columns * self.rows
    }

    /// The point `u` of cell `index`.
    fn place(self, index: u32, u: Vec2) -> Vec2 {
        let cell = Vec2::new((index % self.columns) as f32, (index / self.columns) as f32);
        let size = Vec2::new(self.columns as f32, self.rows as f32);
        ((cell + u) / size).min(Vec2::splat(1.0_f32.next_down()))
    }
}

/// A gather ray shorter than this many times the reach of an estimate of the global map meets a corner, which that estimate would
/// blur: light is then looked for from there as it was from where the ray came.
const CORNER: f32 = 2.0;

impl Estimator for GatherPass<'_> {
    type State = EyeState;
    type Memory<'s> = Nearest;

    fn moment(&self) -> Option<Moment> {
        Some(self.moment)
    }

    fn camera_state(&self, _view: &View, _ray: &Ray) -> EyeState {
        EyeState::new()
    }

    fn shade<'s>(&self, stage: &mut Stage<'_, 's, Self>, vertex: Vertex<'_, EyeState>) {
        let Some(event) = self.eye.arrive(stage, &vertex) else {
            return;
        };
        let (lane, numbers) = (vertex.lane, &vertex.numbers());
        if event.bsdf.is_specular() {
            self.eye.pass_specular(stage, &event, (lane, numbers));
            return;
        }
        if let Some(shown) = self.shown {
            self.show(stage, &event, lane, shown);
            return;
        }
        match lane.state.phase {
            Phase::Eye => self.first_diffuse(stage, &event, (lane, numbers)),
            Phase::Gather | Phase::GatherBySpecular => self.gathered(stage, &event, (lane, numbers), vertex.ray),
        }
    }
}

impl GatherPass<'_> {
    /// The first surface that is not specular: direct light, caustics, and directions to gather from.
    fn first_diffuse(&self, stage: &mut Stage<'_, '_, Self>, event: &Event<'_, '_>, way: Way<'_>) {
        let (lane, _) = way;
        let term = lane.state.term;
        // With nothing to gather the directions serve the direct light only.
        let directions = if term == Term::Indirect || !self.eye.terms.indirect {
            1
        } else {
            self.directions.count()
        };
        self.eye.sample_light(stage, event, way, term, directions);
        let caustic = if term == Term::Indirect { term } else { Term::Caustic };
        if self.eye.terms.has(caustic) {
            let receiver = Receiver::new(event.si, stage.depth, self.eye.max_depth);
            let found = &mut *stage.memory;
            let radiance =
                (self.maps.caustic).nearest_radiance(event.si, &event.bsdf, &receiver, &self.gathering, found);
            add(stage, event, lane, &radiance, SampledSpectrum::ONE);
        }
        if directions == 1 {
            self.send(stage, event, way, 1);
            return;
        }
        for direction in 0..directions {
            let stream = lane.stream.branch(direction);
            let mut numbers = EventNumbers::draw(&stream, stage.depth);
            numbers.bsdf = self.directions.place(direction, numbers.bsdf);
            let lane = Lane { stream, ..*lane };
            self.send(stage, event, (&lane, &numbers), directions);
        }
    }

    /// The irradiance of a map on the side that is seen.
    fn show(&self, stage: &mut Stage<'_, '_, Self>, event: &Event<'_, '_>, lane: &Lane<EyeState>, shown: ShownMap) {
        let map = match shown {
            ShownMap::Caustic => &self.maps.caustic,
            ShownMap::Global => &self.maps.global,
        };
        let si = event.si;
        let mut receiver = Receiver::new(si, stage.depth, self.eye.max_depth);
        receiver.ng = if si.ng.dot(si.wo) < 0.0 { -si.ng } else { si.ng };
        let irradiance = map.nearest_irradiance(&receiver, &self.gathering, stage.memory);
        add(stage, event, lane, &irradiance, SampledSpectrum::ONE);
    }

    /// Sends one of the directions of a final gather.
    fn send(&self, stage: &mut Stage<'_, '_, Self>, event: &Event<'_, '_>, way: Way<'_>, directions: u32) {
        let (lane, numbers) = way;
        let mode = TransportMode::Radiance;
        let Some(sample) = event.bsdf.sample_f(event.si.wo, numbers.lobe, numbers.bsdf, mode) else {
            return;
        };
        match sample.density {
            Density::Continuous(_) => self.eye.gather(stage, event, lane, &sample, directions),
            // A mirror that is a part of the surface.
            Density::Delta(_) => self.eye.follow_specular(stage, event, way, &sample, directions),
        }
    }

    /// The irradiance on the side of the normal, and how far away the photons are that it comes from. Where no point near by has
    /// it worked out, photons are asked without those that such points are made of: that there is none of these is no chance.
    fn irradiance(&self, receiver: &Receiver, found: &mut Nearest) -> (Carried, f32) {
        let Maps { global, irradiance, .. } = self.maps;
        let max_distance = self.gathering.max_distance;
        if let Some(known) = irradiance.at(receiver.p, receiver.ng, receiver.error, max_distance, found) {
            return (known.irradiance, known.reach);
        }
        let irradiance = global.nearest_irradiance_of_others(receiver, PHOTONS_PER_RECORD, &self.gathering, found);
        (irradiance, found.radius_squared().sqrt())
    }

    /// What a gather ray met.
    fn gathered(&self, stage: &mut Stage<'_, '_, Self>, event: &Event<'_, '_>, way: Way<'_>, ray: &Ray) {
        if !self.eye.terms.indirect {
            return;
        }
        let (Event { si, bsdf, .. }, (lane, numbers)) = (event, way);
        let found = &mut *stage.memory;
        let receiver = Receiver::new(si, stage.depth, self.eye.max_depth);
        let (radiance, factor, reach) = match bsdf.lambertian_reflectance() {
            Some(reflectance) if receiver.max_depth == self.maps.irradiance_depth => {
                let ng = if si.ng.dot(si.wo) < 0.0 { -si.ng } else { si.ng };
                let (irradiance, reach) = self.irradiance(&Receiver { ng, ..receiver }, found);
                (irradiance, reflectance * FRAC_1_PI, reach)
            }
            _ => {
                let radiance = (self.maps.global).nearest_radiance(si, bsdf, &receiver, &self.gathering, found);
                (radiance, SampledSpectrum::ONE, found.radius_squared().sqrt())
            }
        };
        let is_in_corner = si.p.distance(ray.origin) < CORNER * reach;
        if is_in_corner && lane.state.phase == Phase::Gather {
            let state = EyeState {
                phase: Phase::Eye,
                term: Term::Indirect,
                ..lane.state
            };
            let lane = Lane { state, ..*lane };
            self.first_diffuse(stage, event, (&lane, numbers));
            return;
        }
        add(stage, event, lane, &radiance, factor);
        if bsdf.has_delta()
            && let Some(sample) = bsdf.sample_f(si.wo, numbers.lobe, numbers.bsdf, TransportMode::Radiance)
            && matches!(sample.density, Density::Delta(_))
        {
            self.eye.follow_specular(stage, event, way, &sample, 1);
        }
    }
}

/// Adds what photons send along a path.
pub(super) fn add<E: Estimator<State = EyeState>>(
    stage: &mut Stage<'_, '_, E>,
    event: &Event<'_, '_>,
    lane: &Lane<EyeState>,
    radiance: &Carried,
    factor: SampledSpectrum,
) {
    stage.add(lane, radiance.seen(lane.beta * factor, event.hero_only));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strata_are_nearly_square_and_cover_all() {
        let size = |count| {
            let strata = Strata::new(count);
            assert_eq!(strata.count(), count);
            [strata.columns, strata.rows]
        };
        assert_eq!([size(1), size(32), size(36), size(7)], [[1, 1], [8, 4], [6, 6], [7, 1]]);
        let strata = Strata::new(32);
        assert_eq!(strata.place(0, Vec2::ZERO), Vec2::ZERO);
        assert_eq!(strata.place(9, Vec2::splat(0.5)), Vec2::new(1.5 / 8.0, 1.5 / 4.0));
        assert!(strata.place(31, Vec2::splat(1.0_f32.next_down())).max_element() < 1.0);
    }
}
