//! The order in which the rays of a call go together: by the signs of their directions, the axis of the greatest component, and the cell of
//! the tree's box that they start in.

use std::cell::Cell;

use super::interleave;
use super::lanes::Lanes;
use super::packet::SeenRoom;
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

/// Packets of which the rays are sorted by comparison: to count how many each class has would take longer.
const FEW_PACKETS: usize = 8;

/// Memory of a thread that is kept from call to call, as to clear it takes longer than to trace few rays.
pub struct Room {
    /// For one ray, or a packet.
    pub stack: [u64; STACK],
    /// For packets and few primitives.
    pub seen: SeenRoom,
    /// For several rays on their way.
    pub interleave: interleave::Room,
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
                seen: SeenRoom::default(),
                interleave: interleave::Room::new(),
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

/// What the cells of a box are told apart by.
struct Cells {
    low: [f32; 3],
    scale: [f32; 3],
}

impl Cells {
    #[inline(always)]
    fn new(bounds: &Bounds3) -> Self {
        Self {
            low: bounds.min.to_array(),
            scale: ((1 << CELL_BITS) as f32 / bounds.extent()).to_array(),
        }
    }
}

/// What is added to a small whole number to have it in the last bits.
const WHOLE: f32 = (1 << 23) as f32;

/// The class of each ray of a packet, in the last bits.
#[inline(always)]
fn packet_classes<S: Lanes<LANES>>(s: S, packet: &RayPacket, cells: &Cells) -> [f32; LANES] {
    let (direction, origin) = (
        [&packet.dir_x, &packet.dir_y, &packet.dir_z],
        [&packet.org_x, &packet.org_y, &packet.org_z],
    );
    let zero = s.splat(0.0);
    let mut sum = s.splat(WHOLE);
    for axis in 0..3 {
        let negative = s.lt(s.load(direction[axis]), zero);
        sum = s.add(sum, s.blend(negative, zero, s.splat((CELLS << axis) as f32)));
        let from_low = s.sub(s.load(origin[axis]), s.splat(cells.low[axis]));
        let cell = s.mul(from_low, s.splat(cells.scale[axis]));
        // The bits of the cells' numbers along the axes in turn.
        let [first, second] = [1 << axis, 8 << axis];
        for (from, more) in [(1.0, first), (2.0, second - first), (3.0, first)] {
            let beyond = s.le(s.splat(from), cell);
            sum = s.add(sum, s.blend(beyond, zero, s.splat(more as f32)));
        }
    }
    let [x, y, z] = [
        s.abs(s.load(direction[0])),
        s.abs(s.load(direction[1])),
        s.abs(s.load(direction[2])),
    ];
    let is_x = s.and(s.lt(y, x), s.lt(z, x));
    let (y_class, z_class) = (s.splat((8 * CELLS) as f32), s.splat((16 * CELLS) as f32));
    let greatest = s.blend(is_x, s.blend(s.le(y, z), y_class, z_class), zero);
    let active = s.le(s.load(&packet.tnear), s.load(&packet.tfar));
    let none = s.splat(WHOLE + (CLASSES * CELLS) as f32);
    let mut classes = [0.0; LANES];
    s.store(s.blend(active, none, s.add(sum, greatest)), &mut classes);
    classes
}

/// Puts rays in the order of their classes, and within a class of the cells that they start in; those that take no part are left out.
/// Returns how many there are.
#[inline(always)]
pub fn sort<S: Lanes<LANES>>(
    s: S,
    packets: &[RayPacket],
    bounds: &Bounds3,
    classes: &mut [u16; BATCH],
    places: &mut [Place; BATCH],
) -> usize {
    let cells = Cells::new(bounds);
    for (packet, classes) in packets.iter().zip(classes.chunks_exact_mut(LANES)) {
        let found = packet_classes(s, packet, &cells);
        for (to, class) in classes.iter_mut().zip(found) {
            *to = class.to_bits() as u16;
        }
    }
    place(&classes[..packets.len() * LANES], places)
}

/// Packets of a call that are looked at to tell whether its rays are alike.
const LOOKS: usize = 8;

/// How many rays there are of a class, on average, by some of the packets: many of those that mirrors send on, or of a tile to a small
/// light.
#[inline(always)]
pub fn rays_of_class<S: Lanes<LANES>>(s: S, packets: &[RayPacket], bounds: &Bounds3) -> usize {
    let cells = Cells::new(bounds);
    let mut met = [0u64; (CLASSES * CELLS).div_ceil(64) + 1];
    let mut rays = 0;
    for packet in packets.iter().step_by(packets.len().div_ceil(LOOKS).max(1)) {
        for class in packet_classes(s, packet, &cells) {
            let class = usize::from(class.to_bits() as u16);
            rays += usize::from(class < CLASSES * CELLS);
            if let Some(word) = met.get_mut(class / 64) {
                *word |= 1 << (class % 64);
            }
        }
    }
    let classes: u32 = met[..CLASSES * CELLS / 64].iter().map(|word| word.count_ones()).sum();
    rays / classes.max(1) as usize
}

/// Where rays of these classes go.
fn place(classes: &[u16], places: &mut [Place; BATCH]) -> usize {
    if classes.len() <= FEW_PACKETS * LANES {
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
