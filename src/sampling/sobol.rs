//! The first four dimensions of Sobol's sequence, and nested uniform (Owen) scrambling by a hash.
//!
//! Sources: Joe and Kuo 2008, "Constructing Sobol sequences with better two-dimensional projections" (direction numbers
//! new-joe-kuo-6); Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4); Laine and Karras 2011 for the form of
//! the hash, Vegdahl 2021 ("Building a better LK hash") for the constants.
//!
//! Everything here works on *reversed* integers: bit 0 is the most significant binary digit of the point. In that order a
//! multiplication carries from coarse digits to fine ones, which is what nested scrambling needs.

use super::hash::{GOLDEN, mix64, unit_f32};

/// Scrambles a reversed integer: whether a bit is flipped depends on the seed and on the bits below it only, so that it is
/// a random nested permutation of the digits.
#[inline(always)]
pub const fn scramble_reversed(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

/// Dimension 1 of point `index`, reversed: the product of the index with Pascal's triangle modulo 2. Pascal's matrix of 32
/// rows is a fivefold Kronecker power, so five steps suffice.
#[inline(always)]
pub const fn dimension_1_reversed(index: u32) -> u32 {
    let mut x = index;
    x ^= (x >> 1) & 0x5555_5555;
    x ^= (x >> 2) & 0x3333_3333;
    x ^= (x >> 4) & 0x0f0f_0f0f;
    x ^= (x >> 8) & 0x00ff_00ff;
    x ^ ((x >> 16) & 0x0000_ffff)
}

/// Dimensions 2 and 3 of point `index`, reversed.
#[inline(always)]
pub fn dimensions_2_3_reversed(index: u32) -> (u32, u32) {
    let mut both = 0;
    for (digit, row) in HEX_DIGITS.iter().enumerate() {
        both ^= row[(index >> (4 * digit) & 15) as usize];
    }
    (both as u32, (both >> 32) as u32)
}

/// [`dimensions_2_3_reversed`] of several points without a look into tables, which vectors are slow at: the matrices of the two
/// dimensions, diagonal by diagonal.
#[inline(always)]
fn dimensions_2_3_of_lanes<const N: usize>(indices: [u32; N]) -> ([u32; N], [u32; N]) {
    let (mut second, mut third) = ([0; N], [0; N]);
    for (k, &[in_second, in_third]) in DIAGONALS.iter().enumerate() {
        for i in 0..N {
            let shifted = indices[i] >> k;
            second[i] ^= shifted & in_second;
            third[i] ^= shifted & in_third;
        }
    }
    (second, third)
}

/// The first four dimensions of each of the points `indices`, Owen-scrambled by parts of its hash, in [0, 1).
#[inline(always)]
pub(super) fn scrambled_points<const N: usize>(indices: [u32; N], hashes: [u64; N]) -> [[f32; N]; 4] {
    let (mut second, mut third) = ([0; N], [0; N]);
    if N == 1 {
        (second[0], third[0]) = dimensions_2_3_reversed(indices[0]);
    } else {
        (second, third) = dimensions_2_3_of_lanes(indices);
    }
    let mut numbers = [[0.0; N]; 4];
    let [x, y, z, w] = &mut numbers;
    for i in 0..N {
        let (index, hash) = (indices[i], hashes[i]);
        let (a, b) = (mix64(hash.wrapping_add(GOLDEN)), mix64(hash ^ GOLDEN.rotate_left(32)));
        x[i] = scrambled_unit(index, a as u32);
        y[i] = scrambled_unit(dimension_1_reversed(index), (a >> 32) as u32);
        z[i] = scrambled_unit(second[i], b as u32);
        w[i] = scrambled_unit(third[i], (b >> 32) as u32);
    }
    numbers
}

#[inline(always)]
fn scrambled_unit(reversed: u32, seed: u32) -> f32 {
    unit_f32(scramble_reversed(reversed, seed).reverse_bits())
}

/// For each hexadecimal digit of an index and each of its values: its share of dimension 2 (low half) and 3 (high half).
/// One kilobyte, which stays in the cache where larger tables would push out the scene.
static HEX_DIGITS: [[u64; 16]; 8] = hex_digit_tables();

/// By distance k: which digits of dimensions 2 and 3, reversed, depend on the digit of the index k places above.
static DIAGONALS: [[u32; 2]; 32] = diagonals();

/// Direction numbers of dimensions 2 and 3: the primitive polynomials x^2 + x + 1 and x^3 + x + 1 with the initial numbers of Joe and
/// Kuo.
const DIRECTION_NUMBERS: [[u32; 32]; 2] = [direction_numbers(2, 1, [1, 3, 0]), direction_numbers(3, 1, [1, 3, 1])];

const fn diagonals() -> [[u32; 2]; 32] {
    let mut diagonals = [[0; 2]; 32];
    let mut bit = 0;
    while bit < 32 {
        let mut d = 0;
        while d < 2 {
            // A digit of a point depends on no digit of the index below it.
            let column = DIRECTION_NUMBERS[d][bit].reverse_bits();
            let mut k = 0;
            while k <= bit {
                diagonals[k][d] |= column & 1 << (bit - k);
                k += 1;
            }
            d += 1;
        }
        bit += 1;
    }
    diagonals
}

const fn hex_digit_tables() -> [[u64; 16]; 8] {
    let [second, third] = DIRECTION_NUMBERS;
    let mut tables = [[0; 16]; 8];
    let mut bit = 0;
    while bit < 32 {
        let column = second[bit].reverse_bits() as u64 | (third[bit].reverse_bits() as u64) << 32;
        let mut value = 0;
        while value < 16 {
            if value >> (bit % 4) & 1 == 1 {
                tables[bit / 4][value] ^= column;
            }
            value += 1;
        }
        bit += 1;
    }
    tables
}

/// The direction numbers, most significant digit first, of the primitive polynomial of `degree` whose inner coefficients
/// are the bits of `inner`, from the initial odd numbers `m` (Bratley and Fox 1988).
const fn direction_numbers(degree: usize, inner: u32, m: [u32; 3]) -> [u32; 32] {
    let mut v = [0; 32];
    let mut i = 0;
    while i < 32 {
        if i < degree {
            v[i] = m[i] << (31 - i);
        } else {
            v[i] = v[i - degree] ^ (v[i - degree] >> degree);
            let mut k = 1;
            while k < degree {
                if inner >> (degree - 1 - k) & 1 == 1 {
                    v[i] ^= v[i - k];
                }
                k += 1;
            }
        }
        i += 1;
    }
    v
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(index: u32) -> [u32; 4] {
        let (second, third) = dimensions_2_3_reversed(index);
        [index, dimension_1_reversed(index), second, third].map(u32::reverse_bits)
    }

    #[test]
    fn the_first_points_are_the_published_ones() {
        // In sixteenths, from any table of the sequence (not in Gray-code order).
        let published = [
            [0, 0, 0, 0],
            [8, 8, 8, 8],
            [4, 12, 12, 12],
            [12, 4, 4, 4],
            [2, 10, 6, 2],
            [10, 2, 14, 10],
            [6, 6, 10, 14],
            [14, 14, 2, 6],
        ];
        for (index, expected) in published.into_iter().enumerate() {
            assert_eq!(point(index as u32).map(|x| x >> 28), expected, "point {index}");
        }
    }

    #[test]
    fn pascal_steps_equal_the_recurrence() {
        let v = direction_numbers(1, 0, [1, 0, 0]);
        for index in (0..10_000_000_u32).step_by(9973).chain([u32::MAX]) {
            let sum = (0..32).filter(|j| index >> j & 1 == 1).fold(0, |x, j| x ^ v[j]);
            assert_eq!(dimension_1_reversed(index).reverse_bits(), sum);
        }
    }

    #[test]
    fn diagonals_give_what_the_tables_give() {
        for index in (0..1 << 12).chain((0..1000_u32).map(|i| i.wrapping_mul(0x9e37_79b9))) {
            let (second, third) = dimensions_2_3_of_lanes([index, !index]);
            assert_eq!((second[0], third[0]), dimensions_2_3_reversed(index));
            assert_eq!((second[1], third[1]), dimensions_2_3_reversed(!index));
        }
    }

    #[test]
    fn scrambling_is_nested() {
        // Points that agree in their first k digits still do, and differ in the next one as they did.
        for k in 0..31 {
            for seed in [0, 1, 0x1234_5678, u32::MAX] {
                let (a, b) = (
                    0x2468_ace1_u32,
                    0x2468_ace1_u32 ^ (1 << k) ^ (0x5bd1_e995_u32 << (k + 1)),
                );
                let difference = scramble_reversed(a, seed) ^ scramble_reversed(b, seed);
                assert_eq!(difference.trailing_zeros(), k);
            }
        }
    }
}
