//! Eight children at once, onto a stack.

use std::arch::x86_64::*;

use super::Avx2;
use crate::accel::bvh::interleave::{Interleaved, Stack};
use crate::accel::bvh::node::{FixedNode, Node, WIDTH};
use crate::accel::bvh::ray::Slab;

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
    fn spread<const ANY: bool>(self, node: &FixedNode, slab: &Slab, tnear: f32, tfar: f32, stack: &mut Stack) {
        // SAFETY: `self` proves that the processor has AVX2 and FMA.
        unsafe { spread::<ANY>(node, slab, tnear, tfar, stack) }
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
#[inline]
fn spread<const ANY: bool>(node: &FixedNode, slab: &Slab, tnear: f32, tfar: f32, stack: &mut Stack) {
    let (entry, hit) = super::slabs(node.fixed_planes(), slab, tnear, tfar);
    let mask = _mm256_movemask_ps(hit) as u32;
    if ANY {
        // SAFETY: eight bytes of the table; and there is room for eight above what is on the stack.
        unsafe {
            let order = _mm256_cvtepu8_epi32(_mm_loadl_epi64(PACKED[mask as usize % 256].as_ptr().cast()));
            let children = _mm256_loadu_si256(node.children().as_ptr().cast());
            let to = stack.child.as_mut_ptr().add(stack.depth);
            _mm256_storeu_si256(to.cast(), _mm256_permutevar8x32_epi32(children, order));
        }
        debug_assert!(stack.depth + WIDTH <= stack.child.len());
        stack.depth += mask.count_ones() as usize;
        return;
    }
    // Distances with the lane in the last three bits; they are not negative, so that they compare as integers.
    let lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    let keys = _mm256_andnot_si256(_mm256_set1_epi32(7), _mm256_castps_si256(entry));
    let keys = _mm256_or_si256(keys, lanes);
    let missed = _mm256_andnot_si256(_mm256_castps_si256(hit), _mm256_set1_epi32(i32::MAX));
    let sorted = _mm256_or_si256(keys, missed);
    let least = _mm256_min_epi32(sorted, _mm256_permute2x128_si256::<1>(sorted, sorted));
    let least = _mm256_min_epi32(least, _mm256_shuffle_epi32::<0b01_00_11_10>(least));
    let least = _mm256_min_epi32(least, _mm256_shuffle_epi32::<0b10_11_00_01>(least));
    let nearest = _mm256_extract_epi32::<0>(least) as u32;
    let lane = nearest & 7;
    let others = mask & !(1 << lane);
    let count = mask.count_ones() as usize;
    // SAFETY: eight bytes of the table; and there is room for eight above what is on the stack.
    unsafe {
        let order = _mm256_cvtepu8_epi32(_mm_loadl_epi64(PACKED[others as usize % 256].as_ptr().cast()));
        let children = _mm256_loadu_si256(node.children().as_ptr().cast());
        let depth = stack.depth;
        debug_assert!(depth + WIDTH <= stack.child.len());
        let to = stack.distance.as_mut_ptr().add(depth);
        _mm256_storeu_si256(to.cast(), _mm256_permutevar8x32_epi32(keys, order));
        let to = stack.child.as_mut_ptr().add(depth);
        _mm256_storeu_si256(to.cast(), _mm256_permutevar8x32_epi32(children, order));
        // Where nothing is hit this writes below the top: it is written back what is there.
        let top = depth + count - 1;
        let is_hit = count != 0;
        let (d, c) = (stack.distance.as_mut_ptr().add(top), stack.child.as_mut_ptr().add(top));
        *d = if is_hit { nearest } else { *d };
        *c = if is_hit { node.children()[lane as usize].0 } else { *c };
        stack.depth = depth + count;
    }
}
