//! Between the values at four corners.

use super::{Mapping2, TextureContext};

/// Linear in s and in t between the values at (0, 0), (0, 1), (1, 0) and (1, 1), and so on beyond them.
#[derive(Clone, Debug)]
pub struct Bilerp<V> {
    /// Where the corners are.
    pub mapping: Mapping2,
    /// The values, in the order above.
    pub corners: [V; 4],
}

impl<V> Bilerp<V> {
    /// The sum of the values at the corners, which `value` gives, by weights; `add` adds one to a sum.
    pub(super) fn evaluate<T>(
        &self,
        context: &TextureContext,
        zero: T,
        value: impl Fn(&V) -> T,
        add: impl Fn(T, T, f32) -> T,
    ) -> T {
        let st = self.mapping.map(context).st;
        let (s, t) = (st.x, st.y);
        let weights = [(1.0 - s) * (1.0 - t), (1.0 - s) * t, s * (1.0 - t), s * t];
        let corners = self.corners.iter().zip(weights);
        corners.fold(zero, |sum, (corner, weight)| add(sum, value(corner), weight))
    }
}
