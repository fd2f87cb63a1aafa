//! From a binary tree to one of eight children a node.

use super::build::{Binary, Leaf};
use super::node::{Child, ChildRef, Node, WIDTH};

/// Makes the nodes of `tree`, the root first. `leaf` makes a leaf of items and returns it with its box.
pub fn collapse<N: Node>(tree: &Binary, leaf: &mut impl FnMut(Leaf) -> (ChildRef, N::Bounds)) -> Vec<N> {
    let mut nodes = Vec::new();
    if let Binary::Leaf(_) = tree {
        let child = emit(tree, &mut nodes, leaf);
        nodes.push(N::new(&[child]));
    } else {
        emit(tree, &mut nodes, leaf);
    }
    nodes
}

fn emit<N: Node>(
    tree: &Binary,
    nodes: &mut Vec<N>,
    leaf: &mut impl FnMut(Leaf) -> (ChildRef, N::Bounds),
) -> (ChildRef, N::Bounds) {
    let pair = match tree {
        Binary::Leaf(items) => return leaf(*items),
        Binary::Inner { children, .. } => children,
    };
    let (members, count) = open(pair);
    let index = nodes.len();
    // The place of this node, so that parents precede children in memory.
    nodes.push(N::new(&[]));
    let mut children = Vec::with_capacity(WIDTH);
    for member in &members[..count] {
        children.push(emit(member, nodes, leaf));
    }
    let bounds = children[1..].iter().fold(children[0].1, |a, b| N::union(a, b.1));
    nodes[index] = N::new(&children);
    (ChildRef::new(Child::Node(index)), bounds)
}

/// Opens the largest of the trees below a node again and again, until there are eight or only leaves.
fn open(pair: &[Binary; 2]) -> ([&Binary; WIDTH], usize) {
    let mut members = [&pair[0]; WIDTH];
    members[1] = &pair[1];
    let mut count = 2;
    while count < WIDTH {
        let mut largest = None;
        let mut most = f64::NEG_INFINITY;
        for (i, member) in members[..count].iter().enumerate() {
            if let Binary::Inner { half_area, children } = member
                && (largest.is_none() || *half_area > most)
            {
                most = *half_area;
                largest = Some((i, children));
            }
        }
        let Some((slot, inner)) = largest else { break };
        members[slot] = &inner[0];
        members[count] = &inner[1];
        count += 1;
    }
    (members, count)
}
