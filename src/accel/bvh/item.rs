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

    /// Around a box.
    pub fn new(bounds: &Bounds3) -> Self {
        Self {
            low: bounds.min.extend(0.0),
            high: bounds.max.extend(0.0),
        }
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

    /// Half of its area, without overflow; 0 of nothing.
    pub fn half_area(&self) -> f64 {
        half_area(&self.bounds())
    }
}

/// As [`Bounds3::half_area`], without overflow.
pub fn half_area(bounds: &Bounds3) -> f64 {
    if bounds.is_empty() {
        return 0.0;
    }
    let d = bounds.max.as_dvec3() - bounds.min.as_dvec3();
    d.x * d.y + d.y * d.z + d.z * d.x
}

/// Something to be put into a tree: a box, and in the last lane of its least corner the bits of a name.
#[derive(Clone, Copy, Debug)]
pub struct Item {
    low: Vec4,
    high: Vec4,
}

impl Item {
    /// What `index` names to the caller, in a box.
    pub fn new(bounds: &Bounds3, index: u32) -> Self {
        Self::with_box(&Box4::new(bounds), index)
    }

    /// The same.
    #[inline]
    pub fn with_box(bounds: &Box4, index: u32) -> Self {
        let mut item = Self {
            low: bounds.low,
            high: bounds.high,
        };
        item.low.w = f32::from_bits(index);
        item
    }

    /// What it is, to the caller.
    #[inline]
    pub fn index(&self) -> u32 {
        self.low.w.to_bits()
    }

    /// Its box.
    #[inline]
    pub fn box4(&self) -> Box4 {
        Box4 {
            low: self.low,
            high: self.high,
        }
    }

    /// The middle of its box; zero along axes where that is infinite. The last lane is zero.
    #[inline]
    pub fn center(&self) -> Vec4 {
        let (mut low, mut high) = (self.low, self.high);
        // A name is a small number as a float, with which some processors are slow.
        (low.w, high.w) = (0.0, 0.0);
        let c = low * 0.5 + high * 0.5;
        if c.is_finite() {
            return c;
        }
        Vec4::select(c.abs().cmplt(Vec4::INFINITY), c, Vec4::ZERO)
    }
}

/// Boxes around items, and around their centres.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    /// Around the items.
    pub bounds: Box4,
    /// Around their centres.
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
            centers: self.centers.grow(item.center()),
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

    /// The size of the box of the centres.
    pub fn spread(&self) -> Vec3 {
        (self.centers.high - self.centers.low).truncate()
    }
}
