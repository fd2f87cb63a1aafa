//! Instructions that move numbers between lanes, which the compiler does not find in plain loops.

use super::{Kernel, LANES, Vectorizer};

/// Eight numbers of 32 bits.
pub type Column = [u32; LANES];

/// Instructions that permute and choose numbers of columns. Of plain choices the compiler would make branches.
pub trait Shuffle: Copy {
    /// The eight numbers of a byte each.
    fn widen(self, bytes: u64) -> Column;

    /// Lane i of the result is lane `from[i]` of `column`, each in 0..8.
    fn shuffle(self, column: Column, from: Column) -> Column;

    /// The lanes of `a` whose bits are all set in `mask`, and those of `b` that are not set there.
    fn select(self, mask: Column, a: Column, b: Column) -> Column;

    /// Lane i of column j of the result is lane j of row i.
    fn transpose(self, rows: [Column; LANES]) -> [Column; LANES];
}

/// A computation with such instructions, for [`Vectorizer::shuffle`].
pub(super) trait ShuffleKernel {
    /// Does it.
    fn call<S: Shuffle>(self, shuffle: S);
}

impl Vectorizer {
    /// Calls `kernel`, compiled for what the machine has.
    #[inline(always)]
    pub(super) fn shuffle(self, kernel: impl ShuffleKernel) {
        #[cfg(target_arch = "x86_64")]
        match self.arch() {
            pulp::Arch::V4(shuffle) => return shuffle.vectorize(Shuffling { shuffle, kernel }),
            pulp::Arch::V3(shuffle) => return shuffle.vectorize(Shuffling { shuffle, kernel }),
            _ => {}
        }
        self.run(Shuffling {
            shuffle: Portable,
            kernel,
        });
    }

    /// Writes row i of all blocks to lane i of as many columns as they are long, one block after the other.
    #[inline(always)]
    pub fn transpose<const BLOCKS: usize>(
        self,
        rows: [&[Column; BLOCKS]; LANES],
        columns: &mut [[Column; LANES]; BLOCKS],
    ) {
        self.shuffle(Transpose { rows, columns });
    }
}

/// See [`Vectorizer::shuffle`].
struct Shuffling<S, K> {
    shuffle: S,
    kernel: K,
}

impl<S: Shuffle, K: ShuffleKernel> Kernel for Shuffling<S, K> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.kernel.call(self.shuffle);
    }
}

/// See [`Vectorizer::transpose`].
struct Transpose<'a, const BLOCKS: usize> {
    rows: [&'a [Column; BLOCKS]; LANES],
    columns: &'a mut [[Column; LANES]; BLOCKS],
}

impl<const BLOCKS: usize> ShuffleKernel for Transpose<'_, BLOCKS> {
    #[inline(always)]
    fn call<S: Shuffle>(self, shuffle: S) {
        let [a, b, c, d, e, f, g, h] = self.rows;
        for i in 0..BLOCKS {
            self.columns[i] = shuffle.transpose([a[i], b[i], c[i], d[i], e[i], f[i], g[i], h[i]]);
        }
    }
}

/// Plain Rust, for any machine.
#[derive(Clone, Copy, Debug)]
pub(super) struct Portable;

impl Shuffle for Portable {
    #[inline(always)]
    fn widen(self, bytes: u64) -> Column {
        bytes.to_le_bytes().map(u32::from)
    }

    #[inline(always)]
    fn shuffle(self, column: Column, from: Column) -> Column {
        from.map(|lane| column[lane as usize % LANES])
    }

    #[inline(always)]
    fn select(self, mask: Column, a: Column, b: Column) -> Column {
        std::array::from_fn(|i| (a[i] & mask[i]) | (b[i] & !mask[i]))
    }

    #[inline(always)]
    fn transpose(self, rows: [Column; LANES]) -> [Column; LANES] {
        std::array::from_fn(|column| rows.map(|row| row[column]))
    }
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::x86_64::__m256;

    use pulp::cast;
    use pulp::x86::{V3, V4};

    use super::{Column, LANES, Shuffle};

    impl Shuffle for V3 {
        #[inline(always)]
        fn widen(self, bytes: u64) -> Column {
            cast(self.avx2._mm256_cvtepu8_epi32(cast([bytes, 0])))
        }

        #[inline(always)]
        fn shuffle(self, column: Column, from: Column) -> Column {
            cast(self.avx2._mm256_permutevar8x32_epi32(cast(column), cast(from)))
        }

        #[inline(always)]
        fn select(self, mask: Column, a: Column, b: Column) -> Column {
            cast(self.avx2._mm256_blendv_epi8(cast(b), cast(a), cast(mask)))
        }

        #[inline(always)]
        fn transpose(self, rows: [Column; LANES]) -> [Column; LANES] {
            let [a, b, c, d, e, f, g, h] = rows;
            let first = of_four(self, cast(a), cast(b), cast(c), cast(d));
            let last = of_four(self, cast(e), cast(f), cast(g), cast(h));
            [
                cast(self.avx._mm256_permute2f128_ps::<0x20>(first[0], last[0])),
                cast(self.avx._mm256_permute2f128_ps::<0x20>(first[1], last[1])),
                cast(self.avx._mm256_permute2f128_ps::<0x20>(first[2], last[2])),
                cast(self.avx._mm256_permute2f128_ps::<0x20>(first[3], last[3])),
                cast(self.avx._mm256_permute2f128_ps::<0x31>(first[0], last[0])),
                cast(self.avx._mm256_permute2f128_ps::<0x31>(first[1], last[1])),
                cast(self.avx._mm256_permute2f128_ps::<0x31>(first[2], last[2])),
                cast(self.avx._mm256_permute2f128_ps::<0x31>(first[3], last[3])),
            ]
        }
    }

    /// Columns of four rows: of the first half of the rows in the lower four numbers, of the last in the upper.
    #[inline(always)]
    fn of_four(simd: V3, a: __m256, b: __m256, c: __m256, d: __m256) -> [__m256; 4] {
        let (ab, cd) = (simd.avx._mm256_unpacklo_ps(a, b), simd.avx._mm256_unpacklo_ps(c, d));
        let ab_after = simd.avx._mm256_unpackhi_ps(a, b);
        let cd_after = simd.avx._mm256_unpackhi_ps(c, d);
        [
            simd.avx._mm256_shuffle_ps::<0x44>(ab, cd),
            simd.avx._mm256_shuffle_ps::<0xee>(ab, cd),
            simd.avx._mm256_shuffle_ps::<0x44>(ab_after, cd_after),
            simd.avx._mm256_shuffle_ps::<0xee>(ab_after, cd_after),
        ]
    }

    impl Shuffle for V4 {
        #[inline(always)]
        fn widen(self, bytes: u64) -> Column {
            Shuffle::widen(*self, bytes)
        }

        #[inline(always)]
        fn shuffle(self, column: Column, from: Column) -> Column {
            Shuffle::shuffle(*self, column, from)
        }

        #[inline(always)]
        fn select(self, mask: Column, a: Column, b: Column) -> Column {
            Shuffle::select(*self, mask, a, b)
        }

        #[inline(always)]
        fn transpose(self, rows: [Column; LANES]) -> [Column; LANES] {
            Shuffle::transpose(*self, rows)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_become_columns() {
        let rows: [[Column; 2]; LANES] = std::array::from_fn(|row| {
            std::array::from_fn(|block| std::array::from_fn(|column| (100 * row + LANES * block + column) as u32))
        });
        let (mut columns, mut portable) = ([[[0; LANES]; LANES]; 2], [[[0; LANES]; LANES]; 2]);
        Vectorizer::default().transpose(rows.each_ref(), &mut columns);
        Transpose {
            rows: rows.each_ref(),
            columns: &mut portable,
        }
        .call(Portable);
        for columns in [columns, portable] {
            for (column, lanes) in columns.as_flattened().iter().enumerate() {
                assert_eq!(*lanes, std::array::from_fn(|row| (100 * row + column) as u32));
            }
        }
    }
}
