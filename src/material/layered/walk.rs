//! Walks between the layers: flights, events, and the connections of a walk to a direction outside.

use super::{Interlayer, Layered};
use crate::material::argument_random::ArgumentRandom;
use crate::material::{Density, LocalSample, TransportMode};
use crate::math::{Frame, Vec2, Vec3};
use crate::sampling::power_heuristic;
use crate::sampling::warp::{henyey_greenstein_pdf, sample_henyey_greenstein};
use crate::spectrum::SampledSpectrum;

/// A walk: where it is, where it goes, what it carries. The coat is at `thickness`, the body at 0.
pub(super) struct Walk {
    pub(super) z: f32,
    pub(super) w: Vec3,
    pub(super) beta: SampledSpectrum,
}

/// Where a flight between the layers ends.
pub(super) enum Flight {
    Coat,
    Body,
    Medium,
}

impl Walk {
    fn turn(&mut self, next: &LocalSample) {
        self.beta *= next.weight();
        self.w = next.wi;
    }

    /// Russian roulette, as in pbrt-v4.
    pub(super) fn survive(&mut self, depth: u32, random: &mut ArgumentRandom) -> Option<()> {
        let most = self.beta.max_value();
        if depth > 3 && most < 0.25 {
            if random.unit() >= most {
                return None;
            }
            self.beta *= 1.0 / most;
        }
        Some(())
    }
}

impl Layered {
    /// One walk from `wo`, connected to `wi` through the coat wherever it scatters (both above).
    pub(super) fn estimate(
        &self,
        wo: Vec3,
        wi: Vec3,
        mode: TransportMode,
        random: &mut ArgumentRandom,
    ) -> SampledSpectrum {
        let mut sum = SampledSpectrum::ZERO;
        let adjoint = match mode {
            TransportMode::Radiance => TransportMode::Importance,
            TransportMode::Importance => TransportMode::Radiance,
        };
        let entered = self.coat.sample_transmission(wo, random.pair(), mode);
        // A direction below that light from wi may come from.
        let light = self.coat.sample_transmission(wi, random.pair(), adjoint);
        let (Some(entered), Some(light)) = (entered, light) else {
            return sum;
        };
        let mut walk = Walk {
            z: self.interlayer.thickness,
            w: entered.wi,
            beta: entered.weight(),
        };
        let connection = Connection { wi, light, mode };
        for depth in 0..self.interlayer.max_depth {
            if walk.survive(depth, random).is_none() {
                break;
            }
            let Some(flight) = self.fly(&mut walk, random) else {
                break;
            };
            let go_on = match flight {
                Flight::Medium => self.connect_medium(&mut walk, &connection, &mut sum, random),
                Flight::Body => self.connect_body(&mut walk, &connection, &mut sum, random),
                Flight::Coat => self
                    .coat
                    .sample_reflection(-walk.w, random.pair(), mode)
                    .map(|next| walk.turn(&next)),
            };
            if go_on.is_none() {
                break;
            }
        }
        sum
    }

    /// Adds what the medium scatters to wi, and goes on.
    fn connect_medium(
        &self,
        walk: &mut Walk,
        connection: &Connection,
        sum: &mut SampledSpectrum,
        random: &mut ArgumentRandom,
    ) -> Option<()> {
        let Interlayer { thickness, g, .. } = self.interlayer;
        let light = &connection.light;
        let phase = henyey_greenstein_pdf(walk.w.dot(-light.wi), g).0;
        let weight = connection.weight_of_light(phase);
        *sum += walk.beta
            * self.interlayer.albedo
            * light.weight()
            * (phase * weight * transmittance(thickness - walk.z, light.wi) / light.wi.z.abs());
        if let Some(mirror) = self.body.mirror_reflectance(light.wi) {
            *sum += self.connect_mirrors(walk, connection, mirror);
        }
        let pdf = self.scatter_in_medium(walk, random);
        if walk.w.z > 0.0 {
            self.connect_coat(walk, connection, Some(pdf), thickness - walk.z, sum);
        }
        (walk.w.z != 0.0).then_some(())
    }

    /// What the medium scatters to wi by way of a mirror under a smooth coat, which nothing else finds: down to the mirror first, or
    /// up; and any number of times to and fro between the two. The directions of all these chains are two.
    fn connect_mirrors(&self, walk: &Walk, connection: &Connection, mirror: SampledSpectrum) -> SampledSpectrum {
        let Interlayer { thickness, g, .. } = self.interlayer;
        let light = &connection.light;
        if !self.coat.is_delta() {
            return SampledSpectrum::ZERO;
        }
        let across = transmittance(thickness, light.wi);
        let to_and_fro = mirror * (self.coat.reflectance(light.wi.z) * across * across);
        let chains = to_and_fro.map(|r| 1.0 / (1.0 - r).max(1e-6));
        let up = henyey_greenstein_pdf(walk.w.dot(-light.wi), g).0 * transmittance(thickness - walk.z, light.wi);
        let down_direction = Vec3::new(-light.wi.x, -light.wi.y, light.wi.z);
        let down = henyey_greenstein_pdf(walk.w.dot(down_direction), g).0 * transmittance(walk.z, light.wi) * across;
        let scattered = walk.beta * self.interlayer.albedo * light.weight() * (1.0 / light.wi.z.abs());
        // The direct way up is counted already.
        scattered * (mirror * chains * down + (chains - SampledSpectrum::ONE) * up)
    }

    /// Adds what the body reflects to wi, and goes on.
    fn connect_body(
        &self,
        walk: &mut Walk,
        connection: &Connection,
        sum: &mut SampledSpectrum,
        random: &mut ArgumentRandom,
    ) -> Option<()> {
        let thickness = self.interlayer.thickness;
        let light = &connection.light;
        if let Some(value) = self.body.eval(-walk.w, -light.wi) {
            let weight = connection.weight_of_light(value.pdf);
            *sum += walk.beta * value.f * light.weight() * (weight * transmittance(thickness, light.wi));
        }
        let next = self.body.sample_f(-walk.w, random.pair())?;
        walk.turn(&next);
        let pdf = match next.density {
            Density::Continuous(pdf) => Some(pdf.0),
            Density::Delta(_) => None,
        };
        self.connect_coat(walk, connection, pdf, thickness, sum);
        Some(())
    }

    /// Adds what goes up through a rough coat to wi; the walk's direction had the density `pdf` (none: it had to be).
    fn connect_coat(
        &self,
        walk: &Walk,
        connection: &Connection,
        pdf: Option<f32>,
        distance: f32,
        sum: &mut SampledSpectrum,
    ) {
        let Some(exit) = self.coat.transmission(-walk.w, connection.wi, connection.mode) else {
            return;
        };
        // The density with which the walk's direction would have been drawn from wi: pbrt-v4 takes the other way round.
        let light = self.coat.transmission(connection.wi, -walk.w, connection.mode);
        let weight = match (pdf, light) {
            (Some(pdf), Some(light)) => power_heuristic(pdf, light.pdf),
            _ => 1.0,
        };
        *sum += walk.beta * exit.f * (weight * transmittance(distance, walk.w));
    }

    /// Goes to where the walk meets something next; `None` for a direction along the layers.
    pub(super) fn fly(&self, walk: &mut Walk, random: &mut ArgumentRandom) -> Option<Flight> {
        let thickness = self.interlayer.thickness;
        let up = walk.w.z > 0.0;
        let end = if up { thickness } else { 0.0 };
        if walk.w.z == 0.0 {
            return None;
        }
        if self.interlayer.albedo.is_black() {
            walk.beta *= transmittance(end - walk.z, walk.w);
        } else {
            let z = walk.z - (1.0 - random.unit()).ln() * walk.w.z;
            if z > 0.0 && z < thickness {
                walk.z = z;
                return Some(Flight::Medium);
            }
        }
        walk.z = end;
        Some(if up { Flight::Coat } else { Flight::Body })
    }

    /// Draws a new direction from the phase function and returns its density.
    pub(super) fn scatter_in_medium(&self, walk: &mut Walk, random: &mut ArgumentRandom) -> f32 {
        let g = self.interlayer.g;
        let local = sample_henyey_greenstein(Vec2::new(random.unit(), random.unit()), g);
        walk.w = Frame::from_normal(walk.w).to_world(local).normalize();
        walk.beta *= self.interlayer.albedo;
        henyey_greenstein_pdf(local.z, g).0
    }
}

/// What a walk is connected to.
struct Connection {
    wi: Vec3,
    /// The sampled direction below, towards which light from `wi` goes.
    light: LocalSample,
    mode: TransportMode,
}

impl Connection {
    /// The weight of the direction drawn from `wi` where the walk could have drawn it with density `pdf` too; a smooth coat can be
    /// passed in no other way.
    fn weight_of_light(&self, pdf: f32) -> f32 {
        match self.light.density {
            Density::Delta(_) => 1.0,
            Density::Continuous(light) => power_heuristic(light.0, pdf),
        }
    }
}

/// What is left of light after a flight over the height `dz` in direction `w`.
fn transmittance(dz: f32, w: Vec3) -> f32 {
    (-(dz / w.z).abs()).exp()
}
