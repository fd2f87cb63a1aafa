//! Round curves: tubes of pieces, each the convex hull of two balls, as Embree and Mitsuba 3 have them. They are seen from outside only:
//! a ray that starts within, or comes in through an open end, passes.
//!
//! Where a line enters a piece is where it enters the cone that touches both balls, between the circles where it touches them, or one
//! of the balls beyond (after Quilez's round cone). In double precision, by one function for every backend.

use std::f64::consts::TAU;

use super::placement::Placement;
use super::shape::LineHits;
use super::surface::LocalSurface;
use super::triangle::LEAST_ERROR;
use crate::math::{Bounds3, DAffine3, DVec3, Vec2, Vec3};

/// A piece of a tube, object space.
#[derive(Clone, Copy, Debug)]
pub struct TubePiece {
    /// The middles of the two balls.
    pub ends: [Vec3; 2],
    /// Their radii; not negative.
    pub radii: [f32; 2],
    /// How far along its curve they are, which is 1 - v of the texture coordinates.
    pub along: [f32; 2],
    /// Unit tangents of the curve at the ends, where it goes on smoothly: then the piece ends in the planes across them, and normals are
    /// those of the curve. `None` for a straight piece, which ends with its balls.
    pub tangents: Option<[Vec3; 2]>,
    /// Whether another straight piece ends where this one starts: then the ball there is that one's, as in Embree, so that coordinates
    /// around it do not depend on who is asked first.
    pub is_joined: bool,
}

/// Pieces of tubes; each is a primitive.
#[derive(Clone, Debug)]
pub struct TubeSet {
    pieces: Vec<TubePiece>,
    placement: Placement,
}

/// A piece in the numbers that a line is tested with.
struct Hull {
    a: DVec3,
    axis: DVec3,
    radii: [f64; 2],
    /// How much smaller the second radius is.
    taper: f64,
    /// The square of the length of the axis less that of the taper: not positive if one ball holds the other.
    slant2: f64,
    tangents: Option<[DVec3; 2]>,
    /// The first end whose ball is tested.
    first_ball: usize,
}

/// Where a line enters a piece.
struct Entry {
    t: f64,
    /// From the first end to the second, of the ball that touches the surface here.
    fraction: f64,
}

impl Hull {
    fn new(piece: &TubePiece) -> Self {
        let [a, b] = piece.ends.map(Vec3::as_dvec3);
        let radii = piece.radii.map(f64::from);
        let (axis, taper) = (b - a, radii[0] - radii[1]);
        Self {
            a,
            axis,
            radii,
            taper,
            slant2: axis.length_squared() - taper * taper,
            tangents: piece.tangents.map(|tangents| tangents.map(Vec3::as_dvec3)),
            first_ball: usize::from(piece.is_joined),
        }
    }

    fn center(&self, fraction: f64) -> DVec3 {
        self.a + self.axis * fraction
    }

    fn radius(&self, fraction: f64) -> f64 {
        self.radii[0] - self.taper * fraction
    }

    /// Where the cone's circle through a point is: from 0 to `slant2` between those where it touches the balls.
    fn height(&self, p: DVec3) -> f64 {
        (p - self.a).dot(self.axis) - self.radii[0] * self.taper
    }

    /// The first place where the line `o + t d` comes in, `d` of unit length.
    fn entry(&self, o: DVec3, d: DVec3) -> Option<Entry> {
        // What is seen of a ball at a joint is beyond the end of the piece before: all else is inside that.
        let balls = (self.first_ball..2).map(|end| self.entry_of_ball(o, d, end));
        let [first, second] = self.entries_of_cone(o, d);
        let candidates = balls.chain([first, second]).flatten();
        candidates.min_by(|a, b| a.t.total_cmp(&b.t))
    }

    /// Into the ball at an end, beyond where the cone touches it.
    fn entry_of_ball(&self, o: DVec3, d: DVec3, end: usize) -> Option<Entry> {
        let fraction = end as f64;
        let (center, radius) = (self.center(fraction), self.radii[end]);
        let from = o - center;
        let along = from.dot(d);
        let discriminant = radius * radius - (from - d * along).length_squared();
        if discriminant.is_nan() || discriminant <= 0.0 {
            return None;
        }
        let t = -along - discriminant.sqrt();
        let p = o + d * t;
        let is_beyond = if self.slant2 <= 0.0 {
            // The larger ball holds the smaller one.
            (end == 0) == (self.taper > 0.0)
        } else if end == 0 {
            self.height(p) <= 0.0
        } else {
            self.height(p) >= self.slant2
        };
        let is_within = self.tangents.is_none_or(|tangents| {
            let out = if end == 0 { -tangents[0] } else { tangents[1] };
            // A little beyond the plane, as the next piece may touch the ball elsewhere: its slope is another.
            let slope = self.taper.abs() / self.axis.length().max(f64::MIN_POSITIVE);
            (p - center).dot(out) <= radius * (slope + 1e-6)
        });
        (is_beyond && is_within).then_some(Entry { t, fraction })
    }

    /// Into the cone, between where it touches the balls.
    fn entries_of_cone(&self, o: DVec3, d: DVec3) -> [Option<Entry>; 2] {
        let slant2 = self.slant2;
        if slant2 <= 0.0 {
            return [None, None];
        }
        let from = o - self.a;
        let (length2, radius) = (self.axis.length_squared(), self.radii[0]);
        let (along_o, along_d) = (self.axis.dot(from), self.axis.dot(d));
        let a = slant2 - along_d * along_d;
        let b = slant2 * d.dot(from) + along_d * (self.taper * radius - along_o);
        let c = slant2 * from.length_squared() - along_o * along_o
            + radius * (2.0 * along_o * self.taper - length2 * radius);
        let discriminant = b * b - a * c;
        if discriminant.is_nan() || discriminant < 0.0 {
            return [None, None];
        }
        let q = -(b + discriminant.sqrt().copysign(b));
        [c / q, q / a].map(|t| {
            let fraction = self.height(o + d * t) / slant2;
            if !(t.is_finite() && (0.0..=1.0).contains(&fraction)) {
                return None;
            }
            let outward = o + d * t - self.center(fraction);
            (outward.dot(d) < 0.0).then_some(Entry { t, fraction })
        })
    }
}

impl TubeSet {
    /// Tubes of these pieces; `None` if the transform is singular or anything is not finite.
    pub fn new(pieces: Vec<TubePiece>, world_from_object: DAffine3) -> Option<Self> {
        let placement = Placement::new(world_from_object)?;
        let is_finite = |piece: &TubePiece| {
            let vectors = piece.ends.iter().chain(piece.tangents.iter().flatten());
            vectors.into_iter().all(|v| v.is_finite()) && piece.radii.iter().chain(&piece.along).all(|x| x.is_finite())
        };
        pieces.iter().all(is_finite).then_some(Self { pieces, placement })
    }

    /// With the geometric normal on the inside.
    #[must_use]
    pub fn with_flipped_normal(mut self, flip: bool) -> Self {
        self.placement.flip_normal = flip;
        self
    }

    /// The pieces.
    pub fn pieces(&self) -> &[TubePiece] {
        &self.pieces
    }

    /// Bytes of its arrays.
    pub fn memory(&self) -> usize {
        size_of_val(self.pieces.as_slice())
    }

    /// A box around a piece.
    pub fn piece_bounds(&self, piece: usize) -> Bounds3 {
        let piece = &self.pieces[piece];
        let balls = piece
            .ends
            .map(Vec3::as_dvec3)
            .into_iter()
            .zip(piece.radii.map(f64::from));
        self.placement.box_around(balls)
    }

    /// Where the line of a ray comes into a piece from outside.
    #[inline]
    pub fn intersect(&self, piece: usize, origin: DVec3, direction: DVec3) -> LineHits {
        let hull = Hull::new(&self.pieces[piece]);
        LineHits::new(self.entry(&hull, origin, direction).map(|entry| entry.t), None)
    }

    /// The same, with the distance in units of the direction.
    fn entry(&self, hull: &Hull, origin: DVec3, direction: DVec3) -> Option<Entry> {
        let (o, d) = self.placement.ray(origin, direction);
        let length = d.length();
        let d = d / length;
        // From beside the piece, so that no digits are lost to the distance.
        let near = (hull.center(0.5) - o).dot(d);
        let entry = hull.entry(o + d * near, d)?;
        Some(Entry {
            t: (entry.t + near) / length,
            ..entry
        })
    }

    /// The surface where a ray meets a piece, or nearly does.
    pub(super) fn surface(&self, piece: usize, origin: DVec3, direction: DVec3) -> LocalSurface {
        let piece = &self.pieces[piece];
        let hull = Hull::new(piece);
        let (o, d) = self.placement.ray(origin, direction);
        // Where a backend saw a hit through an instance's rounded transform: the place beside the middle.
        let (near, fraction) = match self.entry(&hull, origin, direction) {
            Some(entry) => (o + d * entry.t, entry.fraction),
            None => {
                let p = o + d * ((hull.center(0.5) - o).dot(d) / d.length_squared());
                let along = (p - hull.a).dot(hull.axis) / hull.axis.length_squared();
                (p, if along.is_finite() { along.clamp(0.0, 1.0) } else { 0.0 })
            }
        };
        let center = hull.center(fraction);
        let outward = (near - center).try_normalize().unwrap_or_else(|| -d.normalize());
        let p = center + outward * hull.radius(fraction);
        let axis = hull.axis.try_normalize().unwrap_or(DVec3::X);
        let tangent = hull
            .tangents
            .map_or(axis, |[a, b]| a.lerp(b, fraction).try_normalize().unwrap_or(axis));
        let shading = match hull.tangents {
            None => outward,
            Some(_) => smooth_normal(outward, tangent, hull.taper / hull.axis.length()),
        };
        let along = piece.along.map(f64::from);
        let per_along = 1.0 / (along[1] - along[0]);
        LocalSurface {
            p: self.placement.point(p),
            error: LEAST_ERROR * f64::from(self.size(piece)),
            ng: self.placement.normal(outward),
            ns: self.placement.normal(shading).as_vec3(),
            dpdu: self.placement.vector(tangent.cross(p - center) * TAU),
            dpdv: self.placement.vector(-(hull.axis - outward * hull.taper) * per_along),
            uv: Vec2::new(
                turn(outward, tangent) as f32,
                (1.0 - (along[0] + (along[1] - along[0]) * fraction)) as f32,
            ),
            barycentrics: Vec2::ZERO,
        }
    }

    /// How large a piece is in the world, about.
    fn size(&self, piece: &TubePiece) -> f32 {
        let scale = self.placement.world_from_object.matrix3.to_cols_array().map(f64::abs);
        let scale = scale.into_iter().fold(0.0, f64::max) as f32;
        scale * ((piece.ends[1] - piece.ends[0]).length() + piece.radii[0] + piece.radii[1])
    }
}

/// The normal of a curve's tube, which gets thinner by `slope`, beside that of a piece of it.
fn smooth_normal(outward: DVec3, tangent: DVec3, slope: f64) -> DVec3 {
    let across = outward - tangent * tangent.dot(outward);
    match across.try_normalize() {
        Some(across) => (across * (1.0 - slope * slope).max(0.0).sqrt() + tangent * slope).normalize(),
        None => outward,
    }
}

/// How far around the axis a direction is, in [0, 1], as Mitsuba counts: from where the z axis of the object's space is a quarter.
fn turn(outward: DVec3, tangent: DVec3) -> f64 {
    let up = (DVec3::Z - tangent * tangent.z).try_normalize().unwrap_or(DVec3::Y);
    let beside = up.cross(tangent);
    let turn = up.dot(outward).atan2(beside.dot(outward)) / TAU;
    if turn < 0.0 { turn + 1.0 } else { turn }
}

#[cfg(test)]
mod tests;
