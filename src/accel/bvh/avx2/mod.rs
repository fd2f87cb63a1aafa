//! The kernel for processors with AVX2. It does the operations of the portable kernel in the same order, many lanes at a time;
//! none is fused, so the bits are the same.

// Vector instructions are intrinsics, which are unsafe where the processor may not have them.
#![allow(unsafe_code)]

mod lanes;
mod spread;
mod triangles;

use std::arch::x86_64::*;

use super::Scene;
use super::few::Few;
use super::kernel::{BoxHits, Kernel, TriangleHits};
use super::leaf::{BlockIds, Corners};
use super::node::ChildRef;
use super::node::{Planes, WIDTH};
use super::query::Query;
use super::ray::{LocalRay, Slab, Slabs};
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
        unsafe {
            match scene.few_within(plan.exhaustive) {
                Some(few) => intersect_few(self, (scene, few), rays, hits),
                None => intersect(self, scene, plan, rays, hits, filter),
            }
        }
    }

    /// Occlusion, by packets.
    pub fn occluded(self, scene: &Scene, plan: Plan, rays: &mut [RayPacket], filter: Option<&dyn HitFilter>) {
        // SAFETY: `self` proves that the processor has AVX2 and FMA.
        unsafe {
            match scene.few_within(plan.exhaustive) {
                Some(few) => occluded_few(self, (scene, few), rays),
                None => occluded(self, scene, plan, rays, filter),
            }
        }
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

#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
fn intersect_few(kernel: Avx2, few: (&Scene, &Few), rays: &[RayPacket], hits: &mut [HitPacket]) {
    stream::intersect_few(kernel, kernel, few, rays, hits);
}

#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
fn occluded_few(kernel: Avx2, few: (&Scene, &Few), rays: &mut [RayPacket]) {
    stream::occluded_few(kernel, kernel, few, rays);
}

const CACHE_LINE: usize = 64;

#[repr(align(32))]
struct Aligned<T>(T);

/// A vector for each axis.
type Wide = [__m256d; 3];

impl Kernel for Avx2 {
    #[inline(always)]
    fn boxes(self, planes: &Planes, slab: &Slab, tnear: f32, tfar: f32) -> BoxHits {
        // SAFETY: `self` proves that the processor has AVX2 and FMA.
        unsafe { boxes(planes, slab, tnear, tfar) }
    }

    #[inline(always)]
    fn triangles(self, corners: &Corners, ids: &BlockIds, mask: u32, shear: &Shear, range: [f32; 2]) -> TriangleHits {
        triangles::triangles(self, corners, ids, mask, shear, range, false)
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
fn slabs(planes: &Planes, ray: impl Slabs, tnear: f32, tfar: f32) -> (__m256, __m256) {
    let distances = |plane: usize, [scale, shift]: [f32; 2]| {
        let row: &[f32; WIDTH] = &planes.0[plane];
        // SAFETY: eight floats, aligned to 32 bytes as rows of `Planes` are.
        let row = unsafe { _mm256_load_ps(row.as_ptr()) };
        _mm256_fmadd_ps(row, _mm256_set1_ps(scale), _mm256_set1_ps(shift))
    };
    let near = |axis: usize| distances(2 * axis + (ray.negative(axis) & 1), ray.near(axis));
    let far = |axis: usize| distances(2 * axis + 1 - (ray.negative(axis) & 1), ray.far(axis));
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
