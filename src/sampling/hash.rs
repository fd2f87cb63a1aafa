//! Mixing functions: the one source of randomness of a render, which has no generator with a state.

/// 2^64 divided by the golden ratio, odd: steps by it visit every 64-bit value and are far apart.
pub(super) const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// A bijection of the 64-bit integers in which every input bit affects every output bit (the finaliser of SplitMix64 with
/// the constants of Stafford's variant 13). It maps 0 to 0: add something first where that matters.
#[inline]
pub const fn mix64(mut x: u64) -> u64 {
    x ^= x >> 30;
    x = x.wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x ^= x >> 27;
    x = x.wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// A bijection of the 32-bit integers in which every input bit affects every output bit (two rounds of multiplication and shift
/// with the constants that Wellons's search of 2018 found, "lowbias32"). It maps 0 to 0.
#[inline(always)]
pub const fn mix32(mut x: u32) -> u32 {
    x ^= x >> 16;
    x = x.wrapping_mul(0x7feb_352d);
    x ^= x >> 15;
    x = x.wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

/// The number at place `counter` of the SplitMix64 generator (Steele, Lea and Flood 2014) whose state is the key. Keys are
/// hashes, so that no two of these sequences come near each other.
#[inline(always)]
pub(super) const fn split_mix(key: u64, counter: u64) -> u64 {
    mix64(key.wrapping_add(counter.wrapping_add(1).wrapping_mul(GOLDEN)))
}

/// Hashes `value` into the hash `key`: chains of it tell sequences of values apart.
#[inline]
pub const fn combine(key: u64, value: u64) -> u64 {
    mix64(key ^ mix64(value.wrapping_add(GOLDEN))).wrapping_add(GOLDEN)
}

/// A hash of a short list of numbers (ids, coordinates), the same on every machine. Lists of different length differ.
#[inline]
pub fn hash_u32s(values: &[u32]) -> u64 {
    let mut hash = mix64(values.len() as u64 ^ GOLDEN);
    for &value in values {
        hash = combine(hash, u64::from(value));
    }
    hash
}

/// A number in [0, 1) from the upper 24 of 32 random bits: each multiple of 2^-24 is as likely as any other.
#[inline]
pub fn unit_f32(bits: u32) -> f32 {
    // By way of a signed integer, which is cheaper to convert.
    (bits >> 8).cast_signed() as f32 * (1.0 / 16_777_216.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_input_bit_flips_each_output_bit_half_the_time() {
        // Over 4096 inputs the count of flips of one output bit has the standard deviation 32: 6 of them is far out even
        // among 64 x 64 pairs.
        for input_bit in 0..64 {
            let mut flips = [0_i32; 64];
            for i in 0..4096_u64 {
                let difference = combine(1, i) ^ combine(1, i ^ (1 << input_bit));
                for (bit, count) in flips.iter_mut().enumerate() {
                    *count += (difference >> bit & 1) as i32;
                }
            }
            assert!(
                flips.iter().all(|c| (c - 2048).abs() < 6 * 32),
                "bit {input_bit}: {flips:?}"
            );
        }
    }

    #[test]
    fn order_and_length_matter() {
        assert_ne!(hash_u32s(&[1, 2]), hash_u32s(&[2, 1]));
        assert_ne!(hash_u32s(&[0]), hash_u32s(&[0, 0]));
        assert_ne!(hash_u32s(&[]), hash_u32s(&[0]));
    }

    #[test]
    fn unit_numbers_stay_below_one() {
        assert_eq!(unit_f32(0), 0.0);
        assert!(unit_f32(u32::MAX) < 1.0);
        assert_eq!(unit_f32(1 << 31), 0.5);
    }
}
