//! The order in which the rays of a call go together: by the signs of their directions, the axis of the greatest component, and the cell of
//! the tree's box that they start in.

use std::cell::Cell;

use super::interleave;
use super::traverse::STACK;
use crate::geometry::{LANES, RayPacket};
use crate::math::Bounds3;

/// Classes of rays, by the signs of the direction and the axis of its greatest component.
const CLASSES: usize = 24;

/// Cells of the box of the tree along each axis, in bits.
const CELL_BITS: u32 = 2;

/// Cells in all.
const CELLS: usize = 1 << (3 * CELL_BITS);

/// Rays that are sorted at a time.
pub const BATCH: usize = 4096;

/// Where a ray of a call is: packet * LANES + lane.
pub type Place = u16;

/// The class of a direction.
#[inline(always)]
fn class([x, y, z]: [f32; 3]) -> usize {
    let sign = |x: f32| x.to_bits() >> 31;
    let size = [x.abs(), y.abs(), z.abs()];
    let is_x = (size[0] > size[1]) & (size[0] > size[2]);
    let axis = if is_x { 0 } else { 1 + u32::from(size[2] >= size[1]) };
    (axis << 3 | sign(z) << 2 | sign(y) << 1 | sign(x)) as usize
}

/// Packets of which the rays are sorted by comparison: to count how many each class has would take longer.
const FEW_PACKETS: usize = 8;

/// Memory of a thread that is kept from call to call, as to clear it takes longer than to trace few rays.
pub struct Room {
    /// For one ray, or a packet.
    pub stack: [u64; STACK],
    /// For several rays on their way.
    pub stacks: Vec<interleave::Stack>,
    /// Of each ray of a batch, its class.
    pub classes: [u16; BATCH],
    /// The rays of a batch in order.
    pub places: [Place; BATCH],
}

thread_local! {
    static ROOM: Cell<Option<Box<Room>>> = const { Cell::new(None) };
}

impl Room {
    /// That of this thread, which has none until [`Room::put`].
    pub fn take() -> Box<Self> {
        ROOM.take().unwrap_or_else(|| {
            Box::new(Self {
                stack: [0; STACK],
                stacks: Vec::new(),
                classes: [0; BATCH],
                places: [0; BATCH],
            })
        })
    }

    /// Keeps it for the next call.
    pub fn put(self: Box<Self>) {
        ROOM.set(Some(self));
    }
}

/// Puts rays in the order of their classes, and within a class of the cells that they start in; those that take no part are left out.
/// Returns how many there are.
pub fn sort(packets: &[RayPacket], bounds: &Bounds3, classes: &mut [u16; BATCH], places: &mut [Place; BATCH]) -> usize {
    let low = bounds.min;
    let scale = ((1 << CELL_BITS) as f32 / bounds.extent()).to_array();
    let cell = |x: f32, axis: usize| ((x - low[axis]) * scale[axis]).clamp(0.0, ((1 << CELL_BITS) - 1) as f32) as u32;
    // Spreads the bits of a cell number two apart.
    let spread = |x: u32| (x & 1) | (x & 2) << 2;
    for (packet, classes) in packets.iter().zip(classes.chunks_exact_mut(LANES)) {
        for (lane, to) in classes.iter_mut().enumerate() {
            let class = class([packet.dir_x[lane], packet.dir_y[lane], packet.dir_z[lane]]);
            let at = [packet.org_x[lane], packet.org_y[lane], packet.org_z[lane]];
            let at = [0, 1, 2].map(|axis| spread(cell(at[axis], axis)) << axis);
            let class = class * CELLS + (at[0] | at[1] | at[2]) as usize;
            *to = if packet.is_active(lane) { class } else { CLASSES * CELLS } as u16;
        }
    }
    let classes = &classes[..packets.len() * LANES];
    if packets.len() <= FEW_PACKETS {
        return sort_few(classes, places);
    }
    let mut counts = [0u16; CLASSES * CELLS + 1];
    for &class in classes {
        counts[class as usize] += 1;
    }
    let mut first = 0;
    for count in &mut counts {
        first += std::mem::replace(count, first);
    }
    for (place, &class) in classes.iter().enumerate() {
        let next = &mut counts[class as usize];
        places[*next as usize] = place as Place;
        *next += 1;
    }
    counts[CLASSES * CELLS - 1] as usize
}

/// The same of few.
fn sort_few(classes: &[u16], places: &mut [Place; BATCH]) -> usize {
    let mut keys = [0u32; FEW_PACKETS * LANES];
    let mut count = 0;
    for (place, &class) in classes.iter().enumerate() {
        keys[count] = u32::from(class) << 16 | place as u32;
        count += usize::from(usize::from(class) < CLASSES * CELLS);
    }
    let keys = &mut keys[..count];
    keys.sort_unstable();
    for (to, key) in places.iter_mut().zip(&*keys) {
        *to = *key as Place;
    }
    count
}
