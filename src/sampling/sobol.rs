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

/// Dimension 2 of point `index`, reversed.
///
/// The direction numbers of a primitive polynomial p of degree d, as power series in the shift S by a digit, obey its recurrence with one
/// term more: p(X) v = S^d v, where X goes from one to the next. A point, the sum of X^i v_0 over the digits i of its index that are 1, is
/// therefore the index as a polynomial in X, written in base p: what is left after p^k shifts the first d direction numbers by d k digits.
/// As p^(2^j) has as few terms as p, that takes divisions by p^8, p^4, p^2 and p, each of all parts of the index at once.
#[inline(always)]
pub const fn dimension_2_reversed(index: u32) -> u32 {
    // p = X^2 + X + 1: the parts of a dividend by X^2n + X^n + 1 are a, b, c, d of n digits, a the lowest; a + c + d and b + c are left,
    // and c + d and d are the quotient.
    let mut x = index;
    x ^= (x >> 8) & 0x00ff_ff00;
    x ^= (x >> 16) & 0x0000_00ff;
    x ^= (x >> 4) & 0x0ff0_0ff0;
    x ^= (x >> 8) & 0x000f_000f;
    x ^= (x >> 2) & 0x3c3c_3c3c;
    x ^= (x >> 4) & 0x0303_0303;
    x ^= (x >> 1) & 0x6666_6666;
    x ^= (x >> 2) & 0x1111_1111;
    // The first direction numbers are 1 and 1 + S.
    x ^ ((x >> 1) & 0x5555_5555)
}

/// Dimension 3 of point `index`, reversed: as [`dimension_2_reversed`].
#[inline(always)]
pub const fn dimension_3_reversed(index: u32) -> u32 {
    // p = X^3 + X + 1: of the parts a to f of a dividend by X^3n + X^n + 1, a + d + f, b + d + e + f, c + e + f are left, and d + f, e, f
    // are the quotient. The first dividend has no e and f.
    let mut x = index;
    x ^= ((x >> 16) & 0x0000_ff00) ^ ((x >> 24) & 0x0000_00ff);
    x ^= (x >> 8) & 0x0000_f000;
    x ^= ((x >> 8) & 0x0000_0ff0) ^ ((x >> 12) & 0x0000_0fff);
    x ^= (x >> 4) & 0xc00c_00c0;
    x ^= ((x >> 4) & 0x3c03_c03c) ^ ((x >> 6) & 0x3f03_f03f);
    x ^= (x >> 2) & 0x0820_8208;
    x ^= ((x >> 2) & 0x0618_6186) ^ ((x >> 3) & 0x071c_71c7);
    // The first direction numbers are 1, 1 + S and S^2.
    x ^ ((x >> 1) & 0x4924_9249)
}

/// The first four dimensions of each of the points `indices`, Owen-scrambled by parts of its hash, in [0, 1).
#[inline(always)]
pub(super) fn scrambled_points<const N: usize>(indices: [u32; N], hashes: [u64; N]) -> [[f32; N]; 4] {
    let mut numbers = [[0.0; N]; 4];
    let [x, y, z, w] = &mut numbers;
    for i in 0..N {
        let (index, hash) = (indices[i], hashes[i]);
        let (a, b) = (mix64(hash.wrapping_add(GOLDEN)), mix64(hash ^ GOLDEN.rotate_left(32)));
        x[i] = scrambled_unit(index, a as u32);
        y[i] = scrambled_unit(dimension_1_reversed(index), (a >> 32) as u32);
        z[i] = scrambled_unit(dimension_2_reversed(index), b as u32);
        w[i] = scrambled_unit(dimension_3_reversed(index), (b >> 32) as u32);
    }
    numbers
}

#[inline(always)]
fn scrambled_unit(reversed: u32, seed: u32) -> f32 {
    unit_f32(scramble_reversed(reversed, seed).reverse_bits())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The direction numbers, most significant digit first, of the primitive polynomial of `degree` whose inner coefficients
    /// are the bits of `inner`, from the initial odd numbers `m` (Bratley and Fox 1988).
    fn direction_numbers(degree: usize, inner: u32, m: [u32; 3]) -> [u32; 32] {
        let mut v = [0; 32];
        for i in 0..degree {
            v[i] = m[i] << (31 - i);
        }
        for i in degree..32 {
            v[i] = v[i - degree] ^ (v[i - degree] >> degree);
            for k in (1..degree).filter(|k| inner >> (degree - 1 - k) & 1 == 1) {
                v[i] ^= v[i - k];
            }
        }
        v
    }

    fn point(index: u32) -> [u32; 4] {
        let [first, second, third] =
            [dimension_1_reversed, dimension_2_reversed, dimension_3_reversed].map(|of| of(index));
        [index, first, second, third].map(u32::reverse_bits)
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

    /// As published: the primitive polynomials x + 1, x^2 + x + 1 and x^3 + x + 1 with the initial numbers of Joe and Kuo.
    #[test]
    fn steps_equal_the_recurrence() {
        let dimensions = [
            (
                direction_numbers(1, 0, [1, 0, 0]),
                dimension_1_reversed as fn(u32) -> u32,
            ),
            (direction_numbers(2, 1, [1, 3, 0]), dimension_2_reversed),
            (direction_numbers(3, 1, [1, 3, 1]), dimension_3_reversed),
        ];
        for (v, reversed) in dimensions {
            let single = (0..32).map(|bit| 1 << bit);
            for index in (0..10_000_000_u32).step_by(9973).chain(single).chain([u32::MAX]) {
                let sum = (0..32).filter(|j| index >> j & 1 == 1).fold(0, |x, j| x ^ v[j]);
                assert_eq!(reversed(index).reverse_bits(), sum);
            }
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
