//! Eight numbers at a time: with vector instructions where the machine has them, and with the same bits where it has not.

use pulp::{Arch, NullaryFnOnce};

/// Numbers of a vector.
pub const EIGHT: usize = 8;

/// A set of instructions.
pub trait Simd: Copy {
    /// Eight numbers.
    type Vector: Copy;

    fn load(self, numbers: &[f32; EIGHT]) -> Self::Vector;
    fn store(self, v: Self::Vector) -> [f32; EIGHT];
    fn splat(self, x: f32) -> Self::Vector;
    fn add(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn sub(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn mul(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    /// The greater one, or `b` where one is no number.
    fn max(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    /// A bit for each lane of `a` that is at most that of `b`.
    fn at_most(self, a: Self::Vector, b: Self::Vector) -> u32;
    /// `a` where it is at most `b`, and 0 elsewhere.
    fn keep_at_most(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;

    /// `(x x + y y) + z z`
    #[inline(always)]
    fn length_squared(self, [x, y, z]: [Self::Vector; 3]) -> Self::Vector {
        self.add(self.add(self.mul(x, x), self.mul(y, y)), self.mul(z, z))
    }
}

/// A computation that is written for any set of instructions. Its `run` and all on its way want `#[inline(always)]`.
pub trait Task {
    fn run<S: Simd>(self, simd: S);
}

/// The best set of instructions that the machine has. Which it is is found out once: make one and copy it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Dispatch(Arch);

impl Dispatch {
    #[inline(always)]
    pub fn run<T: Task>(self, task: T) {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            Arch::V3(simd) => simd.vectorize(Compiled { simd, task }),
            _ => self.0.dispatch(Compiled { simd: Portable, task }),
        }
    }
}

/// A task that is compiled for a set of instructions.
struct Compiled<S, T> {
    simd: S,
    task: T,
}

impl<S: Simd, T: Task> NullaryFnOnce for Compiled<S, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.task.run(self.simd);
    }
}

/// Plain Rust, for any machine.
#[derive(Clone, Copy, Debug)]
pub struct Portable;

impl Simd for Portable {
    type Vector = [f32; EIGHT];

    #[inline(always)]
    fn load(self, numbers: &[f32; EIGHT]) -> Self::Vector {
        *numbers
    }

    #[inline(always)]
    fn store(self, v: Self::Vector) -> [f32; EIGHT] {
        v
    }

    #[inline(always)]
    fn splat(self, x: f32) -> Self::Vector {
        [x; EIGHT]
    }

    #[inline(always)]
    fn add(self, a: Self::Vector, b: Self::Vector) -> Self::Vector {
        std::array::from_fn(|i| a[i] + b[i])
    }

    #[inline(always)]
    fn sub(self, a: Self::Vector, b: Self::Vector) -> Self::Vector {
        std::array::from_fn(|i| a[i] - b[i])
    }

    #[inline(always)]
    fn mul(self, a: Self::Vector, b: Self::Vector) -> Self::Vector {
        std::array::from_fn(|i| a[i] * b[i])
    }

    #[inline(always)]
    fn max(self, a: Self::Vector, b: Self::Vector) -> Self::Vector {
        std::array::from_fn(|i| if a[i] > b[i] { a[i] } else { b[i] })
    }

    #[inline(always)]
    fn at_most(self, a: Self::Vector, b: Self::Vector) -> u32 {
        (0..EIGHT).map(|i| u32::from(a[i] <= b[i]) << i).sum()
    }

    #[inline(always)]
    fn keep_at_most(self, a: Self::Vector, b: Self::Vector) -> Self::Vector {
        std::array::from_fn(|i| if a[i] <= b[i] { a[i] } else { 0.0 })
    }
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use std::arch::x86_64::{__m256, _CMP_LE_OQ};

    use pulp::cast;
    use pulp::x86::V3;

    use super::{EIGHT, Simd};

    impl Simd for V3 {
        type Vector = __m256;

        #[inline(always)]
        fn load(self, numbers: &[f32; EIGHT]) -> __m256 {
            cast(*numbers)
        }

        #[inline(always)]
        fn store(self, v: __m256) -> [f32; EIGHT] {
            cast(v)
        }

        #[inline(always)]
        fn splat(self, x: f32) -> __m256 {
            self.avx._mm256_set1_ps(x)
        }

        #[inline(always)]
        fn add(self, a: __m256, b: __m256) -> __m256 {
            self.avx._mm256_add_ps(a, b)
        }

        #[inline(always)]
        fn sub(self, a: __m256, b: __m256) -> __m256 {
            self.avx._mm256_sub_ps(a, b)
        }

        #[inline(always)]
        fn mul(self, a: __m256, b: __m256) -> __m256 {
            self.avx._mm256_mul_ps(a, b)
        }

        #[inline(always)]
        fn max(self, a: __m256, b: __m256) -> __m256 {
            self.avx._mm256_max_ps(a, b)
        }

        #[inline(always)]
        fn at_most(self, a: __m256, b: __m256) -> u32 {
            self.avx._mm256_movemask_ps(self.avx._mm256_cmp_ps::<_CMP_LE_OQ>(a, b)) as u32
        }

        #[inline(always)]
        fn keep_at_most(self, a: __m256, b: __m256) -> __m256 {
            self.avx._mm256_and_ps(a, self.avx._mm256_cmp_ps::<_CMP_LE_OQ>(a, b))
        }
    }
}
