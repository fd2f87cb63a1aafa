//! Numbers of the eight rays of a packet side by side, as a [`Kernel`](super::Kernel)'s loops want them.

use super::{Vec2, Vec3, columns};

/// Rays in a packet: the widest that both backends trace natively on AVX2.
pub const LANES: usize = 8;

/// A number for each lane.
pub type Lanes = [f32; LANES];

/// A vector for each lane.
pub trait VectorLanes {
    /// One of them.
    type Vector: Copy;

    /// The vector of a lane.
    fn get(&self, lane: usize) -> Self::Vector;

    /// Puts `v` into a lane.
    fn set(&mut self, lane: usize, v: Self::Vector);
}

/// A point of the plane for each lane.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(32))]
pub struct Vec2Lanes([Lanes; 2]);

/// A vector of space for each lane.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(32))]
pub struct Vec3Lanes([Lanes; 3]);

impl VectorLanes for Vec2Lanes {
    type Vector = Vec2;

    #[inline(always)]
    fn get(&self, lane: usize) -> Vec2 {
        let [x, y] = &self.0;
        Vec2::new(x[lane], y[lane])
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, v: Vec2) {
        let [x, y] = &mut self.0;
        [x[lane], y[lane]] = v.to_array();
    }
}

impl VectorLanes for Vec3Lanes {
    type Vector = Vec3;

    #[inline(always)]
    fn get(&self, lane: usize) -> Vec3 {
        let [x, y, z] = &self.0;
        Vec3::new(x[lane], y[lane], z[lane])
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, v: Vec3) {
        let [x, y, z] = &mut self.0;
        [x[lane], y[lane], z[lane]] = v.to_array();
    }
}

columns!(Vec3Lanes { 0 });

impl Vec3Lanes {
    /// The lanes of x, of y and of z.
    #[inline(always)]
    pub fn columns(&self) -> &[Lanes; 3] {
        &self.0
    }
}
