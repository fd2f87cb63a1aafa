//! A packet against spheres of few.

use super::Packet;
use crate::accel::bvh::few::Ball;
use crate::accel::bvh::lanes::Lanes;
use crate::accel::bvh::prepare::{Rays, Row};
use crate::accel::bvh::query::Candidate;
use crate::geometry::{HitPacket, line_roots_or_nan};
use crate::math::DVec3;

impl<const N: usize> Packet<'_, N> {
    /// Tests rays against a sphere, as [`Query::offer_analytic`](crate::accel::bvh::query::Query::offer_analytic).
    #[inline(always)]
    pub(super) fn ball<S: Lanes<N>>(&mut self, s: S, ball: &Ball, lanes: u32) {
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
        let met = (s.bits(enters) | s.bits(leaves)) & lanes;
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
