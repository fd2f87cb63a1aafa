//! Eight children at once, onto a stack.

use std::arch::x86_64::*;
use std::hint::select_unpredictable;

use super::Avx2;
use super::triangles::triangles;
use crate::accel::bvh::interleave::{Interleaved, Mates, Member, Room, Stack, Top, Trip};
use crate::accel::bvh::kernel::TriangleHits;
use crate::accel::bvh::leaf::{Block, FixedBlock};
use crate::accel::bvh::node::{FixedNode, Node, WIDTH};
use crate::accel::bvh::traverse::STACK;
use crate::geometry::{LANES, RayPacket};

/// For each set of lanes, these lanes first.
static PACKED: [[u8; WIDTH]; 256] = packed();

const fn packed() -> [[u8; WIDTH]; 256] {
    let mut table = [[0; WIDTH]; 256];
    let mut set = 0;
    while set < 256 {
        let (mut lane, mut count) = (0, 0);
        while lane < WIDTH {
            if set >> lane & 1 == 1 {
                table[set][count] = lane as u8;
                count += 1;
            }
            lane += 1;
        }
        set += 1;
    }
    table
}

impl Interleaved for Avx2 {
    #[inline(always)]
    fn spread<const ANY: bool>(self, node: &FixedNode, ray: Member, stack: &mut Stack, depth: usize) -> Top {
        // SAFETY: `self` proves that the processor has AVX2 and FMA.
        unsafe { spread::<ANY>(node, ray, stack, depth) }
    }

    #[inline(always)]
    fn triangles_of(self, block: &FixedBlock, ray: Member, any: bool) -> TriangleHits {
        let (rays, lane) = (&ray.mates.prepared.rays, ray.lane % LANES);
        let range = [rays.tnear[lane], rays.tfar[lane]];
        triangles(
            self,
            block.fixed_corners(),
            block.ids(),
            rays.mask[lane],
            ray,
            range,
            any,
        )
    }

    #[inline(always)]
    fn trip<const ANY: bool>(
        self,
        trip: &Trip<'_, '_, Self>,
        packets: &[RayPacket],
        room: &mut Room,
        single_stack: &mut [u64; STACK],
        done: &mut dyn FnMut(&Mates),
    ) {
        // SAFETY: `self` proves that the processor has AVX2 and FMA.
        unsafe { trace::<ANY>(trip, packets, room, single_stack, done) }
    }

    #[inline(always)]
    fn fetch(self, place: usize) {
        for line in 0..4 {
            // SAFETY: a hint, which reads nothing: any address is allowed.
            unsafe { _mm_prefetch::<_MM_HINT_T0>((place + 64 * line) as *const i8) };
        }
    }
}

#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
#[inline(never)]
fn trace<const ANY: bool>(
    trip: &Trip<'_, '_, Avx2>,
    packets: &[RayPacket],
    room: &mut Room,
    single_stack: &mut [u64; STACK],
    done: &mut dyn FnMut(&Mates),
) {
    trip.trace::<ANY>(packets, room, single_stack, done);
}

#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
#[inline]
fn spread<const ANY: bool>(node: &FixedNode, ray: Member, stack: &mut Stack, depth: usize) -> Top {
    let lane = ray.lane % LANES;
    let (tnear, cull) = (ray.mates.prepared.rays.tnear[lane], ray.mates.cull[lane]);
    let (entry, hit) = super::slabs(node.fixed_planes(), ray, tnear, cull);
    let mask = _mm256_movemask_ps(hit) as u32;
    // Distances with the lane in the last three bits; they are not negative, so that they compare as integers.
    let lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    let keys = _mm256_andnot_si256(_mm256_set1_epi32(7), _mm256_castps_si256(entry));
    let keys = _mm256_or_si256(keys, lanes);
    let nearest = if ANY {
        31 - (mask | 1).leading_zeros()
    } else {
        let missed = _mm256_andnot_si256(_mm256_castps_si256(hit), _mm256_set1_epi32(i32::MAX));
        let sorted = _mm256_or_si256(keys, missed);
        let least = _mm256_min_epi32(sorted, _mm256_permute2x128_si256::<1>(sorted, sorted));
        let least = _mm256_min_epi32(least, _mm256_shuffle_epi32::<0b01_00_11_10>(least));
        let least = _mm256_min_epi32(least, _mm256_shuffle_epi32::<0b10_11_00_01>(least));
        _mm256_extract_epi32::<0>(least) as u32
    };
    let first = nearest as usize % WIDTH;
    let others = mask & !(1 << first);
    debug_assert!(depth + WIDTH <= stack.child.len());
    let below = stack.pop(depth);
    // SAFETY: eight bytes of the table; and there is room for eight above what is on the stack.
    unsafe {
        let order = _mm256_cvtepu8_epi32(_mm_loadl_epi64(PACKED[others as usize % 256].as_ptr().cast()));
        let children = _mm256_loadu_si256(node.children().as_ptr().cast());
        let to = stack.child.as_mut_ptr().add(depth);
        _mm256_storeu_si256(to.cast(), _mm256_permutevar8x32_epi32(children, order));
        if !ANY {
            let to = stack.distance.as_mut_ptr().add(depth);
            _mm256_storeu_si256(to.cast(), _mm256_permutevar8x32_epi32(keys, order));
        }
    }
    // Not from the stack, where it would be read before it is there; and which it is cannot be predicted.
    let is_hit = mask != 0;
    Top {
        child: select_unpredictable(is_hit, node.children()[first].0, below.child),
        distance: select_unpredictable(is_hit, nearest, below.distance),
        depth: select_unpredictable(is_hit, depth + others.count_ones() as usize, below.depth),
    }
}
