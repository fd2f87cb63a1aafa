//! A bounding volume hierarchy over lights: which light a point samples is decided on the way from the root to a leaf, at each
//! node in proportion to the importance of its children for that point (Conty Estevez and Kulla 2018; pbrt-v4, section 12.6.3). Nodes
//! have up to eight children, whose importances are computed at once. Lights that are infinitely far away stand beside the tree: each
//! is as likely as all of it.

mod build;
mod clusters;

use super::bounds::LightBounds;
use super::sampler::SampledLight;
use super::{Light, LightId};
use crate::math::{Bounds3, Kernel, LANES, Lanes, Vec3, Vectorizer};
use crate::sampling::BELOW_ONE;
use build::{Binary, MAX_DEPTH};
use clusters::Clusters;

/// The tree, and what stands beside it.
#[derive(Clone, Debug, Default)]
pub(super) struct LightBvh {
    vectorizer: Vectorizer,
    /// Where ways begin.
    root: Next,
    nodes: Vec<Node>,
    /// By node: what leads there; `None` for the root.
    above: Vec<Option<Child>>,
    infinite: Vec<LightId>,
    /// By light.
    standings: Vec<Standing>,
}

#[derive(Clone, Debug, Default)]
#[repr(align(64))]
struct Node {
    clusters: Clusters,
    next: [Next; LANES],
}

/// What a child of a node is.
#[derive(Clone, Copy, Debug, Default)]
enum Next {
    #[default]
    Nothing,
    Node(u32),
    Light(LightId),
}

/// A child of a node.
#[derive(Clone, Copy, Debug, Default)]
struct Child {
    node: u32,
    lane: u32,
}

/// Where a light is.
#[derive(Clone, Copy, Debug)]
enum Standing {
    /// Nowhere, as it emits nothing.
    Absent,
    /// Infinitely far away.
    Beside,
    /// In the tree, as this child; the only light of it is none.
    Within(Option<Child>),
}

/// Of the children that matter none has less than this of the share of the greatest: importance is an estimate.
const LEAST_SHARE: f32 = 1.0 / 65536.0;

impl LightBvh {
    /// Over all `lights` that shine on given points; `scene_bounds` say how much of an infinite light arrives.
    pub fn new(lights: &[Light], scene_bounds: &Bounds3) -> Self {
        let mut tree = Self {
            standings: vec![Standing::Absent; lights.len()],
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
                    tree.standings[i] = Standing::Beside;
                }
            }
        }
        if let Some(binary) = Binary::over(&mut bounded) {
            tree.root = tree.add(binary, None);
        }
        tree
    }

    /// Adds what is below `above`.
    fn add(&mut self, binary: Binary, above: Option<Child>) -> Next {
        let children = match binary {
            Binary::Light(light, _) => {
                self.standings[light.index()] = Standing::Within(above);
                return Next::Light(light);
            }
            Binary::Pair(_, children) => build::widen(*children),
        };
        let node = self.nodes.len();
        self.nodes.push(Node::default());
        self.above.push(above);
        for (lane, child) in children.into_iter().enumerate() {
            self.nodes[node].clusters.set(lane, child.bounds());
            let place = Child {
                node: node as u32,
                lane: lane as u32,
            };
            self.nodes[node].next[lane] = self.add(child, Some(place));
        }
        Next::Node(node as u32)
    }

    /// The probability of each infinite light.
    #[inline]
    fn pmf_beside(&self) -> f32 {
        let has_tree = !matches!(self.root, Next::Nothing);
        1.0 / (self.infinite.len() + usize::from(has_tree)) as f32
    }

    /// The probability of the tree.
    #[inline]
    fn pmf_within(&self) -> f32 {
        if self.infinite.is_empty() {
            1.0
        } else {
            1.0 - self.infinite.len() as f32 * self.pmf_beside()
        }
    }

    /// See [`super::LightSampler::sample`].
    #[inline]
    pub fn sample(&self, p: Vec3, n: Vec3, u: f32) -> Option<SampledLight> {
        let mut u = u;
        if !self.infinite.is_empty() {
            let each = self.pmf_beside();
            let beside = self.infinite.len() as f32 * each;
            if u < beside || matches!(self.root, Next::Nothing) {
                let index = ((u / each) as usize).min(self.infinite.len() - 1);
                let light = self.infinite[index];
                return Some(SampledLight { light, pmf: each });
            }
            u = ((u - beside) / (1.0 - beside)).min(BELOW_ONE);
        }
        let pmf = self.pmf_within();
        match self.root {
            Next::Nothing => None,
            Next::Light(light) => Some(SampledLight { light, pmf }),
            Next::Node(_) => self.vectorizer.run(Descend { tree: self, p, n, u }),
        }
    }

    /// See [`super::LightSampler::only`].
    #[inline]
    pub fn only(&self) -> Option<SampledLight> {
        match self.root {
            Next::Light(light) if self.infinite.is_empty() => Some(SampledLight { light, pmf: 1.0 }),
            _ => None,
        }
    }

    /// See [`super::LightSampler::pmf`].
    #[inline]
    pub fn pmf(&self, p: Vec3, n: Vec3, light: LightId) -> f32 {
        match self.standings[light.index()] {
            Standing::Absent => 0.0,
            Standing::Beside => self.pmf_beside(),
            Standing::Within(None) => self.pmf_within(),
            Standing::Within(Some(child)) => self.vectorizer.run(Follow {
                tree: self,
                p,
                n,
                child,
            }),
        }
    }
}

/// The way to a light that `u` chooses.
struct Descend<'a> {
    tree: &'a LightBvh,
    p: Vec3,
    n: Vec3,
    u: f32,
}

impl Kernel for Descend<'_> {
    type Output = Option<SampledLight>;

    #[inline(always)]
    fn call(self) -> Option<SampledLight> {
        let Self { tree, p, n, mut u } = self;
        let (mut next, mut pmf) = (tree.root, tree.pmf_within());
        loop {
            match next {
                Next::Nothing => return None,
                Next::Light(light) => return Some(SampledLight { light, pmf }),
                Next::Node(node) => {
                    let node = &tree.nodes[node as usize];
                    let shares = Shares::of(&node.clusters.importance(p, n))?;
                    let lane = shares.choose(&mut u);
                    pmf *= shares.get(lane);
                    next = node.next[lane];
                }
            }
        }
    }
}

/// The probability of the way to a child.
struct Follow<'a> {
    tree: &'a LightBvh,
    p: Vec3,
    n: Vec3,
    child: Child,
}

impl Kernel for Follow<'_> {
    type Output = f32;

    #[inline(always)]
    fn call(self) -> f32 {
        let Self { tree, p, n, child } = self;
        let mut way = [child; MAX_DEPTH];
        let mut steps = 1;
        while let Some(above) = tree.above[way[steps - 1].node as usize] {
            way[steps] = above;
            steps += 1;
        }
        let mut pmf = tree.pmf_within();
        // From the root on, as the product is rounded where a light is sampled.
        for child in way[..steps].iter().rev() {
            let importance = tree.nodes[child.node as usize].clusters.importance(p, n);
            let Some(shares) = Shares::of(&importance) else {
                return 0.0;
            };
            pmf *= shares.get(child.lane as usize);
        }
        pmf
    }
}

/// How a node's children share what is below it.
struct Shares {
    weights: Lanes,
    /// Of the weights before each child, and of all.
    sums: [f32; LANES + 1],
}

impl Shares {
    /// In proportion to importance; `None` if no child matters.
    #[inline(always)]
    fn of(importance: &Lanes) -> Option<Self> {
        let least = LEAST_SHARE * greatest(importance);
        let weights = importance.map(
            #[inline(always)]
            |importance| if importance > 0.0 { importance.max(least) } else { 0.0 },
        );
        let sums = sums(&weights);
        (sums[LANES] > 0.0).then_some(Self { weights, sums })
    }

    /// The child that `u` chooses, a uniform number in [0, 1) that is then one again.
    #[inline(always)]
    fn choose(&self, u: &mut f32) -> usize {
        let total = self.sums[LANES];
        // Below the total even after rounding: a child that does not matter is never chosen.
        let target = (*u * total).min(total.next_down());
        let mut lane = 0;
        for i in 1..LANES {
            lane += usize::from(self.sums[i] <= target);
        }
        *u = ((target - self.sums[lane]) / self.weights[lane]).min(BELOW_ONE);
        lane
    }

    /// The probability of a child.
    #[inline(always)]
    fn get(&self, lane: usize) -> f32 {
        self.weights[lane] / self.sums[LANES]
    }
}

/// Sums of the numbers before each, and of all. In few steps that wait for one another; a 0 leaves the sum before it as it is.
#[inline(always)]
fn sums(lanes: &Lanes) -> [f32; LANES + 1] {
    let [a, b, c, d, e, f, g, h] = *lanes;
    let two = a + b;
    let four = two + (c + d);
    let six = four + (e + f);
    [0.0, a, two, two + c, four, four + e, six, six + g, six + (g + h)]
}

/// The greatest of eight numbers.
#[inline(always)]
fn greatest(lanes: &Lanes) -> f32 {
    let [a, b, c, d, e, f, g, h] = *lanes;
    (a.max(b)).max(c.max(d)).max((e.max(f)).max(g.max(h)))
}
