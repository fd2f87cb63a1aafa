//! Random permutations of 0..n without a table, for several lanes at once.

use super::hash::mix32;

/// Where each lane's random permutation of 0..`n`, chosen by its seed, takes its value. Values are less than `n`; `n` is at
/// least 1.
///
/// It is a bijection of the integers of as many bits as `n` needs, followed again until it comes back below `n` (cycle walking:
/// Black and Rogaway 2002). All lanes walk as long as one of them has to, so that the loop over lanes stays free of branches.
#[inline(always)]
pub(super) fn permute<const N: usize>(values: [u32; N], n: u32, seeds: [u32; N]) -> [u32; N] {
    let width = u32::BITS - (n - 1).leading_zeros();
    let bits = Bits {
        mask: ((1_u64 << width) - 1) as u32,
        shift: width.div_ceil(2).max(1),
    };
    let mut values: [u32; N] = std::array::from_fn(|i| bits.scramble(values[i], seeds[i]));
    loop {
        let mut outside = false;
        for &value in &values {
            outside |= value >= n;
        }
        if !outside {
            return values;
        }
        for (value, &seed) in values.iter_mut().zip(&seeds) {
            let next = bits.scramble(*value, seed);
            *value = if *value >= n { next } else { *value };
        }
    }
}

/// The integers of a number of bits.
#[derive(Clone, Copy)]
struct Bits {
    mask: u32,
    shift: u32,
}

impl Bits {
    /// A bijection of these integers: products carry low bits to high ones, shifts high bits to low ones.
    #[inline(always)]
    fn scramble(self, mut value: u32, seed: u32) -> u32 {
        let mut key = mix32(seed ^ 0x9e37_79b9);
        // Of the pairs of images of two values each is then as likely as any other to 0.3 %, for the smallest ranges too.
        for _ in 0..5 {
            value = value.wrapping_mul(key | 1) & self.mask;
            value ^= value >> self.shift;
            value ^= (value >> 1) & (key >> 7);
            value = value.wrapping_add(key >> 15) & self.mask;
            key = mix32(key.wrapping_add(0x9e37_79b9));
        }
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_seed_permutes() {
        for n in (1..70).chain([1000, 4095, 4096, 4097]) {
            for seed in [0, 1, 77, u32::MAX] {
                let mut seen = vec![false; n as usize];
                for i in 0..n {
                    let [image] = permute([i], n, [seed]);
                    assert!(!std::mem::replace(&mut seen[image as usize], true), "{n} {seed} {i}");
                }
            }
        }
    }

    #[test]
    fn pairs_of_images_are_all_alike_over_seeds() {
        const SEEDS: u32 = 40_000;
        for n in [2_u32, 3, 4, 5, 8, 13, 16, 17] {
            let [mut counts_first, mut counts_last] = [0; 2].map(|_| vec![0_u32; (n * n) as usize]);
            for seed in 0..SEEDS {
                let [a, b, c] = permute([0, 1, n - 1], n, [mix32(seed + 1); 3]);
                counts_first[(a * n + b) as usize] += 1;
                counts_last[(a * n + c) as usize] += 1;
            }
            for counts in [counts_first, counts_last] {
                let expected = f64::from(SEEDS) / f64::from(n * (n - 1));
                let pairs = (0..n * n).filter(|pair| pair / n != pair % n);
                let chi2: f64 = pairs
                    .map(|pair| (f64::from(counts[pair as usize]) - expected).powi(2) / expected)
                    .sum();
                let freedom = f64::from(n * (n - 1) - 1);
                // Five standard deviations.
                assert!(
                    chi2 < freedom + 5.0 * (2.0 * freedom).sqrt(),
                    "{n}: {chi2} for {freedom}"
                );
            }
        }
    }
}
