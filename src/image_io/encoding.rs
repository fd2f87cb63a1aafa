//! What the numbers of integer image formats mean.

use std::fmt::{Display, Formatter};

use super::srgb;

/// The curve from a stored value in [0, 1] to a linear one. Floating-point formats are linear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Encoding {
    /// That of sRGB.
    Srgb,
    /// None.
    Linear,
    /// A power; positive.
    Gamma(f32),
}

impl Encoding {
    /// From the names of pbrt-v4: `sRGB`, `linear`, `gamma 2.2`.
    pub fn from_name(name: &str) -> Option<Self> {
        match name.split_ascii_whitespace().collect::<Vec<_>>()[..] {
            ["sRGB"] => Some(Self::Srgb),
            ["linear"] => Some(Self::Linear),
            ["gamma", exponent] => {
                let exponent = exponent.parse::<f32>().ok()?;
                (exponent > 0.0 && exponent.is_finite()).then_some(Self::Gamma(exponent))
            }
            _ => None,
        }
    }

    /// The linear value of a stored one.
    pub fn decode(self, stored: f32) -> f32 {
        match self {
            Self::Srgb => srgb::decode(stored),
            Self::Linear => stored,
            Self::Gamma(exponent) => stored.powf(exponent),
        }
    }

    /// The linear values of all 8-bit codes.
    pub(super) fn decode_table(self) -> [f32; 256] {
        std::array::from_fn(|code| self.decode(code as f32 / 255.0))
    }
}

/// The name of pbrt-v4, which [`Encoding::from_name`] reads.
impl Display for Encoding {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Srgb => f.write_str("sRGB"),
            Self::Linear => f.write_str("linear"),
            Self::Gamma(exponent) => write!(f, "gamma {exponent}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_pbrt() {
        assert_eq!(Encoding::from_name("sRGB"), Some(Encoding::Srgb));
        assert_eq!(Encoding::from_name("linear"), Some(Encoding::Linear));
        assert_eq!(Encoding::from_name("gamma 2.2"), Some(Encoding::Gamma(2.2)));
        for encoding in [Encoding::Srgb, Encoding::Linear, Encoding::Gamma(2.2)] {
            assert_eq!(Encoding::from_name(&encoding.to_string()), Some(encoding));
        }
        for wrong in [
            "srgb",
            "gamma",
            "gamma 0",
            "gamma -1",
            "gamma x",
            "gamma inf",
            "gamma 2 2",
            "",
        ] {
            assert_eq!(Encoding::from_name(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn values_survive_a_round_trip() {
        for code in 0..=255_u8 {
            let stored = f32::from(code) / 255.0;
            assert_eq!(srgb::encode_u8(Encoding::Srgb.decode_table()[usize::from(code)]), code);
            assert_eq!(Encoding::Linear.decode(stored), stored);
            let back = Encoding::Gamma(2.2).decode(stored).powf(1.0 / 2.2);
            assert!((back - stored).abs() < 1e-6);
        }
        // 0.5 to the power 2.
        assert_eq!(Encoding::Gamma(2.0).decode(0.5), 0.25);
    }
}
