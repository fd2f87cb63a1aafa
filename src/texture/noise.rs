//! Gradient noise (Perlin 2002, "Improving Noise"), and sums of its octaves that leave out what is finer than the footprint.

use super::mapping::Coordinates3;
use crate::math::Vec3;

/// Perlin's permutation of 0 to 255.
#[rustfmt::skip]
const PERMUTATION: [u8; 256] = [
    151, 160, 137, 91, 90, 15, 131, 13, 201, 95, 96, 53, 194, 233, 7, 225,
    140, 36, 103, 30, 69, 142, 8, 99, 37, 240, 21, 10, 23, 190, 6, 148,
    247, 120, 234, 75, 0, 26, 197, 62, 94, 252, 219, 203, 117, 35, 11, 32,
    57, 177, 33, 88, 237, 149, 56, 87, 174, 20, 125, 136, 171, 168, 68, 175,
    74, 165, 71, 134, 139, 48, 27, 166, 77, 146, 158, 231, 83, 111, 229, 122,
    60, 211, 133, 230, 220, 105, 92, 41, 55, 46, 245, 40, 244, 102, 143, 54,
    65, 25, 63, 161, 1, 216, 80, 73, 209, 76, 132, 187, 208, 89, 18, 169,
    200, 196, 135, 130, 116, 188, 159, 86, 164, 100, 109, 198, 173, 186, 3, 64,
    52, 217, 226, 250, 124, 123, 5, 202, 38, 147, 118, 126, 255, 82, 85, 212,
    207, 206, 59, 227, 47, 16, 58, 17, 182, 189, 28, 42, 223, 183, 170, 213,
    119, 248, 152, 2, 44, 154, 163, 70, 221, 153, 101, 155, 167, 43, 172, 9,
    129, 22, 39, 253, 19, 98, 108, 110, 79, 113, 224, 232, 178, 185, 112, 104,
    218, 246, 97, 228, 251, 34, 242, 193, 238, 210, 144, 12, 191, 179, 162, 241,
    81, 51, 145, 235, 249, 14, 239, 107, 49, 192, 214, 31, 181, 199, 106, 157,
    184, 84, 204, 176, 115, 121, 50, 45, 127, 4, 150, 254, 138, 236, 205, 93,
    222, 114, 67, 29, 24, 72, 243, 141, 128, 195, 78, 66, 215, 61, 156, 180,
];

/// Between octaves the frequency grows by this, just off 2 so that their zeros do not coincide.
const LACUNARITY: f32 = 1.99;
/// The mean magnitude of noise, about.
const MEAN_MAGNITUDE: f32 = 0.2;

/// Noise at a point: 0 where all coordinates are integers, between them in [-1, 1], with two continuous derivatives.
pub fn noise(p: Vec3) -> f32 {
    // Beyond 2^30 there are no fractions anyway; so that cells are integers.
    let p = p % Vec3::splat((1 << 30) as f32);
    let cell = p.floor();
    let d = p - cell;
    let corner = [cell.x as i32, cell.y as i32, cell.z as i32];
    let gradient = |i: i32, j: i32, k: i32| {
        let offset = d - Vec3::new(i as f32, j as f32, k as f32);
        gradient([corner[0] + i, corner[1] + j, corner[2] + k], offset)
    };
    let fade = |t: f32| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let (x, y, z) = (fade(d.x), fade(d.y), fade(d.z));
    let lerp = |t: f32, a: f32, b: f32| (1.0 - t) * a + t * b;
    let edge = |j, k| lerp(x, gradient(0, j, k), gradient(1, j, k));
    let face = |k| lerp(y, edge(0, k), edge(1, k));
    lerp(z, face(0), face(1))
}

/// The dot product of an offset with the gradient of a corner of a cell: one of 12 directions to the edges of a cube.
fn gradient(corner: [i32; 3], offset: Vec3) -> f32 {
    let permuted = |i: usize| usize::from(PERMUTATION[i & 255]);
    let [x, y, z] = corner.map(|c| (c & 255) as usize);
    // The sums wrap around at 256, as a doubled table would.
    let h = permuted(permuted(permuted(x) + y) + z) & 15;
    let u = if h < 8 || h == 12 || h == 13 {
        offset.x
    } else {
        offset.y
    };
    let v = if h < 4 || h == 12 || h == 13 {
        offset.y
    } else {
        offset.z
    };
    let signed = |w: f32, negative: bool| if negative { -w } else { w };
    signed(u, h & 1 != 0) + signed(v, h & 2 != 0)
}

/// How many octaves are coarser than the footprint, whole and in part.
fn octaves_in(c: &Coordinates3, most: u32) -> (u32, f32) {
    let footprint = c.dpdx.length_squared().max(c.dpdy.length_squared());
    let octaves = (-1.0 - 0.5 * footprint.log2()).clamp(0.0, most as f32);
    (octaves as u32, octaves.fract())
}

/// From 0 below 0.3 to 1 above 0.7.
fn fade_in(part: f32) -> f32 {
    let t = ((part - 0.3) / 0.4).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The sum of at most `octaves` octaves of noise, each `roughness` times the one before.
pub fn fbm(c: &Coordinates3, roughness: f32, octaves: u32) -> f32 {
    let (whole, part) = octaves_in(c, octaves);
    let (mut sum, mut frequency, mut weight) = (0.0, 1.0, 1.0);
    for _ in 0..whole {
        sum += weight * noise(c.p * frequency);
        frequency *= LACUNARITY;
        weight *= roughness;
    }
    sum + weight * fade_in(part) * noise(c.p * frequency)
}

/// [`fbm`] of the noise's magnitude; octaves that are left out count with their mean.
pub fn turbulence(c: &Coordinates3, roughness: f32, octaves: u32) -> f32 {
    let (whole, part) = octaves_in(c, octaves);
    let (mut sum, mut frequency, mut weight) = (0.0, 1.0, 1.0);
    for _ in 0..whole {
        sum += weight * noise(c.p * frequency).abs();
        frequency *= LACUNARITY;
        weight *= roughness;
    }
    let fade = fade_in(part);
    sum += weight * ((1.0 - fade) * MEAN_MAGNITUDE + fade * noise(c.p * frequency).abs());
    for _ in whole..octaves {
        sum += weight * MEAN_MAGNITUDE;
        weight *= roughness;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(p: Vec3, footprint: f32) -> Coordinates3 {
        Coordinates3 {
            p,
            dpdx: Vec3::new(footprint, 0.0, 0.0),
            dpdy: Vec3::new(0.0, footprint, 0.0),
        }
    }

    #[test]
    fn noise_is_zero_on_the_lattice_and_has_its_gradients_there() {
        for (x, y, z) in [(0.0, 0.0, 0.0), (3.0, -2.0, 7.0), (255.0, 256.0, -1.0)] {
            assert_eq!(noise(Vec3::new(x, y, z)), 0.0);
        }
        // At the origin h = perm[perm[perm[0]]] & 15 = perm[perm[151]] & 15 = perm[17] & 15 = 36 & 15 = 4: u = x, v = z.
        let step = 1e-3;
        let slope = |axis: Vec3| noise(axis * step) / step;
        for (axis, expected) in [(Vec3::X, 1.0), (Vec3::Y, 0.0), (Vec3::Z, 1.0)] {
            assert!((slope(axis) - expected).abs() < 1e-2, "{axis}: {}", slope(axis));
        }
    }

    #[test]
    fn noise_is_bounded_continuous_and_periodic() {
        let (mut largest, mut mean, n) = (0.0_f32, 0.0, 40_000);
        for i in 0..n {
            let p = Vec3::new(i as f32 * 0.173, i as f32 * 0.0917, i as f32 * 0.0431);
            let value = noise(p);
            largest = largest.max(value.abs());
            mean += value / n as f32;
            let beside = noise(p + Vec3::splat(1e-3));
            assert!((value - beside).abs() < 2e-2, "a jump at {p}");
        }
        assert!(largest <= 1.0 && largest > 0.7, "{largest}");
        assert!(mean.abs() < 0.02, "{mean}");
        let p = Vec3::new(0.3, 0.7, 0.2);
        assert!((noise(p) - noise(p + Vec3::new(256.0, 0.0, 512.0))).abs() < 1e-4);
        assert!(noise(Vec3::splat(3e38)).is_finite());
    }

    #[test]
    fn octaves_below_the_footprint_are_left_out() {
        let p = Vec3::new(1.3, 0.4, 2.7);
        // Without a footprint: the first octave, and with none at all nothing; with one octave and a footprint of 1/8, all of it.
        assert_eq!(fbm(&at(p, 0.0), 0.5, 1), noise(p));
        assert_eq!(fbm(&at(p, 10.0), 0.5, 8), 0.0);
        // A footprint of 2^-4 leaves -1 + 4 = 3 octaves.
        let three = noise(p) + 0.5 * noise(p * 1.99) + 0.25 * noise(p * (1.99 * 1.99));
        assert!((fbm(&at(p, 0.0625), 0.5, 8) - three).abs() < 1e-6);
        // All of a turbulence's octaves left out: 0.2 for the one that fades, and for each of the 8: 0.2 (1 + 2 - 2^-7).
        let expected = 0.2 * (1.0 + 2.0 - 2.0_f32.powi(-7));
        assert!((turbulence(&at(p, 10.0), 0.5, 8) - expected).abs() < 1e-6);
    }
}
