//! Searches against going through all points.

use super::nodes::LEAF;
use super::{KdTree, Nearest};
use crate::math::{Vec2, Vec3};
use crate::sampling::hash::{hash_u32s, unit_f32};
use crate::sampling::warp;

fn unit(index: usize, purpose: u32) -> f32 {
    unit_f32(hash_u32s(&[index as u32, purpose]) as u32)
}

fn random(index: usize, purpose: u32) -> Vec3 {
    Vec3::from([0, 1, 2].map(|axis| unit(index, purpose + axis)))
}

/// Points by name, of which there are more than one level of nodes.
fn clouds() -> Vec<(&'static str, Vec<Vec3>)> {
    let count = 3000;
    let cloud = |point: &dyn Fn(usize) -> Vec3| (0..count).map(point).collect();
    let oblique = Vec3::new(0.3, -0.7, 0.2);
    vec![
        ("in a cube", cloud(&|i| random(i, 0))),
        (
            "on a sphere",
            cloud(&|i| warp::sample_uniform_sphere(Vec2::new(unit(i, 0), unit(i, 1)))),
        ),
        (
            "in clusters",
            cloud(&|i| random(i % 7, 3) + 1e-3 * random(i, 0).powf(3.0)),
        ),
        ("in a plane", cloud(&|i| random(i, 0) * Vec3::new(1.0, 0.0, 1.0))),
        (
            "in an oblique plane",
            cloud(&|i| random(i, 0).reject_from(oblique.normalize())),
        ),
        ("on a line", cloud(&|i| Vec3::Y * unit(i, 0))),
        ("on an oblique line", cloud(&|i| oblique * unit(i, 0))),
        ("at one point", cloud(&|_| oblique)),
        (
            "at two points",
            cloud(&|i| if unit(i, 0) < 0.3 { oblique } else { Vec3::ZERO }),
        ),
        ("on a grid", cloud(&|i| (8.0 * random(i, 0)).floor() / 8.0)),
        (
            "around zero",
            cloud(&|i| if i % 2 == 0 { Vec3::ZERO } else { -Vec3::ZERO }),
        ),
        ("far away", cloud(&|i| 1e6 + random(i, 0))),
    ]
}

/// Points to search around: some of the points, some near, some far.
fn queries(points: &[Vec3]) -> Vec<Vec3> {
    let center = points.iter().sum::<Vec3>() / points.len().max(1) as f32;
    let some = points.iter().step_by(points.len() / 10 + 1);
    let near = some.clone().map(|p| *p + 0.05 * (random(1, 6) - 0.5));
    some.copied()
        .chain(near)
        .chain([center, center + 10.0, center - 2.0 * Vec3::Y, Vec3::splat(1e15)])
        .collect()
}

fn distance_squared(p: Vec3, q: Vec3) -> f32 {
    let d = q - p;
    (d.x * d.x + d.y * d.y) + d.z * d.z
}

/// Squared distances and indices of the accepted points within a radius, in order.
fn by_distance(points: &[Vec3], p: Vec3, radius: f32, accept: impl Fn(usize) -> bool) -> Vec<(f32, usize)> {
    let mut all: Vec<_> = points.iter().map(|q| distance_squared(p, *q)).zip(0..).collect();
    all.retain(|(d, i)| *d <= radius * radius && accept(*i));
    all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    all
}

/// What was found, as [`by_distance`] has it; and that places ascend.
fn found_by_distance(tree: &KdTree, found: &Nearest) -> Vec<(f32, usize)> {
    assert!(found.places().is_sorted_by(|a, b| a < b));
    assert_eq!(found.places().len(), found.distances_squared().len());
    let indices = found
        .places()
        .iter()
        .map(|place| tree.order()[*place as usize] as usize);
    let mut all: Vec<_> = found.distances_squared().iter().copied().zip(indices).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    all
}

#[test]
fn the_nearest_are_those_that_going_through_all_points_finds() {
    let mut found = Nearest::new();
    for (name, points) in clouds() {
        let tree = KdTree::build(&points);
        for p in queries(&points) {
            for k in [1, 2, 7, 50, 64, 500, 3000, 4000] {
                for radius in [0.0, 0.01, 0.3, 20.0, f32::INFINITY] {
                    let mut expected = by_distance(&points, p, radius, |_| true);
                    expected.truncate(k);
                    tree.nearest(p, k, radius, |_| true, &mut found);
                    let radius_squared = match expected.last() {
                        Some((d, _)) if expected.len() == k => *d,
                        _ => (radius * radius).min(f32::MAX),
                    };
                    let case = format!("points {name}, k = {k} within {radius} of {p}");
                    assert_eq!(found_by_distance(&tree, &found), expected, "{case}");
                    assert_eq!(found.radius_squared(), radius_squared, "{case}");
                }
            }
        }
    }
}

#[test]
fn points_that_are_not_accepted_do_not_count() {
    let mut found = Nearest::new();
    for (name, points) in clouds() {
        let tree = KdTree::build(&points);
        for p in queries(&points) {
            for share in [0, 1, 10, 200] {
                let accept = |index: usize| unit(index, 9) * 200.0 < share as f32;
                let mut expected = by_distance(&points, p, 0.5, accept);
                expected.truncate(20);
                tree.nearest(
                    p,
                    20,
                    0.5,
                    |place| accept(tree.order()[place as usize] as usize),
                    &mut found,
                );
                assert_eq!(
                    found_by_distance(&tree, &found),
                    expected,
                    "points {name}, {share} of 200, at {p}"
                );
            }
        }
    }
}

#[test]
fn few_points_are_found_too() {
    let all: Vec<_> = (0..2 * LEAF + 2).map(|i| random(i, 0)).collect();
    let k = 50;
    let mut found = Nearest::new();
    for count in [
        0,
        1,
        2,
        LEAF - 1,
        LEAF,
        LEAF + 1,
        k - 1,
        k,
        k + 1,
        2 * LEAF,
        2 * LEAF + 1,
    ] {
        let points = &all[..count];
        let tree = KdTree::build(points);
        assert_eq!(tree.len(), count);
        assert_eq!(tree.is_empty(), count == 0);
        let mut expected = by_distance(points, Vec3::ZERO, f32::INFINITY, |_| true);
        expected.truncate(k);
        tree.nearest(Vec3::ZERO, k, f32::INFINITY, |_| true, &mut found);
        assert_eq!(found_by_distance(&tree, &found), expected, "{count} points");
    }
}

#[test]
fn nothing_is_found_where_nothing_is_asked_for() {
    let points: Vec<_> = (0..100).map(|i| random(i, 0)).collect();
    let tree = KdTree::build(&points);
    let mut found = Nearest::new();
    for (k, radius) in [(0, 1.0), (5, -1.0), (5, f32::NAN)] {
        tree.nearest(points[0], 5, 1.0, |_| true, &mut found);
        assert_eq!(found.len(), 5);
        tree.nearest(points[0], k, radius, |_| true, &mut found);
        assert!(found.is_empty(), "k = {k} within {radius}");
    }
    for radius in [-1.0, f32::NAN] {
        tree.within(points[0], radius, |place, _| {
            panic!("place {place} is not within {radius}")
        });
    }
}

#[test]
fn all_points_within_a_radius_are_visited_once_and_in_order() {
    for (name, points) in clouds() {
        let tree = KdTree::build(&points);
        for p in queries(&points) {
            for radius in [0.0, 0.01, 0.3, 20.0, f32::INFINITY] {
                let mut places = Vec::new();
                let mut visited = Vec::new();
                tree.within(p, radius, |place, d| {
                    places.push(place);
                    visited.push((d, tree.order()[place as usize] as usize));
                });
                assert!(places.is_sorted_by(|a, b| a < b));
                visited.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
                let expected = by_distance(&points, p, radius, |_| true);
                assert_eq!(visited, expected, "points {name} within {radius} of {p}");
            }
        }
    }
}

#[test]
fn a_point_at_the_radius_is_within() {
    let tree = KdTree::build(&[Vec3::new(0.1, 0.0, 0.0), Vec3::new(0.0, 0.3, 0.0)]);
    let mut found = Nearest::new();
    tree.nearest(Vec3::ZERO, 5, 0.1, |_| true, &mut found);
    assert_eq!(found.places().len(), 1);
    tree.nearest(Vec3::ZERO, 5, 0.1f32.next_down(), |_| true, &mut found);
    assert!(found.is_empty());
}

#[test]
fn the_order_has_every_point_once() {
    for (name, points) in clouds() {
        let tree = KdTree::build(&points);
        let mut indices = tree.order().to_vec();
        indices.sort_unstable();
        assert!(indices.into_iter().eq(0..points.len() as u32), "points {name}");
    }
}

#[test]
fn the_tree_is_the_same_for_any_number_of_threads() {
    let points: Vec<_> = (0..100_000).map(|i| (64.0 * random(i, 0)).floor()).collect();
    let build = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("a pool");
        pool.install(|| KdTree::build(&points))
    };
    let one = build(1);
    for threads in [2, 3] {
        let other = build(threads);
        assert_eq!(one.order(), other.order());
        assert_eq!(format!("{one:?}"), format!("{other:?}"));
    }
}

#[test]
fn a_batch_finds_what_its_queries_find() {
    for (name, points) in clouds() {
        let tree = KdTree::build(&points);
        let queries = queries(&points);
        let mut times = vec![0; queries.len()];
        let mut found = Nearest::new();
        let accept = |query: usize, place: u32| !(query + place as usize).is_multiple_of(3);
        tree.nearest_batch(&queries, 30, 0.4, accept, &mut found, |query, found| {
            let mut alone = Nearest::new();
            tree.nearest(queries[query], 30, 0.4, |place| accept(query, place), &mut alone);
            assert_eq!(found.places(), alone.places(), "points {name}, query {query}");
            assert_eq!(found.distances_squared(), alone.distances_squared());
            assert_eq!(found.radius_squared(), alone.radius_squared());
            times[query] += 1;
        });
        assert!(times.iter().all(|n| *n == 1), "points {name}: each query once");
    }
}

#[test]
fn of_many_points_equally_far_few_are_looked_at() {
    let tree = KdTree::build(&vec![Vec3::ONE; 100_000]);
    let mut found = Nearest::new();
    let asked = std::cell::Cell::new(0);
    let accept = |_: u32| {
        asked.set(asked.get() + 1);
        true
    };
    tree.nearest(Vec3::ZERO, 50, f32::INFINITY, accept, &mut found);
    assert_eq!(found.len(), 50);
    assert!(found.places().iter().all(|place| tree.order()[*place as usize] < 50));
    // Two leaves have enough of them.
    assert!(asked.get() <= 4 * LEAF, "{} points looked at", asked.get());
}
