//! The light paths of a wave.

use super::Wave;
use crate::integrator::numbers::LIGHT_BRANCH;
use crate::integrator::stage::Estimator;
use crate::material::TransportMode;

impl<E: Estimator> Wave<'_, E> {
    /// Starts the light path of each slot.
    pub(super) fn emit(&mut self) {
        let streams = self.slots.iter().map(|slot| {
            let [x, y] = slot.pixel.map(u32::cast_signed);
            self.view.sampler.start(x, y, slot.sample).branch(LIGHT_BRANCH)
        });
        let streams: Vec<_> = streams.collect();
        let estimator = self.estimator;
        let mut stage = self.stage(TransportMode::Importance, 0, 0);
        for (slot, stream) in streams.into_iter().enumerate() {
            estimator.emit(&mut stage, slot as u32, stream);
        }
        stage.finish_batch();
    }
}
