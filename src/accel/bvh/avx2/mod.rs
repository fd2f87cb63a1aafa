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
use super::stream::{self, Plan};
use super::traverse::{self, Level, Walk};
use super::tree::FixedTree;
use super::triangle::Shear;
use crate::accel::HitFilter;
use crate::geometry::{HitPacket, RayPacket};

/// Proof that the processor has AVX2 and fused multiply-add.
#[derive(Clone, Copy, Debug)]
pub struct Avx2(());

impl Avx2 {
    /// If the processor has it.
    pub fn detect() -> Option<Self> {
        let has = std::arch::is_x86_feature_detected!("avx2")
            && std::arch::is_x86_feature_detected!("fma")
            && std::arch::is_x86_feature_detected!("bmi1")
            && std::arch::is_x86_feature_detected!("popcnt");
        has.then_some(Self(()))
    }
}

impl Avx2 {
    /// Nearest hits, by packets.
    pub fn intersect(
        self,
        scene: &Scene,
        plan: Plan,
        rays: &[RayPacket],
        hits: &mut [HitPacket],
        filter: Option<&dyn HitFilter>,
    ) {
        // SAFETY: `self` proves that the processor has AVX2 and FMA.
        unsafe { intersect(self, scene, plan, rays, hits, filter) }
    }

    /// Occlusion, by packets.
    pub fn occluded(self, scene: &Scene, plan: Plan, rays: &mut [RayPacket], filter: Option<&dyn HitFilter>) {
        // SAFETY: `self` proves that the processor has AVX2 and FMA.
        unsafe { occluded(self, scene, plan, rays, filter) }
    }
}

#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
fn intersect(
    kernel: Avx2,
    scene: &Scene,
    plan: Plan,
    rays: &[RayPacket],
    hits: &mut [HitPacket],
    filter: Option<&dyn HitFilter>,
) {
    stream::intersect(kernel, kernel, scene, plan, rays, hits, filter);
}

#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
fn occluded(kernel: Avx2, scene: &Scene, plan: Plan, rays: &mut [RayPacket], filter: Option<&dyn HitFilter>) {
    stream::occluded(kernel, kernel, scene, plan, rays, filter);
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

#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
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

#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
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

#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
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
#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
#[inline]
fn slabs(planes: &Planes, slab: &Slab, tnear: f32, tfar: f32) -> (__m256, __m256) {
    let distances = |plane: usize, scale: f32, shift: f32| {
        let row: &[f32; WIDTH] = &planes.0[plane];
        // SAFETY: eight floats, aligned to 32 bytes as rows of `Planes` are.
        let row = unsafe { _mm256_load_ps(row.as_ptr()) };
        _mm256_fmadd_ps(row, _mm256_set1_ps(scale), _mm256_set1_ps(shift))
    };
    let near = |axis: usize| {
        let plane = 2 * axis + (slab.negative[axis] & 1);
        distances(plane, slab.near[axis][0], slab.near[axis][1])
    };
    let far = |axis: usize| {
        let plane = 2 * axis + 1 - (slab.negative[axis] & 1);
        distances(plane, slab.far[axis][0], slab.far[axis][1])
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

#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
#[inline]
fn triangles(corners: &Corners, ids: &BlockIds, mask: u32, shear: &Shear, range: [f32; 2]) -> TriangleHits {
    let [x, y, depth] = [
        offsets(corners, shear, 0),
        offsets(corners, shear, 1),
        offsets(corners, shear, 2),
    ];
    let [ax, bx, cx] = minus(x, times(depth, shear.scale[0]));
    let [ay, by, cy] = minus(y, times(depth, shear.scale[1]));
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
    let x = times(x, shear.inverse[0]);
    let y = times(y, shear.inverse[1]);
    let z = times(depth, shear.scale[2]);
    let first = greatest([least(x), least(y), least(z)]);
    let last = least([greatest(x), greatest(y), greatest(z)]);
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

#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
#[inline]
fn size(v: __m128) -> __m128 {
    _mm_andnot_ps(_mm_set1_ps(-0.0), v)
}

/// Coordinates of four triangles along one of the axes of a shear, relative to the origin.
#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
#[inline]
fn offsets(corners: &Corners, shear: &Shear, axis: usize) -> Rows {
    let (row, origin) = (shear.axes[axis], _mm_set1_ps(shear.origin[axis]));
    let [a, b, c]: [&[f32; LANES]; 3] = [&corners.0[0][row], &corners.0[1][row], &corners.0[2][row]];
    // SAFETY: four floats each, aligned to 16 bytes as rows of `Corners` are.
    let rows = unsafe {
        [
            _mm_load_ps(a.as_ptr()),
            _mm_load_ps(b.as_ptr()),
            _mm_load_ps(c.as_ptr()),
        ]
    };
    [
        _mm_sub_ps(rows[0], origin),
        _mm_sub_ps(rows[1], origin),
        _mm_sub_ps(rows[2], origin),
    ]
}

#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
#[inline]
fn times([a, b, c]: Rows, factor: f32) -> Rows {
    let factor = _mm_set1_ps(factor);
    [_mm_mul_ps(a, factor), _mm_mul_ps(b, factor), _mm_mul_ps(c, factor)]
}

#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
#[inline]
fn minus([a, b, c]: Rows, [d, e, f]: Rows) -> Rows {
    [_mm_sub_ps(a, d), _mm_sub_ps(b, e), _mm_sub_ps(c, f)]
}

#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
#[inline]
fn least([a, b, c]: Rows) -> __m128 {
    _mm_min_ps(_mm_min_ps(a, b), c)
}

#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
#[inline]
fn greatest([a, b, c]: Rows) -> __m128 {
    _mm_max_ps(_mm_max_ps(a, b), c)
}

/// Distances to the planes of four triangles, in double precision and then rounded.
#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
#[inline]
fn plane_distances(corners: &Corners, shear: &Shear) -> __m128 {
    let (corner, normal) = lanes::planes(corners, shear.axes);
    let origin = shear.origin.map(f64::from);
    let direction = shear.direction.map(f64::from);
    let height = [
        _mm256_sub_pd(corner[0], _mm256_set1_pd(origin[0])),
        _mm256_sub_pd(corner[1], _mm256_set1_pd(origin[1])),
        _mm256_sub_pd(corner[2], _mm256_set1_pd(origin[2])),
    ];
    let along = [
        _mm256_set1_pd(direction[0]),
        _mm256_set1_pd(direction[1]),
        _mm256_set1_pd(direction[2]),
    ];
    _mm256_cvtpd_ps(_mm256_div_pd(dot(normal, height), dot(normal, along)))
}

/// A vector for each axis.
type Wide = [__m256d; 3];

#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
#[inline]
fn dot([a, b, c]: Wide, [d, e, f]: Wide) -> __m256d {
    let sum = _mm256_add_pd(_mm256_mul_pd(a, d), _mm256_mul_pd(b, e));
    _mm256_add_pd(sum, _mm256_mul_pd(c, f))
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
