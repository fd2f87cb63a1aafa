//! The ray query backends: that they agree with an f64 judge and with each other, that closed meshes let nothing out, that rays
//! do not meet the primitive they leave, and that the contract of [`lucerna::accel::Accel`] holds.
//!
//! `LUCERNA_TEST_TIER=full` traces a hundred and a thousand times as many rays. Counts are printed (`--nocapture` shows them).

mod agreement;
mod contract;
mod leaks;
mod rays;
mod rng;
mod spawn;
mod worlds;

use std::sync::Arc;

use lucerna::accel::{Accel, Backend, BuildOptions, BuildQuality, HitFilter, RayKind, build, bvh::Bvh};
use lucerna::geometry::{Hit, HitPacket, LANES, Ray, RayQueue, World};

/// Whether the long tier is asked for.
fn is_full() -> bool {
    std::env::var_os("LUCERNA_TEST_TIER").is_some_and(|tier| tier == "full")
}

/// All backends over a world, in robust mode, by name: those that can be chosen, Embree's compact scenes, and every way that our BVH has
/// to trace.
fn backends(world: &Arc<World>) -> Vec<(String, Box<dyn Accel>)> {
    let options = BuildOptions::default();
    let mut backends: Vec<(String, Box<dyn Accel>)> = Backend::AVAILABLE
        .iter()
        .map(|&backend| (backend.to_string(), build(backend, world, &options).unwrap()))
        .collect();
    #[cfg(feature = "embree")]
    {
        let compact = BuildOptions {
            compact: true,
            ..options
        };
        let scene = build(Backend::Embree, world, &compact).unwrap();
        backends.push(("embree, compact".into(), scene));
    }
    for (name, bvh) in Bvh::build(world, &options).variants() {
        backends.push((format!("bvh, {name}"), Box::new(bvh)));
    }
    backends
}

/// The same, and more: builds of every quality, and every call of Embree.
fn configurations(world: &Arc<World>) -> Vec<(String, Box<dyn Accel>)> {
    let mut all = backends(world);
    for quality in [BuildQuality::Low, BuildQuality::High] {
        let options = BuildOptions {
            quality,
            ..BuildOptions::default()
        };
        for (name, bvh) in Bvh::build(world, &options).variants() {
            all.push((format!("bvh, {quality:?} quality, {name}"), Box::new(bvh)));
        }
        #[cfg(feature = "embree")]
        for compact in [false, true] {
            all.extend(calls_of_embree(world, &BuildOptions { compact, ..options }));
        }
    }
    all
}

/// Every call of Embree through one build.
#[cfg(feature = "embree")]
fn calls_of_embree(world: &Arc<World>, options: &BuildOptions) -> Vec<(String, Box<dyn Accel>)> {
    use lucerna::accel::embree::{Calls, EmbreeScene, Entry};
    let scene = EmbreeScene::build(world, options).unwrap();
    let all = Entry::AVAILABLE
        .iter()
        .flat_map(|&entry| [false, true].map(|coherent| Calls { entry, coherent }));
    let name = |calls| {
        let compact = if options.compact { ", compact" } else { "" };
        format!("embree, {:?} quality{compact}, {calls:?}", options.quality)
    };
    all.filter(|calls| calls.return_from(world, options))
        .map(|calls| (name(calls), Box::new(scene.calling(calls)) as Box<dyn Accel>))
        .collect()
}

/// What each ray hits, with the distance.
fn intersect(accel: &dyn Accel, rays: &[Ray], filter: Option<&dyn HitFilter>) -> Vec<Option<(Hit, f32)>> {
    let mut queue: RayQueue = rays.iter().copied().collect();
    let packets = queue.packets_mut();
    let mut hits = vec![HitPacket::EMPTY; packets.len()];
    accel.intersect(RayKind::Bounce, packets, &mut hits, filter);
    let answer = |i: usize| {
        hits[i / LANES]
            .get(i % LANES)
            .map(|hit| (hit, hits[i / LANES].t[i % LANES]))
    };
    (0..rays.len()).map(answer).collect()
}

/// Whether each ray is occluded.
fn occluded(accel: &dyn Accel, rays: &[Ray], filter: Option<&dyn HitFilter>) -> Vec<bool> {
    let mut queue: RayQueue = rays.iter().copied().collect();
    let packets = queue.packets_mut();
    accel.occluded(RayKind::Shadow, packets, filter);
    (0..rays.len())
        .map(|i| packets[i / LANES].is_occluded(i % LANES))
        .collect()
}
