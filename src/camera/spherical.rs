//! A camera at a point that sees all around, as pbrt-v4's: film positions are points of a map of the sphere.
//!
//! A direction is seen where the map has it, and, as pixel filters reach beyond the raster, on what continues the map there: by latitude and
//! longitude around the sphere and over the poles, by equal areas at the mirrored place of the same edge. All these positions have
//! the same density: one film position is one over the solid angle that it stands for. A connection to the camera takes one of
//! them at random.

use std::f32::consts::PI;

use super::importance::{CameraConnection, CameraDensity, CameraRay, RasterDomain};
use super::pose::Pose;
use crate::geometry::RayCone;
use crate::math::{Vec2, Vec3};
use crate::sampling::warp::equal_area_square_to_sphere;
use crate::sampling::{SolidAnglePdf, SphereMap};

/// The map and its size.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spherical {
    map: SphereMap,
    /// Pixels.
    size: Vec2,
}

/// Of the map's axes, whose pole is z, to the camera's, whose y is up.
fn swapped(v: Vec3) -> Vec3 {
    Vec3::new(v.x, v.z, v.y)
}

impl Spherical {
    pub fn new(map: SphereMap, resolution: [u32; 2]) -> Self {
        Self {
            map,
            size: Vec2::new(resolution[0] as f32, resolution[1] as f32),
        }
    }

    /// The direction that a film position means, unit length, in camera space.
    #[inline]
    pub fn direction(&self, film: Vec2) -> Vec3 {
        let uv = film / self.size;
        swapped(match self.map {
            SphereMap::EqualArea => equal_area_square_to_sphere(within_square(uv)),
            SphereMap::LatLong => {
                let ((sin, cos), (sin_phi, cos_phi)) = ((PI * uv.y).sin_cos(), (2.0 * PI * uv.x).sin_cos());
                Vec3::new(sin * cos_phi, sin * sin_phi, cos)
            }
        })
    }

    /// See [`super::Camera::ray_cone`].
    pub fn ray_cone(&self, film: Vec2, scale: f32) -> RayCone {
        let solid_angle = 1.0 / self.density(self.direction(film)).min(1e12);
        RayCone {
            width: 0.0,
            spread: scale * solid_angle.sqrt(),
        }
    }

    /// Pixels by solid angle around a direction of camera space.
    fn density(&self, direction: Vec3) -> f32 {
        let pixels = self.size.x * self.size.y;
        match self.map {
            SphereMap::EqualArea => pixels / (4.0 * PI),
            SphereMap::LatLong => {
                let sin = Vec2::new(direction.x, direction.z).length();
                pixels / (2.0 * PI * PI * sin.max(1e-12))
            }
        }
    }

    /// The film positions that mean the same as `film`, one of the raster, and lie next to it.
    fn images(&self, film: Vec2) -> [Vec2; 9] {
        let Vec2 { x: w, y: h } = self.size;
        let Vec2 { x, y } = film;
        match self.map {
            SphereMap::LatLong => {
                let half = 0.5 * w;
                let other = if x < half { x + half } else { x - half };
                let beside = |x: f32, y: f32| [Vec2::new(x - w, y), Vec2::new(x, y), Vec2::new(x + w, y)];
                let [rows, above, below] = [beside(x, y), beside(other, -y), beside(other, 2.0 * h - y)];
                [
                    rows[0], rows[1], rows[2], above[0], above[1], above[2], below[0], below[1], below[2],
                ]
            }
            SphereMap::EqualArea => {
                let mut images = [film; 9];
                for (i, image) in images.iter_mut().enumerate() {
                    let (column, row) = (i as i32 % 3 - 1, i as i32 / 3 - 1);
                    // Across an edge the other axis is turned around; across two edges both are, and what was turned is mirrored.
                    let mirrored = |c: f32, size: f32, step: i32| match step {
                        0 => c,
                        step if step < 0 => -c,
                        _ => 2.0 * size - c,
                    };
                    let (turned_x, turned_y) = (if row == 0 { x } else { w - x }, if column == 0 { y } else { h - y });
                    *image = Vec2::new(mirrored(turned_x, w, column), mirrored(turned_y, h, row));
                }
                images
            }
        }
    }

    /// See [`super::Camera::sample_wi`].
    pub fn sample_wi(&self, pose: &Pose, p: Vec3, u_lens: Vec2, domain: &RasterDomain) -> Option<CameraConnection> {
        let ray = self.pdf_we(pose, p)?;
        let images = self.images(ray.film);
        let mut seen = [Vec2::ZERO; 9];
        let mut count = 0;
        for film in images.into_iter().filter(|&film| domain.contains(film)) {
            seen[count] = film;
            count += 1;
        }
        if count == 0 {
            return None;
        }
        let film = seen[((u_lens.x * count as f32) as usize).min(count - 1)];
        let eye = pose.frame.point(Vec3::ZERO);
        let wi = (eye - p).normalize();
        Some(CameraConnection {
            // One of several is taken for all.
            ray: CameraRay {
                film,
                importance: ray.importance * count as f32,
                ..ray
            },
            wi,
            end: eye,
            lens: eye,
            normal: -wi,
            density: CameraDensity::Delta,
        })
    }

    /// See [`super::Camera::pdf_we`]. The film position is the one on the raster.
    pub fn pdf_we(&self, pose: &Pose, p: Vec3) -> Option<CameraRay> {
        let local = pose.camera_from_world.transform_point3(p.as_dvec3());
        let distance = local.length();
        let direction = (local / distance).as_vec3();
        if !direction.is_finite() {
            return None;
        }
        // Solid angles grow by the volume over the cube of the length that a unit has become.
        let length = pose.frame.vector(direction).length();
        let density = self.density(direction) * length.powi(3) / pose.volume;
        let world_distance = length * distance as f32;
        Some(CameraRay {
            film: self.map.point(swapped(direction)) * self.size,
            we: density,
            importance: 1.0,
            position: CameraDensity::Delta,
            direction: CameraDensity::Continuous(SolidAnglePdf(density)),
            arrival: SolidAnglePdf(density).to_area(world_distance * world_distance, 1.0),
        })
    }
}

/// The point of the unit square that continues it at a point outside, which is at most one away.
fn within_square(uv: Vec2) -> Vec2 {
    let Vec2 { mut x, mut y } = uv;
    if !(0.0..=1.0).contains(&x) {
        x = if x < 0.0 { -x } else { 2.0 - x };
        y = 1.0 - y;
    }
    if !(0.0..=1.0).contains(&y) {
        y = if y < 0.0 { -y } else { 2.0 - y };
        x = 1.0 - x;
    }
    Vec2::new(x, y).clamp(Vec2::ZERO, Vec2::ONE)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAMERAS: [(SphereMap, [u32; 2]); 2] = [(SphereMap::EqualArea, [16, 16]), (SphereMap::LatLong, [32, 16])];

    #[test]
    fn all_images_of_a_film_position_mean_the_same_direction() {
        for (map, resolution) in CAMERAS {
            let camera = Spherical::new(map, resolution);
            for i in 0..400 {
                let u = Vec2::new((i as f32 * 0.618_034).fract(), (i as f32 * 0.754_878).fract());
                let film = u * camera.size;
                let direction = camera.direction(film);
                assert!((direction.length() - 1.0).abs() < 1e-6);
                assert!((map.point(swapped(direction)) - u).length() < 1e-4, "{map:?} {u}");
                for image in camera.images(film) {
                    // Only what is at most one raster away is asked for.
                    let inside = image.cmpge(-camera.size).all() && image.cmple(camera.size * 2.0).all();
                    let there = camera.direction(image);
                    assert!(
                        !inside || (there - direction).length() < 1e-3,
                        "{map:?} {film} {image}: {direction} {there}"
                    );
                }
            }
        }
    }

    #[test]
    fn known_directions_are_those_of_pbrt() {
        let near = |a: Vec3, b: Vec3| (a - b).length() < 1e-6;
        let [equal_area, lat_long] = CAMERAS.map(|(map, resolution)| Spherical::new(map, resolution));
        assert!(near(lat_long.direction(Vec2::new(0.0, 8.0)), Vec3::X));
        assert!(near(lat_long.direction(Vec2::new(8.0, 8.0)), Vec3::Z));
        assert!(near(lat_long.direction(Vec2::new(5.0, 0.0)), Vec3::Y));
        assert!(near(equal_area.direction(Vec2::new(8.0, 8.0)), Vec3::Y));
        assert!(near(equal_area.direction(Vec2::new(16.0, 8.0)), Vec3::X));
    }
}
