//! Backends, brute force and the judge about the same rays.

use std::ops::AddAssign;
use std::sync::Arc;

use lucerna::accel::brute::Brute;
use lucerna::accel::bvh::Bvh;
use lucerna::accel::judge::Judge;
use lucerna::accel::{Accel, BuildOptions, FilterHit, HitFilter};
use lucerna::geometry::{CurveKind, Geometry, GeometryId, Hit, Opacity, PrimitiveId, Ray, Shape, World, WorldBuilder};
use rayon::prelude::*;

use crate::rays::RayMaker;
use crate::rng::{Rng, hash};
use crate::{backends, configurations, intersect, is_full, occluded, worlds};

/// Rays in one task.
const BATCH: usize = 4096;

#[derive(Clone, Copy, Debug, Default)]
struct Count {
    rays: usize,
    hits: usize,
    judged: usize,
    ambiguous: usize,
    /// Ambiguous rays about which the backends and brute force do not all say the same.
    differing: usize,
    /// Answers of Embree that only the lenient judge allows.
    lenient: usize,
    wrong: usize,
}

impl AddAssign for Count {
    fn add_assign(&mut self, other: Self) {
        self.rays += other.rays;
        self.hits += other.hits;
        self.judged += other.judged;
        self.ambiguous += other.ambiguous;
        self.differing += other.differing;
        self.lenient += other.lenient;
        self.wrong += other.wrong;
    }
}

/// Everything that answers about one world.
struct Court<'a> {
    name: &'a str,
    judge: Judge,
    /// For Embree, where it says what the other would not allow.
    lenient: Judge,
    backends: Vec<(String, Box<dyn Accel>)>,
    filter: Option<&'a dyn HitFilter>,
}

impl Court<'_> {
    fn accepts(&self, ray: &Ray, hit: Hit) -> bool {
        self.filter.is_none_or(|filter| {
            filter.accept(&FilterHit {
                geometry: hit.geometry,
                primitive: hit.primitive,
                instance: hit.instance,
                u: 0.0,
                v: 0.0,
                t: 0.0,
                ray_id: ray.id,
            })
        })
    }

    /// Asks all backends about all rays, and the judge about every ray (in the full tier, about all on which they differ and one
    /// in a hundred).
    fn try_rays(&self, rays: &[Ray]) -> Count {
        let nearest: Vec<_> = self
            .backends
            .iter()
            .map(|(_, b)| intersect(&**b, rays, self.filter))
            .collect();
        let any: Vec<_> = self
            .backends
            .iter()
            .map(|(_, b)| occluded(&**b, rays, self.filter))
            .collect();
        let mut count = Count::default();
        for (i, ray) in rays.iter().enumerate() {
            let hit = |answers: &Vec<Option<(Hit, f32)>>| answers[i].map(|(hit, _)| hit);
            let first = hit(&nearest[0]);
            let differ = nearest.iter().any(|answers| hit(answers) != first);
            let occlusion_differs = any.iter().any(|answers| answers[i] != first.is_some());
            count.rays += 1;
            count.hits += usize::from(first.is_some());
            count.differing += usize::from(differ);
            if is_full() && !differ && !occlusion_differs && i % 100 != 0 {
                continue;
            }
            let verdict = self.judge.judge(ray, |hit| self.accepts(ray, hit));
            count.judged += 1;
            count.ambiguous += usize::from(!verdict.is_clear());
            for ((name, _), (nearest, any)) in self.backends.iter().zip(nearest.iter().zip(&any)) {
                if verdict.allows(nearest[i]) && verdict.allows_occluded(any[i]) {
                    continue;
                }
                if name.starts_with("embree") {
                    let verdict = self.lenient.judge(ray, |hit| self.accepts(ray, hit));
                    if verdict.allows(nearest[i]) && verdict.allows_occluded(any[i]) {
                        count.lenient += 1;
                        continue;
                    }
                }
                count.wrong += 1;
                if count.wrong <= 3 {
                    println!("{}, {name}: {ray:?}", self.name);
                    println!("  answers {:?}, occluded {}\n  judged {verdict:?}", nearest[i], any[i]);
                }
            }
        }
        count
    }
}

fn try_world(name: &str, world: &Arc<World>, filter: Option<&dyn HitFilter>, rays: usize, seed: u64) -> Count {
    try_backends(name, world, backends(world), filter, rays, seed)
}

fn try_backends(
    name: &str,
    world: &Arc<World>,
    backends: Vec<(String, Box<dyn Accel>)>,
    filter: Option<&dyn HitFilter>,
    rays: usize,
    seed: u64,
) -> Count {
    let mut court = Court {
        name,
        judge: Judge::new(world),
        lenient: Judge::new(world).with_pluecker_margins(),
        backends,
        filter,
    };
    if !is_full() {
        court.backends.push(("brute force".into(), Box::new(Brute::new(world))));
    }
    let maker = RayMaker::new(world);
    let counts: Vec<Count> = (0..rays.div_ceil(BATCH))
        .into_par_iter()
        .map(|batch| {
            let rng = &mut Rng::new(hash(seed << 32 | batch as u64));
            let rays: Vec<Ray> = (0..BATCH.min(rays))
                .map(|i| maker.ray(rng, (batch * BATCH + i) as u32))
                .collect();
            court.try_rays(&rays)
        })
        .collect();
    let mut total = Count::default();
    counts.into_iter().for_each(|count| total += count);
    println!("{name}: {total:?}");
    total
}

#[test]
fn backends_answer_what_the_judge_allows() {
    let worlds = worlds::all();
    let rays = if is_full() { 100_000_000 } else { 1_000_000 } / worlds.len();
    let mut total = Count::default();
    for (seed, (name, world)) in worlds.iter().enumerate() {
        total += try_world(name, world, None, rays, seed as u64);
    }
    println!("all: {total:?}");
    assert!(total.rays >= rays * worlds.len() && total.judged > 0);
    assert_eq!(total.wrong, 0);
    // The rays are made to be hard, but not so hard that most prove nothing. Those that the full tier does not judge are not among
    // the ambiguous: all backends agree about them.
    let judged = if is_full() { total.rays } else { total.judged };
    assert!(2 * total.ambiguous < judged, "{} rays are ambiguous", total.ambiguous);
}

/// Builds of every quality and every call.
#[test]
fn every_configuration_answers_what_the_judge_allows() {
    let worlds = worlds::all();
    let rays = if is_full() { 10_000_000 } else { 60_000 } / worlds.len();
    for (seed, (name, world)) in worlds.iter().enumerate() {
        let total = try_backends(name, world, configurations(world), None, rays, 50 + seed as u64);
        assert_eq!(total.wrong, 0, "{name}");
    }
}

#[test]
fn our_bvh_answers_what_the_judge_allows_at_the_ends_of_single_precision() {
    for (seed, (name, world)) in worlds::extreme().iter().enumerate() {
        let ours = configurations(world)
            .into_iter()
            .filter(|(name, _)| !name.starts_with("embree"))
            .collect();
        let total = try_backends(name, world, ours, None, 20_000, seed as u64);
        assert_eq!(total.wrong, 0, "{name}");
        assert!(total.hits > 5000, "{name}");
    }
}

/// Accepts by a hash of ray and primitive.
struct Hashed;

impl HitFilter for Hashed {
    fn accept(&self, hit: &FilterHit) -> bool {
        hash(u64::from(hit.ray_id) << 32 | u64::from(hit.primitive.0)).is_multiple_of(3)
    }
}

/// Half of the geometry of each world is filtered.
fn filtered(shapes: Vec<Shape>) -> Arc<World> {
    let mut builder = WorldBuilder::default();
    for (i, shape) in shapes.into_iter().enumerate() {
        let opacity = [Opacity::Filtered, Opacity::Opaque][i % 2];
        let geometry = Geometry {
            opacity,
            ..Geometry::opaque(shape)
        };
        let id = builder.add_geometry(geometry);
        builder.root.geometries.push(id);
    }
    Arc::new(builder.build().unwrap())
}

#[test]
fn a_filter_is_asked_about_filtered_geometry_only() {
    let rng = &mut Rng::new(3);
    let worlds = [
        filtered(vec![
            Shape::Mesh(worlds::soup(rng, 300, 0.3)),
            Shape::Mesh(worlds::soup(rng, 50, 0.3)),
        ]),
        filtered(vec![worlds::spheres(rng, 50), worlds::spheres(rng, 10)]),
        filtered(vec![worlds::quadrics(rng, 60), worlds::patches(rng, 20)]),
        filtered(vec![worlds::patches(rng, 60), worlds::quadrics(rng, 10)]),
        filtered(vec![
            worlds::curves(rng, 300, CurveKind::Flat),
            worlds::quadrics(rng, 10),
        ]),
    ];
    for (seed, world) in worlds.iter().enumerate() {
        let opaque = |hit: GeometryId| world.geometry(hit).opacity == Opacity::Opaque;
        struct OnlyFiltered<F>(F);
        impl<F: Fn(GeometryId) -> bool + Sync> HitFilter for OnlyFiltered<F> {
            fn accept(&self, hit: &FilterHit) -> bool {
                (self.0)(hit.geometry) || Hashed.accept(hit)
            }
        }
        let filter = OnlyFiltered(opaque);
        let total = try_world("filtered", world, Some(&filter), 20_000, seed as u64);
        assert_eq!(total.wrong, 0);
        assert!(total.hits > 1000);
    }
}

#[test]
fn where_distances_are_equal_the_least_ids_are_reported() {
    // The same triangles in three geometries, the ids of which do not follow the order of the tree.
    let rng = &mut Rng::new(5);
    let mesh = worlds::soup(rng, 200, 0.3);
    let world = worlds::of_shapes(vec![
        Shape::Mesh(mesh.clone()),
        Shape::Mesh(mesh.clone()),
        Shape::Mesh(mesh),
    ]);
    let mut repeated: Vec<[u32; 3]> = Vec::new();
    let same = worlds::soup(rng, 1, 1.0);
    repeated.extend(std::iter::repeat_n([0, 1, 2], 100_000));
    let many = lucerna::geometry::TriangleMesh::new(vec![same.positions(0).to_vec()], repeated).unwrap();
    for (world, count) in [(world, 20_000), (worlds::of_mesh(many), 200)] {
        let maker = RayMaker::new(&world);
        let rays: Vec<Ray> = (0..count).map(|id| maker.ray(rng, id)).collect();
        let mut hits = 0;
        let options = BuildOptions::default();
        for (name, backend) in Bvh::build(&world, &options).variants() {
            for (ray, answer) in rays.iter().zip(intersect(&backend, &rays, None)) {
                if let Some((hit, _)) = answer {
                    hits += 1;
                    assert_eq!(hit.geometry, GeometryId(0), "{name}: {ray:?}");
                    assert!(world.instances().is_empty() && hit.instance.is_none());
                    if world.geometries().len() == 1 {
                        assert_eq!(hit.primitive, PrimitiveId(0), "{name}: {ray:?}");
                    }
                }
            }
        }
        assert!(hits > 50, "{hits}");
    }
}
