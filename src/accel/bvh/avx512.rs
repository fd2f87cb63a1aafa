//! Packets of sixteen rays by AVX-512.

// Vector instructions are intrinsics, which are unsafe where the processor may not have them.
#![allow(unsafe_code)]

use std::arch::x86_64::*;

use super::Scene;
use super::avx2::Avx2;
use super::few::Few;
use super::lanes::{BlockPlanes, Lanes, WideRays};
use super::leaf::Corners;
use super::prepare::Rays;
use super::stream::{self, Plan};
use super::triangle::Plane;
use crate::accel::HitFilter;
use crate::geometry::{HitPacket, RayPacket};

/// Proof that the processor has AVX-512 (F, VL, DQ and BW), AVX2 and fused multiply-add.
#[derive(Clone, Copy, Debug)]
pub struct Avx512(Avx2);

impl Avx512 {
    /// If the processor has it.
    pub fn detect() -> Option<Self> {
        let has = std::arch::is_x86_feature_detected!("avx512f")
            && std::arch::is_x86_feature_detected!("avx512vl")
            && std::arch::is_x86_feature_detected!("avx512dq")
            && std::arch::is_x86_feature_detected!("avx512bw");
        if has { Avx2::detect().map(Self) } else { None }
    }

    /// Nearest hits, by packets.
    pub fn intersect(
        self,
        scene: &Scene,
        plan: Plan,
        rays: &[RayPacket],
        hits: &mut [HitPacket],
        filter: Option<&dyn HitFilter>,
    ) {
        // SAFETY: `self` proves that the processor has AVX-512, AVX2 and FMA.
        unsafe {
            match scene.few_within(plan.exhaustive) {
                Some(few) => intersect_few(self, (scene, few), rays, hits),
                None => intersect(self, scene, plan, rays, hits, filter),
            }
        }
    }

    /// Occlusion, by packets.
    pub fn occluded(self, scene: &Scene, plan: Plan, rays: &mut [RayPacket], filter: Option<&dyn HitFilter>) {
        // SAFETY: `self` proves that the processor has AVX-512, AVX2 and FMA.
        unsafe {
            match scene.few_within(plan.exhaustive) {
                Some(few) => occluded_few(self, (scene, few), rays),
                None => occluded(self, scene, plan, rays, filter),
            }
        }
    }
}

#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,bmi1,popcnt")]
fn intersect(
    s: Avx512,
    scene: &Scene,
    plan: Plan,
    rays: &[RayPacket],
    hits: &mut [HitPacket],
    filter: Option<&dyn HitFilter>,
) {
    stream::intersect(s, s.0, scene, plan, rays, hits, filter);
}

#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,bmi1,popcnt")]
fn occluded(s: Avx512, scene: &Scene, plan: Plan, rays: &mut [RayPacket], filter: Option<&dyn HitFilter>) {
    stream::occluded(s, s.0, scene, plan, rays, filter);
}

#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,bmi1,popcnt")]
fn intersect_few(s: Avx512, few: (&Scene, &Few), rays: &[RayPacket], hits: &mut [HitPacket]) {
    stream::intersect_few(s, s.0, few, rays, hits);
}

#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,bmi1,popcnt")]
fn occluded_few(s: Avx512, few: (&Scene, &Few), rays: &mut [RayPacket]) {
    stream::occluded_few(s, s.0, few, rays);
}

/// Calls intrinsics that need AVX-512.
macro_rules! with {
    ($($body:tt)*) => {{
        // SAFETY: `self` proves that the processor has AVX-512; what is loaded or stored is a reference to as much.
        #[allow(unused_unsafe, reason = "an intrinsic without pointers is safe where its feature is known")]
        unsafe { $($body)* }
    }};
}

impl Lanes<16> for Avx512 {
    type F = __m512;
    type D = [__m512d; 2];
    type U = __m512i;
    type M = __mmask16;

    #[inline(always)]
    fn splat(self, x: f32) -> __m512 {
        with!(_mm512_set1_ps(x))
    }
    #[inline(always)]
    fn load(self, x: &[f32; 16]) -> __m512 {
        with!(_mm512_loadu_ps(x.as_ptr()))
    }
    #[inline(always)]
    fn store(self, x: __m512, to: &mut [f32; 16]) {
        with!(_mm512_storeu_ps(to.as_mut_ptr(), x));
    }
    #[inline(always)]
    fn add(self, a: __m512, b: __m512) -> __m512 {
        with!(_mm512_add_ps(a, b))
    }
    #[inline(always)]
    fn sub(self, a: __m512, b: __m512) -> __m512 {
        with!(_mm512_sub_ps(a, b))
    }
    #[inline(always)]
    fn mul(self, a: __m512, b: __m512) -> __m512 {
        with!(_mm512_mul_ps(a, b))
    }
    #[inline(always)]
    fn div(self, a: __m512, b: __m512) -> __m512 {
        with!(_mm512_div_ps(a, b))
    }
    #[inline(always)]
    fn fused(self, a: __m512, b: __m512, c: __m512) -> __m512 {
        with!(_mm512_fmadd_ps(a, b, c))
    }
    #[inline(always)]
    fn least(self, a: __m512, b: __m512) -> __m512 {
        with!(_mm512_min_ps(a, b))
    }
    #[inline(always)]
    fn greatest(self, a: __m512, b: __m512) -> __m512 {
        with!(_mm512_max_ps(a, b))
    }
    #[inline(always)]
    fn abs(self, a: __m512) -> __m512 {
        with!(_mm512_abs_ps(a))
    }
    #[inline(always)]
    fn copysign(self, a: __m512, b: __m512) -> __m512 {
        with!({
            let sign = _mm512_set1_ps(-0.0);
            _mm512_or_ps(_mm512_andnot_ps(sign, a), _mm512_and_ps(sign, b))
        })
    }
    #[inline(always)]
    fn lt(self, a: __m512, b: __m512) -> __mmask16 {
        with!(_mm512_cmp_ps_mask::<_CMP_LT_OQ>(a, b))
    }
    #[inline(always)]
    fn le(self, a: __m512, b: __m512) -> __mmask16 {
        with!(_mm512_cmp_ps_mask::<_CMP_LE_OQ>(a, b))
    }
    #[inline(always)]
    fn and(self, a: __mmask16, b: __mmask16) -> __mmask16 {
        a & b
    }
    #[inline(always)]
    fn bits(self, m: __mmask16) -> u32 {
        u32::from(m)
    }
    #[inline(always)]
    fn signs(self, a: __m512) -> u32 {
        with!(u32::from(_mm512_movepi32_mask(_mm512_castps_si512(a))))
    }
    #[inline(always)]
    fn mask(self, bits: u32) -> __mmask16 {
        bits as __mmask16
    }
    #[inline(always)]
    fn blend(self, m: __mmask16, a: __m512, b: __m512) -> __m512 {
        with!(_mm512_mask_blend_ps(m, a, b))
    }
    #[inline(always)]
    fn splat_u(self, x: u32) -> __m512i {
        with!(_mm512_set1_epi32(x as i32))
    }
    #[inline(always)]
    fn load_u(self, x: &[u32; 16]) -> __m512i {
        with!(_mm512_loadu_si512(x.as_ptr().cast()))
    }
    #[inline(always)]
    fn store_u(self, x: __m512i, to: &mut [u32; 16]) {
        with!(_mm512_storeu_si512(to.as_mut_ptr().cast(), x));
    }
    #[inline(always)]
    fn blend_u(self, m: __mmask16, a: __m512i, b: __m512i) -> __m512i {
        with!(_mm512_mask_blend_epi32(m, a, b))
    }
    #[inline(always)]
    fn meet(self, a: __m512i, b: __m512i) -> __mmask16 {
        with!(_mm512_test_epi32_mask(a, b))
    }
    #[inline(always)]
    fn none(self, a: __m512i) -> __mmask16 {
        with!(_mm512_cmpeq_epi32_mask(a, _mm512_set1_epi32(-1)))
    }
    #[inline(always)]
    fn planes(self, corners: &Corners) -> BlockPlanes {
        Lanes::<8>::planes(self.0, corners)
    }
    #[inline(always)]
    fn widen(self, rays: &Rays<16>) -> WideRays<[__m512d; 2]> {
        with!(WideRays {
            origin: halves(&rays.origin),
            direction: halves(&rays.direction),
        })
    }
    #[inline(always)]
    fn plane_distance(self, plane: &Plane, rays: &WideRays<[__m512d; 2]>) -> __m512 {
        with!({
            let low = _mm512_castps256_ps512(half_distance(plane, rays, 0));
            _mm512_insertf32x8::<1>(low, half_distance(plane, rays, 1))
        })
    }
}

/// Both halves of each row in double precision.
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,bmi1,popcnt")]
#[inline]
fn halves([x, y, z]: &[[f32; 16]; 3]) -> [[__m512d; 2]; 3] {
    let half = |row: &[f32; 16], first: usize| {
        // SAFETY: half of the floats, from the first or the middle one on.
        _mm512_cvtps_pd(unsafe { _mm256_loadu_ps(row.as_ptr().add(first)) })
    };
    [
        [half(x, 0), half(x, 8)],
        [half(y, 0), half(y, 8)],
        [half(z, 0), half(z, 8)],
    ]
}

/// The distances of the first or the second half of the lanes.
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,bmi1,popcnt")]
#[inline]
fn half_distance(plane: &Plane, rays: &WideRays<[__m512d; 2]>, half: usize) -> __m256 {
    let height = |axis: usize| _mm512_sub_pd(_mm512_set1_pd(plane.corner[axis]), rays.origin[axis][half]);
    let along = |axis: usize| rays.direction[axis][half];
    let dot = |x: __m512d, y: __m512d, z: __m512d| {
        let term = |axis: usize, x: __m512d| _mm512_mul_pd(_mm512_set1_pd(plane.normal[axis]), x);
        _mm512_add_pd(_mm512_add_pd(term(0, x), term(1, y)), term(2, z))
    };
    let above = dot(height(0), height(1), height(2));
    _mm512_cvtpd_ps(_mm512_div_pd(above, dot(along(0), along(1), along(2))))
}
