//! The end of a wave: its slots and light paths come to the film.

use std::sync::Mutex;

use super::Wave;
use crate::film::{Splat, TileSums, lock};
use crate::integrator::DroppedSample;
use crate::integrator::stage::{Estimator, Retiring};

impl<E: Estimator> Wave<'_, E> {
    /// Turns slots into sensor values, and what light paths brought to the film into splats.
    pub(super) fn retire(&mut self, tile: Option<&Mutex<TileSums>>) {
        if !self.film.layers().is_empty() {
            let wave = Retiring {
                view: self.view,
                film: self.film,
                slots: &self.slots,
                tile,
            };
            self.estimator.retire_layers(&mut self.memory, &wave);
        }
        if let Some(tile) = tile {
            self.retire_slots(&mut lock(tile));
        }
        if E::LIGHT_PATHS {
            self.retire_splats();
        }
    }

    fn retire_splats(&mut self) {
        for splat in self.landed.drain(..) {
            let slot = &self.slots[splat.slot as usize];
            if slot.broken || !splat.value.is_finite() || splat.value.min_value() < 0.0 {
                self.stats.drop_sample(DroppedSample {
                    pixel: slot.pixel,
                    sample: slot.sample,
                });
                continue;
            }
            self.splatted.push(Splat {
                film: splat.film,
                rgb: self.view.splat_to_rgb(splat.value, &slot.lambda),
            });
        }
        self.stats.dropped_samples += self.film.splat(&self.view.filter, &mut self.splatted);
        self.film.add_light_paths(self.slots.len() as u64);
    }

    fn retire_slots(&mut self, sums: &mut TileSums) {
        let rect = sums.rect();
        for slot in &self.slots {
            let [x, y] = slot.pixel;
            if !rect.contains(x, y) {
                continue;
            }
            let rgb = slot
                .is_good()
                .then(|| self.view.sensor.to_rgb(slot.l * slot.importance, &slot.lambda));
            if !sums.add(x, y, rgb, slot.filter_weight) {
                self.stats.drop_sample(DroppedSample {
                    pixel: slot.pixel,
                    sample: slot.sample,
                });
            }
        }
    }
}
