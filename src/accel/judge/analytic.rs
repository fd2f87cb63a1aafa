//! What the judge finds about primitives that backends test in double precision, all by the same function: where the ray's margins
//! leave no choice, that function says what must be answered.

use super::line::{DISTANCE, Found, Line};
use crate::geometry::{Ray, Shape};
use crate::math::DVec3;

/// How many times its margins a line is moved, so that what lies between is covered too.
const WIDEN: f64 = 2.0;

impl Line {
    /// Whether and where the line meets a primitive of an analytic shape.
    ///
    /// The line is moved by its margins, at the distance of the primitive, along each axis and back. If it always meets the
    /// primitive as many times, it certainly meets it, at distances between those found, widened by their spread; else it may
    /// or may not meet it. In world space a backend has the very line, and there is no margin but that of the distance.
    /// A backend's surface may be off by `off`.
    pub(super) fn analytic(&self, shape: &Shape, primitive: usize, ray: &Ray, off: f64) -> Option<Found> {
        let bounds = shape.primitive_bounds(primitive);
        let to_center = (0.5 * (bounds.min + bounds.max)).as_dvec3() - self.origin;
        let reach = (to_center.length() + f64::from(bounds.extent().length())) / self.direction.length();
        let moved = WIDEN * (self.origin_margin + self.direction_margin * reach) + DVec3::splat(off);
        let shifts = [
            DVec3::ZERO,
            DVec3::X,
            DVec3::NEG_X,
            DVec3::Y,
            DVec3::NEG_Y,
            DVec3::Z,
            DVec3::NEG_Z,
        ];
        let shifts = &shifts[..if moved == DVec3::ZERO { 1 } else { 7 }];
        let hits: Vec<Vec<f64>> = shifts
            .iter()
            .map(|&shift| {
                shape
                    .line_hits(primitive, self.origin + shift * moved, self.direction)
                    .iter()
                    .collect()
            })
            .collect();
        let widened = |distances: &mut dyn Iterator<Item = f64>, certain: bool| {
            let none = [f64::INFINITY, f64::NEG_INFINITY];
            let [low, high] = distances.fold(none, |[low, high], t| [low.min(t), high.max(t)]);
            let off = high - low + DISTANCE * low.abs().max(high.abs()) + off / self.direction.length();
            (low <= high).then_some(Found {
                t: [low - off, high + off],
                certain,
            })
        };
        let count = hits[0].len();
        if hits.iter().any(|hits| hits.len() != count) {
            return widened(&mut hits.iter().flatten().copied(), false).and_then(|found| found.within(ray));
        }
        let mut nearest: Option<Found> = None;
        for place in 0..count {
            let found = widened(&mut hits.iter().map(|hits| hits[place]), true).and_then(|found| found.within(ray));
            nearest = match (nearest, found) {
                (Some(first), Some(second)) => Some(Found {
                    t: [first.t[0], second.t[1]],
                    certain: second.certain,
                }),
                (first, second) => first.or(second),
            };
            if nearest.is_some_and(|found| found.certain) {
                break;
            }
        }
        nearest
    }
}
