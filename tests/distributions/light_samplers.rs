//! The choice of a light: probabilities add up to 1, are those with which lights are chosen, and leave out no light that shines.

use glam::{DVec3, Vec2, Vec3};
use lucerna::light::{
    AreaLight, DistantLight, EmitterShape, EnvironmentLight, Light, LightId, LightSampler, PointLight,
};
use lucerna::math::Bounds3;
use lucerna::sampling::warp;
use lucerna::spectrum::{ColorMode, CompiledSpectrum, Spectrum, SpectrumRole, Wavelengths};

use super::common::chi2::Chi2;
use super::common::random::Random;
use super::first_two;

const BOUNDS: Bounds3 = Bounds3 {
    min: Vec3::splat(-4.0),
    max: Vec3::splat(4.0),
};

fn constant(value: f32) -> CompiledSpectrum {
    Spectrum::constant(value).compile(ColorMode::Spectral, SpectrumRole::Emission)
}

fn point_in(random: &mut Random, size: f32) -> Vec3 {
    let [x, y, z, _] = random.unit4();
    (Vec3::new(x, y, z) * 2.0 - 1.0) * size
}

fn direction(random: &mut Random) -> Vec3 {
    warp::sample_uniform_sphere(Vec2::new(random.unit(), random.unit()))
}

/// A light of any kind that is not infinitely far away, of any size and brightness; a few are black.
fn random_light(random: &mut Random) -> Light {
    let p = point_in(random, 4.0);
    let brightness = if random.unit() < 0.1 {
        0.0
    } else {
        (8.0 * random.unit() - 4.0).exp()
    };
    let size = (-4.0 * random.unit()).exp();
    let shape = match (random.unit() * 4.0) as u32 {
        0 => return Light::Point(PointLight::new(p, constant(brightness))),
        1 => EmitterShape::Sphere {
            center: p.as_dvec3(),
            radius: f64::from(size),
            inward: random.unit() < 0.3,
        },
        _ => {
            let vertices = [p, p + size * direction(random), p + size * direction(random)];
            let ng = (vertices[1] - p).cross(vertices[2] - p).normalize();
            EmitterShape::Triangle { vertices, ng }
        }
    };
    let two_sided = random.unit() < 0.3;
    Light::Area(AreaLight::new(shape, constant(brightness), two_sided).expect("an area"))
}

/// `count` lights, and as many infinite ones as asked for, in the middle.
fn lights(count: usize, infinite: usize, seed: u64) -> Vec<Light> {
    let mut random = Random::new(seed);
    let mut lights: Vec<Light> = (0..count).map(|_| random_light(&mut random)).collect();
    for i in 0..infinite {
        let light = if i % 2 == 0 {
            Light::Environment(EnvironmentLight::new(constant(0.5)))
        } else {
            Light::Distant(DistantLight::new(Vec3::Z, constant(2.0)))
        };
        lights.insert(count / 2, light);
    }
    lights
}

/// All samplers, over few and many lights, with and without infinite ones.
fn samplers() -> Vec<(String, Vec<Light>, LightSampler)> {
    let mut all = Vec::new();
    for (count, infinite) in [(1, 0), (0, 1), (1, 1), (2, 0), (7, 2), (60, 0), (300, 1), (3000, 0)] {
        let lights = lights(count, infinite, 1 + count as u64);
        for (name, sampler) in [
            ("uniform", LightSampler::uniform(&lights)),
            ("power", LightSampler::power(&lights, &BOUNDS)),
            ("bvh", LightSampler::bvh(&lights, &BOUNDS)),
        ] {
            all.push((format!("{name}, {count} + {infinite} lights"), lights.clone(), sampler));
        }
    }
    all
}

/// Points with normals among the lights and far away, some without a normal.
fn places(count: usize) -> Vec<(Vec3, Vec3)> {
    let mut random = Random::new(77);
    let place = |i: usize| {
        let size = [4.0, 4.5, 40.0][i % 3];
        let n = if i % 5 == 4 { Vec3::ZERO } else { direction(&mut random) };
        (point_in(&mut random, size), n)
    };
    (0..count).map(place).collect()
}

/// The sum is 1, less what a tree loses where it finds only below a node that nothing there shines on the point (that it loses as
/// often is tested with the frequencies); a light that brings something to a point has a probability.
#[test]
fn probabilities_add_up_to_one_and_no_light_that_shines_is_left_out() {
    let lambda = Wavelengths::sample_visible(0.4);
    let mut random = Random::new(5);
    for (name, lights, sampler) in samplers() {
        let mut lit = 0;
        for (p, n) in places(60) {
            let pmfs = (0..lights.len()).map(|i| sampler.pmf(p, n, LightId(i as u32)));
            let sum: f64 = pmfs.clone().map(f64::from).sum();
            let shines = |light: &Light| {
                let sample = light.sample_li(p, Vec2::new(random.unit(), random.unit()), &lambda);
                sample.is_some_and(|sample| sample.li.max_value() > 0.0)
            };
            let shining: Vec<bool> = lights.iter().map(shines).collect();
            let any = shining.contains(&true);
            // Products of some 12 factors, each rounded, by light.
            assert!(sum < 1.0 + 2e-5, "{name} at {p}, {n}: {sum}");
            let least = if name.starts_with("bvh") { 0.5 } else { 1.0 - 2e-5 };
            assert!(sum > least || !any, "{name} at {p}, {n}: {sum}");
            for (i, (pmf, shines)) in pmfs.zip(shining).enumerate() {
                assert!(pmf > 0.0 || !shines, "{name} at {p}, {n}: light {i} is left out");
            }
            lit += usize::from(any);
        }
        assert!(lit >= 30, "{name}: {lit} places are lit");
    }
}

#[test]
fn lights_are_chosen_with_their_probability() {
    const PLACES: usize = 5;
    let samplers = samplers();
    for (name, lights, sampler) in &samplers {
        for (p, n) in places(PLACES) {
            let count = lights.len();
            let test = Chi2 {
                bins: [count, 1],
                samples: 100_000,
                ..Chi2::new([[0.0, count as f64], [0.0, 1.0]]).of(samplers.len() * PLACES)
            };
            let report = test.run(
                |u| {
                    let chosen = sampler.sample(p, n, u[0])?;
                    assert!(chosen.pmf > 0.0);
                    assert_eq!(chosen.pmf, sampler.pmf(p, n, chosen.light), "{name} at {p}, {n}");
                    Some([f64::from(chosen.light.0) + 0.5, 0.5])
                },
                |[at, _]| f64::from(sampler.pmf(p, n, LightId(at as u32))),
            );
            report.assert_ok(name);
        }
    }
}

#[test]
fn uniform_and_power_are_what_they_say_and_nothing_is_chosen_of_nothing() {
    let levels = [0.5, 0.0, 3.0, 1.0, 0.01];
    let lights = levels.map(|l| Light::Point(PointLight::new(Vec3::ZERO, constant(l))));
    for (i, level) in levels.into_iter().enumerate() {
        let id = LightId(i as u32);
        assert!((LightSampler::uniform(&lights).pmf(Vec3::ONE, Vec3::Z, id) - 0.2).abs() < 1e-6);
        let by_power = LightSampler::power(&lights, &BOUNDS).pmf(Vec3::ONE, Vec3::Z, id);
        assert!((by_power - level / 4.51).abs() < 1e-6, "{i}: {by_power}");
        // All in one place: no more is known of them than their intensity.
        let by_tree = LightSampler::bvh(&lights, &BOUNDS).pmf(Vec3::ONE, Vec3::Z, id);
        assert!((by_tree - level / 4.51).abs() < 1e-6, "{i}: {by_tree}");
    }
    for lights in [&[][..], &lights[1..2]] {
        for sampler in [LightSampler::power(lights, &BOUNDS), LightSampler::bvh(lights, &BOUNDS)] {
            assert_eq!(sampler.sample(Vec3::ONE, Vec3::Z, 0.5), None);
        }
    }
    assert_eq!(LightSampler::uniform(&[]).sample(Vec3::ONE, Vec3::Z, 0.5), None);
}

/// What the tree is for: with many small lights around, most samples go to the few that matter. The variance of an estimate of
/// the irradiance falls by more than a factor of ten.
#[test]
fn the_tree_knows_what_matters() {
    let mut random = Random::new(9);
    let lights: Vec<Light> = (0..2000)
        .map(|_| {
            let center: DVec3 = point_in(&mut random, 4.0).as_dvec3();
            let shape = EmitterShape::Sphere {
                center,
                radius: 0.01,
                inward: false,
            };
            Light::Area(AreaLight::new(shape, constant(1.0), false).expect("an area"))
        })
        .collect();
    let lambda = Wavelengths::sample_visible(0.4);
    let moments = |sampler: &LightSampler| {
        let mut random = Random::new(10);
        let (mut sum, mut squares) = (0.0, 0.0);
        for _ in 0..50_000 {
            let (p, n) = (Vec3::new(0.3, -0.2, 0.7), Vec3::Z);
            let u = random.unit4();
            let value = sampler.sample(p, n, u[2]).map_or(0.0, |chosen| {
                let sample = lights[chosen.light.index()].sample_li(p, first_two(u), &lambda);
                sample.map_or(0.0, |s| match s.density {
                    lucerna::light::LightDensity::Continuous(pdf) => {
                        f64::from(s.li.0[0] * s.wi.dot(n).max(0.0) / (pdf.0 * chosen.pmf))
                    }
                    lucerna::light::LightDensity::Delta => f64::NAN,
                })
            });
            sum += value / 50_000.0;
            squares += value * value / 50_000.0;
        }
        (sum, squares - sum * sum)
    };
    let (by_power, power_variance) = moments(&LightSampler::power(&lights, &BOUNDS));
    let (by_tree, tree_variance) = moments(&LightSampler::bvh(&lights, &BOUNDS));
    let error = ((power_variance + tree_variance) / 50_000.0).sqrt();
    assert!(
        (by_power - by_tree).abs() < 3.5 * error,
        "{by_power} and {by_tree}, {error}"
    );
    assert!(
        tree_variance < 0.1 * power_variance,
        "{tree_variance} and {power_variance}"
    );
}
