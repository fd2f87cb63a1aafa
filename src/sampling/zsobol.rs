//! Sobol points dealt out along a Morton curve over the pixels, so that neighbouring pixels make different errors, which the eye
//! takes for less: blue noise.
//!
//! Ahmed and Wonka 2020, "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of Pixels".
//! Of one Owen-scrambled sequence each pixel takes 2^k consecutive points, each block of 2 x 2 pixels four such runs that
//! together are a net, and so on. The order within each block is random and differs between groups, so that groups are
//! independent.
//!
//! pbrt-v4's `zsobol` does so over the whole picture. Here it is over a tile of 256 x 256 pixels (fewer for more than 2^16
//! samples), each with its own scrambling: that indices fit into 32 bits, and numbers do not depend on the resolution.

use super::hash::{mix32, split_mix};
use super::sobol::{scramble_reversed, scrambled_points};

/// Pixels along a tile are 2 to the power of this, at most.
const MOST_LEVELS: u32 = 8;

/// How the points are dealt out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Order {
    /// Binary digits of the number of samples in a pixel.
    pub log2_samples: u8,
    /// Where the pixel is on its tile's Morton curve.
    pub place: u16,
}

impl Order {
    /// For `samples` in each pixel, and pixel (`x`, `y`); with the tile that this is in.
    #[inline]
    pub fn new(samples: u32, x: i32, y: i32) -> (Self, [i32; 2]) {
        let log2_samples = (u32::BITS - (samples.max(1) - 1).leading_zeros()).min(31);
        let levels = levels(log2_samples);
        let within = |v: i32| spread(v.cast_unsigned() & ((1 << levels) - 1));
        let order = Self {
            log2_samples: log2_samples as u8,
            place: (within(x) | within(y) << 1) as u16,
        };
        (order, [x >> levels, y >> levels])
    }
}

/// Levels of blocks in a tile: its pixels' samples are numbered with 32 bits.
#[inline(always)]
fn levels(log2_samples: u32) -> u32 {
    ((32 - log2_samples) / 2).min(MOST_LEVELS)
}

/// Puts a zero above each of eight bits.
#[inline(always)]
const fn spread(v: u32) -> u32 {
    let v = (v | v << 4) & 0x0f0f;
    let v = (v | v << 2) & 0x3333;
    (v | v << 1) & 0x5555
}

/// The images of 1 and 2 under the six invertible linear maps of two bits, four bits for each map.
const LINEAR_MAPS: u32 = 0xb7_e6d9;

/// The random permutation of `digit` (0 to 3) that `hash` chooses: the 24 of them are the affine maps of two bits.
#[inline(always)]
fn permute_digit(digit: u32, hash: u32) -> u32 {
    let map = LINEAR_MAPS >> (((hash >> 16) * 6) >> 16 << 2);
    let of_1 = (map & 3) * (digit & 1);
    let of_2 = (map >> 2 & 3) * (digit >> 1);
    of_1 ^ of_2 ^ (hash & 3)
}

/// The four numbers of `group` in each lane, for [`Order`]s of one number of samples. The keys are those of tiles, not of pixels.
#[inline(always)]
pub(super) fn draw<const N: usize>(
    keys: [u64; N],
    reversed_indices: [u32; N],
    log2_samples: u8,
    places: [u32; N],
    group: u32,
) -> [[f32; N]; 4] {
    let log2_samples = u32::from(log2_samples);
    let hashes = keys.map(|key| split_mix(key, u64::from(group)));
    let mut permuted = [0_u32; N];
    for level in (0..levels(log2_samples)).rev() {
        for i in 0..N {
            // A number for the block that the permutation is of, unlike those of all other blocks of any size.
            let block = places[i] >> (2 * level + 2) | 1 << (30 - 2 * level);
            let hash = mix32((hashes[i] as u32).wrapping_add(block.wrapping_mul(0x9e37_79b9)));
            permuted[i] |= permute_digit(places[i] >> (2 * level) & 3, hash) << (2 * level);
        }
    }
    let within = ((1_u64 << log2_samples) - 1) as u32;
    for i in 0..N {
        let seed = mix32((hashes[i] >> 32) as u32 ^ places[i].wrapping_mul(0x9e37_79b9));
        let index = scramble_reversed(reversed_indices[i], seed).reverse_bits() & within;
        permuted[i] = permuted[i] << log2_samples | index;
    }
    scrambled_points(permuted, hashes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_permuted_in_all_24_ways() {
        let mut counts = std::collections::BTreeMap::new();
        for seed in 0..24_000 {
            *counts
                .entry([0, 1, 2, 3].map(|digit| permute_digit(digit, mix32(seed + 1))))
                .or_insert(0) += 1;
        }
        assert_eq!(counts.len(), 24);
        for (permutation, count) in counts {
            let mut sorted = permutation;
            sorted.sort_unstable();
            assert_eq!(sorted, [0, 1, 2, 3]);
            // Six standard deviations.
            assert!((f64::from(count) - 1000.0).abs() < 190.0, "{permutation:?}: {count}");
        }
    }

    #[test]
    fn places_are_morton_indices_in_the_tile() {
        let (order, tile) = Order::new(16, 3, 5);
        assert_eq!((order.place, tile, order.log2_samples), (0b10_0111, [0, 0], 4));
        let (order, tile) = Order::new(5, -1, 256);
        assert_eq!((order.place, tile, order.log2_samples), (0x5555, [-1, 1], 3));
        assert_eq!(Order::new(1 << 24, 17, -1).1, [1, -1]);
        assert_eq!(Order::new(1, 17, -1).0.log2_samples, 0);
    }
}
