//! What choosing a light costs, and what it is worth, by the number of lights: small triangles of random brightness all over a
//! cube, and lit points among them.
//!
//! - `sample`: one light chosen for a point;
//! - `pmf`: the probability of a light, as multiple importance sampling asks for it at a hit;
//! - `build`: the hierarchy.
//!
//! Before the timings it prints the variance of one light sample's estimate of irradiance, over the square of the irradiance, on
//! average over points.
//!
//! `cargo bench --bench lights`.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use lucerna::light::{AreaLight, EmitterShape, Light, LightDensity, LightId, LightSampler};
use lucerna::math::{Bounds3, Vec2, Vec3};
use lucerna::sampling::hash::{hash_u32s, unit_f32};
use lucerna::sampling::warp;
use lucerna::spectrum::{ColorMode, Spectrum, SpectrumRole, Wavelengths};

const COUNTS: [usize; 6] = [1, 10, 100, 1000, 10_000, 100_000];
const POINTS: usize = 1 << 12;
const BOUNDS: Bounds3 = Bounds3 {
    min: Vec3::ZERO,
    max: Vec3::ONE,
};

/// A number in [0, 1) for an index and a purpose.
fn unit(index: usize, purpose: u32) -> f32 {
    unit_f32(hash_u32s(&[index as u32, purpose]) as u32)
}

fn point(index: usize, purpose: u32) -> Vec3 {
    Vec3::from([0, 1, 2].map(|axis| unit(index, purpose + axis)))
}

fn direction(index: usize, purpose: u32) -> Vec3 {
    warp::sample_uniform_sphere(Vec2::new(unit(index, purpose), unit(index, purpose + 1)))
}

fn lights(count: usize) -> Vec<Light> {
    let size = 0.2 / (count as f32).cbrt();
    (0..count)
        .map(|i| {
            let a = point(i, 0);
            let vertices = [a, a + size * direction(i, 3), a + size * direction(i, 5)];
            let ng = (vertices[1] - a).cross(vertices[2] - a).normalize();
            let radiance = Spectrum::constant(unit(i, 7) + 0.1);
            let radiance = radiance.compile(ColorMode::Rgb, SpectrumRole::Emission);
            let light = AreaLight::new(EmitterShape::Triangle { vertices, ng }, radiance, true);
            Light::Area(light.expect("an area"))
        })
        .collect()
}

/// Points among the lights, and their normals.
fn places() -> Vec<(Vec3, Vec3)> {
    (0..POINTS).map(|i| (point(i, 10), direction(i, 13))).collect()
}

/// The variance of one sample over the square of its expectation, the median over some points.
fn relative_variance(lights: &[Light], sampler: &LightSampler) -> f64 {
    const SAMPLES: usize = 20_000;
    let lambda = Wavelengths::rgb();
    let mut variances: Vec<f64> = places()
        .into_iter()
        .take(31)
        .map(|(p, n)| {
            let (mut sum, mut squares) = (0.0, 0.0);
            for i in 0..SAMPLES {
                let u = Vec2::new(unit(i, 20), unit(i, 21));
                let value = sampler.sample(p, n, unit(i, 22)).map_or(0.0, |chosen| {
                    let sample = lights[chosen.light.index()].sample_li(p, 0.0, u, &lambda);
                    sample.map_or(0.0, |s| match s.density {
                        LightDensity::Continuous(pdf) => {
                            f64::from(s.li.0[0] * s.wi.dot(n).max(0.0) / (pdf.0 * chosen.pmf))
                        }
                        LightDensity::Delta => 0.0,
                    })
                });
                sum += value;
                squares += value * value;
            }
            let mean = sum / SAMPLES as f64;
            squares / SAMPLES as f64 / (mean * mean) - 1.0
        })
        .filter(|variance| variance.is_finite())
        .collect();
    variances.sort_by(f64::total_cmp);
    variances.get(variances.len() / 2).copied().unwrap_or(0.0)
}

fn bench(criterion: &mut Criterion) {
    println!("lights: relative variance of one sample by uniform, power, bvh");
    for count in COUNTS {
        let lights = lights(count);
        let places = places();
        let samplers = [
            ("uniform", LightSampler::uniform(&lights)),
            ("power", LightSampler::power(&lights, &BOUNDS)),
            ("bvh", LightSampler::bvh(&lights, &BOUNDS)),
        ];
        let [uniform, power, bvh] = samplers.each_ref().map(|(_, s)| relative_variance(&lights, s));
        println!("{count}: {uniform:.2} {power:.2} {bvh:.2}");
        for (name, sampler) in &samplers[1..] {
            let mut i = 0;
            let mut next = move || {
                i = (i + 1) % POINTS;
                i
            };
            criterion.bench_with_input(
                BenchmarkId::new(format!("sample/{name}"), count),
                sampler,
                |b, sampler| {
                    b.iter(|| {
                        let i = next();
                        let (p, n) = places[i];
                        black_box(sampler.sample(p, n, i as f32 / POINTS as f32))
                    });
                },
            );
            criterion.bench_with_input(BenchmarkId::new(format!("pmf/{name}"), count), sampler, |b, sampler| {
                b.iter(|| {
                    let i = next();
                    let (p, n) = places[i];
                    black_box(sampler.pmf(p, n, LightId((i * 7919 % count) as u32)))
                });
            });
        }
        let mut group = criterion.benchmark_group("build");
        group.sample_size(10);
        group.bench_with_input(BenchmarkId::new("bvh", count), &lights, |b, lights| {
            b.iter(|| black_box(LightSampler::bvh(lights, &BOUNDS)));
        });
        group.finish();
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
