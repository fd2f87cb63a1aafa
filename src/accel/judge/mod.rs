//! The judge: decides in double precision what a ray may be said to hit.
//!
//! A backend works in single precision. Where a ray passes an edge, grazes a plane, or meets two surfaces at nearly one distance,
//! more than one answer is right. The judge intersects every primitive in double precision with margins that bound what single
//! precision may lose, and calls the ray [clear](Verdict::Clear) where that cannot change the answer, else
//! [ambiguous](Verdict::Ambiguous), with all that may be answered.
//!
//! # Margins
//!
//! With u = 2^-24, the unit roundoff of `f32`:
//!
//! - A corner, relative to the ray's origin, is moved across the ray by at most 4u (|x| + |z|) in the watertight test of Woop,
//!   Benthin and Wald (2013), x and z being its coordinates there. The judge takes 16.
//! - A moving corner is off by 3u of its coordinates, and by the rounding of time to a fraction of a segment.
//! - Through an instance, origin and direction of the ray are off by the rounding of its transform: 16u of the sums of absolute
//!   values of what is added there if it does not move, 64u if it does, times 1 + the condition of its matrix, as a backend may
//!   interpolate and invert it in single precision.
//!
//! - Tests by Plücker coordinates, with distances to the triangle's plane in single precision, need more: see
//!   [`Judge::with_pluecker_margins`].
//!
//! A corner's margin carries over to the edge functions, and from them to the distance as a mean of the corners' with their
//! weights: see `Line::triangle`.
//!
//! Spheres are intersected in double precision by the backends too; their margin is that of the ray through an instance, and
//! 16 roundings of the `f64` operations in units of the distances involved. Other shapes: see `Line::analytic`.

mod analytic;
mod line;

use std::sync::Arc;

use self::line::{Found, Line, corners};
use crate::geometry::{Geometry, GeometryId, Hit, InstanceId, PrimitiveId, Ray, Shape, World};

/// What may be answered about a ray.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// Only this.
    Clear(Option<Candidate>),
    /// Any of these; a miss too if `miss`.
    Ambiguous {
        /// In order of the least distance that each may have.
        candidates: Vec<Candidate>,
        /// Whether nothing need be hit.
        miss: bool,
    },
}

/// A hit that may be answered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// What is hit.
    pub hit: Hit,
    /// The least and the greatest distance that may be answered, in units of the ray's direction.
    pub t: [f64; 2],
    /// Whether the ray certainly hits it (though something nearer may hide it).
    pub certain: bool,
}

impl Candidate {
    /// Whether a backend may answer this with distance `t`.
    pub fn allows(&self, hit: Hit, t: f32) -> bool {
        self.hit == hit && (self.t[0]..=self.t[1]).contains(&f64::from(t))
    }
}

impl Verdict {
    /// Whether it is clear.
    pub fn is_clear(&self) -> bool {
        matches!(self, Self::Clear(_))
    }

    /// Whether a backend may answer that the nearest hit is `answer`, with its distance.
    pub fn allows(&self, answer: Option<(Hit, f32)>) -> bool {
        match (self, answer) {
            (Self::Clear(expected), Some((hit, t))) => expected.is_some_and(|candidate| candidate.allows(hit, t)),
            (Self::Clear(expected), None) => expected.is_none(),
            (Self::Ambiguous { candidates, .. }, Some((hit, t))) => candidates.iter().any(|c| c.allows(hit, t)),
            (Self::Ambiguous { miss, .. }, None) => *miss,
        }
    }

    /// Whether a backend may answer that the ray is occluded, or that it is not.
    pub fn allows_occluded(&self, occluded: bool) -> bool {
        match self {
            Self::Clear(expected) => expected.is_some() == occluded,
            Self::Ambiguous { miss, .. } => occluded || *miss,
        }
    }
}

/// Judges rays through a world.
pub struct Judge {
    world: Arc<World>,
    pluecker: bool,
}

impl Judge {
    /// Over `world`.
    pub fn new(world: &Arc<World>) -> Self {
        Self {
            world: Arc::clone(world),
            pluecker: false,
        }
    }

    /// With margins for backends that test by Plücker coordinates in single precision, as Embree's robust mode does.
    ///
    /// An edge function is there the product of the direction with (p - q) x (p + q), of corners p and q relative to the ray's
    /// origin: it is off by some 16u |p - q| |p + q|, however close to the ray they are. A distance is N . a / N . d, N being
    /// the cross product of two edges and a a corner. With the extent E of the triangle and the distance R of its farthest corner,
    /// N is off by some 16u E (E + R), which moves the plane by as much times E where the ray meets it, and N . a is off by
    /// 16u |N| R. Of a sliver, and of a triangle that is grazed, such a distance says nothing.
    ///
    /// Curves that face the ray are straight pieces there, within a tenth of the width of ours.
    #[must_use]
    pub fn with_pluecker_margins(mut self) -> Self {
        self.pluecker = true;
        self
    }

    /// The verdict about a [valid](Ray::is_valid) ray. Hits on filtered geometry count where `accept` says so.
    pub fn judge(&self, ray: &Ray, accept: impl Fn(Hit) -> bool) -> Verdict {
        let mut candidates = Vec::new();
        if ray.tnear <= ray.tfar {
            let line = Line::in_world(ray);
            for &id in self.world.root() {
                self.geometry(id, None, &line, ray, &mut candidates);
            }
            for (index, instance) in self.world.instances().iter().enumerate() {
                if instance.mask & ray.mask == 0 {
                    continue;
                }
                let line = Line::in_instance(ray, &instance.world_from_object);
                for &id in &self.world.groups()[instance.group.index()] {
                    let instance = Some(InstanceId::from_index(index));
                    self.geometry(id, instance, &line, ray, &mut candidates);
                }
            }
        }
        candidates.retain(|candidate| accept(candidate.hit));
        decide(candidates)
    }

    fn geometry(&self, id: GeometryId, instance: Option<InstanceId>, line: &Line, ray: &Ray, out: &mut Vec<Candidate>) {
        let geometry: &Geometry = self.world.geometry(id);
        if geometry.mask & ray.mask == 0 {
            return;
        }
        let mut add = |primitive: usize, found: Option<Found>| {
            if let Some(found) = found {
                out.push(Candidate {
                    hit: Hit {
                        geometry: id,
                        primitive: PrimitiveId::from_index(primitive),
                        instance,
                    },
                    t: found.t,
                    certain: found.certain,
                });
            }
        };
        match &geometry.shape {
            Shape::Mesh(mesh) => {
                for triangle in 0..mesh.triangle_count() {
                    let corners = corners(mesh, triangle, ray.time);
                    let mut found = line.triangle(&corners, self.pluecker);
                    if self.pluecker {
                        found = found.map(|found| line.rounded_plane(&corners, found));
                    }
                    add(triangle, found.and_then(|found| found.within(ray)));
                }
            }
            Shape::Spheres(spheres) => {
                for (index, sphere) in spheres.iter().enumerate() {
                    add(index, line.sphere(sphere, ray));
                }
            }
            shape => {
                for index in 0..shape.primitive_count() {
                    let off = match shape {
                        Shape::Curves(curves) if self.pluecker => curves.facing_error(index),
                        _ => 0.0,
                    };
                    add(index, line.analytic(shape, index, ray, off));
                }
            }
        }
    }
}

/// Of what may be hit, what may be the nearest.
fn decide(mut candidates: Vec<Candidate>) -> Verdict {
    let certain = candidates.iter().filter(|candidate| candidate.certain);
    let nearest = certain.map(|candidate| candidate.t[1]).fold(f64::INFINITY, f64::min);
    candidates.retain(|candidate| candidate.t[0] <= nearest);
    candidates.sort_by(|a, b| a.t[0].total_cmp(&b.t[0]));
    match candidates.as_slice() {
        [] => Verdict::Clear(None),
        [only] if only.certain => Verdict::Clear(Some(*only)),
        _ => Verdict::Ambiguous {
            miss: !candidates.iter().any(|candidate| candidate.certain),
            candidates,
        },
    }
}
