//! Lanes of packets moved to the end of a queue of packets, so that no lane between is empty: a few instructions for eight lanes.
//!
//! A packet's columns, of eight numbers of 32 bits each, are permuted alike: chosen lanes come first, in their order, behind what the queue's
//! last packet holds already; those that do not fit there begin the next one.

use super::shuffle::{Column, Shuffle, ShuffleKernel};
use super::{LANES, LaneSet, Lanes, Vectorizer};

/// What eight lanes hold, a number of each in every column, to be put into packets `P`.
pub trait Columns<P = Self> {
    /// Writes the lanes of `self` to `last` behind what it holds, and to `next`, as `packing` says.
    fn pack<S: Shuffle>(&self, packing: &Packing<S>, last: &mut P, next: &mut P);
}

/// Where the lanes of a packet go.
#[derive(Clone, Copy, Debug)]
pub struct Packing<S> {
    shuffle: S,
    /// The lane that each lane of the queue's packets is taken from.
    from: Column,
    /// The queue's last packet.
    packet: usize,
    /// The mask of its lanes that the queue holds already.
    held: Column,
    /// The masks of its lanes, and of those of the next packet, that the queue holds then.
    full: [Column; 2],
    /// Lanes that are added.
    added: usize,
}

impl<S: Shuffle> Packing<S> {
    /// Of `chosen` lanes to a queue of `len` lanes.
    #[inline(always)]
    fn new(shuffle: S, chosen: LaneSet, len: usize) -> Self {
        let (held, added) = (len % LANES, chosen.len() as usize);
        let full = (held + added) % (2 * LANES);
        Self {
            shuffle,
            from: shuffle.widen(ORDERS[chosen.index()].rotate_left(8 * held as u32)),
            packet: len / LANES,
            held: FIRST_LANES[held],
            full: [FIRST_LANES[full.min(LANES)], FIRST_LANES[full.saturating_sub(LANES)]],
            added,
        }
    }

    /// Writes `lanes` to the end of a queue's `packets`, which grows by `any` packet. What it writes behind the chosen lanes is of no meaning.
    #[inline(always)]
    pub fn append<P: Copy>(&self, packets: &mut Vec<P>, lanes: &impl Columns<P>, any: &P) {
        while packets.len() < self.packet + 2 {
            packets.push(*any);
        }
        if let Some([last, next]) = packets[self.packet..].first_chunk_mut() {
            lanes.pack(self, last, next);
        }
    }

    /// Writes the lanes of a column.
    #[inline(always)]
    fn pack(&self, column: Column, last: &mut Column, next: &mut Column) {
        let lanes = self.shuffle.shuffle(column, self.from);
        *last = self.shuffle.select(self.held, *last, lanes);
        *next = lanes;
    }

    /// Writes `value` to all lanes of a column.
    #[inline(always)]
    pub fn fill(&self, value: u32, last: &mut Column, next: &mut Column) {
        *last = self.shuffle.select(self.held, *last, [value; LANES]);
        *next = [value; LANES];
    }

    /// Writes `value` to all lanes of a column behind the last one that the queue has now.
    #[inline(always)]
    pub fn end_with(&self, value: f32, last: &mut Lanes, next: &mut Lanes) {
        let value = [value.to_bits(); LANES];
        for (full, lanes) in self.full.into_iter().zip([last, next]) {
            *lanes = from_bits(self.shuffle.select(full, to_bits(*lanes), value));
        }
    }

    /// How many lanes are added.
    #[inline(always)]
    pub fn added(&self) -> usize {
        self.added
    }
}

#[inline(always)]
fn to_bits(lanes: Lanes) -> Column {
    lanes.map(f32::to_bits)
}

#[inline(always)]
fn from_bits(column: Column) -> Lanes {
    column.map(f32::from_bits)
}

/// The masks of the first lanes of a packet, by their number.
static FIRST_LANES: [Column; LANES + 1] = {
    let mut masks = [[0; LANES]; LANES + 1];
    let mut count = 1;
    while count <= LANES {
        masks[count] = masks[count - 1];
        masks[count][count - 1] = u32::MAX;
        count += 1;
    }
    masks
};

/// For each set the lanes of a packet, a byte for each: first those in the set.
static ORDERS: [u64; 256] = {
    let mut orders = [0; 256];
    let mut set = 0;
    while set < 256 {
        let (mut order, mut place) = (0, 0);
        let mut turn = 0;
        while turn < 2 * LANES {
            let (lane, is_wanted) = (turn % LANES, turn < LANES);
            if (set >> lane & 1 == 1) == is_wanted {
                order |= (lane as u64) << (8 * place);
                place += 1;
            }
            turn += 1;
        }
        orders[set] = order;
        set += 1;
    }
    orders
};

/// Adds lanes of packets to queues, all of as many lanes, by [`Packing::append`].
pub trait Append {
    /// Does it.
    fn append<S: Shuffle>(self, packing: &Packing<S>);
}

impl Vectorizer {
    /// Adds `chosen` lanes to queues of `len` lanes.
    #[inline(always)]
    pub fn append(self, chosen: LaneSet, len: usize, append: impl Append) {
        self.shuffle(Appending { chosen, len, append });
    }
}

/// See [`Vectorizer::append`].
struct Appending<A> {
    chosen: LaneSet,
    len: usize,
    append: A,
}

impl<A: Append> ShuffleKernel for Appending<A> {
    #[inline(always)]
    fn call<S: Shuffle>(self, shuffle: S) {
        self.append.append(&Packing::new(shuffle, self.chosen, self.len));
    }
}

impl Columns for Column {
    #[inline(always)]
    fn pack<S: Shuffle>(&self, packing: &Packing<S>, last: &mut Self, next: &mut Self) {
        packing.pack(*self, last, next);
    }
}

impl Columns for Lanes {
    #[inline(always)]
    fn pack<S: Shuffle>(&self, packing: &Packing<S>, last: &mut Self, next: &mut Self) {
        let (mut last_bits, mut next_bits) = (to_bits(*last), [0; LANES]);
        packing.pack(to_bits(*self), &mut last_bits, &mut next_bits);
        (*last, *next) = (from_bits(last_bits), from_bits(next_bits));
    }
}

impl<C: Columns, const N: usize> Columns for [C; N] {
    #[inline(always)]
    fn pack<S: Shuffle>(&self, packing: &Packing<S>, last: &mut Self, next: &mut Self) {
        for i in 0..N {
            self[i].pack(packing, &mut last[i], &mut next[i]);
        }
    }
}

/// Implements [`Columns`] for a struct of them.
macro_rules! columns {
    ($type:ident $(<$parameter:ident: $bound:path>)? { $($field:tt),* }) => {
        impl $(<$parameter: $bound>)? $crate::math::Columns for $type $(<$parameter>)? {
            #[inline(always)]
            fn pack<Instructions: $crate::math::Shuffle>(
                &self,
                packing: &$crate::math::Packing<Instructions>,
                last: &mut Self,
                next: &mut Self,
            ) {
                $(self.$field.pack(packing, &mut last.$field, &mut next.$field);)*
            }
        }
    };
}
pub(crate) use columns;

/// What eight lanes hold that has no columns.
#[derive(Clone, Copy, Debug)]
pub struct Each<T>(pub [T; LANES]);

impl<T: Copy> Columns for Each<T> {
    #[inline(always)]
    fn pack<S: Shuffle>(&self, packing: &Packing<S>, last: &mut Self, next: &mut Self) {
        for i in 0..LANES {
            let value = self.0[packing.from[i] as usize % LANES];
            if packing.held[i] == 0 {
                last.0[i] = value;
            }
            next.0[i] = value;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::shuffle::Portable;

    struct Numbers<'a>(&'a mut Vec<[u32; LANES]>, [u32; LANES]);

    impl Append for Numbers<'_> {
        fn append<S: Shuffle>(self, packing: &Packing<S>) {
            packing.append(self.0, &self.1, &[99; LANES]);
        }
    }

    #[test]
    fn chosen_lanes_follow_each_other_without_gaps() {
        let numbers: [u32; LANES] = std::array::from_fn(|i| 10 + i as u32);
        for held in 0..LANES as u32 {
            for set in 0..256_u32 {
                let chosen: [bool; LANES] = std::array::from_fn(|i| set >> i & 1 == 1);
                let before: Vec<u32> = (0..held).collect();
                let mut expected = before.clone();
                expected.extend((0..LANES).filter(|&i| chosen[i]).map(|i| numbers[i]));
                let mut first = [99; LANES];
                first[..held as usize].copy_from_slice(&before);
                let (mut packets, mut portable) = (vec![first], vec![first]);
                let lanes = LaneSet::from(chosen);
                assert_eq!(lanes.len() + held, expected.len() as u32);
                Vectorizer::default().append(lanes, held as usize, Numbers(&mut packets, numbers));
                Packing::new(Portable, lanes, held as usize).append(&mut portable, &numbers, &[99; LANES]);
                assert_eq!(packets.as_flattened()[..expected.len()], expected);
                assert_eq!(portable.as_flattened()[..expected.len()], expected);
            }
        }
    }
}
