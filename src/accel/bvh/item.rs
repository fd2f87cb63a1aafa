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

/// Bits of a name in the first lane: as many as leave a number of usual size, as some processors are slow with the smallest. The others are
/// in the second lane.
const LOW_BITS: u32 = 23;

/// The number 1, to whose last bits a name is added.
const ONE: u32 = 0x3f80_0000;

/// In the second lane, that the item is a fragment.
const IS_FRAGMENT: u32 = 1 << 22;

impl Item {
    /// What `index` names to the caller, in a box.
    #[inline]
    pub fn new(bounds: &Bounds3, index: u32) -> Self {
        let [low, high] = [index & ((1 << LOW_BITS) - 1), index >> LOW_BITS];
        Self::with_lanes(
            &Box4::within_reach(bounds),
            f32::from_bits(ONE | low),
            f32::from_bits(ONE | high),
        )
    }

    #[inline]
    fn with_lanes(bounds: &Box4, low: f32, high: f32) -> Self {
        let mut item = Self {
            low: bounds.low,
            high: bounds.high,
        };
        (item.low.w, item.high.w) = (low, high);
        item
    }

    /// A fragment of it.
    pub fn fragment(&self, bounds: &Box4) -> Self {
        let high = f32::from_bits(self.high.w.to_bits() | IS_FRAGMENT);
        Self::with_lanes(bounds, self.low.w, high)
    }

    /// Whether it is one.
    #[inline]
    pub fn is_fragment(&self) -> bool {
        self.high.w.to_bits() & IS_FRAGMENT != 0
    }

    /// What it is, to the caller.
    #[inline]
    pub fn index(&self) -> u32 {
        let [low, high] = [self.low, self.high].map(|corner| corner.w.to_bits() & !ONE);
        low | (high & !IS_FRAGMENT) << LOW_BITS
    }

    /// The box that it was made in, if that is known: nothing of it was cut off.
    pub fn whole(&self) -> Option<Bounds3> {
        let bounds = self.box4().bounds();
        let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
        (!self.is_fragment() && reach < FARTHEST).then_some(bounds)
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
