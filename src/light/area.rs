//! Surfaces that emit: single triangles, spheres, other quadrics, patches; at rest or in motion.

use std::f32::consts::PI;
use std::sync::Arc;

use super::coordinates::{Coordinates, sphere_uv};
use super::emission::{sample_side, side_pdf};
use super::emitter::{Emitter, EmitterShape, SamplePlace, SurfaceSample};
use super::image::EmissionImage;
use super::lanes::{PlainLight, PlainShape, PlaneLight, SphereLight};
use super::moving::{MovingEmitter, sphere_shape};
use super::{EmissionDensity, EmissionOrigin, EmissionSample, LightBounds, LightDensity, LightEnd, LightSample};
use crate::desc::AreaSpread;
use crate::geometry::Sphere;
use crate::math::{DMat3, Vec2, Vec3};
use crate::sampling::{AreaPdf, SolidAnglePdf};
use crate::spectrum::{CompiledSpectrum, SampledSpectrum, Wavelengths};
use crate::texture::{FloatTexture, TextureContext};

/// A surface that emits on the side of its geometric normal, or on both: the same radiance in every direction, or along the normal only.
#[derive(Clone, Debug)]
pub struct AreaLight {
    /// At time 0 if it moves.
    emitter: Emitter,
    area: f32,
    motion: Option<Arc<MovingEmitter>>,
    radiance: Radiance,
    two_sided: bool,
    /// With [`AreaSpread::Normal`], `radiance` is what leaves a unit of area.
    spread: AreaSpread,
    /// How much of the surface there is: rays pass it with the probability 1 - alpha.
    alpha: FloatTexture,
    /// If anything depends on them.
    coordinates: Option<Arc<Coordinates>>,
    /// Luminance, alpha included, on average over the surface; at time 0 if it moves.
    luminance: f32,
}

/// What each point of a surface emits.
#[derive(Clone, Debug)]
enum Radiance {
    /// The same everywhere.
    Constant(CompiledSpectrum),
    /// By texture coordinates, times a factor.
    Image(Arc<EmissionImage>, f32),
}

impl AreaLight {
    /// With `radiance` in W·m⁻²·sr⁻¹·nm⁻¹. `None` if the shape has no area.
    pub fn new(shape: EmitterShape, radiance: CompiledSpectrum, two_sided: bool) -> Option<Self> {
        let area = shape.area();
        Some(Self::of(Emitter::new(shape)?, area, None, radiance, two_sided))
    }

    fn of(
        emitter: Emitter,
        area: f32,
        motion: Option<Arc<MovingEmitter>>,
        radiance: CompiledSpectrum,
        two_sided: bool,
    ) -> Self {
        Self {
            emitter,
            area,
            motion,
            luminance: radiance.photometric_luminance(),
            radiance: Radiance::Constant(radiance),
            two_sided,
            spread: AreaSpread::Diffuse,
            alpha: FloatTexture::Constant(1.0),
            coordinates: None,
        }
    }

    /// A sphere that emits; an ellipsoid if its transform makes it one.
    pub fn sphere(sphere: &Sphere, radiance: CompiledSpectrum, two_sided: bool) -> Option<Self> {
        Self::new(sphere_shape(sphere), radiance, two_sided)
    }

    /// A surface that moves. `None` if it has no area at time 0.
    pub fn moving(emitter: MovingEmitter, radiance: CompiledSpectrum, two_sided: bool) -> Option<Self> {
        let at_start = emitter.at(0.0)?;
        let area = at_start.shape.area();
        Some(Self::of(at_start, area, Some(Arc::new(emitter)), radiance, two_sided))
    }

    /// With the radiances of an image by texture coordinates instead: (0, 0) is its lower left corner.
    #[must_use]
    pub fn with_image(self, image: Arc<EmissionImage>, coordinates: Coordinates) -> Self {
        Self {
            radiance: Radiance::Image(image, 1.0),
            coordinates: Some(Arc::new(coordinates)),
            ..self
        }
        .measured()
    }

    /// Lets rays pass with the probability 1 - `alpha`. As in pbrt-v4 a light whose alpha is 0 sends its light all the same, but only
    /// light samples find it.
    #[must_use]
    pub fn with_alpha(self, alpha: f32) -> Self {
        let alpha = FloatTexture::Constant(alpha.clamp(0.0, 1.0));
        Self { alpha, ..self }.measured()
    }

    /// Lets rays pass with the probability 1 - alpha by a texture, whose values are kept in [0, 1].
    #[must_use]
    pub fn with_alpha_texture(self, alpha: FloatTexture, coordinates: Coordinates) -> Self {
        Self {
            alpha,
            coordinates: Some(Arc::new(coordinates)),
            ..self
        }
        .measured()
    }

    /// With its light going where `spread` says.
    #[must_use]
    pub fn with_spread(self, spread: AreaSpread) -> Self {
        Self { spread, ..self }
    }

    /// This light, `factor` times as bright.
    #[must_use]
    pub fn scaled(self, factor: f32) -> Self {
        Self {
            radiance: match self.radiance {
                Radiance::Constant(radiance) => Radiance::Constant(radiance.scaled(factor)),
                Radiance::Image(image, scale) => Radiance::Image(image, scale * factor),
            },
            luminance: self.luminance * factor,
            ..self
        }
    }

    /// Whether only light that it sends out is found: no direction towards it brings any.
    pub(super) fn is_along_normals(&self) -> bool {
        self.spread == AreaSpread::Normal
    }

    /// Its power over that of a unit of its radiance.
    pub fn geometric_factor(&self) -> f32 {
        let directions = match self.spread {
            AreaSpread::Diffuse => PI,
            AreaSpread::Normal => 1.0,
        };
        self.sides() * directions * self.area
    }

    /// Whether no ray meets it.
    pub(super) fn is_delta(&self) -> bool {
        matches!(self.alpha, FloatTexture::Constant(alpha) if alpha <= 0.0)
    }

    /// See [`PlainLight`]; `None` if it is not one.
    pub(super) fn plain(&self) -> Option<PlainLight> {
        let is_plain = matches!(self.radiance, Radiance::Constant(_))
            && matches!(self.alpha, FloatTexture::Constant(1.0))
            && self.spread == AreaSpread::Diffuse;
        if self.motion.is_some() || !is_plain {
            return None;
        }
        let plane = |is_triangle: bool, vectors: [Vec3; 3], ng: Vec3| {
            let (pdf, error) = self.emitter.plane_point_data();
            PlainShape::Plane(PlaneLight {
                is_triangle,
                vectors,
                ng,
                error,
                pdf,
            })
        };
        let shape = match self.emitter.shape {
            EmitterShape::Triangle { vertices, ng } => plane(true, vertices, ng),
            EmitterShape::Parallelogram { corner, edges, ng } => plane(false, [corner, edges[0], edges[1]], ng),
            EmitterShape::Sphere { center, radius, inward } => {
                PlainShape::Sphere(SphereLight { center, radius, inward })
            }
            EmitterShape::Ellipsoid(_) | EmitterShape::Quadric(_) | EmitterShape::Patch(_) => return None,
        };
        Some(PlainLight {
            shape,
            two_sided: self.two_sided,
        })
    }

    /// What it emits everywhere, if that is the same; else 0.
    #[inline]
    pub(super) fn constant_radiance(&self, lambda: &Wavelengths) -> SampledSpectrum {
        match &self.radiance {
            Radiance::Constant(radiance) => radiance.sample(lambda),
            Radiance::Image(..) => SampledSpectrum::ZERO,
        }
    }

    /// What it emits everywhere and at all wavelengths, if that is the same; in rgb mode the latter is.
    pub(super) fn known_radiance(&self) -> Option<SampledSpectrum> {
        match &self.radiance {
            Radiance::Constant(radiance) => radiance.constant(),
            Radiance::Image(..) => None,
        }
    }

    /// Its surface area, one side; at time 0 if it moves.
    pub fn area(&self) -> f32 {
        self.area
    }

    /// How many sides emit.
    pub fn sides(&self) -> f32 {
        if self.two_sided { 2.0 } else { 1.0 }
    }

    /// Radiance emitted in direction `w`, but along the normal only, where the geometric normal is `ng` and the texture coordinates are `uv`.
    #[inline]
    pub fn le(&self, ng: Vec3, uv: Vec2, w: Vec3, lambda: &Wavelengths) -> SampledSpectrum {
        if self.is_along_normals() || (!self.two_sided && ng.dot(w) <= 0.0) {
            return SampledSpectrum::ZERO;
        }
        self.radiance_at(uv, lambda)
    }

    #[inline]
    fn radiance_at(&self, uv: Vec2, lambda: &Wavelengths) -> SampledSpectrum {
        match &self.radiance {
            Radiance::Constant(radiance) => radiance.sample(lambda),
            Radiance::Image(image, scale) => image.sample_bilinear(uv, lambda) * *scale,
        }
    }

    /// How much of the surface there is at a point of it, as the rays that meet it find; all of one that none meets.
    #[inline]
    fn alpha_at(&self, p: Vec3, ng: Vec3, uv: Vec2) -> f32 {
        match &self.alpha {
            FloatTexture::Constant(alpha) if *alpha <= 0.0 => 1.0,
            FloatTexture::Constant(alpha) => *alpha,
            texture => texture.evaluate(&TextureContext::at_point(p, ng, uv)).clamp(0.0, 1.0),
        }
    }

    /// Radiance that leaves a sampled point in direction `w`, on average over the rays that meet it and pass it.
    #[inline]
    fn le_of<M>(&self, sample: &SurfaceSample<M>, time: f32, w: Vec3, lambda: &Wavelengths) -> SampledSpectrum {
        let uv = self.uv(sample.at, time);
        self.le(sample.ng, uv, w, lambda) * self.alpha_at(sample.p, sample.ng, uv)
    }

    /// What `ask` says of the emitter at a time; `None` if it has no area then.
    #[inline]
    fn at<T>(&self, time: f32, ask: impl Fn(&Emitter) -> T) -> Option<T> {
        match &self.motion {
            None => Some(ask(&self.emitter)),
            Some(motion) => motion.at(time).map(|emitter| ask(&emitter)),
        }
    }

    /// Density, by solid angle at `from`, of the point `p` of the light at `time`, where its geometric normal is `ng`.
    #[inline]
    pub fn pdf_li(&self, from: Vec3, p: Vec3, ng: Vec3, time: f32) -> SolidAnglePdf {
        self.at(time, |emitter| emitter.pdf(from, p, ng))
            .unwrap_or(SolidAnglePdf(0.0))
    }

    #[inline]
    pub(super) fn sample_li(&self, from: Vec3, time: f32, u: Vec2, lambda: &Wavelengths) -> Option<LightSample> {
        let sample = self.at(time, |emitter| emitter.sample(from, u))?;
        let wi = (sample.p - from).try_normalize()?;
        let li = self.le_of(&sample, time, -wi, lambda);
        let (li, density) = if self.is_delta() {
            (li * (1.0 / sample.pdf.0), LightDensity::Delta)
        } else {
            (li, LightDensity::Continuous(sample.pdf))
        };
        (sample.pdf.0 > 0.0 && sample.pdf.0.is_finite() && !li.is_black()).then_some(LightSample {
            li,
            wi,
            end: LightEnd::Point {
                p: sample.p,
                error: sample.error,
                ng: sample.ng,
            },
            density,
        })
    }

    /// A point by area, and a direction by its cosine, or the normal.
    pub(super) fn sample_le(
        &self,
        time: f32,
        u_position: Vec2,
        u_direction: Vec2,
        lambda: &Wavelengths,
    ) -> Option<EmissionSample> {
        let sample = self.at(time, |emitter| emitter.sample_area(u_position))?;
        if self.is_along_normals() {
            return self.sample_normal(&sample, time, u_direction, lambda);
        }
        let (p, ng) = (sample.p, sample.ng);
        let direction = sample_side(ng, self.two_sided, u_direction);
        let le = self.le_of(&sample, time, direction, lambda);
        let emission = EmissionSample {
            le: if self.is_delta() { le * (1.0 / sample.pdf.0) } else { le },
            origin: EmissionOrigin::Surface {
                p,
                error: sample.error,
                ng,
            },
            direction,
            density: self.density(sample.pdf, ng, direction),
            cos_theta: ng.dot(direction).abs(),
        };
        emission.checked()
    }

    /// A ray along the normal at a sampled point; of two sides either, by the first number.
    fn sample_normal(
        &self,
        sample: &SurfaceSample<AreaPdf>,
        time: f32,
        u: Vec2,
        lambda: &Wavelengths,
    ) -> Option<EmissionSample> {
        let (p, ng) = (sample.p, sample.ng);
        let uv = self.uv(sample.at, time);
        let emission = EmissionSample {
            le: self.radiance_at(uv, lambda) * (self.alpha_at(p, ng, uv) * self.sides()),
            origin: EmissionOrigin::Surface {
                p,
                error: sample.error,
                ng,
            },
            direction: if self.two_sided && u.x >= 0.5 { -ng } else { ng },
            density: EmissionDensity {
                position: LightDensity::Continuous(sample.pdf),
                direction: LightDensity::Delta,
            },
            cos_theta: 1.0,
        };
        emission.checked()
    }

    /// Densities of [`Self::sample_le`] for the ray in direction `w` from the point `p` of the light at `time`, where its geometric
    /// normal is `ng`.
    pub(super) fn pdf_le(&self, p: Vec3, ng: Vec3, w: Vec3, time: f32) -> (AreaPdf, SolidAnglePdf) {
        let position = self.at(time, |emitter| emitter.pdf_area(p, ng));
        (position.unwrap_or(AreaPdf(0.0)), side_pdf(ng, self.two_sided, w))
    }

    /// [`Self::pdf_le`]; as a light without extent if no ray meets it.
    pub(super) fn emission_density(&self, p: Vec3, ng: Vec3, w: Vec3, time: f32) -> EmissionDensity {
        let (position, _) = self.pdf_le(p, ng, w, time);
        self.density(position, ng, w)
    }

    fn density(&self, position: AreaPdf, ng: Vec3, w: Vec3) -> EmissionDensity {
        let direction = side_pdf(ng, self.two_sided, w);
        if self.is_delta() {
            return EmissionDensity::at_point(direction);
        }
        EmissionDensity::continuous((position, direction))
    }

    /// The texture coordinates of a sampled point, if anything depends on them.
    fn uv(&self, at: SamplePlace, time: f32) -> Vec2 {
        let Some(coordinates) = self.coordinates.as_deref() else {
            return Vec2::ZERO;
        };
        let in_world = match (at, coordinates) {
            (SamplePlace::Triangle(b), Coordinates::Corners([p, q, r])) => return *p * b.x + *q * b.y + *r * b.z,
            (SamplePlace::Coordinates(uv), _) => return uv,
            (SamplePlace::Triangle(_), Coordinates::Sphere(_) | Coordinates::Own) | (SamplePlace::Parallelogram, _) => {
                return Vec2::ZERO;
            }
            (SamplePlace::Ellipsoid(outward), _) => return sphere_uv(outward),
            (SamplePlace::Sphere(outward), _) => outward,
        };
        let moving = self.motion.as_ref().and_then(|motion| motion.object_from_world(time));
        let object_from_world = match (moving, coordinates) {
            (Some(moving), _) => moving,
            (None, Coordinates::Sphere(fixed)) => *fixed,
            (None, Coordinates::Corners(_) | Coordinates::Own) => DMat3::IDENTITY,
        };
        sphere_uv((object_from_world * in_world).normalize())
    }

    /// With its luminance on average over the surface: by some points for each pixel of an image that it shows, within reason.
    fn measured(self) -> Self {
        /// What it has at least of what it would have if it were as bright everywhere: the points may miss what there is.
        const LEAST: f32 = 1e-3;
        let whole = match &self.radiance {
            Radiance::Constant(radiance) => radiance.photometric_luminance(),
            Radiance::Image(image, scale) => image.mean_luminance() * scale,
        };
        let Some(coordinates) = self.coordinates.as_deref() else {
            return Self {
                luminance: whole * self.alpha_at(Vec3::ZERO, Vec3::Z, Vec2::ZERO),
                ..self
            };
        };
        let shown = match &self.radiance {
            Radiance::Constant(_) => 0.0,
            Radiance::Image(image, _) => coordinates.extent_in(image.size()),
        };
        let steps = (2.0 * shown).clamp(32.0, 512.0) as usize;
        let (mut sum, mut area) = (0.0, 0.0);
        for i in 0..steps * steps {
            let u = (Vec2::new((i % steps) as f32, (i / steps) as f32) + 0.5) / steps as f32;
            let sample = self.emitter.sample_area(u);
            let uv = self.uv(sample.at, 0.0);
            let luminance = match &self.radiance {
                Radiance::Constant(_) => whole,
                Radiance::Image(image, scale) => image.luminance_bilinear(uv) * scale,
            };
            sum += f64::from(luminance * self.alpha_at(sample.p, sample.ng, uv) / sample.pdf.0);
            area += f64::from(1.0 / sample.pdf.0);
        }
        Self {
            luminance: ((sum / area) as f32).max(LEAST * whole),
            ..self
        }
    }

    pub(super) fn bounds(&self) -> LightBounds {
        let (luminance, area) = (self.luminance, self.area);
        if let Some(motion) = &self.motion {
            return LightBounds::omnidirectional(motion.bounds(), luminance * area);
        }
        let bounds = self.emitter.shape.bounds();
        match &self.emitter.shape {
            EmitterShape::Triangle { ng, .. } | EmitterShape::Parallelogram { ng, .. } => LightBounds {
                bounds,
                axis: *ng,
                cos_normals: 1.0,
                cos_emission: 0.0,
                intensity: luminance * area,
                two_sided: self.two_sided,
            },
            // From outside about a quarter of the area is seen, projected.
            EmitterShape::Sphere { .. } | EmitterShape::Ellipsoid(_) => {
                LightBounds::omnidirectional(bounds, luminance * 0.25 * area)
            }
            // Of an open surface more than that, from some places.
            EmitterShape::Quadric(_) | EmitterShape::Patch(_) => {
                LightBounds::omnidirectional(bounds, luminance * 0.5 * area)
            }
        }
    }

    /// At time 0 if it moves.
    pub(super) fn power(&self) -> f32 {
        self.geometric_factor() * self.luminance
    }
}
