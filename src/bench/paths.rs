//! The rays of a path tracer through a synthetic world, every surface of which is diffuse: waves of 32 x 32 pixels, camera rays in
//! blocks of 4 x 2, then bounce by bounce, a shadow ray from each vertex; and paths from the lamp.

use super::streams::{Stream, StreamKind, Waves, sort};
use super::synthetic::{Numbers, Synthetic};
use crate::accel::Accel;
use crate::geometry::{HitPacket, LANES, Ray, RayQueue, SurfaceInteraction};
use crate::math::Vec3;

/// Pixels of a wave along each axis.
const TILE: usize = 32;
/// Pixels of a packet of camera rays.
const BLOCK: [usize; 2] = [4, 2];
/// Bounces of a path.
const BOUNCES: u32 = 4;

/// The streams of paths through a picture of as many tiles as give about `rays` camera rays, with random numbers from `seed`. Hits are
/// found by `accel`.
pub fn trace(scene: &Synthetic, accel: &dyn Accel, rays: usize, seed: u64) -> Vec<Stream> {
    let numbers = &mut Numbers::new(seed);
    let tiles = ((rays / (TILE * TILE)) as f64).sqrt().ceil().max(1.0) as usize;
    let mut waves: Vec<(StreamKind, Waves)> = Vec::new();
    for tile in 0..tiles * tiles {
        let corner = [tile % tiles * TILE, tile / tiles * TILE];
        let mut rays = camera_rays(scene, corner, tiles * TILE, numbers);
        let mut kind = StreamKind::Camera;
        for bounce in 1..=BOUNCES + 1 {
            if rays.is_empty() {
                break;
            }
            waves.push((kind, vec![rays.packets().to_vec()]));
            let (shadows, next) = scatter(scene, accel, kind, &rays, numbers);
            waves.push((StreamKind::Shadow, vec![shadows.packets().to_vec()]));
            rays = next;
            kind = StreamKind::Bounce(bounce.min(super::streams::DEEPEST));
        }
        let mut rays = lamp_rays(scene, numbers);
        for _ in 0..BOUNCES {
            if rays.is_empty() {
                break;
            }
            waves.push((StreamKind::Photon, vec![rays.packets().to_vec()]));
            rays = scatter(scene, accel, StreamKind::Photon, &rays, numbers).1;
        }
    }
    sort(waves, rays)
}

fn camera_rays(scene: &Synthetic, corner: [usize; 2], size: usize, numbers: &mut Numbers) -> RayQueue {
    let forward = (scene.target - scene.eye).normalize();
    let right = forward.cross(Vec3::Y).normalize();
    let up = right.cross(forward);
    let mut queue = RayQueue::default();
    for y in (0..TILE).step_by(BLOCK[1]) {
        for x in (0..TILE).step_by(BLOCK[0]) {
            for lane in 0..LANES {
                let pixel = [x + lane % BLOCK[0] + corner[0], y + lane / BLOCK[0] + corner[1]];
                let [px, py] = pixel.map(|p| (p as f32 + numbers.unit()) / size as f32 * 2.0 - 1.0);
                let direction = (forward + 0.24 * (px * right - py * up)).normalize();
                queue.push(&Ray::new(scene.eye, direction, 0.0));
            }
        }
    }
    queue
}

/// From points of the lamp, downwards, by the cosine.
fn lamp_rays(scene: &Synthetic, numbers: &mut Numbers) -> RayQueue {
    let ray = |_| {
        let direction = (Vec3::NEG_Y + numbers.direction()).normalize_or(Vec3::NEG_Y);
        let origin = lamp_point(scene, numbers) - Vec3::new(0.0, 1e-4, 0.0);
        Ray::new(origin, direction, 0.0)
    };
    (0..TILE * TILE).map(ray).collect()
}

fn lamp_point(scene: &Synthetic, numbers: &mut Numbers) -> Vec3 {
    let [corner, e, f] = scene.lamp;
    corner + e * numbers.unit() + f * numbers.unit()
}

/// The shadow rays and the next bounce.
fn scatter(
    scene: &Synthetic,
    accel: &dyn Accel,
    kind: StreamKind,
    rays: &RayQueue,
    numbers: &mut Numbers,
) -> (RayQueue, RayQueue) {
    let mut hits = vec![HitPacket::EMPTY; rays.packets().len()];
    accel.intersect(kind.ray_kind(), rays.packets(), &mut hits, None);
    let (mut shadows, mut next) = (RayQueue::default(), RayQueue::default());
    for (packet, hits) in rays.packets().iter().zip(&hits) {
        for lane in 0..LANES {
            let Some(hit) = hits.get(lane) else { continue };
            let surface = scene.world.interaction(&packet.get(lane), hit);
            let n = facing(&surface);
            next.push(&surface.spawn_ray((n + numbers.direction()).normalize_or(n)));
            let lamp = lamp_point(scene, numbers);
            if (lamp - surface.p).dot(n) > 0.0 {
                let mut ray = surface.spawn_ray(lamp - surface.p);
                ray.tfar = 0.999;
                shadows.push(&ray);
            }
        }
    }
    (shadows, next)
}

/// The normal on the side that was hit.
fn facing(surface: &SurfaceInteraction) -> Vec3 {
    if surface.wo.dot(surface.ng) < 0.0 {
        -surface.ng
    } else {
        surface.ng
    }
}
