//! The end of a wave: its slots and light paths come to the film.

use std::sync::Mutex;

use super::Wave;
use crate::desc::FilmKind;
use crate::film::{LayerSample, Splat, TileSums, lock};
use crate::integrator::DroppedSample;
use crate::integrator::stage::{Estimator, Retiring};
use crate::spectrum::SampledSpectrum;

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
        let keeps_layers = self.film.kind() != FilmKind::Rgb;
        for (index, slot) in self.slots.iter().enumerate() {
            let [x, y] = slot.pixel;
            if !rect.contains(x, y) {
                continue;
            }
            let l = slot.l * slot.importance;
            let rgb = slot.is_good().then(|| self.view.sensor.to_rgb(l, &slot.lambda));
            if keeps_layers {
                let sample = LayerSample {
                    weight: slot.filter_weight,
                    rgb,
                    l: rgb.map_or(SampledSpectrum::ZERO, |_| self.view.sensor.limit(l)),
                    lambda: &slot.lambda,
                    surface: self.first_hits.get(index),
                };
                sums.add_layers(x, y, &sample);
            }
            if !sums.add(x, y, rgb, slot.filter_weight) {
                self.stats.drop_sample(DroppedSample {
                    pixel: slot.pixel,
                    sample: slot.sample,
                });
            }
        }
    }
}
