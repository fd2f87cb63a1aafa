//! Light of points that media scatter towards a path: near a point light it grows like 1/d², which flights by optical depth rarely meet.
//!
//! So each flight through a medium looks once more for the light of a point, from a place drawn in proportion to 1/d² (Kulla and Fajardo
//! 2012, "Importance Sampling Techniques for Path Tracing in Participating Media"), weighed by multiple importance sampling against the
//! light samples that are taken where flights end. Both draw a place on the ray and a light; the direction to it follows.

use super::flight::Flight;
use super::shadows::LightOnItsWay;
use super::{TravelLane, VolumePath, VolumeStage, ray_through_space};
use crate::desc::Strategy;
use crate::geometry::Ray;
use crate::integrator::numbers::EventNumbers;
use crate::light::LightId;
use crate::math::{DVec3, Vec3};
use crate::medium::{Coefficients, HenyeyGreenstein};
use crate::sampling::{SolidAnglePdf, power_heuristic};
use crate::scene::Scene;

/// A part of a ray through one medium, from its origin on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    pub origin: Vec3,
    /// Unit length.
    pub direction: Vec3,
    /// May be infinite.
    pub length: f32,
}

impl Segment {
    pub fn of(ray: &Ray, length: f32) -> Self {
        Self {
            origin: ray.origin,
            direction: ray.direction,
            length,
        }
    }

    /// The point at a distance.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }

    /// Its distances by the angle under which `point` sees them; none if it goes through the point.
    pub fn seen_from(&self, point: Vec3) -> Option<Equiangular> {
        let to_point: DVec3 = point.as_dvec3() - self.origin.as_dvec3();
        let direction = self.direction.as_dvec3();
        let nearest = to_point.dot(direction);
        let height = (to_point - direction * nearest).length();
        let from = (-nearest / height).atan();
        let spread = ((f64::from(self.length) - nearest) / height).atan() - from;
        (height > 0.0 && spread > 0.0).then_some(Equiangular {
            nearest,
            height,
            from,
            spread,
        })
    }
}

/// Distances along a segment in proportion to one over the squared distance to a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Equiangular {
    /// The distance along the ray that is nearest to the point.
    nearest: f64,
    /// How far away the point is there; positive.
    height: f64,
    /// The angle, from there, at which the segment starts.
    from: f64,
    /// How much it covers.
    spread: f64,
}

impl Equiangular {
    /// The distance for `u` in [0, 1).
    pub fn sample(&self, u: f32) -> f32 {
        let angle = self.from + self.spread * f64::from(u);
        (self.nearest + self.height * angle.tan()) as f32
    }

    /// Density by distance of [`Self::sample`].
    pub fn pdf(&self, t: f32) -> f32 {
        let along = f64::from(t) - self.nearest;
        (self.height / (self.spread * (self.height * self.height + along * along))) as f32
    }
}

/// A flight about to start on a segment, at the end of which there may be a scattering event.
pub(super) struct Passage<'a> {
    pub lane: &'a TravelLane,
    pub flight: Flight,
    pub at: &'a Coefficients,
    pub phase: HenyeyGreenstein,
    pub segment: Segment,
    /// Of the event.
    pub numbers: &'a EventNumbers,
    pub time: f32,
}

impl VolumePath {
    /// The light of a point, scattered somewhere along a segment, which starts on its way to there.
    pub(super) fn look_along(&self, stage: &mut VolumeStage<'_, '_>, passage: &Passage) {
        let Passage {
            lane,
            flight,
            at,
            ref segment,
            numbers,
            time,
            ..
        } = *passage;
        let scene = stage.scene;
        let is_asked = self.0.strategy != Strategy::Bsdf && self.0.max_depth != Some(stage.depth);
        if !is_asked || scene.point_sampler().is_empty() {
            return;
        }
        let sampler = scene.point_sampler();
        let Some(chosen) = sampler.sample(segment.origin, Vec3::ZERO, numbers.which_light) else {
            return;
        };
        let light = scene.light(chosen.light);
        let distances = light.position(time).and_then(|point| segment.seen_from(point));
        let Some(distances) = distances else { return };
        // A surface at the end chooses its lobe by the same number: each estimate is right by itself.
        let t = distances.sample(numbers.lobe);
        let (p, density) = (segment.at(t), chosen.pmf * distances.pdf(t));
        let lambda = &stage.slots[lane.slot as usize].lambda;
        let Some(sample) = light.sample_li(p, time, numbers.light, lambda) else {
            return;
        };
        let transmittance = at.transmittance(t);
        let pmf = scene.light_sampler().pmf(p, Vec3::ZERO, chosen.light);
        let weight = power_heuristic(density, pmf * flight.chances.mean(at.sigma_t * transmittance));
        let scattered = at.sigma_s * transmittance * passage.phase.pdf(-segment.direction, sample.wi).0;
        let value = lane.beta * scattered * sample.li * (weight / density);
        let ray = ray_through_space(p, sample.wi, sample.end, time);
        if !(density > 0.0 && ray.is_valid()) || value.is_black() {
            return;
        }
        let light = LightOnItsWay {
            slot: lane.slot,
            value,
            medium: lane.state.medium,
            chances: flight.scattered().chances,
            pdf_light: None,
            pdf_scatter: SolidAnglePdf(0.0),
        };
        stage.memory.push(&ray, light);
    }
}

/// The density with which [`VolumePath::look_along`] chooses this light and this distance on a segment.
pub(super) fn density_along(scene: &Scene, segment: &Segment, t: f32, light: LightId, time: f32) -> f32 {
    let pmf = scene.point_sampler().pmf(segment.origin, Vec3::ZERO, light);
    if pmf == 0.0 {
        return 0.0;
    }
    let distances = scene
        .light(light)
        .position(time)
        .and_then(|point| segment.seen_from(point));
    distances.map_or(0.0, |distances| pmf * distances.pdf(t))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_density_is_that_of_the_samples() {
        let direction = Vec3::new(0.48, 0.6, 0.64);
        for (length, point) in [
            (3.0, Vec3::new(1.0, 1.5, 1.0)),
            (f32::INFINITY, Vec3::new(1.0, 1.5, 1.0)),
            (0.7, Vec3::new(-2.0, 0.1, 0.3)),
            (1.3, Vec3::new(0.48, 0.6, 0.66)),
        ] {
            let origin = Vec3::ZERO;
            let segment = Segment {
                origin,
                direction,
                length,
            };
            let distances = segment.seen_from(point).unwrap();
            const STEPS: u32 = 1000;
            for i in 0..STEPS {
                // The inverse has the slope 1 / pdf.
                let u = |offset: f32| (i as f32 + offset) / STEPS as f32;
                let (a, t, b) = (u(0.25), distances.sample(u(0.5)), u(0.75));
                let slope = f64::from(distances.sample(b) - distances.sample(a)) / f64::from(b - a);
                assert!((0.0..=length).contains(&t));
                let product = slope * f64::from(distances.pdf(t));
                // Far away the slope changes too much for the difference to be it.
                assert!(
                    t > 50.0 || (product - 1.0).abs() < 0.02,
                    "{length} {point}: {product} at {t}"
                );
            }
        }
    }

    #[test]
    fn a_point_on_the_ray_is_left_to_others() {
        let segment = Segment {
            origin: Vec3::ZERO,
            direction: Vec3::X,
            length: 2.0,
        };
        assert!(segment.seen_from(Vec3::X).is_none());
        assert!(segment.seen_from(Vec3::new(1.0, 1e-20, 0.0)).is_some());
    }
}
