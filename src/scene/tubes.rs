//! Round curves to the pieces that rays meet.

use crate::desc::{TubeBasis, TubesDesc};
use crate::geometry::{TubePiece, TubeSet};
use crate::math::{DAffine3, DVec3, Vec3};

/// The curves as pieces; none if they are too large.
pub(super) fn tubes(desc: &TubesDesc, transform: &DAffine3) -> Option<TubeSet> {
    let segments = desc.segment_count();
    let mut pieces = Vec::with_capacity(segments);
    let (mut first, mut segment) = (0, 0);
    for &count in &desc.counts {
        let count = count as usize;
        let points = desc.points.get(first..first + count)?;
        let radii = desc.radii.get(first..first + count)?;
        let along = |segment: usize, fraction: f64| ((segment as f64 + fraction) / segments as f64) as f32;
        match desc.basis {
            TubeBasis::Linear => {
                for (i, (ends, radii)) in points.windows(2).zip(radii.windows(2)).enumerate() {
                    pieces.push(TubePiece {
                        ends: [ends[0], ends[1]],
                        radii: [radii[0], radii[1]],
                        along: [0.0, 1.0].map(|fraction| along(segment, fraction)),
                        tangents: None,
                        is_joined: i > 0,
                    });
                    segment += 1;
                }
            }
            TubeBasis::CubicBSpline => {
                for (points, radii) in points.windows(4).zip(radii.windows(4)) {
                    let spline = Segment::new(points, radii);
                    pieces.extend(spline.pieces(|fraction| along(segment, fraction)));
                    segment += 1;
                }
            }
        }
        first += count;
    }
    TubeSet::new(pieces, *transform)
}

/// A segment of a uniform cubic B-spline.
struct Segment {
    points: [DVec3; 4],
    radii: [f64; 4],
}

/// How far a piece may be from the curve, in its radii.
const TOLERANCE: f64 = 0.01;
/// By how much the tangent may turn in a piece, in radians.
const LARGEST_TURN: f64 = 0.15;
/// Pieces of a segment, at most.
const MOST: usize = 16;

impl Segment {
    fn new(points: &[Vec3], radii: &[f32]) -> Self {
        Self {
            points: std::array::from_fn(|i| points[i].as_dvec3()),
            radii: std::array::from_fn(|i| f64::from(radii[i])),
        }
    }

    fn at(&self, u: f64) -> (DVec3, f64) {
        let v = 1.0 - u;
        let weights = [
            v * v * v,
            3.0 * u * u * u - 6.0 * u * u + 4.0,
            3.0 * v * v * v - 6.0 * v * v + 4.0,
            u * u * u,
        ]
        .map(|w| w / 6.0);
        let point = self.points.iter().zip(weights).map(|(p, w)| *p * w).sum();
        let radius: f64 = self.radii.iter().zip(weights).map(|(r, w)| r * w).sum();
        (point, radius)
    }

    /// The unit tangent; the direction of the whole where the curve stands still.
    fn tangent(&self, u: f64) -> DVec3 {
        let [a, b, c, d] = self.points;
        let v = 1.0 - u;
        let derivative = (b - a) * (0.5 * v * v) + (c - b) * (0.5 + u * v) + (d - c) * (0.5 * u * u);
        let whole = || (d - a).try_normalize().unwrap_or(DVec3::X);
        derivative.try_normalize().unwrap_or_else(whole)
    }

    /// Into how many pieces it is divided.
    fn count(&self) -> usize {
        let ([a, b, c, d], [ra, rb, rc, rd]) = (self.points, self.radii);
        let bend = (a - 2.0 * b + c).length().max((b - 2.0 * c + d).length());
        let swell = (ra - 2.0 * rb + rc).abs().max((rb - 2.0 * rc + rd).abs());
        let radius = [0.0, 0.5, 1.0].map(|u| self.at(u).1).into_iter().fold(0.0, f64::max);
        // A chord is from its curve by an eighth of the second derivative.
        let by_distance = (bend.max(swell) / (8.0 * TOLERANCE * radius.max(f64::MIN_POSITIVE))).sqrt();
        let tangents = [0.0, 0.25, 0.5, 0.75, 1.0].map(|u| self.tangent(u));
        let turn: f64 = tangents.windows(2).map(|pair| pair[0].angle_between(pair[1])).sum();
        let count = by_distance.max(turn / LARGEST_TURN).ceil();
        (count as usize).clamp(1, MOST)
    }

    fn pieces(&self, along: impl Fn(f64) -> f32) -> impl Iterator<Item = TubePiece> {
        let count = self.count();
        (0..count).map(move |i| {
            let u = [i, i + 1].map(|i| i as f64 / count as f64);
            let [(a, ra), (b, rb)] = u.map(|u| self.at(u));
            TubePiece {
                ends: [a.as_vec3(), b.as_vec3()],
                radii: [ra as f32, rb as f32],
                along: u.map(&along),
                tangents: Some(u.map(|u| self.tangent(u).as_vec3())),
                is_joined: false,
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::DQuat;

    #[test]
    fn b_splines_are_on_their_curves_and_go_on_without_a_gap() {
        let points: Vec<Vec3> = (0..6)
            .map(|i| Vec3::new(i as f32, (i as f32).sin(), (0.5 * i as f32).cos()))
            .collect();
        let desc = TubesDesc {
            basis: TubeBasis::CubicBSpline,
            radii: vec![0.3, 0.1, 0.2, 0.2, 0.1, 0.05],
            counts: vec![6],
            points,
        };
        let set = tubes(&desc, &DAffine3::IDENTITY).unwrap();
        let pieces = set.pieces();
        for pair in pieces.windows(2) {
            assert!((pair[0].ends[1] - pair[1].ends[0]).length() < 1e-6);
            assert!((pair[0].radii[1] - pair[1].radii[0]).abs() < 1e-6);
            assert!((pair[0].tangents.unwrap()[1] - pair[1].tangents.unwrap()[0]).length() < 1e-5);
            assert!((pair[0].along[1] - pair[1].along[0]).abs() < 1e-6);
        }
        assert_eq!((pieces[0].along[0], pieces[pieces.len() - 1].along[1]), (0.0, 1.0));
        // At a knot: a sixth, two thirds, a sixth.
        let knot = (desc.points[0] + 4.0 * desc.points[1] + desc.points[2]) / 6.0;
        assert!((pieces[0].ends[0] - knot).length() < 1e-6);
        assert!((pieces[0].radii[0] - (0.3 + 0.4 + 0.2) / 6.0).abs() < 1e-6);
    }

    #[test]
    fn straight_segments_are_one_piece() {
        let segment = Segment::new(&[0.0, 1.0, 2.0, 3.0].map(|x| Vec3::X * x), &[0.1; 4]);
        assert_eq!(segment.count(), 1);
        let knot = Segment::new(&[Vec3::ZERO; 4], &[0.1; 4]);
        assert!(knot.count() >= 1 && knot.tangent(0.5).is_finite());
    }

    /// Where the radius changes, the next piece touches the ball of a joint elsewhere: there was a gap between the two, through which rays
    /// passed.
    #[test]
    fn no_ray_passes_a_joint() {
        let points = [[-1.0, 0.8], [-0.5, -0.9], [0.0, 1.0], [0.5, -0.9]].map(|[x, y]| Vec3::new(x, y, 0.1 * x));
        let radii = [0.15, 0.1, 0.25, 0.15];
        let desc = TubesDesc {
            basis: TubeBasis::CubicBSpline,
            points: points.to_vec(),
            radii: radii.to_vec(),
            counts: vec![4],
        };
        let tubes = tubes(&desc, &DAffine3::IDENTITY).unwrap();
        assert!(tubes.pieces().len() > 8);
        let segment = Segment::new(&points, &radii);
        let mut asked = 0;
        for i in 0..4000 {
            let u = 0.05 + 0.9 * f64::from(i) / 4000.0;
            let ((center, radius), tangent) = (segment.at(u), segment.tangent(u));
            let around = DQuat::from_axis_angle(tangent, 2.4 * f64::from(i));
            let direction = around * tangent.any_orthonormal_vector();
            let origin = center - direction * (1.1 * radius);
            let is_met = (0..tubes.pieces().len()).any(|piece| {
                let t = tubes.intersect(piece, origin, direction).from(0.0);
                t.is_some_and(|t| t < radius)
            });
            // From inside another part of a tight bend nothing is met.
            let is_outside = tubes.pieces().iter().all(|piece| {
                let [a, b] = piece.ends.map(Vec3::as_dvec3);
                let axis = b - a;
                let fraction = ((origin - a).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
                let reach = f64::from(piece.radii[0].max(piece.radii[1]));
                origin.distance(a + axis * fraction) > reach
            });
            assert!(is_met || !is_outside, "{u}");
            asked += usize::from(is_outside);
        }
        assert!(asked > 2000, "only {asked} rays came from outside");
    }
}
