//! What is kept of a photon, in 32 bytes.

use crate::math::{Vec2, Vec3};
use crate::spectrum::{LANES, SampledSpectrum};

/// A photon where it met a surface.
///
/// | bytes | what | error |
/// |---|---|---|
/// | 12 | position, three `f32` | none |
/// | 8 + 2 | power at the four wavelengths of its pass: four mantissas, one exponent | 2^-16 of the largest of the four |
/// | 4 | incident direction, by an octahedral map at 2 x 16 bits (Cigolle et al. 2014) | 7e-5 radians |
/// | 4 | geometric normal, likewise | 7e-5 radians |
/// | 2 | scattering events before this one; whether its secondary wavelengths have ended | events beyond 32,767 count as that many |
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Photon {
    p: [f32; 3],
    mantissas: [u16; LANES],
    wi: [u16; 2],
    ng: [u16; 2],
    exponent: i16,
    /// The number of scattering events; the topmost bit says that only the hero is left.
    history: u16,
}

const _: () = assert!(size_of::<Photon>() == 32);

const HERO_ONLY: u16 = 1 << 15;

impl Photon {
    /// A photon at `p` that came from direction `wi` (unit length, away from the surface) to a surface of geometric normal `ng`,
    /// after `depth` scattering events. `power` is that of the whole emission: it counts divided by the number of photons emitted.
    /// `hero_only` says that a dispersive surface has ended its secondary wavelengths; the hero's power is not raised for it.
    ///
    /// `None` if its power is black, negative or not finite.
    pub fn new(p: Vec3, wi: Vec3, ng: Vec3, power: SampledSpectrum, depth: u32, hero_only: bool) -> Option<Self> {
        let largest = power.max_value();
        if !(largest >= f32::MIN_POSITIVE && power.is_finite() && power.min_value() >= 0.0 && p.is_finite()) {
            return None;
        }
        // largest = m 2^exponent with m in [0.5, 1).
        let exponent = (largest.to_bits() >> 23) as i16 - 126;
        let scale = 2.0_f64.powi(16 - i32::from(exponent));
        let mantissas = power.0.map(|v| (f64::from(v) * scale).round().min(65_535.0) as u16);
        let mut history = depth.min(u32::from(HERO_ONLY - 1)) as u16;
        if hero_only {
            history |= HERO_ONLY;
        }
        Some(Self {
            p: p.to_array(),
            mantissas,
            wi: encode(wi),
            ng: encode(ng),
            exponent,
            history,
        })
    }

    /// Where it met the surface.
    #[inline]
    pub fn p(&self) -> Vec3 {
        self.p.into()
    }

    /// See [`Photon::new`]; in W·nm⁻¹.
    #[inline]
    pub fn power(&self) -> SampledSpectrum {
        let scale = f64::from_bits(((i64::from(self.exponent) - 16 + 1023) as u64) << 52);
        SampledSpectrum(self.mantissas.map(|m| (f64::from(m) * scale) as f32))
    }

    /// Where it came from: a unit vector away from the surface.
    #[inline]
    pub fn wi(&self) -> Vec3 {
        decode(self.wi)
    }

    /// The geometric normal of the surface, unit length.
    #[inline]
    pub fn ng(&self) -> Vec3 {
        decode(self.ng)
    }

    /// Scattering events before this one.
    #[inline]
    pub fn depth(&self) -> u32 {
        u32::from(self.history & !HERO_ONLY)
    }

    /// Whether its secondary wavelengths have ended.
    #[inline]
    pub fn is_hero_only(&self) -> bool {
        self.history & HERO_ONLY != 0
    }
}

/// The sphere is projected onto an octahedron, and its lower half folded out to the corners of the square.
fn encode(w: Vec3) -> [u16; 2] {
    let sum = w.x.abs() + w.y.abs() + w.z.abs();
    let upper = Vec2::new(w.x, w.y) / sum;
    let square = if w.z >= 0.0 { upper } else { folded(upper) };
    square
        .to_array()
        .map(|x| ((0.5 * x + 0.5) * 65_536.0).clamp(0.0, 65_535.0) as u16)
}

#[inline]
fn decode(square: [u16; 2]) -> Vec3 {
    let square = Vec2::from(square.map(|x| (2.0 * f32::from(x) + 1.0) / 65_536.0 - 1.0));
    let z = 1.0 - square.x.abs() - square.y.abs();
    let plane = if z >= 0.0 { square } else { folded(square) };
    plane.extend(z).normalize()
}

/// The triangle of the square that belongs to the lower half, exchanged with its image in the upper.
#[inline]
fn folded(p: Vec2) -> Vec2 {
    Vec2::new((1.0 - p.y.abs()).copysign(p.x), (1.0 - p.x.abs()).copysign(p.y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::warp::equal_area_square_to_sphere;
    use crate::sampling::{Sampler, SamplerKind};

    #[test]
    fn what_is_kept_is_as_exact_as_stated() {
        let sampler = Sampler::new(SamplerKind::Independent, 5, 4096);
        for i in 0..4096 {
            let stream = sampler.start(0, 0, i);
            let [a, b, c, d] = stream.draw4(0);
            let w = equal_area_square_to_sphere(Vec2::new(a, b));
            let ng = equal_area_square_to_sphere(Vec2::new(c, d));
            let [e, f, g, h] = stream.draw4(1);
            // From 1e-30 to 1e30.
            let magnitude = 10.0_f32.powf(60.0 * stream.draw1(2) - 30.0);
            let power = SampledSpectrum([e, f * f, g.powi(4), h.powi(8)]) * magnitude;
            let photon = Photon::new(Vec3::new(a, -b, c), w, ng, power, i, i % 2 == 1).expect("it has power");
            assert_eq!(photon.p(), Vec3::new(a, -b, c));
            assert_eq!((photon.depth(), photon.is_hero_only()), (i, i % 2 == 1));
            assert!((photon.wi() - w).length() < 7e-5, "{w}: {}", photon.wi());
            assert!((photon.ng() - ng).length() < 7e-5);
            assert!((photon.wi().length() - 1.0).abs() < 1e-6);
            let allowed = power.max_value() / 65_536.0;
            for (kept, value) in photon.power().0.iter().zip(power.0) {
                assert!((kept - value).abs() <= allowed, "{value} became {kept} of {power:?}");
            }
        }
    }

    #[test]
    fn rounding_keeps_the_mean() {
        // A component of a hundredth of the largest: rounding to nearest has no bias that its sum would show.
        let sampler = Sampler::new(SamplerKind::Sobol, 1, 1 << 14);
        let (mut exact, mut kept) = (0.0_f64, 0.0_f64);
        for i in 0..1 << 14 {
            let small = 0.01 * sampler.start(0, 0, i).draw1(0);
            let power = SampledSpectrum([1.0, small, 0.0, 0.0]);
            let photon = Photon::new(Vec3::ZERO, Vec3::Z, Vec3::Z, power, 0, false).expect("it has power");
            exact += f64::from(small);
            kept += f64::from(photon.power().0[1]);
        }
        assert!((kept / exact - 1.0).abs() < 1e-5);
    }

    #[test]
    fn what_cannot_be_kept_is_refused() {
        let photon = |p, power| Photon::new(p, Vec3::Z, Vec3::Z, power, 0, false);
        assert_eq!(photon(Vec3::ZERO, SampledSpectrum::ZERO), None);
        assert_eq!(photon(Vec3::ZERO, SampledSpectrum([1.0, f32::NAN, 0.0, 0.0])), None);
        assert_eq!(
            photon(Vec3::ZERO, SampledSpectrum([f32::INFINITY, 0.0, 0.0, 0.0])),
            None
        );
        assert_eq!(photon(Vec3::ZERO, SampledSpectrum([1.0, -1e-9, 0.0, 0.0])), None);
        assert_eq!(photon(Vec3::NAN, SampledSpectrum::ONE), None);
        let many = photon(Vec3::ZERO, SampledSpectrum::ONE).map(|_| {
            Photon::new(Vec3::ZERO, Vec3::Z, Vec3::Z, SampledSpectrum::ONE, u32::MAX, true).map(|p| p.depth())
        });
        assert_eq!(many, Some(Some(32_767)));
    }
}
