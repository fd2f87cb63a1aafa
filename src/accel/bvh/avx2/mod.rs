//! The kernel for processors with AVX2. It does the operations of the portable kernel in the same order, many lanes at a time;
//! none is fused, so the bits are the same.

// Vector instructions are intrinsics, which are unsafe where the processor may not have them.
#![allow(unsafe_code)]

mod lanes;
mod spread;

use std::arch::x86_64::*;

use super::Scene;
use super::kernel::{BoxHits, Kernel, TriangleHits};
use super::leaf::{BlockIds, Corners, LANES};
use super::node::ChildRef;
use super::node::{Planes, WIDTH};
use super::query::Query;
use super::ray::{LocalRay, Slab};
use super::stream;
use super::traverse::{self, Level, Walk};
use super::tree::FixedTree;
use super::triangle::Shear;
use crate::accel::{HitFilter, RayKind};
use crate::geometry::{HitPacket, RayPacket};

/// Proof that the processor has AVX2 and fused multiply-add.
#[derive(Clone, Copy, Debug)]
pub struct Avx2(());

impl Avx2 {
    /// If the processor has it.
    pub fn detect() -> Option<Self> {
        (std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma")).then_some(Self(()))
    }
}

impl Avx2 {
    /// Nearest hits, by packets.
    pub fn intersect(
        self,
        scene: &Scene,
        kind: RayKind,
        rays: &[RayPacket],
        hits: &mut [HitPacket],
        filter: Option<&dyn HitFilter>,
    ) {
        // SAFETY: `self` proves that the processor has AVX2 and FMA.
        unsafe { intersect(self, scene, kind, rays, hits, filter) }
    }

    /// Occlusion, by packets.
    pub fn occluded(self, scene: &Scene, rays: &mut [RayPacket], filter: Option<&dyn HitFilter>) {
        // SAFETY: `self` proves that the processor has AVX2 and FMA.
        unsafe { occluded(self, scene, rays, filter) }
    }
}

#[target_feature(enable = "avx2,fma")]
fn intersect(
    kernel: Avx2,
    scene: &Scene,
    kind: RayKind,
    rays: &[RayPacket],
    hits: &mut [HitPacket],
    filter: Option<&dyn HitFilter>,
) {
    stream::intersect(kernel, kernel, scene, kind, rays, hits, filter);
}

#[target_feature(enable = "avx2,fma")]
fn occluded(kernel: Avx2, scene: &Scene, rays: &mut [RayPacket], filter: Option<&dyn HitFilter>) {
    stream::occluded(kernel, kernel, scene, rays, filter);
}

const CACHE_LINE: usize = 64;

#[repr(align(32))]
struct Aligned<T>(T);

impl Kernel for Avx2 {
    #[inline(always)]
    fn boxes(self, planes: &Planes, slab: &Slab, tnear: f32, tfar: f32) -> BoxHits {
        // SAFETY: `self` proves that the processor has AVX2 and FMA.
        unsafe { boxes(planes, slab, tnear, tfar) }
    }

    #[inline(always)]
    fn triangles(self, corners: &Corners, ids: &BlockIds, mask: u32, shear: &Shear, range: [f32; 2]) -> TriangleHits {
        // SAFETY: `self` proves that the processor has AVX2 and FMA.
        unsafe { triangles(corners, ids, mask, shear, range) }
    }

    #[inline(always)]
    fn prefetch<T>(self, items: &[T], index: usize) {
        let item = items.as_ptr().wrapping_add(index).cast::<i8>();
        for line in 0..size_of::<T>().div_ceil(CACHE_LINE) {
            // SAFETY: a hint, which reads nothing: any address is allowed.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(item.wrapping_add(line * CACHE_LINE)) };
        }
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
        // SAFETY: `self` proves that the processor has AVX2 and FMA.
        unsafe { group::<ANY>(self, scene, level, ray, query, stack) }
    }

    #[inline(always)]
    fn fixed<const ANY: bool>(
        self,
        walk: &Walk<'_, Self>,
        tree: &FixedTree,
        start: ChildRef,
        ray: &LocalRay,
        query: &mut Query,
        stack: &mut [u64],
    ) -> bool {
        // SAFETY: `self` proves that the processor has AVX2 and FMA.
        unsafe { fixed::<ANY>(walk, tree, start, ray, query, stack) }
    }
}

#[target_feature(enable = "avx2,fma")]
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

#[target_feature(enable = "avx2,fma")]
fn fixed<const ANY: bool>(
    walk: &Walk<'_, Avx2>,
    tree: &FixedTree,
    start: ChildRef,
    ray: &LocalRay,
    query: &mut Query,
    stack: &mut [u64],
) -> bool {
    walk.tree::<_, _, ANY>(tree, start, 0.0, ray, query, stack)
}

#[target_feature(enable = "avx2,fma")]
#[inline]
fn boxes(planes: &Planes, slab: &Slab, tnear: f32, tfar: f32) -> BoxHits {
    let (entry, hit) = slabs(planes, slab, tnear, tfar);
    let mut result = Aligned([0.0; WIDTH]);
    // SAFETY: eight floats, aligned to 32 bytes.
    unsafe { _mm256_store_ps(result.0.as_mut_ptr(), entry) };
    BoxHits {
        mask: _mm256_movemask_ps(hit) as u32,
        entry: result.0,
    }
}

/// Where a ray enters eight boxes, and which of them it meets.
#[target_feature(enable = "avx2,fma")]
#[inline]
fn slabs(planes: &Planes, slab: &Slab, tnear: f32, tfar: f32) -> (__m256, __m256) {
    let distances = |plane: usize, scale: f32, shift: f32| {
        let row: &[f32; WIDTH] = &planes.0[plane];
        // SAFETY: eight floats, aligned to 32 bytes as rows of `Planes` are.
        let row = unsafe { _mm256_load_ps(row.as_ptr()) };
        _mm256_fmadd_ps(row, _mm256_set1_ps(scale), _mm256_set1_ps(shift))
    };
    let near = |axis: usize| {
        let plane = 2 * axis + slab.negative[axis];
        distances(plane, slab.near_scale[axis], slab.near_shift[axis])
    };
    let far = |axis: usize| {
        let plane = 2 * axis + 1 - slab.negative[axis];
        distances(plane, slab.far_scale[axis], slab.far_shift[axis])
    };
    let entry = _mm256_max_ps(
        _mm256_max_ps(near(0), near(1)),
        _mm256_max_ps(near(2), _mm256_set1_ps(tnear)),
    );
    let exit = _mm256_min_ps(
        _mm256_min_ps(far(0), far(1)),
        _mm256_min_ps(far(2), _mm256_set1_ps(tfar)),
    );
    (entry, _mm256_cmp_ps::<_CMP_LE_OQ>(entry, exit))
}

/// A vector for each corner of four triangles.
type Rows = [__m128; 3];

#[target_feature(enable = "avx2,fma")]
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
        let sheared = |corner: usize| _mm_sub_ps(offset(corner, axis), _mm_mul_ps(scale, depth[corner]));
        [sheared(0), sheared(1), sheared(2)]
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

    // Zero, or NaN where the products overflow.
    let unsure = any(
        _mm_cmpngt_ps(size(u), zero),
        _mm_cmpngt_ps(size(v), zero),
        _mm_cmpngt_ps(size(w), zero),
    );
    let planes = plane_distances(corners, shear);
    let parallel = _mm_cmpnlt_ps(size(planes), _mm_set1_ps(f32::INFINITY));
    let enter = |[a, b, c]: Rows| _mm_min_ps(_mm_min_ps(a, b), c);
    let leave = |[a, b, c]: Rows| _mm_max_ps(_mm_max_ps(a, b), c);
    let along = |axis: usize| -> Rows {
        let inverse = _mm_set1_ps(shear.inverse[axis]);
        [0, 1, 2].map(|corner| _mm_mul_ps(offset(corner, axis), inverse))
    };
    let (x, y) = (along(0), along(1));
    let z = depth.map(|depth| _mm_mul_ps(_mm_set1_ps(shear.scale[2]), depth));
    let first = leave([enter(x), enter(y), enter(z)]);
    let last = enter([leave(x), leave(y), leave(z)]);
    let t = _mm_min_ps(_mm_max_ps(planes, first), last);
    // The ray misses the box.
    let beside = _mm_cmpnle_ps(first, last);
    let inexact = possible & _mm_movemask_ps(any(unsure, parallel, beside)) as u32;
    let inside = _mm_and_ps(
        _mm_cmpgt_ps(t, _mm_set1_ps(range[0])),
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

#[target_feature(enable = "avx2,fma")]
#[inline]
fn size(v: __m128) -> __m128 {
    _mm_andnot_ps(_mm_set1_ps(-0.0), v)
}

/// Distances to the planes of four triangles, in double precision and then rounded.
#[target_feature(enable = "avx2,fma")]
#[inline]
fn plane_distances(corners: &Corners, shear: &Shear) -> __m128 {
    let corner = |corner: usize| {
        let row = |axis: usize| {
            let row: &[f32; LANES] = &corners.0[corner][shear.axes[axis]];
            // SAFETY: four floats, aligned to 16 bytes as rows of `Corners` are.
            _mm256_cvtps_pd(unsafe { _mm_load_ps(row.as_ptr()) })
        };
        [row(0), row(1), row(2)]
    };
    let splat = |v: &[f32; 3]| {
        let element = |i: usize| _mm256_set1_pd(f64::from(v[i]));
        [element(0), element(1), element(2)]
    };
    let minus = |a: &[__m256d; 3], b: &[__m256d; 3]| {
        [
            _mm256_sub_pd(a[0], b[0]),
            _mm256_sub_pd(a[1], b[1]),
            _mm256_sub_pd(a[2], b[2]),
        ]
    };
    let a = corner(0);
    let (e, f) = (minus(&corner(1), &a), minus(&corner(2), &a));
    let product = |i: usize, j: usize| _mm256_sub_pd(_mm256_mul_pd(e[i], f[j]), _mm256_mul_pd(e[j], f[i]));
    let n = [product(1, 2), product(2, 0), product(0, 1)];
    let dot = |v: &[__m256d; 3]| {
        let term = |i: usize| _mm256_mul_pd(n[i], v[i]);
        _mm256_add_pd(_mm256_add_pd(term(0), term(1)), term(2))
    };
    let height = dot(&minus(&a, &splat(&shear.origin)));
    _mm256_cvtpd_ps(_mm256_div_pd(height, dot(&splat(&shear.direction))))
}

/// Decides the lanes that single precision cannot.
#[cold]
#[inline(never)]
fn resolve(hits: &mut TriangleHits, lanes: u32, corners: &Corners, shear: &Shear, range: [f32; 2]) {
    for lane in (0..LANES).filter(|lane| lanes >> lane & 1 != 0) {
        if let Some(t) = shear.distance(&corners.lane(lane))
            && t > range[0]
            && t <= range[1]
        {
            hits.mask |= 1 << lane;
            hits.t[lane] = t;
        }
    }
}
