//! Streams of rays as a path tracer shoots them: waves of 32 x 32 pixels, camera rays in blocks of 4 x 2, then bounce by bounce.

use super::synthetic::{Numbers, Synthetic};
use crate::accel::{Accel, RayKind};
use crate::geometry::{HitPacket, LANES, Ray, RayPacket, RayQueue};
use crate::math::Vec3;

/// Pixels of a wave along each axis.
const TILE: usize = 32;
/// Pixels of a packet of camera rays.
const BLOCK: [usize; 2] = [4, 2];

/// Rays of one kind, by wave.
pub type Waves = Vec<Vec<RayPacket>>;

/// The streams of a render.
#[derive(Clone, Debug, Default)]
pub struct Streams {
    /// By [`RayKind::ALL`].
    pub waves: [Waves; 3],
}

impl Streams {
    /// The waves of a kind.
    pub fn of(&self, kind: RayKind) -> &Waves {
        &self.waves[index(kind)]
    }
}

fn index(kind: RayKind) -> usize {
    match kind {
        RayKind::Camera => 0,
        RayKind::Shadow => 1,
        RayKind::Bounce => 2,
    }
}

/// The rays of paths of at most `bounces` bounces through a picture of `tiles` x `tiles` tiles, every surface being diffuse; one
/// shadow ray from each of their vertices. The hits are found by `accel`.
pub fn synthetic(scene: &Synthetic, accel: &dyn Accel, tiles: usize, bounces: usize) -> Streams {
    let mut streams = Streams::default();
    let numbers = &mut Numbers::new(7);
    for tile in 0..tiles * tiles {
        let corner = [tile % tiles * TILE, tile / tiles * TILE];
        let mut rays = camera_rays(scene, corner, tiles * TILE, numbers);
        for bounce in 0..=bounces {
            let kind = if bounce == 0 { RayKind::Camera } else { RayKind::Bounce };
            if rays.is_empty() {
                break;
            }
            streams.waves[index(kind)].push(rays.packets().to_vec());
            let (shadows, next) = scatter(scene, accel, kind, &rays, numbers);
            if !shadows.is_empty() {
                streams.waves[index(RayKind::Shadow)].push(shadows.packets().to_vec());
            }
            rays = next;
        }
    }
    streams
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

/// The shadow rays and the next bounce.
fn scatter(
    scene: &Synthetic,
    accel: &dyn Accel,
    kind: RayKind,
    rays: &RayQueue,
    numbers: &mut Numbers,
) -> (RayQueue, RayQueue) {
    let mut hits = vec![HitPacket::EMPTY; rays.packets().len()];
    accel.intersect(kind, rays.packets(), &mut hits, None);
    let (mut shadows, mut next) = (RayQueue::default(), RayQueue::default());
    for (packet, hits) in rays.packets().iter().zip(&hits) {
        for lane in 0..LANES {
            let Some(hit) = hits.get(lane) else { continue };
            let surface = scene.world.interaction(&packet.get(lane), hit);
            let n = if surface.wo.dot(surface.ng) < 0.0 {
                -surface.ng
            } else {
                surface.ng
            };
            let direction = (n + numbers.direction()).normalize_or(n);
            next.push(&surface.spawn_ray(direction));
            let [lamp, e, f] = scene.lamp;
            let lamp = lamp + e * numbers.unit() + f * numbers.unit();
            if (lamp - surface.p).dot(n) > 0.0 {
                let mut ray = surface.spawn_ray(lamp - surface.p);
                ray.tfar = 0.999;
                shadows.push(&ray);
            }
        }
    }
    (shadows, next)
}
