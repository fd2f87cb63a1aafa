//! Passes: photons first, then the camera paths of some samples, all at the wavelengths and the time of the pass.

use std::time::Instant;

use super::eye::Eye;
use super::gather::{GatherPass, Maps, Strata};
use super::guide::EmissionGuide;
use super::irradiance::IrradianceMap;
use super::kernel::Kernel;
use super::limits::LimitedProgress;
use super::map::{Gathering, PhotonMap};
use super::progressive::{ProgressivePass, Radius, shrinkage};
use super::shoot::{PhotonNumbers, Shot, Stand, Until, learn_caustics, moment_of, shoot};
use super::tracer::{Keep, PhotonTracer};
use super::{PhotonCount, PhotonIntegrator, SppmIntegrator};
use crate::desc::Terms;
use crate::integrator::RenderStats;
use crate::integrator::schedule::{Progress, render_tiles};
use crate::integrator::stage::Moment;
use crate::light::Light;
use crate::material::Material;
use crate::scene::{Scene, View};

/// Photons stored in the caustic map, if nobody says how many.
const CAUSTIC_PHOTONS: u32 = 200_000;
/// Photons stored in the global map, if nobody says how many.
const GLOBAL_PHOTONS: u32 = 50_000;
/// How far away photons may be, of the scene's radius, if nobody says.
const MAX_DISTANCE: f32 = 0.02;
/// Of the photons of a progressive pass, those that are aimed at what makes caustics: they land close together, the others all over the scene.
const CAUSTIC_SHARE: f64 = 0.3;

/// A render in passes.
struct Render<'a> {
    stand: Stand<'a>,
    max_depth: Option<u32>,
    guide: Option<EmissionGuide>,
    stats: RenderStats,
}

impl<'a> Render<'a> {
    /// `caustic` photons of a pass are aimed, of `passes` passes.
    fn new(stand: Stand<'a>, max_depth: Option<u32>, caustic: u32, passes: u32) -> Self {
        let mut stats = RenderStats::default();
        let photons = u64::from(caustic) * u64::from(passes);
        let scene = stand.scene;
        let may_have_caustics = !scene.materials().iter().all(Material::is_never_specular)
            || scene.lights().iter().any(Light::is_along_normals);
        let has_caustics = photons > 0 && may_have_caustics;
        Self {
            guide: has_caustics
                .then(|| learn_caustics(stand, max_depth, photons, &mut stats))
                .flatten(),
            stand,
            max_depth,
            stats,
        }
    }

    /// The map of a pass; caustic photons are aimed, and there are none without anything to aim at.
    fn map(&mut self, keep: Keep, pass: u32, moment: Moment, until: Until) -> PhotonMap {
        let guide = match keep {
            Keep::Caustic if self.guide.is_none() => return PhotonMap::default(),
            Keep::Caustic => self.guide.as_ref(),
            Keep::All | Keep::Indirect => None,
        };
        let tracer = PhotonTracer {
            keep,
            max_depth: self.max_depth,
            guide,
        };
        let numbers = PhotonNumbers::new(self.stand.view.sampler.seed(), keep, pass);
        let shot: Shot = shoot(self.stand, &tracer, numbers, moment, until, &mut self.stats);
        let counted = match keep {
            Keep::Caustic => &mut self.stats.caustic_photons,
            Keep::All | Keep::Indirect => &mut self.stats.global_photons,
        };
        *counted += PhotonCount {
            emitted: shot.emitted,
            stored: shot.photons.len() as u64,
        };
        PhotonMap::new(&shot)
    }
}

/// The passes that have samples of a view, and which, where a pass has so many of each pixel.
fn passes(view: &View, samples: u32) -> impl Iterator<Item = (u32, std::ops::Range<u32>)> {
    let wanted = view.samples.clone();
    (wanted.start / samples..wanted.end.div_ceil(samples)).map(move |pass| {
        let first = pass * samples;
        (pass, first.max(wanted.start)..(first + samples).min(wanted.end))
    })
}

impl PhotonIntegrator {
    /// Renders all passes.
    pub(in crate::integrator) fn render(&self, stand: Stand<'_>, progress: &dyn Progress) -> RenderStats {
        let Stand { scene, view, film } = stand;
        let parameters = &self.parameters;
        let samples = self.samples_per_pass(scene, view);
        // As many photons in all, however many passes they are spread over.
        let share = f64::from(parameters.passes) * f64::from(samples) / f64::from(view.sampler.samples_per_pixel());
        let count = |wanted: Option<u32>, automatic: u32| {
            let all = f64::from(wanted.unwrap_or(automatic));
            (all * share.min(1.0)).ceil() as u32
        };
        let (mut caustic, mut global) = (
            count(parameters.caustic_photons, CAUSTIC_PHOTONS),
            count(parameters.global_photons, GLOBAL_PHOTONS),
        );
        let mut terms = parameters.terms;
        if self.shown.is_some() {
            terms = Terms::NONE;
        } else {
            // Only maps that are asked; indirect light asks both.
            if !terms.indirect {
                global = 0;
            }
            if !(terms.indirect || terms.caustic) {
                caustic = 0;
            }
        }
        terms.indirect &= global > 0;
        let max_distance = parameters
            .max_distance
            .unwrap_or(MAX_DISTANCE * scene.bounds().radius());
        let gathering = Gathering {
            count: parameters.used as usize,
            max_distance,
            kernel: Kernel::new(parameters.filter),
        };
        let mut render = Render::new(
            stand,
            self.max_depth,
            caustic,
            view.sampler.samples_per_pixel().div_ceil(samples),
        );
        for (pass, samples) in passes(view, samples) {
            let moment = moment_of(view.sampler.seed(), pass);
            let maps = Maps::new(
                render.map(Keep::Caustic, pass, moment, Until::Stored(caustic)),
                render.map(Keep::All, pass, moment, Until::Stored(global)),
                &gathering,
                self.max_depth,
            );
            let estimator = GatherPass {
                eye: Eye {
                    max_depth: self.max_depth,
                    terms,
                },
                shown: self.shown,
                moment,
                maps: &maps,
                gathering,
                directions: Strata::new(parameters.final_gather_samples),
            };
            let of_pass = render_tiles(scene, view, film, &estimator, samples, progress);
            render.stats.merge(of_pass);
        }
        render.stats
    }

    /// The samples of a pixel in a pass: one only where anything moves, or each pass would be a ghost of its own.
    fn samples_per_pass(&self, scene: &Scene, view: &View) -> u32 {
        if scene.moves() || !view.camera.is_static() {
            return 1;
        }
        view.sampler.samples_per_pixel().div_ceil(self.parameters.passes)
    }
}

impl Maps {
    fn new(caustic: PhotonMap, global: PhotonMap, gathering: &Gathering, max_depth: Option<u32>) -> Self {
        // Mostly one event goes before the one where photons are gathered.
        let irradiance_depth = max_depth.map_or(u32::MAX, |max_depth| max_depth.saturating_sub(2));
        Self {
            irradiance: IrradianceMap::new(&global, gathering, irradiance_depth),
            caustic,
            global,
            irradiance_depth,
        }
    }
}

impl SppmIntegrator {
    /// Renders all passes, one for each sample of a pixel.
    pub(in crate::integrator) fn render(&self, stand: Stand<'_>, progress: &dyn Progress) -> RenderStats {
        let start = Instant::now();
        let Stand { scene, view, film } = stand;
        let parameters = &self.parameters;
        let [width, height] = view.resolution;
        let photons = parameters.photons.unwrap_or_else(|| width.saturating_mul(height));
        let aimed = (f64::from(photons) * CAUSTIC_SHARE) as u32;
        let mut render = Render::new(stand, self.max_depth, aimed, view.sampler.samples_per_pixel());
        let caustic = if render.guide.is_some() { aimed } else { 0 };
        let progress = &LimitedProgress {
            progress,
            start,
            time: self.limits.time,
        };
        for (pass, samples) in passes(view, 1) {
            let moment = moment_of(view.sampler.seed(), pass);
            let estimator = ProgressivePass {
                eye: Eye {
                    max_depth: self.max_depth,
                    terms: parameters.terms,
                },
                moment,
                caustic: &render.map(Keep::Caustic, pass, moment, Until::Emitted(caustic)),
                indirect: &render.map(Keep::Indirect, pass, moment, Until::Emitted(photons - caustic)),
                kernel: Kernel::new(parameters.filter),
                radius: Radius {
                    first: parameters.radius,
                    shrinkage: shrinkage(pass),
                    most: MAX_DISTANCE * scene.bounds().radius(),
                },
            };
            let of_pass = render_tiles(scene, view, film, &estimator, samples, progress);
            render.stats.merge(of_pass);
            let done = pass + 1 - view.samples.start;
            if self.limits.are_reached(start, film, done) {
                render.stats.stopped_after = Some(done);
                break;
            }
        }
        render.stats
    }
}
