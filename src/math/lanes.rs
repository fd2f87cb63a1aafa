//! Numbers of the eight rays of a packet side by side, as a [`Kernel`](super::Kernel)'s loops want them.

use super::Vec3;

/// Rays in a packet: the widest that both backends trace natively on AVX2.
pub const LANES: usize = 8;

/// A number for each lane.
pub type Lanes = [f32; LANES];

/// A vector for each lane.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(32))]
pub struct Vec3Lanes([Lanes; 3]);

impl Vec3Lanes {
    /// From the elements of the vectors.
    pub fn new(x: Lanes, y: Lanes, z: Lanes) -> Self {
        Self([x, y, z])
    }

    /// The vector of a lane.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> Vec3 {
        let [x, y, z] = &self.0;
        Vec3::new(x[lane], y[lane], z[lane])
    }

    /// Puts `v` into a lane.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, v: Vec3) {
        let [x, y, z] = &mut self.0;
        [x[lane], y[lane], z[lane]] = v.to_array();
    }
}
