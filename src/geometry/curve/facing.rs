//! Curves as a backend's own primitives take them: cubic Bézier curves with radii, that face the ray.

use super::{CurveKind, CurveSet, bezier, width_at};
use crate::math::{DVec3, Vec3};

/// Most straight steps of a primitive that a backend's curve may have.
const MOST_STEPS: u32 = 16;

/// The primitives of a [`CurveSet`], world space.
#[derive(Clone, Debug)]
pub struct FacingCurves {
    /// Control points and radii; neighbours on a segment share one.
    pub points: Vec<[f32; 4]>,
    /// The first of the four control points of each primitive.
    pub first: Vec<u32>,
    /// Straight steps that are within a twentieth of the width of each.
    pub steps: u32,
    /// Half the width where it is greatest.
    pub largest_radius: f32,
}

impl CurveSet {
    /// The primitives as curves of a backend's own. `None` where those are another surface: of ribbons, of curves whose transform is not a
    /// turn with one scale (they face the ray in object space), of those that bend so tightly that it takes too many straight steps, and
    /// of too many.
    pub fn facing(&self) -> Option<FacingCurves> {
        let scale = self.uniform_scale().filter(|_| self.kind != CurveKind::Ribbon)?;
        let parts = 1_usize << self.depth;
        let per_segment = 3 * parts + 1;
        let count = self.segments.len() * per_segment;
        if u32::try_from(count).is_err() {
            return None;
        }
        let mut points = Vec::with_capacity(count);
        let mut first = Vec::with_capacity(self.primitive_count());
        let mut steps = 1;
        let mut largest_radius = 0.0_f32;
        for segment in &self.segments {
            let start = points.len();
            for part in 0..parts {
                let [u0, u1] = [part, part + 1].map(|i| i as f64 / parts as f64);
                let control = bezier::between(&segment.points.map(Vec3::as_dvec3), [u0, u1]);
                let widest = width_at(segment, u0).max(width_at(segment, u1));
                steps = steps.max(straight_steps(&control, widest)?);
                first.push((start + 3 * part) as u32);
                let taken = if part == 0 { 0 } else { 1 };
                for (i, p) in control.iter().enumerate().skip(taken) {
                    let radius = 0.5 * scale * width_at(segment, u0 + (u1 - u0) * i as f64 / 3.0);
                    let p = self.placement.point(*p).as_vec3();
                    points.push([p.x, p.y, p.z, radius as f32]);
                    largest_radius = largest_radius.max(radius as f32);
                }
            }
        }
        Some(FacingCurves {
            points,
            first,
            steps,
            largest_radius,
        })
    }

    /// How far, in world space, what [`Self::facing`] makes of a primitive may be from what [`Self::intersect`] meets: straight steps here
    /// and there are within a twentieth of the width.
    pub fn facing_error(&self, primitive: usize) -> f64 {
        let (segment, u) = self.part(primitive);
        let widest = u.map(|u| width_at(segment, u)).into_iter().fold(0.0, f64::max);
        self.uniform_scale().map_or(0.0, |scale| 2.0 * 0.05 * scale * widest)
    }

    /// By how much the transform scales in all directions alike; `None` if it does not.
    fn uniform_scale(&self) -> Option<f64> {
        let m = self.placement.world_from_object.matrix3;
        let axes = [m.x_axis, m.y_axis, m.z_axis];
        let square = axes[0].length_squared();
        let is_alike = |a: f64| (a - square).abs() <= 1e-6 * square;
        let is_square = |a: DVec3, b: DVec3| a.dot(b).abs() <= 1e-6 * square;
        let all = axes.iter().all(|a| is_alike(a.length_squared()));
        let square_on = is_square(axes[0], axes[1]) && is_square(axes[1], axes[2]) && is_square(axes[2], axes[0]);
        (all && square_on).then(|| square.sqrt())
    }
}

/// How many equal straight steps keep within a twentieth of the width; `None` if it takes too many.
fn straight_steps(points: &[DVec3; 4], width: f64) -> Option<u32> {
    let bend = |i: usize| (points[i] - 2.0 * points[i + 1] + points[i + 2]).length();
    // A chord is from its curve by an eighth of the second derivative.
    let steps = (6.0 * bend(0).max(bend(1)) / (8.0 * 0.05 * width)).sqrt().ceil();
    // Of no width there is nothing to see.
    let steps = if width > 0.0 { steps } else { 1.0 };
    (steps <= f64::from(MOST_STEPS)).then_some((steps as u32).max(1))
}
