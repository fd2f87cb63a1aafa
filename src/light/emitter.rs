//! Surfaces that emit as such: points sampled on each kind of shape, with their densities.

use std::f64::consts::PI;
use std::sync::Arc;

use super::patch::PatchEmitter;
use crate::geometry::{LEAST_ERROR, Quadric, Sphere, triangle_error};
use crate::math::{Bounds3, DVec3, Frame, Vec2, Vec3, gamma};
use crate::sampling::{AreaPdf, SolidAnglePdf, warp};

/// The surface of an area light at one time, world space.
#[derive(Clone, Debug)]
pub enum EmitterShape {
    /// A triangle.
    Triangle {
        /// Its corners.
        vertices: [Vec3; 3],
        /// Unit geometric normal, on the side that emits.
        ng: Vec3,
    },
    /// A parallelogram.
    Parallelogram {
        /// One of its corners.
        corner: Vec3,
        /// From there to the two next to it.
        edges: [Vec3; 2],
        /// Unit geometric normal, on the side that emits.
        ng: Vec3,
    },
    /// A sphere.
    Sphere {
        /// Its centre.
        center: DVec3,
        /// Its radius.
        radius: f64,
        /// Whether the normal, and so the side that emits, is inside.
        inward: bool,
    },
    /// A sphere that its transform has made an ellipsoid.
    Ellipsoid(Arc<Sphere>),
    /// A part of a sphere, a cylinder or a disk.
    Quadric(Arc<Quadric>),
    /// A bilinear patch.
    Patch(Arc<PatchEmitter>),
}

/// A point of an emitter, with its density: an [`AreaPdf`] or a [`SolidAnglePdf`].
pub(super) struct SurfaceSample<M> {
    pub p: Vec3,
    /// See [`SurfaceInteraction::error`](crate::geometry::SurfaceInteraction::error).
    pub error: f32,
    pub ng: Vec3,
    pub pdf: M,
    /// What texture coordinates are found by.
    pub at: SamplePlace,
}

/// Where on its shape a point is.
#[derive(Clone, Copy, Debug)]
pub(super) enum SamplePlace {
    /// Barycentric coordinates.
    Triangle(Vec3),
    /// Along the two edges.
    Parallelogram,
    /// Unit direction from the centre of a sphere, in the world.
    Sphere(DVec3),
    /// Unit direction from the centre of an ellipsoid, in object space.
    Ellipsoid(DVec3),
    /// Texture coordinates of other shapes.
    Coordinates(Vec2),
}

/// A shape with what does not change from point to point.
#[derive(Clone, Debug)]
pub(super) struct Emitter {
    pub shape: EmitterShape,
    /// Of a point chosen uniformly by area; not known where none is.
    uniform: AreaPdf,
    /// Of a point of a plane shape: that of its plane, and the rounding of three weighted corners.
    error: f32,
}

impl Emitter {
    /// `None` if the shape has no area.
    pub fn new(shape: EmitterShape) -> Option<Self> {
        let area = match &shape {
            EmitterShape::Ellipsoid(_) | EmitterShape::Quadric(_) | EmitterShape::Patch(_) => f32::INFINITY,
            _ => shape.area(),
        };
        (area > 0.0).then(|| Self {
            uniform: AreaPdf(1.0 / area),
            error: shape.error(),
            shape,
        })
    }

    /// The density of a point by area, and its [error](SurfaceSample::error), if it is plane.
    #[inline]
    pub fn plane_point_data(&self) -> (AreaPdf, f32) {
        (self.uniform, self.error)
    }

    /// Density, by solid angle at `from`, of [`Self::sample`] for the point `p`, where the geometric normal is `ng`.
    #[inline]
    pub fn pdf(&self, from: Vec3, p: Vec3, ng: Vec3) -> SolidAnglePdf {
        match self.cone(from) {
            Some(cone) => warp::uniform_cone_pdf(cone.one_minus_cos),
            None => area_to_solid_angle(self.pdf_area(p, ng), from, p, ng),
        }
    }

    /// Density of [`Self::sample_area`] for the point `p`, where the geometric normal is `ng`.
    #[inline]
    pub fn pdf_area(&self, p: Vec3, ng: Vec3) -> AreaPdf {
        match &self.shape {
            EmitterShape::Ellipsoid(sphere) => {
                let outward = sphere.object_from_world().transform_point3(p.as_dvec3()).normalize();
                ellipsoid_pdf(sphere, outward)
            }
            EmitterShape::Quadric(quadric) => AreaPdf(quadric.pdf(p.as_dvec3()) as f32),
            EmitterShape::Patch(patch) => AreaPdf(patch.pdf(p.as_dvec3(), ng.as_dvec3()) as f32),
            _ => self.uniform,
        }
    }

    /// The cone that a sphere fills, seen from outside; `None` for other shapes.
    #[inline]
    fn cone(&self, from: Vec3) -> Option<Cone> {
        match &self.shape {
            EmitterShape::Sphere { center, radius, .. } => Cone::towards(from, *center, *radius),
            _ => None,
        }
    }

    /// A point of the surface for `u` in [0, 1)²: uniformly over the cone that a sphere fills, seen from outside, else by
    /// [`Self::sample_area`].
    #[inline]
    pub fn sample(&self, from: Vec3, u: Vec2) -> SurfaceSample<SolidAnglePdf> {
        if let EmitterShape::Sphere { center, radius, inward } = &self.shape
            && let Some(cone) = Cone::towards(from, *center, *radius)
        {
            let outward = cone.surface_direction(warp::sample_uniform_cone(u, cone.one_minus_cos), *radius);
            let pdf = warp::uniform_cone_pdf(cone.one_minus_cos);
            return sphere_point(*center, *radius, *inward, outward, pdf);
        }
        let SurfaceSample { p, error, ng, pdf, at } = self.sample_area(u);
        let pdf = area_to_solid_angle(pdf, from, p, ng);
        SurfaceSample { p, error, ng, pdf, at }
    }

    /// A point of the surface for `u` in [0, 1)², wherever it is seen from: uniform by area; of an ellipsoid or another quadric the
    /// image of a uniform point of object space; of a patch nearly uniform.
    #[inline]
    pub fn sample_area(&self, u: Vec2) -> SurfaceSample<AreaPdf> {
        let plane = |p: Vec3, ng: Vec3, at: SamplePlace| SurfaceSample {
            p,
            error: self.error,
            ng,
            pdf: self.uniform,
            at,
        };
        match &self.shape {
            EmitterShape::Triangle { vertices, ng } => {
                let (p, barycentrics) = plane_point(vertices, true, u);
                plane(p, *ng, SamplePlace::Triangle(barycentrics))
            }
            EmitterShape::Parallelogram { corner, edges, ng } => {
                let (p, _) = plane_point(&[*corner, edges[0], edges[1]], false, u);
                plane(p, *ng, SamplePlace::Parallelogram)
            }
            EmitterShape::Sphere { center, radius, inward } => {
                let outward = warp::sample_uniform_sphere(u).as_dvec3().normalize();
                sphere_point(*center, *radius, *inward, outward, self.uniform)
            }
            EmitterShape::Ellipsoid(sphere) => sample_ellipsoid(sphere, u),
            EmitterShape::Quadric(quadric) => {
                let sample = quadric.sample(u);
                let at = SamplePlace::Coordinates(sample.uv);
                surface_point(sample.p, quadric.error(), sample.ng, AreaPdf(sample.pdf as f32), at)
            }
            EmitterShape::Patch(patch) => {
                let (uv, pdf) = patch.sample(u);
                let surface = &patch.surface;
                let at = SamplePlace::Coordinates(surface.texture_coordinates(uv));
                let (p, ng) = (surface.patch.point(uv), surface.ng(uv));
                surface_point(p, surface.error(), ng, AreaPdf(pdf as f32), at)
            }
        }
    }
}

/// A point, uniform by area, of the triangle with these corners, or of the parallelogram with the first as a corner and the others as
/// its edges; and the weights of the three. Without branches, so that it is vectorised over lanes.
#[inline(always)]
pub(super) fn plane_point(vectors: &[Vec3; 3], is_triangle: bool, u: Vec2) -> (Vec3, Vec3) {
    let barycentrics = warp::sample_uniform_triangle(u);
    let weight = |of_triangle, of_parallelogram| if is_triangle { of_triangle } else { of_parallelogram };
    let weights = Vec3::new(
        weight(barycentrics.x, 1.0),
        weight(barycentrics.y, u.x),
        weight(barycentrics.z, u.y),
    );
    let p = vectors[0] * weights.x + vectors[1] * weights.y + vectors[2] * weights.z;
    (p, weights)
}

/// A point that a backend sees off its place by `error`, and by rounding.
#[inline(always)]
fn surface_point<M>(p: DVec3, error: f64, ng: DVec3, pdf: M, at: SamplePlace) -> SurfaceSample<M> {
    let (p, ng) = (p.as_vec3(), ng.as_vec3());
    SurfaceSample {
        p,
        error: ng.abs().dot(p.abs()) * gamma(3) + error as f32,
        ng,
        pdf,
        at,
    }
}

/// The point of a sphere in the unit direction `outward` from its centre.
#[inline(always)]
pub(super) fn sphere_point<M>(center: DVec3, radius: f64, inward: bool, outward: DVec3, pdf: M) -> SurfaceSample<M> {
    let ng = outward * if inward { -1.0 } else { 1.0 };
    let at = SamplePlace::Sphere(outward);
    surface_point(center + outward * radius, LEAST_ERROR * radius, ng, pdf, at)
}

/// The image of a uniform point of the unit sphere.
fn sample_ellipsoid(sphere: &Sphere, u: Vec2) -> SurfaceSample<AreaPdf> {
    let outward = warp::sample_uniform_sphere(u).as_dvec3().normalize();
    let world = sphere.world_from_object().transform_point3(outward * sphere.radius());
    let normal = (sphere.object_from_world().matrix3.transpose() * outward).normalize();
    let ng = if sphere.has_flipped_normal() { -normal } else { normal };
    let error = LEAST_ERROR * (world - sphere.center()).length();
    let at = SamplePlace::Ellipsoid(outward);
    surface_point(world, error, ng, ellipsoid_pdf(sphere, outward), at)
}

/// The density by area of the image of a uniform point of the unit sphere: areas grow by |det M| |M⁻ᵀ n|.
fn ellipsoid_pdf(sphere: &Sphere, outward: DVec3) -> AreaPdf {
    let (m, inverse) = (sphere.world_from_object().matrix3, sphere.object_from_world().matrix3);
    let growth = m.determinant().abs() * (inverse.transpose() * outward).length();
    AreaPdf((1.0 / (4.0 * PI * sphere.radius().powi(2) * growth)) as f32)
}

/// The density by solid angle at `from` of the point `p`, where the geometric normal is `ng`.
#[inline(always)]
pub(super) fn area_to_solid_angle(pdf: AreaPdf, from: Vec3, p: Vec3, ng: Vec3) -> SolidAnglePdf {
    let to_light = p - from;
    let distance_squared = to_light.length_squared();
    let cos = ng.dot(to_light).abs() / distance_squared.sqrt();
    pdf.to_solid_angle(distance_squared, cos)
}

impl EmitterShape {
    /// Two triangles as the one parallelogram that they make up, as a rectangle of a scene does: one light to choose instead of
    /// two, and one domain to spread points over. `None` if they do not.
    pub fn joined(&self, other: &Self) -> Option<Self> {
        let (
            Self::Triangle { vertices: a, ng },
            Self::Triangle {
                vertices: b,
                ng: other_ng,
            },
        ) = (self, other)
        else {
            return None;
        };
        // The corner of each that the other does not have, opposite to the edge that they share.
        let lone = |of: &[Vec3; 3], other: &[Vec3; 3]| {
            let mut alone = (0..3).filter(|&i| !other.contains(&of[i]));
            alone.next().filter(|_| alone.next().is_none())
        };
        let (i, j) = (lone(a, b)?, lone(b, a)?);
        let (corner, ends) = (a[i], [a[(i + 1) % 3], a[(i + 2) % 3]]);
        let edges = ends.map(|end| end - corner);
        // The two need not be equal to the last bit: the error of a point allows for some roundings.
        let gap = (ends[0] - b[j] + edges[1]).abs();
        let largest = a.iter().fold(b[j].abs(), |m, v| m.max(v.abs()));
        let is_parallelogram = gap.cmple(largest * gamma(3)).all();
        (is_parallelogram && ng.dot(*other_ng) > 0.99).then_some(Self::Parallelogram { corner, edges, ng: *ng })
    }

    fn error(&self) -> f32 {
        let plane_error = |vertices: &[Vec3; 3], ng: &Vec3, largest: Vec3| {
            triangle_error(&vertices.map(Vec3::as_dvec3)) as f32 + gamma(8) * ng.abs().dot(largest)
        };
        match self {
            Self::Triangle { vertices, ng } => {
                plane_error(vertices, ng, vertices.iter().fold(Vec3::ZERO, |m, v| m.max(v.abs())))
            }
            Self::Parallelogram { corner, edges, ng } => {
                let [a, b] = edges.map(|edge| *corner + edge);
                let largest = [a, b, a + edges[1]].iter().fold(corner.abs(), |m, v| m.max(v.abs()));
                plane_error(&[*corner, a, b], ng, largest)
            }
            Self::Sphere { .. } | Self::Ellipsoid(_) | Self::Quadric(_) | Self::Patch(_) => 0.0,
        }
    }

    /// One side. Slow for ellipsoids and other quadrics.
    pub fn area(&self) -> f32 {
        match self {
            Self::Triangle {
                vertices: [a, b, c], ..
            } => 0.5 * (*b - *a).cross(*c - *a).length(),
            Self::Parallelogram { edges: [a, b], .. } => a.cross(*b).length(),
            Self::Sphere { radius, .. } => (4.0 * PI * radius * radius) as f32,
            Self::Ellipsoid(sphere) => ellipsoid_area(sphere),
            Self::Quadric(quadric) => quadric.area() as f32,
            Self::Patch(patch) => patch.area() as f32,
        }
    }

    /// A box around it.
    pub fn bounds(&self) -> Bounds3 {
        match self {
            Self::Triangle { vertices, .. } => Bounds3::from_points(*vertices),
            Self::Parallelogram { corner, edges, .. } => {
                let [a, b] = edges.map(|edge| *corner + edge);
                Bounds3::from_points([*corner, a, b, a + edges[1]])
            }
            Self::Sphere { center, radius, .. } => {
                let largest = center.abs().max_element() as f32;
                Bounds3::from_points([center.as_vec3()]).expand(*radius as f32 * (1.0 + gamma(2)) + largest * gamma(1))
            }
            Self::Ellipsoid(sphere) => sphere.bounds(),
            Self::Quadric(quadric) => quadric.bounds(),
            Self::Patch(patch) => patch.surface.patch.bounds(),
        }
    }
}

/// By the midpoint rule over the sphere that it is the image of: there is no closed form.
fn ellipsoid_area(sphere: &Sphere) -> f32 {
    const STEPS: usize = 128;
    let mut sum = 0.0;
    for i in 0..2 * STEPS * STEPS {
        let z = 1.0 - 2.0 * ((i / (2 * STEPS)) as f64 + 0.5) / STEPS as f64;
        let (sin, cos) = (PI * ((i % (2 * STEPS)) as f64 + 0.5) / STEPS as f64).sin_cos();
        let r = (1.0 - z * z).sqrt();
        sum += 1.0 / f64::from(ellipsoid_pdf(sphere, DVec3::new(r * cos, r * sin, z)).0);
    }
    (sum / (2 * STEPS * STEPS) as f64) as f32
}

/// The cone of directions in which a sphere is seen from a point outside.
pub(super) struct Cone {
    /// Unit direction to the centre.
    axis: DVec3,
    /// Distance to the centre.
    distance: f64,
    /// 1 - cos of its half angle, without cancellation.
    pub one_minus_cos: f32,
}

impl Cone {
    /// `None` where `from` is not [outside](Self::is_outside).
    fn towards(from: Vec3, center: DVec3, radius: f64) -> Option<Self> {
        Self::is_outside(from, center, radius).then(|| Self::of(from, center, radius))
    }

    /// False inside the sphere, and so near to it that `from`, rounded to single precision, may stand for a point inside: on the
    /// sphere itself half of all points seem to be outside.
    #[inline(always)]
    pub fn is_outside(from: Vec3, center: DVec3, radius: f64) -> bool {
        let distance = (center - from.as_dvec3()).length();
        let rounding = f64::from(gamma(1) * (from.x.abs() + from.y.abs() + from.z.abs()));
        distance > radius + rounding
    }

    /// From outside.
    #[inline(always)]
    pub fn of(from: Vec3, center: DVec3, radius: f64) -> Self {
        let to_center = center - from.as_dvec3();
        let distance = to_center.length();
        let sin = radius / distance;
        let one_minus_cos = sin * sin / (1.0 + (1.0 - sin * sin).sqrt());
        Self {
            axis: to_center / distance,
            distance,
            one_minus_cos: one_minus_cos as f32,
        }
    }

    /// The direction from the sphere's centre to the point where it is first met along `w`, a direction in the cone's local frame.
    #[inline(always)]
    pub fn surface_direction(&self, w: Vec3, radius: f64) -> DVec3 {
        let sin2 = f64::from(w.x) * f64::from(w.x) + f64::from(w.y) * f64::from(w.y);
        let cos = (1.0 - sin2).max(0.0).sqrt();
        let to_line2 = self.distance * self.distance * sin2;
        let t = self.distance * cos - (radius * radius - to_line2).max(0.0).sqrt();
        let frame = Frame::from_normal(self.axis.as_vec3());
        let across = (frame.s * w.x + frame.t * w.y).as_dvec3();
        ((across + self.axis * cos) * t - self.axis * self.distance).normalize()
    }
}
