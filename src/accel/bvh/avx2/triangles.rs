//! A ray against the four triangles of a block.

use std::arch::x86_64::*;

use super::{Aligned, Avx2, Wide, lanes};
use crate::accel::bvh::kernel::TriangleHits;
use crate::accel::bvh::leaf::{BlockIds, Corners, LANES};
use crate::accel::bvh::triangle::{Plane, Shear, Shears};

/// A vector for each corner of four triangles.
type Rows = [__m128; 3];

/// See [`Kernel::triangles`](crate::accel::bvh::kernel::Kernel::triangles). With `any` it matters only whether one is met, not
/// where.
// Not a function of its own, in which fewer registers could be used.
#[inline(always)]
pub fn triangles(
    _proof: Avx2,
    corners: &Corners,
    ids: &BlockIds,
    mask: u32,
    ray: impl Shears,
    range: [f32; 2],
    any: bool,
) -> TriangleHits {
    // SAFETY: `_proof` is that the processor has AVX2 and FMA; four numbers are loaded from and stored to rows that are aligned to as much.
    unsafe {
        let rows = [
            offsets(corners, ray, 0),
            offsets(corners, ray, 1),
            offsets(corners, ray, 2),
        ];
        let [x, y, depth] = rows;
        let [ax, bx, cx] = minus(x, times(depth, ray.scale(0)));
        let [ay, by, cy] = minus(y, times(depth, ray.scale(1)));
        let u = _mm_sub_ps(_mm_mul_ps(cx, by), _mm_mul_ps(cy, bx));
        let v = _mm_sub_ps(_mm_mul_ps(ax, cy), _mm_mul_ps(ay, cx));
        let w = _mm_sub_ps(_mm_mul_ps(bx, ay), _mm_mul_ps(by, ax));
        // A NaN is lost or makes neither true: the lane is not passed over here unless the other two differ in sign.
        let zero = _mm_setzero_ps();
        let missed = _mm_and_ps(
            _mm_cmplt_ps(least([u, v, w]), zero),
            _mm_cmplt_ps(zero, greatest([u, v, w])),
        );
        let masks = _mm_load_si128(ids.mask.as_ptr().cast());
        let masked = _mm_cmpeq_epi32(_mm_and_si128(masks, _mm_set1_epi32(mask as i32)), _mm_setzero_si128());
        let missed = _mm_or_ps(missed, _mm_castsi128_ps(masked));
        let possible = !_mm_movemask_ps(missed) as u32 & 0xf;
        if possible == 0 {
            return TriangleHits {
                mask: 0,
                t: [0.0; LANES],
            };
        }
        // Zero, or NaN where the products overflow.
        let unsure = or(
            or(_mm_cmpngt_ps(size(u), zero), _mm_cmpngt_ps(size(v), zero)),
            _mm_cmpngt_ps(size(w), zero),
        );
        distances(corners, rows, possible, unsure, ray, range, any)
    }
}

/// Where the ray meets those triangles that it passes through or cannot tell.
#[inline(always)]
unsafe fn distances(
    corners: &Corners,
    [x, y, depth]: [Rows; 3],
    possible: u32,
    unsure: __m128,
    ray: impl Shears,
    range: [f32; 2],
    any: bool,
) -> TriangleHits {
    // SAFETY: the processor has AVX2 and FMA, as the caller knows; what is stored to is as large and as aligned as that needs.
    unsafe {
        let x = times(x, ray.inverse(0));
        let y = times(y, ray.inverse(1));
        let z = times(depth, ray.scale(2));
        let first = greatest([least(x), least(y), least(z)]);
        let last = least([greatest(x), greatest(y), greatest(z)]);
        let (tnear, tfar) = (_mm_set1_ps(range[0]), _mm_set1_ps(range[1]));
        // The ray misses the box.
        let beside = _mm_cmpnle_ps(first, last);
        // Or the box is not in the range, so that no hit is.
        let within = _mm_and_ps(_mm_cmplt_ps(tnear, last), _mm_cmple_ps(first, tfar));
        let possible = possible & _mm_movemask_ps(_mm_or_ps(within, beside)) as u32;
        let mut hits = TriangleHits {
            mask: 0,
            t: [0.0; LANES],
        };
        if possible == 0 {
            return hits;
        }
        if any {
            // Wherever in its box a triangle is met, that is in the range.
            let inside = _mm_and_ps(_mm_cmplt_ps(tnear, first), _mm_cmple_ps(last, tfar));
            let certain = possible & _mm_movemask_ps(_mm_andnot_ps(or(unsure, beside), inside)) as u32;
            let first = certain.trailing_zeros() as usize;
            // Without area no ray meets it, though rounding may seem to say so.
            if certain != 0 && Plane::new(&corners.lane(first % LANES)).has_area() {
                hits.mask = 1 << first;
                hits.t = [range[1]; LANES];
                return hits;
            }
        }
        let planes = plane_distances(corners, ray);
        let parallel = _mm_cmpnlt_ps(size(planes), _mm_set1_ps(f32::INFINITY));
        let t = _mm_min_ps(_mm_max_ps(planes, first), last);
        let inexact = possible & _mm_movemask_ps(or(or(unsure, parallel), beside)) as u32;
        let inside = _mm_and_ps(_mm_cmpgt_ps(t, tnear), _mm_cmple_ps(t, tfar));
        let mut distances = Aligned([0.0; LANES]);
        _mm_store_ps(distances.0.as_mut_ptr(), t);
        hits.t = distances.0;
        hits.mask = possible & !inexact & _mm_movemask_ps(inside) as u32;
        if inexact != 0 {
            resolve(&mut hits, inexact, corners, &ray.shear(), range);
        }
        hits
    }
}

#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
#[inline]
fn or(a: __m128, b: __m128) -> __m128 {
    _mm_or_ps(a, b)
}

#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
#[inline]
fn size(v: __m128) -> __m128 {
    _mm_andnot_ps(_mm_set1_ps(-0.0), v)
}

/// Coordinates of four triangles along one of the axes of a shear, relative to the origin.
#[target_feature(enable = "avx2,fma,bmi1,popcnt")]
#[inline]
fn offsets(corners: &Corners, ray: impl Shears, axis: usize) -> Rows {
    let row = ray.axis(axis);
    let origin = _mm_set1_ps(ray.origin(row));
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
fn plane_distances(corners: &Corners, ray: impl Shears) -> __m128 {
    let (corner, normal) = lanes::planes(corners);
    let origin = [ray.origin(0), ray.origin(1), ray.origin(2)].map(f64::from);
    let direction = [ray.direction(0), ray.direction(1), ray.direction(2)].map(f64::from);
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
