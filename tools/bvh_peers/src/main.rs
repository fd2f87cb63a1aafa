//! Three BVH crates on the rays of a file that `lucerna bench --rays` saved: how fast they are, and how often they differ from the answers in
//! the file. `cargo run --release -- FILE [TURNS]`. The format is that of docs/rays.md.
//!
//! Each is called as its documentation shows: ray by ray, on one thread. `bvh` has no way to be told the nearest hit so far: it gives every
//! triangle whose box the ray meets.

mod file;

use std::hint::black_box;
use std::time::{Duration, Instant};

use file::{Answer, File, Packet, Ray};

/// The nearest triangle and its distance; of shadow rays, any.
type Hit = Option<(u32, f32)>;

trait Peer {
    fn name(&self) -> &'static str;
    fn nearest(&self, ray: &Ray) -> Hit;
    fn any(&self, ray: &Ray) -> bool;
}

struct Obvhs {
    name: &'static str,
    bvh: obvhs::cwbvh::CwBvh,
    /// In the order of the tree.
    triangles: Vec<obvhs::triangle::Triangle>,
}

impl Obvhs {
    fn build(file: &File, name: &'static str, params: obvhs::BvhBuildParams) -> Self {
        let point = |v: u32| glam::Vec3A::from_array(file.vertices[v as usize]);
        let triangle = |[a, b, c]: &[u32; 3]| obvhs::triangle::Triangle { v0: point(*a), v1: point(*b), v2: point(*c) };
        let triangles: Vec<_> = file.triangles.iter().map(triangle).collect();
        let bvh = obvhs::cwbvh::builder::build_cwbvh_from_tris(&triangles, params, &mut Duration::default());
        let triangles = bvh.primitive_indices.iter().map(|&i| triangles[i as usize]).collect();
        Self { name, bvh, triangles }
    }

    fn ray(ray: &Ray) -> obvhs::ray::Ray {
        let (o, d) = (glam::Vec3A::from_array(ray.origin), glam::Vec3A::from_array(ray.direction));
        obvhs::ray::Ray::new(o, d, ray.tnear, ray.tfar)
    }
}

impl Peer for Obvhs {
    fn name(&self) -> &'static str {
        self.name
    }

    fn nearest(&self, ray: &Ray) -> Hit {
        let mut hit = obvhs::ray::RayHit::none();
        let found = self.bvh.ray_traverse(Self::ray(ray), &mut hit, |ray, id| self.triangles[id].intersect(ray));
        found.then(|| (self.bvh.primitive_indices[hit.primitive_id as usize], hit.t))
    }

    fn any(&self, ray: &Ray) -> bool {
        !self.bvh.ray_traverse_miss(Self::ray(ray), |ray, id| self.triangles[id].intersect(ray))
    }
}

struct Shape {
    corners: [nalgebra::Point3<f32>; 3],
    index: u32,
    node: usize,
}

impl bvh::aabb::Bounded<f32, 3> for Shape {
    fn aabb(&self) -> bvh::aabb::Aabb<f32, 3> {
        self.corners.iter().fold(bvh::aabb::Aabb::empty(), |aabb, p| aabb.grow(p))
    }
}

impl bvh::bounding_hierarchy::BHShape<f32, 3> for Shape {
    fn set_bh_node_index(&mut self, index: usize) {
        self.node = index;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

struct BvhCrate {
    bvh: bvh::bvh::Bvh<f32, 3>,
    shapes: Vec<Shape>,
}

impl BvhCrate {
    fn build(file: &File) -> Self {
        let point = |v: u32| nalgebra::Point3::from(file.vertices[v as usize]);
        let shape = |(index, corners): (usize, &[u32; 3])| Shape {
            corners: corners.map(point),
            index: index as u32,
            node: 0,
        };
        let mut shapes: Vec<_> = file.triangles.iter().enumerate().map(shape).collect();
        let bvh = bvh::bvh::Bvh::build(&mut shapes);
        Self { bvh, shapes }
    }

    /// The ray, whose direction this crate makes one of unit length, and the length that it had.
    fn ray(ray: &Ray) -> (bvh::ray::Ray<f32, 3>, f32) {
        let direction = nalgebra::Vector3::from(ray.direction);
        (bvh::ray::Ray::new(ray.origin.into(), direction), direction.norm())
    }

    /// From either side: the crate's own test is one of front faces.
    fn distance(ray: &bvh::ray::Ray<f32, 3>, [a, b, c]: &[nalgebra::Point3<f32>; 3]) -> f32 {
        let front = ray.intersects_triangle(a, b, c).distance;
        front.min(ray.intersects_triangle(a, c, b).distance)
    }
}

impl Peer for BvhCrate {
    fn name(&self) -> &'static str {
        "bvh"
    }

    fn nearest(&self, given: &Ray) -> Hit {
        let (ray, length) = Self::ray(given);
        let (low, mut high) = (given.tnear * length, given.tfar * length);
        let mut hit = None;
        for shape in self.bvh.traverse_iterator(&ray, &self.shapes) {
            let t = Self::distance(&ray, &shape.corners);
            if t > low && t <= high {
                high = t;
                hit = Some((shape.index, t / length));
            }
        }
        hit
    }

    fn any(&self, given: &Ray) -> bool {
        let (ray, length) = Self::ray(given);
        let within = |t: f32| t > given.tnear * length && t <= given.tfar * length;
        self.bvh.traverse_iterator(&ray, &self.shapes).any(|shape| within(Self::distance(&ray, &shape.corners)))
    }
}

struct Parry {
    mesh: parry3d::shape::TriMesh,
}

impl Parry {
    fn build(file: &File) -> Option<Self> {
        let vertices = file.vertices.iter().map(|&p| p.into()).collect();
        let mesh = parry3d::shape::TriMesh::new(vertices, file.triangles.clone()).ok()?;
        Some(Self { mesh })
    }

    /// It knows no tnear: the ray starts there.
    fn ray(ray: &Ray) -> parry3d::query::Ray {
        let direction = parry3d::na::Vector3::from(ray.direction);
        let origin = parry3d::na::Point3::from(ray.origin) + direction * ray.tnear;
        parry3d::query::Ray::new(origin, direction)
    }
}

impl Peer for Parry {
    fn name(&self) -> &'static str {
        "parry3d"
    }

    fn nearest(&self, ray: &Ray) -> Hit {
        let most = (ray.tfar - ray.tnear).min(f32::MAX);
        let shape = parry3d::shape::CompositeShapeRef(&self.mesh);
        let (index, t) = shape.cast_local_ray(&Self::ray(ray), most, false)?;
        Some((index, t + ray.tnear))
    }

    fn any(&self, ray: &Ray) -> bool {
        self.nearest(ray).is_some()
    }
}

/// Seconds to trace all rays of a stream once.
fn trace(peer: &dyn Peer, packets: &[Packet], is_shadow: bool) -> f64 {
    let start = Instant::now();
    for packet in packets {
        for ray in packet.active() {
            if is_shadow {
                black_box(peer.any(&ray));
            } else {
                black_box(peer.nearest(&ray));
            }
        }
    }
    start.elapsed().as_secs_f64()
}

/// Rays about which a peer and the file do not agree: hit or not, or a distance that differs by more than a ten thousandth.
fn differing(peer: &dyn Peer, stream: &file::Stream) -> usize {
    let mut count = 0;
    for (packet, answers) in stream.packets.iter().zip(&stream.answers) {
        for (lane, ray) in packet.lanes() {
            count += usize::from(match answers {
                Answer::Any(bits) => peer.any(&ray) != (bits >> lane & 1 == 1),
                Answer::Nearest(triangles, distances) => match (peer.nearest(&ray), triangles[lane]) {
                    (None, u32::MAX) => false,
                    (None, _) | (Some(_), u32::MAX) => true,
                    (Some((index, t)), expected) => {
                        index != expected && (t - distances[lane]).abs() > 1e-4 * t.max(distances[lane])
                    }
                },
            });
        }
    }
    count
}

fn main() -> Result<(), String> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("expected a file of rays, then perhaps how often to trace them")?;
    let turns = arguments.next().and_then(|turns| turns.parse().ok()).unwrap_or(5);
    let file = File::read(&path)?;
    println!("{}: {} triangles", file.name, file.triangles.len());
    let mut peers: Vec<Box<dyn Peer>> = Vec::new();
    let mut add = |build: &dyn Fn() -> Option<Box<dyn Peer>>| {
        let start = Instant::now();
        if let Some(peer) = build() {
            println!("  {:14} built in {:.3} s", peer.name(), start.elapsed().as_secs_f64());
            peers.push(peer);
        }
    };
    let medium = obvhs::BvhBuildParams::medium_build();
    let slow = obvhs::BvhBuildParams::very_slow_build();
    add(&|| Some(Box::new(Obvhs::build(&file, "obvhs medium", medium))));
    add(&|| Some(Box::new(Obvhs::build(&file, "obvhs slowest", slow))));
    add(&|| Some(Box::new(BvhCrate::build(&file))));
    add(&|| Some(Box::new(Parry::build(&file)?)));
    for stream in &file.streams {
        let is_shadow = stream.kind == "shadow";
        let mut times = vec![Vec::new(); peers.len()];
        for turn in 0..turns {
            for i in 0..peers.len() {
                let who = (i + turn) % peers.len();
                times[who].push(trace(&*peers[who], &stream.packets, is_shadow));
            }
        }
        let rays: usize = stream.packets.iter().map(|packet| packet.active().count()).sum();
        for (peer, times) in peers.iter().zip(&mut times) {
            times.sort_by(f64::total_cmp);
            println!(
                "  {:10} {:14} {:8.2} million rays a second, {} of {rays} differ",
                stream.kind,
                peer.name(),
                rays as f64 * 1e-6 / times[times.len() / 2],
                differing(&**peer, stream)
            );
        }
    }
    Ok(())
}
