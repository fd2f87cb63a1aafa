//! The kernel for processors with AVX2. It does the operations of the portable kernel in the same order, many lanes at a time;
//! none is fused, so the bits are the same.

// Vector instructions are intrinsics, which are unsafe where the processor may not have them.
#![allow(unsafe_code)]

use std::arch::x86_64::*;

use super::Scene;
use super::kernel::{BoxHits, Kernel, TriangleHits};
use super::leaf::{BlockIds, Corners, LANES};
use super::node::{Planes, WIDTH};
use super::query::Query;
use super::ray::{LocalRay, Slab};
use super::traverse::{self, Level};
use super::triangle::{DETERMINANTS, Shear, Sheared};

/// Proof that the processor has AVX2.
#[derive(Clone, Copy, Debug)]
pub struct Avx2(());

impl Avx2 {
    /// If the processor has it.
    pub fn detect() -> Option<Self> {
        std::arch::is_x86_feature_detected!("avx2").then_some(Self(()))
    }
}

#[repr(align(32))]
struct Aligned<T>(T);

impl Kernel for Avx2 {
    #[inline(always)]
    fn boxes(self, planes: &Planes, slab: &Slab, tnear: f32, tfar: f32) -> BoxHits {
        // SAFETY: `self` proves that the processor has AVX2.
        unsafe { boxes(planes, slab, tnear, tfar) }
    }

    #[inline(always)]
    fn triangles(self, corners: &Corners, ids: &BlockIds, mask: u32, shear: &Shear, range: [f32; 2]) -> TriangleHits {
        // SAFETY: `self` proves that the processor has AVX2.
        unsafe { triangles(corners, ids, mask, shear, range) }
    }

    #[inline(always)]
    fn group<const ANY: bool>(
        self,
        scene: &Scene,
        level: &Level,
        ray: &LocalRay,
        query: &mut Query,
        stack: &mut [u64],
    ) -> bool {
        // SAFETY: `self` proves that the processor has AVX2.
        unsafe { group::<ANY>(self, scene, level, ray, query, stack) }
    }
}

#[target_feature(enable = "avx2")]
fn group<const ANY: bool>(
    kernel: Avx2,
    scene: &Scene,
    level: &Level,
    ray: &LocalRay,
    query: &mut Query,
    stack: &mut [u64],
) -> bool {
    traverse::group::<Avx2, ANY>(kernel, scene, level, ray, query, stack)
}

#[target_feature(enable = "avx2")]
#[inline]
fn boxes(planes: &Planes, slab: &Slab, tnear: f32, tfar: f32) -> BoxHits {
    let distances = |plane: usize, origin: f32, scale: f32| {
        let row: &[f32; WIDTH] = &planes.0[plane];
        // SAFETY: eight floats, aligned to 32 bytes as rows of `Planes` are.
        let row = unsafe { _mm256_load_ps(row.as_ptr()) };
        _mm256_mul_ps(_mm256_sub_ps(row, _mm256_set1_ps(origin)), _mm256_set1_ps(scale))
    };
    let near = |axis: usize| {
        distances(
            2 * axis + slab.negative[axis],
            slab.near_origin[axis],
            slab.near_scale[axis],
        )
    };
    let far = |axis: usize| {
        distances(
            2 * axis + 1 - slab.negative[axis],
            slab.far_origin[axis],
            slab.far_scale[axis],
        )
    };
    // Where an operand is NaN the result is the second.
    let entry = _mm256_max_ps(near(0), _mm256_set1_ps(tnear));
    let entry = _mm256_max_ps(near(2), _mm256_max_ps(near(1), entry));
    let exit = _mm256_min_ps(far(0), _mm256_set1_ps(tfar));
    let exit = _mm256_min_ps(far(2), _mm256_min_ps(far(1), exit));
    let mut result = Aligned([0.0; WIDTH]);
    // SAFETY: eight floats, aligned to 32 bytes.
    unsafe { _mm256_store_ps(result.0.as_mut_ptr(), entry) };
    BoxHits {
        mask: _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(entry, exit)) as u32,
        entry: result.0,
    }
}

/// A vector for each corner of four triangles.
type Rows = [__m128; 3];

#[target_feature(enable = "avx2")]
#[inline]
fn triangles(corners: &Corners, ids: &BlockIds, mask: u32, shear: &Shear, range: [f32; 2]) -> TriangleHits {
    let offset = |corner: usize, axis: usize| {
        let row: &[f32; LANES] = &corners.0[corner][shear.axes[axis]];
        // SAFETY: four floats, aligned to 16 bytes as rows of `Corners` are.
        let row = unsafe { _mm_load_ps(row.as_ptr()) };
        _mm_sub_ps(row, _mm_set1_ps(shear.origin[axis]))
    };
    let (scale_x, scale_y) = (_mm_set1_ps(shear.scale[0]), _mm_set1_ps(shear.scale[1]));
    let depth: Rows = [offset(0, 2), offset(1, 2), offset(2, 2)];
    let across = |axis: usize, scale: __m128| -> Rows {
        [0, 1, 2].map(|corner| _mm_sub_ps(offset(corner, axis), _mm_mul_ps(scale, depth[corner])))
    };
    let ([ax, bx, cx], [ay, by, cy]) = (across(0, scale_x), across(1, scale_y));
    let u = _mm_sub_ps(_mm_mul_ps(cx, by), _mm_mul_ps(cy, bx));
    let v = _mm_sub_ps(_mm_mul_ps(ax, cy), _mm_mul_ps(ay, cx));
    let w = _mm_sub_ps(_mm_mul_ps(bx, ay), _mm_mul_ps(by, ax));

    let zero = _mm_setzero_ps();
    let any = |a, b, c| _mm_or_ps(_mm_or_ps(a, b), c);
    let below = any(_mm_cmplt_ps(u, zero), _mm_cmplt_ps(v, zero), _mm_cmplt_ps(w, zero));
    let above = any(_mm_cmpgt_ps(u, zero), _mm_cmpgt_ps(v, zero), _mm_cmpgt_ps(w, zero));
    // SAFETY: four integers, aligned to 16 bytes as rows of `BlockIds` are.
    let masks = unsafe { _mm_load_si128(ids.mask.as_ptr().cast()) };
    let masked = _mm_cmpeq_epi32(_mm_and_si128(masks, _mm_set1_epi32(mask as i32)), _mm_setzero_si128());
    let missed = _mm_or_ps(_mm_and_ps(below, above), _mm_castsi128_ps(masked));
    let possible = !_mm_movemask_ps(missed) as u32 & 0xf;
    if possible == 0 {
        return TriangleHits {
            mask: 0,
            t: [0.0; LANES],
        };
    }

    let determinant = _mm_add_ps(_mm_add_ps(u, v), w);
    let size = _mm_andnot_ps(_mm_set1_ps(-0.0), determinant);
    let exact = _mm_and_ps(
        _mm_cmpgt_ps(size, _mm_set1_ps(DETERMINANTS[0])),
        _mm_cmplt_ps(size, _mm_set1_ps(DETERMINANTS[1])),
    );
    let flat = any(_mm_cmpeq_ps(u, zero), _mm_cmpeq_ps(v, zero), _mm_cmpeq_ps(w, zero));
    let inexact = possible & _mm_movemask_ps(_mm_or_ps(flat, _mm_cmpeq_ps(exact, zero))) as u32;

    let [az, bz, cz] = depth.map(|z| _mm_mul_ps(_mm_set1_ps(shear.scale[2]), z));
    let inverse = _mm_div_ps(_mm_set1_ps(1.0), determinant);
    let term = |volume, z| _mm_mul_ps(_mm_mul_ps(volume, inverse), z);
    let t = _mm_add_ps(_mm_add_ps(term(u, az), term(v, bz)), term(w, cz));
    let least = _mm_min_ps(_mm_min_ps(az, bz), cz);
    let greatest = _mm_max_ps(_mm_max_ps(az, bz), cz);
    let t = _mm_min_ps(_mm_max_ps(t, least), greatest);
    let inside = _mm_and_ps(
        _mm_cmpge_ps(t, _mm_set1_ps(range[0])),
        _mm_cmple_ps(t, _mm_set1_ps(range[1])),
    );
    let mut distances = Aligned([0.0; LANES]);
    // SAFETY: four floats, aligned to 32 bytes.
    unsafe { _mm_store_ps(distances.0.as_mut_ptr(), t) };
    let mut hits = TriangleHits {
        mask: possible & !inexact & _mm_movemask_ps(inside) as u32,
        t: distances.0,
    };
    if inexact != 0 {
        resolve(&mut hits, inexact, corners, shear, range);
    }
    hits
}

/// Decides the lanes that single precision cannot.
#[cold]
#[inline(never)]
fn resolve(hits: &mut TriangleHits, lanes: u32, corners: &Corners, shear: &Shear, range: [f32; 2]) {
    for lane in (0..LANES).filter(|lane| lanes >> lane & 1 != 0) {
        let sheared: Sheared = shear.corners(&corners.lane(lane));
        if let Some(t) = sheared.distance()
            && t >= range[0]
            && t <= range[1]
        {
            hits.mask |= 1 << lane;
            hits.t[lane] = t;
        }
    }
}
