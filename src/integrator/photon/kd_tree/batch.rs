//! An order of queries that is good for the cache.

use crate::math::Vec3;

/// Bits of each coordinate in a position along the curve.
const BITS: u32 = 10;

/// The indices of points in the order of the Morton curve through their box.
pub fn along_curve(points: &[Vec3]) -> impl Iterator<Item = usize> {
    let min = points.iter().copied().fold(Vec3::INFINITY, Vec3::min);
    let max = points.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
    let cells = ((1 << BITS) - 1) as f32;
    let scale = cells / (max - min).max_element().max(f32::MIN_POSITIVE);
    let position = |p: Vec3| {
        let cell = (p - min) * scale;
        // Conversion saturates, and makes what is no number 0.
        spread(cell.x as u32) | (spread(cell.y as u32) << 1) | (spread(cell.z as u32) << 2)
    };
    let mut keys: Vec<_> = points.iter().enumerate().map(|(i, p)| (position(*p), i)).collect();
    keys.sort_unstable();
    keys.into_iter().map(|(_, i)| i)
}

/// Spreads the lowest [`BITS`] bits to every third.
fn spread(cell: u32) -> u32 {
    let mut bits = cell & ((1 << BITS) - 1);
    bits = (bits | (bits << 16)) & 0x0300_00ff;
    bits = (bits | (bits << 8)) & 0x0300_f00f;
    bits = (bits | (bits << 4)) & 0x030c_30c3;
    (bits | (bits << 2)) & 0x0924_9249
}
