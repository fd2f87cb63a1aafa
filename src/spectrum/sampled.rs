//! The four-lane values that radiance, throughput and reflectance are carried in.

use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// How many wavelengths a path carries.
pub const LANES: usize = 4;

/// A spectral quantity at the four wavelengths of a path ([`Wavelengths`](super::Wavelengths)), or, in rgb mode, its
/// linear sRGB components and a zero. All arithmetic is lane by lane.
#[repr(C, align(16))]
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SampledSpectrum(pub [f32; LANES]);

impl SampledSpectrum {
    /// Zero in every lane.
    pub const ZERO: Self = Self::splat(0.0);
    /// One in every lane.
    pub const ONE: Self = Self::splat(1.0);

    /// The same value in every lane.
    #[inline]
    pub const fn splat(value: f32) -> Self {
        Self([value; LANES])
    }

    /// Whether every lane is zero.
    #[inline]
    pub fn is_black(self) -> bool {
        let [a, b, c, d] = self.0;
        (a == 0.0) & (b == 0.0) & (c == 0.0) & (d == 0.0)
    }

    /// The largest lane. NaN lanes are ignored unless all are NaN.
    #[inline]
    pub fn max_value(self) -> f32 {
        let [a, b, c, d] = self.0;
        a.max(b).max(c.max(d))
    }

    /// The smallest lane. NaN lanes are ignored unless all are NaN.
    #[inline]
    pub fn min_value(self) -> f32 {
        let [a, b, c, d] = self.0;
        a.min(b).min(c.min(d))
    }

    /// The mean of the lanes. It counts the unused fourth lane of rgb mode as well.
    #[inline]
    pub fn mean(self) -> f32 {
        let [a, b, c, d] = self.0;
        ((a + b) + (c + d)) * (1.0 / LANES as f32)
    }

    /// Whether no lane is infinite or NaN.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.0.iter().all(|v| v.is_finite())
    }

    /// Applies `f` to each lane.
    #[inline]
    pub fn map(self, f: impl Fn(f32) -> f32) -> Self {
        Self(self.0.map(f))
    }

    #[inline]
    fn zip(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i], other.0[i])))
    }

    /// Divides lane by lane; a lane whose divisor is zero gives zero.
    #[inline]
    pub fn safe_div(self, divisor: Self) -> Self {
        self.zip(divisor, |a, b| if b == 0.0 { 0.0 } else { a / b })
    }

    /// The square root of each lane.
    #[inline]
    pub fn sqrt(self) -> Self {
        self.map(f32::sqrt)
    }

    /// The exponential of each lane.
    #[inline]
    pub fn exp(self) -> Self {
        self.map(f32::exp)
    }

    /// Raises each lane to at least `low`; a NaN lane becomes `low`.
    #[inline]
    pub fn clamp_min(self, low: f32) -> Self {
        self.map(|v| v.max(low))
    }

    /// `self` at `t = 0`, `other` at `t = 1`, linear between and beyond.
    #[inline]
    pub fn lerp(self, other: Self, t: f32) -> Self {
        self.zip(other, |a, b| a * (1.0 - t) + b * t)
    }
}

impl Default for SampledSpectrum {
    fn default() -> Self {
        Self::ZERO
    }
}

impl Neg for SampledSpectrum {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        self.map(|v| -v)
    }
}

/// Implements one operator for spectrum op spectrum and spectrum op f32, and the assigning forms of both.
macro_rules! lane_operator {
    ($trait:ident, $method:ident, $assign_trait:ident, $assign_method:ident, $op:tt) => {
        impl $trait for SampledSpectrum {
            type Output = Self;
            #[inline]
            fn $method(self, other: Self) -> Self {
                self.zip(other, |a, b| a $op b)
            }
        }
        impl $trait<f32> for SampledSpectrum {
            type Output = Self;
            #[inline]
            fn $method(self, other: f32) -> Self {
                self.map(|a| a $op other)
            }
        }
        impl $assign_trait for SampledSpectrum {
            #[inline]
            fn $assign_method(&mut self, other: Self) {
                *self = *self $op other;
            }
        }
        impl $assign_trait<f32> for SampledSpectrum {
            #[inline]
            fn $assign_method(&mut self, other: f32) {
                *self = *self $op other;
            }
        }
    };
}

lane_operator!(Add, add, AddAssign, add_assign, +);
lane_operator!(Sub, sub, SubAssign, sub_assign, -);
lane_operator!(Mul, mul, MulAssign, mul_assign, *);
lane_operator!(Div, div, DivAssign, div_assign, /);

impl Mul<SampledSpectrum> for f32 {
    type Output = SampledSpectrum;
    #[inline]
    fn mul(self, other: SampledSpectrum) -> SampledSpectrum {
        other * self
    }
}

impl std::iter::Sum for SampledSpectrum {
    fn sum<I: Iterator<Item = Self>>(spectra: I) -> Self {
        spectra.fold(Self::ZERO, Add::add)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: SampledSpectrum = SampledSpectrum([1.0, 2.0, 4.0, 8.0]);
    const B: SampledSpectrum = SampledSpectrum([2.0, 0.0, 2.0, 4.0]);

    #[test]
    fn operators_act_on_each_lane() {
        assert_eq!((A + B).0, [3.0, 2.0, 6.0, 12.0]);
        assert_eq!((A - B).0, [-1.0, 2.0, 2.0, 4.0]);
        assert_eq!((A * B).0, [2.0, 0.0, 8.0, 32.0]);
        assert_eq!((B / A).0, [2.0, 0.0, 0.5, 0.5]);
        assert_eq!((2.0 * A).0, (A * 2.0).0);
        assert_eq!((A / 2.0).0, [0.5, 1.0, 2.0, 4.0]);
        let mut c = A;
        c += B;
        c *= 2.0;
        assert_eq!(c.0, [6.0, 4.0, 12.0, 24.0]);
        assert_eq!([A, B].into_iter().sum::<SampledSpectrum>(), A + B);
    }

    #[test]
    fn reductions_and_guards() {
        assert_eq!(A.safe_div(B).0, [0.5, 0.0, 2.0, 2.0]);
        assert_eq!((A.max_value(), A.min_value(), A.mean()), (8.0, 1.0, 3.75));
        assert!(SampledSpectrum::ZERO.is_black() && !B.is_black());
        assert!(A.is_finite() && !(A / B).is_finite());
        assert_eq!(A.lerp(B, 0.25).0, [1.25, 1.5, 3.5, 7.0]);
        assert_eq!((-A).clamp_min(-3.0).0, [-1.0, -2.0, -3.0, -3.0]);
        assert_eq!(std::mem::align_of::<SampledSpectrum>(), 16);
    }
}
