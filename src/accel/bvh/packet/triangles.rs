//! A packet against triangles: one after the other, a lane for each ray.

use super::Packet;
use crate::accel::bvh::lanes::{BlockPlanes, Lanes};
use crate::accel::bvh::leaf::{Block, Corners, FixedBlock, LANES as TRIANGLES};
use crate::accel::bvh::prepare::{Rays, Row};
use crate::accel::bvh::query::Candidate;
use crate::accel::bvh::triangle::Plane;

/// Which triangle is tested.
#[derive(Clone, Copy)]
pub struct FacetIds {
    pub mask: u32,
    pub geometry: u32,
    pub primitive: u32,
    pub instance: u32,
}

/// A triangle as the rays of a packet see it, each by the axes of its own shear.
pub trait Facet<S: Lanes<N>, const N: usize> {
    fn ids(&self) -> FacetIds;

    fn corners(&self) -> [[f32; 3]; 3];

    /// Whether it has area: else no ray meets it, though rounding may seem to say so.
    fn has_area(&self) -> bool;

    /// The offsets of the corners from the origins of the rays, by axis.
    fn offsets(&self, s: S, packet: &Packet<'_, N>) -> [[S::F; 3]; 3];

    /// See [`Shear::inverse`](crate::accel::bvh::triangle::Shear::inverse).
    fn inverse(&self, s: S, packet: &Packet<'_, N>) -> [S::F; 2];

    /// See [`Plane::distance`](crate::accel::bvh::triangle::Plane::distance).
    fn plane_distances(&mut self, s: S, packet: &Packet<'_, N>) -> S::F;
}

/// A triangle of a block, for rays of one class.
struct BlockFacet<'a> {
    block: &'a FixedBlock,
    triangle: usize,
    instance: u32,
    /// Of the block, once they have been asked for.
    planes: &'a mut Option<BlockPlanes>,
}

impl<S: Lanes<N>, const N: usize> Facet<S, N> for BlockFacet<'_> {
    #[inline(always)]
    fn ids(&self) -> FacetIds {
        let (ids, triangle) = (self.block.ids(), self.triangle);
        FacetIds {
            mask: ids.mask[triangle],
            geometry: ids.geometry[triangle],
            primitive: ids.primitive[triangle],
            instance: self.instance,
        }
    }

    #[inline(always)]
    fn corners(&self) -> [[f32; 3]; 3] {
        self.block.fixed_corners().lane(self.triangle)
    }

    #[inline(always)]
    fn has_area(&self) -> bool {
        Plane::new(&self.block.fixed_corners().lane(self.triangle)).has_area()
    }

    #[inline(always)]
    fn offsets(&self, s: S, packet: &Packet<'_, N>) -> [[S::F; 3]; 3] {
        let offsets = Offsets::of(&packet.prepared.rays, self.block.fixed_corners(), self.triangle);
        let [x, y, z] = packet.axes;
        [offsets.along(s, x), offsets.along(s, y), offsets.along(s, z)]
    }

    #[inline(always)]
    fn inverse(&self, s: S, packet: &Packet<'_, N>) -> [S::F; 2] {
        let [x, y, _] = packet.axes;
        let rows = &packet.prepared.inverse;
        [s.load(&rows[x]), s.load(&rows[y])]
    }

    #[inline(always)]
    fn plane_distances(&mut self, s: S, packet: &Packet<'_, N>) -> S::F {
        let corners = self.block.fixed_corners();
        let planes = self.planes.get_or_insert_with(|| s.planes(corners));
        let (rays, [normal, corner]) = (&packet.prepared.rays, planes.of(self.triangle));
        s.plane_distance(normal, corner, &rays.origin, &rays.direction)
    }
}

impl<const N: usize> Packet<'_, N> {
    /// Tests the rays of `lanes` against the triangles of a block.
    #[inline(always)]
    pub fn block<S: Lanes<N>, const ANY: bool>(&mut self, s: S, block: &FixedBlock, lanes: u32, instance: u32) {
        let mut planes = None;
        for triangle in 0..TRIANGLES {
            if block.ids().mask[triangle] == 0 {
                continue;
            }
            let facet = BlockFacet {
                block,
                triangle,
                instance,
                planes: &mut planes,
            };
            self.facet::<S, _, ANY>(s, facet, lanes);
        }
    }

    /// Tests the rays of `lanes` against a triangle; says whether it may have changed what they have met.
    #[inline(always)]
    pub(super) fn facet<S: Lanes<N>, F: Facet<S, N>, const ANY: bool>(
        &mut self,
        s: S,
        mut facet: F,
        lanes: u32,
    ) -> bool {
        let [x, y, depth] = facet.offsets(s, self);
        let [ax, bx, cx] = sheared(s, x, &self.prepared.scale[0], depth);
        let [ay, by, cy] = sheared(s, y, &self.prepared.scale[1], depth);
        let u = s.sub(s.mul(cx, by), s.mul(cy, bx));
        let v = s.sub(s.mul(ax, cy), s.mul(ay, cx));
        let w = s.sub(s.mul(bx, ay), s.mul(by, ax));
        // A NaN is lost or makes neither true: the lane is not passed over here unless the other two differ in sign.
        let (lowest, highest) = (least(s, [u, v, w]), greatest(s, [u, v, w]));
        let zero = s.splat(0.0);
        let missed = s.and(s.lt(lowest, zero), s.lt(zero, highest));
        let possible = lanes & !s.bits(missed);
        if possible == 0 {
            return false;
        }
        let [inverse_x, inverse_y] = facet.inverse(s, self);
        let along_x = times(s, x, inverse_x);
        let along_y = times(s, y, inverse_y);
        let along_z = times(s, depth, s.load(&self.prepared.scale[2]));
        let first = greatest(s, [least(s, along_x), least(s, along_y), least(s, along_z)]);
        let last = least(s, [greatest(s, along_x), greatest(s, along_y), greatest(s, along_z)]);
        // Other rays miss the box, by rounding only.
        let boxed = s.le(first, last);
        let tnear = s.load(&self.prepared.rays.tnear);
        let tfar = s.load(&self.prepared.rays.tfar);
        let within = s.bits(s.and(s.lt(tnear, last), s.le(first, tfar))) | !s.bits(boxed);
        let ids = facet.ids();
        let seen = s.meet(s.load_u(&self.prepared.rays.mask), s.splat_u(ids.mask));
        let possible = possible & within & s.bits(seen);
        if possible == 0 {
            return false;
        }
        // Zero, or NaN where the products overflow.
        let sure = s.and(s.and(s.lt(zero, s.abs(u)), s.lt(zero, s.abs(v))), s.lt(zero, s.abs(w)));
        let candidate = Candidate {
            t: 0.0,
            geometry: ids.geometry,
            primitive: ids.primitive,
            instance: ids.instance,
        };
        let is_filtered = self.asked.is_filtered(candidate.geometry);
        let mut possible = possible;
        if ANY && !is_filtered {
            // Wherever in its box the triangle is met, that counts.
            let inside = s.and(s.and(s.lt(tnear, first), s.le(last, tfar)), s.and(sure, boxed));
            let certain = possible & s.bits(inside);
            let certain = if certain != 0 && facet.has_area() { certain } else { 0 };
            self.mark(s, certain, &candidate);
            possible &= !certain;
            if possible == 0 {
                return true;
            }
        }
        let distances = facet.plane_distances(s, self);
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
            self.offer(&facet.corners(), &distances, inside, inexact, candidate);
        }
        true
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
    let [da, db, dc] = times(s, depth, s.load(scale));
    [s.sub(a, da), s.sub(b, db), s.sub(c, dc)]
}

#[inline(always)]
fn times<S: Lanes<N>, const N: usize>(s: S, [a, b, c]: [S::F; 3], factor: S::F) -> [S::F; 3] {
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
