//! A packet against the triangles of a block: one after the other, a lane for each ray.

use super::Packet;
use crate::accel::bvh::lanes::Lanes;
use crate::accel::bvh::leaf::{Block, Corners, FixedBlock, LANES as TRIANGLES};
use crate::accel::bvh::prepare::{Rays, Row};
use crate::accel::bvh::query::Candidate;
use crate::accel::bvh::triangle::Plane;

impl<const N: usize> Packet<'_, N> {
    /// Tests the rays of `lanes` against the triangles of a block.
    #[inline(always)]
    pub fn block<S: Lanes<N>, const ANY: bool>(&mut self, s: S, block: &FixedBlock, lanes: u32, instance: u32) {
        let (ids, corners) = (block.ids(), block.fixed_corners());
        let mut planes = None;
        for triangle in 0..TRIANGLES {
            if ids.mask[triangle] == 0 {
                continue;
            }
            let [x, y, z] = self.axes;
            let offsets = Offsets::of(&self.prepared.rays, corners, triangle);
            let [x_offsets, y_offsets, depth] = [offsets.along(s, x), offsets.along(s, y), offsets.along(s, z)];
            let [ax, bx, cx] = sheared(s, x_offsets, &self.prepared.scale[0], depth);
            let [ay, by, cy] = sheared(s, y_offsets, &self.prepared.scale[1], depth);
            let u = s.sub(s.mul(cx, by), s.mul(cy, bx));
            let v = s.sub(s.mul(ax, cy), s.mul(ay, cx));
            let w = s.sub(s.mul(bx, ay), s.mul(by, ax));
            // A NaN is lost or makes neither true: the lane is not passed over here unless the other two differ in sign.
            let (lowest, highest) = (least(s, [u, v, w]), greatest(s, [u, v, w]));
            let zero = s.splat(0.0);
            let missed = s.and(s.lt(lowest, zero), s.lt(zero, highest));
            let possible = lanes & !s.bits(missed);
            if possible == 0 {
                continue;
            }
            let along_x = times(s, x_offsets, &self.prepared.inverse[x]);
            let along_y = times(s, y_offsets, &self.prepared.inverse[y]);
            let along_z = times(s, depth, &self.prepared.scale[2]);
            let first = greatest(s, [least(s, along_x), least(s, along_y), least(s, along_z)]);
            let last = least(s, [greatest(s, along_x), greatest(s, along_y), greatest(s, along_z)]);
            // Other rays miss the box, by rounding only.
            let boxed = s.le(first, last);
            let tnear = s.load(&self.prepared.rays.tnear);
            let tfar = s.load(&self.prepared.rays.tfar);
            let within = s.bits(s.and(s.lt(tnear, last), s.le(first, tfar))) | !s.bits(boxed);
            let seen = s.meet(s.load_u(&self.prepared.rays.mask), s.splat_u(ids.mask[triangle]));
            let mut possible = possible & within & s.bits(seen);
            if possible == 0 {
                continue;
            }
            // Zero, or NaN where the products overflow.
            let sure = s.and(s.and(s.lt(zero, s.abs(u)), s.lt(zero, s.abs(v))), s.lt(zero, s.abs(w)));
            let candidate = Candidate {
                t: 0.0,
                geometry: ids.geometry[triangle],
                primitive: ids.primitive[triangle],
                instance,
            };
            let is_filtered = self.asked.is_filtered(candidate.geometry);
            if ANY && !is_filtered {
                // Wherever in its box the triangle is met, that counts.
                let inside = s.and(s.and(s.lt(tnear, first), s.le(last, tfar)), s.and(sure, boxed));
                let certain = possible & s.bits(inside);
                if certain != 0 && Plane::new(&corners.lane(triangle)).has_area() {
                    self.mark(s, certain, &candidate);
                    possible &= !certain;
                    if possible == 0 {
                        continue;
                    }
                }
            }
            let planes = planes.get_or_insert_with(|| s.planes(corners));
            let distances = s.plane_distance(&planes.of(triangle), &s.widen(&self.prepared.rays));
            let t = s.least(s.greatest(distances, first), last);
            let finite = s.lt(s.abs(distances), s.splat(f32::INFINITY));
            let exact = possible & s.bits(s.and(s.and(sure, finite), boxed));
            let inside = exact & s.bits(s.and(s.lt(tnear, t), s.le(t, tfar)));
            let inexact = possible & !exact;
            if inexact == 0 && !is_filtered {
                self.take_all(s, t, inside, &candidate);
            } else {
                let mut distances = [0.0; N];
                s.store(t, &mut distances);
                self.offer(&corners.lane(triangle), &distances, inside, inexact, candidate);
            }
        }
    }

    /// Marks lanes as having met something.
    #[inline(always)]
    fn mark<S: Lanes<N>>(&mut self, s: S, lanes: u32, candidate: &Candidate) {
        let mask = s.mask(lanes);
        let ids = [candidate.geometry, candidate.primitive, candidate.instance];
        for (row, id) in self.ids.iter_mut().zip(ids) {
            s.store_u(s.blend_u(mask, s.load_u(row), s.splat_u(id)), row);
        }
    }

    /// Takes the hits of the lanes of `inside`, which are in the range of their rays, where they precede the nearest so far.
    #[inline(always)]
    pub(super) fn take_all<S: Lanes<N>>(&mut self, s: S, t: S::F, inside: u32, candidate: &Candidate) {
        let tfar = s.load(&self.prepared.rays.tfar);
        let closer = inside & s.bits(s.lt(t, tfar));
        let mask = s.mask(closer);
        s.store(s.blend(mask, tfar, t), &mut self.prepared.rays.tfar);
        let ids = [candidate.geometry, candidate.primitive, candidate.instance];
        self.mark(s, closer, candidate);
        let mut ties = inside & !closer;
        while ties != 0 {
            let lane = ties.trailing_zeros() as usize;
            ties &= ties - 1;
            if ids < self.ids.map(|row| row[lane]) {
                (0..3).for_each(|i| self.ids[i][lane] = ids[i]);
            }
        }
    }

    /// Offers hits one by one: those that single precision cannot decide, and those that a filter is asked about.
    #[cold]
    #[inline(never)]
    fn offer(
        &mut self,
        corners: &[[f32; 3]; 3],
        distances: &Row<N>,
        inside: u32,
        inexact: u32,
        mut candidate: Candidate,
    ) {
        let mut rest = inside | inexact;
        while rest != 0 {
            let lane = rest.trailing_zeros() as usize;
            rest &= rest - 1;
            let shear = self.prepared.shear(lane);
            candidate.t = distances[lane];
            let mut query = self.query(lane);
            if inexact >> lane & 1 != 0 {
                match shear.distance(corners) {
                    Some(t) if query.contains(t) => candidate.t = t,
                    _ => continue,
                }
            }
            if query.offer(&candidate, || shear.barycentrics(corners)) {
                self.take(lane, &query);
            }
        }
    }
}

/// A triangle's corners, seen from the origins of rays.
struct Offsets<'a, const N: usize> {
    rays: &'a Rays<N>,
    corners: &'a Corners,
    triangle: usize,
}

// Functions, not closures nor `array::map`: those may be left out of line, where they are compiled without the instructions of `S`.
impl<'a, const N: usize> Offsets<'a, N> {
    #[inline(always)]
    fn of(rays: &'a Rays<N>, corners: &'a Corners, triangle: usize) -> Self {
        Self {
            rays,
            corners,
            triangle,
        }
    }

    /// The offsets of the three corners along an axis.
    #[inline(always)]
    fn along<S: Lanes<N>>(&self, s: S, axis: usize) -> [S::F; 3] {
        [
            self.of_corner(s, 0, axis),
            self.of_corner(s, 1, axis),
            self.of_corner(s, 2, axis),
        ]
    }

    #[inline(always)]
    fn of_corner<S: Lanes<N>>(&self, s: S, corner: usize, axis: usize) -> S::F {
        let corner = s.splat(self.corners.0[corner][axis][self.triangle]);
        s.sub(corner, s.load(&self.rays.origin[axis]))
    }
}

/// Offsets across the rays, of the corners that are at `depth`.
#[inline(always)]
fn sheared<S: Lanes<N>, const N: usize>(s: S, [a, b, c]: [S::F; 3], scale: &Row<N>, depth: [S::F; 3]) -> [S::F; 3] {
    let [da, db, dc] = times(s, depth, scale);
    [s.sub(a, da), s.sub(b, db), s.sub(c, dc)]
}

#[inline(always)]
fn times<S: Lanes<N>, const N: usize>(s: S, [a, b, c]: [S::F; 3], factor: &Row<N>) -> [S::F; 3] {
    let factor = s.load(factor);
    [s.mul(factor, a), s.mul(factor, b), s.mul(factor, c)]
}

#[inline(always)]
fn least<S: Lanes<N>, const N: usize>(s: S, [a, b, c]: [S::F; 3]) -> S::F {
    s.least(s.least(a, b), c)
}

#[inline(always)]
fn greatest<S: Lanes<N>, const N: usize>(s: S, [a, b, c]: [S::F; 3]) -> S::F {
    s.greatest(s.greatest(a, b), c)
}
