//! Camera paths of progressive photon mapping: photons within a radius that shrinks from pass to pass.

use super::eye::{Event, Eye, EyeState, Phase};
use super::gather::add;
use super::kernel::Kernel;
use super::map::{PhotonMap, Receiver};
use crate::desc::Term;
use crate::geometry::Ray;
use crate::integrator::stage::{Estimator, Moment, Stage, Vertex};
use crate::material::{Density, TransportMode};
use crate::scene::View;
use crate::spectrum::SampledSpectrum;

/// The camera's side of a pass.
pub(super) struct ProgressivePass<'m> {
    pub eye: Eye,
    pub moment: Moment,
    /// Photons that come from specular surfaces only.
    pub caustic: &'m PhotonMap,
    /// All others, but those straight from lights.
    pub indirect: &'m PhotonMap,
    pub kernel: Kernel,
    pub radius: Radius,
}

/// How far photons of a pass may be from where they are looked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Radius {
    /// Of the first pass, in scene units; `None`: in proportion to what a pixel sees.
    pub first: Option<f32>,
    /// What this pass's is of the first one's.
    pub shrinkage: f32,
    /// For caustics not more than this by default, in scene units.
    pub most: f32,
}

/// Widths of a pixel that the first radius is by default, for caustics.
const PIXELS: f32 = 3.0;
/// What it is for indirect light, of that for caustics: that light is smooth, and its photons are spread over the whole scene. On
/// scenes/jensen-box.pbrt its noise was nearly all of the error; 1.5 and 2 do equally well there at 128 x 128 pixels.
const INDIRECT: f32 = 2.0;
/// How much of the photons' density each pass gives to lower variance; the rest lowers bias (Hachisuka and Jensen 2009; Knaus and
/// Zwicker 2011 show that variance and bias then vanish, and that for 2/3 both do so at the same rate).
const ALPHA: f64 = 2.0 / 3.0;

/// The radius of pass `pass`, counted from 0, over that of the first: r²(i + 1) / r²(i) = (i + alpha) / (i + 1), where passes are counted
/// from 1 (Knaus and Zwicker 2011, equation 10). A function of the pass alone, so that passes do not depend on each other.
pub(super) fn shrinkage(pass: u32) -> f32 {
    let square: f64 = (1..=pass).map(f64::from).map(|i| (i + ALPHA) / (i + 1.0)).product();
    square.sqrt() as f32
}

impl Estimator for ProgressivePass<'_> {
    type State = EyeState;
    type Memory<'s> = ();

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
        let way = (vertex.lane, &vertex.numbers());
        match vertex.lane.state.phase {
            Phase::Eye if event.bsdf.is_specular() => self.eye.pass_specular(stage, &event, way),
            Phase::Eye => self.first_diffuse(stage, &event, &vertex),
            // Only light that it might have met was looked for.
            Phase::Gather | Phase::GatherBySpecular => {}
        }
    }
}

impl ProgressivePass<'_> {
    /// The first surface that is not specular: all light that arrives there.
    fn first_diffuse(&self, stage: &mut Stage<'_, '_, Self>, event: &Event<'_, '_>, vertex: &Vertex<'_, EyeState>) {
        let (si, bsdf) = (event.si, &event.bsdf);
        let (lane, numbers) = (vertex.lane, &vertex.numbers());
        self.eye.sample_light(stage, event, (lane, numbers), lane.state.term, 1);
        let receiver = Receiver::new(si, stage.depth, self.eye.max_depth);
        let footprint = si.footprint / stage.view.detail_scale();
        for (map, term) in [(self.caustic, Term::Caustic), (self.indirect, Term::Indirect)] {
            if self.eye.terms.has(term) {
                let radius = self.radius.at(footprint, term);
                let radiance = map.radiance_within(si, bsdf, &receiver, radius, &self.kernel);
                add(stage, event, lane, &radiance, SampledSpectrum::ONE);
            }
        }
        let Some(sample) = bsdf.sample_f(si.wo, numbers.lobe, numbers.bsdf, TransportMode::Radiance) else {
            return;
        };
        match sample.density {
            Density::Continuous(_) => self.eye.gather(stage, event, lane, &sample, 1),
            // A mirror that is a part of the surface.
            Density::Delta(_) => self.eye.follow_specular(stage, event, (lane, numbers), &sample, 1),
        }
    }
}

impl Radius {
    /// Where a pixel sees `footprint`, in scene units, for photons of `term`.
    fn at(&self, footprint: f32, term: Term) -> f32 {
        let wider = if term == Term::Indirect { INDIRECT } else { 1.0 };
        match self.first {
            Some(first) => first * self.shrinkage,
            None => wider * (PIXELS * footprint * self.shrinkage).min(self.most),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_radius_that_is_asked_for_is_used() {
        let radius = |first| Radius {
            first,
            shrinkage: 0.5,
            most: 0.1,
        };
        for term in [Term::Caustic, Term::Indirect] {
            assert_eq!(radius(Some(3.0)).at(0.01, term), 1.5);
        }
        assert_eq!(radius(None).at(0.01, Term::Caustic), 0.015);
        assert_eq!(radius(None).at(0.01, Term::Indirect), 0.03);
        assert_eq!(radius(None).at(7.0, Term::Caustic), 0.1);
        assert_eq!(radius(None).at(7.0, Term::Indirect), 0.2);
    }

    #[test]
    fn areas_shrink_as_the_passes_to_the_power_of_a_third() {
        assert_eq!(shrinkage(0), 1.0);
        assert!((shrinkage(1).powi(2) - (1.0 + 2.0 / 3.0) / 2.0).abs() < 1e-6);
        // r² ~ i^(alpha - 1).
        let ratio = f64::from(shrinkage(8000).powi(2) / shrinkage(1000).powi(2));
        assert!((ratio - 8.0_f64.powf(ALPHA - 1.0)).abs() < 1e-3, "{ratio}");
    }
}
