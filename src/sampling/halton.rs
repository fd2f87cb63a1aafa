//! Halton's sequence, Owen-scrambled: the digits of a sample's index in a prime base, mirrored at the point.
//!
//! Each dimension has its own prime; that of dimension d of group g is prime number 4 g + d, and group 64 begins again with 2.
//! Every pixel takes the first points of the sequence under its own scrambling. (pbrt-v4 has one sequence for all pixels and
//! permutes digits unless told to scramble them; the expectation is the same.)
//!
//! Sources: Halton 1960; Owen 1995 ("Randomly permuted (t,m,s)-nets and (t,s)-sequences"). The random permutation of a digit d
//! is a d + c modulo the prime with random a (not 0) and c. It takes two different digits to each pair of different digits with
//! the same probability, as do all permutations together: the variance of an estimate, which pairs of points decide, is that of
//! Owen's scrambling.

use super::hash::{mix32, split_mix, unit_f32};

const COUNT: usize = 256;

/// The first primes, up to 1619.
static PRIMES: [u32; COUNT] = first_primes();

const fn first_primes() -> [u32; COUNT] {
    let mut primes = [0; COUNT];
    let mut found = 0;
    let mut candidate = 2;
    while found < COUNT {
        let mut i = 0;
        while i < found && candidate % primes[i] != 0 {
            i += 1;
        }
        if i == found {
            primes[found] = candidate;
            found += 1;
        }
        candidate += 1;
    }
    primes
}

/// The four numbers of `group` in each lane, for indices less than `samples`, which is at most 2^24 for points without
/// repetition.
#[inline(always)]
pub(super) fn draw<const N: usize>(keys: [u64; N], indices: [u32; N], samples: u32, group: u32) -> [[f32; N]; 4] {
    let hashes = keys.map(|key| split_mix(key, u64::from(group)));
    std::array::from_fn(|d| {
        let base = PRIMES[(4 * group as usize + d) % COUNT];
        let seeds = hashes.map(|hash| mix32((hash as u32).wrapping_add(d as u32 + 1)) ^ (hash >> 32) as u32);
        scrambled_radical_inverse(Base::new(base), indices, samples, seeds)
    })
}

/// Division by a number that the compiler does not know.
#[derive(Clone, Copy)]
struct Base {
    base: u32,
    /// 2^40 over the base, rounded up.
    reciprocal: u64,
}

impl Base {
    #[inline(always)]
    fn new(base: u32) -> Self {
        let reciprocal = (1_u64 << 40) / u64::from(base) + 1;
        Self { base, reciprocal }
    }

    /// Quotient and remainder of `value`, which is less than 2^24 (so that the rounded reciprocal is off by less than 1/base).
    #[inline(always)]
    fn divide(self, value: u32) -> (u32, u32) {
        let quotient = ((u64::from(value) * self.reciprocal) >> 40) as u32;
        (quotient, value.wrapping_sub(quotient.wrapping_mul(self.base)))
    }

    /// `bits` as a number from 0 to `count` - 1.
    #[inline(always)]
    fn below(bits: u32, count: u32) -> u32 {
        ((u64::from(bits) * u64::from(count)) >> 32) as u32
    }
}

#[inline(always)]
fn scrambled_radical_inverse<const N: usize>(base: Base, indices: [u32; N], samples: u32, seeds: [u32; N]) -> [f32; N] {
    let mut rest = indices.map(|index| index & 0x00ff_ffff);
    let mut hash = seeds;
    let mut reversed = [0_u32; N];
    // What tells the indices apart: base^digits >= samples. Below them the digits of a point are its own, so that they are drawn
    // in one go.
    let mut cells = 1_u32;
    while cells < samples.min(1 << 24) {
        for i in 0..N {
            let (quotient, digit) = base.divide(rest[i]);
            let factor = 1 + Base::below(mix32(hash[i]), base.base - 1);
            let shift = Base::below(mix32(hash[i] ^ 0x5bd1_e995), base.base);
            let (_, scrambled) = base.divide(factor * digit + shift);
            reversed[i] = reversed[i] * base.base + scrambled;
            // The next digit's permutation depends on this digit and on those above it.
            hash[i] = mix32(
                hash[i]
                    .wrapping_add(0x9e37_79b9)
                    .wrapping_add(digit.wrapping_mul(0x85eb_ca6b)),
            );
            rest[i] = quotient;
        }
        cells *= base.base;
    }
    let scale = 1.0 / f64::from(cells);
    std::array::from_fn(|i| {
        let offset = unit_f32(mix32(hash[i] ^ 0xc2b2_ae35));
        let place = (f64::from(reversed[i]) + f64::from(offset)) * scale;
        (place * 16_777_216.0).min(16_777_215.0) as i32 as f32 * (1.0 / 16_777_216.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bases_are_primes_and_divide() {
        assert_eq!(PRIMES[..8], [2, 3, 5, 7, 11, 13, 17, 19]);
        assert_eq!(PRIMES[255], 1619);
        for &prime in &PRIMES {
            let base = Base::new(prime);
            for value in (0..1 << 24).step_by(99_991).chain([prime - 1, prime, (1 << 24) - 1]) {
                assert_eq!(base.divide(value), (value / prime, value % prime));
            }
        }
    }
}
