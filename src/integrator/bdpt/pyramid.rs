//! What each strategy found: a layer of the film for each (s, t), with and without its weight.
//!
//! Contributions are noted beside those of the picture, and count if the same shadow rays arrive. Connections that Russian roulette leaves
//! out of the picture have shadow rays too, for the layers without weights.
//!
//! Connecting a light to the lens directly (s = t = 1) is no strategy, as in pbrt-v4: lights seen directly are left to s = 0, which finds all
//! that have an extent, and others are not seen.

use super::BdptIntegrator;
use crate::film::{Film, Splat, lock};
use crate::integrator::stage::Retiring;
use crate::math::Vec2;
use crate::scene::View;
use crate::spectrum::SampledSpectrum;

/// The strategies that are told apart: those of all paths of up to so many edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pyramid {
    edges: u32,
}

/// A layer of a film with a [`Pyramid`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StrategyLayer {
    /// What the paths of s vertices from a light and t from the lens bring.
    Strategy {
        /// Vertices of the light subpath.
        s: u32,
        /// Vertices of the camera subpath, that on the lens included.
        t: u32,
        /// Whether it counts as it does in the picture, or in full.
        weighted: bool,
    },
    /// All longer paths, weighted.
    Longer,
}

impl StrategyLayer {
    /// Its name in a file.
    pub fn name(self) -> String {
        match self {
            Self::Strategy { s, t, weighted: true } => format!("s{s}.t{t}.weighted"),
            Self::Strategy { s, t, weighted: false } => format!("s{s}.t{t}.unweighted"),
            Self::Longer => "longer.weighted".to_owned(),
        }
    }

    /// Whether light paths bring it to the film.
    fn is_splatted(self) -> bool {
        matches!(self, Self::Strategy { t: 1, .. } | Self::Longer)
    }
}

impl Pyramid {
    /// The most edges there may be.
    pub const LARGEST: u32 = 10;

    /// Of paths of up to `edges` edges; `None` unless they are 1 to [`Pyramid::LARGEST`].
    pub fn new(edges: u32) -> Option<Self> {
        (1..=Self::LARGEST).contains(&edges).then_some(Self { edges })
    }

    /// That whose layers a film has; `None` if it has none.
    fn of_film(film: &Film) -> Option<Self> {
        (1..=Self::LARGEST)
            .map(|edges| Self { edges })
            .find(|pyramid| pyramid.layer_count() == film.layers().len())
    }

    /// The most edges of a path whose strategies are told apart.
    pub fn edges(self) -> u32 {
        self.edges
    }

    /// The strategies, shortest paths first: each takes two layers. Lights seen directly are left to s = 0.
    fn strategies(self) -> impl Iterator<Item = (u32, u32)> {
        (1..=self.edges)
            .flat_map(|edges| (0..=edges).map(move |s| (s, edges + 1 - s)))
            .filter(|&strategy| strategy != (1, 1))
    }

    fn strategy_count(self) -> usize {
        ((self.edges + 1) * (self.edges + 2) / 2 - 2) as usize
    }

    fn layer_count(self) -> usize {
        2 * self.strategy_count() + 1
    }

    /// Where a strategy is among [`Pyramid::strategies`]; one past their end if its paths are longer.
    fn index(self, s: u32, t: u32) -> usize {
        match s + t - 1 {
            0 | 1 => 0,
            edges if edges > self.edges => self.strategy_count(),
            edges => (edges * (edges + 1) / 2 - 2 + s) as usize,
        }
    }

    /// The layers of a film, in order.
    pub fn layers(self) -> Vec<StrategyLayer> {
        let both = |(s, t)| [false, true].map(|weighted| StrategyLayer::Strategy { s, t, weighted });
        let mut layers: Vec<_> = self.strategies().flat_map(both).collect();
        layers.push(StrategyLayer::Longer);
        layers
    }

    /// A film for the picture of `view`, with a layer for each of [`Pyramid::layers`].
    pub(in crate::integrator) fn film(self, view: &View) -> Film {
        let layer = |layer: StrategyLayer| {
            let film = view.film();
            if layer.is_splatted() { film.with_splats() } else { film }
        };
        let layers = self.layers().into_iter().map(layer).collect();
        view.film().with_splats().with_layers(layers)
    }

    /// Memory that such a film takes for each pixel, in bytes.
    pub fn bytes_per_pixel(self) -> u64 {
        let layers = self.layers();
        let of_layers = layers.iter().map(|layer| Film::bytes_per_pixel(layer.is_splatted()));
        Film::bytes_per_pixel(true) + of_layers.sum::<u64>()
    }
}

/// What a strategy found.
#[derive(Clone, Copy, Debug)]
struct Found {
    slot: u32,
    /// As [`Pyramid::index`] has it.
    strategy: usize,
    /// As it counts in the picture.
    value: SampledSpectrum,
    /// Without its weight, and without Russian roulette among connections.
    in_full: SampledSpectrum,
    /// Where it lands on the film, if it is a splat.
    film: Option<Vec2>,
}

/// What the strategies found in a wave.
#[derive(Debug)]
pub(super) struct Record {
    pyramid: Pyramid,
    /// Radiance by slot, and in it by layer.
    l: Vec<SampledSpectrum>,
    /// What counts if a shadow ray is not blocked.
    noted: Vec<Found>,
    landed: Vec<(Found, Vec2)>,
}

impl Found {
    /// The layers that it belongs to, and what it brings to each.
    fn by_layer(&self, pyramid: Pyramid) -> impl Iterator<Item = (usize, SampledSpectrum)> {
        let first = 2 * self.strategy;
        let (in_full, weighted) = if self.strategy == pyramid.strategy_count() {
            (None, (first, self.value))
        } else {
            (Some((first, self.in_full)), (first + 1, self.value))
        };
        in_full.into_iter().chain([weighted])
    }
}

impl Record {
    /// For a wave that renders to `film`; `None` if that has no layers.
    pub fn for_film(film: &Film) -> Option<Box<Self>> {
        Pyramid::of_film(film).map(|pyramid| {
            Box::new(Self {
                pyramid,
                l: Vec::new(),
                noted: Vec::new(),
                landed: Vec::new(),
            })
        })
    }

    /// Forgets all, for a wave of so many slots.
    pub fn restart(&mut self, slots: usize) {
        self.l.clear();
        self.l.resize(slots * self.pyramid.layer_count(), SampledSpectrum::ZERO);
        self.noted.clear();
        self.landed.clear();
    }

    /// A camera subpath of `t` vertices meets a light: it brings `value`, and `in_full` without its weight.
    pub fn add(&mut self, slot: u32, t: u32, value: SampledSpectrum, in_full: SampledSpectrum) {
        let strategy = self.pyramid.index(0, t);
        self.land(&Found {
            slot,
            strategy,
            value,
            in_full,
            film: None,
        });
    }

    /// Strategy (s, t) brings the same if a shadow ray is not blocked: the number by which it is told so.
    pub fn note(&mut self, slot: u32, [s, t]: [u32; 2], value: SampledSpectrum, in_full: SampledSpectrum) -> u32 {
        let strategy = self.pyramid.index(s, t);
        self.noted.push(Found {
            slot,
            strategy,
            value,
            in_full,
            film: None,
        });
        self.noted.len() as u32 - 1
    }

    /// The same of a splat, of strategy (s, 1).
    pub fn note_splat(
        &mut self,
        slot: u32,
        s: u32,
        value: SampledSpectrum,
        in_full: SampledSpectrum,
        film: Vec2,
    ) -> u32 {
        let strategy = self.pyramid.index(s, 1);
        self.noted.push(Found {
            slot,
            strategy,
            value,
            in_full,
            film: Some(film),
        });
        self.noted.len() as u32 - 1
    }

    /// What was noted under this number counts.
    pub fn arrived(&mut self, note: u32) {
        let found = self.noted[note as usize];
        match found.film {
            Some(film) => self.landed.push((found, film)),
            None => self.land(&found),
        }
    }

    fn land(&mut self, found: &Found) {
        let first = found.slot as usize * self.pyramid.layer_count();
        for (layer, value) in found.by_layer(self.pyramid) {
            self.l[first + layer] += value;
        }
    }

    /// Takes everything to the layers of a film. What the picture drops they drop too.
    pub fn retire(&mut self, wave: &Retiring<'_>) {
        self.retire_slots(wave);
        let mut splats: Vec<Vec<Splat>> = vec![Vec::new(); self.pyramid.layer_count()];
        for (found, film) in self.landed.drain(..) {
            let slot = &wave.slots[found.slot as usize];
            if slot.broken || !found.value.is_finite() || found.value.min_value() < 0.0 {
                continue;
            }
            for (layer, value) in found.by_layer(self.pyramid) {
                let rgb = wave.view.splat_to_rgb(value, &slot.lambda);
                splats[layer].push(Splat { film, rgb });
            }
        }
        for (layer, splats) in wave.film.layers().iter().zip(&mut splats) {
            if layer.takes_splats() {
                layer.splat(&wave.view.filter, splats);
                layer.add_light_paths(wave.slots.len() as u64);
            }
        }
    }

    fn retire_slots(&self, wave: &Retiring<'_>) {
        let tiles = wave.film.tiles();
        let Some(tile) = wave
            .tile
            .and_then(|tile| tiles.iter().position(|t| std::ptr::eq(t, tile)))
        else {
            return;
        };
        for (index, layer) in wave.film.layers().iter().enumerate() {
            let mut sums = lock(&layer.tiles()[tile]);
            let rect = sums.rect();
            for (slot, l) in wave.slots.iter().zip(self.l.chunks_exact(self.pyramid.layer_count())) {
                let ([x, y], l) = (slot.pixel, l[index]);
                if !rect.contains(x, y) {
                    continue;
                }
                let rgb = slot.is_good().then(|| match l.is_black() {
                    true => [0.0; 3],
                    false => wave.view.sensor.to_rgb(l * slot.importance, &slot.lambda),
                });
                sums.add(x, y, rgb, slot.filter_weight);
            }
        }
    }
}

impl BdptIntegrator {
    /// An empty film for `view` whose layers are those of `pyramid`, to be rendered as any other. `None` if this is the light tracer,
    /// which has no strategies to choose from.
    pub fn film_of_strategies(&self, view: &View, pyramid: Pyramid) -> Option<Film> {
        (self.strategies == super::Strategies::All).then(|| pyramid.film(view))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_strategy_has_its_place() {
        for edges in 1..=Pyramid::LARGEST {
            let pyramid = Pyramid { edges };
            let strategies: Vec<_> = pyramid.strategies().collect();
            assert_eq!(strategies.len(), pyramid.strategy_count());
            assert_eq!(pyramid.layers().len(), pyramid.layer_count());
            for (i, &(s, t)) in strategies.iter().enumerate() {
                assert_eq!(pyramid.index(s, t), i, "({s}, {t}) of {edges}");
            }
            assert_eq!(pyramid.index(0, edges + 2), strategies.len());
            assert_eq!(pyramid.index(edges + 1, 1), strategies.len());
        }
        assert_eq!(Pyramid::new(0), None);
        assert_eq!(Pyramid::new(11), None);
    }
}
