//! Spatial splits: triangles that a plane goes through are on both of its sides, each time in a box around the part that is there (Stich,
//! Friedrich and Dietrich 2009, "Spatial Splits in Bounding Volume Hierarchies").
//!
//! A part, or fragment, is never lost: where the plane meets an edge is computed in double precision and rounded outwards, so the boxes of a
//! triangle's fragments cover the triangle. (What the rays' own rounding needs is added where leaves are made.)

use rayon::prelude::*;

use super::bins::{CHUNK, cost};
use super::item::{Box4, Extent, Item};
use super::primitives::Primitives;
use crate::math::{Vec3, Vec4};

/// Bins along an axis.
const BINS: usize = 16;

/// Splits are not tried where the boxes of an object split have less than this part of the area of the whole tree in common (Stich et
/// al. 2009, section 4.5; a tenth of what is tried there makes builds a quarter slower and trees no better).
pub const LEAST_OVERLAP: f32 = 1e-4;

/// Nor where they have less than this part of the area of the node in common, as little is to be gained there.
pub const LEAST_SHARE: f32 = 0.2;

/// A plane across an axis.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    axis: usize,
    place: f32,
    /// What the two sides cost.
    pub cost: f32,
    /// How many items are on both.
    pub both: u32,
}

/// An edge's point at `place` along an axis, as a box that it is in for sure. The edge goes from one side to the other.
fn crossing(a: Vec3, b: Vec3, axis: usize, place: f32) -> Box4 {
    let (a, b) = (a.as_dvec3(), b.as_dvec3());
    let fraction = (f64::from(place) - a[axis]) / (b[axis] - a[axis]);
    let mut low = Vec4::ZERO;
    let mut high = Vec4::ZERO;
    for i in 0..3 {
        let nearest = a[i] + (b[i] - a[i]) * fraction;
        // More than the rounding of the operations before; that to single precision is less than a step of it.
        let slack = (a[i].abs() + b[i].abs()) * 8.0 * f64::EPSILON;
        low[i] = ((nearest - slack) as f32).next_down();
        high[i] = ((nearest + slack) as f32).next_up();
    }
    (low[axis], high[axis]) = (place, place);
    Box4 { low, high }
}

/// Boxes around what is of a triangle in a box on the two sides of a plane; one of them may be empty.
fn cut(corners: &[Vec3; 3], within: Box4, axis: usize, place: f32) -> [Box4; 2] {
    let (mut below, mut above) = (Box4::EMPTY, Box4::EMPTY);
    for i in 0..3 {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        if a[axis] <= place {
            below = below.grow(a.extend(0.0));
        }
        if a[axis] >= place {
            above = above.grow(a.extend(0.0));
        }
        if (a[axis] < place && b[axis] > place) || (a[axis] > place && b[axis] < place) {
            let point = crossing(a, b, axis, place);
            below = below.union(point);
            above = above.union(point);
        }
    }
    below.high[axis] = below.high[axis].min(place);
    above.low[axis] = above.low[axis].max(place);
    [below.intersection(within), above.intersection(within)]
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: Box4,
    /// Items that begin here.
    enter: u32,
    /// Items that end here.
    exit: u32,
}

type Histogram = [[Bin; BINS]; 3];

const NOTHING: Histogram = [[Bin {
    bounds: Box4::EMPTY,
    enter: 0,
    exit: 0,
}; BINS]; 3];

/// Cuts a box into equal slabs, along each axis.
#[derive(Clone, Copy)]
struct Slabs {
    low: Vec4,
    step: Vec4,
    /// Slabs a unit of length; 0 along an axis that is not cut.
    scale: Vec4,
}

impl Slabs {
    fn new(bounds: &Box4) -> Self {
        let step = (bounds.high - bounds.low) / BINS as f32;
        let scale = step.recip();
        let is_cut = step.cmpgt(Vec4::ZERO) & scale.cmpgt(Vec4::ZERO) & scale.cmplt(Vec4::INFINITY);
        Self {
            low: bounds.low,
            step,
            scale: Vec4::select(is_cut, scale, Vec4::ZERO),
        }
    }

    /// Where the slab begins.
    fn place(&self, axis: usize, bin: usize) -> f32 {
        self.low[axis] + self.step[axis] * bin as f32
    }

    /// The slabs that a point is in, by axis.
    fn bins(&self, point: Vec4) -> [usize; 3] {
        let [x, y, z, _] = ((point - self.low) * self.scale).to_array();
        [x, y, z].map(|x| (x as usize).min(BINS - 1))
    }
}

/// The plane of least cost between slabs of the items' box, if there is one that divides them.
pub fn best_plane(items: &[Item], extent: &Extent, primitives: &impl Primitives) -> Option<Plane> {
    let slabs = Slabs::new(&extent.bounds);
    let of_chunk = |chunk: &[Item]| {
        let mut histogram = NOTHING;
        for item in chunk {
            add(&mut histogram, item, &slabs, primitives);
        }
        histogram
    };
    let union = |a: Histogram, b: Histogram| {
        std::array::from_fn(|axis| {
            std::array::from_fn(|bin| {
                let (a, b): (&Bin, &Bin) = (&a[axis][bin], &b[axis][bin]);
                Bin {
                    bounds: a.bounds.union(b.bounds),
                    enter: a.enter + b.enter,
                    exit: a.exit + b.exit,
                }
            })
        })
    };
    let histogram = if items.len() <= CHUNK {
        of_chunk(items)
    } else {
        items.par_chunks(CHUNK).map(of_chunk).reduce(|| NOTHING, union)
    };
    let all = items.len() as u32;
    let mut best: Option<Plane> = None;
    for (axis, bins) in histogram.iter().enumerate() {
        if slabs.scale[axis] == 0.0 {
            continue;
        }
        let mut above = [(0.0, 0); BINS];
        let (mut upper, mut count) = (Box4::EMPTY, 0);
        for bin in (1..BINS).rev() {
            upper = upper.union(bins[bin].bounds);
            count += bins[bin].exit;
            above[bin] = (cost(&upper, count), count);
        }
        let (mut lower, mut count) = (Box4::EMPTY, 0);
        for bin in 1..BINS {
            lower = lower.union(bins[bin - 1].bounds);
            count += bins[bin - 1].enter;
            let (above_cost, above_count) = above[bin];
            let cost = cost(&lower, count) + above_cost;
            let divides = count < all && above_count < all;
            if divides && best.is_none_or(|best| cost < best.cost) {
                best = Some(Plane {
                    axis,
                    place: slabs.place(axis, bin),
                    cost,
                    both: (count + above_count).saturating_sub(all),
                });
            }
        }
    }
    best
}

/// Adds an item to all slabs that it is in. The boxes there are estimates, in single precision: how items are cut is up to [`cut`].
fn add(histogram: &mut Histogram, item: &Item, slabs: &Slabs, primitives: &impl Primitives) {
    let bounds = item.box4();
    let (first, last) = (slabs.bins(bounds.low), slabs.bins(bounds.high));
    let triangle = if first == last {
        None
    } else {
        primitives.corners(item.index())
    };
    let triangle = triangle.map(|corners| corners.map(|corner| corner.extend(0.0)));
    let places = triangle.map(|corners| corners.map(|corner| slabs.bins(corner)));
    for (axis, bins) in histogram.iter_mut().enumerate() {
        let (first, last) = (first[axis], last[axis]);
        let (Some(triangle), Some(places), true) = (triangle, places, first < last) else {
            // Not to be cut: where its middle is.
            let bin = &mut bins[slabs.bins(item.twice_center() * 0.5)[axis]];
            bin.bounds = bin.bounds.union(bounds);
            bin.enter += 1;
            bin.exit += 1;
            continue;
        };
        bins[first].enter += 1;
        bins[last].exit += 1;
        // What is beyond a fragment's box counts as being at its border.
        let within = |point: Vec4| point.max(bounds.low).min(bounds.high);
        for i in 0..3 {
            let (mut a, mut b) = (triangle[i], triangle[(i + 1) % 3]);
            let (mut from, mut to) = (places[i][axis], places[(i + 1) % 3][axis]);
            let bin = &mut bins[from.clamp(first, last)];
            bin.bounds = bin.bounds.grow(within(a));
            if from > to {
                (a, b, from, to) = (b, a, to, from);
            }
            let crossed = from.max(first)..to.min(last);
            if crossed.is_empty() {
                continue;
            }
            let slope = (b - a) * (1.0 / (b[axis] - a[axis]));
            for bin in crossed {
                let point = within(a + slope * (slabs.place(axis, bin + 1) - a[axis]));
                bins[bin].bounds = bins[bin].bounds.grow(point);
                bins[bin + 1].bounds = bins[bin + 1].bounds.grow(point);
            }
        }
    }
}

/// Divides items by a plane: those below, then those above. An item that it goes through is cut in two, unless it costs less to have all of
/// it on one side (Stich et al. 2009, "reference unsplitting"), or `room` for more items is used up.
pub fn divide(items: &[Item], plane: &Plane, primitives: &impl Primitives, room: usize) -> [Vec<Item>; 2] {
    let (axis, place) = (plane.axis, plane.place);
    let mut sides = [Vec::with_capacity(items.len()), Vec::with_capacity(items.len())];
    let mut boxes = [Box4::EMPTY; 2];
    let mut straddling = Vec::new();
    for item in items {
        let bounds = item.box4();
        let side = if bounds.high[axis] <= place {
            0
        } else if bounds.low[axis] >= place {
            1
        } else if let Some(triangle) = primitives.corners(item.index()) {
            let parts = cut(&triangle, bounds, axis, place);
            match parts.map(|part| part.is_empty()) {
                [false, false] => {
                    straddling.push((*item, parts));
                    continue;
                }
                // Nothing of it is on the other side; a part that is not empty is there by rounding only.
                [true, _] => 1,
                [false, true] => 0,
            }
        } else {
            usize::from(item.twice_center()[axis] * 0.5 >= place)
        };
        boxes[side] = boxes[side].union(bounds);
        sides[side].push(*item);
    }
    let mut room = room;
    for (item, parts) in straddling {
        let whole = item.box4();
        let counts = [&sides[0], &sides[1]].map(|side| side.len() as u32);
        let cut_cost = cost(&boxes[0].union(parts[0]), counts[0] + 1) + cost(&boxes[1].union(parts[1]), counts[1] + 1);
        let whole_cost =
            |side: usize| cost(&boxes[side].union(whole), counts[side] + 1) + cost(&boxes[1 - side], counts[1 - side]);
        let costs = [whole_cost(0), whole_cost(1)];
        if room > 0 && cut_cost < costs[0].min(costs[1]) {
            room -= 1;
            for side in 0..2 {
                boxes[side] = boxes[side].union(parts[side]);
                sides[side].push(item.fragment(&parts[side]));
            }
            continue;
        }
        let side = usize::from(costs[1] < costs[0]);
        boxes[side] = boxes[side].union(whole);
        sides[side].push(item);
    }
    sides
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of a triangle stay in the boxes of its fragments, however often it is cut.
    #[test]
    fn fragments_cover_their_triangle() {
        let mut state = 1u64;
        let mut random = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f32 / (1 << 24) as f32
        };
        for round in 0..2000 {
            let size = 10f32.powi(round % 9 - 4);
            let mut point = || Vec3::new(random(), random() * 0.01, random()) * size + Vec3::new(3.0, -1.0, 0.0);
            let corners = [point(), point(), point()];
            let whole = corners.iter().fold(Box4::EMPTY, |bounds, p| bounds.grow(p.extend(0.0)));
            let mut parts = vec![whole];
            for level in 0..6 {
                let axis = level % 3;
                let mut next = Vec::new();
                for part in parts {
                    let place = part.low[axis] + (part.high[axis] - part.low[axis]) * random();
                    next.extend(
                        cut(&corners, part, axis, place)
                            .into_iter()
                            .filter(|part| !part.is_empty()),
                    );
                }
                parts = next;
            }
            for _ in 0..50 {
                let (mut u, mut v) = (f64::from(random()), f64::from(random()));
                if u + v > 1.0 {
                    (u, v) = (1.0 - u, 1.0 - v);
                }
                let [a, b, c] = corners.map(Vec3::as_dvec3);
                let p = a + (b - a) * u + (c - a) * v;
                // The point itself is rounded here, by less than this.
                let slack = 1e-14 * (p.abs().max_element() + f64::from(size));
                let is_in = |part: &Box4| {
                    let (low, high) = (part.low.truncate().as_dvec3(), part.high.truncate().as_dvec3());
                    (p + slack).cmpge(low).all() && (p - slack).cmple(high).all()
                };
                assert!(parts.iter().any(is_in), "{corners:?} {p:?}");
            }
        }
    }
}
