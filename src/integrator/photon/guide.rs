//! Emission aimed at what makes caustics: a projection map (Jensen 1996) in the space of the random numbers that start a photon.
//!
//! Pilot photons tell which of these numbers, five of them (which light; where on it; whereto), lead to the caustic map, whatever kind
//! the lights are. Their unit cube is halved again and again where that separates those that do from those that do not, and each cell
//! gets a share of the photons. Numbers are aimed by hierarchical warping (McCool and Harwood 1997; for the numbers of paths: Guo,
//! Bauszat, Bikker and Eisemann 2018), which keeps their stratification. No cell's share is 0, and photons are divided by the
//! density of their numbers: so the power that arrives keeps its mean.

use crate::integrator::numbers::EmissionNumbers;
use crate::math::Vec2;

/// The numbers that start a photon.
const DIMENSIONS: usize = 5;
type Point = [f32; DIMENSIONS];

/// The share of the photons that goes evenly to the whole cube: what the pilots missed is found by these, with at most 10 times the power
/// of unaimed ones.
const EVEN_SHARE: f32 = 0.1;
/// A cell counts as if it had that many more pilots that hit: where few have been, none may have hit by chance, and the photon that then
/// does would be far brighter than others.
const PRIOR: f64 = 0.25;
/// Cells with fewer pilots are not halved.
const LEAST_PILOTS: usize = 128;
/// Halvings of the cube on the way to a cell.
const DEEPEST: u32 = 24;
/// By how much all halvings of a cell together must lower its weight (the standard deviation that is left) to be kept: one alone may
/// be worth little, where several in a row find a small target.
const LEAST_GAIN: f32 = 0.01;

/// A pilot: its numbers, and the power that it brought to the map.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pilot {
    numbers: Point,
    power: f32,
    /// One over the density of its numbers.
    weight: f32,
}

impl Pilot {
    /// Whether it brought anything.
    pub fn is_useful(&self) -> bool {
        self.power > 0.0
    }

    /// A pilot that was started with `numbers`, drawn with this density, and brought `power`, which has been divided by it.
    pub fn new((numbers, density): (EmissionNumbers, f32), power: f32) -> Self {
        Self {
            numbers: to_point(numbers),
            power: power * density,
            weight: 1.0 / density,
        }
    }
}

/// A distribution of the numbers that start photons.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct EmissionGuide {
    /// The root is the first.
    nodes: Vec<Node>,
}

/// A cell of the cube.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Node {
    Leaf,
    /// Halved across `dimension`; the half of smaller numbers is the node after this one.
    Halved {
        dimension: u8,
        /// The share of this cell's photons that go to the half of smaller numbers.
        low: f32,
        /// The other half.
        high: u32,
    },
}

impl EmissionGuide {
    /// Learns from pilots, whose order it changes. `None` if none of them brought anything.
    pub fn new(pilots: &mut [Pilot]) -> Option<Self> {
        if !pilots.iter().any(Pilot::is_useful) {
            return None;
        }
        let mut nodes = Vec::new();
        let mut weights = Vec::new();
        let of_hits = Square::of(pilots.iter().filter(|pilot| pilot.is_useful())).mean();
        halve(pilots, of_hits, [(0.0, 1.0); DIMENSIONS], 0, &mut nodes, &mut weights);
        share(&mut nodes, &weights);
        Some(Self { nodes })
    }

    /// Numbers with the distribution that was learnt, from uniform ones, and their density.
    #[inline]
    pub fn aim(&self, uniform: EmissionNumbers) -> (EmissionNumbers, f32) {
        let mut numbers = to_point(uniform);
        let mut cell = [(0.0_f32, 1.0_f32); DIMENSIONS];
        let (mut density, mut index) = (1.0, 0);
        while let Node::Halved { dimension, low, high } = self.nodes[index] {
            let u = &mut numbers[usize::from(dimension)];
            let (from, to) = &mut cell[usize::from(dimension)];
            let middle = 0.5 * (*from + *to);
            if *u < low {
                (*u, *to) = (*u / low, middle);
                density *= 2.0 * low;
                index += 1;
            } else {
                (*u, *from) = ((*u - low) / (1.0 - low), middle);
                density *= 2.0 * (1.0 - low);
                index = high as usize;
            }
        }
        for (u, (from, to)) in numbers.iter_mut().zip(cell) {
            *u = (from + *u * (to - from)).min(to.next_down());
        }
        (from_point(numbers), density)
    }
}

fn to_point(numbers: EmissionNumbers) -> Point {
    let EmissionNumbers {
        position,
        which_light,
        direction,
    } = numbers;
    [which_light, position.x, position.y, direction.x, direction.y]
}

fn from_point([which_light, position_x, position_y, x, y]: Point) -> EmissionNumbers {
    EmissionNumbers {
        position: Vec2::new(position_x, position_y),
        which_light,
        direction: Vec2::new(x, y),
    }
}

/// The square of power, integrated over a cell by its pilots.
#[derive(Clone, Copy, Default)]
struct Square {
    sum: f64,
    weight: f64,
    count: usize,
}

impl Square {
    fn add(&mut self, pilot: &Pilot) {
        let weight = f64::from(pilot.weight);
        self.sum += weight * f64::from(pilot.power).powi(2);
        self.weight += weight;
        self.count += 1;
    }

    fn of<'a>(pilots: impl IntoIterator<Item = &'a Pilot>) -> Self {
        let mut square = Self::default();
        pilots.into_iter().for_each(|pilot| square.add(pilot));
        square
    }

    fn mean(&self) -> f64 {
        if self.weight > 0.0 { self.sum / self.weight } else { 0.0 }
    }

    /// What a volume of 1 in the cell deserves: the root mean square of power, to which the best density is proportional, where that
    /// of pilots that hit is `of_hits`.
    fn worth(&self, of_hits: f64) -> f32 {
        let count = self.count as f64;
        ((count * self.mean() + PRIOR * of_hits) / (count + PRIOR)).sqrt() as f32
    }
}

/// Appends the node of a cell and all below that pays. `weights` gets the weight of each: worth times volume, where the cube has 1.
fn halve(
    pilots: &mut [Pilot],
    of_hits: f64,
    cell: [(f32, f32); DIMENSIONS],
    depth: u32,
    nodes: &mut Vec<Node>,
    weights: &mut Vec<f32>,
) {
    let index = nodes.len();
    nodes.push(Node::Leaf);
    weights.push(Square::of(pilots.iter()).worth(of_hits) * 0.5_f32.powi(depth.cast_signed()));
    let Some(dimension) = best_dimension(pilots, of_hits, &cell, depth) else {
        return;
    };
    let (from, to) = cell[dimension];
    let middle = 0.5 * (from + to);
    let count = partition(pilots, |pilot| pilot.numbers[dimension] < middle);
    let (low, high) = pilots.split_at_mut(count);
    let with = |range| {
        let mut half = cell;
        half[dimension] = range;
        half
    };
    halve(low, of_hits, with((from, middle)), depth + 1, nodes, weights);
    let high_index = nodes.len();
    halve(high, of_hits, with((middle, to)), depth + 1, nodes, weights);
    nodes[index] = Node::Halved {
        dimension: dimension as u8,
        low: 0.5,
        high: high_index as u32,
    };
    let halved = weights[index + 1] + weights[high_index];
    if halved < (1.0 - LEAST_GAIN) * weights[index] {
        weights[index] = halved;
    } else {
        nodes.truncate(index);
        weights.truncate(index + 1);
        nodes.push(Node::Leaf);
    }
}

/// Moves those that fulfil `is_first` to the front; how many they are. The order within both parts is the same for the same input.
fn partition(pilots: &mut [Pilot], is_first: impl Fn(&Pilot) -> bool) -> usize {
    let mut count = 0;
    for i in 0..pilots.len() {
        if is_first(&pilots[i]) {
            pilots.swap(i, count);
            count += 1;
        }
    }
    count
}

/// Across which dimension it pays most to halve a cell, if there are pilots enough to tell.
fn best_dimension(pilots: &[Pilot], of_hits: f64, cell: &[(f32, f32); DIMENSIONS], depth: u32) -> Option<usize> {
    if pilots.len() < LEAST_PILOTS || depth == DEEPEST || !pilots.iter().any(Pilot::is_useful) {
        return None;
    }
    let halves = (0..DIMENSIONS).map(|dimension| {
        let (from, to) = cell[dimension];
        let middle = 0.5 * (from + to);
        let mut squares = [Square::default(); 2];
        for pilot in pilots {
            squares[usize::from(pilot.numbers[dimension] >= middle)].add(pilot);
        }
        (dimension, 0.5 * (squares[0].worth(of_hits) + squares[1].worth(of_hits)))
    });
    let best = halves.min_by(|a, b| a.1.total_cmp(&b.1));
    best.map(|(dimension, _)| dimension)
}

/// Gives each half its share of the photons.
fn share(nodes: &mut [Node], weights: &[f32]) {
    let even = EVEN_SHARE / (1.0 - EVEN_SHARE) * weights[0];
    // Each cell's weight and, of the even part, its volume's.
    let mut stack = vec![(0_usize, 1.0_f32)];
    while let Some((index, volume)) = stack.pop() {
        let Node::Halved { low, high, .. } = &mut nodes[index] else {
            continue;
        };
        let half = 0.5 * volume;
        let weight = |child: usize| weights[child] + even * half;
        let (a, b) = (weight(index + 1), weight(*high as usize));
        *low = a / (a + b);
        stack.push((*high as usize, half));
        stack.push((index + 1, half));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::{Sampler, SamplerKind};

    fn uniform(i: u32) -> EmissionNumbers {
        let stream = Sampler::new(SamplerKind::Sobol, 3, u32::MAX).start(0, 0, i);
        EmissionNumbers::draw(&stream)
    }

    /// A small target: one light of two, a corner of its surface, a fiftieth of the directions.
    fn brings(numbers: EmissionNumbers) -> f32 {
        let [light, x, y, u, v] = to_point(numbers);
        let hit = light < 0.5 && x + y < 0.8 && (u - 0.3).hypot(v - 0.7) < 0.08;
        if hit { 2.0 + x } else { 0.0 }
    }

    fn guide() -> EmissionGuide {
        let pilot = |(u, density)| Pilot::new((u, density), brings(u) / density);
        let mut pilots: Vec<_> = (0..1 << 16).map(|i| pilot((uniform(i), 1.0))).collect();
        let first = EmissionGuide::new(&mut pilots).expect("some hit");
        pilots.extend((1 << 16..1 << 17).map(|i| pilot(first.aim(uniform(i)))));
        EmissionGuide::new(&mut pilots).expect("some hit")
    }

    #[test]
    fn aiming_keeps_the_mean_and_lowers_the_variance() {
        let guide = guide();
        let (mut plain, mut aimed) = ([0.0_f64; 2], [0.0_f64; 2]);
        let count = 1 << 18;
        for i in 0..count {
            let u = uniform((1 << 20) + i);
            let value = f64::from(brings(u));
            plain = [plain[0] + value, plain[1] + value * value];
            let (v, density) = guide.aim(u);
            let value = f64::from(brings(v)) / f64::from(density);
            aimed = [aimed[0] + value, aimed[1] + value * value];
        }
        let n = f64::from(count);
        let [plain, aimed] = [plain, aimed].map(|[sum, square]| (sum / n, square / n - (sum / n).powi(2)));
        // Half the lights, the integral of 2 + x over the triangle, the disk. The aimed estimate's standard deviation is 0.4 %.
        let exact = 0.5 * (0.64 + 0.8_f64.powi(3) / 6.0) * std::f64::consts::PI * 0.08_f64.powi(2);
        assert!((aimed.0 / exact - 1.0).abs() < 0.015, "{exact} {aimed:?}");
        assert!(aimed.1 < 0.03 * plain.1, "{plain:?} {aimed:?}");
    }

    #[test]
    fn the_density_integrates_to_one_and_is_never_small() {
        let guide = guide();
        let count = 1 << 16;
        let mut sum = 0.0_f64;
        for i in 0..count {
            let (v, density) = guide.aim(uniform(i));
            assert!(density >= 0.99 * EVEN_SHARE, "{density}");
            assert!(to_point(v).iter().all(|x| (0.0..1.0).contains(x)));
            // The mean of 1 / density over aimed numbers is the volume of the cube.
            sum += 1.0 / f64::from(density);
        }
        assert!((sum / f64::from(count) - 1.0).abs() < 0.01, "{sum}");
    }

    #[test]
    fn there_is_nothing_to_learn_from_misses() {
        let mut pilots: Vec<_> = (0..1000).map(|i| Pilot::new((uniform(i), 1.0), 0.0)).collect();
        assert_eq!(EmissionGuide::new(&mut pilots), None);
    }
}
