//! The nearest points found so far, and how far it is to the last of them.
//!
//! What is kept is the squared distances of whole leaves: where more than `k` lanes are within the bound, a new bound is found by
//! counting lanes below a guess, and guessing again between two counts ([`Bracket`]). Nothing is moved, and hardly a branch depends on
//! a lane. Only at the end the lanes within the bound are put together, in the order of places.

use super::bracket::Bracket;
use super::nodes::{LEAF, Lanes};
use super::simd::{EIGHT, Simd};
use crate::math::Vec3;

/// How far a search may be from the last one, in radii of that, to learn from its radius.
const MOVED: f32 = 2.0;
/// How much greater its radius probably is at most. Where it is not, the search is done again.
const GROWN: f32 = 1.15;

/// What a search for nearest points found, and memory that the next search uses again.
#[derive(Clone, Debug, Default)]
pub struct Nearest {
    places: Vec<u32>,
    distances_squared: Vec<f32>,
    radius_squared: f32,
    candidates: Candidates,
    /// Where the last search was that found as many as were asked for, and what it asked for.
    last: Option<(Vec3, usize, f32)>,
}

/// Leaves that have points within the bound.
#[derive(Clone, Debug, Default)]
pub struct Candidates {
    k: usize,
    /// The squared distances of a leaf's points; infinite for a point that is no candidate. Only the first ones, as many as `leaves`, mean
    /// anything.
    lanes: Vec<Lanes>,
    /// Which leaf.
    leaves: Vec<u32>,
    /// Lanes are candidates if they are at most this.
    bound: f32,
    /// Of those that equal the bound only points of at most this index.
    bound_index: u32,
    /// The number of candidates.
    held: usize,
    /// How many candidates are worth a new bound.
    enough: usize,
    /// Leaves by number, then where they are in `lanes`.
    sorted: Vec<(u32, u32)>,
    /// Points whose distance equals the bound: index, and where they are in `lanes`.
    ties: Vec<(u32, u32)>,
}

impl Nearest {
    /// Memory for searches.
    pub fn new() -> Self {
        Self::default()
    }

    /// The number of points found.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Whether none was found.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// The places of the points found, in ascending order.
    pub fn places(&self) -> &[u32] {
        &self.places
    }

    /// Their squared distances, in the order of `places`.
    pub fn distances_squared(&self) -> &[f32] {
        &self.distances_squared
    }

    /// The square of the radius that was searched: the distance of the farthest point found if there are as many as were asked for, and
    /// the search's own limit otherwise.
    pub fn radius_squared(&self) -> f32 {
        self.radius_squared
    }

    /// Within what squared distance of `p` there are probably `k` points, if the last search was near.
    ///
    /// Searches often follow one another closely.
    #[inline(always)]
    pub(super) fn likely_bound(&self, p: Vec3, k: usize) -> f32 {
        match self.last {
            Some((last, last_k, radius)) if last_k == k => {
                let moved = last.distance(p);
                let likely = (radius + moved).min(GROWN * radius);
                if moved <= MOVED * radius {
                    likely * likely
                } else {
                    f32::INFINITY
                }
            }
            _ => f32::INFINITY,
        }
    }

    #[inline(always)]
    pub(super) fn start(&mut self, k: usize, bound: f32) -> &mut Candidates {
        let candidates = &mut self.candidates;
        candidates.k = k;
        candidates.leaves.clear();
        candidates.bound = bound;
        candidates.bound_index = u32::MAX;
        candidates.held = 0;
        candidates.enough = k;
        candidates
    }

    /// Takes the candidates as what was found, within `radius_squared`.
    #[inline(always)]
    pub(super) fn finish<S: Simd>(&mut self, simd: S, order: &[u32], p: Vec3, radius_squared: f32) {
        let Self { candidates, .. } = self;
        self.radius_squared = radius_squared;
        let full = candidates.held >= candidates.k;
        if full {
            candidates.tighten_to(simd, 0);
            candidates.break_ties(order);
        }
        candidates.sorted.clear();
        candidates.sorted.extend(candidates.leaves.iter().copied().zip(0..));
        candidates.sorted.sort_unstable();
        self.places.resize(candidates.held, 0);
        self.distances_squared.resize(candidates.held, 0.0);
        let mut found = self.places.iter_mut().zip(&mut self.distances_squared);
        for &(leaf, block) in &candidates.sorted {
            let lanes = &candidates.lanes[block as usize];
            let mut mask = mask(simd, lanes, candidates.bound);
            while mask != 0 {
                let lane = mask.trailing_zeros() as usize;
                mask &= mask - 1;
                if let Some((place, distance_squared)) = found.next() {
                    *place = leaf * LEAF as u32 + lane as u32;
                    *distance_squared = lanes[lane / EIGHT][lane % EIGHT];
                }
            }
        }
        if full {
            self.radius_squared = self
                .distances_squared
                .iter()
                .fold(0.0, |a, b| if *b > a { *b } else { a });
            self.last = Some((p, candidates.k, self.radius_squared.sqrt()));
        }
    }

    /// Finds nothing.
    pub(super) fn set_empty(&mut self) {
        self.places.clear();
        self.distances_squared.clear();
        self.radius_squared = 0.0;
    }
}

impl Candidates {
    /// Whether what is no nearer than `distance`, and has no index below `first_index`, cannot be among the nearest.
    #[inline(always)]
    pub fn excludes(&self, distance: f32, first_index: impl FnOnce() -> u32) -> bool {
        distance > self.bound
            || (distance == self.bound && self.bound_index != u32::MAX && first_index() > self.bound_index)
    }

    /// Whether there are as many as are asked for.
    #[inline(always)]
    pub fn is_full(&self) -> bool {
        self.held >= self.k
    }

    #[inline(always)]
    pub fn bound(&self) -> f32 {
        self.bound
    }

    /// Adds the points of a leaf that are within the bound and taken by `accept`.
    #[inline(always)]
    pub fn add<S: Simd>(
        &mut self,
        simd: S,
        leaf: u32,
        distances: [S::Vector; LEAF / EIGHT],
        order: &[u32],
        accept: impl Fn(u32) -> bool,
    ) {
        let bound = simd.splat(self.bound);
        let mut within = 0;
        for (i, v) in distances.iter().enumerate() {
            within |= simd.at_most(*v, bound) << (i * EIGHT);
        }
        if within == 0 {
            return;
        }
        let block = self.leaves.len();
        if block == self.lanes.len() {
            self.lanes.push(Default::default());
        }
        let lanes = &mut self.lanes[block];
        for (lanes, v) in lanes.iter_mut().zip(distances) {
            *lanes = simd.store(v);
        }
        let mut rejected = 0;
        let mut mask = within;
        // Counted, so that nothing is left of the loop where all are accepted.
        for _ in 0..within.count_ones() {
            let lane = mask.trailing_zeros();
            mask &= mask - 1;
            rejected |= u32::from(!accept(leaf * LEAF as u32 + lane)) << lane;
        }
        if self.bound_index != u32::MAX {
            rejected |= late_ties(lanes, order, leaf, (self.bound, self.bound_index));
        }
        if rejected != 0 {
            reject(lanes, rejected);
        }
        self.leaves.push(leaf);
        self.held += (within & !rejected).count_ones() as usize;
        if self.held >= self.enough {
            self.tighten(simd, order);
        }
    }

    /// Lowers the bound, as far as there are `k` candidates within.
    #[inline(always)]
    fn tighten<S: Simd>(&mut self, simd: S, order: &[u32]) {
        let slack = self.k / 4;
        self.tighten_to(simd, slack);
        // What is left over ties. The more of it there is, the more it matters to have done with it.
        if self.held > self.k + slack {
            self.drop_ties(order);
        }
        self.enough = self.held + (self.k / 2).max(8);
        if self.leaves.len() > 2 * self.k + 32 {
            self.compact(simd, order);
        }
    }

    /// Lowers the bound until at most `slack` candidates more than `k` are within, or all the others tie.
    #[inline(always)]
    fn tighten_to<S: Simd>(&mut self, simd: S, slack: usize) {
        let blocks = &self.lanes[..self.leaves.len()];
        let mut bracket = Bracket::new(self.k, slack, greatest(simd, blocks, self.bound), self.held);
        while let Some(guess) = bracket.guess() {
            bracket.narrow(guess, count(simd, blocks, guess));
        }
        (self.bound, self.held) = bracket.bound();
    }

    /// Keeps only leaves that have candidates, and exactly `k` of these.
    #[inline(always)]
    fn compact<S: Simd>(&mut self, simd: S, order: &[u32]) {
        self.tighten_to(simd, 0);
        self.break_ties(order);
        let mut kept = 0;
        for block in 0..self.leaves.len() {
            if mask(simd, &self.lanes[block], self.bound) != 0 {
                self.lanes[kept] = self.lanes[block];
                self.leaves[kept] = self.leaves[block];
                kept += 1;
            }
        }
        self.leaves.truncate(kept);
    }

    /// Where more than `k` candidates are left because some tie with the bound, drops those of the highest indices.
    #[inline(always)]
    fn break_ties(&mut self, order: &[u32]) {
        if self.held > self.k {
            self.drop_ties(order);
        }
    }

    #[cold]
    fn drop_ties(&mut self, order: &[u32]) {
        self.ties.clear();
        for (block, (lanes, leaf)) in (0..).zip(self.lanes.iter().zip(&self.leaves)) {
            for (lane, d) in (0..).zip(lanes.as_flattened()) {
                if *d == self.bound {
                    let place = *leaf as usize * LEAF + lane as usize;
                    self.ties.push((order[place], block * LEAF as u32 + lane));
                }
            }
        }
        let kept = self.ties.len() - (self.held - self.k);
        let (_, &mut (first_dropped, _), _) = self.ties.select_nth_unstable(kept);
        for (_, lane) in &self.ties[kept..] {
            self.lanes[*lane as usize / LEAF].as_flattened_mut()[*lane as usize % LEAF] = f32::INFINITY;
        }
        self.held = self.k;
        self.bound_index = first_dropped - 1;
    }
}

/// A bit for each lane that equals the bound with a higher index than it.
#[cold]
fn late_ties(lanes: &Lanes, order: &[u32], leaf: u32, (bound, bound_index): (f32, u32)) -> u32 {
    let points = lanes.as_flattened().iter().zip(&order[leaf as usize * LEAF..]);
    let late = points.map(|(d, index)| *d == bound && *index > bound_index);
    late.zip(0..).map(|(late, lane)| u32::from(late) << lane).sum()
}

/// Makes lanes infinite, so that they are no candidates.
#[inline(always)]
fn reject(lanes: &mut Lanes, mask: u32) {
    for (lane, d) in lanes.as_flattened_mut().iter_mut().enumerate() {
        *d = if mask >> lane & 1 == 1 { f32::INFINITY } else { *d };
    }
}

/// A bit for each lane that is at most `bound`.
#[inline(always)]
fn mask<S: Simd>(simd: S, lanes: &Lanes, bound: f32) -> u32 {
    let mut mask = 0;
    for (i, v) in lanes.iter().enumerate() {
        mask |= simd.at_most(simd.load(v), simd.splat(bound)) << (i * EIGHT);
    }
    mask
}

/// The number of lanes that are at most `bound`.
#[inline(always)]
fn count<S: Simd>(simd: S, blocks: &[Lanes], bound: f32) -> usize {
    let mut count = 0;
    for lanes in blocks {
        count += mask(simd, lanes, bound).count_ones();
    }
    count as usize
}

/// The greatest lane that is at most `bound`.
#[inline(always)]
fn greatest<S: Simd>(simd: S, blocks: &[Lanes], bound: f32) -> f32 {
    let bound = simd.splat(bound);
    let mut greatest = simd.splat(0.0);
    for v in blocks.as_flattened() {
        greatest = simd.max(simd.keep_at_most(simd.load(v), bound), greatest);
    }
    simd.store(greatest)
        .into_iter()
        .fold(0.0, |a, b| if b > a { b } else { a })
}
