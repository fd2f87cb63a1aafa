//! Elementary functions without calls and branches, which the standard library's have: so that loops over lanes become vectors. Their
//! polynomials are least maximum fits of the functions in double precision.

use std::f32::consts::{FRAC_1_SQRT_2, LN_2, LOG2_E};

/// What a number of moderate size is added to to round it to an integer, which the lowest bits of the sum are.
const TO_INTEGER: f32 = 12_582_912.0;

/// The value of a polynomial, whose coefficients begin with the constant.
#[inline(always)]
fn polynomial<const N: usize>(coefficients: [f32; N], x: f32) -> f32 {
    let mut sum = coefficients[N - 1];
    for i in 1..N {
        sum = sum * x + coefficients[N - 1 - i];
    }
    sum
}

/// e to the power `-t`, for `t` not negative: 0 from 87 on, else with a relative error below 1.5e-7.
#[inline(always)]
pub fn exp_minus(t: f32) -> f32 {
    /// ln 2, to few enough bits that their product with an exponent is exact, and the rest.
    const LN_2_HIGH: f32 = 0.693_359_4;
    const LN_2_LOW: f32 = -2.121_944_4e-4;
    let x = -t;
    let shifted = x * LOG2_E + TO_INTEGER;
    let power = shifted - TO_INTEGER;
    let r = x - power * LN_2_HIGH - power * LN_2_LOW;
    let tail = polynomial(
        [0.499_999_93, 0.166_665_2, 0.041_668_39, 0.008_368_736, 0.001_381_455_8],
        r,
    );
    let scale = f32::from_bits(shifted.to_bits().wrapping_shl(23).wrapping_add(1.0_f32.to_bits()));
    let value = (1.0 + (r + r * r * tail)) * scale;
    if t < 87.0 { value } else { 0.0 }
}

/// The natural logarithm of a positive number, not subnormal: with a relative error below 2e-7.
#[inline(always)]
pub fn ln(x: f32) -> f32 {
    const C: [f32; 8] = [
        0.333_333_3,
        -0.250_008_2,
        0.200_012_27,
        -0.166_233_56,
        0.142_017_63,
        -0.131_601_95,
        0.127_615_5,
        -0.076_344_3,
    ];
    // To a factor between the square roots of 1/2 and of 2.
    let bits = x.to_bits() as i32;
    let exponent = (bits - FRAC_1_SQRT_2.to_bits() as i32) >> 23;
    let f = f32::from_bits((bits - (exponent << 23)) as u32) - 1.0;
    let f2 = f * f;
    let tail = f * f2 * polynomial(C, f) - 0.5 * f2;
    exponent as f32 * LN_2 + (f + tail)
}

/// The complementary error function times e to the power `x²`, for `x` in [0, 5]: with a relative error below 4.5e-7.
#[inline(always)]
pub fn scaled_erfc(x: f32) -> f32 {
    const C: [f32; 8] = [
        0.224_928_43,
        0.236_594_75,
        0.139_447_06,
        0.407_883_7,
        -0.370_406_6,
        0.679_343_5,
        -0.391_246_85,
        0.073_455_92,
    ];
    let t = 1.0 / (1.0 + 0.4 * x);
    t * polynomial(C, t)
}

/// The number whose error function is `z - 1`, for `z` in [1e-11, 2): with a relative error below 1e-6. The inner and
/// the outer polynomial are in what Giles 2012, "Approximating the erfinv function", has them in.
#[inline(always)]
pub fn inverse_erf_of_less_one(z: f32) -> f32 {
    const INNER: [f32; 9] = [
        1.501_409_4,
        0.246_640_73,
        -0.004_177_707_7,
        -0.001_253_705_7,
        0.000_218_602_14,
        -4.396_690_8e-6,
        -3.528_829_4e-6,
        3.437_167_2e-7,
        2.853_111e-8,
    ];
    const OUTER: [f32; 9] = [
        3.436_251_9,
        1.007_959,
        0.002_744_998_8,
        -0.001_639_759_6,
        0.000_722_750_27,
        -0.000_530_269,
        0.000_400_323_13,
        -0.000_147_705_73,
        0.000_017_029_007,
    ];
    let w = -ln(z * (2.0 - z));
    let is_inner = w < 5.0;
    let t = if is_inner { w - 2.5 } else { w.sqrt() - 3.6 };
    let mut sum = 0.0;
    for i in (0..INNER.len()).rev() {
        sum = sum * t + if is_inner { INNER[i] } else { OUTER[i] };
    }
    sum * (z - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use statrs::function::erf;

    /// Points from `low` to `high`, as many a factor of e wherever that is.
    fn geometric(low: f64, high: f64) -> impl Iterator<Item = f32> {
        let steps = 400_000;
        (0..=steps).map(move |i| (low * (high / low).powf(f64::from(i) / f64::from(steps))) as f32)
    }

    fn worst(points: impl Iterator<Item = f32>, error: impl Fn(f32) -> f64) -> f64 {
        points.map(error).fold(0.0, f64::max)
    }

    #[test]
    fn functions_are_as_exact_as_they_say() {
        let relative = |value: f32, right: f64| (f64::from(value) / right - 1.0).abs();
        let e = worst(geometric(1e-10, 86.99), |t| {
            relative(exp_minus(t), (-f64::from(t)).exp())
        });
        assert!(e < 1.5e-7, "exp: {e:e}");
        let away_from_1 = geometric(1.2e-38, 3.4e38).filter(|&x| x != 1.0);
        let near_1 = geometric(0.99, 1.01).filter(|&x| x != 1.0);
        let e = worst(away_from_1.chain(near_1), |x| relative(ln(x), f64::from(x).ln()));
        assert!(e < 2e-7, "ln: {e:e}");
        let scaled = |x: f64| (x * x).exp() * erf::erfc(x);
        let e = worst(geometric(1e-6, 5.0), |x| relative(scaled_erfc(x), scaled(f64::from(x))));
        assert!(e < 4.5e-7, "erfc: {e:e}");
        let inverse = |z: f64| {
            if z < 1.0 {
                -erf::erfc_inv(z)
            } else {
                erf::erfc_inv(2.0 - z)
            }
        };
        let e = worst(geometric(1e-11, 1.999_999_8).filter(|&z| z != 1.0), |z| {
            relative(inverse_erf_of_less_one(z), inverse(f64::from(z)))
        });
        assert!(e < 1e-6, "inverse erf: {e:e}");
    }

    #[test]
    fn ends_are_what_they_are() {
        assert_eq!(
            [exp_minus(0.0), exp_minus(87.0), exp_minus(f32::INFINITY)],
            [1.0, 0.0, 0.0]
        );
        assert_eq!(ln(1.0), 0.0);
        assert!((scaled_erfc(0.0) - 1.0).abs() < 3e-7);
        assert_eq!(inverse_erf_of_less_one(1.0), 0.0);
    }
}
