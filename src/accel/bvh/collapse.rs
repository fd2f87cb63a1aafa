//! From a binary tree to one of eight children a node, the one of least cost that has the same leaves (Ylitie, Karras, Laine 2017, "Efficient
//! Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", section 3.1).
//!
//! A subtree can be below a wide node as one child, or its parts can be as several. What the least cost of i children is follows from what
//! those of its two halves are, so that one pass from the leaves up finds them all. The cost of a leaf is the same in all trees; that of a
//! node is its area.

use super::build::{BinaryNode, Leaf};
use super::node::{Child, ChildRef, Node, WIDTH};

/// Nodes of binary trees of which the order of children is left as it is.
const FEW: usize = 1000;

/// Makes the nodes of `tree`, the root first. `leaf` makes a leaf of items and returns it with its box.
pub fn collapse<N: Node>(tree: &[BinaryNode], leaf: &mut impl FnMut(Leaf) -> (ChildRef, N::Bounds)) -> Vec<N> {
    let mut nodes = Vec::new();
    let Some((root, _)) = tree.split_last() else {
        return nodes;
    };
    let shares = best_shares(tree);
    let child = emit(tree, &shares, tree.len() - 1, &mut nodes, leaf);
    if let BinaryNode::Leaf(_) = root {
        nodes.push(N::new(&[child]));
    }
    nodes
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

/// The best shares of each node of a binary tree; of leaves none.
fn best_shares(tree: &[BinaryNode]) -> Vec<Shares> {
    // Of the subtrees whose parents are still to come.
    let mut open: Vec<Costs> = Vec::new();
    let shares = tree.iter().map(|node| match *node {
        BinaryNode::Leaf(_) => {
            open.push([0.0; WIDTH]);
            Shares(0)
        }
        BinaryNode::Inner { half_area, .. } => {
            let (second, first) = (open.pop().unwrap_or_default(), open.pop().unwrap_or_default());
            let (costs, shares) = join(half_area, &first, &second);
            open.push(costs);
            shares
        }
    });
    shares.collect()
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

fn emit<N: Node>(
    tree: &[BinaryNode],
    shares: &[Shares],
    root: usize,
    nodes: &mut Vec<N>,
    leaf: &mut impl FnMut(Leaf) -> (ChildRef, N::Bounds),
) -> (ChildRef, N::Bounds) {
    let back = match tree[root] {
        BinaryNode::Leaf(items) => return leaf(items),
        BinaryNode::Inner { back, .. } => back as usize,
    };
    let mut members = Members::default();
    let share = shares[root].first(WIDTH);
    members.add(tree, shares, root - back, share);
    members.add(tree, shares, root - 1, WIDTH - share);
    let index = nodes.len();
    // The place of this node, so that parents precede children in memory.
    nodes.push(N::new(&[]));
    let mut children = Vec::with_capacity(WIDTH);
    for &member in &members.trees[..members.count] {
        children.push(emit(tree, shares, member, nodes, leaf));
    }
    // Nodes last: where any hit will do, the last are visited first, and in large trees that is faster.
    if tree.len() > FEW {
        children.sort_by_key(|(child, _)| matches!(child.get(), Child::Node(_)));
    }
    let bounds = children[1..].iter().fold(children[0].1, |a, b| N::union(a, b.1));
    nodes[index] = N::new(&children);
    (ChildRef::new(Child::Node(index)), bounds)
}

/// The roots of the trees below a node.
#[derive(Default)]
struct Members {
    trees: [usize; WIDTH],
    count: usize,
}

impl Members {
    /// Adds a subtree as at most `most` children.
    fn add(&mut self, tree: &[BinaryNode], shares: &[Shares], root: usize, most: usize) {
        if let BinaryNode::Inner { back, .. } = tree[root] {
            let count = (2..=most).rev().find(|&count| shares[root].first(count) != 0);
            if let Some(count) = count {
                let share = shares[root].first(count);
                self.add(tree, shares, root - back as usize, share);
                self.add(tree, shares, root - 1, count - share);
                return;
            }
        }
        self.trees[self.count] = root;
        self.count += 1;
    }
}
