//! The calls that trace rays: those of the layer, by packets of 8 and by streams of single rays. Others are in `widths`.

use std::ffi::{c_int, c_uint, c_void};
use std::mem::{MaybeUninit, align_of, offset_of, size_of};
use std::panic::resume_unwind;

use embree_sys as ffi;

use super::callbacks::QueryData;
use super::scene::SceneHandle;
use crate::accel::HitFilter;
use crate::geometry::{HitPacket, LANES, RayPacket};
use crate::math::{Mat4, Vec4};

/// Asserts that a `RayPacket` is an `RTCRay8`: queries pass the one for the other.
macro_rules! assert_same_layout {
    ($($field:ident)*) => {
        const _: () = {
            assert!(size_of::<RayPacket>() == size_of::<ffi::RTCRay8>());
            assert!(align_of::<RayPacket>() == align_of::<ffi::RTCRay8>());
            $(assert!(offset_of!(RayPacket, $field) == offset_of!(ffi::RTCRay8, $field));)*
        };
    };
}
assert_same_layout! { org_x org_y org_z tnear dir_x dir_y dir_z time tfar mask id flags }

// "Nothing" is the same number here and there, so that ids of what was not hit need no translation.
const _: () = assert!(ffi::EMBREE_INVALID_ID == HitPacket::NONE);

/// Packets that go into one call of a stream: their rays, as Embree wants them there, fit the first level cache.
pub(super) const STREAM_PACKETS: usize = 32;

/// Which lanes take part, as Embree wants it: -1 or 0.
#[repr(C, align(32))]
struct Valid([c_int; LANES]);

impl Valid {
    #[inline]
    fn of(rays: &RayPacket) -> Self {
        Self(std::array::from_fn(|lane| -c_int::from(rays.is_active(lane))))
    }

    #[inline]
    fn any(&self) -> bool {
        self.0 != [0; LANES]
    }
}

/// A committed scene, and what goes with every call about it.
pub struct Query<'a> {
    /// The scene.
    pub scene: &'a SceneHandle,
    /// Asked about hits on filtered geometry.
    pub filter: Option<&'a dyn HitFilter>,
    /// Embree's ids of instances start here.
    pub first_instance: u32,
    /// Whether the rays of a packet are neighbours.
    pub coherent: bool,
}

impl Query<'_> {
    /// Nearest hits, in packets of 8, with Embree's ids of geometries and instances, which `resolve` makes the world's.
    pub fn intersect8(&self, rays: &[RayPacket], hits: &mut [HitPacket], resolve: impl Fn(&mut HitPacket)) {
        self.run(|query| {
            // SAFETY: numbers only, for which zero is a value.
            let mut packet: ffi::RTCRayHit8 = unsafe { MaybeUninit::zeroed().assume_init() };
            for (rays, hits) in rays.iter().zip(hits) {
                let valid = Valid::of(rays);
                if !valid.any() {
                    *hits = HitPacket {
                        t: rays.tfar,
                        ..HitPacket::EMPTY
                    };
                    continue;
                }
                // SAFETY: the layouts are the same, as asserted above, and both are plain numbers.
                packet.ray = unsafe { *(&raw const *rays).cast::<ffi::RTCRay8>() };
                packet.hit.geomID = [ffi::EMBREE_INVALID_ID; LANES];
                packet.hit.instID[0] = [ffi::EMBREE_INVALID_ID; LANES];
                // SAFETY: the scene is committed; mask, packet and query are live, aligned, and this thread's own.
                unsafe { ffi::embree_intersect8(valid.0.as_ptr(), self.scene.raw(), query, &raw mut packet) };
                // Embree leaves the primitive of a miss as it was.
                let found = &packet.hit;
                let primitive = std::array::from_fn(|lane| match found.geomID[lane] {
                    ffi::EMBREE_INVALID_ID => HitPacket::NONE,
                    _ => found.primID[lane],
                });
                *hits = HitPacket {
                    geometry: packet.hit.geomID,
                    primitive,
                    instance: packet.hit.instID[0],
                    t: packet.ray.tfar,
                };
                resolve(hits);
            }
        });
    }

    /// Occlusion, in packets of 8.
    pub fn occluded8(&self, rays: &mut [RayPacket]) {
        self.run(|query| {
            for rays in rays {
                let valid = Valid::of(rays);
                if valid.any() {
                    let packet = (&raw mut *rays).cast::<ffi::RTCRay8>();
                    // SAFETY: as in `intersect8`; the layouts are the same, as asserted above.
                    unsafe { ffi::embree_occluded8(valid.0.as_ptr(), self.scene.raw(), query, packet) };
                }
            }
        });
    }

    /// Occlusion, in streams of single rays. Only where there are streams (`EMBREE_HAS_STREAMS`).
    pub fn occluded_stream(&self, rays: &mut [RayPacket]) {
        self.run(|query| {
            let mut stream = [[SingleRay::default(); LANES]; STREAM_PACKETS];
            for packets in rays.chunks_mut(STREAM_PACKETS) {
                for (singles, packet) in stream.iter_mut().zip(&*packets) {
                    *singles = single_rays(packet);
                }
                let count = (packets.len() * LANES) as c_uint;
                let first = stream.as_mut_ptr().cast::<ffi::RTCRay>();
                // SAFETY: the scene is committed; the stream has at least `count` rays of the right layout, as asserted below, and is
                // this thread's own, as is the query. Rays that take no part have tnear > tfar, by which streams leave them out.
                let traced = unsafe { ffi::embree_occluded1_stream(self.scene.raw(), query, first, count) };
                debug_assert!(traced, "streams are asked for only where they exist");
                for (singles, packet) in stream.iter().zip(packets) {
                    packet.tfar = std::array::from_fn(|lane| singles[lane].0[2].x);
                }
            }
        });
    }

    /// Makes a query for `calls`, and goes on with the panic of a callback once Embree has returned.
    pub(super) fn run(&self, calls: impl FnOnce(*mut ffi::EmbreeQuery)) {
        let data = QueryData::new(self.filter, self.first_instance);
        let user = (&raw const data).cast_mut().cast::<c_void>();
        let mut query = MaybeUninit::uninit();
        // SAFETY: it fills the query; `data` outlives it.
        unsafe { ffi::embree_query_init(query.as_mut_ptr(), self.coherent, None, user) };
        calls(query.as_mut_ptr());
        if let Some(payload) = data.into_panic() {
            resume_unwind(payload);
        }
    }
}

/// An `RTCRay`: (origin, tnear), (direction, time), (tfar, mask, id, flags), the last three as bits.
#[derive(Clone, Copy, Debug, Default)]
#[repr(transparent)]
pub(super) struct SingleRay(pub [Vec4; 3]);

const _: () = {
    assert!(size_of::<SingleRay>() == size_of::<ffi::RTCRay>());
    assert!(align_of::<SingleRay>() >= align_of::<ffi::RTCRay>());
    assert!(offset_of!(ffi::RTCRay, org_x) == 0 && offset_of!(ffi::RTCRay, tnear) == 12);
    assert!(offset_of!(ffi::RTCRay, dir_x) == 16 && offset_of!(ffi::RTCRay, time) == 28);
    assert!(offset_of!(ffi::RTCRay, tfar) == 32 && offset_of!(ffi::RTCRay, mask) == 36);
    assert!(offset_of!(ffi::RTCRay, id) == 40 && offset_of!(ffi::RTCRay, flags) == 44);
};

/// The rays of a packet: six transpositions of 4 x 4 numbers.
#[inline]
pub(super) fn single_rays(packet: &RayPacket) -> [SingleRay; LANES] {
    let bits = |row: &[u32; LANES]| row.map(f32::from_bits);
    let thirds = [
        [packet.org_x, packet.org_y, packet.org_z, packet.tnear],
        [packet.dir_x, packet.dir_y, packet.dir_z, packet.time],
        [packet.tfar, bits(&packet.mask), bits(&packet.id), bits(&packet.flags)],
    ];
    let mut singles = [SingleRay::default(); LANES];
    for (third, rows) in thirds.iter().enumerate() {
        for half in [0, 4] {
            let [a, b, c, d] = rows.each_ref().map(|row| Vec4::from_slice(&row[half..half + 4]));
            let lanes = Mat4::from_cols(a, b, c, d).transpose();
            for (i, lane) in [lanes.x_axis, lanes.y_axis, lanes.z_axis, lanes.w_axis]
                .into_iter()
                .enumerate()
            {
                singles[half + i].0[third] = lane;
            }
        }
    }
    singles
}
