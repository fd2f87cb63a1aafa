//! How paths and shadow rays are sent: from the columns in which they were computed.

use super::scatter::Scattered;
use crate::geometry::Surfaces;
use crate::integrator::direct::Origin;
use crate::integrator::lane::LanePacket;
use crate::integrator::path::PathStage;
use crate::integrator::shadow::{ContributionLanes, NO_NOTE};
use crate::integrator::stage::PacketVertices;
use crate::math::{Columns, LaneSet, Packing, Shuffle};

impl Scattered {
    /// Sends the chosen paths on their ways, and shadow rays.
    #[inline(always)]
    pub fn send(&self, stage: &mut PathStage<'_, '_>, packet: &PacketVertices<'_, Origin>, chosen: LaneSet) {
        let (lanes, surfaces, scattered) = (packet.lanes, packet.surfaces.all(), self);
        let (connects, goes_on) = (chosen.and(self.connects.into()), chosen.and(self.goes_on.into()));
        let (shadow_is_valid, next_is_valid) = (self.shadow_is_valid.into(), self.next_is_valid.into());
        stage.note_broken(connects.without(shadow_is_valid), lanes);
        stage.note_broken(goes_on.without(next_is_valid), lanes);
        let connected = Connected { lanes, scattered };
        stage.add_unless_occluded_together(connects.and(shadow_is_valid), &self.shadow_rays, &connected);
        let next = Next {
            lanes,
            surfaces,
            scattered,
        };
        stage.go_on_together(goes_on.and(next_is_valid), &self.next_rays, &next, lanes);
    }
}

/// What lights bring to paths.
struct Connected<'a> {
    lanes: &'a LanePacket<Origin>,
    scattered: &'a Scattered,
}

impl Columns<ContributionLanes> for Connected<'_> {
    #[inline(always)]
    fn pack<S: Shuffle>(&self, packing: &Packing<S>, last: &mut ContributionLanes, next: &mut ContributionLanes) {
        self.lanes.slot.pack(packing, &mut last.slot, &mut next.slot);
        packing.fill(NO_NOTE, &mut last.note, &mut next.note);
        self.scattered.value.pack(packing, &mut last.value, &mut next.value);
    }
}

/// Paths after their events.
struct Next<'a> {
    lanes: &'a LanePacket<Origin>,
    surfaces: &'a Surfaces,
    scattered: &'a Scattered,
}

impl Columns<LanePacket<Origin>> for Next<'_> {
    #[inline(always)]
    fn pack<S: Shuffle>(&self, packing: &Packing<S>, last: &mut LanePacket<Origin>, next: &mut LanePacket<Origin>) {
        let Self {
            lanes,
            surfaces,
            scattered,
        } = self;
        lanes.slot.pack(packing, &mut last.slot, &mut next.slot);
        lanes.split.pack(packing, &mut last.split, &mut next.split);
        lanes.streams.pack(packing, &mut last.streams, &mut next.streams);
        lanes.eta_scale.pack(packing, &mut last.eta_scale, &mut next.eta_scale);
        lanes
            .cone_spread
            .pack(packing, &mut last.cone_spread, &mut next.cone_spread);
        scattered.beta.pack(packing, &mut last.beta, &mut next.beta);
        scattered
            .cone_width
            .pack(packing, &mut last.cone_width, &mut next.cone_width);
        surfaces.p.pack(packing, &mut last.states.p, &mut next.states.p);
        surfaces.ns.pack(packing, &mut last.states.n, &mut next.states.n);
        scattered.pdf.pack(packing, &mut last.states.pdf, &mut next.states.pdf);
    }
}
