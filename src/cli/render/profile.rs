//! `--profile`: where a render's time went, and what the fastest backend would need for the same rays.

use std::fmt;
use std::sync::Arc;
use std::time::Duration;

use super::Job;
use super::prepare::Prepared;
use crate::accel::{Accel, Backend, BuildOptions};
use crate::bench::contenders::{BuildPlan, Built, Choice, Family, quality_name};
use crate::bench::streams::{Stream, StreamKind};
use crate::bench::{rates, recorded};
use crate::cli::stats::{Fastest, Profile, StageShare};
use crate::error::Result;
use crate::geometry::World;
use crate::integrator::{Integrator, RenderStats};
use crate::scene::{Scene, SceneOptions, View, ViewOverrides};

/// Rays of each kind that are recorded and traced again, about.
const RAYS: usize = 1 << 16;
/// How often.
const TURNS: usize = 3;
/// Rays of each kind by which the ways that are worth that are found, and how many of them are.
const FEW_RAYS: usize = 1 << 12;
const BEST: usize = 4;

/// A kind of ray as the statistics know it, with the streams that are of it.
type Kind = (&'static str, fn(StreamKind) -> bool);

const KINDS: [Kind; 4] = [
    ("camera", |kind| kind == StreamKind::Camera),
    ("bounce", |kind| matches!(kind, StreamKind::Bounce(_))),
    ("photon", |kind| kind == StreamKind::Photon),
    ("shadow", |kind| kind == StreamKind::Shadow),
];

impl Job<'_> {
    /// The profile of a render.
    pub(super) fn profile(
        &self,
        prepared: &Prepared,
        view: &View,
        integrator: &Integrator,
        stats: &RenderStats,
    ) -> Result<Profile> {
        let threads = self.pool.current_num_threads();
        let all = stats.render_time.as_secs_f64() * threads as f64;
        let rays = [
            stats.camera_rays,
            stats.bounce_rays,
            stats.photon_rays,
            stats.shadow_rays,
        ];
        let streams = self.record(prepared, view, integrator)?;
        let options = self.options();
        let fastest = self
            .pool
            .install(|| fastest(prepared.scene.world(), &options, &streams, rays))?;
        let needed: f64 = fastest.iter().map(|fastest| fastest.seconds).sum();
        Ok(Profile {
            load_seconds: prepared.load_seconds,
            build_seconds: prepared.scene.build_seconds(),
            render_seconds: stats.render_time.as_secs_f64(),
            thread_seconds: stages(stats, all),
            render_over_fastest: if needed > 0.0 { all / needed } else { 0.0 },
            fastest,
        })
    }

    fn options(&self) -> BuildOptions {
        BuildOptions {
            quality: self.args.build_quality.into(),
            robust: !self.args.not_robust,
            compact: self.args.compact,
            threads: self.pool.current_num_threads(),
        }
    }

    /// The rays of a short render like the one that was.
    fn record(&self, prepared: &Prepared, view: &View, integrator: &Integrator) -> Result<Vec<Stream>> {
        let desc = &prepared.desc;
        let options = SceneOptions {
            backend: Some(Backend::default()),
            build: self.options(),
            color: self.args.color.into(),
        };
        let multiple = integrator.samples_multiple();
        let overrides = ViewOverrides {
            spp_multiple: multiple,
            resolution: Some(view.resolution),
            spp: Some(multiple),
            seed: self.args.seed,
            ..ViewOverrides::default()
        };
        let Some(described) = desc.views.iter().find(|described| described.name == view.name) else {
            return Ok(Vec::new());
        };
        let short = View::build(desc, described, self.args.color.into(), &overrides)?;
        self.pool.install(|| {
            let scene = Scene::build(desc, &options)?;
            Ok(recorded::record(scene, &short, integrator, RAYS).1)
        })
    }
}

/// The fastest way for the rays of each kind, of those that builds of the render's quality have.
fn fastest(world: &Arc<World>, options: &BuildOptions, streams: &[Stream], rays: [u64; 4]) -> Result<Vec<Fastest>> {
    let choice = Choice {
        all: true,
        only: vec![quality_name(options.quality).to_owned()],
    };
    let threads = options.threads;
    // Compact scenes are there for their memory.
    let plans = BuildPlan::all()
        .into_iter()
        .filter(|plan| plan.family != Family::EmbreeCompact && plan.is_wanted(&choice));
    let built = plans.map(|plan| plan.build(world, &choice, threads));
    let built = built.collect::<Result<Vec<Built>>>()?;
    let ways: Vec<_> = built
        .iter()
        .flat_map(|built| {
            built
                .contenders
                .iter()
                .map(move |(way, accel)| (built.plan.name(), way, &**accel))
        })
        .collect();
    let accels: Vec<_> = ways.iter().map(|(_, _, accel)| *accel).collect();
    let mut all = Vec::new();
    for ((name, is_of_kind), count) in KINDS.into_iter().zip(rays) {
        let streams: Vec<&Stream> = streams.iter().filter(|stream| is_of_kind(stream.kind)).collect();
        if streams.is_empty() || count == 0 {
            continue;
        }
        let few: Vec<Stream> = streams.iter().map(|stream| stream.thinned(FEW_RAYS)).collect();
        let mut ranked: Vec<_> = seconds(&accels, &few, 1).into_iter().zip(0..).collect();
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        ranked.truncate(BEST);
        let best: Vec<_> = ranked.iter().map(|&(_, i): &(f64, usize)| accels[i]).collect();
        let seconds_of_best = seconds(&best, streams.iter().copied(), TURNS);
        let least = seconds_of_best.iter().zip(&ranked).min_by(|a, b| a.0.total_cmp(b.0));
        let Some((least, &(_, place))) = least else { continue };
        let (build, way, _) = &ways[place];
        let mrays = streams.iter().map(|stream| stream.rays()).sum::<usize>() as f64 * 1e-6 / least;
        all.push(Fastest {
            kind: name,
            way: format!("{build}, {way}"),
            mrays,
            seconds: count as f64 * 1e-6 / mrays * threads as f64,
        });
    }
    Ok(all)
}

/// Seconds that each of `accels` needs for the rays of `streams`.
fn seconds<'s>(accels: &[&dyn Accel], streams: impl IntoIterator<Item = &'s Stream>, turns: usize) -> Vec<f64> {
    let mut seconds = vec![0.0; accels.len()];
    for stream in streams {
        let millions = stream.rays() as f64 * 1e-6;
        for (seconds, rate) in seconds.iter_mut().zip(rates::measure(accels, stream, turns)) {
            *seconds += millions / rate.median;
        }
    }
    seconds
}

/// What the threads did in `all` seconds of theirs.
fn stages(stats: &RenderStats, all: f64) -> Vec<StageShare> {
    let times = &stats.times;
    let stage = |stage, time: Duration, rays| StageShare {
        stage,
        seconds: time.as_secs_f64(),
        share: time.as_secs_f64() / all.max(1e-9),
        rays,
    };
    let other = Duration::from_secs_f64((all - times.all().as_secs_f64()).max(0.0));
    let mut stages = vec![
        stage("trace camera", times.camera, stats.camera_rays),
        stage("trace bounce", times.bounce, stats.bounce_rays),
        stage("trace photon", times.photon, stats.photon_rays),
        stage("trace shadow", times.shadow, stats.shadow_rays),
    ];
    stages.retain(|stage| stage.rays > 0);
    stages.extend([
        stage("sample", times.sample, 0),
        stage("shade", times.shade, 0),
        stage("film", times.film, 0),
        stage("other", other, 0),
    ]);
    stages
}

impl fmt::Display for Profile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "  load {:.3} s, build {:.3} s, render {:.3} s; thread seconds of the render:",
            self.load_seconds, self.build_seconds, self.render_seconds
        )?;
        for stage in &self.thread_seconds {
            write!(
                f,
                "    {:14}{:9.3} s {:5.1} %",
                stage.stage,
                stage.seconds,
                100.0 * stage.share
            )?;
            if stage.rays > 0 {
                write!(f, "  {:9.2} million rays", stage.rays as f64 * 1e-6)?;
            }
            writeln!(f)?;
        }
        writeln!(f, "  the fastest way for the same rays:")?;
        for fastest in &self.fastest {
            writeln!(
                f,
                "    {:14}{:9.3} s  {:9.2} million rays a second by {}",
                fastest.kind, fastest.seconds, fastest.mrays, fastest.way
            )?;
        }
        write!(f, "  the render took {:.2} times as long", self.render_over_fastest)
    }
}
