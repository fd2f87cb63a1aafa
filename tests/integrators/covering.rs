//! `path` and `bdpt`, in all their ways, against the oracle: every pair of materials, lights, ways, backends, colour modes, samplers,
//! light samplers, lenses and motions; in the full tier every three of them.

use std::collections::BTreeMap;

use lucerna::accel::Backend;
use lucerna::desc::{Distribution, Heuristic, Strategy, Termination};
use lucerna::integrator::{Integrator, KajiyaIntegrator};
use lucerna::scene::ViewOverrides;
use lucerna::spectrum::ColorMode;

use crate::common::covering::Covering;
use crate::common::means::{Estimate, FEWEST_RUNS, Means, MeansReport};
use crate::common::render::{Built, MODES, blocks, parse};
use crate::common::{full_tier, in_shard, sidak};
use crate::lamps::LAMPS;
use crate::surfaces::SURFACES;

const ORACLE: KajiyaIntegrator = KajiyaIntegrator {
    max_depth: Some(3),
    termination: Termination::Constant(0.1),
    branching: 1,
    distribution: Distribution::Bsdf,
};

/// Surfaces of a scene.
const GROUP: usize = 3;
/// Pixels that a ball and its surroundings have.
const SQUARE: [usize; 2] = [8, 8];
/// Ways of `path`, then those of `bdpt`; the last in the full tier only.
const ALL_WAYS: &[&str] = &[
    "mis",
    "balance",
    "split",
    "bsdf",
    "split bsdf",
    "light",
    "bdpt power",
    "bdpt balance",
];
const WAYS: &[&str] = ALL_WAYS.split_last().expect("there are some").1;
const SAMPLERS: [&str; 5] = ["zsobol", "sobol", "halton", "stratified", "independent"];
const LIGHT_SAMPLERS: [&str; 3] = ["bvh", "power", "uniform"];
const LENSES: [&str; 2] = ["", r#""float lensradius" 0.15 "float focaldistance" 4.5"#];
/// Surfaces that scatter by delta lobes.
const SMOOTH: [&str; 5] = ["glass", "mirror", "thin glass", "smooth coat", "glass that disperses"];
/// Where things are when the shutter closes.
const MOTIONS: [&str; 2] = [
    "",
    "ActiveTransform EndTime Translate 0.2 0.1 0.1 Rotate 5 0 1 0 ActiveTransform All",
];

// Where a row has the level of each factor. What is seen depends on the first five only.
const SURFACE: usize = 0;
const LAMP: usize = 1;
const COLOR: usize = 2;
const LENS: usize = 3;
const MOTION: usize = 4;
const WAY: usize = 5;
const SAMPLER: usize = 6;
const LIGHT_SAMPLER: usize = 7;
const BACKEND: usize = 8;

fn levels(ways: &[&str]) -> [usize; 9] {
    [
        SURFACES.len() / GROUP,
        LAMPS.len(),
        MODES.len(),
        LENSES.len(),
        MOTIONS.len(),
        ways.len(),
        SAMPLERS.len(),
        LIGHT_SAMPLERS.len(),
        Backend::AVAILABLE.len(),
    ]
}

/// The rows in which all combinations of `strength` levels occur.
fn rows(ways: &[&str], strength: usize) -> Vec<Vec<usize>> {
    // Lights that directions do not meet are not looked for by directions alone; what a mirror throws of them onto other surfaces only
    // light subpaths find, not the oracle.
    let allowed = |row: &[Option<usize>]| {
        let finds_by_directions = row[WAY].is_some_and(|way| ways[way].contains("bsdf"));
        let finds_caustics = row[WAY].is_some_and(|way| ways[way].contains("bdpt"))
            && row[SURFACE].is_some_and(|group| {
                SURFACES[GROUP * group..][..GROUP]
                    .iter()
                    .any(|s| SMOOTH.contains(&s.name))
            });
        !((finds_by_directions || finds_caustics) && row[LAMP].is_some_and(|lamp| LAMPS[lamp].is_delta))
    };
    let covering = Covering {
        levels: &levels(ways),
        strength,
        allowed: &allowed,
    };
    let rows = covering.rows();
    println!(
        "{} rows; at least {} if none were excluded",
        rows.len(),
        covering.fewest()
    );
    assert!(covering.missing(&rows).is_empty());
    rows
}

fn describe(row: &[usize], ways: &[&str]) -> String {
    let surfaces = &SURFACES[GROUP * row[SURFACE]..][..GROUP];
    let names: Vec<&str> = surfaces.iter().map(|surface| surface.name).collect();
    format!(
        "{} under {}, {:?}, {}, {}, {}, {}, {}, {}",
        names.join(" + "),
        LAMPS[row[LAMP]].name,
        MODES[row[COLOR]],
        ["pinhole", "lens"][row[LENS]],
        ["still", "moving"][row[MOTION]],
        ways[row[WAY]],
        SAMPLERS[row[SAMPLER]],
        LIGHT_SAMPLERS[row[LIGHT_SAMPLER]],
        Backend::AVAILABLE[row[BACKEND]],
    )
}

/// Balls in a row on a floor: each is seen in one square of 8 x 8 pixels.
fn scene(row: &[usize]) -> String {
    let motion = MOTIONS[row[MOTION]];
    let surfaces = &SURFACES[GROUP * row[SURFACE]..][..GROUP];
    let textures = surfaces.iter().map(|surface| surface.textures).collect::<Vec<_>>();
    let balls = surfaces.iter().zip(-1..).map(|(surface, column)| {
        let x = 2.2 * f64::from(column);
        let (material, shape) = (surface.material, surface.shape);
        format!(
            "AttributeBegin {motion} Translate {x} 0.9 0 Rotate 60 1 0.5 0.2 {material}\n\
             Shape \"sphere\" \"float radius\" 0.9 {shape} AttributeEnd\n"
        )
    });
    format!(
        r#"LookAt 0 1.6 -5.5  0 0.8 0  0 1 0
        Camera "perspective" "float fov" 23 {lens}
        Film "rgb" "integer xresolution" 24 "integer yresolution" 8
        PixelFilter "box"
        Sampler "{sampler}"
        Integrator "path" "integer maxdepth" 3 "string lightsampler" "{light_sampler}"
        WorldBegin
        {lamp}
        AttributeBegin
            Material "diffuse" "rgb reflectance" [0.5 0.55 0.6]
            Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-9 0 -5  -9 0 9  9 0 9  9 0 -5]
        AttributeEnd
        {textures}
        {balls}"#,
        lens = LENSES[row[LENS]],
        sampler = SAMPLERS[row[SAMPLER]],
        light_sampler = LIGHT_SAMPLERS[row[LIGHT_SAMPLER]],
        lamp = LAMPS[row[LAMP]].text(motion),
        textures = textures.join("\n"),
        balls = balls.collect::<String>(),
    )
}

fn build(row: &[usize]) -> Built {
    Built::new(parse(&scene(row)), Backend::AVAILABLE[row[BACKEND]], MODES[row[COLOR]])
}

/// The integrator of a way, for scenes of the path tracer.
fn integrator(way: &str, built: &Built) -> Integrator {
    let of_scene = Integrator::from_desc(&built.desc.integrator);
    let Integrator::Path(mut path) = of_scene else {
        panic!("not a path tracer");
    };
    if let Integrator::Bdpt(mut bdpt) = of_scene.named(way.split(' ').next().unwrap_or(way)) {
        bdpt.heuristic = match way {
            "bdpt balance" => Heuristic::Balance,
            _ => Heuristic::Power,
        };
        return Integrator::Bdpt(bdpt);
    }
    match way {
        "balance" => path.heuristic = Heuristic::Balance,
        "split" => path.splitting = 3,
        "bsdf" => path.strategy = Strategy::Bsdf,
        "split bsdf" => {
            path.strategy = Strategy::Bsdf;
            path.splitting = 2;
        }
        "light" => path.strategy = Strategy::Light,
        _ => {}
    }
    Integrator::Path(path)
}

/// The power that each comparison has: what error of one channel of one ball, and of the whole, it notices.
fn power() -> (f64, f64) {
    if full_tier() { (0.05, 0.01) } else { (0.1, 0.02) }
}

/// Samples a pixel of the first renders: textures are filtered alike from here on.
const FIRST: u32 = 64;
/// At most.
const LAST: u32 = 1 << 15;

/// 16 pictures, the means of their squares, each of as many renders as it takes.
struct Pictures {
    built: Built,
    integrator: Integrator,
    runs: Vec<Vec<f64>>,
    spp: u32,
    seed: u64,
}

impl Pictures {
    /// Of a scene, with seeds from `seed` on.
    fn new(row: &[usize], integrator: impl FnOnce(&Built) -> Integrator, seed: u64) -> Self {
        let built = build(row);
        let mut pictures = Self {
            integrator: integrator(&built),
            built,
            runs: Vec::new(),
            spp: FIRST,
            seed,
        };
        pictures.runs = pictures.render();
        pictures
    }

    fn render(&mut self) -> Vec<Vec<f64>> {
        let first = self.seed;
        self.seed += FEWEST_RUNS as u64;
        (first..self.seed).map(|seed| self.picture(seed)).collect()
    }

    fn picture(&self, seed: u64) -> Vec<f64> {
        let overrides = ViewOverrides {
            seed,
            spp: Some(self.spp),
            ..ViewOverrides::default()
        };
        let view = self.built.view(0, &overrides);
        let (picture, stats) = self.built.picture_with(&view, self.integrator);
        assert_eq!(stats.dropped_samples, 0, "dropped: {:?}", stats.dropped);
        // Saturated light of one wavelength is out of sRGB.
        let is_rgb = self.built.scene.color() == ColorMode::Rgb;
        assert!(picture.iter().all(|v| v.is_finite() && (*v >= 0.0 || !is_rgb)));
        blocks(&picture, view.resolution[0] as usize, SQUARE)
    }

    /// Renders as much again.
    fn double(&mut self) {
        let more = self.render();
        for (value, more) in self.runs.iter_mut().flatten().zip(more.into_iter().flatten()) {
            *value = 0.5 * (*value + more);
        }
        self.spp *= 2;
    }

    /// The sum of the relative variances of the squares.
    fn noise(&self) -> f64 {
        let noise = |block: usize| {
            let estimate = Estimate::of(self.runs.iter().map(|run| run[block]));
            estimate.variance / estimate.mean.powi(2)
        };
        (0..self.runs[0].len()).map(noise).sum()
    }
}

/// Compares an integrator with the oracle, both with as many samples as the power needs. When to stop is decided by variances alone.
fn compare(means: Means, ours: &mut Pictures, oracle: &mut Pictures) -> MeansReport {
    loop {
        let report = means.against_runs(&ours.runs, &oracle.runs);
        let is_enough = report.detectable.0 <= power().0 && report.detectable.1 <= power().1;
        let noisier = if ours.noise() > oracle.noise() {
            &mut *ours
        } else {
            &mut *oracle
        };
        if is_enough || noisier.spp >= LAST {
            return report;
        }
        noisier.double();
    }
}

#[test]
fn three_way_rows_cover() {
    rows(ALL_WAYS, 3);
}

#[test]
fn every_pair_or_three_agree_with_the_oracle() {
    let (ways, strength) = if full_tier() { (ALL_WAYS, 3) } else { (WAYS, 2) };
    let rows = rows(ways, strength);
    let means = Means {
        significance: sidak(0.01, rows.len()),
        ..Means::default()
    };
    // Rows of which the same is seen share the oracle's pictures.
    let mut scenes: BTreeMap<&[usize], Vec<&[usize]>> = BTreeMap::new();
    for row in &rows {
        scenes.entry(&row[..WAY]).or_default().push(row);
    }
    let mut wrong = Vec::new();
    for (_, rows) in scenes.values().enumerate().filter(|(i, _)| in_shard(*i)) {
        let mut oracle = Pictures::new(rows[0], |_| Integrator::Kajiya(ORACLE), 1_000_001);
        for row in rows {
            let mut ours = Pictures::new(row, |built| integrator(ways[row[WAY]], built), 1);
            let report = compare(means, &mut ours, &mut oracle);
            let name = format!("{} ({} and {} samples)", describe(row, ways), ours.spp, oracle.spp);
            println!("{name}: {report}");
            report.assert_power(&name, power().0, power().1);
            if !report.agrees() {
                wrong.push(format!("{name}: {report}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
