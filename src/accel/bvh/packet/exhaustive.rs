//! A packet of any rays against all primitives of a world that has few.

use super::Packet;
use super::triangles::{Facet, FacetIds};
use crate::accel::bvh::few::{self, Ball, Few};
use crate::accel::bvh::lanes::Lanes;
use crate::accel::bvh::prepare::{Rays, Row};
use crate::accel::bvh::query::Candidate;
use crate::geometry::{HitPacket, line_roots_or_nan};
use crate::math::DVec3;

/// Rays by the axes of their shears, which each has of its own.
struct Turned<F, U> {
    /// Which axes they are.
    axes: [U; 3],
    origin: [F; 3],
    /// See [`Shear::inverse`](crate::accel::bvh::triangle::Shear::inverse).
    inverse: [F; 2],
}

/// A triangle of few.
struct FewFacet<'a, F, U> {
    facet: &'a few::Facet,
    turned: &'a Turned<F, U>,
}

impl<S: Lanes<N>, const N: usize> Facet<S, N> for FewFacet<'_, S::F, S::U> {
    #[inline(always)]
    fn ids(&self) -> FacetIds {
        let [geometry, primitive] = self.facet.ids;
        FacetIds {
            mask: self.facet.mask,
            geometry,
            primitive,
            instance: HitPacket::NONE,
        }
    }

    #[inline(always)]
    fn corners(&self) -> [[f32; 3]; 3] {
        self.facet.points()
    }

    #[inline(always)]
    fn has_area(&self) -> bool {
        true
    }

    #[inline(always)]
    fn offsets(&self, s: S, _packet: &Packet<'_, N>) -> [[S::F; 3]; 3] {
        let [a, b, c] = &self.facet.corners;
        [
            [self.offset(s, a, 0), self.offset(s, b, 0), self.offset(s, c, 0)],
            [self.offset(s, a, 1), self.offset(s, b, 1), self.offset(s, c, 1)],
            [self.offset(s, a, 2), self.offset(s, b, 2), self.offset(s, c, 2)],
        ]
    }

    #[inline(always)]
    fn inverse(&self, _s: S, _packet: &Packet<'_, N>) -> [S::F; 2] {
        self.turned.inverse
    }

    #[inline(always)]
    fn plane_distances(&mut self, s: S, packet: &Packet<'_, N>) -> S::F {
        let (rays, plane) = (&packet.prepared.rays, &self.facet.plane);
        s.plane_distance(plane.normal, plane.corner, &rays.origin, &rays.direction)
    }
}

impl<F: Copy, U: Copy> FewFacet<'_, F, U> {
    #[inline(always)]
    fn offset<S: Lanes<N, F = F, U = U>, const N: usize>(&self, s: S, corner: &few::Choices, axis: usize) -> F {
        s.sub(s.pick(corner, self.turned.axes[axis]), self.turned.origin[axis])
    }
}

impl<const N: usize> Packet<'_, N> {
    /// Tests the rays of `lanes` against all primitives. Returns those that it leaves out, as their directions are of an unusual size.
    #[inline(always)]
    pub fn exhaust<S: Lanes<N>, const ANY: bool>(&mut self, s: S, few: &Few, lanes: u32) -> u32 {
        let usual = lanes & self.prepared.usual;
        let turned = &self.turned(s);
        let mut open = usual;
        for ball in &few.balls {
            self.ball(s, ball, open);
        }
        if ANY {
            open &= !self.hits(s);
        }
        for facet in &few.facets {
            let facet = FewFacet { facet, turned };
            if self.facet::<S, _, ANY>(s, facet, open) && ANY {
                open &= !self.hits(s);
                if open == 0 {
                    break;
                }
            }
        }
        lanes & !usual
    }

    #[inline(always)]
    fn turned<S: Lanes<N>>(&self, s: S) -> Turned<S::F, S::U> {
        let prepared = &self.prepared;
        let [is_x, is_y] = [s.mask(prepared.greatest[0]), s.mask(prepared.greatest[1])];
        // The greatest axis is the last; those after it, in cyclic order, precede it.
        let pick = |x: &Row<N>, y: &Row<N>, z: &Row<N>| s.blend(is_x, s.blend(is_y, s.load(z), s.load(y)), s.load(x));
        let pick_u = |x, y, z| s.blend_u(is_x, s.blend_u(is_y, s.splat_u(z), s.splat_u(y)), s.splat_u(x));
        let [x, y, z] = &prepared.rays.origin;
        let [inverse_x, inverse_y, inverse_z] = &prepared.inverse;
        Turned {
            axes: [pick_u(1, 2, 0), pick_u(2, 0, 1), pick_u(0, 1, 2)],
            origin: [pick(y, z, x), pick(z, x, y), pick(x, y, z)],
            inverse: [
                pick(inverse_y, inverse_z, inverse_x),
                pick(inverse_z, inverse_x, inverse_y),
            ],
        }
    }

    /// Tests rays against a sphere, as [`Query::offer_analytic`](crate::accel::bvh::query::Query::offer_analytic).
    #[inline(always)]
    fn ball<S: Lanes<N>>(&mut self, s: S, ball: &Ball, lanes: u32) {
        let rays = &self.prepared.rays;
        let radius = ball.sphere.radius();
        let [enter, leave] = if let Some(by) = ball.sphere.only_moved_by() {
            places(rays, radius, |origin| origin - by, |direction| direction)
        } else {
            let object = ball.sphere.object_from_world();
            let point = |origin| object.transform_point3(origin);
            places(rays, radius, point, |direction| object.transform_vector3(direction))
        };
        let (enter, leave) = (s.load(&enter), s.load(&leave));
        let (tnear, tfar) = (s.load(&rays.tnear), s.load(&rays.tfar));
        let enters = s.and(s.lt(tnear, enter), s.le(enter, tfar));
        let leaves = s.and(s.lt(tnear, leave), s.le(leave, tfar));
        let seen = s.bits(s.meet(s.load_u(&rays.mask), s.splat_u(ball.mask)));
        let met = (s.bits(enters) | s.bits(leaves)) & seen & lanes;
        if met == 0 {
            return;
        }
        let [geometry, primitive] = ball.ids;
        let candidate = Candidate {
            t: 0.0,
            geometry,
            primitive,
            instance: HitPacket::NONE,
        };
        self.take_all(s, s.blend(enters, leave, enter), met, &candidate);
    }
}

/// Where lines enter and leave a sphere of a radius about the origin of the space that `point` and `vector` bring them into; NaN where they miss it.
#[inline(always)]
fn places<const N: usize>(
    rays: &Rays<N>,
    radius: f64,
    point: impl Fn(DVec3) -> DVec3,
    vector: impl Fn(DVec3) -> DVec3,
) -> [Row<N>; 2] {
    let mut places = [[0.0; N]; 2];
    for lane in 0..N {
        let at = |rows: &[Row<N>; 3]| DVec3::new(rows[0][lane].into(), rows[1][lane].into(), rows[2][lane].into());
        let [first, second] = line_roots_or_nan(point(at(&rays.origin)), vector(at(&rays.direction)), radius);
        places[0][lane] = (if second < first { second } else { first }) as f32;
        places[1][lane] = (if second < first { first } else { second }) as f32;
    }
    places
}
