//! Parts of spheres, cylinders and disks, in double precision from the parser to the hit. They are pbrt's, with its texture
//! coordinates: u goes once around the axis as far as the shape does, v along it (of a disk, from the rim inward).

use std::f64::consts::TAU;

use super::placement::Placement;
use super::shape::LineHits;
use super::sphere::line_roots;
use super::surface::LocalSurface;
use super::triangle::LEAST_ERROR;
use crate::math::{Bounds3, DAffine3, DVec2, DVec3, Vec2};

/// A part of a surface of revolution around the z axis of its object space, from angle 0 at the x axis on. An affine transform
/// may stretch it; it does not move by itself (an instance can move it).
#[derive(Clone, Debug)]
pub struct Quadric {
    kind: QuadricKind,
    /// Angle that it goes around, in (0, 2π].
    phi_max: f64,
    placement: Placement,
    /// Whether its texture coordinates are Mitsuba's of a disk.
    radial_uv: bool,
    /// Diagonal of its box.
    size: f64,
}

/// Which surface it is a part of. Object space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum QuadricKind {
    /// The part of a sphere around the origin between two heights.
    Sphere {
        /// Positive.
        radius: f64,
        /// The lower and the upper end, within the sphere; ascending.
        z: [f64; 2],
    },
    /// A cylinder around the z axis, without lids.
    Cylinder {
        /// Positive.
        radius: f64,
        /// The lower and the upper end; ascending.
        z: [f64; 2],
    },
    /// A disk, or a ring, perpendicular to the z axis.
    Disk {
        /// Where it crosses the z axis.
        height: f64,
        /// Positive.
        radius: f64,
        /// Of its hole, less than `radius`; may be 0.
        inner_radius: f64,
    },
}

impl QuadricKind {
    /// Whether its numbers are finite and it has an area.
    fn is_valid(&self) -> bool {
        let (numbers, has_extent) = match *self {
            Self::Sphere { radius, z: [low, high] } => (
                [radius, low, high],
                radius > 0.0 && -radius <= low && low < high && high <= radius,
            ),
            Self::Cylinder { radius, z: [low, high] } => ([radius, low, high], radius > 0.0 && low < high),
            Self::Disk {
                height,
                radius,
                inner_radius,
            } => (
                [height, radius, inner_radius],
                0.0 <= inner_radius && inner_radius < radius,
            ),
        };
        has_extent && numbers.iter().all(|x| x.is_finite())
    }

    /// The greatest distance from the axis, and the least and greatest height.
    fn extent(&self) -> (f64, [f64; 2]) {
        match *self {
            Self::Sphere { radius, z: [low, high] } => {
                let nearest = 0.0_f64.clamp(low, high);
                ((radius * radius - nearest * nearest).sqrt(), [low, high])
            }
            Self::Cylinder { radius, z } => (radius, z),
            Self::Disk { height, radius, .. } => (radius, [height; 2]),
        }
    }
}

impl Quadric {
    /// The part within the angle `phi_max` (radians, in (0, 2π]); `None` if that is no surface, or the transform is singular.
    pub fn new(kind: QuadricKind, phi_max: f64, world_from_object: DAffine3) -> Option<Self> {
        let placement = Placement::new(world_from_object)?;
        if !(kind.is_valid() && phi_max > 0.0 && phi_max <= TAU) {
            return None;
        }
        let mut quadric = Self {
            kind,
            phi_max,
            placement,
            radial_uv: false,
            size: 0.0,
        };
        quadric.size = f64::from(quadric.bounds().extent().length());
        Some(quadric)
    }

    /// With the geometric normal on the other side: that towards the axis, and of a disk that of negative z.
    #[must_use]
    pub fn with_flipped_normal(mut self, flip: bool) -> Self {
        self.placement.flip_normal = flip;
        self
    }

    /// With (1 - v, 1 - u) as its texture coordinates: of a disk the distance from the middle, and once around the other way.
    #[must_use]
    pub fn with_radial_uv(mut self, radial: bool) -> Self {
        self.radial_uv = radial;
        self
    }

    /// This one, placed by another transform after its own; `None` if the product is singular.
    pub fn transformed(&self, transform: &DAffine3) -> Option<Self> {
        let placed = Self::new(self.kind, self.phi_max, *transform * self.placement.world_from_object)?;
        let placed = placed.with_flipped_normal(self.placement.flip_normal);
        Some(placed.with_radial_uv(self.radial_uv))
    }

    /// Which surface it is a part of.
    pub fn kind(&self) -> QuadricKind {
        self.kind
    }

    /// World space (or that of the group) to object space.
    pub fn object_from_world(&self) -> &DAffine3 {
        &self.placement.object_from_world
    }

    /// A box around it; as if it went all the way around.
    pub fn bounds(&self) -> Bounds3 {
        let (radius, z) = self.kind.extent();
        let m = self.placement.world_from_object.matrix3;
        let across = DVec2::new(radius, radius);
        // The support of an ellipse along an axis of the world.
        let half = DVec3::from_array([0, 1, 2].map(|i| (across * DVec2::new(m.x_axis[i], m.y_axis[i])).length()));
        let center = self.placement.world_from_object.translation;
        let ends = z.map(|z| center + m.z_axis * z);
        let (mut min, mut max) = (ends[0].min(ends[1]) - half, ends[0].max(ends[1]) + half);
        if let QuadricKind::Sphere { radius, .. } = self.kind {
            let rows = m.transpose();
            let half = DVec3::new(rows.x_axis.length(), rows.y_axis.length(), rows.z_axis.length()) * radius;
            (min, max) = (min.max(center - half), max.min(center + half));
        }
        Bounds3::around(min, max)
    }

    /// Where the infinite line of a ray meets it.
    #[inline]
    pub fn intersect(&self, origin: DVec3, direction: DVec3) -> LineHits {
        let (o, d) = self.placement.ray(origin, direction);
        let Some([a, b]) = self.whole(o, d) else {
            return LineHits::NONE;
        };
        let keep = |t: f64| Some(t).filter(|&t| self.holds(o + d * t));
        LineHits::new(keep(a), keep(b))
    }

    /// Where a line of object space meets the whole surface; twice the same, if once.
    #[inline]
    fn whole(&self, o: DVec3, d: DVec3) -> Option<[f64; 2]> {
        let flat = DVec3::new(1.0, 1.0, 0.0);
        match self.kind {
            QuadricKind::Sphere { radius, .. } => line_roots(o, d, radius),
            QuadricKind::Cylinder { radius, .. } => line_roots(o * flat, d * flat, radius),
            QuadricKind::Disk { height, .. } => {
                let t = (height - o.z) / d.z;
                t.is_finite().then_some([t, f64::NAN])
            }
        }
    }

    /// Whether a point of the whole surface is on this part of it.
    #[inline]
    fn holds(&self, p: DVec3) -> bool {
        let is_between = match self.kind {
            QuadricKind::Sphere { radius, z: [low, high] } => {
                (low <= -radius || p.z >= low) && (high >= radius || p.z <= high)
            }
            QuadricKind::Cylinder { z: [low, high], .. } => (low..=high).contains(&p.z),
            QuadricKind::Disk {
                radius, inner_radius, ..
            } => {
                let r2 = p.truncate().length_squared();
                r2 <= radius * radius && r2 >= inner_radius * inner_radius
            }
        };
        is_between && (self.phi_max >= TAU || angle(p) <= self.phi_max)
    }

    /// A point near the surface, moved onto it.
    fn onto(&self, p: DVec3) -> DVec3 {
        match self.kind {
            QuadricKind::Sphere { radius, .. } => p.normalize() * radius,
            QuadricKind::Cylinder { radius, .. } => {
                let across = p.truncate();
                (across * (radius / across.length())).extend(p.z)
            }
            QuadricKind::Disk { height, .. } => p.truncate().extend(height),
        }
    }

    /// The unit normal at a point, object space, not flipped.
    fn normal(&self, p: DVec3) -> DVec3 {
        match self.kind {
            QuadricKind::Sphere { .. } => p.normalize(),
            QuadricKind::Cylinder { .. } => p.truncate().normalize().extend(0.0),
            QuadricKind::Disk { .. } => DVec3::Z,
        }
    }

    /// From the angle and the point to texture coordinates.
    fn uv(&self, phi: f64, p: DVec3) -> Vec2 {
        let v = match self.kind {
            QuadricKind::Sphere { radius, z } => {
                let [low, high] = z.map(|z| polar(z, radius));
                (polar(p.z, radius) - low) / (high - low)
            }
            QuadricKind::Cylinder { z: [low, high], .. } => (p.z - low) / (high - low),
            QuadricKind::Disk {
                radius, inner_radius, ..
            } => (radius - p.truncate().length()) / (radius - inner_radius),
        };
        let uv = DVec2::new(phi / self.phi_max, v).clamp(DVec2::ZERO, DVec2::ONE);
        let uv = if self.radial_uv {
            DVec2::new(1.0 - uv.y, 1.0 - uv.x)
        } else {
            uv
        };
        uv.as_vec2()
    }

    /// The derivatives of a point, object space, by its texture coordinates.
    fn derivatives(&self, p: DVec3) -> [DVec3; 2] {
        let dpdu = DVec3::new(-p.y, p.x, 0.0) * self.phi_max;
        let from_axis = p.truncate().length();
        let azimuth = p.truncate() / from_axis.max(f64::MIN_POSITIVE);
        let dpdv = match self.kind {
            QuadricKind::Sphere { radius, z } => {
                let [low, high] = z.map(|z| polar(z, radius));
                (azimuth * p.z).extend(-from_axis) * (high - low)
            }
            QuadricKind::Cylinder { z: [low, high], .. } => DVec3::Z * (high - low),
            QuadricKind::Disk {
                radius, inner_radius, ..
            } => (azimuth * (inner_radius - radius)).extend(0.0),
        };
        if self.radial_uv { [-dpdv, -dpdu] } else { [dpdu, dpdv] }
    }

    /// The surface where a ray meets it at `tnear` or behind, or nearly does.
    pub(super) fn surface(&self, origin: DVec3, direction: DVec3, tnear: f64) -> LocalSurface {
        let (o, d) = self.placement.ray(origin, direction);
        // Where a backend saw a hit through an instance's rounded transform: of the whole surface, or the point nearest to the axis.
        let t = self.intersect(origin, direction).from(tnear).unwrap_or_else(|| {
            let [a, b] = self.whole(o, d).unwrap_or([f64::NAN; 2]);
            let whole = LineHits::new(Some(a).filter(|t| !t.is_nan()), Some(b).filter(|t| !t.is_nan()));
            whole.from(tnear).unwrap_or(-o.dot(d) / d.length_squared())
        });
        let p = self.onto(o + d * t);
        let [dpdu, dpdv] = self.derivatives(p).map(|v| self.placement.vector(v));
        let ng = self.placement.normal(self.normal(p));
        LocalSurface {
            p: self.placement.point(p),
            error: self.error(),
            ng,
            ns: ng.as_vec3(),
            dpdu,
            dpdv,
            uv: self.uv(angle(p), p),
            barycentrics: Vec2::ZERO,
        }
    }

    /// How far from a point a backend may see the surface, beside the rounding of the point: its test is in double precision.
    pub fn error(&self) -> f64 {
        LEAST_ERROR * self.size
    }

    /// The point for `u` in [0, 1)², uniform by area in object space.
    pub fn sample(&self, u: Vec2) -> QuadricPoint {
        let u = u.as_dvec2();
        let phi = u.x * self.phi_max;
        let (sin, cos) = phi.sin_cos();
        let at = |from_axis: f64, z: f64| DVec3::new(from_axis * cos, from_axis * sin, z);
        let p = match self.kind {
            QuadricKind::Sphere { radius, z: [low, high] } => {
                let z = low + (high - low) * u.y;
                at((radius * radius - z * z).max(0.0).sqrt(), z)
            }
            QuadricKind::Cylinder { radius, z: [low, high] } => at(radius, low + (high - low) * u.y),
            QuadricKind::Disk {
                height,
                radius,
                inner_radius,
            } => {
                let (outer, inner) = (radius * radius, inner_radius * inner_radius);
                at((outer + (inner - outer) * u.y).sqrt(), height)
            }
        };
        QuadricPoint {
            p: self.placement.point(p),
            ng: self.placement.normal(self.normal(p)),
            uv: self.uv(phi, p),
            pdf: self.density(p),
        }
    }

    /// The density by area, in the world, of [`Quadric::sample`] for a point of the surface.
    pub fn pdf(&self, p: DVec3) -> f64 {
        self.density(self.placement.object_from_world.transform_point3(p))
    }

    /// The same for a point of object space: areas grow by |det M| |M⁻ᵀ n|.
    fn density(&self, p: DVec3) -> f64 {
        let normal = self.placement.object_from_world.matrix3.transpose() * self.normal(p);
        let growth = self.placement.world_from_object.matrix3.determinant().abs() * normal.length();
        1.0 / (self.object_area() * growth)
    }

    fn object_area(&self) -> f64 {
        self.phi_max
            * match self.kind {
                QuadricKind::Sphere { radius, z: [low, high] } | QuadricKind::Cylinder { radius, z: [low, high] } => {
                    radius * (high - low)
                }
                QuadricKind::Disk {
                    radius, inner_radius, ..
                } => 0.5 * (radius - inner_radius) * (radius + inner_radius),
            }
    }

    /// Its area in the world, one side: by the midpoint rule, which is exact where the transform scales evenly.
    pub fn area(&self) -> f64 {
        const STEPS: usize = 64;
        let area = |i: usize| {
            let u = (Vec2::new((i % STEPS) as f32, (i / STEPS) as f32) + 0.5) / STEPS as f32;
            1.0 / self.sample(u).pdf
        };
        (0..STEPS * STEPS).map(area).sum::<f64>() / (STEPS * STEPS) as f64
    }
}

/// A sampled point of a [`Quadric`], world space.
#[derive(Clone, Copy, Debug)]
pub struct QuadricPoint {
    /// The point.
    pub p: DVec3,
    /// Unit geometric normal.
    pub ng: DVec3,
    /// Texture coordinates.
    pub uv: Vec2,
    /// Density by area.
    pub pdf: f64,
}

/// The angle of a point around the z axis, in [0, 2π).
#[inline]
fn angle(p: DVec3) -> f64 {
    let phi = p.y.atan2(p.x);
    if phi < 0.0 { phi + TAU } else { phi }
}

/// The angle from the z axis at a height of a sphere.
fn polar(z: f64, radius: f64) -> f64 {
    (z / radius).clamp(-1.0, 1.0).acos()
}

#[cfg(test)]
mod tests;
