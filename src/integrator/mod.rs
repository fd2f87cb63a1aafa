//! Estimators of the rendering equation.
//!
//! An integrator never traces one ray. It advances a wave (`wave.rs`): the paths of one tile go through the same stage together,
//! and the rays of a stage reach the backend as packets.
//!
//! Which random numbers serve what, by group of a [`SampleStream`](crate::sampling::SampleStream):
//!
//! | group | numbers |
//! |---|---|
//! | 0 | film x, film y, lens, lens |
//! | 1 | wavelength, time |
//! | 2 + 2 d | light point, light point, which light, Russian roulette, at scattering event d |
//! | 3 + 2 d | BSDF direction, BSDF direction, which lobe, which connections (bdpt) or how far through media (path), at scattering event d |
//!
//! A photon has a stream of its own, by pass and kind of photon, with the groups of a light path; the wavelengths and the time of a pass are the
//! same for all its photons and camera paths. A direction of a final gather has a branch of its sample's numbers.
//!
//! A light path has a [branch](crate::sampling::SampleStream::branch) of its sample's numbers, with the same groups at scattering events:
//! where it is connected to the lens, the light point is one of the lens. Groups 0 and 1 there: position on the light, which light;
//! direction from it.

mod adjoint;
mod bdpt;
mod direct;
mod emission;
mod fault;
mod kajiya;
mod lane;
mod numbers;
mod occlusion;
mod path;
mod photon;
mod queue;
mod schedule;
mod shadow;
mod stage;
mod times;
mod volume;
mod wave;

use std::time::{Duration, Instant};

pub use bdpt::{BdptIntegrator, Pyramid, Strategies, StrategyLayer};
#[doc(hidden)]
pub use fault::Fault;
pub use kajiya::KajiyaIntegrator;
pub use occlusion::OcclusionIntegrator;
pub use path::PathIntegrator;
#[doc(hidden)]
pub use photon::{KdTree, Nearest};
pub use photon::{Limits, PhotonCount, PhotonIntegrator, ShownMap, SppmIntegrator};
pub use schedule::{Progress, Silent};
pub use times::StageTimes;

use crate::desc::{
    Heuristic, IntegratorDesc, IntegratorKind, KajiyaDesc, LightSamplerKind, OcclusionDesc, PathDesc, PhotonDesc,
    SppmDesc, Strategy, Terms,
};
use crate::film::Film;
use crate::light::Light;
use crate::material::Material;
use crate::scene::{Scene, View};
use photon::Stand;
use volume::VolumePath;

/// The integrators there are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integrator {
    /// Unidirectional path tracing.
    Path(PathIntegrator),
    /// The rendering equation taken literally.
    Kajiya(KajiyaIntegrator),
    /// Bidirectional path tracing, or light tracing.
    Bdpt(BdptIntegrator),
    /// Photon mapping in two passes.
    Photon(PhotonIntegrator),
    /// Progressive photon mapping.
    Sppm(SppmIntegrator),
    /// Ambient occlusion.
    Occlusion(OcclusionIntegrator),
}

impl Integrator {
    /// The names by which a scene or a command line chooses one.
    pub const NAMES: &[&str] = &[
        "path",
        "kajiya",
        "bdpt",
        "lightpath",
        "photon",
        "sppm",
        "ambientocclusion",
    ];

    /// The one that a scene asks for.
    pub fn from_desc(desc: &IntegratorDesc) -> Self {
        let max_depth = desc.max_depth;
        match desc.kind {
            IntegratorKind::Path(PathDesc {
                strategy,
                heuristic,
                splitting,
            }) => Self::Path(PathIntegrator {
                max_depth,
                strategy,
                heuristic,
                splitting,
                fault: Fault::None,
            }),
            IntegratorKind::Kajiya(KajiyaDesc {
                termination,
                branching,
                distribution,
            }) => Self::Kajiya(KajiyaIntegrator {
                max_depth,
                termination,
                branching,
                distribution,
            }),
            IntegratorKind::Bdpt(heuristic) => Self::Bdpt(BdptIntegrator {
                max_depth,
                heuristic,
                strategies: Strategies::All,
                fault: Fault::None,
            }),
            IntegratorKind::LightTracer => Self::Bdpt(BdptIntegrator {
                max_depth,
                heuristic: Heuristic::default(),
                strategies: Strategies::LightTracer,
                fault: Fault::None,
            }),
            IntegratorKind::Photon(parameters) => Self::Photon(PhotonIntegrator {
                max_depth,
                parameters,
                shown: None,
            }),
            IntegratorKind::Occlusion(OcclusionDesc { cosine, max_distance }) => Self::Occlusion(OcclusionIntegrator {
                cosine,
                max_distance: max_distance.unwrap_or(f32::INFINITY),
            }),
            IntegratorKind::Sppm(parameters) => Self::Sppm(SppmIntegrator {
                max_depth,
                parameters,
                limits: Limits::default(),
            }),
        }
    }

    /// The integrator `name`, one of [`Integrator::NAMES`], with its default parameters and this one's depth; this one if that is
    /// its name.
    #[must_use]
    pub fn named(self, name: &str) -> Self {
        let kind = match name {
            _ if name == self.name() => return self,
            "kajiya" => IntegratorKind::Kajiya(KajiyaDesc::default()),
            "bdpt" => IntegratorKind::Bdpt(Heuristic::default()),
            "lightpath" => IntegratorKind::LightTracer,
            "photon" => IntegratorKind::Photon(PhotonDesc::default()),
            "sppm" => IntegratorKind::Sppm(SppmDesc::default()),
            "ambientocclusion" => IntegratorKind::Occlusion(OcclusionDesc::default()),
            _ => IntegratorKind::Path(PathDesc::default()),
        };
        let max_depth = match self {
            Self::Path(PathIntegrator { max_depth, .. })
            | Self::Kajiya(KajiyaIntegrator { max_depth, .. })
            | Self::Bdpt(BdptIntegrator { max_depth, .. })
            | Self::Photon(PhotonIntegrator { max_depth, .. })
            | Self::Sppm(SppmIntegrator { max_depth, .. }) => max_depth,
            Self::Occlusion(_) => IntegratorDesc::default().max_depth,
        };
        Self::from_desc(&IntegratorDesc {
            max_depth,
            light_sampler: LightSamplerKind::default(),
            kind,
        })
    }

    /// Its name.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Path(_) => "path",
            Self::Kajiya(_) => "kajiya",
            Self::Bdpt(bdpt) => match bdpt.strategies {
                Strategies::All => "bdpt",
                Strategies::LightTracer => "lightpath",
            },
            Self::Photon(_) => "photon",
            Self::Sppm(_) => "sppm",
            Self::Occlusion(_) => "ambientocclusion",
        }
    }

    /// The same integrator for paths of at most `max_depth` scattering events; `None` for any number.
    #[must_use]
    pub fn with_max_depth(mut self, max_depth: Option<u32>) -> Self {
        match &mut self {
            Self::Path(path) => path.max_depth = max_depth,
            Self::Kajiya(kajiya) => kajiya.max_depth = max_depth,
            Self::Bdpt(bdpt) => bdpt.max_depth = max_depth,
            Self::Photon(photon) => photon.max_depth = max_depth,
            Self::Sppm(sppm) => sppm.max_depth = max_depth,
            Self::Occlusion(_) => {}
        }
        self
    }

    /// The same integrator, looking for light by `strategy`. `None` if it knows no other way than its own.
    #[must_use]
    pub fn with_strategy(self, strategy: Strategy) -> Option<Self> {
        match self {
            Self::Path(path) => Some(Self::Path(PathIntegrator { strategy, ..path })),
            Self::Kajiya(_) | Self::Bdpt(_) | Self::Photon(_) | Self::Sppm(_) | Self::Occlusion(_) => None,
        }
    }

    /// The same integrator, showing these parts of the light only. `None` if it does not take light apart.
    #[must_use]
    pub fn with_terms(mut self, terms: Terms) -> Option<Self> {
        match &mut self {
            Self::Photon(photon) => photon.parameters.terms = terms,
            Self::Sppm(sppm) => sppm.parameters.terms = terms,
            Self::Path(_) | Self::Kajiya(_) | Self::Bdpt(_) | Self::Occlusion(_) => return None,
        }
        Some(self)
    }

    /// The same integrator, showing nothing but a photon map. `None` if it has none of that kind.
    #[must_use]
    pub fn with_shown(self, map: ShownMap) -> Option<Self> {
        match self {
            Self::Photon(photon) => Some(Self::Photon(PhotonIntegrator {
                shown: Some(map),
                ..photon
            })),
            Self::Path(_) | Self::Kajiya(_) | Self::Bdpt(_) | Self::Sppm(_) | Self::Occlusion(_) => None,
        }
    }

    /// The same integrator, which may end early. `None` if it does not work in passes that make the picture better and better.
    #[must_use]
    pub fn with_limits(self, limits: Limits) -> Option<Self> {
        match self {
            Self::Sppm(sppm) => Some(Self::Sppm(SppmIntegrator { limits, ..sppm })),
            Self::Path(_) | Self::Kajiya(_) | Self::Bdpt(_) | Self::Photon(_) | Self::Occlusion(_) => None,
        }
    }

    /// What the number of samples of a pixel is a multiple of.
    pub fn samples_multiple(&self) -> u32 {
        match self {
            Self::Photon(photon) => photon.parameters.passes,
            Self::Path(_) | Self::Kajiya(_) | Self::Bdpt(_) | Self::Sppm(_) | Self::Occlusion(_) => 1,
        }
    }

    /// Light of `scene` that it cannot find, and which integrators can, for people; `None` if it finds all.
    pub fn blind_spot(&self, scene: &Scene) -> Option<String> {
        let from_eye = matches!(self, Self::Path(_) | Self::Kajiya(_));
        if from_eye && scene.lights().iter().any(Light::is_along_normals) {
            return Some(format!(
                "`{}` cannot find light that leaves a surface along its normals only: `bdpt`, `lightpath`, `photon` and `sppm` do",
                self.name()
            ));
        }
        let lights = scene.lights().iter().filter(|light| light.is_delta()).count();
        if lights == 0 || !scene.materials().iter().any(Material::may_have_delta) {
            return None;
        }
        let (missed, found_by) = match self {
            Self::Path(_) | Self::Kajiya(_) => (
                "that comes by way of mirrors or clear glass",
                "`sppm` and `photon` find it, and `bdpt` where it is not seen by way of such surfaces again",
            ),
            Self::Bdpt(_) => (
                "that comes by way of mirrors or clear glass and is seen by way of such surfaces",
                "`sppm` and `photon` find it",
            ),
            Self::Photon(_) | Self::Sppm(_) | Self::Occlusion(_) => return None,
        };
        let whose = if lights == 1 { "a light" } else { "lights" };
        Some(format!(
            "`{}` cannot find the light of {whose} without extent {missed}: {found_by}",
            self.name()
        ))
    }

    /// Whether it shows light.
    pub fn needs_lights(&self) -> bool {
        !matches!(self, Self::Occlusion(_))
    }

    /// Whether it connects light paths to the camera.
    pub fn splats(&self) -> bool {
        matches!(self, Self::Bdpt(_))
    }

    /// What of `scene` it cannot render at all, for people; `None` if there is nothing.
    pub fn missing(&self, scene: &Scene) -> Option<String> {
        let can = matches!(self, Self::Path(_));
        (scene.has_media() && !can).then(|| {
            let name = self.name();
            format!("`{name}` does not render participating media: use the integrator `path`")
        })
    }

    /// An empty film for what it does with `view`.
    pub fn film(&self, view: &View) -> Film {
        match self {
            Self::Sppm(sppm) if sppm.limits.noise.is_some() => view.film().with_squares(),
            Self::Path(_) | Self::Kajiya(_) | Self::Photon(_) | Self::Sppm(_) | Self::Occlusion(_) => view.film(),
            Self::Bdpt(_) => view.film().with_splats(),
        }
    }

    /// The same with a layer for each strategy (s, t) of `pyramid`. `None` if it has no strategies of that kind.
    pub fn film_of_strategies(&self, view: &View, pyramid: Pyramid) -> Option<Film> {
        match self {
            Self::Bdpt(bdpt) => bdpt.film_of_strategies(view, pyramid),
            Self::Path(_) | Self::Kajiya(_) | Self::Photon(_) | Self::Sppm(_) | Self::Occlusion(_) => None,
        }
    }

    /// Renders all samples of `view` onto `film`, one of [`Integrator::film`] or [`Integrator::film_of_strategies`], on the threads of the rayon pool that calls. The image
    /// does not depend on how many those are.
    pub fn render(&self, scene: &Scene, view: &View, film: &Film, progress: &dyn Progress) -> RenderStats {
        let start = Instant::now();
        let samples = view.samples.clone();
        let mut stats = match self {
            Self::Path(path) if scene.has_media() => {
                schedule::render_tiles(scene, view, film, &VolumePath(*path), samples, progress)
            }
            Self::Path(path) => schedule::render_tiles(scene, view, film, path, samples, progress),
            Self::Kajiya(kajiya) => schedule::render_tiles(scene, view, film, kajiya, samples, progress),
            Self::Bdpt(bdpt) => schedule::render_tiles(scene, view, film, bdpt, samples, progress),
            Self::Photon(photon) => photon.render(Stand { scene, view, film }, progress),
            Self::Sppm(sppm) => sppm.render(Stand { scene, view, film }, progress),
            Self::Occlusion(occlusion) => schedule::render_tiles(scene, view, film, occlusion, samples, progress),
        };
        stats.render_time = start.elapsed();
        stats
    }
}

/// What a render did.
#[derive(Clone, Debug, Default)]
pub struct RenderStats {
    /// Wall-clock time of the render.
    pub render_time: Duration,
    /// Where the threads' time went.
    pub times: StageTimes,
    /// Rays from the camera.
    pub camera_rays: u64,
    /// Rays scattered by surfaces, on the way from the camera.
    pub bounce_rays: u64,
    /// Rays on the way from lights.
    pub photon_rays: u64,
    /// Rays towards lights.
    pub shadow_rays: u64,
    /// Scattering events, and ends of paths, that were taken together, by packets.
    pub events_together: u64,
    /// The samples of each pixel that were rendered, if fewer than were planned.
    pub stopped_after: Option<u32>,
    /// Photons of caustic maps.
    pub caustic_photons: PhotonCount,
    /// Photons of global maps.
    pub global_photons: PhotonCount,
    /// Samples that counted as black because they were not finite or negative.
    pub dropped_samples: u64,
    /// The first few of them, by pixel and sample.
    pub dropped: Vec<DroppedSample>,
}

/// A sample that was dropped. With the seed it can be rendered again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct DroppedSample {
    /// Column and row of the pixel.
    pub pixel: [u32; 2],
    /// Index of the sample.
    pub sample: u32,
}

/// How many dropped samples are kept by name.
const DROPPED_KEPT: usize = 16;

impl RenderStats {
    /// All rays.
    pub fn rays(&self) -> u64 {
        self.camera_rays + self.bounce_rays + self.photon_rays + self.shadow_rays
    }

    /// Adds what another thread did.
    fn merge(&mut self, other: Self) {
        self.times += other.times;
        self.camera_rays += other.camera_rays;
        self.bounce_rays += other.bounce_rays;
        self.photon_rays += other.photon_rays;
        self.shadow_rays += other.shadow_rays;
        self.events_together += other.events_together;
        self.caustic_photons += other.caustic_photons;
        self.global_photons += other.global_photons;
        self.dropped_samples += other.dropped_samples;
        self.dropped.extend(other.dropped);
        self.dropped.sort_unstable();
        self.dropped.truncate(DROPPED_KEPT);
    }

    fn drop_sample(&mut self, sample: DroppedSample) {
        self.dropped_samples += 1;
        if self.dropped.len() < DROPPED_KEPT {
            self.dropped.push(sample);
        }
    }
}
