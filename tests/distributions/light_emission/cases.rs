//! Lights of every kind, with what is known of their flux and a receiver that they shine on.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3, Vec2, Vec3};
use lucerna::geometry::Sphere;
use lucerna::light::{
    AreaLight, Behind, Coordinates, DistantLight, EmissionImage, EmissionSample, EmitterShape, EnvironmentLight,
    GoniometricLight, ImageEnvironment, Light, MovingEmitter, Place, PointLight, Portal, PortalEnvironment,
    ProjectionLight, Side, SpotLight,
};
use lucerna::math::{AnimatedTransform, Bounds3};
use lucerna::sampling::warp;
use lucerna::spectrum::{ColorMode, CompiledSpectrum, RgbEmission, Spectrum, SpectrumRole, Wavelengths, cie};
use lucerna::texture::{Bilerp, FloatTexture, Mapping2};

use crate::common::random::Random;

pub const SCENE: Bounds3 = Bounds3 {
    min: Vec3::splat(-2.0),
    max: Vec3::splat(2.0),
};

/// A disk that counts what comes to its front.
#[derive(Clone, Copy)]
pub struct Receiver {
    pub center: Vec3,
    pub normal: Vec3,
    pub radius: f32,
}

pub const ABOVE: Receiver = Receiver {
    center: Vec3::new(0.3, -0.2, 1.6),
    normal: Vec3::new(0.0, 0.6, -0.8),
    radius: 0.9,
};

const BELOW: Receiver = Receiver {
    center: Vec3::new(-0.1, 0.2, -1.2),
    normal: Vec3::new(0.6, 0.0, 0.8),
    radius: 0.9,
};

/// In the middle of what a stretched projection shows.
const AHEAD_STRETCHED: Receiver = Receiver {
    center: Vec3::new(0.0, -1.0, 1.2),
    normal: Vec3::new(0.0, 0.6, -0.8),
    radius: 0.8,
};

/// In the middle of what a projection shows.
const AHEAD: Receiver = Receiver {
    center: Vec3::new(0.1, 1.3, 1.7),
    normal: Vec3::new(0.0, -0.6, -0.8),
    radius: 0.8,
};

pub struct Case {
    pub name: &'static str,
    pub light: Light,
    pub time: f32,
    /// All that leaves the light, where it is known, and how precisely (relative).
    pub flux: Option<(f64, f64)>,
    pub receiver: Receiver,
    /// Whether a ray may carry nothing.
    pub dark: bool,
}

impl Case {
    /// Whose power is `unit` times its flux.
    fn of_power(name: &'static str, light: Light, unit: f32, receiver: Receiver) -> Self {
        Self {
            name,
            flux: Some((f64::from(light.power(&SCENE) / unit), 1e-4)),
            light,
            time: 0.0,
            receiver,
            dark: false,
        }
    }

    /// Of a radiance or an intensity that [`constant`] says.
    pub fn new(name: &'static str, light: Light, receiver: Receiver) -> Self {
        Self::of_power(name, light, cie::y_integral(), receiver)
    }

    fn with_flux(self, flux: Option<(f64, f64)>) -> Self {
        Self { flux, ..self }
    }

    pub fn sample_le(&self, random: &mut Random) -> Option<EmissionSample> {
        let [a, b, c, d] = random.unit4();
        let (u_position, u_direction) = (Vec2::new(a, b), Vec2::new(c, d));
        self.light
            .sample_le(self.time, u_position, u_direction, &Wavelengths::rgb(), &SCENE)
    }
}

pub fn constant(value: f32) -> CompiledSpectrum {
    Spectrum::constant(value).compile(ColorMode::Spectral, SpectrumRole::Emission)
}

/// Grey pixels between 0 and 2, a third of them black.
pub fn image(size: [usize; 2]) -> EmissionImage {
    let rgb: Vec<[f32; 3]> = factors(size[0] * size[1]).into_iter().map(|f| [f; 3]).collect();
    EmissionImage::new(&rgb, size[0], RgbEmission::new(ColorMode::Rgb)).expect("pixels")
}

fn factors(count: usize) -> Vec<f32> {
    let mut random = Random::new(3);
    (0..count).map(|_| (3.0 * random.unit() - 1.0).max(0.0)).collect()
}

pub const CORNERS: [Vec3; 3] = [
    Vec3::new(-0.7, -0.5, 0.2),
    Vec3::new(0.8, -0.3, -0.1),
    Vec3::new(-0.1, 0.6, 0.1),
];

const UVS: [Vec2; 3] = [Vec2::new(0.1, 0.0), Vec2::new(1.2, 0.2), Vec2::new(0.3, 0.9)];

pub fn triangle(two_sided: bool) -> AreaLight {
    let [a, b, c] = CORNERS;
    let ng = (b - a).cross(c - a).normalize();
    let shape = EmitterShape::Triangle { vertices: CORNERS, ng };
    AreaLight::new(shape, constant(2.0), two_sided).expect("not degenerate")
}

fn sphere(radius: f64, inward: bool) -> Light {
    let center = DVec3::new(0.1, 0.2, -0.1);
    let shape = EmitterShape::Sphere { center, radius, inward };
    Light::Area(AreaLight::new(shape, constant(2.0), false).expect("a sphere has an area"))
}

fn ellipsoid() -> Sphere {
    let transform = DAffine3::from_rotation_x(0.4) * DAffine3::from_scale(DVec3::new(0.9, 0.3, 0.5));
    Sphere::new(0.9, transform).expect("not singular")
}

pub fn motion() -> AnimatedTransform {
    let turn = DAffine3::from_rotation_y(1.1) * DAffine3::from_translation(DVec3::new(0.3, -0.2, 0.2));
    AnimatedTransform::new(DAffine3::IDENTITY, turn).expect("a motion")
}

fn surfaces() -> Vec<Case> {
    let parallelogram = EmitterShape::Parallelogram {
        corner: CORNERS[0],
        edges: [CORNERS[1] - CORNERS[0], CORNERS[2] - CORNERS[0]],
        ng: -(CORNERS[1] - CORNERS[0]).cross(CORNERS[2] - CORNERS[0]).normalize(),
    };
    let parallelogram = AreaLight::new(parallelogram, constant(2.0), false).expect("not degenerate");
    let alpha = |alpha: f32| Light::Area(triangle(false).with_alpha(alpha));
    let whole = f64::from(triangle(false).area()) * 2.0 * PI;
    let ramp = |[a, b]: [f32; 2]| {
        FloatTexture::Bilerp(Arc::new(Bilerp {
            mapping: Mapping2::Uv {
                scale: Vec2::ONE,
                delta: Vec2::ZERO,
            },
            corners: [a, b, a, b],
        }))
    };
    // On average over a triangle v is that of its middle, and over a sphere 1/2.
    let cut = triangle(true).with_alpha_texture(ramp([0.1, 0.7]), Coordinates::Corners(UVS));
    let cut_flux = 2.0 * whole * (0.1 + 0.6 * f64::from(UVS[0].y + UVS[1].y + UVS[2].y) / 3.0);
    let ball = AreaLight::sphere(&Sphere::at(DVec3::ZERO, 0.6).expect("a sphere"), constant(2.0), false);
    let ball = ball.expect("an area");
    let ball_flux = 0.6 * 2.0 * PI * f64::from(ball.area());
    let ball = ball.with_alpha_texture(ramp([0.2, 1.0]), Coordinates::Sphere(DMat3::IDENTITY));
    let ellipsoid = AreaLight::sphere(&ellipsoid(), constant(2.0), true).expect("an area");
    vec![
        Case::new("triangle", Light::Area(triangle(false)), ABOVE),
        Case::new("two sides, above", Light::Area(triangle(true)), ABOVE),
        Case::new("two sides, below", Light::Area(triangle(true)), BELOW),
        Case::new("parallelogram", Light::Area(parallelogram), BELOW),
        Case::new("sphere", sphere(0.5, false), ABOVE),
        Case::new("sphere around", sphere(3.0, true), ABOVE),
        Case::new("ellipsoid", Light::Area(ellipsoid), BELOW),
        Case::new("alpha", alpha(0.25), ABOVE),
        Case::new("alpha by its flux", alpha(0.25), ABOVE).with_flux(Some((0.25 * whole, 1e-4))),
        Case::new("alpha by a texture", Light::Area(cut.clone()), BELOW),
        Case::new("alpha by a texture", Light::Area(cut), ABOVE).with_flux(Some((cut_flux, 1e-4))),
        Case::new("a ball with alpha", Light::Area(ball), ABOVE).with_flux(Some((ball_flux, 1e-4))),
        Case::new("invisible", alpha(0.0), ABOVE).with_flux(Some((whole, 1e-4))),
    ]
}

/// Centre and radius of a sphere before it moves.
pub const BALL: (DVec3, f64) = (DVec3::new(0.2, 0.1, 0.0), 0.6);

fn ball() -> Sphere {
    Sphere::at(BALL.0, BALL.1).expect("a sphere")
}

fn moving_sphere(sphere: Sphere) -> AreaLight {
    AreaLight::moving(MovingEmitter::sphere(sphere, motion()), constant(2.0), false).expect("an area")
}

/// The ball with the image of 8 x 4 pixels.
pub fn painted_ball() -> Case {
    let painted = moving_sphere(ball()).with_image(image([8, 4]).into(), Coordinates::Sphere(DMat3::IDENTITY));
    Case {
        dark: true,
        ..Case::new("moving painted sphere", Light::Area(painted), ABOVE).with_flux(None)
    }
}

/// Emitters at several times; the flux is that of the area then.
fn moving() -> Vec<Case> {
    let mut cases = Vec::new();
    for time in [0.4, 1.0] {
        let steps = vec![CORNERS, CORNERS.map(|v| v * 1.5)];
        let emitter = MovingEmitter::triangle(steps, Side::Orientation(true), motion());
        let light = AreaLight::moving(emitter, constant(2.0), false).expect("an area");
        let area = f64::from(light.area()) * (1.0 + 0.5 * f64::from(time)).powi(2);
        let below = Case::new("moving triangle", Light::Area(light), BELOW);
        cases.push(below.with_flux(Some((2.0 * PI * area, 1e-4))));

        cases.push(Case::new(
            "moving ellipsoid",
            Light::Area(moving_sphere(ellipsoid())),
            ABOVE,
        ));
        cases.push(Case::new("moving sphere", Light::Area(moving_sphere(ball())), ABOVE));
        cases.push(painted_ball());
        for case in cases.iter_mut().rev().take(4) {
            case.time = time;
        }
    }
    cases
}

fn images() -> Vec<Case> {
    let painted = triangle(true).with_image(image([8, 4]).into(), Coordinates::Corners(UVS));
    const STEPS: usize = 256;
    let luminance = (0..STEPS * STEPS).map(|i| {
        let u = (Vec2::new((i % STEPS) as f32, (i / STEPS) as f32) + 0.5) / STEPS as f32;
        let b = warp::sample_uniform_triangle(u);
        f64::from(image([8, 4]).luminance_bilinear(UVS[0] * b.x + UVS[1] * b.y + UVS[2] * b.z))
    });
    let mean = luminance.sum::<f64>() / (STEPS * STEPS) as f64;
    let flux = 2.0 * PI * f64::from(painted.area()) * mean;
    let painted = Case {
        dark: true,
        ..Case::new("painted triangle", Light::Area(painted), BELOW).with_flux(Some((flux, 1e-3)))
    };
    let stretched = DAffine3::from_rotation_x(0.7) * DAffine3::from_scale(DVec3::new(1.0, 0.5, 2.0));
    let stretched = || {
        Place::new(
            AnimatedTransform::fixed(stretched).expect("invertible"),
            DAffine3::IDENTITY,
        )
    };
    let at = || Place::facing(DVec3::new(0.1, 0.2, 0.3), DVec3::new(0.0, 0.6, 0.8));
    let goniometric =
        |place| Light::Goniometric(GoniometricLight::new(place, constant(2.0), factors(64)).expect("a square"));
    let projection = |place| Light::Projection(ProjectionLight::new(place, image([6, 4]), 1.2));
    vec![
        painted,
        Case::new("goniometric", goniometric(at()), ABOVE),
        Case::new("stretched goniometric", goniometric(stretched()), BELOW).with_flux(None),
        Case::of_power("projection", projection(at()), 1.0, AHEAD),
        Case::of_power("stretched projection", projection(stretched()), 1.0, AHEAD_STRETCHED).with_flux(None),
    ]
}

fn points() -> Vec<Case> {
    let place = || Place::facing(DVec3::new(0.1, 0.2, 0.3), DVec3::new(0.0, -0.28, 0.96));
    let spot = |start, end| Light::Spot(SpotLight::new(place(), constant(2.0), start, end));
    let point = Light::Point(PointLight::new(Place::at_point(Vec3::splat(0.2)), constant(2.0)));
    let distant = Light::Distant(DistantLight::new(place(), constant(2.0)));
    vec![
        Case::new("point", point, BELOW),
        Case::new("spot", spot(0.3, 1.1), ABOVE),
        Case::new("soft spot", spot(0.0, 0.7), ABOVE),
        Case::new("sharp spot", spot(0.6, 0.6), ABOVE),
        Case::new("distant", distant, BELOW),
    ]
}

fn environments() -> Vec<Case> {
    let sky = |size, scale: DVec3| {
        let turned = DAffine3::from_rotation_x(0.7) * DAffine3::from_rotation_z(2.1) * DAffine3::from_scale(scale);
        let place = Place::new(
            AnimatedTransform::fixed(turned).expect("invertible"),
            DAffine3::IDENTITY,
        );
        let sky = ImageEnvironment::new(place, image(size)).expect("a map of the sphere");
        Light::Environment(EnvironmentLight::Image(Box::new(sky)))
    };
    let corner = |x, y| Vec3::new(x, y, 1.0);
    let corners = [
        corner(-1.0, -1.0),
        corner(-1.0, 1.0),
        corner(0.5, 1.0),
        corner(0.5, -1.0),
    ];
    let portal = |behind| {
        let portal = Portal::new(corners).expect("a rectangle");
        Light::Environment(EnvironmentLight::Portal(Box::new(PortalEnvironment::new(
            portal, behind,
        ))))
    };
    let window = Case::new("portal", portal(Behind::Constant(constant(2.0))), BELOW);
    let image_behind = Case::of_power("portal with an image", portal(Behind::Image(image([8, 8]))), 1.0, BELOW);
    vec![
        Case::new(
            "environment",
            Light::Environment(EnvironmentLight::Constant(constant(2.0))),
            ABOVE,
        ),
        Case::of_power("square sky", sky([8, 8], DVec3::ONE), 1.0, BELOW),
        Case::of_power("wide sky", sky([16, 8], DVec3::ONE), 1.0, ABOVE),
        Case::of_power("stretched sky", sky([8, 8], DVec3::new(1.0, 0.8, 1.3)), 1.0, BELOW).with_flux(None),
        window.with_flux(Some((2.0 * PI * 3.0, 1e-4))),
        image_behind,
    ]
}

pub fn cases() -> Vec<Case> {
    [surfaces(), moving(), images(), points(), environments()]
        .into_iter()
        .flatten()
        .collect()
}
