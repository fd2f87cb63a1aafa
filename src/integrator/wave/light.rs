//! The light paths of a wave.

use std::time::Instant;

use super::Wave;
use crate::integrator::lane::Slot;
use crate::integrator::numbers::LIGHT_BRANCH;
use crate::integrator::stage::Estimator;
use crate::integrator::times::lap;
use crate::material::TransportMode;
use crate::sampling::SampleStream;

impl<'s, E: Estimator> Wave<'s, E> {
    /// Starts the light path of each slot.
    pub(super) fn emit(&mut self) {
        let streams = self.slots.iter().map(|slot| {
            let [x, y] = slot.pixel.map(u32::cast_signed);
            self.view.sampler.start(x, y, slot.sample).branch(LIGHT_BRANCH)
        });
        let streams: Vec<_> = streams.collect();
        self.emit_by(&streams);
    }

    fn emit_by(&mut self, streams: &[SampleStream]) {
        let estimator = self.estimator;
        let mut stage = self.stage(TransportMode::Importance, 0, 0);
        for (slot, &stream) in streams.iter().enumerate() {
            estimator.emit(&mut stage, slot as u32, stream);
        }
        stage.finish();
    }

    /// Follows light paths without camera paths to their ends: one for each slot, by its random numbers. What is then left are the slots
    /// and what the estimator kept.
    pub fn follow_light_paths(
        &mut self,
        paths: impl Iterator<Item = (Slot, SampleStream)>,
    ) -> (&[Slot], &mut E::Memory<'s>) {
        let streams: Vec<_>;
        (self.slots, streams) = paths.unzip();
        let mut start = Instant::now();
        self.emit_by(&streams);
        lap(&mut start, &mut self.stats.times.sample);
        self.finish_pending();
        (&self.slots, &mut self.memory)
    }
}
