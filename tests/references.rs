//! Pictures of known scenes against other programs', by the rule of `../shared/reference/README.md`: blocks of 4 x 4 pixels, our
//! 16 renders' own variance, the reference's stated one.
//!
//! The rule asks that ours be as precise as the reference or half a percent, for smallpt the work of half an hour. So the tiers
//! differ: one scene is conclusive in the normal tier, all are in the full one; the normal tier applies all other clauses to the
//! rest, where the mean over the image alone tells errors of half a percent.
//!
//! The scenes and references are not part of this repository; without them these tests are skipped, except in CI.

mod common;

use std::path::{Path, PathBuf};

use common::means::FEWEST_RUNS;
use common::reference::{Reference, Rule, Runs, compare};
use common::render::Built;
use common::{full_tier, in_shard, picture_of_difference, shared};
use lucerna::accel::Backend;
use lucerna::desc::{ParseOptions, load};
use lucerna::image_io::read_exr;
use lucerna::integrator::Integrator;
use lucerna::scene::ViewOverrides;
use lucerna::spectrum::ColorMode;

/// A scene, and how it is rendered.
struct Case {
    scene: PathBuf,
    color: ColorMode,
    /// Instead of the scene's.
    max_depth: Option<u32>,
    /// Samples a pixel of each of the 16 renders, in the normal tier.
    spp: u32,
}

/// What a case is compared with.
struct Comparison {
    /// Name of the reference.
    name: &'static str,
    /// Whether it is Mitsuba's, whose outermost pixels see only what lies within the picture. Here as in pbrt their filter reaches
    /// beyond: in the Cornell box, with darkness around it, pbrt's pixels are 3 to 5 % darker there than Mitsuba's, and nowhere
    /// else. These pixels are taken from the reference.
    splatted: bool,
    /// So many samples a pixel of each render, with a reserve, make the comparison conclusive.
    conclusive_spp: u32,
}

impl Case {
    /// Renders the case and applies the rule to each comparison; in the full tier on every backend, on the first one with as many
    /// samples as a conclusion takes. Nothing happens without the references.
    fn check(&self, comparisons: &[Comparison]) {
        let Some(directory) = shared("reference") else { return };
        for (i, &backend) in Backend::AVAILABLE.iter().enumerate() {
            let most = comparisons.iter().map(|c| c.conclusive_spp).max().unwrap_or(0);
            match (full_tier(), i) {
                (true, 0) => self.check_on(backend, most.max(self.spp), &directory, comparisons),
                (false, 0) | (true, _) => self.check_on(backend, self.spp, &directory, comparisons),
                (false, _) => {}
            }
        }
    }

    fn check_on(&self, backend: Backend, spp: u32, directory: &Path, comparisons: &[Comparison]) {
        let references: Vec<Reference> = comparisons.iter().map(|c| read_reference(directory, c)).collect();
        let pictures = self.render(backend, spp, [references[0].width, references[0].height]);
        for (comparison, reference) in comparisons.iter().zip(&references) {
            let mut runs = Runs::new(reference.width, reference.height);
            let mut mean = vec![0.0; reference.mean.len()];
            for picture in &pictures {
                let mut picture = picture.clone();
                if comparison.splatted {
                    border(reference).for_each(|i| picture[i] = reference.mean[i]);
                }
                runs.add(&picture);
                let add = |(sum, value): (&mut f32, &f32)| *sum += value / FEWEST_RUNS as f32;
                mean.iter_mut().zip(&picture).for_each(add);
            }
            let report = compare(&runs, reference, &comparison.rule());
            let name = format!("{} on {backend}, {spp} spp", comparison.name);
            println!("{name}: {report}");
            let problem = if spp < comparison.conclusive_spp {
                report.problem_but_precision()
            } else {
                report.problem()
            };
            if let Some(problem) = problem {
                let picture = picture_of_difference(&name, &mean, reference);
                panic!("{name}: {problem}\nsee {}", picture.display());
            }
        }
    }

    /// 16 pictures.
    fn render(&self, backend: Backend, spp: u32, [width, height]: [usize; 2]) -> Vec<Vec<f32>> {
        let desc = load(&self.scene, &ParseOptions::default()).unwrap_or_else(|e| panic!("{e}"));
        let built = Built::new(desc, backend, self.color);
        let mut integrator = Integrator::from_desc(&built.desc.integrator);
        if self.max_depth.is_some() {
            integrator = integrator.with_max_depth(self.max_depth);
        }
        let picture = |seed| {
            let overrides = ViewOverrides {
                resolution: Some([width as u32, height as u32]),
                spp: Some(spp),
                seed,
                ..ViewOverrides::default()
            };
            let (picture, stats) = built.picture_with(&built.view(0, &overrides), integrator);
            assert_eq!(stats.dropped_samples, 0, "dropped: {:?}", stats.dropped);
            picture
        };
        (1..=FEWEST_RUNS as u64).map(picture).collect()
    }
}

impl Comparison {
    /// The rule of the README: splats into neighbours correlate pixels.
    fn rule(&self) -> Rule {
        Rule {
            variance_factor: if self.splatted { 1.9 } else { 1.0 },
            ..Rule::default()
        }
    }
}

/// The values of the outermost pixels.
fn border(reference: &Reference) -> impl Iterator<Item = usize> + use<> {
    let (width, height) = (reference.width, reference.height);
    let outer = move |p: &usize| [0, width - 1].contains(&(p % width)) || [0, height - 1].contains(&(p / width));
    (0..width * height).filter(outer).flat_map(|p| 3 * p..3 * p + 3)
}

fn read_reference(directory: &Path, comparison: &Comparison) -> Reference {
    let name = comparison.name;
    let read = |part: &str| {
        let path = directory.join(format!("{name}-{part}.exr"));
        let (image, _) = read_exr(&path).unwrap_or_else(|e| panic!("{e}"));
        let pixels = image.to_rgb().expect("a picture in colour");
        ([image.width(), image.height()], pixels.into_flattened())
    };
    let ([width, height], mean) = read("mean");
    let (size, variance) = read("var");
    assert_eq!([width, height], size);
    let mut reference = Reference {
        width,
        height,
        mean,
        variance,
    };
    if comparison.splatted {
        border(&reference).for_each(|i| reference.variance[i] = 0.0);
    }
    reference
}

#[test]
fn smallpt_in_rgb() {
    let case = Case {
        scene: Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/smallpt.pbrt"),
        color: ColorMode::Rgb,
        max_depth: None,
        spp: 32,
    };
    if in_shard(0) {
        case.check(&[Comparison {
            name: "smallpt",
            splatted: false,
            conclusive_spp: 2600,
        }]);
    }
}

/// The Cornell box of ../shared/scenes, unless that is missing.
fn cornell_box(color: ColorMode, max_depth: Option<u32>, spp: u32) -> Option<Case> {
    Some(Case {
        scene: shared("scenes")?.join("cornell-box/scene-v4.pbrt"),
        color,
        max_depth,
        spp,
    })
}

/// pbrt's picture goes to depth 65, Mitsuba's to 29 of pbrt's count. The walls reflect 0.73 at most, so that what comes after 29 is
/// less than 0.73^30 / (1 - 0.73) = 3e-4 of the light: one render serves both.
#[test]
fn cornell_box_in_spectral() {
    if let Some(case) = cornell_box(ColorMode::Spectral, None, 320).filter(|_| in_shard(1)) {
        case.check(&[
            Comparison {
                name: "pbrt-cornell-box",
                splatted: false,
                conclusive_spp: 320,
            },
            Comparison {
                name: "mi3-cornell-box-spectral",
                splatted: true,
                conclusive_spp: 1300,
            },
        ]);
    }
}

#[test]
fn cornell_box_in_rgb() {
    if let Some(case) = cornell_box(ColorMode::Rgb, Some(29), 96).filter(|_| in_shard(2)) {
        case.check(&[Comparison {
            name: "mi3-cornell-box-rgb",
            splatted: true,
            conclusive_spp: 1000,
        }]);
    }
}
