//! What a finished render says about itself.

use serde::Serialize;

use crate::integrator::RenderStats;

/// The statistics of one render, as `--stats` and `--json` write them.
#[derive(Clone, Debug, Serialize)]
pub struct Statistics {
    /// The scene file.
    pub scene: String,
    /// Name of the view.
    pub camera: String,
    /// The image file.
    pub output: String,
    /// Pixels of the whole picture.
    pub resolution: [u32; 2],
    /// `x0, y0, x1, y1` of the pixels rendered.
    pub crop: [u32; 4],
    /// Its name on the command line.
    pub integrator: &'static str,
    /// `spectral` or `rgb`.
    pub color: &'static str,
    /// Its name on the command line.
    pub backend: String,
    /// Version of the Embree library, or of Lucerna.
    pub backend_version: String,
    /// Threads that rendered.
    pub threads: usize,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Samples a pixel.
    pub spp: u32,
    /// From the start of loading the scene (for a later camera of a scene: of its own render) to the image on the disk.
    pub wall_seconds: f64,
    /// Reading and understanding the scene file.
    pub load_seconds: f64,
    /// Building the backend's structures.
    pub build_seconds: f64,
    /// Rendering alone.
    pub render_seconds: f64,
    /// Thread time inside the backend's queries.
    pub backend_thread_seconds: f64,
    /// Rays from the camera.
    pub camera_rays: u64,
    /// Rays towards lights.
    pub shadow_rays: u64,
    /// All rays.
    pub rays: u64,
    /// All rays over the render's seconds.
    pub rays_per_second: f64,
    /// Most memory that the process had so far; 0 where the system does not tell.
    pub peak_memory_bytes: u64,
    /// Where the time went, if that was asked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub profile: Option<Profile>,
    /// What the integrator's photons did, if it has any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub photons: Option<Photons>,
    /// The renders from one side alone, if strategies were asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub one_sided: Vec<OneSided>,
    /// Samples that counted as black because they were not finite or negative.
    pub dropped_samples: u64,
}

/// Where the time of a render went. Thread seconds are those of all threads together.
#[derive(Clone, Debug, Serialize)]
pub struct Profile {
    /// Wall-clock seconds: reading the scene.
    pub load_seconds: f64,
    /// Wall-clock seconds: building the backend.
    pub build_seconds: f64,
    /// Wall-clock seconds: rendering.
    pub render_seconds: f64,
    /// Of the render, what threads did.
    pub thread_seconds: Vec<StageShare>,
    /// For the same rays, what the fastest way of any backend would need.
    pub fastest: Vec<Fastest>,
    /// The thread seconds of the render over those that the fastest ways would need; 0 if there are none.
    pub render_over_fastest: f64,
}

/// What threads did.
#[derive(Clone, Debug, Serialize)]
pub struct StageShare {
    /// `trace camera`, `trace bounce`, `trace photon`, `trace shadow`, `sample`, `shade`, `film` or `other`.
    pub stage: &'static str,
    /// How long, all threads together.
    pub seconds: f64,
    /// The part of all that they did.
    pub share: f64,
    /// Rays, of a stage that traces them.
    pub rays: u64,
}

/// The fastest way to trace the rays of one kind.
#[derive(Clone, Debug, Serialize)]
pub struct Fastest {
    /// `camera`, `bounce`, `photon` or `shadow`.
    pub kind: &'static str,
    /// Who traces them, and how.
    pub way: String,
    /// Millions of rays a second, all threads together.
    pub mrays: f64,
    /// Thread seconds for the rays of the render.
    pub seconds: f64,
}

/// A render of what paths from one side alone find.
#[derive(Clone, Debug, Serialize)]
pub struct OneSided {
    /// Its layer: `eye-only` or `light-only`.
    pub layer: &'static str,
    /// Its name on the command line.
    pub integrator: &'static str,
    /// Rendering alone.
    pub render_seconds: f64,
    /// All rays.
    pub rays: u64,
    /// Samples that counted as black because they were not finite or negative.
    pub dropped_samples: u64,
}

impl OneSided {
    /// That of a layer.
    pub fn of(layer: &'static str, integrator: &'static str, stats: &RenderStats) -> Self {
        Self {
            layer,
            integrator,
            render_seconds: stats.render_time.as_secs_f64(),
            rays: stats.rays(),
            dropped_samples: stats.dropped_samples,
        }
    }
}

/// Photons of all passes.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Photons {
    /// Emitted for the caustic map.
    pub caustic_emitted: u64,
    /// Kept there.
    pub caustic_stored: u64,
    /// Emitted for the global map.
    pub global_emitted: u64,
    /// Kept there.
    pub global_stored: u64,
}

impl Photons {
    /// Those of a render; `None` if there were none.
    pub fn of(stats: &RenderStats) -> Option<Self> {
        let (caustic, global) = (stats.caustic_photons, stats.global_photons);
        (caustic.emitted + global.emitted > 0).then_some(Self {
            caustic_emitted: caustic.emitted,
            caustic_stored: caustic.stored,
            global_emitted: global.emitted,
            global_stored: global.stored,
        })
    }
}

/// Most resident memory that this process had so far; 0 where the system does not tell.
pub fn peak_memory_bytes() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = line.and_then(|rest| rest.trim().trim_end_matches("kB").trim().parse::<u64>().ok());
    kilobytes.unwrap_or(0) * 1024
}
