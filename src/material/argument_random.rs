//! Random numbers for BSDFs whose values are estimates: a function of the arguments, so that the same arguments give the same value.

use crate::math::{Vec2, Vec3};
use crate::sampling::hash::{combine, mix64, unit_f32};

/// A sequence of numbers in [0, 1) that its seed determines.
#[derive(Clone, Copy, Debug)]
pub(super) struct ArgumentRandom {
    state: u64,
}

impl ArgumentRandom {
    /// The sequence of two directions.
    pub fn of_directions(a: Vec3, b: Vec3) -> Self {
        Self::of(&[a.x, a.y, a.z, b.x, b.y, b.z])
    }

    /// The sequence of a direction and the numbers of a sample.
    pub fn of_sample(w: Vec3, u_lobe: f32, u: Vec2) -> Self {
        Self::of(&[w.x, w.y, w.z, u_lobe, u.x, u.y])
    }

    fn of(values: &[f32]) -> Self {
        let pairs = values.chunks(2);
        let state = pairs.fold(values.len() as u64, |hash, pair| {
            let bits = |i: usize| pair.get(i).map_or(0, |v| u64::from(v.to_bits()));
            combine(hash, bits(0) << 32 | bits(1))
        });
        Self { state }
    }

    /// The next number.
    #[inline]
    pub fn unit(&mut self) -> f32 {
        // An odd step visits all states; the finaliser makes them look unrelated (SplitMix64).
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        unit_f32((mix64(self.state) >> 32) as u32)
    }

    /// The next two.
    #[inline]
    pub fn pair(&mut self) -> Vec2 {
        Vec2::new(self.unit(), self.unit())
    }
}
