//! Spaces of RGB colours: primaries, and the light that is white.

use std::sync::{Arc, LazyLock};

use glam::{DMat3, DVec3, Mat3, Vec3};

use super::cie::{self, DenseTable};
use super::named;

/// A space of linear RGB, as pbrt-v4's directive `ColorSpace` names them. (1, 1, 1) is its white: the illuminant of the space, with Y = 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ColorSpace {
    /// `srgb`: the primaries of ITU-R BT.709, white D65.
    #[default]
    Srgb,
    /// `dci-p3`: the primaries of DCI-P3 with the white D65, which is Display P3.
    DciP3,
    /// `rec2020`: ITU-R BT.2020, white D65.
    Rec2020,
    /// `aces2065-1`: SMPTE ST 2065-1, whose triangle holds all colours; white is that of ACES, about D60.
    Aces2065,
}

struct Space {
    illuminant: Arc<DenseTable>,
    xyz_from_rgb: DMat3,
    rgb_from_xyz: DMat3,
    /// Rows sum to 1.
    srgb_reflectance: Mat3,
}

static SPACES: [LazyLock<Space>; 4] = [
    LazyLock::new(|| Space::new(ColorSpace::Srgb)),
    LazyLock::new(|| Space::new(ColorSpace::DciP3)),
    LazyLock::new(|| Space::new(ColorSpace::Rec2020)),
    LazyLock::new(|| Space::new(ColorSpace::Aces2065)),
];

impl Space {
    /// Scales the primaries so that (1, 1, 1) has the colour of the illuminant and Y = 1.
    fn new(space: ColorSpace) -> Self {
        let illuminant = match space {
            ColorSpace::Aces2065 => Arc::new(named::dense("illum-acesD60")),
            _ => named::d65().clone(),
        };
        let white = DVec3::from(cie::integrate_xyz(|nm| illuminant.at(nm)));
        let white = white / white.y;
        let primaries = space.primaries().map(|[x, y]| DVec3::new(x, y, 1.0 - x - y));
        let primaries = DMat3::from_cols(primaries[0], primaries[1], primaries[2]);
        let xyz_from_rgb = primaries * DMat3::from_diagonal(primaries.inverse() * white);
        Self {
            illuminant,
            xyz_from_rgb,
            rgb_from_xyz: xyz_from_rgb.inverse(),
            srgb_reflectance: match space {
                ColorSpace::Srgb => Mat3::IDENTITY,
                _ => {
                    let srgb = ColorSpace::Srgb.rgb_from_xyz() * xyz_from_rgb;
                    let white = srgb * DVec3::ONE;
                    (DMat3::from_diagonal(white.recip()) * srgb).as_mat3()
                }
            },
        }
    }
}

impl ColorSpace {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Srgb, Self::DciP3, Self::Rec2020, Self::Aces2065];

    /// The name in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Srgb => "srgb",
            Self::DciP3 => "dci-p3",
            Self::Rec2020 => "rec2020",
            Self::Aces2065 => "aces2065-1",
        }
    }

    /// The inverse of [`Self::name`].
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|space| space.name() == name)
    }

    /// Chromaticities (x, y) of red, green and blue.
    pub fn primaries(self) -> [[f64; 2]; 3] {
        match self {
            Self::Srgb => [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]],
            Self::DciP3 => [[0.680, 0.320], [0.265, 0.690], [0.150, 0.060]],
            Self::Rec2020 => [[0.708, 0.292], [0.170, 0.797], [0.131, 0.046]],
            Self::Aces2065 => [[0.7347, 0.2653], [0.0, 1.0], [0.0001, -0.0770]],
        }
    }

    /// The chromaticity of white.
    pub fn white(self) -> [f64; 2] {
        let [x, y, z] = self.rgb_to_xyz([1.0; 3]);
        [x / (x + y + z), y / (x + y + z)]
    }

    /// Linear RGB of an XYZ; linear, so the scale of the input is that of the output. Components are negative for colours
    /// outside the gamut.
    pub fn xyz_to_rgb(self, xyz: [f64; 3]) -> [f64; 3] {
        (self.rgb_from_xyz() * DVec3::from(xyz)).into()
    }

    /// XYZ of linear RGB: (1, 1, 1) gives the white with Y = 1.
    pub fn rgb_to_xyz(self, rgb: [f64; 3]) -> [f64; 3] {
        (self.xyz_from_rgb() * DVec3::from(rgb)).into()
    }

    /// Linear sRGB of a reflectance in linear RGB of this space, with the white of one for that of the other: (1, 1, 1) gives (1, 1, 1).
    pub fn reflectance_to_srgb(self, rgb: [f32; 3]) -> [f32; 3] {
        (self.space().srgb_reflectance * Vec3::from(rgb)).into()
    }

    /// The space of these chromaticities (x, y) of red, green, blue and white, each coordinate to a thousandth of its value as in
    /// pbrt-v4; `None` if it is none of those that have names.
    pub fn from_chromaticities(chromaticities: [[f32; 2]; 4]) -> Option<Self> {
        let close = |a: f64, b: f64| a == b || ((a - b) / b).abs() < 1e-3;
        Self::ALL.into_iter().find(|space| {
            let [red, green, blue] = space.primaries();
            let own = [red, green, blue, space.white()].into_iter().flatten();
            let given = chromaticities.into_iter().flatten().map(f64::from);
            given.zip(own).all(|(a, b)| close(a, b))
        })
    }

    /// The matrix of [`Self::xyz_to_rgb`].
    pub fn rgb_from_xyz(self) -> DMat3 {
        self.space().rgb_from_xyz
    }

    /// The matrix of [`Self::rgb_to_xyz`].
    pub fn xyz_from_rgb(self) -> DMat3 {
        self.space().xyz_from_rgb
    }

    /// The light that is white at a wavelength in nm, with the luminance of a constant 1.
    pub fn white_at(self, nm: f32) -> f32 {
        self.illuminant().at(nm)
    }

    /// The light that is white, by nm, with the luminance of a constant 1.
    pub(super) fn illuminant(self) -> &'static Arc<DenseTable> {
        &self.space().illuminant
    }

    fn space(self) -> &'static Space {
        &SPACES[self as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matrices_are_the_published_ones() {
        // By rows, XYZ of RGB: SMPTE EG 432-1 and ITU-R BT.2020 for a white of x = 0.3127, y = 0.3290; SMPTE ST 2065-1.
        let published = [
            (
                ColorSpace::DciP3,
                [
                    [0.48657, 0.26567, 0.19822],
                    [0.22897, 0.69174, 0.07929],
                    [0.0, 0.04511, 1.04394],
                ],
            ),
            (
                ColorSpace::Rec2020,
                [
                    [0.63696, 0.14462, 0.16888],
                    [0.26270, 0.67800, 0.05930],
                    [0.0, 0.02807, 1.06099],
                ],
            ),
            (
                ColorSpace::Aces2065,
                [
                    [0.95255, 0.0, 0.00009],
                    [0.34397, 0.72817, -0.07213],
                    [0.0, 0.0, 1.00883],
                ],
            ),
        ];
        for (space, rows) in published {
            let ours = space.xyz_from_rgb().transpose().to_cols_array_2d();
            for (row, expected) in ours.iter().zip(&rows) {
                for (a, b) in row.iter().zip(expected) {
                    assert!((a - b).abs() < 1e-3, "{space:?}: {row:?} and {expected:?}");
                }
            }
        }
    }

    #[test]
    fn whites_are_those_of_the_illuminants() {
        for (space, white) in [
            (ColorSpace::Srgb, [0.3127, 0.3290]),
            (ColorSpace::DciP3, [0.3127, 0.3290]),
            (ColorSpace::Rec2020, [0.3127, 0.3290]),
            (ColorSpace::Aces2065, [0.32168, 0.33767]),
        ] {
            let found = space.white();
            assert!(
                (found[0] - white[0]).abs() < 1e-4 && (found[1] - white[1]).abs() < 1e-4,
                "{space:?}: {found:?}"
            );
            assert_eq!(ColorSpace::from_name(space.name()), Some(space));
            let xyz = cie::integrate_xyz(|nm| space.illuminant().at(nm) / cie::y_integral());
            assert!(space.xyz_to_rgb(xyz).iter().all(|c| (c - 1.0).abs() < 1e-5));
        }
        assert_eq!(ColorSpace::from_name("p3"), None);
    }

    #[test]
    fn spaces_are_known_by_their_chromaticities() {
        for space in ColorSpace::ALL {
            let [red, green, blue] = space.primaries();
            let rounded = |xy: [f64; 2]| xy.map(|c| (c * 1e4).round() as f32 / 1e4);
            let given = [red, green, blue, space.white()].map(rounded);
            assert_eq!(ColorSpace::from_chromaticities(given), Some(space));
            let mut other = given;
            other[2][0] += 0.01;
            assert_eq!(ColorSpace::from_chromaticities(other), None);
        }
        // ACEScg.
        let other = [[0.713, 0.293], [0.165, 0.830], [0.128, 0.044], [0.32168, 0.33767]];
        assert_eq!(ColorSpace::from_chromaticities(other), None);
    }
}
