//! From a binary tree to one of eight children a node, the one of least cost that has the same leaves (Ylitie, Karras, Laine 2017, "Efficient
//! Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", section 3.1).
//!
//! A subtree can be below a wide node as one child, or its parts can be as several. What the least cost of i children is follows from what
//! those of its two halves are, so that one pass from the leaves up finds them all. The cost of a leaf is the same in all trees; that of a
//! node is its area.

use std::ops::Range;

use arrayvec::ArrayVec;

use super::build::{BinaryNode, LEAST_PARALLEL, Leaf};
use super::node::{Child, ChildRef, WIDTH};
use super::topology::Topology;

/// The wide tree of a binary one, which is not empty. `leaf` says what a leaf is, if it holds no triangles.
pub fn collapse(tree: &[BinaryNode], leaf: &(impl Fn(Leaf) -> Option<ChildRef> + Sync)) -> Topology {
    let mut shares = vec![Shares(0); tree.len()];
    best_shares(tree, &mut shares);
    let mut topology = Topology::default();
    let collapser = Collapser { leaf };
    let tree = Subtree {
        nodes: tree,
        shares: &shares,
    };
    if let Some(&BinaryNode::Leaf(items)) = tree.nodes.last() {
        let root = topology.add_node();
        topology.nodes[root][0] = collapser.leaf(items, &mut topology);
    } else {
        collapser.node(tree, &mut topology);
    }
    topology
}

/// For each number of children that a subtree may become, how many of them its first half becomes; 0 where fewer children, or one, do.
#[derive(Clone, Copy)]
struct Shares(u32);

impl Shares {
    const BITS: usize = 3;

    fn with(self, children: usize, first: usize) -> Self {
        Self(self.0 | (first as u32) << (Self::BITS * (children - 2)))
    }

    fn first(self, children: usize) -> usize {
        (self.0 >> (Self::BITS * (children - 2)) & 7) as usize
    }
}

/// Least costs of a subtree as at most 1, 2, ... children of a node.
type Costs = [f64; WIDTH];

/// Finds the best shares of each node of a binary tree, of leaves none, and the costs of the root.
fn best_shares(tree: &[BinaryNode], shares: &mut [Shares]) -> Costs {
    let (root, below) = (tree.len() - 1, tree.len().saturating_sub(1));
    let (half_area, back) = match tree[root] {
        BinaryNode::Leaf(_) => return [0.0; WIDTH],
        BinaryNode::Inner { half_area, back } => (half_area, back as usize),
    };
    let (first, second) = tree[..below].split_at(tree.len() - back);
    let (shares, of_root) = shares.split_at_mut(below);
    let (first_shares, second_shares) = shares.split_at_mut(first.len());
    let mut of_first = || best_shares(first, first_shares);
    let mut of_second = || best_shares(second, second_shares);
    let (first, second) = if tree.len() > LEAST_PARALLEL {
        rayon::join(of_first, of_second)
    } else {
        (of_first(), of_second())
    };
    let (costs, best) = join(half_area, &first, &second);
    of_root[0] = best;
    costs
}

fn join(half_area: f64, first: &Costs, second: &Costs) -> (Costs, Shares) {
    let mut costs = [0.0; WIDTH];
    let mut shares = Shares(0);
    // As several children; the last entry is that of the children of a node.
    for count in 2..=WIDTH {
        let (mut least, mut best) = (f64::INFINITY, 1);
        for share in 1..count {
            let cost = first[share - 1] + second[count - share - 1];
            if cost < least {
                (least, best) = (cost, share);
            }
        }
        costs[count - 1] = least;
        shares = shares.with(count, best);
    }
    costs[0] = half_area + costs[WIDTH - 1];
    // Fewer may do: a wide node is cheaper than its parts if these need another node each.
    for count in 2..WIDTH {
        if costs[count - 2] <= costs[count - 1] {
            costs[count - 1] = costs[count - 2];
            shares = Shares(shares.0 & !(7 << (Shares::BITS * (count - 2))));
        }
    }
    (costs, shares)
}

/// A part of a binary tree: its root is the last node.
#[derive(Clone, Copy)]
struct Subtree<'a> {
    nodes: &'a [BinaryNode],
    shares: &'a [Shares],
}

impl<'a> Subtree<'a> {
    /// Both halves, and how many children each becomes if together they become at most `most`; `None` if they are to be one.
    fn halves(self, most: usize) -> Option<[(Self, usize); 2]> {
        let root = self.nodes.len() - 1;
        let BinaryNode::Inner { back, .. } = self.nodes[root] else {
            return None;
        };
        let count = (2..=most).rev().find(|&count| self.shares[root].first(count) != 0)?;
        let share = self.shares[root].first(count);
        let middle = self.nodes.len() - back as usize;
        let part = |range: Range<usize>| Self {
            nodes: &self.nodes[range.clone()],
            shares: &self.shares[range],
        };
        Some([(part(0..middle), share), (part(middle..root), count - share)])
    }

    /// Adds it to the children of a node, as at most `most` of them.
    fn add_to(self, children: &mut ArrayVec<Self, WIDTH>, most: usize) {
        match self.halves(most) {
            Some(halves) => halves.into_iter().for_each(|(half, most)| half.add_to(children, most)),
            None => children.push(self),
        }
    }
}

struct Collapser<'a, L> {
    leaf: &'a L,
}

impl<L: Fn(Leaf) -> Option<ChildRef> + Sync> Collapser<'_, L> {
    /// Adds a node for a tree of more than one leaf, and what is below it.
    fn node(&self, tree: Subtree<'_>, topology: &mut Topology) {
        let node = topology.add_node();
        let mut children = ArrayVec::new();
        tree.add_to(&mut children, WIDTH);
        let mut below = Vec::new();
        for (slot, child) in children.into_iter().enumerate() {
            if let Some(&BinaryNode::Leaf(leaf)) = child.nodes.last() {
                topology.nodes[node][slot] = self.leaf(leaf, topology);
            } else if tree.nodes.len() > LEAST_PARALLEL {
                below.push((slot, child));
            } else {
                topology.nodes[node][slot] = ChildRef::new(Child::Node(topology.nodes.len()));
                self.node(child, topology);
            }
        }
        topology.append_all(node, below, |child, part| self.node(child, part));
    }

    fn leaf(&self, leaf: Leaf, topology: &mut Topology) -> ChildRef {
        (self.leaf)(leaf).unwrap_or_else(|| topology.add_block(leaf))
    }
}
