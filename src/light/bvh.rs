//! A bounding volume hierarchy over lights: which light a point samples is decided on the way from the root to a leaf, at each
//! node in proportion to the importance of its two children for that point (Conty Estevez and Kulla 2018; pbrt-v4, section 12.6.3).
//! Lights that are infinitely far away stand beside it: each is as likely as the whole tree.

use super::bounds::{Cluster, LightBounds};
use super::sampler::SampledLight;
use super::{Light, LightId};
use crate::math::{Bounds3, Vec3};
use crate::sampling::BELOW_ONE;

/// The tree, and what stands beside it.
#[derive(Clone, Debug, Default)]
pub(super) struct LightBvh {
    /// The root first; two children are neighbours.
    nodes: Vec<Node>,
    infinite: Vec<LightId>,
    /// By light: the way from the root, a bit a level from the lowest on (1: the second child), above them a 1;
    /// [`ABSENT`] or [`BESIDE`].
    ways: Vec<u64>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    cluster: Cluster,
    next: Next,
}

#[derive(Clone, Copy, Debug)]
enum Next {
    /// The first of two children.
    Children(u32),
    Leaf(LightId),
}

/// The way to a light that emits nothing.
const ABSENT: u64 = 0;
/// The way to a light that is infinitely far away.
const BESIDE: u64 = u64::MAX;
/// From this depth on lights are halved by number, so that 2^32 of them need at most 62 levels.
const HALVING_DEPTH: u32 = 30;
const BUCKETS: usize = 12;
/// Of two children that matter neither is less likely than this: importance is an estimate, and 1 - share must not round to 0.
const LEAST_SHARE: f32 = 1.0 / 65536.0;

type BoundedLight = (LightId, LightBounds);

impl LightBvh {
    /// Over all `lights` that shine on given points; `scene_bounds` say how much of an infinite light arrives.
    pub fn new(lights: &[Light], scene_bounds: &Bounds3) -> Self {
        let mut tree = Self {
            ways: vec![ABSENT; lights.len()],
            ..Self::default()
        };
        let mut bounded = Vec::new();
        for (i, light) in lights.iter().enumerate() {
            if light.power(scene_bounds) <= 0.0 || light.is_along_normals() {
                continue;
            }
            match light.bounds() {
                Some(bounds) => bounded.push((LightId(i as u32), bounds)),
                None => {
                    tree.infinite.push(LightId(i as u32));
                    tree.ways[i] = BESIDE;
                }
            }
        }
        if let Some(all) = union_of(&bounded) {
            tree.nodes.reserve(2 * bounded.len());
            tree.nodes.push(Node::leaf(bounded[0].0, &all));
            tree.fill(0, &mut bounded, &all, 0, 0);
        }
        tree
    }

    /// Makes node `index`, at `depth` on the way `way`, the root of a tree over `lights`, which are not none.
    fn fill(&mut self, index: usize, lights: &mut [BoundedLight], all: &LightBounds, way: u64, depth: u32) {
        if let [(light, bounds)] = lights {
            self.nodes[index] = Node::leaf(*light, bounds);
            self.ways[light.index()] = way | 1 << depth;
            return;
        }
        let middle = split(lights, all, depth);
        let first = self.nodes.len();
        self.nodes[index] = Node {
            cluster: Cluster::new(all),
            next: Next::Children(first as u32),
        };
        let (left, right) = lights.split_at_mut(middle);
        let children = [left, right].map(|lights| (union_of(lights), lights));
        for (bounds, lights) in &children {
            self.nodes.extend(bounds.map(|bounds| Node::leaf(lights[0].0, &bounds)));
        }
        for (i, (bounds, lights)) in children.into_iter().enumerate() {
            if let Some(bounds) = bounds {
                self.fill(first + i, lights, &bounds, way | (i as u64) << depth, depth + 1);
            }
        }
    }

    /// The probability of each infinite light.
    #[inline]
    fn pmf_beside(&self) -> f32 {
        1.0 / (self.infinite.len() + usize::from(!self.nodes.is_empty())) as f32
    }

    /// See [`super::LightSampler::sample`].
    #[inline]
    pub fn sample(&self, p: Vec3, n: Vec3, u: f32) -> Option<SampledLight> {
        let mut pmf = 1.0;
        let mut u = u;
        if !self.infinite.is_empty() {
            let each = self.pmf_beside();
            let beside = self.infinite.len() as f32 * each;
            if u < beside || self.nodes.is_empty() {
                let index = ((u / each) as usize).min(self.infinite.len() - 1);
                let light = self.infinite[index];
                return Some(SampledLight { light, pmf: each });
            }
            pmf = 1.0 - beside;
            u = ((u - beside) / pmf).min(BELOW_ONE);
        }
        let mut node = self.nodes.first()?;
        loop {
            match node.next {
                Next::Leaf(light) => return Some(SampledLight { light, pmf }),
                Next::Children(first) => {
                    let share = self.share_of_first(first, p, n)?;
                    let second = u >= share;
                    let taken = if second { 1.0 - share } else { share };
                    u = ((if second { u - share } else { u }) / taken).min(BELOW_ONE);
                    pmf *= taken;
                    node = &self.nodes[first as usize + usize::from(second)];
                }
            }
        }
    }

    /// See [`super::LightSampler::pmf`].
    #[inline]
    pub fn pmf(&self, p: Vec3, n: Vec3, light: LightId) -> f32 {
        let mut way = self.ways[light.index()];
        match way {
            ABSENT => return 0.0,
            BESIDE => return self.pmf_beside(),
            _ => {}
        }
        let mut pmf = if self.infinite.is_empty() {
            1.0
        } else {
            1.0 - self.infinite.len() as f32 * self.pmf_beside()
        };
        let mut node = &self.nodes[0];
        while let Next::Children(first) = node.next {
            let Some(share) = self.share_of_first(first, p, n) else {
                return 0.0;
            };
            pmf *= if way & 1 == 1 { 1.0 - share } else { share };
            node = &self.nodes[first as usize + (way & 1) as usize];
            way >>= 1;
        }
        pmf
    }

    /// The probability with which the way goes on to the node `first`, not to its neighbour; `None` if neither matters.
    #[inline]
    fn share_of_first(&self, first: u32, p: Vec3, n: Vec3) -> Option<f32> {
        let importance = |i: usize| self.nodes[first as usize + i].cluster.importance(p, n);
        let (a, b) = (importance(0), importance(1));
        let share = a / (a + b);
        if a > 0.0 && b > 0.0 {
            Some(share.clamp(LEAST_SHARE, 1.0 - LEAST_SHARE))
        } else {
            (a + b > 0.0).then_some(share)
        }
    }
}

impl Node {
    fn leaf(light: LightId, bounds: &LightBounds) -> Self {
        Self {
            cluster: Cluster::new(bounds),
            next: Next::Leaf(light),
        }
    }
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
