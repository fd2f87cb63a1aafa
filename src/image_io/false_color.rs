//! Magnitudes as colours.

/// From the least magnitude to the greatest, linear RGB.
const COLORS: [[f32; 3]; 7] = [
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.6],
    [0.0, 0.5, 0.7],
    [0.0, 0.6, 0.1],
    [0.9, 0.8, 0.0],
    [0.8, 0.05, 0.0],
    [1.0, 1.0, 1.0],
];
/// The least magnitude that is told from 0, of the greatest.
const RANGE: f32 = 1e-3;
/// The share of pixels that may be brighter than the greatest magnitude.
const OUTLIERS: f64 = 1e-3;

/// Replaces linear RGB pixels by colours that tell the logarithm of their mean.
pub fn false_colors(pixels: &mut [f32]) {
    let mean = |rgb: &[f32]| (rgb.iter().sum::<f32>() / 3.0).max(0.0);
    let mut sorted: Vec<f32> = pixels.chunks_exact(3).map(mean).collect();
    sorted.sort_unstable_by(f32::total_cmp);
    let outliers = (OUTLIERS * sorted.len() as f64) as usize;
    let most = sorted.iter().rev().nth(outliers).copied().unwrap_or(0.0);
    for rgb in pixels.chunks_exact_mut(3) {
        rgb.copy_from_slice(&color(mean(rgb) / most));
    }
}

/// The colour of a magnitude, of the greatest.
fn color(magnitude: f32) -> [f32; 3] {
    let steps = (COLORS.len() - 1) as f32;
    let place = (1.0 - magnitude.ln() / RANGE.ln()) * steps;
    // No number where all is black.
    if place.is_nan() || place <= 0.0 {
        return COLORS[0];
    }
    let index = (place as usize).min(COLORS.len() - 2);
    let fraction = (place - index as f32).min(1.0);
    let (a, b) = (COLORS[index], COLORS[index + 1]);
    std::array::from_fn(|i| a[i] + fraction * (b[i] - a[i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_tell_magnitudes() {
        // A thousand pixels: the brightest is an outlier, the next one is the greatest magnitude.
        let mut pixels = vec![0.0; 3000];
        pixels[..3].copy_from_slice(&[100.0; 3]);
        pixels[3..6].copy_from_slice(&[8.0; 3]);
        pixels[6..9].copy_from_slice(&[8e-3; 3]);
        pixels[9..12].copy_from_slice(&[8.0 * RANGE.sqrt(); 3]);
        false_colors(&mut pixels);
        let expected = [COLORS[6], COLORS[6], COLORS[0], COLORS[3], COLORS[0]];
        for (rgb, expected) in pixels.chunks(3).zip(expected) {
            assert!(
                rgb.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-4),
                "{rgb:?} {expected:?}"
            );
        }
        let mut black = vec![0.0; 30];
        false_colors(&mut black);
        assert!(black.iter().all(|&v| v == 0.0));
    }
}
