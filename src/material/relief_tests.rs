use super::*;
use crate::geometry::{GeometryId, Hit, PrimitiveId};
use crate::image_io::{Image, Window};
use crate::material::{ConductorIor, Density, Distribution, Roughness, TransportMode};
use crate::math::DAffine3;
use crate::spectrum::{ColorMode, Spectrum, SpectrumRole};
use crate::texture::{NoiseKind, NoiseTexture, TextureSpace, Wrap};

fn constant(value: f32) -> crate::texture::SpectrumTexture {
    Spectrum::constant(value)
        .compile(ColorMode::Spectral, SpectrumRole::Reflectance)
        .into()
}

fn diffuse() -> Material {
    Material::Diffuse {
        reflectance: constant(0.8),
        roughness: 0.0.into(),
    }
}

/// Reflects nearly all light.
fn metal(alpha: f32) -> Material {
    Material::Conductor {
        ior: ConductorIor::Measured {
            eta: constant(0.01),
            k: constant(100.0),
        },
        roughness: Roughness::new(alpha.into(), alpha.into(), false, Distribution::default()),
        multiple_scattering: false,
    }
}

/// A map of one colour.
fn normals(rgb: [f32; 3]) -> ReliefMap {
    let window = Window::of_size(1, 1);
    let image = Image::rgb(window, window, rgb.to_vec()).expect("an image");
    ReliefMap::Normals(Arc::new(
        MipMap::new(&Arc::new(image), Wrap::Repeat, false).expect("colour"),
    ))
}

/// A map that bends the normal of the plane z = 0 to `n`.
fn bent_to(n: Vec3) -> ReliefMap {
    normals((n.normalize() * 0.5 + 0.5).into())
}

fn relief(map: ReliefMap, material: Material) -> Material {
    Material::Relief(Arc::new(Relief { map, material }))
}

fn plane() -> SurfaceInteraction {
    SurfaceInteraction {
        p: Vec3::new(0.3, 0.7, 0.0),
        error: 0.0,
        ng: Vec3::Z,
        ns: Vec3::Z,
        dpdu: Vec3::X * 2.0,
        dpdv: Vec3::Y * 3.0,
        uv: Vec2::new(0.15, 0.2),
        barycentrics: Vec2::ZERO,
        wo: Vec3::Z,
        footprint: 0.0,
        time: 0.0,
        hit: Hit {
            geometry: GeometryId(0),
            primitive: PrimitiveId(0),
            instance: None,
        },
    }
}

fn lambda() -> Wavelengths {
    Wavelengths::sample_visible(0.3)
}

fn direction(theta: f32, phi: f32) -> Vec3 {
    Vec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
}

/// The integral of `f` over all directions.
fn integrate(f: impl Fn(Vec3) -> f32) -> f64 {
    let (rows, columns) = (400, 800);
    let mut sum = 0.0;
    for i in 0..rows {
        let cos = 1.0 - 2.0 * (i as f32 + 0.5) / rows as f32;
        for j in 0..columns {
            let phi = std::f32::consts::TAU * (j as f32 + 0.5) / columns as f32;
            sum += f64::from(f(direction(cos.acos(), phi)));
        }
    }
    sum * 4.0 * std::f64::consts::PI / f64::from(rows * columns)
}

const NORMALS: [Vec3; 3] = [
    Vec3::new(0.2, 0.1, 1.0),
    Vec3::new(-0.9, 0.3, 1.0),
    Vec3::new(0.0, 1.0, 0.4),
];

fn outgoing() -> [Vec3; 4] {
    [
        direction(0.1, 0.0),
        direction(0.9, 3.0),
        direction(1.4, 0.2),
        direction(1.5, 4.4),
    ]
}

#[test]
fn flat_maps_change_no_bit() {
    let flat_height = FloatTexture::Scale(Arc::new([0.0.into(), noise()]));
    let mut si = plane();
    si.ns = Vec3::new(0.1, -0.2, 1.0).normalize();
    for map in [normals([0.5, 0.5, 1.0]), ReliefMap::Displacement(flat_height)] {
        let (mapped, plain) = (relief(map, metal(0.3)), metal(0.3));
        let (mapped, plain) = (mapped.bsdf(&si, &mut lambda()), plain.bsdf(&si, &mut lambda()));
        for wo in outgoing() {
            let u = Vec2::new(0.3, 0.8);
            let [a, b] = [&mapped, &plain].map(|bsdf| bsdf.sample_f(wo, 0.6, u, TransportMode::Radiance));
            assert_eq!(format!("{a:?}"), format!("{b:?}"));
            let wi = direction(0.5, 1.0);
            let [a, b] = [&mapped, &plain].map(|bsdf| bsdf.f(wo, wi, TransportMode::Radiance));
            assert_eq!(a, b);
        }
    }
}

fn noise() -> FloatTexture {
    let space = TextureSpace::new(&DAffine3::IDENTITY);
    FloatTexture::Noise(Arc::new(NoiseTexture {
        space,
        kind: NoiseKind::Fbm {
            octaves: 1,
            roughness: 0.5,
        },
    }))
}

#[test]
fn the_albedo_of_a_diffuse_surface_is_the_same_under_any_map() {
    for n in NORMALS {
        let material = relief(bent_to(n), diffuse());
        let bsdf = material.bsdf(&plane(), &mut lambda());
        for wo in outgoing() {
            let albedo = integrate(|wi| bsdf.f(wo, wi, TransportMode::Radiance).0[0] * bsdf.abs_cos(wi));
            assert!((albedo - 0.8).abs() < 4e-3, "normal {n}, wo {wo}: {albedo}");
        }
    }
}

#[test]
fn a_metal_gains_no_energy_and_has_no_black_edge() {
    for n in NORMALS {
        let material = relief(bent_to(n), metal(0.5));
        let bsdf = material.bsdf(&plane(), &mut lambda());
        for wo in outgoing() {
            let albedo = integrate(|wi| bsdf.f(wo, wi, TransportMode::Radiance).0[0] * bsdf.abs_cos(wi));
            assert!((0.05..1.005).contains(&albedo), "normal {n}, wo {wo}: {albedo}");
        }
    }
}

#[test]
fn values_are_symmetric_and_nothing_leaks_through() {
    for n in NORMALS {
        for material in [diffuse(), metal(0.4)] {
            let material = relief(bent_to(n), material);
            let bsdf = material.bsdf(&plane(), &mut lambda());
            for wo in outgoing() {
                for i in 0..40 {
                    let wi = direction(0.05 + 0.075 * i as f32, 2.4 * i as f32);
                    let [there, back] = [(wo, wi), (wi, wo)].map(|(a, b)| bsdf.f(a, b, TransportMode::Radiance).0[0]);
                    assert!((there - back).abs() <= 1e-5 * there.max(back), "{there} and {back}");
                    assert!(wi.z > 0.0 || there == 0.0, "light leaks to {wi}");
                }
            }
        }
    }
}

/// The density over all directions is the fraction of samples that are any, and samples have the density and value that they say.
#[test]
fn samples_agree_with_the_density() {
    for n in NORMALS {
        for material in [diffuse(), metal(0.5)] {
            let material = relief(bent_to(n), material);
            let bsdf = material.bsdf(&plane(), &mut lambda());
            for wo in outgoing() {
                let (mut found, mut moments, side) = (0, Vec3::ZERO, 256);
                for i in 0..side * side {
                    let u = Vec2::new((i % side) as f32 + 0.5, (i / side) as f32 + 0.5) / side as f32;
                    // The golden ratio: independent of u, and even.
                    let u_lobe = (i as f32 * 0.618_034).fract();
                    let Some(sample) = bsdf.sample_f(wo, u_lobe, u, TransportMode::Radiance) else {
                        continue;
                    };
                    assert!(sample.wi.z > 0.0, "a sample goes through the surface");
                    found += 1;
                    moments += sample.wi / (side * side) as f32;
                    if i % 97 == 0 {
                        let Density::Continuous(pdf) = sample.density else {
                            panic!("a delta");
                        };
                        let value = bsdf.eval(wo, sample.wi, TransportMode::Radiance).expect("a value");
                        assert!((value.pdf.0 / pdf.0 - 1.0).abs() < 2e-3, "{value:?} and {pdf:?}");
                        assert!((value.f.0[0] / sample.value.0[0] - 1.0).abs() < 2e-3);
                    }
                }
                let pdf = |wi: Vec3| bsdf.pdf(wo, wi, TransportMode::Radiance).0;
                let (all, found) = (integrate(pdf), f64::from(found) / f64::from(side * side));
                assert!((all - found).abs() < 0.01, "normal {n}, wo {wo}: {all} and {found}");
                for axis in 0..3 {
                    let expected = integrate(|wi| wi[axis] * pdf(wi));
                    let error = (expected - f64::from(moments[axis])).abs();
                    assert!(error < 0.01, "normal {n}, wo {wo}: {expected} and {}", moments[axis]);
                }
            }
        }
    }
}

#[test]
fn a_slope_bends_the_normal_as_it_should() {
    // A height of u / 2 over x = 2 u: the slope is 1/4.
    let mapping = crate::texture::Mapping2::Uv {
        scale: Vec2::ONE,
        delta: Vec2::ZERO,
    };
    let ramp = FloatTexture::Bilerp(Arc::new(crate::texture::Bilerp {
        mapping,
        corners: [0.0, 0.0, 0.5, 0.5],
    }));
    let bent = ReliefMap::Displacement(ramp).bend(&plane()).expect("a slope");
    let expected = Vec3::new(-0.25, 0.0, 1.0).normalize();
    assert!((bent.ns - expected).length() < 1e-3, "{}", bent.ns);
    // On the inside of a turned surface too, the normal stays on its side.
    let mut inside = plane();
    (inside.ng, inside.ns) = (-Vec3::Z, -Vec3::Z);
    let map = bent_to(Vec3::new(0.3, 0.0, 1.0));
    let bent = map.bend(&inside).expect("a bent normal");
    assert!((bent.ns - Vec3::new(0.3, 0.0, -1.0).normalize()).length() < 1e-6);
}
