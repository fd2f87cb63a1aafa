//! Surfaces that emit: single triangles and spheres.

use std::f32::consts::PI;

use super::{LightBounds, LightDensity, LightEnd, LightSample};
use crate::geometry::{LEAST_ERROR, triangle_error};
use crate::math::{Bounds3, DVec3, Frame, Vec2, Vec3, gamma};
use crate::sampling::{AreaPdf, SolidAnglePdf, warp};
use crate::spectrum::{CompiledSpectrum, SampledSpectrum, Wavelengths};

/// The surface of an area light. World space; it does not move.
#[derive(Clone, Copy, Debug)]
pub enum EmitterShape {
    /// A triangle.
    Triangle {
        /// Its corners.
        vertices: [Vec3; 3],
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
}

/// A surface that emits the same radiance in every direction of the side of its geometric normal, or of both.
#[derive(Clone, Debug)]
pub struct AreaLight {
    shape: EmitterShape,
    area: f32,
    /// Of a sampled point, see [`SurfaceInteraction::error`](crate::geometry::SurfaceInteraction::error); of a triangle only.
    error: f32,
    radiance: CompiledSpectrum,
    two_sided: bool,
}

/// A point of an emitter.
struct SurfaceSample {
    p: Vec3,
    error: f32,
    ng: Vec3,
    pdf: SolidAnglePdf,
}

impl AreaLight {
    /// With `radiance` in W·m⁻²·sr⁻¹·nm⁻¹. `None` if the shape has no area.
    pub fn new(shape: EmitterShape, radiance: CompiledSpectrum, two_sided: bool) -> Option<Self> {
        let area = shape.area();
        (area > 0.0).then(|| Self {
            area,
            error: shape.error(),
            shape,
            radiance,
            two_sided,
        })
    }

    /// This light, `factor` times as bright.
    #[must_use]
    pub fn scaled(self, factor: f32) -> Self {
        Self {
            radiance: self.radiance.scaled(factor),
            ..self
        }
    }

    /// Its surface area, one side.
    pub fn area(&self) -> f32 {
        self.area
    }

    /// How many sides emit.
    pub fn sides(&self) -> f32 {
        if self.two_sided { 2.0 } else { 1.0 }
    }

    /// Radiance emitted in direction `w` where the geometric normal is `ng`.
    #[inline]
    pub fn le(&self, ng: Vec3, w: Vec3, lambda: &Wavelengths) -> SampledSpectrum {
        if self.two_sided || ng.dot(w) > 0.0 {
            self.radiance.sample(lambda)
        } else {
            SampledSpectrum::ZERO
        }
    }

    /// Density, by solid angle at `from`, of the point `p` of the light, where its geometric normal is `ng`.
    #[inline]
    pub fn pdf_li(&self, from: Vec3, p: Vec3, ng: Vec3) -> SolidAnglePdf {
        if let EmitterShape::Sphere { center, radius, .. } = self.shape
            && let Some(cone) = Cone::towards(from, center, radius)
        {
            return warp::uniform_cone_pdf(cone.one_minus_cos);
        }
        self.uniform_pdf(from, p, ng)
    }

    /// The density by solid angle of a point chosen uniformly by area.
    fn uniform_pdf(&self, from: Vec3, p: Vec3, ng: Vec3) -> SolidAnglePdf {
        let to_light = p - from;
        let distance_squared = to_light.length_squared();
        let cos = ng.dot(to_light).abs() / distance_squared.sqrt();
        AreaPdf(1.0 / self.area).to_solid_angle(distance_squared, cos)
    }

    pub(super) fn sample_li(&self, from: Vec3, u: Vec2, lambda: &Wavelengths) -> Option<LightSample> {
        let sample = match &self.shape {
            EmitterShape::Triangle { vertices, ng } => self.sample_triangle(vertices, *ng, from, u),
            EmitterShape::Sphere { center, radius, inward } => self.sample_sphere(*center, *radius, *inward, from, u),
        };
        let wi = (sample.p - from).try_normalize()?;
        let li = self.le(sample.ng, -wi, lambda);
        (sample.pdf.0 > 0.0 && sample.pdf.0.is_finite() && !li.is_black()).then_some(LightSample {
            li,
            wi,
            end: LightEnd::Point {
                p: sample.p,
                error: sample.error,
                ng: sample.ng,
            },
            density: LightDensity::Continuous(sample.pdf),
        })
    }

    fn sample_triangle(&self, vertices: &[Vec3; 3], ng: Vec3, from: Vec3, u: Vec2) -> SurfaceSample {
        let b = warp::sample_uniform_triangle(u);
        let p = vertices[0] * b.x + vertices[1] * b.y + vertices[2] * b.z;
        SurfaceSample {
            p,
            error: self.error,
            ng,
            pdf: self.uniform_pdf(from, p, ng),
        }
    }

    /// Uniformly over the cone that the sphere fills, seen from outside; uniformly over its area, seen from inside or from the
    /// sphere itself.
    fn sample_sphere(&self, center: DVec3, radius: f64, inward: bool, from: Vec3, u: Vec2) -> SurfaceSample {
        let cone = Cone::towards(from, center, radius);
        let outward = match &cone {
            Some(cone) => cone.surface_direction(warp::sample_uniform_cone(u, cone.one_minus_cos), radius),
            None => warp::sample_uniform_sphere(u).as_dvec3(),
        };
        let p = (center + outward * radius).as_vec3();
        let ng = if inward { -outward } else { outward }.as_vec3();
        let pdf = match &cone {
            Some(cone) => warp::uniform_cone_pdf(cone.one_minus_cos),
            None => self.uniform_pdf(from, p, ng),
        };
        SurfaceSample {
            p,
            error: ng.abs().dot(p.abs()) * gamma(3) + (LEAST_ERROR * radius) as f32,
            ng,
            pdf,
        }
    }

    pub(super) fn bounds(&self) -> LightBounds {
        let radiance = self.radiance.photometric_luminance();
        match &self.shape {
            EmitterShape::Triangle { vertices, ng } => LightBounds {
                bounds: Bounds3::from_points(*vertices),
                axis: *ng,
                cos_normals: 1.0,
                cos_emission: 0.0,
                intensity: radiance * self.area,
                two_sided: self.two_sided,
            },
            // Of a sphere no more than half is seen from outside, and all of its area faces a point inside.
            EmitterShape::Sphere { center, radius, .. } => {
                let (center, radius) = (center.as_vec3(), *radius as f32);
                LightBounds::omnidirectional(
                    Bounds3::from_points([center]).expand(radius),
                    radiance * PI * radius * radius,
                )
            }
        }
    }

    pub(super) fn power(&self) -> f32 {
        self.sides() * PI * self.area * self.radiance.photometric_luminance()
    }
}

impl EmitterShape {
    /// Of any point sampled on a triangle: that of its plane, and the rounding of three weighted corners.
    fn error(&self) -> f32 {
        match self {
            Self::Triangle { vertices, ng } => {
                let largest = vertices.iter().fold(Vec3::ZERO, |m, v| m.max(v.abs()));
                triangle_error(&vertices.map(Vec3::as_dvec3)) as f32 + gamma(8) * ng.abs().dot(largest)
            }
            Self::Sphere { .. } => 0.0,
        }
    }

    fn area(&self) -> f32 {
        match self {
            Self::Triangle {
                vertices: [a, b, c], ..
            } => 0.5 * (*b - *a).cross(*c - *a).length(),
            Self::Sphere { radius, .. } => (4.0 * std::f64::consts::PI * radius * radius) as f32,
        }
    }
}

/// The cone of directions in which a sphere is seen from a point outside.
struct Cone {
    /// Unit direction to the centre.
    axis: DVec3,
    /// Distance to the centre.
    distance: f64,
    /// 1 - cos of its half angle, without cancellation.
    one_minus_cos: f32,
}

impl Cone {
    /// `None` from inside the sphere, and from so near to it that `from`, rounded to single precision, may stand for a point
    /// inside: on the sphere itself half of all points seem to be outside.
    fn towards(from: Vec3, center: DVec3, radius: f64) -> Option<Self> {
        let to_center = center - from.as_dvec3();
        let distance = to_center.length();
        let rounding = f64::from(gamma(1) * (from.x.abs() + from.y.abs() + from.z.abs()));
        if distance <= radius + rounding {
            return None;
        }
        let sin = radius / distance;
        let one_minus_cos = sin * sin / (1.0 + (1.0 - sin * sin).sqrt());
        Some(Self {
            axis: to_center / distance,
            distance,
            one_minus_cos: one_minus_cos as f32,
        })
    }

    /// The direction from the sphere's centre to the point where it is first met along `w`, a direction in the cone's local frame.
    fn surface_direction(&self, w: Vec3, radius: f64) -> DVec3 {
        let sin2 = f64::from(w.x) * f64::from(w.x) + f64::from(w.y) * f64::from(w.y);
        let cos = (1.0 - sin2).max(0.0).sqrt();
        let to_line2 = self.distance * self.distance * sin2;
        let t = self.distance * cos - (radius * radius - to_line2).max(0.0).sqrt();
        let frame = Frame::from_normal(self.axis.as_vec3());
        let across = (frame.s * w.x + frame.t * w.y).as_dvec3();
        ((across + self.axis * cos) * t - self.axis * self.distance).normalize()
    }
}
