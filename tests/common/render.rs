//! Pictures of scenes written as pbrt text, for every backend and colour mode, reduced to the runs that `means` judges.

use std::path::Path;

use lucerna::accel::Backend;
use lucerna::desc::{ParseOptions, SceneDesc, pbrt};
use lucerna::integrator::{Integrator, RenderStats, Silent};
use lucerna::scene::{Scene, SceneOptions, View, ViewOverrides};
use lucerna::spectrum::{ColorMode, Spectrum, SpectrumRole, Wavelengths, cie};

use super::full_tier;
use super::means::{FEWEST_RUNS, Means, MeansReport};

/// Both colour modes.
pub const MODES: [ColorMode; 2] = [ColorMode::Rgb, ColorMode::Spectral];

/// Every backend in every colour mode.
pub fn combinations() -> impl Iterator<Item = (Backend, ColorMode)> {
    let modes = |&backend| MODES.map(|mode| (backend, mode));
    Backend::AVAILABLE.iter().flat_map(modes)
}

/// Two of the [`combinations`] in which each backend and each colour mode occurs once, chosen by `name`; in the full tier all four.
pub fn usual_combinations(name: &str) -> impl Iterator<Item = (Backend, ColorMode)> {
    let parity = name.bytes().map(usize::from).sum::<usize>();
    let last = Backend::AVAILABLE.len() - 1;
    combinations().enumerate().filter_map(move |(index, combination)| {
        let (backend, mode) = (index / MODES.len(), index % MODES.len());
        (last == 0 || full_tier() || (backend + mode + parity).is_multiple_of(2)).then_some(combination)
    })
}

/// A scene and what it was described by.
pub struct Built {
    pub desc: SceneDesc,
    pub scene: Scene,
}

/// Reads a scene from a text; files that it names are looked for beside tests/.
#[track_caller]
pub fn parse(text: &str) -> SceneDesc {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inline.pbrt");
    pbrt::parse_str(text.as_bytes(), &path, &ParseOptions::default()).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn options(backend: Backend, color: ColorMode) -> SceneOptions {
    SceneOptions {
        backend: Some(backend),
        color,
        ..SceneOptions::default()
    }
}

impl Built {
    pub fn new(desc: SceneDesc, backend: Backend, color: ColorMode) -> Self {
        let scene = Scene::build(&desc, &options(backend, color)).expect("the scene can be built");
        Self { desc, scene }
    }

    /// The same, without the shapes in the description.
    pub fn taking_shapes(mut desc: SceneDesc, backend: Backend, color: ColorMode) -> Self {
        let scene = Scene::build_taking_shapes(&mut desc, &options(backend, color)).expect("the scene can be built");
        Self { desc, scene }
    }

    /// The view `index` of the scene with some changes.
    pub fn view(&self, index: usize, overrides: &ViewOverrides) -> View {
        View::build(&self.desc, &self.desc.views[index], self.scene.color(), overrides).expect("the view makes sense")
    }

    /// The picture of a view: r, g, b by pixel. No sample may have been dropped.
    #[track_caller]
    pub fn picture(&self, view: &View) -> Vec<f32> {
        let (picture, stats) = self.picture_with(view, Integrator::from_desc(&self.desc.integrator));
        assert_eq!(stats.dropped_samples, 0, "dropped: {:?}", stats.dropped);
        picture
    }

    /// The picture of a view by an integrator, and what was done for it.
    pub fn picture_with(&self, view: &View, integrator: Integrator) -> (Vec<f32>, RenderStats) {
        let film = integrator.film(view);
        let stats = integrator.render(&self.scene, view, &film, &Silent);
        (film.develop(), stats)
    }

    /// The first view, rendered with the seeds 1 to 16 and `spp` samples a pixel: one list a run, the mean of each channel over
    /// each block of `block` pixels.
    #[track_caller]
    pub fn runs(&self, spp: u32, block: [usize; 2]) -> Vec<Vec<f64>> {
        (1..=FEWEST_RUNS as u64)
            .map(|seed| {
                let overrides = ViewOverrides {
                    seed,
                    spp: Some(spp),
                    ..ViewOverrides::default()
                };
                let view = self.view(0, &overrides);
                blocks(&self.picture(&view), view.resolution[0] as usize, block)
            })
            .collect()
    }
}

/// The mean of each channel over each block of a picture `width` pixels wide, whose sides are multiples of the block's.
pub fn blocks(picture: &[f32], width: usize, [columns, rows]: [usize; 2]) -> Vec<f64> {
    let height = picture.len() / 3 / width;
    assert!(width.is_multiple_of(columns) && height.is_multiple_of(rows));
    let mut sums = vec![0.0; picture.len() / (columns * rows)];
    for (i, pixel) in picture.chunks_exact(3).enumerate() {
        let block = i / width / rows * (width / columns) + i % width / columns;
        for (sum, &value) in sums[3 * block..].iter_mut().zip(pixel) {
            *sum += f64::from(value) / (columns * rows) as f64;
        }
    }
    sums
}

/// A radiance known in closed form, `f` of the values of some spectra at a wavelength, as linear sRGB. In rgb mode `f` is
/// applied to each channel, in spectral mode to each wavelength, before the sensor.
pub fn expected_rgb(mode: ColorMode, spectra: &[(Spectrum, SpectrumRole)], f: impl Fn(&[f64]) -> f64) -> [f64; 3] {
    match mode {
        ColorMode::Rgb => {
            let lanes = spectra.iter().map(|(spectrum, role)| {
                let compiled = spectrum.compile(mode, *role);
                compiled.sample(&Wavelengths::rgb()).0
            });
            let lanes: Vec<_> = lanes.collect();
            std::array::from_fn(|c| f(&lanes.iter().map(|lane| f64::from(lane[c])).collect::<Vec<_>>()))
        }
        ColorMode::Spectral => cie::xyz_to_srgb(cie::integrate_xyz(|nm| {
            let values = spectra.iter().map(|(spectrum, _)| f64::from(spectrum.value(nm)));
            f(&values.collect::<Vec<_>>()) as f32
        })),
    }
}

/// How runs are judged against a closed form: an error of `power.0` in any one block and of `power.1` in the whole are noticed
/// with probability 0.99 each, and what is off by less than a thousandth passes (single precision, the steps of 1 nm).
pub struct Judge {
    pub power: (f64, f64),
}

impl Judge {
    /// 5 % of one block, half a percent of the whole.
    pub const USUAL: Self = Self { power: (0.05, 0.005) };
    const MEANS: Means = Means {
        significance: 0.01,
        slack: 1e-3,
    };

    /// Panics unless the runs agree with what is expected of each block, have the power, and would not agree with an
    /// expectation that is wrong by that much, everywhere (either way) or in one block. Where black is expected of all,
    /// it must be black to the last bit.
    #[track_caller]
    pub fn assert_agrees(&self, name: &str, runs: &[Vec<f64>], expected: &[f64]) -> MeansReport {
        let report = Self::MEANS.against_exact(runs, expected);
        report.assert_agrees(name);
        if expected.iter().all(|&e| e == 0.0) {
            assert!(runs.iter().flatten().all(|&v| v == 0.0), "{name}: not black");
            return report;
        }
        report.assert_power(name, self.power.0, self.power.1);
        let injected = |wrong: &dyn Fn(usize) -> f64| {
            let expected: Vec<f64> = expected.iter().enumerate().map(|(i, e)| e / wrong(i)).collect();
            let report = Self::MEANS.against_exact(runs, &expected);
            assert!(!report.agrees(), "{name}: an injected error is not noticed: {report}");
        };
        injected(&|_| 1.0 + self.power.1);
        injected(&|_| 1.0 - self.power.1);
        let brightest = (0..expected.len()).max_by(|&a, &b| expected[a].total_cmp(&expected[b]));
        injected(&|i| if Some(i) == brightest { 1.0 + self.power.0 } else { 1.0 });
        report
    }
}
