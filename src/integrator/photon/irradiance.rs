//! Irradiance, worked out beforehand at some of the photons: final gathering then needs the nearest of these points only
//! (Christensen 1999, "Faster photon map global illumination").

use rayon::prelude::*;

use super::carried::Carried;
use super::kd_tree::{KdTree, Nearest};
use super::map::{Gathering, PhotonMap, Receiver};
use super::stored::Photon;
use crate::math::Vec3;

/// One photon in so many has its irradiance, as Christensen has it.
pub(super) const PHOTONS_PER_RECORD: u32 = 4;
/// Cosine of the angle between the normals of a point and of a record that stands for it: 25 degrees.
const LEAST_NORMAL_COS: f32 = 0.9;
/// How far from the tangent plane a record may be, in units of its distance.
const MOST_ELEVATION: f32 = 0.2;

/// Irradiance at points of a photon map.
#[derive(Debug, Default)]
pub(super) struct IrradianceMap {
    tree: KdTree,
    /// In the order of the tree.
    records: Vec<Record>,
}

/// A point whose irradiance is known.
#[derive(Clone, Copy, Debug)]
pub(super) struct Record {
    p: Vec3,
    /// Geometric normal, on the side that the light came from.
    ng: Vec3,
    /// By wavelength, of the light that arrives on that side.
    pub irradiance: Carried,
    /// How far away the photons are that it comes from.
    pub reach: f32,
}

impl IrradianceMap {
    /// Of the photons of `map` that had `max_depth` scattering events before at most.
    pub fn new(map: &PhotonMap, gathering: &Gathering, max_depth: u32) -> Self {
        let record = |found: &mut Nearest, photon: Photon| {
            let ng = photon.ng();
            let ng = if ng.dot(photon.wi()) < 0.0 { -ng } else { ng };
            let receiver = Receiver {
                p: photon.p(),
                ng,
                error: 0.0,
                max_depth,
            };
            Record {
                p: photon.p(),
                ng,
                irradiance: map.nearest_irradiance_of_others(&receiver, PHOTONS_PER_RECORD, gathering, found),
                reach: found.radius_squared().sqrt(),
            }
        };
        let photons = map.every(PHOTONS_PER_RECORD);
        let records: Vec<Record> = photons.into_par_iter().map_init(Nearest::default, record).collect();
        let tree = KdTree::build(&records.iter().map(|record| record.p).collect::<Vec<_>>());
        let records = tree.order().iter().map(|&i| records[i as usize]).collect();
        Self { tree, records }
    }

    /// The irradiance at `p`, a point of a surface with the geometric normal `ng` on the side that matters, where `error` is that of
    /// [`Receiver`]. `None` if no point at most `max_distance` away is known that could stand for it.
    #[inline]
    pub fn at(&self, p: Vec3, ng: Vec3, error: f32, max_distance: f32, found: &mut Nearest) -> Option<&Record> {
        let accept = |place: u32| {
            let record = &self.records[place as usize];
            let d = record.p - p;
            let height = d.dot(ng).abs() - error;
            record.ng.dot(ng) >= LEAST_NORMAL_COS
                && (height <= 0.0 || height * height <= MOST_ELEVATION * MOST_ELEVATION * d.length_squared())
        };
        self.tree.nearest(p, 1, max_distance, accept, found);
        let &place = found.places().first()?;
        Some(&self.records[place as usize])
    }
}
