//! How bias and noise fall. Under a light of intensity 1 at height 1 the irradiance of a floor is (1 + s²)^(-3/2) at a distance s from
//! below it; a circle around there finds the mean by the cone filter, which is less. For small radii the loss is 3/2 E[s²] r², E[s²]
//! being the filter's second moment; for any radius it is an integral over the circle.

use lucerna::spectrum::ColorMode;

use crate::common::full_tier;
use crate::common::means::{Estimate, FEWEST_RUNS};
use crate::common::render::{Built, blocks};
use crate::{assert_exact, build, film, photon, quad, runs, sppm};
use lucerna::integrator::Integrator;
use lucerna::scene::ViewOverrides;

/// The mean of the irradiance in a circle around the middle, by the cone filter.
fn seen(radius: f64) -> f64 {
    const STEPS: usize = 1000;
    let k = 1.1;
    let norm = 1.0 / (1.0 - 2.0 / (3.0 * k));
    let at = |i: usize| {
        let s = (i as f64 + 0.5) / STEPS as f64;
        2.0 * s * norm * (1.0 - s / k) * (1.0 + (s * radius).powi(2)).powf(-1.5)
    };
    (0..STEPS).map(at).sum::<f64>() / STEPS as f64
}

/// What r² of a pass is of the first one's, by the recurrence of Knaus and Zwicker (2011).
fn shrinkage(pass: u32) -> f64 {
    (1..=pass).map(f64::from).map(|i| (i + 2.0 / 3.0) / (i + 1.0)).product()
}

/// The floor is a sheet that is seen from below, in a spot so small that it is flat there. It passes pi of the irradiance on as radiance.
fn floor(size: f64, light: &str) -> String {
    format!(
        "LookAt 0 0 -1  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-0.01 0.01 -0.01 0.01]\n{}WorldBegin\n{light}\n\
         Material \"diffusetransmission\" \"rgb reflectance\" [0 0 0] \"rgb transmittance\" [1 1 1]\n{}",
        film([2, 2]),
        quad([-size, -size, 0.0], [2.0 * size, 0.0, 0.0], [0.0, 2.0 * size, 0.0])
    )
}

/// A point light in the middle of a ball that passes all of its light on diffusely: it is then Lambertian, and lights as a point does.
fn lampshade() -> String {
    floor(
        1.5,
        "AttributeBegin Translate 0 0 1 LightSource \"point\" \"rgb I\" [3.1415927 3.1415927 3.1415927]\n\
         Material \"diffusetransmission\" \"rgb reflectance\" [0 0 0] \"rgb transmittance\" [1 1 1] Shape \"sphere\" \"float radius\" 0.1\n\
         AttributeEnd",
    )
}

/// A point light over an interface that is none.
fn interface() -> String {
    let pane = quad([-2.0, -2.0, 0.5], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]);
    floor(
        1.2,
        &format!(
            "LightSource \"point\" \"point3 from\" [0 0 1] \"rgb I\" [3.1415927 3.1415927 3.1415927]\n\
             Material \"dielectric\" \"float eta\" 1.0\n{pane}"
        ),
    )
}

/// The slope of a line through points (x, y) of which y has a standard deviation, and that of the slope.
fn slope(points: &[[f64; 3]]) -> (f64, f64) {
    let weighted = |f: &dyn Fn(&[f64; 3]) -> f64| points.iter().map(|p| f(p) / (p[2] * p[2])).sum::<f64>();
    let weight = weighted(&|_| 1.0);
    let x = weighted(&|p| p[0]) / weight;
    let square = weighted(&|p| (p[0] - x).powi(2));
    (weighted(&|p| (p[0] - x) * p[1]) / square, square.recip().sqrt())
}

/// One run: the mean over the picture.
fn value(built: &Built, integrator: Integrator, spp: u32, seed: u64) -> f64 {
    let overrides = ViewOverrides {
        seed,
        spp: Some(spp),
        ..ViewOverrides::default()
    };
    let view = built.view(0, &overrides);
    let (picture, _) = built.picture_with(&view, integrator);
    blocks(&picture, view.resolution[0] as usize, [2, 2])
        .iter()
        .sum::<f64>()
        / 3.0
}

/// ln of the bias of an estimate, with its deviation.
fn log_bias(estimate: Estimate) -> [f64; 2] {
    let bias = 1.0 - estimate.mean;
    [bias.ln(), estimate.variance.sqrt() / bias]
}

#[test]
fn a_circle_sees_the_mean_over_it() {
    let built = build(&lampshade(), ColorMode::Rgb);
    let mut points = Vec::new();
    let mut predicted = Vec::new();
    for radius in [0.3_f64, 0.45, 0.7] {
        // One pass, whose circles have not shrunk.
        let runs = runs_of_pass(&built, sppm(Some(2), 150_000, radius as f32));
        let expected = seen(radius);
        assert_exact(&format!("radius {radius}"), &grey(&runs), &[expected; 3], 1e-4, 0.05);
        let [y, deviation] = log_bias(Estimate::of(runs.iter().copied()));
        points.push([radius.ln(), y, deviation]);
        predicted.push([radius.ln(), (1.0 - expected).ln(), deviation]);
    }
    let ((fitted, deviation), (theory, _)) = (slope(&points), slope(&predicted));
    println!("bias ~ r^{fitted:.3} +- {deviation:.3}, by theory {theory:.3}, 2 in the limit");
    assert!(
        deviation < 0.08 && (fitted - theory).abs() < 4.0 * deviation,
        "{fitted} +- {deviation}, {theory}"
    );
}

fn runs_of_pass(built: &Built, integrator: Integrator) -> Vec<f64> {
    (1..=FEWEST_RUNS as u64)
        .map(|seed| value(built, integrator, 1, seed))
        .collect()
}

fn grey(values: &[f64]) -> Vec<Vec<f64>> {
    values.iter().map(|&v| vec![v; 3]).collect()
}

/// Bias ~ n^(-1/3) and variance ~ n^(-2/3) after n passes, in the limit; where there are few, by the sums of the recurrence.
#[test]
fn passes_lower_bias_and_noise_at_the_rates_of_theory() {
    const RADIUS: f64 = 0.6;
    const SEEDS: u64 = 48;
    let built = build(&lampshade(), ColorMode::Rgb);
    let integrator = sppm(Some(2), 2000, RADIUS as f32);
    let (mut biases, mut predicted) = (Vec::new(), Vec::new());
    let (mut variances, mut predicted_variances) = (Vec::new(), Vec::new());
    let (counts, precision) = if full_tier() {
        ([1, 8, 64], 0.09)
    } else {
        ([1, 4, 16], 0.12)
    };
    for passes in counts {
        let squares: Vec<f64> = (0..passes).map(shrinkage).collect();
        let mean = |f: &dyn Fn(f64) -> f64| squares.iter().map(|&s| f(s)).sum::<f64>() / f64::from(passes);
        let expected = mean(&|s| seen(RADIUS * s.sqrt()));
        let values: Vec<f64> = (1..=SEEDS)
            .map(|seed| value(&built, integrator, passes, seed))
            .collect();
        let name = format!("{passes} passes");
        assert_exact(&name, &grey(&values), &[expected; 3], 1e-4, 0.12);
        let estimate = Estimate::of(values.iter().copied());
        let [y, deviation] = log_bias(estimate);
        let x = f64::from(passes).ln();
        biases.push([x, y, deviation]);
        predicted.push([x, (1.0 - expected).ln(), deviation]);
        // A sample variance has the relative deviation sqrt(2 / (n - 1)).
        let deviation = (2.0 / (SEEDS - 1) as f64).sqrt();
        variances.push([x, estimate.variance.ln(), deviation]);
        // Photons are as many as the area, the estimate divides by it: each pass has a variance ~ 1 / r².
        predicted_variances.push([x, (mean(&|s| 1.0 / s) / f64::from(passes)).ln(), deviation]);
    }
    for (name, points, predicted, limit) in [
        ("bias", biases, predicted, -1.0 / 3.0),
        ("variance", variances, predicted_variances, -2.0 / 3.0),
    ] {
        let ((fitted, deviation), (theory, _)) = (slope(&points), slope(&predicted));
        println!("{name} ~ n^{fitted:.3} +- {deviation:.3}, by theory {theory:.3}, {limit:.3} in the limit");
        assert!(
            (fitted - theory).abs() < 4.0 * deviation,
            "{name}: {fitted} +- {deviation}, {theory}"
        );
        assert!(deviation < precision, "{name}: {deviation}");
    }
}

/// k of N photons lie within r² = k / (pi N p), p being their density: bias ~ 1 / N.
#[test]
fn more_photons_lower_the_bias_of_nearest_neighbours() {
    const USED: u32 = 100;
    // The solid angle of the floor from the light: photons that are stored have the density 1 over this below it.
    let side = 1.2_f64;
    let omega = 4.0 * (side * side / (1.0 + 2.0 * side * side).sqrt()).atan();
    let built = build(&interface(), ColorMode::Rgb);
    let (mut points, mut predicted) = (Vec::new(), Vec::new());
    // In the normal tier the absolute value for the fewest photons only.
    let counts: &[u32] = if full_tier() { &[400, 800, 1600] } else { &[400] };
    for &photons in counts {
        let integrator = photon(Some(2), |p| {
            p.caustic_photons = Some(photons);
            p.global_photons = Some(0);
            p.used = USED;
            p.max_distance = Some(1.0);
            p.passes = 64;
            p.final_gather_samples = 1;
        });
        let runs = runs(&built, integrator, 64, 1, [2, 2]);
        let r2 = f64::from(USED + 1) * omega / (std::f64::consts::PI * f64::from(photons));
        let expected = seen_by_nearest(r2);
        assert_exact(&format!("{photons} photons"), &runs, &[expected; 3], 3e-3, 0.05);
        let [y, deviation] = log_bias(Estimate::of(runs.iter().map(|run| run.iter().sum::<f64>() / 3.0)));
        // Photons are more even than random ones: an estimate by k may be off by a part of one of them.
        let deviation = deviation.hypot(0.25 / f64::from(USED) / (1.0 - expected));
        let x = f64::from(photons).ln();
        points.push([x, y, deviation]);
        predicted.push([x, (1.0 - expected).ln(), deviation]);
    }
    if points.len() < 2 {
        return;
    }
    let ((fitted, deviation), (theory, _)) = (slope(&points), slope(&predicted));
    println!("bias ~ N^{fitted:.3} +- {deviation:.3}, by theory {theory:.3}, -1 in the limit");
    assert!(
        deviation < 0.12 && (fitted - theory).abs() < 4.0 * deviation,
        "{fitted} +- {deviation}, {theory}"
    );
}

/// As [`seen`], where the circle holds as many photons as one of r² would if they were as dense all over: their number within s is
/// proportional to 1 - 1 / sqrt(1 + s²).
fn seen_by_nearest(r2: f64) -> f64 {
    // Twice the share of the half sphere that is within s.
    let share = |s2: f64| 2.0 * (1.0 - 1.0 / (1.0 + s2).sqrt());
    let mut radius2 = r2;
    for _ in 0..100 {
        radius2 *= r2 / share(radius2);
    }
    seen(radius2.sqrt())
}
