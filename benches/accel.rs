//! Ray queries on the rays that a renderer really shoots: streams recorded from renders of scenes/, replayed on one thread
//!
//! - `embree-raw`: through C calls on ready packets, robust, by the entry point that suits the kind;
//! - `embree`: through the layer, on the packets of a wave;
//! - `embree-packed`: the same, from single rays, packing included;
//! - `bvh`: through our own BVH.
//!
//! Rays go in waves of 1024, copied into place outside the measured time: as in a render they are in the cache.
//!
//! `cargo bench --bench accel`; `cargo bench --bench accel -- cornell` for one scene.

use std::hint::black_box;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use lucerna::accel::record::{RayStreams, Recorder};
use lucerna::accel::{Accel, Backend, BuildOptions, RayKind};
use lucerna::desc::{self, ParseOptions};
use lucerna::geometry::{HitPacket, LANES, Ray, RayPacket, RayQueue};
use lucerna::integrator::{Integrator, Silent};
use lucerna::scene::{Scene, SceneOptions, View, ViewOverrides};

const SCENES: [&str; 4] = ["cornell-box", "smallpt", "glass-and-mirror", "instances"];

/// Packets of each kind: 2^18 rays.
const PACKETS: usize = 1 << 15;

/// Packets of one call: a wave of a render, which is in the cache when it is traced.
const WAVE: usize = 128;

/// A scene in one backend.
fn load(name: &str, backend: Backend) -> (Scene, View, Integrator) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scenes")
        .join(name)
        .with_extension("pbrt");
    let desc = desc::load(&path, &ParseOptions::default()).expect("the project's own scene");
    let options = SceneOptions {
        backend: Some(backend),
        build: BuildOptions::default(),
        ..SceneOptions::default()
    };
    let scene = Scene::build(&desc, &options).expect("a scene that renders");
    let overrides = ViewOverrides {
        resolution: Some([512, 512]),
        spp: Some(1),
        ..ViewOverrides::default()
    };
    let view = View::build(&desc, &desc.views[0], scene.color(), &overrides).expect("a view of the scene");
    (scene, view, Integrator::from_desc(&desc.integrator))
}

/// The streams of one render, recorded through the default backend.
fn record(name: &str) -> Vec<(RayKind, Vec<RayPacket>)> {
    let (scene, view, integrator) = load(name, Backend::default());
    let streams = RayStreams::new(PACKETS);
    let scene = scene.map_accel(|inner| Arc::new(Recorder::new(inner, streams.clone())));
    integrator.render(&scene, &view, &view.film(), &Silent);
    let recorded = streams.take();
    let of_kind = |wanted: RayKind| {
        let waves = recorded.iter().filter(|(kind, _, _)| *kind == wanted);
        let packets = waves.flat_map(|(_, _, waves)| waves.iter().flatten().copied());
        (wanted, packets.take(PACKETS).collect())
    };
    RayKind::ALL.map(of_kind).into()
}

/// The time of `waves`, of which `trace` tells that of each, `iterations` times.
fn timed<W>(
    iterations: u64,
    waves: &(impl Iterator<Item = W> + Clone),
    mut trace: impl FnMut(W) -> Duration,
) -> Duration {
    (0..iterations).flat_map(|_| waves.clone()).map(&mut trace).sum()
}

/// Traces a wave through the layer.
fn trace(accel: &dyn Accel, kind: RayKind, rays: &mut [RayPacket], hits: &mut [HitPacket]) {
    match kind {
        RayKind::Shadow => accel.occluded(kind, rays, None),
        RayKind::Camera | RayKind::Bounce => accel.intersect(kind, rays, hits, None),
    }
    black_box((rays, hits));
}

fn benches(c: &mut Criterion) {
    for name in SCENES {
        let streams = record(name);
        let built: Vec<_> = Backend::AVAILABLE
            .iter()
            .map(|&backend| (backend, load(name, backend).0))
            .collect();
        for (kind, packets) in streams {
            let rays: Vec<Ray> = packets
                .iter()
                .flat_map(|packet| {
                    (0..LANES)
                        .filter(|&lane| packet.is_active(lane))
                        .map(|lane| packet.get(lane))
                })
                .collect();
            let mut group = c.benchmark_group(format!("{name}/{kind:?}").to_lowercase());
            group
                .sample_size(10)
                .throughput(Throughput::Elements(rays.len() as u64));
            let mut hits = vec![HitPacket::EMPTY; WAVE];
            let mut wave = Vec::with_capacity(WAVE);
            for (backend, scene) in &built {
                group.bench_function(BenchmarkId::from_parameter(backend), |b| {
                    b.iter_custom(|iterations| {
                        timed(iterations, &packets.chunks(WAVE), |packets| {
                            wave.clear();
                            wave.extend_from_slice(packets);
                            let start = Instant::now();
                            trace(scene.accel(), kind, &mut wave, &mut hits[..packets.len()]);
                            start.elapsed()
                        })
                    });
                });
                group.bench_function(BenchmarkId::from_parameter(format!("{backend}-packed")), |b| {
                    let (mut hot, mut queue) = (Vec::with_capacity(WAVE * LANES), RayQueue::default());
                    b.iter_custom(|iterations| {
                        timed(iterations, &rays.chunks(WAVE * LANES), |rays| {
                            hot.clear();
                            hot.extend_from_slice(rays);
                            let start = Instant::now();
                            queue.clear();
                            hot.iter().for_each(|ray| queue.push(ray));
                            let packets = queue.packets_mut();
                            let hits = &mut hits[..packets.len()];
                            trace(scene.accel(), kind, packets, hits);
                            start.elapsed()
                        })
                    });
                });
            }
            #[cfg(feature = "embree")]
            raw::bench(&mut group, built[0].1.world(), kind, &packets);
            group.finish();
        }
    }
}

/// C calls on ready packets.
#[cfg(feature = "embree")]
mod raw {
    use std::mem::MaybeUninit;
    use std::ptr::{from_ref, null_mut};
    use std::sync::Arc;
    use std::time::Instant;

    use criterion::BenchmarkGroup;
    use criterion::measurement::WallTime;
    use embree_sys as ffi;
    use lucerna::accel::embree::EmbreeScene;
    use lucerna::accel::{BuildOptions, RayKind};
    use lucerna::geometry::{LANES, RayPacket, World};

    use super::{WAVE, timed};

    #[derive(Clone, Copy)]
    #[repr(C, align(32))]
    struct Valid([i32; LANES]);

    /// What the call of a kind takes.
    enum Ready {
        Packets(Vec<(Valid, ffi::RTCRayHit8)>),
        Shadows(Vec<(Valid, ffi::RTCRay8)>),
        Stream(Vec<ffi::RTCRay>),
    }

    pub fn bench(group: &mut BenchmarkGroup<WallTime>, world: &Arc<World>, kind: RayKind, packets: &[RayPacket]) {
        let scene = EmbreeScene::build(world, &BuildOptions::default()).expect("it was built before");
        group.bench_function("embree-raw", |b| {
            b.iter_custom(|iterations| {
                timed(iterations, &packets.chunks(WAVE), |packets| {
                    let mut ready = ready(kind, packets);
                    let start = Instant::now();
                    trace(&scene, kind, &mut ready);
                    start.elapsed()
                })
            });
        });
    }

    fn ready(kind: RayKind, packets: &[RayPacket]) -> Ready {
        let valid = |packet: &RayPacket| Valid(std::array::from_fn(|lane| -i32::from(packet.is_active(lane))));
        // SAFETY: a RayPacket has the layout of an RTCRay8, which the library asserts.
        let raw = |packet: &RayPacket| unsafe { *from_ref(packet).cast::<ffi::RTCRay8>() };
        match kind {
            RayKind::Shadow if ffi::EMBREE_HAS_STREAMS == 1 => Ready::Stream(
                packets
                    .iter()
                    .flat_map(|packet| {
                        (0..LANES)
                            .filter(|&lane| packet.is_active(lane))
                            .map(|lane| ffi::RTCRay {
                                org_x: packet.org_x[lane],
                                org_y: packet.org_y[lane],
                                org_z: packet.org_z[lane],
                                tnear: packet.tnear[lane],
                                dir_x: packet.dir_x[lane],
                                dir_y: packet.dir_y[lane],
                                dir_z: packet.dir_z[lane],
                                time: packet.time[lane],
                                tfar: packet.tfar[lane],
                                mask: packet.mask[lane],
                                id: packet.id[lane],
                                flags: 0,
                            })
                    })
                    .collect(),
            ),
            RayKind::Shadow => Ready::Shadows(packets.iter().map(|packet| (valid(packet), raw(packet))).collect()),
            RayKind::Camera | RayKind::Bounce => Ready::Packets(
                packets
                    .iter()
                    .map(|packet| {
                        // SAFETY: numbers only, for which zero is a value.
                        let mut ready: ffi::RTCRayHit8 = unsafe { MaybeUninit::zeroed().assume_init() };
                        ready.ray = raw(packet);
                        ready.hit.geomID = [ffi::EMBREE_INVALID_ID; LANES];
                        ready.hit.instID[0] = [ffi::EMBREE_INVALID_ID; LANES];
                        (valid(packet), ready)
                    })
                    .collect(),
            ),
        }
    }

    fn trace(scene: &EmbreeScene, kind: RayKind, ready: &mut Ready) {
        let mut query = MaybeUninit::uninit();
        // SAFETY: it fills the query. Scenes of this bench have no filter, so no callback asks for a user pointer.
        unsafe { ffi::embree_query_init(query.as_mut_ptr(), kind == RayKind::Camera, None, null_mut()) };
        let (query, scene) = (query.as_mut_ptr(), scene.raw_scene());
        match ready {
            Ready::Packets(packets) => {
                for (valid, packet) in packets {
                    // SAFETY: the scene is committed; mask, packet and query are live and aligned.
                    unsafe { ffi::embree_intersect8(valid.0.as_ptr(), scene, query, packet) };
                }
            }
            Ready::Shadows(packets) => {
                for (valid, packet) in packets {
                    // SAFETY: as above.
                    unsafe { ffi::embree_occluded8(valid.0.as_ptr(), scene, query, packet) };
                }
            }
            Ready::Stream(rays) => {
                for rays in rays.chunks_mut(256) {
                    let count = rays.len() as u32;
                    // SAFETY: as above; there are `count` rays.
                    unsafe { ffi::embree_occluded1_stream(scene, query, rays.as_mut_ptr(), count) };
                }
            }
        }
    }
}

criterion_group!(accel, benches);
criterion_main!(accel);
