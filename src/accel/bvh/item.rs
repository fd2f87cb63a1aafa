//! What trees are built over: boxes with names, in four lanes for the processor's vectors.

use crate::math::{Bounds3, Vec3, Vec4};

/// A box in four lanes, of which the last means nothing.
#[derive(Clone, Copy, Debug)]
pub struct Box4 {
    /// The least corner.
    pub low: Vec4,
    /// The greatest corner.
    pub high: Vec4,
}

impl Box4 {
    /// Around nothing.
    pub const EMPTY: Self = Self {
        low: Vec4::INFINITY,
        high: Vec4::NEG_INFINITY,
    };

    /// Around a box as trees are shaped by it.
    #[inline]
    pub fn within_reach(bounds: &Bounds3) -> Self {
        let reach = Vec4::splat(FARTHEST);
        Self {
            low: bounds.min.extend(0.0).clamp(-reach, reach),
            high: bounds.max.extend(0.0).clamp(-reach, reach),
        }
    }

    /// Twice its middle. The last lane means nothing.
    #[inline]
    pub fn twice_center(&self) -> Vec4 {
        self.low + self.high
    }

    /// Around both.
    #[inline]
    pub fn union(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// Around what is in both.
    #[inline]
    pub fn intersection(self, other: Self) -> Self {
        Self {
            low: self.low.max(other.low),
            high: self.high.min(other.high),
        }
    }

    /// Around it and a point.
    #[inline]
    pub fn grow(self, point: Vec4) -> Self {
        Self {
            low: self.low.min(point),
            high: self.high.max(point),
        }
    }

    /// Whether nothing is in it.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.low.truncate().cmpgt(self.high.truncate()).any()
    }

    /// The same in three lanes.
    pub fn bounds(&self) -> Bounds3 {
        Bounds3 {
            min: self.low.truncate(),
            max: self.high.truncate(),
        }
    }

    /// Half of its area; 0 of nothing. Of boxes of [items](Item) it is finite.
    #[inline]
    pub fn half_area(&self) -> f32 {
        let d = (self.high - self.low).max(Vec4::ZERO);
        d.x * d.y + d.y * d.z + d.z * d.x
    }
}

/// Beyond this boxes are cut off where trees are shaped: so areas, times numbers of primitives, are finite in single precision.
const FARTHEST: f32 = 1e15;

/// Whether nothing of a triangle is cut off where trees are shaped.
#[inline]
pub fn is_within_reach(corners: [Vec3; 3]) -> bool {
    let [a, b, c] = corners.map(Vec3::abs);
    a.max(b).max(c).max_element() <= FARTHEST
}

/// As [`Bounds3::half_area`], of any box without overflow.
pub fn half_area(bounds: &Bounds3) -> f64 {
    if bounds.is_empty() {
        return 0.0;
    }
    let d = bounds.max.as_dvec3() - bounds.min.as_dvec3();
    d.x * d.y + d.y * d.z + d.z * d.x
}

/// Something to be put into a tree: a box, and in the last lanes of its corners the bits of a name.
#[derive(Clone, Copy, Debug)]
pub struct Item {
    low: Vec4,
    high: Vec4,
}

/// Bits of a name in a lane: below the exponent of a number of usual size, as some processors are slow with the smallest.
const NAME_BITS: u32 = 23;

/// A number from 1 to 2 whose last bits are some of a name.
fn named(bits: u32) -> f32 {
    f32::from_bits(0x3f80_0000 | bits)
}

impl Item {
    /// What `index` names to the caller, in a box.
    #[inline]
    pub fn new(bounds: &Bounds3, index: u32) -> Self {
        Self::with_box(&Box4::within_reach(bounds), index)
    }

    /// The same.
    #[inline]
    pub fn with_box(bounds: &Box4, index: u32) -> Self {
        let mut item = Self {
            low: bounds.low,
            high: bounds.high,
        };
        item.low.w = named(index & ((1 << NAME_BITS) - 1));
        item.high.w = named(index >> NAME_BITS);
        item
    }

    /// What it is, to the caller.
    #[inline]
    pub fn index(&self) -> u32 {
        let [low, high] = [self.low, self.high].map(|corner| corner.w.to_bits() & ((1 << NAME_BITS) - 1));
        low | high << NAME_BITS
    }

    /// Its box.
    #[inline]
    pub fn box4(&self) -> Box4 {
        Box4 {
            low: self.low,
            high: self.high,
        }
    }

    /// Twice the middle of its box. The last lane means nothing.
    #[inline]
    pub fn twice_center(&self) -> Vec4 {
        self.box4().twice_center()
    }
}

/// Boxes around items, and around their centres.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    /// Around the items.
    pub bounds: Box4,
    /// Around twice their centres.
    pub centers: Box4,
}

impl Extent {
    /// Of no items.
    pub const EMPTY: Self = Self {
        bounds: Box4::EMPTY,
        centers: Box4::EMPTY,
    };

    /// With one more.
    #[inline]
    pub fn with(self, item: &Item) -> Self {
        Self {
            bounds: self.bounds.union(item.box4()),
            centers: self.centers.grow(item.twice_center()),
        }
    }

    /// Of both.
    #[inline]
    pub fn union(self, other: Self) -> Self {
        Self {
            bounds: self.bounds.union(other.bounds),
            centers: self.centers.union(other.centers),
        }
    }

    /// Twice the size of the box of the centres.
    pub fn spread(&self) -> Vec3 {
        (self.centers.high - self.centers.low).truncate()
    }
}
