//! From a binary tree to one of eight children a node.

use super::build::{BinaryNode, Leaf};
use super::node::{Child, ChildRef, Node, WIDTH};

/// Makes the nodes of `tree`, the root first. `leaf` makes a leaf of items and returns it with its box.
pub fn collapse<N: Node>(tree: &[BinaryNode], leaf: &mut impl FnMut(Leaf) -> (ChildRef, N::Bounds)) -> Vec<N> {
    let mut nodes = Vec::new();
    let Some((root, _)) = tree.split_last() else {
        return nodes;
    };
    let child = emit(tree, tree.len() - 1, &mut nodes, leaf);
    if let BinaryNode::Leaf(_) = root {
        nodes.push(N::new(&[child]));
    }
    nodes
}

fn emit<N: Node>(
    tree: &[BinaryNode],
    root: usize,
    nodes: &mut Vec<N>,
    leaf: &mut impl FnMut(Leaf) -> (ChildRef, N::Bounds),
) -> (ChildRef, N::Bounds) {
    let back = match tree[root] {
        BinaryNode::Leaf(items) => return leaf(items),
        BinaryNode::Inner { back, .. } => back as usize,
    };
    let (members, count) = open(tree, [root - back, root - 1]);
    let index = nodes.len();
    // The place of this node, so that parents precede children in memory.
    nodes.push(N::new(&[]));
    let mut children = Vec::with_capacity(WIDTH);
    for &member in &members[..count] {
        children.push(emit(tree, member, nodes, leaf));
    }
    let bounds = children[1..].iter().fold(children[0].1, |a, b| N::union(a, b.1));
    nodes[index] = N::new(&children);
    (ChildRef::new(Child::Node(index)), bounds)
}

/// Opens the largest of the trees below a node again and again, until there are eight or only leaves.
fn open(tree: &[BinaryNode], pair: [usize; 2]) -> ([usize; WIDTH], usize) {
    let mut members = [pair[0]; WIDTH];
    members[1] = pair[1];
    let mut count = 2;
    while count < WIDTH {
        let mut largest = None;
        let mut most = f64::NEG_INFINITY;
        for (slot, &member) in members[..count].iter().enumerate() {
            if let BinaryNode::Inner { half_area, back } = tree[member]
                && (largest.is_none() || half_area > most)
            {
                most = half_area;
                largest = Some((slot, member - back as usize, member - 1));
            }
        }
        let Some((slot, first, second)) = largest else { break };
        members[slot] = first;
        members[count] = second;
        count += 1;
    }
    (members, count)
}
