//! Some of the lanes of a packet.

use super::LANES;

/// Some of the lanes of a packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LaneSet(u8);

impl LaneSet {
    /// None of them.
    pub const NONE: Self = Self(0);

    /// All of them.
    pub const ALL: Self = Self(u8::MAX);

    /// One of them.
    #[inline]
    pub fn of(lane: usize) -> Self {
        Self(1 << lane)
    }

    /// How many.
    #[inline]
    pub fn len(self) -> u32 {
        self.0.count_ones()
    }

    /// Those that are in `other` too.
    #[inline]
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// Those, and those in `other`.
    #[inline]
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Those that are not in `other`.
    #[inline]
    #[must_use]
    pub fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Whether there are none.
    #[inline]
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether a lane is in it.
    #[inline(always)]
    pub fn has(self, lane: usize) -> bool {
        self.0 >> lane & 1 == 1
    }

    /// Its place among all sets: bit i is set for lane i.
    #[inline(always)]
    pub(super) fn index(self) -> usize {
        self.0.into()
    }

    /// Which ones.
    #[inline]
    pub fn lanes(self) -> impl Iterator<Item = usize> {
        let mut rest = self.0;
        std::iter::from_fn(move || {
            let lane = rest.trailing_zeros() as usize;
            rest &= rest.wrapping_sub(1);
            (lane < LANES).then_some(lane)
        })
    }
}

impl From<[bool; LANES]> for LaneSet {
    #[inline(always)]
    fn from(chosen: [bool; LANES]) -> Self {
        // The product brings the lowest bit of each byte to a place of its own in the highest byte.
        let bytes = u64::from_le_bytes(chosen.map(u8::from));
        Self((bytes.wrapping_mul(0x0102_0408_1020_4080) >> 56) as u8)
    }
}
