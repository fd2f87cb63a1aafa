//! A camera that looks through the lenses of a table, as pbrt-v4's `realistic` (Kolb, Mitchell and Hanrahan 1995; Steinert et al. 2011).
//!
//! The film is at z = 0 in camera space and the lenses are before it. A camera ray starts at a point of the film, goes to a point of the exit
//! pupil, drawn on the plane of the rear lens, and on through all surfaces; many do not come through. Lengths are in metres.

mod lens;
mod pupil;
mod stop;

use self::lens::Lens;
use self::pupil::Pupil;
use self::stop::Stop;
use super::CameraSample;
use crate::desc::RealisticDesc;
use crate::geometry::RayCone;
use crate::math::{DVec3, Vec2, Vec3};

/// What a realistic camera is made of.
#[derive(Clone, Copy, Debug)]
pub struct RealisticSpec<'a> {
    /// The lenses, the aperture stop and the distance of what is in focus.
    pub desc: &'a RealisticDesc,
    /// From corner to corner of the film, in metres.
    pub film_diagonal: f64,
    /// Pixels of the whole picture.
    pub resolution: [u32; 2],
}

/// Lenses, focused, with a film behind them.
#[derive(Clone, Debug)]
pub struct Realistic {
    lens: Lens,
    stop: Stop,
    pupil: Pupil,
    /// Width and height of the film.
    film: [f64; 2],
    resolution: Vec2,
    /// From the film to the plane where, seen from there, the lenses are.
    image_distance: f64,
}

impl Realistic {
    /// Focuses the lenses and finds what of them the film sees.
    ///
    /// # Errors
    /// A message if the lenses cannot be focused, or no light comes through them.
    pub fn new(spec: &RealisticSpec<'_>) -> Result<Self, String> {
        let [width, height] = spec.resolution.map(f64::from);
        let aspect = height / width;
        let x = spec.film_diagonal / (1.0 + aspect * aspect).sqrt();
        let mut lens = Lens::new(spec.desc);
        let image_distance = lens.focus(spec.desc.focus_distance, spec.film_diagonal)?;
        let pupil = Pupil::new(&lens, 0.5 * spec.film_diagonal)
            .ok_or("no light comes through these lenses to the film: is the aperture too small?")?;
        Ok(Self {
            stop: Stop::new(&spec.desc.shape),
            lens,
            pupil,
            film: [x, aspect * x],
            resolution: Vec2::new(width as f32, height as f32),
            image_distance,
        })
    }

    /// Origin, on the front lens, direction and weight of the ray of a sample, in camera space. `None` if it does not come through.
    pub(super) fn ray(&self, sample: &CameraSample) -> Option<(Vec3, Vec3, f32)> {
        let s = (sample.film / self.resolution - 0.5).as_dvec2();
        // The picture on the film is upside down.
        let film = DVec3::new(-s.x * self.film[0], s.y * self.film[1], 0.0);
        let (rear, area) = self.pupil.sample(film.truncate(), sample.lens)?;
        let rear_z = self.lens.rear_z();
        let direction = rear.extend(rear_z) - film;
        let (origin, out, passed) = self.lens.trace_from_film(film, direction, &self.stop)?;
        let cos = direction.z / direction.length();
        let weight = passed * cos.powi(4) * area / (rear_z * rear_z);
        Some((origin.as_vec3(), out.as_vec3(), weight as f32))
    }

    /// See [`super::Camera::ray_cone`].
    pub(super) fn ray_cone(&self, scale: f32) -> RayCone {
        let pixel = self.film[0] as f32 / self.resolution.x;
        RayCone {
            width: 0.0,
            spread: scale * pixel / self.image_distance as f32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::desc::{LensSurface, StopShape};

    /// A thin plano-convex lens of focal length 50 mm behind a stop of 2 mm.
    fn simple(focus_distance: f64, shape: StopShape) -> RealisticDesc {
        let surface = |radius, thickness, eta, diameter| LensSurface {
            radius,
            thickness,
            eta,
            diameter,
        };
        RealisticDesc {
            surfaces: vec![
                surface(0.0, 0.01, 1.0, 2.0),
                surface(25.0, 1.0, 1.5, 12.0),
                surface(-1e9, 50.0, 1.0, 12.0),
            ],
            focus_distance,
            shape,
        }
    }

    fn camera(desc: &RealisticDesc) -> Realistic {
        let spec = RealisticSpec {
            desc,
            film_diagonal: 0.01,
            resolution: [80, 60],
        };
        Realistic::new(&spec).expect("a lens")
    }

    fn sample(x: f32, y: f32, i: usize) -> CameraSample {
        let lens = Vec2::new((i as f32 * 0.618_034).fract(), (i as f32 * 0.754_878).fract());
        CameraSample {
            film: Vec2::new(x, y),
            lens,
            time: 0.0,
        }
    }

    #[test]
    fn rays_meet_at_the_distance_of_focus() {
        let camera = camera(&simple(2.0, StopShape::Round));
        // 1 / f = 1 / 2 + 1 / image distance, from the film to the thing.
        assert!(
            (camera.image_distance - 0.0513).abs() < 2e-4,
            "{}",
            camera.image_distance
        );
        // Near the axis: farther out a single lens is not sharp.
        for (x, y) in [(40.0, 30.0), (37.0, 32.0)] {
            let rays: Vec<_> = (0..400).filter_map(|i| camera.ray(&sample(x, y, i))).collect();
            assert!(rays.len() > 100, "{}", rays.len());
            let at = |&(origin, direction, _): &(Vec3, Vec3, f32), z: f32| {
                origin + direction * ((z - origin.z) / direction.z)
            };
            let spread = |z: f32| {
                let points: Vec<Vec3> = rays.iter().map(|ray| at(ray, z)).collect();
                let mean = points.iter().sum::<Vec3>() / points.len() as f32;
                points.iter().map(|&p| (p - mean).length()).fold(0.0, f32::max)
            };
            // Sharper there than on the lens, and than before and after it.
            assert!(spread(2.0) < 2e-4, "{}", spread(2.0));
            assert!(
                spread(1.0) > 4e-4 && spread(4.0) > 8e-4,
                "{} {}",
                spread(1.0),
                spread(4.0)
            );
        }
        // What is at the upper left of the picture is to the left and above.
        let (_, direction, _) = (0..100).find_map(|i| camera.ray(&sample(0.0, 0.0, i))).expect("a ray");
        assert!(direction.x < 0.0 && direction.y > 0.0, "{direction}");
        let tan = 0.004 / camera.image_distance as f32;
        assert!((direction.x / direction.z + tan).abs() < 2e-3);
    }

    /// The mean weight is the solid angle that the aperture has from the film, times cos to the fourth, over one of a square radian: for
    /// any shape, which are as bright as the round one.
    #[test]
    fn the_weight_is_the_aperture() {
        for (shape, error) in [
            (StopShape::Round, 0.01),
            (StopShape::Square, 0.02),
            (StopShape::Gaussian, 0.02),
            (StopShape::Pentagon, 0.03),
            (StopShape::Star, 0.03),
        ] {
            let camera = camera(&simple(2.0, shape.clone()));
            const N: usize = 40_000;
            let sum: f64 = (0..N)
                .filter_map(|i| camera.ray(&sample(40.0, 30.0, i)))
                .map(|(_, _, weight)| f64::from(weight))
                .sum();
            // The pupil is the stop itself, nearly: a circle of 1 mm at the distance of the lens.
            let expected = std::f64::consts::PI * (0.001 / camera.image_distance).powi(2);
            let mean = sum / N as f64;
            assert!(
                (mean / expected - 1.0).abs() < error,
                "{shape:?}: {mean} and {expected}"
            );
        }
    }

    #[test]
    fn lenses_that_cannot_be_focused_are_refused() {
        let spec = |desc| RealisticSpec {
            desc,
            film_diagonal: 0.01,
            resolution: [80, 60],
        };
        let near = simple(0.1, StopShape::Round);
        assert!(Realistic::new(&spec(&near)).is_err_and(|e| e.contains("too near")));
        let mut closed = simple(2.0, StopShape::Round);
        closed.surfaces[1].diameter = 1e-9;
        assert!(Realistic::new(&spec(&closed)).is_err());
    }
}
