//! Worlds to trace: each a name and a world of at most a thousand primitives.

use std::f64::consts::TAU;
use std::sync::Arc;

use lucerna::geometry::{
    CurveKind, CurveSegment, CurveSet, Geometry, Group, Instance, PatchMesh, Quadric, QuadricKind, Shape, Sphere,
    TriangleMesh, TubePiece, TubeSet, World, WorldBuilder,
};
use lucerna::math::{AnimatedTransform, DAffine3, DQuat, DVec3, Vec3};

use crate::rng::Rng;

/// Unconnected triangles of one size in a cube.
pub fn soup(rng: &mut Rng, count: usize, size: f32) -> TriangleMesh {
    let mut positions = Vec::new();
    for _ in 0..count {
        let center = rng.cube();
        positions.extend((0..3).map(|_| center + size * rng.cube()));
    }
    let indices = (0..count as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    TriangleMesh::new(vec![positions], indices).unwrap()
}

/// The triangles of a grid of `n` by `n` quads over vertices in row order.
fn grid_indices(n: u32) -> Vec<[u32; 3]> {
    let mut indices = Vec::new();
    for y in 0..n {
        for x in 0..n {
            let a = y * (n + 1) + x;
            let (b, c, d) = (a + 1, a + n + 2, a + n + 1);
            indices.extend([[a, b, c], [a, c, d]]);
        }
    }
    indices
}

/// A flat square [-1, 1]² in z = 0: axis-parallel rays meet edges, vertices, and run within its plane.
pub fn square(n: u32) -> TriangleMesh {
    let at = |i: u32| 2.0 * i as f32 / n as f32 - 1.0;
    let positions = (0..=n).flat_map(|y| (0..=n).map(move |x| Vec3::new(at(x), at(y), 0.0)));
    TriangleMesh::new(vec![positions.collect()], grid_indices(n)).unwrap()
}

/// A hilly square.
pub fn terrain(n: u32, height: f32) -> TriangleMesh {
    let flat = square(n);
    let lift = |p: &Vec3| {
        Vec3::new(
            p.x,
            p.y,
            height * ((7.0 * p.x).sin() * (5.0 * p.y).cos() + (31.0 * p.x * p.y).sin()),
        )
    };
    TriangleMesh::new(
        vec![flat.positions(0).iter().map(lift).collect()],
        flat.indices().to_vec(),
    )
    .unwrap()
}

/// An octahedron, each face divided `levels` times, with its vertices at the distance that `radius` gives: a closed surface.
pub fn ball(levels: u32, radius: impl Fn(Vec3) -> f32) -> TriangleMesh {
    let mut positions = vec![Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
    let mut indices: Vec<[u32; 3]> = Vec::new();
    for (x, y, z) in [
        (0, 2, 4),
        (2, 1, 4),
        (1, 3, 4),
        (3, 0, 4),
        (2, 0, 5),
        (1, 2, 5),
        (3, 1, 5),
        (0, 3, 5),
    ] {
        indices.push([x, y, z]);
    }
    for _ in 0..levels {
        let mut middles = std::collections::HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                positions.push((positions[a as usize] + positions[b as usize]).normalize());
                positions.len() as u32 - 1
            })
        };
        let mut finer = Vec::new();
        for [a, b, c] in indices {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        indices = finer;
    }
    let positions = positions.into_iter().map(|p| p * radius(p)).collect();
    TriangleMesh::new(vec![positions], indices).unwrap()
}

/// A ball with bumps, which still sees all of itself from the middle.
pub fn bumpy_ball(levels: u32) -> TriangleMesh {
    ball(levels, |p| {
        1.0 + 0.2 * (9.0 * p.x).sin() * (8.0 * p.y + 1.0).cos() * (7.0 * p.z).sin()
    })
}

/// The axis-parallel cube [-1, 1]³.
pub fn cube() -> TriangleMesh {
    let at = |i: u32, bit: u32| if i & bit == 0 { -1.0 } else { 1.0 };
    let positions = (0..8).map(|i| Vec3::new(at(i, 1), at(i, 2), at(i, 4))).collect();
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let indices = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    TriangleMesh::new(vec![positions], indices).unwrap()
}

/// The mesh with each vertex moved.
pub fn mapped(mesh: &TriangleMesh, map: impl Fn(Vec3) -> Vec3) -> TriangleMesh {
    let positions = mesh.positions(0).iter().map(|&p| map(p)).collect();
    TriangleMesh::new(vec![positions], mesh.indices().to_vec()).unwrap()
}

/// The mesh with a time step for each map.
pub fn moving(mesh: &TriangleMesh, steps: &[&dyn Fn(Vec3) -> Vec3]) -> TriangleMesh {
    let positions = |map: &&dyn Fn(Vec3) -> Vec3| mesh.positions(0).iter().map(|&p| map(p)).collect();
    TriangleMesh::new(steps.iter().map(positions).collect(), mesh.indices().to_vec()).unwrap()
}

/// A world of geometries in world space.
pub fn of_shapes(shapes: Vec<Shape>) -> Arc<World> {
    let mut builder = WorldBuilder::default();
    for shape in shapes {
        let id = builder.add_geometry(Geometry::opaque(shape));
        builder.root.geometries.push(id);
    }
    Arc::new(builder.build().unwrap())
}

pub fn of_mesh(mesh: TriangleMesh) -> Arc<World> {
    of_shapes(vec![Shape::Mesh(mesh)])
}

/// A world of one group, placed by each transform.
pub fn instanced(shapes: Vec<Shape>, places: impl IntoIterator<Item = AnimatedTransform>) -> Arc<World> {
    let mut builder = WorldBuilder::default();
    let geometries = shapes.into_iter().map(Geometry::opaque).collect::<Vec<_>>();
    let geometries = geometries.into_iter().map(|g| builder.add_geometry(g)).collect();
    let group = builder.add_group(Group {
        geometries,
        instances: Vec::new(),
    });
    for world_from_object in places {
        builder.root.instances.push(Instance {
            group,
            world_from_object,
            mask: u32::MAX,
        });
    }
    Arc::new(builder.build().unwrap())
}

/// A rotation with scale and translation.
pub fn place(rng: &mut Rng, scale: f64, spread: f32) -> DAffine3 {
    let axis = rng.direction().as_dvec3().normalize();
    let stretch = DVec3::new(1.0, f64::from(rng.range(0.5, 1.5)), f64::from(rng.range(0.5, 1.5)));
    DAffine3::from_scale_rotation_translation(
        scale * stretch,
        DQuat::from_axis_angle(axis, f64::from(rng.range(0.0, 6.0))),
        (spread * rng.cube()).as_dvec3(),
    )
}

fn fixed(transform: DAffine3) -> AnimatedTransform {
    AnimatedTransform::fixed(transform).unwrap()
}

/// Ellipsoids in a cube.
pub fn spheres(rng: &mut Rng, count: usize) -> Shape {
    let sphere = |_| {
        let radius = f64::from(rng.range(0.02, 0.2));
        Sphere::new(1.0, place(rng, radius, 1.0)).unwrap()
    };
    Shape::Spheres((0..count).map(sphere).collect())
}

/// Spheres that are only moved, in a cube.
pub fn moved_spheres(rng: &mut Rng, count: usize) -> Shape {
    let sphere = |_| {
        let radius = f64::from(rng.range(0.02, 0.5));
        Sphere::at(rng.cube().as_dvec3(), radius).unwrap()
    };
    Shape::Spheres((0..count).map(sphere).collect())
}

/// Parts of spheres, cylinders and disks of all proportions in a cube.
pub fn quadrics(rng: &mut Rng, count: usize) -> Shape {
    let quadric = |i: usize| {
        let [a, b] = [rng.range(-1.0, 0.8), rng.range(-0.6, 1.0)].map(f64::from);
        let z = if a < b { [a, b] } else { [b, a] };
        let inner_radius = f64::from(rng.unit()) * 0.9;
        let kind = match i % 3 {
            0 => QuadricKind::Sphere { radius: 1.0, z },
            1 => QuadricKind::Cylinder {
                radius: inner_radius + 0.05,
                z,
            },
            _ => QuadricKind::Disk {
                height: a,
                radius: 1.0,
                inner_radius,
            },
        };
        let phi_max = if rng.below(2) == 0 {
            TAU
        } else {
            TAU * f64::from(rng.range(0.1, 1.0))
        };
        let scale = f64::from(rng.range(0.05, 0.3));
        Quadric::new(kind, phi_max, place(rng, scale, 1.0)).unwrap()
    };
    Shape::Quadrics((0..count).map(quadric).collect())
}

/// Bilinear patches in a cube: twisted, flat, with two corners in one place, and a flat one along the axes.
pub fn patches(rng: &mut Rng, count: usize) -> Shape {
    let mut positions = Vec::new();
    for i in 0..count {
        let center = rng.cube();
        let mut corners: [Vec3; 4] = std::array::from_fn(|_| center + 0.3 * rng.cube());
        match i % 4 {
            0 => corners[3] = corners[1] + 0.7 * (corners[2] - corners[0]),
            1 => corners[1] = corners[0],
            2 => corners = corners.map(|p| Vec3::new(p.x, p.y, center.z)),
            _ => {}
        }
        positions.extend(corners);
    }
    let indices = (0..count as u32).map(|i| [0, 1, 2, 3].map(|k| 4 * i + k)).collect();
    Shape::Patches(PatchMesh::new(positions, indices).unwrap())
}

/// Bent curves of all kinds and widths in a cube.
pub fn curves(rng: &mut Rng, count: usize, kind: CurveKind) -> Shape {
    let segment = |_| {
        let mut at = rng.cube();
        let along = 0.15 * rng.direction();
        let points = std::array::from_fn(|_| {
            at += along + 0.05 * rng.cube();
            at
        });
        CurveSegment {
            points,
            widths: [rng.range(0.0, 0.1), rng.range(0.01, 0.1)],
            normals: [rng.direction(), rng.direction()],
        }
    };
    let segments = (0..count).map(segment).collect();
    Shape::Curves(CurveSet::new(segments, kind, 2, DAffine3::IDENTITY).unwrap())
}

/// Pieces of tubes of all proportions in a cube, closed and open, and some that are balls.
pub fn tubes(rng: &mut Rng, count: usize) -> Shape {
    let piece = |i: usize| {
        let start = rng.cube();
        let along = 0.3 * rng.direction();
        let axis = along.normalize();
        TubePiece {
            ends: [start, start + along * if i % 8 == 7 { 0.01 } else { 1.0 }],
            radii: [rng.range(0.01, 0.1), rng.range(0.0, 0.1)],
            along: [0.0, 1.0],
            tangents: i
                .is_multiple_of(2)
                .then(|| [(axis + 0.1 * rng.direction()).normalize(), axis]),
            is_joined: false,
        }
    };
    Shape::Tubes(TubeSet::new((0..count).map(piece).collect(), DAffine3::IDENTITY).unwrap())
}

/// Many of the same triangle, triangles without area, and triangles that share planes and edges.
fn degenerate(rng: &mut Rng) -> TriangleMesh {
    let mut positions: Vec<Vec3> = (0..60).map(|_| rng.cube()).collect();
    let mut indices: Vec<[u32; 3]> = (0..40).map(|_| [0, 1, 2]).collect();
    indices.extend((0..20u32).map(|i| [i, i, i + 1]));
    indices.extend((0..20u32).map(|i| [i, i, i]));
    for i in 0..20 {
        let (a, b) = (positions[i], positions[i + 20]);
        positions.push(0.5 * (a + b));
        indices.push([i as u32, i as u32 + 20, positions.len() as u32 - 1]);
    }
    let flat = positions.len() as u32;
    positions.extend((0..60).map(|_| rng.cube() * Vec3::new(1.0, 1.0, 0.0) + Vec3::new(0.0, 0.0, 0.25)));
    indices.extend((0..20).map(|i| [flat + 3 * i, flat + 3 * i + 1, flat + 3 * i + 2]));
    TriangleMesh::new(vec![positions], indices).unwrap()
}

/// The same triangle twice, others in a plane, and some without area.
fn partly_degenerate(rng: &mut Rng) -> TriangleMesh {
    let mut positions: Vec<Vec3> = (0..12).map(|_| rng.cube()).collect();
    positions.extend((0..12).map(|_| rng.cube() * Vec3::new(1.0, 0.0, 1.0)));
    let mut indices = vec![[0, 1, 2], [1, 2, 0], [3, 4, 4], [5, 5, 5]];
    for i in 0..8 {
        let (a, b) = (positions[i], positions[i + 4]);
        positions.push(0.5 * (a + b));
        indices.push([i as u32, i as u32 + 4, positions.len() as u32 - 1]);
    }
    indices.extend((0..8u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]));
    TriangleMesh::new(vec![positions], indices).unwrap()
}

/// All worlds of the agreement test.
pub fn all() -> Vec<(&'static str, Arc<World>)> {
    let rng = &mut Rng::new(1);
    let unmoved: &dyn Fn(Vec3) -> Vec3 = &|p| p;
    let shifted: &dyn Fn(Vec3) -> Vec3 = &|p| p * 0.7 + Vec3::new(0.5, -0.3, 0.2);
    let twisted: &dyn Fn(Vec3) -> Vec3 = &|p| Vec3::new(p.y, -p.x, p.z + 0.3 * p.x);
    let soup_moves = moving(&soup(rng, 100, 0.3), &[unmoved, shifted]);
    let ball_moves = moving(&bumpy_ball(2), &[unmoved, shifted, twisted, unmoved]);
    let both_move = vec![
        Shape::Mesh(moving(&soup(rng, 50, 0.3), &[unmoved, shifted, twisted])),
        Shape::Mesh(soup(rng, 50, 0.3)),
        Shape::Mesh(moving(&soup(rng, 50, 0.3), &[shifted, twisted])),
        spheres(rng, 20),
    ];
    let motion = |rng: &mut Rng| AnimatedTransform::new(place(rng, 0.3, 1.0), place(rng, 0.4, 1.0)).unwrap();
    let huge = mapped(&soup(rng, 100, 0.3), |p| p * 1e10);
    let far = mapped(&bumpy_ball(2), |p| p + Vec3::new(5e3, -3e3, 1e3));
    let needles = mapped(&soup(rng, 100, 0.3), |p| p * Vec3::new(1.0, 1e-4, 1.0));
    vec![
        ("nothing", of_shapes(Vec::new())),
        ("empty mesh", of_mesh(TriangleMesh::new(vec![vec![]], vec![]).unwrap())),
        ("one triangle", of_mesh(soup(rng, 1, 1.0))),
        ("soup", of_mesh(soup(rng, 400, 0.3))),
        ("large triangles", of_mesh(soup(rng, 50, 2.0))),
        ("square", of_mesh(square(8))),
        ("terrain", of_mesh(terrain(12, 0.2))),
        ("cube", of_mesh(cube())),
        ("bumpy ball", of_mesh(bumpy_ball(2))),
        ("degenerate", of_mesh(degenerate(rng))),
        ("needles", of_mesh(needles)),
        ("huge", of_mesh(huge)),
        ("far", of_mesh(far)),
        ("tiny", of_mesh(mapped(&bumpy_ball(2), |p| p * 1e-6))),
        ("moving soup", of_mesh(soup_moves)),
        ("moving ball of four steps", of_mesh(ball_moves)),
        ("moving, fixed and spheres", of_shapes(both_move)),
        ("spheres", of_shapes(vec![spheres(rng, 50)])),
        (
            "sphere of radius 1e5",
            of_shapes(vec![Shape::Spheres(vec![
                Sphere::at(DVec3::new(1e5 + 1.0, 0.0, 0.0), 1e5).unwrap(),
            ])]),
        ),
        ("quadrics", of_shapes(vec![quadrics(rng, 60)])),
        ("patches", of_shapes(vec![patches(rng, 80)])),
        (
            "curves",
            of_shapes(vec![
                curves(rng, 30, CurveKind::Flat),
                curves(rng, 30, CurveKind::Cylinder),
                curves(rng, 30, CurveKind::Ribbon),
            ]),
        ),
        (
            "instances of curves",
            instanced(
                vec![curves(rng, 8, CurveKind::Flat), curves(rng, 8, CurveKind::Ribbon)],
                (0..6).map(|_| fixed(place(rng, 0.5, 1.0))).collect::<Vec<_>>(),
            ),
        ),
        (
            "moving instances of curves",
            instanced(
                vec![curves(rng, 8, CurveKind::Cylinder)],
                (0..6).map(|_| motion(rng)).collect::<Vec<_>>(),
            ),
        ),
        (
            "instances of quadrics and patches",
            instanced(
                vec![quadrics(rng, 6), patches(rng, 8)],
                (0..10).map(|_| fixed(place(rng, 0.3, 1.0))).collect::<Vec<_>>(),
            ),
        ),
        (
            "moving instances of quadrics and patches",
            instanced(
                vec![quadrics(rng, 6), patches(rng, 8), Shape::Mesh(soup(rng, 20, 0.5))],
                (0..8).map(|_| motion(rng)).collect::<Vec<_>>(),
            ),
        ),
        (
            "instances",
            instanced(
                vec![Shape::Mesh(bumpy_ball(1)), spheres(rng, 5)],
                (0..10).map(|_| fixed(place(rng, 0.3, 1.0))).collect::<Vec<_>>(),
            ),
        ),
        (
            "moving instances",
            instanced(
                vec![Shape::Mesh(cube()), spheres(rng, 5)],
                (0..8).map(|_| motion(rng)).collect::<Vec<_>>(),
            ),
        ),
        (
            "moving instances of moving meshes",
            instanced(
                vec![
                    Shape::Mesh(moving(&cube(), &[unmoved, shifted])),
                    Shape::Mesh(soup(rng, 30, 0.5)),
                ],
                (0..10).map(|_| motion(rng)).collect::<Vec<_>>(),
            ),
        ),
        ("tubes", of_shapes(vec![tubes(rng, 80)])),
        (
            "instances of tubes",
            instanced(
                vec![tubes(rng, 12)],
                (0..6).map(|_| fixed(place(rng, 0.5, 1.0))).collect::<Vec<_>>(),
            ),
        ),
        (
            "few triangles and spheres",
            of_shapes(vec![
                moved_spheres(rng, 6),
                Shape::Mesh(soup(rng, 20, 1.0)),
                Shape::Mesh(cube()),
                moved_spheres(rng, 4),
            ]),
        ),
        ("few spheres", of_shapes(vec![moved_spheres(rng, 12), spheres(rng, 12)])),
        ("few huge triangles", of_mesh(mapped(&soup(rng, 30, 1.0), |p| p * 1e10))),
        (
            "few needles",
            of_mesh(mapped(&soup(rng, 40, 1.0), |p| p * Vec3::new(1.0, 1e-4, 1.0))),
        ),
        ("few triangles, some without area", of_mesh(partly_degenerate(rng))),
    ]
}

/// Worlds so large or so small that Embree's edge functions, products of three coordinates, overflow or vanish.
pub fn extreme() -> Vec<(&'static str, Arc<World>)> {
    let scaled = |mesh: TriangleMesh, scale: f32| of_mesh(mapped(&mesh, |p| p * scale));
    let rng = &mut Rng::new(2);
    vec![
        ("soup times 2e17", scaled(soup(rng, 100, 0.3), 2e17)),
        ("ball times 1e-18", scaled(bumpy_ball(2), 1e-18)),
        ("ball times 1e-30", scaled(bumpy_ball(2), 1e-30)),
        ("few triangles times 2e17", scaled(soup(rng, 30, 1.0), 2e17)),
        ("few triangles times 1e-30", scaled(soup(rng, 30, 1.0), 1e-30)),
    ]
}
