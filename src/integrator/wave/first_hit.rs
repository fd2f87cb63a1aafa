//! What camera rays meet first, for films that keep it.

use super::Wave;
use crate::camera::CameraSample;
use crate::desc::{FilmKind, GBufferSpace};
use crate::film::SurfaceSample;
use crate::geometry::SurfaceInteraction;
use crate::integrator::lane::Slot;
use crate::integrator::numbers::{DETECTOR_GROUP, FILM_GROUP};
use crate::integrator::stage::Estimator;
use crate::material::TransportMode;
use crate::math::{DAffine3, Vec2, Vec3};
use crate::sampling::SampleStream;
use crate::scene::{Scene, View};
use crate::spectrum::SampledSpectrum;

/// The surfaces that the slots of a wave see first, if the film wants them; else empty.
#[derive(Debug, Default)]
pub(super) struct FirstHits {
    surfaces: Vec<Option<SurfaceSample>>,
}

impl FirstHits {
    /// Forgets all, for a wave of so many slots.
    pub fn restart(&mut self, slots: usize, film: FilmKind) {
        self.surfaces.clear();
        if matches!(film, FilmKind::GBuffer(_)) {
            self.surfaces.resize(slots, None);
        }
    }

    /// Whether they are wanted.
    pub fn are_wanted(&self) -> bool {
        !self.surfaces.is_empty()
    }

    /// That of a slot.
    pub fn get(&self, slot: usize) -> Option<&SurfaceSample> {
        self.surfaces.get(slot)?.as_ref()
    }

    /// Notes what a slot sees.
    pub fn set(&mut self, slot: u32, surface: SurfaceSample) {
        self.surfaces[slot as usize] = Some(surface);
    }
}

/// Branches of a sample's numbers that the estimate of an albedo uses.
const ALBEDO_BRANCHES: [u32; 4] = [u32::MAX - 4, u32::MAX - 3, u32::MAX - 2, u32::MAX - 1];

/// What a film keeps of the surface that a camera sample, whose random numbers are `stream`, sees first.
pub(super) fn surface_sample(
    (scene, view): (&Scene, &View),
    space: GBufferSpace,
    slot: &Slot,
    stream: &SampleStream,
    si: &SurfaceInteraction,
) -> SurfaceSample {
    let from_world = match space {
        GBufferSpace::Camera => view.camera.camera_from_world(slot.time),
        GBufferSpace::World => DAffine3::IDENTITY,
    };
    // A normal goes by the inverse of the transpose.
    let matrix = from_world.matrix3;
    let normals = matrix.inverse().transpose() * matrix.determinant().signum();
    let normal = |n: Vec3| {
        let facing = if n.dot(si.wo) < 0.0 { -n } else { n };
        (normals * facing.as_dvec3()).normalize_or_zero().as_vec3()
    };
    SurfaceSample {
        albedo: albedo(scene, view, slot, stream, si),
        p: from_world.transform_point3(si.p.as_dvec3()).as_vec3(),
        dz: change_of_depth(view, &from_world, slot, stream, si),
        n: normal(si.ng),
        ns: normal(si.ns),
        uv: si.uv,
    }
}

/// The share of light that a surface scatters, from a few directions drawn from its BSDF; without the squeezing of radiance by refraction.
fn albedo(scene: &Scene, view: &View, slot: &Slot, stream: &SampleStream, si: &SurfaceInteraction) -> [f32; 3] {
    let mut lambda = slot.lambda;
    let bsdf = scene.material(si.hit.geometry).bsdf(si, &mut lambda);
    let mut sum = SampledSpectrum::ZERO;
    for branch in ALBEDO_BRANCHES {
        let stream = stream.branch(branch);
        let ([u, v], lobe) = (stream.draw2(FILM_GROUP), stream.draw1(DETECTOR_GROUP));
        let sample = bsdf.sample_f(si.wo, lobe, Vec2::new(u, v), TransportMode::Importance);
        sum += sample.map_or(SampledSpectrum::ZERO, |sample| sample.weight());
    }
    view.sensor
        .albedo_to_rgb(sum * (1.0 / ALBEDO_BRANCHES.len() as f32), &lambda)
}

/// How the z of positions changes on the tangent plane by a pixel to the right, and by one down: where the rays half a pixel to either side
/// meet it. 0 where they do not.
fn change_of_depth(
    view: &View,
    from_world: &DAffine3,
    slot: &Slot,
    stream: &SampleStream,
    si: &SurfaceInteraction,
) -> Vec2 {
    let [film_x, film_y, lens_x, lens_y] = stream.draw4(FILM_GROUP);
    let corner = Vec2::new(slot.pixel[0] as f32, slot.pixel[1] as f32);
    let film = corner + 0.5 + view.filter.sample(Vec2::new(film_x, film_y)).offset;
    let sample = CameraSample {
        film,
        lens: Vec2::new(lens_x, lens_y),
        time: 0.0,
    };
    let depth_at = |offset: Vec2| {
        let sample = CameraSample {
            film: film + offset,
            ..sample
        };
        let (ray, _) = view.camera.ray_at(&sample, slot.time)?;
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let n = si.ng.as_dvec3();
        let t = n.dot(si.p.as_dvec3() - origin) / n.dot(direction);
        let p = origin + direction * t;
        (t > 0.0 && p.is_finite()).then(|| from_world.transform_point3(p).z)
    };
    let change = |offset: Vec2| match (depth_at(offset), depth_at(-offset)) {
        (Some(after), Some(before)) => (after - before) as f32,
        _ => 0.0,
    };
    Vec2::new(change(Vec2::new(0.5, 0.0)), change(Vec2::new(0.0, 0.5)))
}

impl<E: Estimator> Wave<'_, E> {
    /// The space of what the film wants of first surfaces.
    pub(super) fn gbuffer_space(&self) -> GBufferSpace {
        match self.film.kind() {
            FilmKind::GBuffer(space) => space,
            FilmKind::Rgb | FilmKind::Spectral(_) => GBufferSpace::default(),
        }
    }
}
