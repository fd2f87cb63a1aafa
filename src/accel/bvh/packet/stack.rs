//! What a packet has still to visit.

// What is on the stack below its top was written.
#![allow(unsafe_code)]

use std::mem::MaybeUninit;

use crate::accel::bvh::node::ChildRef;
use crate::accel::bvh::prepare::Row;
use crate::accel::bvh::traverse::TREE_STACK;

/// Something still to be visited.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
struct Entry<const N: usize> {
    /// Where each ray enters its box; without meaning for occlusion, which does not ask.
    distance: Row<N>,
    child: ChildRef,
    /// Which rays.
    lanes: u32,
}

/// What is still to be visited, the nearest on top.
pub struct Stack<const N: usize> {
    entries: [MaybeUninit<Entry<N>>; TREE_STACK],
    depth: usize,
}

impl<const N: usize> Stack<N> {
    /// Nothing.
    #[inline(always)]
    pub fn new() -> Self {
        Self {
            entries: [const { MaybeUninit::uninit() }; TREE_STACK],
            depth: 0,
        }
    }

    /// Puts something on top; without `distance`, its distances are not written.
    #[inline(always)]
    pub fn push(&mut self, child: ChildRef, lanes: u32, distance: Option<&Row<N>>) {
        let entry = self.entries[self.depth].as_mut_ptr();
        // SAFETY: it points to an entry of the stack, of which only fields are written.
        unsafe {
            (*entry).child = child;
            (*entry).lanes = lanes;
            if let Some(distance) = distance {
                (*entry).distance = *distance;
            }
        }
        self.depth += 1;
    }

    /// Takes the top off: the child, its rays, and, if that is why it was written, the distances.
    #[inline(always)]
    pub fn pop<const ANY: bool>(&mut self) -> Option<(ChildRef, u32, Option<&Row<N>>)> {
        self.depth = self.depth.checked_sub(1)?;
        let entry = self.entries[self.depth].as_ptr();
        // SAFETY: entries below the top were written, with distances unless `ANY`.
        unsafe {
            let distance = if ANY { None } else { Some(&(*entry).distance) };
            Some(((*entry).child, (*entry).lanes, distance))
        }
    }
}
