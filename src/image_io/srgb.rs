//! The transfer curve of sRGB (IEC 61966-2-1): a line near black, a power of 2.4 above.

/// The encoded value in [0, 1] of a linear one; what is outside [0, 1] is clamped, NaN is 0.
pub fn encode(linear: f32) -> f32 {
    // `max` and `min` return the other operand for NaN.
    let linear = linear.max(0.0).min(1.0);
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    }
}

/// The linear value of an encoded one in [0, 1].
pub fn decode(encoded: f32) -> f32 {
    if encoded <= 0.040_45 {
        encoded / 12.92
    } else {
        ((encoded + 0.055) / 1.055).powf(2.4)
    }
}

/// The nearest 8-bit code of a linear value.
pub fn encode_u8(linear: f32) -> u8 {
    // In [0.5, 255.5], so truncation rounds to nearest.
    (encode(linear) * 255.0 + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_survive_a_round_trip() {
        for code in 0..=255_u8 {
            assert_eq!(encode_u8(decode(f32::from(code) / 255.0)), code);
        }
    }

    #[test]
    fn known_values() {
        // From the definition: 0.18 -> 0.4613561 -> 117.6; 0.5 -> 0.7353569 -> 187.5; the line: 0.002 -> 0.02584 -> 6.59.
        for (linear, encoded, code) in [
            (0.18, 0.461_356_1, 118),
            (0.5, 0.735_356_9, 188),
            (0.002, 0.025_84, 7),
            (1.0, 1.0, 255),
            (0.0, 0.0, 0),
        ] {
            assert!((encode(linear) - encoded).abs() < 1e-6, "{linear}");
            assert_eq!(encode_u8(linear), code);
        }
    }

    #[test]
    fn out_of_range_is_clamped() {
        for (linear, code) in [
            (f32::NAN, 0),
            (f32::INFINITY, 255),
            (-1.0, 0),
            (7.0, 255),
            (f32::NEG_INFINITY, 0),
        ] {
            assert_eq!(encode_u8(linear), code);
        }
    }
}
