//! Photon maps, and the radiance that they reflect.

use super::carried::Carried;
use super::kd_tree::{KdTree, Nearest};
use super::kernel::Kernel;
use super::shoot::Shot;
use super::stored::Photon;
use crate::geometry::SurfaceInteraction;
use crate::material::{Bsdf, TransportMode};
use crate::math::Vec3;
use crate::spectrum::SampledSpectrum;

/// The photons of a pass, by where they are.
#[derive(Debug, Default)]
pub(super) struct PhotonMap {
    tree: KdTree,
    /// In the order of the tree.
    photons: Vec<Photon>,
    /// What the power of each is multiplied by: one over the number emitted.
    scale: f32,
}

/// A point of a surface where photons are looked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Receiver {
    pub p: Vec3,
    /// Geometric normal, on either side.
    pub ng: Vec3,
    /// How far a photon of the same plane may be from it by rounding.
    pub error: f32,
    /// Scattering events of photons before they arrived, at most.
    pub max_depth: u32,
}

/// |cos| of the angle between the normals of a receiver and of a photon that is taken to be on the same surface: 45 degrees.
const LEAST_NORMAL_COS: f32 = 0.7;
/// How far from a receiver's tangent plane a photon may be, in units of its distance.
const MOST_ELEVATION: f32 = 0.2;

impl Receiver {
    /// Where a camera path of `depth` scattering events arrived, of paths that have `max_depth` at most.
    pub fn new(si: &SurfaceInteraction, depth: u32, max_depth: Option<u32>) -> Self {
        Self {
            p: si.p,
            ng: si.ng,
            error: 4.0 * si.error,
            max_depth: max_depth.map_or(u32::MAX, |max_depth| max_depth.saturating_sub(depth + 1)),
        }
    }

    /// Whether a photon is on the receiver's own surface, not around the corner or behind a wall.
    #[inline]
    fn accepts(&self, photon: &Photon) -> bool {
        let d = photon.p() - self.p;
        let height = d.dot(self.ng).abs() - self.error;
        if (height > 0.0 && height * height > MOST_ELEVATION * MOST_ELEVATION * d.length_squared())
            || photon.depth() > self.max_depth
        {
            return false;
        }
        let (ng, wi) = (photon.ng(), photon.wi());
        let cos = ng.dot(self.ng);
        // Light that arrived behind a surface is behind its neighbour too, though it may have come from above that one's plane.
        cos.abs() >= LEAST_NORMAL_COS && ng.dot(wi) * self.ng.dot(wi) * cos > 0.0
    }
}

/// How many photons make an estimate, and from how far away.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gathering {
    /// Photons at most, at least 1.
    pub count: usize,
    /// In scene units.
    pub max_distance: f32,
    pub kernel: Kernel,
}

impl PhotonMap {
    pub fn new(shot: &Shot) -> Self {
        let positions: Vec<Vec3> = shot.photons.iter().map(Photon::p).collect();
        let tree = KdTree::build(&positions);
        let photons = tree.order().iter().map(|&i| shot.photons[i as usize]).collect();
        Self {
            tree,
            photons,
            scale: (1.0 / shot.emitted.max(1) as f64) as f32,
        }
    }

    /// Every `stride`th photon, in the order in which they were shot.
    pub fn every(&self, stride: u32) -> Vec<Photon> {
        let placed = self.photons.iter().zip(self.tree.order());
        let mut photons: Vec<_> = placed.filter(|&(_, &index)| index % stride == 0).collect();
        photons.sort_unstable_by_key(|&(_, &index)| index);
        photons.into_iter().map(|(&photon, _)| photon).collect()
    }

    /// The radiance that `bsdf` sends towards `si.wo` of the photons nearest to `si`, per unit of radiance that the path carries:
    /// the sum of f times power over pi r², r being the distance of the last (Jensen 1996). That one lies on the rim of the disk
    /// and is left out, or the estimate would be too large by a part in their number.
    pub fn nearest_radiance(
        &self,
        si: &SurfaceInteraction,
        bsdf: &Bsdf,
        receiver: &Receiver,
        gathering: &Gathering,
        found: &mut Nearest,
    ) -> Carried {
        let r2 = self.find(receiver, gathering, found, |_, _| true);
        let mut sum = Carried::default();
        for (&place, &d2) in found.places().iter().zip(found.distances_squared()) {
            if d2 < r2 {
                self.add_reflected(&mut sum, place, gathering.kernel.at(d2 / r2), si, bsdf);
            }
        }
        sum.scaled(self.density_scale(r2))
    }

    /// [`PhotonMap::nearest_radiance`] of all photons at most `radius` away.
    pub fn radiance_within(
        &self,
        si: &SurfaceInteraction,
        bsdf: &Bsdf,
        receiver: &Receiver,
        radius: f32,
        kernel: &Kernel,
    ) -> Carried {
        let mut sum = Carried::default();
        if self.photons.is_empty() {
            return sum;
        }
        let r2 = radius * radius;
        self.tree.within(receiver.p, radius, |place, d2| {
            if receiver.accepts(&self.photons[place as usize]) {
                self.add_reflected(&mut sum, place, kernel.at(d2 / r2), si, bsdf);
            }
        });
        sum.scaled(self.density_scale(r2))
    }

    /// The irradiance, by wavelength, of the photons nearest to `receiver` that arrived on the side of its normal.
    pub fn nearest_irradiance(&self, receiver: &Receiver, gathering: &Gathering, found: &mut Nearest) -> Carried {
        self.irradiance_of(receiver, gathering, found, |_| true)
    }

    /// [`PhotonMap::nearest_irradiance`] without every `stride`th photon: a receiver that is one of these is then independent of
    /// the photons that count, and does not see itself.
    pub fn nearest_irradiance_of_others(
        &self,
        receiver: &Receiver,
        stride: u32,
        gathering: &Gathering,
        found: &mut Nearest,
    ) -> Carried {
        let order = self.tree.order();
        let others = |place: u32| !order[place as usize].is_multiple_of(stride);
        let share = (stride - 1) as f32 / stride as f32;
        self.irradiance_of(receiver, gathering, found, others)
            .scaled(1.0 / share)
    }

    fn irradiance_of(
        &self,
        receiver: &Receiver,
        gathering: &Gathering,
        found: &mut Nearest,
        counts: impl Fn(u32) -> bool,
    ) -> Carried {
        let is_wanted = |place: u32, photon: &Photon| counts(place) && photon.wi().dot(receiver.ng) > 0.0;
        let r2 = self.find(receiver, gathering, found, is_wanted);
        let mut sum = Carried::default();
        for (&place, &d2) in found.places().iter().zip(found.distances_squared()) {
            if d2 < r2 {
                let photon = &self.photons[place as usize];
                sum.add(photon.power() * gathering.kernel.at(d2 / r2), photon.is_hero_only());
            }
        }
        sum.scaled(self.density_scale(r2))
    }

    /// Finds photons for an estimate; the squared radius of the disk that they stand for, inside of which those are that count.
    fn find(
        &self,
        receiver: &Receiver,
        gathering: &Gathering,
        found: &mut Nearest,
        also: impl Fn(u32, &Photon) -> bool,
    ) -> f32 {
        let accept = |place: u32| {
            let photon = &self.photons[place as usize];
            receiver.accepts(photon) && also(place, photon)
        };
        // One more than count, for the rim.
        let count = gathering.count + 1;
        self.tree
            .nearest(receiver.p, count, gathering.max_distance, accept, found);
        found.radius_squared()
    }

    /// What takes a sum of powers, each times its kernel, to one by area.
    fn density_scale(&self, r2: f32) -> f32 {
        if r2 > 0.0 {
            self.scale / (std::f32::consts::PI * r2)
        } else {
            0.0
        }
    }

    /// Adds what a surface reflects of a photon.
    #[inline]
    fn add_reflected(&self, sum: &mut Carried, place: u32, kernel: f32, si: &SurfaceInteraction, bsdf: &Bsdf) {
        let photon = &self.photons[place as usize];
        let wi = photon.wi();
        let Some(value) = bsdf.eval(si.wo, wi, TransportMode::Radiance) else {
            return;
        };
        // Photons are as dense as the cosine to the geometric normal says; scattering counts by that to the shading normal.
        let cos_ratio = value.cos_theta / si.ng.dot(wi).abs().max(LEAST_COS);
        let power: SampledSpectrum = photon.power();
        sum.add(value.f * power * (kernel * cos_ratio), photon.is_hero_only());
    }
}

/// Photons that arrive at a flatter angle to the geometric normal count as if it were this: the ratio of cosines has no bound there.
const LEAST_COS: f32 = 1e-3;
