//! Embree through the bindings alone: one triangle, traced by every entry point.

use std::ffi::{CStr, c_char, c_void};
use std::mem::MaybeUninit;
use std::ptr;

use embree_sys::*;

/// A device and a scene with the triangle (0,0,0) (1,0,0) (0,1,0), id 7, released when dropped.
struct Fixture {
    device: RTCDevice,
    scene: RTCScene,
}

impl Fixture {
    fn new(flags: RTCSceneFlags) -> Self {
        // SAFETY: each handle is used while it lives; the buffers are written within their sizes (three vertices of three
        // floats, padded by Embree itself, and one triangle); the scene keeps the geometry alive.
        unsafe {
            let device = rtcNewDevice(c"threads=1".as_ptr());
            assert!(!device.is_null());
            let scene = rtcNewScene(device);
            rtcSetSceneFlags(scene, flags);
            let geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
            let vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 3);
            let corners: [f32; 9] = [0., 0., 0., 1., 0., 0., 0., 1., 0.];
            ptr::copy_nonoverlapping(corners.as_ptr(), vertices.cast(), 9);
            let indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, 1);
            ptr::copy_nonoverlapping([0u32, 1, 2].as_ptr(), indices.cast(), 3);
            rtcSetGeometryMask(geometry, u32::MAX);
            rtcCommitGeometry(geometry);
            rtcAttachGeometryByID(scene, geometry, 7);
            rtcReleaseGeometry(geometry);
            rtcCommitScene(scene);
            assert_eq!(rtcGetDeviceError(device), RTC_ERROR_NONE);
            Self { device, scene }
        }
    }
}

impl Drop for Fixture {
    fn drop(&mut self) {
        // SAFETY: both are live, and nothing uses them after this.
        unsafe {
            rtcReleaseScene(self.scene);
            rtcReleaseDevice(self.device);
        }
    }
}

fn query(filter: RTCFilterFunctionN, user: *mut c_void) -> EmbreeQuery {
    let mut query = MaybeUninit::uninit();
    // SAFETY: embree_query_init fills the whole query.
    unsafe {
        embree_query_init(query.as_mut_ptr(), false, filter, user);
        query.assume_init()
    }
}

/// Ray `i` starts at z = 1 + i and goes down; odd ones miss the triangle.
fn ray(i: usize) -> RTCRay {
    RTCRay {
        org_x: if i.is_multiple_of(2) { 0.25 } else { 0.75 },
        org_y: if i.is_multiple_of(2) { 0.25 } else { 0.75 },
        org_z: 1.0 + i as f32,
        tnear: 0.0,
        dir_x: 0.0,
        dir_y: 0.0,
        dir_z: -1.0,
        time: 0.0,
        tfar: f32::INFINITY,
        mask: u32::MAX,
        id: i as u32,
        flags: 0,
    }
}

fn empty_hit() -> RTCHit {
    // SAFETY: RTCHit is numbers only, for which zero is a value.
    let mut hit: RTCHit = unsafe { MaybeUninit::zeroed().assume_init() };
    hit.geomID = EMBREE_INVALID_ID;
    hit
}

/// Whether lane `i` hits: even ones, and only where the lane was asked for.
fn expected(i: usize, valid: i32) -> bool {
    i.is_multiple_of(2) && valid != 0
}

macro_rules! packet_test {
    ($name:ident, $lanes:literal, $ray:ty, $rayhit:ty, $intersect:ident, $occluded:ident) => {
        #[test]
        fn $name() {
            let fixture = Fixture::new(RTC_SCENE_FLAG_ROBUST);
            let mut query = query(None, ptr::null_mut());
            // SAFETY: packets are numbers only, for which zero is a value.
            let mut rays: $ray = unsafe { MaybeUninit::zeroed().assume_init() };
            for i in 0..$lanes {
                let ray = ray(i);
                (rays.org_x[i], rays.org_y[i], rays.org_z[i]) = (ray.org_x, ray.org_y, ray.org_z);
                (rays.dir_x[i], rays.dir_y[i], rays.dir_z[i]) = (ray.dir_x, ray.dir_y, ray.dir_z);
                (rays.tfar[i], rays.mask[i], rays.id[i]) = (ray.tfar, ray.mask, ray.id);
            }
            #[repr(align(64))]
            struct Valid([i32; $lanes]);
            // The last two lanes are left out.
            let valid = Valid(std::array::from_fn(|i| if i + 2 < $lanes { -1 } else { 0 }));

            // SAFETY: as above.
            let mut rayhit: $rayhit = unsafe { MaybeUninit::zeroed().assume_init() };
            rayhit.ray = rays;
            rayhit.hit.geomID = [EMBREE_INVALID_ID; $lanes];
            rayhit.hit.instID = [[EMBREE_INVALID_ID; $lanes]; RTC_MAX_INSTANCE_LEVEL_COUNT as usize];
            // SAFETY: the scene is committed; packet and mask are aligned and have this many lanes.
            unsafe { $intersect(valid.0.as_ptr(), fixture.scene, &raw mut query, &raw mut rayhit) };
            // SAFETY: as above.
            unsafe { $occluded(valid.0.as_ptr(), fixture.scene, &raw mut query, &raw mut rays) };
            for i in 0..$lanes {
                let hit = expected(i, valid.0[i]);
                assert_eq!(
                    rayhit.hit.geomID[i],
                    if hit { 7 } else { EMBREE_INVALID_ID },
                    "lane {i}"
                );
                assert_eq!(
                    rayhit.ray.tfar[i],
                    if hit { 1.0 + i as f32 } else { f32::INFINITY },
                    "lane {i}"
                );
                assert_eq!(
                    rays.tfar[i],
                    if hit { f32::NEG_INFINITY } else { f32::INFINITY },
                    "lane {i}"
                );
                assert_eq!(rayhit.hit.instID[0][i], EMBREE_INVALID_ID, "lane {i}");
                if hit {
                    assert_eq!(
                        (rayhit.hit.primID[i], rayhit.hit.u[i], rayhit.hit.v[i]),
                        (0, 0.25, 0.25),
                        "lane {i}"
                    );
                }
            }
        }
    };
}

packet_test!(
    packets_of_4,
    4,
    RTCRay4,
    RTCRayHit4,
    embree_intersect4,
    embree_occluded4
);
packet_test!(
    packets_of_8,
    8,
    RTCRay8,
    RTCRayHit8,
    embree_intersect8,
    embree_occluded8
);
packet_test!(
    packets_of_16,
    16,
    RTCRay16,
    RTCRayHit16,
    embree_intersect16,
    embree_occluded16
);

#[test]
fn single_rays() {
    let fixture = Fixture::new(RTC_SCENE_FLAG_ROBUST);
    let mut query = query(None, ptr::null_mut());
    for i in 0..4 {
        let mut rayhit = RTCRayHit {
            ray: ray(i),
            hit: empty_hit(),
        };
        let mut shadow = ray(i);
        // SAFETY: the scene is committed, the rays live on this stack.
        unsafe {
            embree_intersect1(fixture.scene, &raw mut query, &raw mut rayhit);
            embree_occluded1(fixture.scene, &raw mut query, &raw mut shadow);
        }
        assert_eq!(rayhit.hit.geomID == 7, expected(i, -1));
        assert_eq!(shadow.tfar == f32::NEG_INFINITY, expected(i, -1));
    }
}

#[test]
fn streams_trace_or_say_that_they_are_absent() {
    let fixture = Fixture::new(RTC_SCENE_FLAG_ROBUST);
    let mut query = query(None, ptr::null_mut());
    let mut hits: Vec<_> = (0..20)
        .map(|i| RTCRayHit {
            ray: ray(i),
            hit: empty_hit(),
        })
        .collect();
    let mut rays: Vec<_> = (0..20).map(ray).collect();
    // SAFETY: the scene is committed, and each array has 20 entries.
    let traced = unsafe {
        [
            embree_intersect1_stream(fixture.scene, &raw mut query, hits.as_mut_ptr(), 20),
            embree_occluded1_stream(fixture.scene, &raw mut query, rays.as_mut_ptr(), 20),
        ]
    };
    assert_eq!(traced, [EMBREE_HAS_STREAMS == 1; 2]);
    for i in 0..20 {
        let hit = traced[0] && expected(i, -1);
        assert_eq!(hits[i].hit.geomID == 7, hit, "ray {i}");
        assert_eq!(rays[i].tfar == f32::NEG_INFINITY, hit, "ray {i}");
    }
}

#[test]
fn streams_of_packets_trace_or_say_that_they_are_absent() {
    let fixture = Fixture::new(RTC_SCENE_FLAG_ROBUST);
    let mut query = query(None, ptr::null_mut());
    // SAFETY: packets are numbers only, for which zero is a value.
    let mut packets: [RTCRayHit8; 3] = unsafe { MaybeUninit::zeroed().assume_init() };
    for (p, packet) in packets.iter_mut().enumerate() {
        packet.hit.geomID = [EMBREE_INVALID_ID; 8];
        for lane in 0..8 {
            let ray = ray(8 * p + lane);
            let rays = &mut packet.ray;
            (rays.org_x[lane], rays.org_y[lane], rays.org_z[lane]) = (ray.org_x, ray.org_y, ray.org_z);
            (rays.dir_z[lane], rays.tfar[lane], rays.mask[lane]) = (ray.dir_z, ray.tfar, ray.mask);
        }
    }
    let mut shadows = packets.map(|packet| packet.ray);
    // SAFETY: the scene is committed, and each array has 3 packets.
    let traced = unsafe {
        [
            embree_intersect8_stream(fixture.scene, &raw mut query, packets.as_mut_ptr(), 3),
            embree_occluded8_stream(fixture.scene, &raw mut query, shadows.as_mut_ptr(), 3),
        ]
    };
    assert_eq!(traced, [EMBREE_HAS_STREAMS == 1; 2]);
    for i in 0..24 {
        let hit = traced[0] && expected(i, -1);
        assert_eq!(packets[i / 8].hit.geomID[i % 8] == 7, hit, "ray {i}");
        assert_eq!(shadows[i / 8].tfar[i % 8] == f32::NEG_INFINITY, hit, "ray {i}");
    }
}

/// Counts its calls in the query's user data, and turns every hit away.
unsafe extern "C" fn reject(args: *const RTCFilterFunctionNArguments) {
    // SAFETY: Embree passes valid arguments with N lanes; the test passes the address of a counter.
    unsafe {
        let args = &*args;
        *embree_context_user(args.context).cast::<u32>() += 1;
        for lane in 0..args.N as usize {
            *args.valid.add(lane) = 0;
        }
    }
}

#[test]
fn the_filter_of_a_query_is_asked_and_finds_the_user_data() {
    let fixture = Fixture::new(RTC_SCENE_FLAG_ROBUST | EMBREE_SCENE_FLAG_QUERY_FILTER);
    let mut calls = 0u32;
    let mut query = query(Some(reject), (&raw mut calls).cast());
    let mut rayhit = RTCRayHit {
        ray: ray(0),
        hit: empty_hit(),
    };
    // SAFETY: the scene is committed, the ray and the counter live on this stack.
    unsafe { embree_intersect1(fixture.scene, &raw mut query, &raw mut rayhit) };
    assert_eq!(rayhit.hit.geomID, EMBREE_INVALID_ID);
    assert_eq!(calls, 1);
}

/// Stores code and message.
unsafe extern "C" fn store(user: *mut c_void, code: RTCError, message: *const c_char) {
    // SAFETY: the test passes the address of an `Option`; Embree passes a string.
    unsafe {
        let message = CStr::from_ptr(message).to_string_lossy().into_owned();
        *user.cast::<Option<(RTCError, String)>>() = Some((code, message));
    }
}

#[test]
fn an_error_reaches_the_device_callback() {
    let fixture = Fixture::new(RTC_SCENE_FLAG_NONE);
    let mut error: Option<(RTCError, String)> = None;
    // SAFETY: the error outlives the device's use of it; a geometry of an unknown type is a mistake that Embree reports.
    unsafe {
        rtcSetDeviceErrorFunction(fixture.device, Some(store), (&raw mut error).cast());
        assert!(rtcNewGeometry(fixture.device, 9999).is_null());
    }
    let (code, message) = error.expect("reported");
    assert_eq!(code, RTC_ERROR_UNKNOWN);
    assert!(!message.is_empty());
}
