//! Wider vector instructions than the compiler may take for granted.

use pulp::Arch;
/// A computation for [`Vectorizer::run`]. Its `call` and all on its way want `#[inline(always)]`: what is not inlined is compiled for any
/// machine.
pub use pulp::NullaryFnOnce as Kernel;

/// Runs loops over lanes with the widest vectors that the machine has. Which ones it has is found out once: make one and copy it.
///
/// The compiler turns plain loops over arrays into such instructions, so that the code within is ordinary, and its results are those
/// of any machine: without contraction of products and sums, vectors round as scalars do.
#[derive(Clone, Copy, Debug, Default)]
pub struct Vectorizer(Arch);

impl Vectorizer {
    /// Calls `kernel`, compiled for what the machine has.
    #[inline(always)]
    pub fn run<K: Kernel>(self, kernel: K) -> K::Output {
        self.0.dispatch(kernel)
    }

    /// The instructions that it runs them with.
    #[inline(always)]
    pub(super) fn arch(self) -> Arch {
        self.0
    }
}
