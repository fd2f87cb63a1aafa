//! Worlds made for measuring: as many triangles as asked for, a box around them, so that paths go on, and a place for a camera.

use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

use crate::error::{Error, Result};
use crate::geometry::{Geometry, Group, Instance, Shape, TriangleMesh, World, WorldBuilder};
use crate::math::{AnimatedTransform, DAffine3, DQuat, Vec3};

/// What stands in the box.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Two blocks: a Cornell box of 36 triangles, whatever number is asked for.
    Box,
    /// Hills: a height field.
    Terrain,
    /// Triangles of random places and directions, whose size lets a constant share of rays through.
    Soup,
    /// Spheres of many triangles each.
    Spheres,
    /// Thin cylinders across the box, of long, thin triangles in all directions.
    Hair,
    /// Spheres of few meridians and many parallels, or the other way round: triangles a hundred times as long as wide.
    Slivers,
    /// Thin triangles from side to side of the box, along its diagonals: no box fits them.
    Diagonals,
    /// Instances of a sphere of a thousand triangles.
    Instances,
}

impl Kind {
    /// All, by name, with the greatest number of triangles.
    pub const ALL: [(&'static str, Self, usize); 8] = [
        ("box", Self::Box, 10_000_000),
        ("terrain", Self::Terrain, 10_000_000),
        ("soup", Self::Soup, 10_000_000),
        ("spheres", Self::Spheres, 10_000_000),
        ("hair", Self::Hair, 10_000_000),
        ("slivers", Self::Slivers, 10_000_000),
        ("diagonals", Self::Diagonals, 10_000_000),
        ("instances", Self::Instances, 100_000_000),
    ];
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = Self::ALL
            .iter()
            .find(|entry| entry.1 == *self)
            .map_or("", |entry| entry.0);
        f.pad(name)
    }
}

/// A world to be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Recipe {
    /// What stands in it.
    pub kind: Kind,
    /// About so many triangles.
    pub count: usize,
}

impl fmt::Display for Recipe {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kind, count } = *self;
        match count {
            0 => write!(f, "{kind}"),
            _ if count % 1_000_000 == 0 => write!(f, "{kind}:{}M", count / 1_000_000),
            _ if count % 1000 == 0 => write!(f, "{kind}:{}k", count / 1000),
            _ => write!(f, "{kind}:{count}"),
        }
    }
}

impl FromStr for Recipe {
    type Err = Error;

    /// `KIND:N`, N being a number such as `50000`, `50k`, `2M` or `1e6`; `box` has no N.
    fn from_str(text: &str) -> Result<Self> {
        let (name, count) = text.split_once(':').unwrap_or((text, ""));
        let Some(&(_, kind, most)) = Kind::ALL.iter().find(|entry| entry.0 == name) else {
            let names = Kind::ALL.map(|entry| entry.0).join(", ");
            return Err(Error::Usage(format!(
                "unknown synthetic world `{name}`: expected one of {names}"
            )));
        };
        if kind == Kind::Box && count.is_empty() {
            return Ok(Self { kind, count: 0 });
        }
        let (digits, unit) = match count.as_bytes().last() {
            Some(b'k') => (&count[..count.len() - 1], 1e3),
            Some(b'M') => (&count[..count.len() - 1], 1e6),
            _ => (count, 1.0),
        };
        let number = digits.parse::<f64>().ok().map(|number| number * unit);
        match number.filter(|number| (1.0..=most as f64).contains(number)) {
            Some(number) => Ok(Self {
                kind,
                count: number as usize,
            }),
            None => Err(Error::Usage(format!(
                "`{text}`: expected KIND:N with N triangles, 1 to {most}, as in {name}:50k or {name}:1e6"
            ))),
        }
    }
}

/// A world, and where to look at it from.
#[derive(Clone, Debug)]
pub struct Synthetic {
    /// The world.
    pub world: Arc<World>,
    /// The camera's place.
    pub eye: Vec3,
    /// What it looks at.
    pub target: Vec3,
    /// A corner of the lamp and its two edges.
    pub lamp: [Vec3; 3],
}

/// Numbers in [0, 1), a function of a seed and of how many were drawn (the mixer of SplitMix64, Steele et al. 2014).
#[derive(Clone, Debug)]
pub struct Numbers(u64);

impl Numbers {
    /// From a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next number.
    pub fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / (1 << 24) as f32
    }

    /// Three of them.
    pub fn cube(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit())
    }

    /// A direction, uniform over the sphere.
    pub fn direction(&mut self) -> Vec3 {
        let z = 1.0 - 2.0 * self.unit();
        let r = (1.0 - z * z).max(0.0).sqrt();
        let (sin, cos) = (std::f32::consts::TAU * self.unit()).sin_cos();
        Vec3::new(r * cos, r * sin, z)
    }
}

#[derive(Default)]
struct Triangles {
    positions: Vec<Vec3>,
    indices: Vec<[u32; 3]>,
}

impl Triangles {
    fn mesh(self) -> Result<TriangleMesh> {
        let count = self.indices.len();
        TriangleMesh::new(vec![self.positions], self.indices)
            .map_err(|error| Error::Usage(format!("a synthetic world of {count} triangles: {error}")))
    }

    fn vertex(&mut self, p: Vec3) -> u32 {
        self.positions.push(p);
        self.positions.len() as u32 - 1
    }

    fn quad(&mut self, corner: Vec3, e: Vec3, f: Vec3) {
        let [a, b, c, d] = [corner, corner + e, corner + e + f, corner + f].map(|p| self.vertex(p));
        self.indices.extend([[a, b, c], [a, c, d]]);
    }

    /// A box without its bottom, turned about the vertical.
    fn block(&mut self, center: Vec3, size: Vec3, angle: f32) {
        let (sin, cos) = angle.sin_cos();
        let (x, z) = (Vec3::new(cos, 0.0, sin) * size.x, Vec3::new(-sin, 0.0, cos) * size.z);
        let y = Vec3::Y * size.y;
        let corner = center - 0.5 * (x + z);
        self.quad(corner, x, y);
        self.quad(corner + z, x, y);
        self.quad(corner, z, y);
        self.quad(corner + x, z, y);
        self.quad(corner + y, x, z);
        self.quad(corner, x, z);
    }

    /// A grid of `n` by `m` quads over a function of [0, 1]^2.
    fn grid(&mut self, n: usize, m: usize, place: impl Fn(f32, f32) -> Vec3) {
        let first = self.positions.len() as u32;
        for j in 0..=m {
            for i in 0..=n {
                let p = place(i as f32 / n as f32, j as f32 / m as f32);
                self.positions.push(p);
            }
        }
        let row = n as u32 + 1;
        for j in 0..m as u32 {
            for i in 0..n as u32 {
                let a = first + j * row + i;
                self.indices
                    .extend([[a, a + 1, a + row + 1], [a, a + row + 1, a + row]]);
            }
        }
    }

    fn soup(&mut self, count: usize) {
        let numbers = &mut Numbers::new(1);
        let size = 0.7 / (count as f32).sqrt().max(1.0);
        for _ in 0..count {
            let center = Vec3::new(-0.9, 0.1, -0.9) + numbers.cube() * Vec3::new(1.8, 1.6, 1.8);
            let corners = [(); 3].map(|()| numbers.direction());
            let corners = corners.map(|d| self.vertex(center + size * d));
            self.indices.push(corners);
        }
    }

    fn spheres(&mut self, count: usize) {
        const SPHERES: usize = 40;
        let numbers = &mut Numbers::new(2);
        let n = (count as f64 / SPHERES as f64).sqrt().max(2.0) as usize;
        for _ in 0..SPHERES {
            let center = Vec3::new(-0.8, 0.2, -0.8) + numbers.cube() * Vec3::new(1.6, 1.4, 1.6);
            let radius = 0.08 + 0.12 * numbers.unit();
            self.sphere(center, radius, n, n.div_ceil(2));
        }
    }

    fn sphere(&mut self, center: Vec3, radius: f32, meridians: usize, parallels: usize) {
        self.grid(meridians, parallels, |u, v| {
            let (sin, cos) = (std::f32::consts::TAU * u).sin_cos();
            let (s, c) = (std::f32::consts::PI * v).sin_cos();
            center + radius * Vec3::new(s * cos, c, s * sin)
        });
    }

    fn slivers(&mut self, count: usize) {
        const SPHERES: usize = 8;
        const RATIO: f64 = 100.0;
        let numbers = &mut Numbers::new(4);
        let few = (count as f64 / (2.0 * SPHERES as f64 * RATIO)).sqrt().max(3.0) as usize;
        let many = (count / (2 * SPHERES * few)).max(3);
        for i in 0..SPHERES {
            let center = Vec3::new(-0.7, 0.3, -0.7) + numbers.cube() * Vec3::new(1.4, 1.2, 1.4);
            let [meridians, parallels] = if i % 2 == 0 { [few, many] } else { [many, few] };
            self.sphere(center, 0.15 + 0.15 * numbers.unit(), meridians, parallels);
        }
    }

    fn diagonals(&mut self, count: usize) {
        let numbers = &mut Numbers::new(5);
        let width = 0.4 / (count as f32).sqrt().max(1.0);
        let (corner, room) = (Vec3::new(-0.9, 0.1, -0.9), Vec3::new(1.8, 1.8, 1.8));
        for i in 0..count {
            // Ends on opposite sides of the box, near the ends of a diagonal or not so near.
            let mut a = numbers.cube() * 0.4;
            let mut b = Vec3::ONE - numbers.cube() * 0.4;
            for (axis, flip) in [(0, i & 1), (1, i >> 1 & 1)] {
                if flip == 1 {
                    (a[axis], b[axis]) = (1.0 - a[axis], 1.0 - b[axis]);
                }
            }
            let (a, b) = (corner + room * a, corner + room * b);
            let side = width * numbers.direction();
            let corners = [a, b, b + side].map(|p| self.vertex(p));
            self.indices.push(corners);
        }
    }

    fn hair(&mut self, count: usize) {
        const SIDES: usize = 6;
        let numbers = &mut Numbers::new(3);
        for _ in 0..count / (2 * SIDES) {
            let corner = Vec3::new(-0.9, 0.1, -0.9);
            let room = Vec3::new(1.8, 1.6, 1.8);
            let a = corner + room * numbers.cube();
            let b = (a + 0.5 * numbers.direction()).clamp(corner, corner + room);
            let (x, y) = (b - a).normalize_or(Vec3::X).any_orthonormal_pair();
            let radius = 0.5 / (count as f32).sqrt();
            self.grid(SIDES, 1, |u, v| {
                let (sin, cos) = (std::f32::consts::TAU * u).sin_cos();
                a + v * (b - a) + radius * (sin * x + cos * y)
            });
        }
    }
}

fn terrain(u: f32, v: f32) -> Vec3 {
    let (x, z) = (2.0 * u - 1.0, 2.0 * v - 1.0);
    let mut y = 0.4;
    let (mut size, mut frequency) = (0.15, 3.0_f32);
    for octave in 0..8 {
        let phase = octave as f32 * 1.7;
        y += size * (frequency * x + phase).sin() * (frequency * 1.1 * z + 0.7 * x * frequency - phase).cos();
        size *= 0.5;
        frequency *= 2.1;
    }
    Vec3::new(x, y.clamp(0.02, 1.9), z)
}

/// Triangles of the sphere that is instanced.
const INSTANCED: usize = 1000;

fn instances(builder: &mut WorldBuilder, count: usize) -> Result<()> {
    let mut sphere = Triangles::default();
    sphere.sphere(Vec3::ZERO, 1.0, 32, INSTANCED / 64);
    let geometry = builder.add_geometry(Geometry::opaque(Shape::Mesh(sphere.mesh()?)));
    let group = builder.add_group(Group {
        geometries: vec![geometry],
        instances: Vec::new(),
    });
    let count = (count / INSTANCED).max(1);
    let numbers = &mut Numbers::new(6);
    let size = 0.4 / (count as f32).sqrt().max(2.0);
    for _ in 0..count {
        let center = Vec3::new(-0.9, 0.1, -0.9) + numbers.cube() * Vec3::new(1.8, 1.6, 1.8);
        let turn = DQuat::from_axis_angle(numbers.direction().as_dvec3(), f64::from(numbers.unit()));
        let size = size * (0.5 + numbers.unit()) * (Vec3::splat(0.7) + 0.6 * numbers.cube());
        let place = DAffine3::from_scale_rotation_translation(size.as_dvec3(), turn, center.as_dvec3());
        let world_from_object = AnimatedTransform::fixed(place)
            .ok_or_else(|| Error::Usage("an instance of a synthetic world has no size".into()))?;
        builder.root.instances.push(Instance {
            group,
            world_from_object,
            mask: u32::MAX,
        });
    }
    Ok(())
}

/// A box from (-1, 0, -1) to (1, 2, 1), open towards the camera, with a lamp below its ceiling and what is asked for in it.
///
/// # Errors
/// [`Error::Usage`] if there are more vertices than an index can tell apart.
pub fn world(recipe: Recipe) -> Result<Synthetic> {
    let count = recipe.count;
    let mut triangles = Triangles::default();
    let (x, y, z) = (2.0 * Vec3::X, 2.0 * Vec3::Y, 2.0 * Vec3::Z);
    let corner = Vec3::new(-1.0, 0.0, -1.0);
    triangles.quad(corner, x, z);
    triangles.quad(corner + y, x, z);
    triangles.quad(corner, x, y);
    triangles.quad(corner, y, z);
    triangles.quad(corner + x, y, z);
    let lamp = [Vec3::new(-0.24, 1.98, -0.22), 0.47 * Vec3::X, 0.38 * Vec3::Z];
    triangles.quad(lamp[0], lamp[1], lamp[2]);
    let mut builder = WorldBuilder::default();
    match recipe.kind {
        Kind::Box => {
            triangles.block(Vec3::new(-0.34, 0.0, -0.29), Vec3::new(0.6, 1.2, 0.6), 0.3);
            triangles.block(Vec3::new(0.33, 0.0, 0.37), Vec3::new(0.6, 0.6, 0.6), -0.3);
        }
        Kind::Terrain => {
            let n = ((count / 2) as f64).sqrt().max(1.0) as usize;
            triangles.grid(n, n, terrain);
        }
        Kind::Soup => triangles.soup(count),
        Kind::Spheres => triangles.spheres(count),
        Kind::Hair => triangles.hair(count),
        Kind::Slivers => triangles.slivers(count),
        Kind::Diagonals => triangles.diagonals(count),
        Kind::Instances => instances(&mut builder, count)?,
    }
    let id = builder.add_geometry(Geometry::opaque(Shape::Mesh(triangles.mesh()?)));
    builder.root.geometries.push(id);
    Ok(Synthetic {
        world: Arc::new(builder.build()?),
        eye: Vec3::new(0.0, 1.0, 5.5),
        target: Vec3::new(0.0, 1.0, 0.0),
        lamp,
    })
}
