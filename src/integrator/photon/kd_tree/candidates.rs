//! The nearest points found so far, and how far it is to the last of them.
//!
//! What is kept is the squared distances of whole leaves: where more than `k` lanes are within the bound, a new bound is found by
//! counting lanes below a guess, and guessing again between two counts. On surfaces the number of points within a radius grows with
//! its square, so that a guess on the line between two counts is nearly right. Nothing is moved, and no branch depends on a lane.

use super::nodes::{LEAF, Lanes};

/// What a search for nearest points found, and memory that the next search uses again.
#[derive(Clone, Debug, Default)]
pub struct Nearest {
    places: Vec<u32>,
    distances_squared: Vec<f32>,
    radius_squared: f32,
    candidates: Candidates,
}

/// Leaves that have points within the bound.
#[derive(Clone, Debug, Default)]
pub struct Candidates {
    k: usize,
    /// The squared distances of a leaf's points; infinite for a point that is no candidate.
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

    #[inline(always)]
    pub(super) fn start(&mut self, k: usize, bound: f32) -> &mut Candidates {
        let candidates = &mut self.candidates;
        candidates.k = k;
        candidates.lanes.clear();
        candidates.leaves.clear();
        candidates.bound = bound;
        candidates.bound_index = u32::MAX;
        candidates.held = 0;
        candidates.enough = k;
        candidates
    }

    /// Takes the candidates as what was found, within `radius_squared`.
    #[inline(always)]
    pub(super) fn finish(&mut self, order: &[u32], radius_squared: f32) {
        let Self { candidates, .. } = self;
        self.places.clear();
        self.distances_squared.clear();
        self.radius_squared = radius_squared;
        if candidates.held >= candidates.k {
            candidates.tighten_to(0);
            candidates.break_ties(order);
            self.radius_squared = greatest(&candidates.lanes, candidates.bound);
        }
        candidates.sorted.clear();
        candidates.sorted.extend(candidates.leaves.iter().copied().zip(0..));
        candidates.sorted.sort_unstable();
        for &(leaf, block) in &candidates.sorted {
            let lanes = &candidates.lanes[block as usize];
            let mut mask = at_most(lanes, candidates.bound);
            while mask != 0 {
                let lane = mask.trailing_zeros();
                mask &= mask - 1;
                self.places.push(leaf * LEAF as u32 + lane);
                self.distances_squared.push(lanes[lane as usize]);
            }
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

    #[inline(always)]
    pub fn bound(&self) -> f32 {
        self.bound
    }

    /// Adds the points of a leaf that are within the bound and taken by `accept`.
    #[inline(always)]
    pub fn add(&mut self, leaf: u32, mut lanes: Lanes, order: &[u32], accept: impl Fn(u32) -> bool) {
        if self.bound_index != u32::MAX {
            self.drop_late_ties(leaf, &mut lanes, order);
        }
        let within = at_most(&lanes, self.bound);
        if within == 0 {
            return;
        }
        let mut hits = within.count_ones();
        let mut mask = within;
        while mask != 0 {
            let lane = mask.trailing_zeros();
            mask &= mask - 1;
            if !accept(leaf * LEAF as u32 + lane) {
                lanes[lane as usize] = f32::INFINITY;
                hits -= 1;
            }
        }
        self.lanes.push(lanes);
        self.leaves.push(leaf);
        self.held += hits as usize;
        if self.held >= self.enough {
            self.tighten(order);
        }
    }

    /// Of what ties with the bound, only those of lower index than what was found can be among the nearest.
    #[cold]
    fn drop_late_ties(&self, leaf: u32, lanes: &mut Lanes, order: &[u32]) {
        for (d, index) in lanes.iter_mut().zip(&order[leaf as usize * LEAF..]) {
            if *d == self.bound && *index > self.bound_index {
                *d = f32::INFINITY;
            }
        }
    }

    /// Lowers the bound, as far as there are `k` candidates within.
    #[inline(always)]
    fn tighten(&mut self, order: &[u32]) {
        self.tighten_to(self.k / 16);
        self.enough = self.held + (self.k / 8).max(8);
        if self.lanes.len() > 2 * self.k + 32 {
            self.compact(order);
        }
    }

    /// Lowers the bound until at most `slack` candidates more than `k` are within, or all the others tie.
    #[inline(always)]
    fn tighten_to(&mut self, slack: usize) {
        // Candidates up to `low` are fewer than `k`, those up to `high` are not. Below 0 there are none.
        let mut low = (-1, 0);
        let mut high = (i64::from(greatest(&self.lanes, self.bound).to_bits()), self.held);
        let wanted = self.k as f32 + 0.5 * slack as f32;
        for step in 0.. {
            if high.1 <= self.k + slack || high.0 - low.0 == 1 {
                break;
            }
            let guess = if step % 4 == 3 {
                // The numbers of floats are bisected, in case that guesses go astray.
                (low.0 + high.0) / 2
            } else {
                let (from, to) = (f32::from_bits(low.0.max(0) as u32), f32::from_bits(high.0 as u32));
                let part = (wanted - low.1 as f32) / (high.1 - low.1) as f32;
                i64::from((from + part * (to - from)).to_bits()).clamp(low.0 + 1, high.0 - 1)
            };
            let count = count(&self.lanes, f32::from_bits(guess as u32));
            if count < self.k {
                low = (guess, count);
            } else {
                high = (guess, count);
            }
        }
        (self.bound, self.held) = (f32::from_bits(high.0 as u32), high.1);
    }

    /// Keeps only leaves that have candidates, and exactly `k` of these.
    #[cold]
    fn compact(&mut self, order: &[u32]) {
        self.tighten_to(0);
        self.break_ties(order);
        let mut kept = 0;
        for block in 0..self.lanes.len() {
            if at_most(&self.lanes[block], self.bound) != 0 {
                self.lanes[kept] = self.lanes[block];
                self.leaves[kept] = self.leaves[block];
                kept += 1;
            }
        }
        self.lanes.truncate(kept);
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
            for (lane, d) in (0..).zip(lanes) {
                if *d == self.bound {
                    let place = *leaf as usize * LEAF + lane as usize;
                    self.ties.push((order[place], block * LEAF as u32 + lane));
                }
            }
        }
        let kept = self.ties.len() - (self.held - self.k);
        let (_, &mut (first_dropped, _), _) = self.ties.select_nth_unstable(kept);
        for (_, lane) in &self.ties[kept..] {
            self.lanes[*lane as usize / LEAF][*lane as usize % LEAF] = f32::INFINITY;
        }
        self.held = self.k;
        self.bound_index = first_dropped - 1;
    }
}

/// A bit for each lane that is at most `bound`.
#[inline(always)]
fn at_most(lanes: &Lanes, bound: f32) -> u32 {
    let mut mask = 0;
    for (lane, d) in lanes.iter().enumerate() {
        mask |= u32::from(*d <= bound) << lane;
    }
    mask
}

/// The number of lanes that are at most `bound`.
#[inline(always)]
fn count(lanes: &[Lanes], bound: f32) -> usize {
    let mut counts = [0u32; LEAF];
    for lanes in lanes {
        for (count, d) in counts.iter_mut().zip(lanes) {
            *count += u32::from(*d <= bound);
        }
    }
    counts.iter().sum::<u32>() as usize
}

/// The greatest lane that is at most `bound`.
#[inline(always)]
fn greatest(lanes: &[Lanes], bound: f32) -> f32 {
    let mut greatest = [0.0; LEAF];
    for lanes in lanes {
        for (greatest, d) in greatest.iter_mut().zip(lanes) {
            let d = if *d <= bound { *d } else { 0.0 };
            *greatest = if d > *greatest { d } else { *greatest };
        }
    }
    greatest.into_iter().fold(0.0, |a, b| if b > a { b } else { a })
}
