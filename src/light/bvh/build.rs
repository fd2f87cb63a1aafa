//! The tree of lights while it is built: a binary one by the surface area orientation heuristic, whose nodes are then widened.

use super::LightBounds;
use crate::light::LightId;
use crate::math::{Bounds3, LANES};

/// A tree over lights.
pub(super) enum Binary {
    Light(LightId, LightBounds),
    Pair(LightBounds, Box<[Binary; 2]>),
}

/// From this depth on lights are halved by number, so that 2^32 of them need at most 62 levels.
const HALVING_DEPTH: u32 = 30;
/// More levels than any tree has.
pub(super) const MAX_DEPTH: usize = 64;
const BUCKETS: usize = 12;
/// So many lights are worth a task of their own.
const TASK_LIGHTS: usize = 1024;

type BoundedLight = (LightId, LightBounds);

impl Binary {
    /// The tree over `lights`; `None` if there are none. The same for any number of threads.
    pub fn over(lights: &mut [BoundedLight]) -> Option<Self> {
        let all = union_of(lights)?;
        Some(Self::below(lights, all, 0))
    }

    /// The part of a tree at `depth` that holds `lights`, which are not none.
    fn below(lights: &mut [BoundedLight], all: LightBounds, depth: u32) -> Self {
        if let [(light, bounds)] = lights {
            return Self::Light(*light, *bounds);
        }
        let middle = split(lights, &all, depth);
        let is_task = lights.len() >= TASK_LIGHTS;
        let (left, right) = lights.split_at_mut(middle);
        let half = |lights: &mut [BoundedLight]| {
            let all = union_of(lights).expect("neither half is empty");
            Self::below(lights, all, depth + 1)
        };
        let (left, right) = if is_task {
            rayon::join(|| half(left), || half(right))
        } else {
            (half(left), half(right))
        };
        Self::Pair(all, Box::new([left, right]))
    }

    pub fn bounds(&self) -> &LightBounds {
        match self {
            Self::Light(_, bounds) | Self::Pair(bounds, _) => bounds,
        }
    }

    /// How much is gained if its children stand in its place; `None` if it has none.
    fn worth_of_opening(&self) -> Option<f32> {
        match self {
            Self::Light(..) => None,
            Self::Pair(bounds, _) => Some(bounds.cost()),
        }
    }
}

/// Up to eight children of one node: those of its two that are least like one light are replaced by their own, one after the other.
pub(super) fn widen(children: [Binary; 2]) -> Vec<Binary> {
    let mut children = Vec::from(children);
    while children.len() < LANES {
        let worths = children.iter().map(Binary::worth_of_opening).enumerate();
        let opened = worths.filter_map(|(i, worth)| Some((worth?, i)));
        let Some((_, opened)) = opened.max_by(|a, b| a.0.total_cmp(&b.0)) else {
            break;
        };
        if let Binary::Pair(_, grandchildren) = children.remove(opened) {
            children.extend(*grandchildren);
        }
    }
    children
}

fn union_of(lights: &[BoundedLight]) -> Option<LightBounds> {
    let (first, rest) = lights.split_first()?;
    Some(rest.iter().fold(first.1, |all, (_, bounds)| all.union(bounds)))
}

/// Orders two or more lights so that those before the returned index (neither none nor all) are one child, by the surface area
/// orientation heuristic over equal buckets on each axis.
fn split(lights: &mut [BoundedLight], all: &LightBounds, depth: u32) -> usize {
    let centers = Bounds3::from_points(lights.iter().map(|(_, b)| b.bounds.center()));
    let half = lights.len() / 2;
    let extent = all.bounds.extent();
    let mut best: Option<(f32, usize, usize)> = None;
    for axis in 0..3 {
        if depth >= HALVING_DEPTH || centers.extent()[axis] <= 0.0 {
            continue;
        }
        let stretch = extent.max_element() / extent[axis];
        for (boundary, cost) in boundary_costs(lights, &centers, axis).into_iter().enumerate() {
            let Some(cost) = cost else { continue };
            if best.is_none_or(|(least, ..)| cost * stretch < least) {
                best = Some((cost * stretch, axis, boundary));
            }
        }
    }
    let Some((_, axis, boundary)) = best else {
        let axis = extent.max_position();
        lights.select_nth_unstable_by(half, |(i, a), (j, b)| {
            let key = |b: &LightBounds| b.bounds.center()[axis];
            key(a).total_cmp(&key(b)).then(i.cmp(j))
        });
        return half;
    };
    lights.sort_by_key(|(_, b)| bucket(b, &centers, axis) > boundary);
    lights.partition_point(|(_, b)| bucket(b, &centers, axis) <= boundary)
}

fn bucket(light: &LightBounds, centers: &Bounds3, axis: usize) -> usize {
    let offset = (light.bounds.center()[axis] - centers.min[axis]) / centers.extent()[axis];
    ((offset * BUCKETS as f32) as usize).min(BUCKETS - 1)
}

/// The cost of splitting after each bucket; `None` where one side would be empty.
fn boundary_costs(lights: &[BoundedLight], centers: &Bounds3, axis: usize) -> [Option<f32>; BUCKETS - 1] {
    let mut buckets: [Option<LightBounds>; BUCKETS] = [None; BUCKETS];
    for (_, light) in lights {
        let bucket = &mut buckets[bucket(light, centers, axis)];
        *bucket = join(*bucket, Some(*light));
    }
    let mut costs = [None; BUCKETS - 1];
    let mut below = None;
    for i in 0..BUCKETS - 1 {
        below = join(below, buckets[i]);
        costs[i] = below.map(|below| below.cost());
    }
    let mut above = None;
    for i in (0..BUCKETS - 1).rev() {
        above = join(above, buckets[i + 1]);
        costs[i] = costs[i].zip(above).map(|(cost, above)| cost + above.cost());
    }
    costs
}

fn join(a: Option<LightBounds>, b: Option<LightBounds>) -> Option<LightBounds> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.union(&b)),
        (a, b) => a.or(b),
    }
}
