//! Points where photons land, and points that a camera sees: in a box from -1 to 1, with a sphere in it.

use lucerna::math::Vec3;

const SPHERE: (Vec3, f32) = (Vec3::new(0.3, -0.6, 0.2), 0.4);
const WIDTH: usize = 400;
const HEIGHT: usize = 320;

/// Numbers in [0, 1): SplitMix64.
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn unit(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / (1 << 24) as f32
    }

    fn direction(&mut self) -> Vec3 {
        let (z, phi) = (2.0 * self.unit() - 1.0, std::f32::consts::TAU * self.unit());
        let r = (1.0 - z * z).max(0.0).sqrt();
        Vec3::new(r * phi.cos(), r * phi.sin(), z)
    }
}

/// Of ten photons six come from the middle of the ceiling, on walls and sphere, three are in a bright spot below the sphere, and one in
/// a thin curve on the floor.
pub fn on_surfaces(count: usize) -> Vec<Vec3> {
    let mut random = Random(1);
    (0..count).map(|i| photon(i, &mut random)).collect()
}

fn photon(i: usize, random: &mut Random) -> Vec3 {
    let (center, _) = SPHERE;
    match i % 10 {
        0..6 => {
            let from = Vec3::new(0.2 * random.unit() - 0.1, 0.999, 0.2 * random.unit() - 0.1);
            let w = random.direction();
            hit(from, Vec3::new(w.x, -w.y.abs(), w.z))
        }
        6..9 => {
            let (r, phi) = (0.3 * random.unit().powi(2), std::f32::consts::TAU * random.unit());
            Vec3::new(center.x + r * phi.cos(), -1.0, center.z + r * phi.sin())
        }
        _ => {
            let phi = std::f32::consts::PI * random.unit();
            let r = 0.5 * (1.0 + 0.5 * phi.cos()) * (1.0 - 0.02 * random.unit());
            Vec3::new(-0.5 + r * phi.cos(), -1.0, -0.3 + r * phi.sin())
        }
    }
}

/// Points all over the box.
pub fn in_cube(count: usize, seed: u64) -> Vec<Vec3> {
    let mut random = Random(seed);
    (0..count)
        .map(|_| 2.0 * Vec3::new(random.unit(), random.unit(), random.unit()) - 1.0)
        .collect()
}

/// What a camera sees in each pixel, row by row.
pub fn seen_by_pixels() -> Vec<Vec3> {
    let from = Vec3::new(0.0, 0.1, -0.95);
    let pixel = |i: usize| {
        let x = (i % WIDTH) as f32 / WIDTH as f32 - 0.5;
        let y = 0.5 - (i / WIDTH) as f32 / HEIGHT as f32;
        hit(from, Vec3::new(2.0 * x, 1.6 * y, 1.0).normalize())
    };
    (0..WIDTH * HEIGHT).map(pixel).collect()
}

/// The same points in random order.
pub fn shuffled(points: &[Vec3]) -> Vec<Vec3> {
    let mut random = Random(2);
    let mut points = points.to_vec();
    for i in (1..points.len()).rev() {
        points.swap(i, random.bits() as usize % (i + 1));
    }
    points
}

/// Where a ray meets the sphere, or else the walls.
fn hit(from: Vec3, w: Vec3) -> Vec3 {
    let (center, radius) = SPHERE;
    let oc = from - center;
    let b = oc.dot(w);
    let discriminant = b * b - oc.length_squared() + radius * radius;
    if discriminant > 0.0 && -b - discriminant.sqrt() > 0.0 {
        return from + (-b - discriminant.sqrt()) * w;
    }
    let walls = [0, 1, 2].map(|axis| (w[axis].signum() - from[axis]) / w[axis]);
    let axis = if walls[0] <= walls[1] && walls[0] <= walls[2] {
        0
    } else if walls[1] <= walls[2] {
        1
    } else {
        2
    };
    let mut p = from + walls[axis] * w;
    p[axis] = w[axis].signum();
    p
}
