//! Weights of multiple importance sampling (Veach and Guibas 1995), for one sample from each of two techniques.
//!
//! Both densities are of the same point in the same measure, times the number of samples where that is not one. The
//! result is the weight itself, never weight / pdf.

/// The balance heuristic's weight of technique a: a / (a + b). A technique that cannot make the point (density 0) has
/// weight 0. Safe for densities that are infinite or whose sum overflows; both infinite share equally.
#[inline(always)]
pub fn balance_heuristic(pdf_a: f32, pdf_b: f32) -> f32 {
    weight(pdf_a, pdf_b, |ratio| ratio)
}

/// The power heuristic's weight of technique a, with exponent 2: a² / (a² + b²). Guarded like [`balance_heuristic`].
#[inline(always)]
pub fn power_heuristic(pdf_a: f32, pdf_b: f32) -> f32 {
    weight(pdf_a, pdf_b, |ratio| ratio * ratio)
}

/// 1 / (1 + f(b / a)): the quotient cannot overflow into NaN as the squares of the densities would.
#[inline(always)]
fn weight(pdf_a: f32, pdf_b: f32, f: impl Fn(f32) -> f32) -> f32 {
    let weight = 1.0 / (1.0 + f(pdf_b / pdf_a));
    let is_infinite = (pdf_a == f32::INFINITY) & (pdf_b == f32::INFINITY);
    let weight = if is_infinite { 0.5 } else { weight };
    if pdf_a == 0.0 { 0.0 } else { weight }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_the_formulas_and_sum_to_one() {
        assert_eq!(balance_heuristic(3.0, 1.0), 0.75);
        assert_eq!(power_heuristic(3.0, 1.0), 0.9);
        let densities = [1e-38, 1e-20, 0.3, 7.0, 1e20, 1e30, 3e38, f32::INFINITY];
        for a in densities {
            for b in densities {
                for heuristic in [balance_heuristic, power_heuristic] {
                    let sum = heuristic(a, b) + heuristic(b, a);
                    assert!((sum - 1.0).abs() < 1e-6, "{a} {b}: {sum}");
                }
            }
        }
    }

    #[test]
    fn an_impossible_technique_has_no_weight() {
        for heuristic in [balance_heuristic, power_heuristic] {
            assert_eq!(heuristic(0.0, 0.0), 0.0);
            assert_eq!(heuristic(0.0, f32::INFINITY), 0.0);
            assert_eq!(heuristic(1e-30, 0.0), 1.0);
            assert_eq!(heuristic(f32::INFINITY, 1.0), 1.0);
            assert_eq!(heuristic(1.0, f32::INFINITY), 0.0);
        }
    }
}
