//! The end of a wave: its slots and light paths come to the film.

use std::sync::Mutex;

use super::Wave;
use crate::desc::FilmKind;
use crate::film::{LayerSample, LinearSensor, SampleLanes, Sensor, Splat, SurfaceSample, TileSums, lock};
use crate::integrator::lane::Slot;
use crate::integrator::stage::{Estimator, Retiring};
use crate::math::{Kernel, LANES, LaneSet, VectorLanes};
use crate::scene::View;
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
                self.stats.drop_sample(slot.dropped());
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
        let (packets, rest) = self.slots.as_chunks::<LANES>();
        let keeps_layers = self.film.kind() != FilmKind::Rgb;
        let alone = if keeps_layers { &self.slots[..] } else { rest };
        let first = self.slots.len() - alone.len();
        for (index, slot) in alone.iter().enumerate() {
            let is_dropped = !retire_slot(self.view, sums, slot, self.first_hits.get(first + index), keeps_layers);
            if is_dropped {
                self.stats.drop_sample(slot.dropped());
            }
        }
        if keeps_layers {
            return;
        }
        let rect = sums.rect();
        let sensor = self.view.sensor.linear();
        for slots in packets {
            let pixels = slots.each_ref().map(|slot| slot.pixel);
            let samples = match sensor {
                Some(sensor) => self.vectorizer.run(Develop { slots, sensor }),
                None => develop(&self.view.sensor, slots),
            };
            let chosen = LaneSet::from(pixels.map(|[x, y]| rect.contains(x, y)));
            let dropped = sums.add_together(self.vectorizer, chosen, &pixels, &samples);
            for lane in dropped.lanes() {
                self.stats.drop_sample(slots[lane].dropped());
            }
        }
    }
}

/// Adds what a slot has gathered to its pixel, if the film has it; false if it was dropped.
fn retire_slot(
    view: &View,
    sums: &mut TileSums,
    slot: &Slot,
    first_hit: Option<&SurfaceSample>,
    keeps_layers: bool,
) -> bool {
    let [x, y] = slot.pixel;
    if !sums.rect().contains(x, y) {
        return true;
    }
    let l = slot.l * slot.importance;
    let rgb = slot.is_good().then(|| view.sensor.to_rgb(l, &slot.lambda));
    if keeps_layers {
        let sample = LayerSample {
            weight: slot.filter_weight,
            rgb,
            l: rgb.map_or(SampledSpectrum::ZERO, |_| view.sensor.limit(l)),
            lambda: &slot.lambda,
            surface: first_hit,
        };
        sums.add_layers(x, y, &sample);
    }
    sums.add(x, y, rgb, slot.filter_weight)
}

/// What the sensor makes of eight slots.
fn develop(sensor: &Sensor, slots: &[Slot; LANES]) -> SampleLanes {
    let mut samples = SampleLanes::default();
    for (i, slot) in slots.iter().enumerate() {
        samples.weight[i] = slot.filter_weight;
        samples.is_good[i] = slot.is_good();
        if samples.is_good[i] {
            samples
                .rgb
                .set(i, sensor.to_rgb(slot.l * slot.importance, &slot.lambda).into());
        }
    }
    samples
}

/// The same where it looks at no wavelengths.
struct Develop<'a> {
    slots: &'a [Slot; LANES],
    sensor: LinearSensor,
}

impl Kernel for Develop<'_> {
    type Output = SampleLanes;

    #[inline(always)]
    fn call(self) -> SampleLanes {
        let mut samples = SampleLanes::default();
        for (i, slot) in self.slots.iter().enumerate() {
            samples.rgb.set(i, self.sensor.to_rgb(slot.l * slot.importance));
            samples.weight[i] = slot.filter_weight;
            samples.is_good[i] = slot.is_good();
        }
        samples
    }
}
