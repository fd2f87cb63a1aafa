//! A tree of nodes with eight children, before the boxes of the nodes are known.

use rayon::prelude::*;

use super::build::Leaf;
use super::node::{Child, ChildRef, Node, WIDTH};
use super::pages::vec_in_large_pages;

/// Trees of fewer nodes keep the order of their children.
const FEW: usize = 128;

/// Which nodes and leaves are below which node.
#[derive(Debug, Default)]
pub struct Topology {
    /// The children of each node, the root's first; parents precede their children. Slots without a child are last, and hold
    /// [`ChildRef::ROOT`], which is nobody's child.
    pub nodes: Vec<[ChildRef; WIDTH]>,
    /// The leaves of triangles, by the number of their block.
    pub blocks: Vec<Leaf>,
}

/// The children in the slots of a node.
fn children(slots: &[ChildRef; WIDTH]) -> &[ChildRef] {
    let count = slots.iter().position(|&child| child == ChildRef::ROOT);
    &slots[..count.unwrap_or(WIDTH)]
}

impl Topology {
    /// Makes room for a tree over so many triangles as is usual.
    pub fn reserve(&mut self, triangles: usize) {
        self.nodes.reserve(triangles / 8);
        self.blocks.reserve(triangles / 2);
    }

    /// Adds a node without children and returns its number.
    pub fn add_node(&mut self) -> usize {
        self.nodes.push([ChildRef::ROOT; WIDTH]);
        self.nodes.len() - 1
    }

    /// Adds a leaf of triangles.
    pub fn add_block(&mut self, leaf: Leaf) -> ChildRef {
        self.blocks.push(leaf);
        ChildRef::new(Child::Block(self.blocks.len() - 1))
    }

    /// Adds trees below a node, each in a slot of it, that `build` makes in parallel.
    pub fn append_all<T: Send>(&mut self, node: usize, trees: Vec<(usize, T)>, build: impl Fn(T, &mut Self) + Sync) {
        let built = trees.into_par_iter().map(|(slot, tree)| {
            let mut part = Self::default();
            build(tree, &mut part);
            (slot, part)
        });
        for (slot, part) in built.collect::<Vec<_>>() {
            self.nodes[node][slot] = self.append(&part);
        }
    }

    /// Adds a tree and returns its root.
    fn append(&mut self, part: &Self) -> ChildRef {
        let (nodes, blocks) = (self.nodes.len(), self.blocks.len());
        let moved = |child: ChildRef| match child.get() {
            Child::Node(0) => ChildRef::ROOT,
            Child::Node(index) => ChildRef::new(Child::Node(index + nodes)),
            Child::Block(index) => ChildRef::new(Child::Block(index + blocks)),
            Child::Analytic(_) | Child::Instance(_) => child,
        };
        self.nodes.extend(part.nodes.iter().map(|slots| slots.map(moved)));
        self.blocks.extend_from_slice(&part.blocks);
        ChildRef::new(Child::Node(nodes))
    }

    /// The nodes, in the boxes that follow from those of the leaves, and a box around all.
    pub fn fit<N: Node>(&self, leaf: impl Fn(Child) -> N::Bounds + Sync) -> (Vec<N>, N::Bounds) {
        let mut bounds = vec![N::NOTHING; self.nodes.len()];
        for (index, slots) in self.nodes.iter().enumerate().rev() {
            let boxes = children(slots).iter().map(|child| match child.get() {
                Child::Node(index) => bounds[index],
                other => leaf(other),
            });
            bounds[index] = boxes.fold(N::NOTHING, N::union);
        }
        let is_large = self.nodes.len() > FEW;
        let node = |slots: &[ChildRef; WIDTH]| {
            let children = children(slots);
            let is_node = |child: &ChildRef| matches!(child.get(), Child::Node(_));
            // Nodes last: where any hit will do, the last are visited first, and in large trees that is faster.
            let leaves = if is_large {
                children.iter().filter(|child| !is_node(child)).count()
            } else {
                0
            };
            let mut next = [0, leaves];
            let mut filled = [(ChildRef::ROOT, N::NOTHING); WIDTH];
            for child in children {
                let bounds = match child.get() {
                    Child::Node(index) => bounds[index],
                    other => leaf(other),
                };
                let next = &mut next[usize::from(!is_large || is_node(child))];
                filled[*next] = (*child, bounds);
                *next += 1;
            }
            N::new(&filled[..children.len()])
        };
        let mut nodes = vec_in_large_pages(self.nodes.len());
        self.nodes
            .par_iter()
            .with_min_len(256)
            .map(node)
            .collect_into_vec(&mut nodes);
        (nodes, bounds[0])
    }
}
