//! Packets of eight rays by AVX2.

use std::arch::x86_64::*;

use super::{Avx2, Wide};
use crate::accel::bvh::lanes::{BlockPlanes, Lanes, WideRays};
use crate::accel::bvh::leaf::{Corners, LANES as TRIANGLES};
use crate::accel::bvh::prepare::Rays;
use crate::accel::bvh::triangle::Plane;

/// Calls intrinsics that need AVX2 and FMA.
macro_rules! with {
    ($($body:tt)*) => {{
        // SAFETY: `self` proves that the processor has AVX2 and FMA; what is loaded or stored is a reference to as much.
        #[allow(unused_unsafe, reason = "an intrinsic without pointers is safe where its feature is known")]
        unsafe { $($body)* }
    }};
}

impl Lanes<8> for Avx2 {
    type F = __m256;
    type D = [__m256d; 2];
    type U = __m256i;
    type M = __m256;

    #[inline(always)]
    fn splat(self, x: f32) -> __m256 {
        with!(_mm256_set1_ps(x))
    }
    #[inline(always)]
    fn load(self, x: &[f32; 8]) -> __m256 {
        with!(_mm256_loadu_ps(x.as_ptr()))
    }
    #[inline(always)]
    fn store(self, x: __m256, to: &mut [f32; 8]) {
        with!(_mm256_storeu_ps(to.as_mut_ptr(), x));
    }
    #[inline(always)]
    fn add(self, a: __m256, b: __m256) -> __m256 {
        with!(_mm256_add_ps(a, b))
    }
    #[inline(always)]
    fn sub(self, a: __m256, b: __m256) -> __m256 {
        with!(_mm256_sub_ps(a, b))
    }
    #[inline(always)]
    fn mul(self, a: __m256, b: __m256) -> __m256 {
        with!(_mm256_mul_ps(a, b))
    }
    #[inline(always)]
    fn div(self, a: __m256, b: __m256) -> __m256 {
        with!(_mm256_div_ps(a, b))
    }
    #[inline(always)]
    fn fused(self, a: __m256, b: __m256, c: __m256) -> __m256 {
        with!(_mm256_fmadd_ps(a, b, c))
    }
    #[inline(always)]
    fn least(self, a: __m256, b: __m256) -> __m256 {
        with!(_mm256_min_ps(a, b))
    }
    #[inline(always)]
    fn greatest(self, a: __m256, b: __m256) -> __m256 {
        with!(_mm256_max_ps(a, b))
    }
    #[inline(always)]
    fn abs(self, a: __m256) -> __m256 {
        with!(_mm256_andnot_ps(_mm256_set1_ps(-0.0), a))
    }
    #[inline(always)]
    fn copysign(self, a: __m256, b: __m256) -> __m256 {
        with!({
            let sign = _mm256_set1_ps(-0.0);
            _mm256_or_ps(_mm256_andnot_ps(sign, a), _mm256_and_ps(sign, b))
        })
    }
    #[inline(always)]
    fn lt(self, a: __m256, b: __m256) -> __m256 {
        with!(_mm256_cmp_ps::<_CMP_LT_OQ>(a, b))
    }
    #[inline(always)]
    fn le(self, a: __m256, b: __m256) -> __m256 {
        with!(_mm256_cmp_ps::<_CMP_LE_OQ>(a, b))
    }
    #[inline(always)]
    fn and(self, a: __m256, b: __m256) -> __m256 {
        with!(_mm256_and_ps(a, b))
    }
    #[inline(always)]
    fn bits(self, m: __m256) -> u32 {
        with!(_mm256_movemask_ps(m) as u32)
    }
    #[inline(always)]
    fn signs(self, a: __m256) -> u32 {
        self.bits(a)
    }
    #[inline(always)]
    fn mask(self, bits: u32) -> __m256 {
        with!({
            let lane = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
            let set = _mm256_and_si256(_mm256_set1_epi32(bits as i32), lane);
            _mm256_castsi256_ps(_mm256_cmpeq_epi32(set, lane))
        })
    }
    #[inline(always)]
    fn blend(self, m: __m256, a: __m256, b: __m256) -> __m256 {
        with!(_mm256_blendv_ps(a, b, m))
    }
    #[inline(always)]
    fn splat_u(self, x: u32) -> __m256i {
        with!(_mm256_set1_epi32(x as i32))
    }
    #[inline(always)]
    fn load_u(self, x: &[u32; 8]) -> __m256i {
        with!(_mm256_loadu_si256(x.as_ptr().cast()))
    }
    #[inline(always)]
    fn store_u(self, x: __m256i, to: &mut [u32; 8]) {
        with!(_mm256_storeu_si256(to.as_mut_ptr().cast(), x));
    }
    #[inline(always)]
    fn blend_u(self, m: __m256, a: __m256i, b: __m256i) -> __m256i {
        with!(_mm256_blendv_epi8(a, b, _mm256_castps_si256(m)))
    }
    #[inline(always)]
    fn meet(self, a: __m256i, b: __m256i) -> __m256 {
        with!({
            let none = _mm256_cmpeq_epi32(_mm256_and_si256(a, b), _mm256_setzero_si256());
            _mm256_castsi256_ps(_mm256_xor_si256(none, _mm256_set1_epi32(-1)))
        })
    }
    #[inline(always)]
    fn none(self, a: __m256i) -> __m256 {
        with!(_mm256_castsi256_ps(_mm256_cmpeq_epi32(a, _mm256_set1_epi32(-1))))
    }
    #[inline(always)]
    fn planes(self, corners: &Corners) -> BlockPlanes {
        with!(block_planes(corners))
    }
    #[inline(always)]
    fn widen(self, rays: &Rays<8>) -> WideRays<[__m256d; 2]> {
        with!(WideRays {
            origin: halves(&rays.origin),
            direction: halves(&rays.direction),
        })
    }
    #[inline(always)]
    fn plane_distance(self, plane: &Plane, rays: &WideRays<[__m256d; 2]>) -> __m256 {
        with!(_mm256_set_m128(
            half_distance(plane, rays, 1),
            half_distance(plane, rays, 0)
        ))
    }
}

/// First corners and normals of the triangles of a block.
#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
#[inline]
pub fn planes(corners: &Corners) -> (Wide, Wide) {
    let [a, b, c] = [wide(corners, 0), wide(corners, 1), wide(corners, 2)];
    let (e, f) = (minus(b, a), minus(c, a));
    let normal = [product(e, f, 1, 2), product(e, f, 2, 0), product(e, f, 0, 1)];
    (a, normal)
}

#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
#[inline]
fn wide(corners: &Corners, corner: usize) -> Wide {
    let [x, y, z]: &[[f32; TRIANGLES]; 3] = &corners.0[corner];
    // SAFETY: four floats each, aligned to 16 bytes as rows of `Corners` are.
    let rows = unsafe {
        [
            _mm_load_ps(x.as_ptr()),
            _mm_load_ps(y.as_ptr()),
            _mm_load_ps(z.as_ptr()),
        ]
    };
    [
        _mm256_cvtps_pd(rows[0]),
        _mm256_cvtps_pd(rows[1]),
        _mm256_cvtps_pd(rows[2]),
    ]
}

#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
#[inline]
fn minus([a, b, c]: Wide, [d, e, f]: Wide) -> Wide {
    [_mm256_sub_pd(a, d), _mm256_sub_pd(b, e), _mm256_sub_pd(c, f)]
}

/// e_i f_j - e_j f_i.
#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
#[inline]
fn product(e: Wide, f: Wide, i: usize, j: usize) -> __m256d {
    _mm256_sub_pd(_mm256_mul_pd(e[i], f[j]), _mm256_mul_pd(e[j], f[i]))
}

#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
#[inline]
fn block_planes(corners: &Corners) -> BlockPlanes {
    let (corner, normal) = planes(corners);
    let mut planes = BlockPlanes {
        corner: [[0.0; TRIANGLES]; 3],
        normal: [[0.0; TRIANGLES]; 3],
    };
    for axis in 0..3 {
        // SAFETY: four doubles, aligned to 32 bytes as rows of `BlockPlanes` are.
        unsafe {
            _mm256_store_pd(planes.corner[axis].as_mut_ptr(), corner[axis]);
            _mm256_store_pd(planes.normal[axis].as_mut_ptr(), normal[axis]);
        }
    }
    planes
}

/// Both halves of each row in double precision.
#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
#[inline]
fn halves([x, y, z]: &[[f32; 8]; 3]) -> [[__m256d; 2]; 3] {
    let half = |row: &[f32; 8], first: usize| {
        // SAFETY: half of the floats, from the first or the middle one on.
        _mm256_cvtps_pd(unsafe { _mm_loadu_ps(row.as_ptr().add(first)) })
    };
    [
        [half(x, 0), half(x, 4)],
        [half(y, 0), half(y, 4)],
        [half(z, 0), half(z, 4)],
    ]
}

/// The distances of the first or the second half of the lanes.
#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
#[inline]
fn half_distance(plane: &Plane, rays: &WideRays<[__m256d; 2]>, half: usize) -> __m128 {
    let height = |axis: usize| _mm256_sub_pd(_mm256_set1_pd(plane.corner[axis]), rays.origin[axis][half]);
    let along = |axis: usize| rays.direction[axis][half];
    let dot = |x: __m256d, y: __m256d, z: __m256d| {
        let term = |axis: usize, x: __m256d| _mm256_mul_pd(_mm256_set1_pd(plane.normal[axis]), x);
        _mm256_add_pd(_mm256_add_pd(term(0, x), term(1, y)), term(2, z))
    };
    let above = dot(height(0), height(1), height(2));
    _mm256_cvtpd_ps(_mm256_div_pd(above, dot(along(0), along(1), along(2))))
}
