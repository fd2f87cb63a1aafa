use super::*;

fn octahedron() -> MeshDesc {
    MeshDesc {
        positions: vec![Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z],
        indices: vec![
            [0, 2, 4],
            [2, 1, 4],
            [1, 3, 4],
            [3, 0, 4],
            [2, 0, 5],
            [1, 2, 5],
            [3, 1, 5],
            [0, 3, 5],
        ],
        ..MeshDesc::default()
    }
}

/// A square of 8 triangles around its middle, in the plane z = 0.
fn square() -> MeshDesc {
    let positions = (0..9).map(|i| Vec3::new((i % 3) as f32, (i / 3) as f32, 0.0)).collect();
    let indices = vec![
        [0, 1, 4],
        [0, 4, 3],
        [1, 2, 4],
        [2, 5, 4],
        [4, 5, 8],
        [4, 8, 7],
        [3, 4, 7],
        [3, 7, 6],
    ];
    MeshDesc {
        positions,
        indices,
        ..MeshDesc::default()
    }
}

#[test]
fn limits_do_not_depend_on_the_level() {
    // A vertex of the cage has the same place on the limit surface however often the cage is refined before.
    for cage in [octahedron(), square()] {
        let coarse = subdivided(&cage, 0).unwrap();
        let fine = subdivided(&cage, 4).unwrap();
        assert_eq!(fine.indices.len(), cage.indices.len() << 8);
        // The vertices that are on no boundary.
        let inner = if cage.positions.len() == 9 { 4..5 } else { 0..6 };
        for v in inner {
            let [a, b] = [&coarse, &fine].map(|mesh| mesh.positions[v]);
            assert!((a - b).length() < 1e-6, "{a} {b}");
        }
    }
}

#[test]
fn a_closed_surface_stays_closed_and_its_normals_point_as_those_of_pbrt() {
    let mesh = subdivided(&octahedron(), 3).unwrap();
    // Euler: V - E + F = 2, with 3 F = 2 E.
    assert_eq!(mesh.positions.len(), mesh.indices.len() / 2 + 2);
    let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
    for [a, b, c] in &mesh.indices {
        for (p, q) in [(a, b), (b, c), (c, a)] {
            *edges.entry((*p.min(q), *p.max(q))).or_default() += if p < q { 1 } else { -1 };
        }
    }
    assert!(edges.values().all(|&balance| balance == 0));
    for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
        // By symmetry normals at the six vertices are exactly along the axes, and nearly radial elsewhere; inward, as the cage
        // runs anticlockwise seen from outside.
        assert!(n.dot(p.normalize()) < -0.9, "{p} {n}");
    }
    assert!((mesh.normals[0] + Vec3::X).length() < 1e-6);
}

#[test]
fn the_limit_of_an_octahedron_is_where_its_eigenvector_says() {
    // Valence 4: beta = 3/32, so the limit weights are 1 / (4 + 3 / (8 beta)) = 1/8 each, and 1/2 for the vertex.
    let mesh = subdivided(&octahedron(), 0).unwrap();
    assert!((mesh.positions[0] - Vec3::X * 0.5).length() < 1e-6);
}

#[test]
fn a_plane_stays_a_plane_and_its_corners_are_rounded() {
    let mesh = subdivided(&square(), 3).unwrap();
    assert!(mesh.positions.iter().all(|p| p.z == 0.0));
    assert!(mesh.normals.iter().all(|n| (*n + Vec3::Z).length() < 1e-6));
    // The corner (0, 0) by the boundary's weights 1/5, 3/5, 1/5.
    let mesh = subdivided(&square(), 0).unwrap();
    assert!((mesh.positions[0] - Vec3::new(0.2, 0.2, 0.0)).length() < 1e-6);
}

#[test]
fn cages_that_are_no_surface_are_refused() {
    let with = |indices: Vec<[u32; 3]>| MeshDesc {
        positions: octahedron().positions,
        indices,
        ..MeshDesc::default()
    };
    for (indices, message) in [
        (vec![[0, 2, 4], [0, 2, 5]], "go round the same way"),
        (vec![[0, 2, 4], [2, 0, 5], [0, 2, 1]], "more than two triangles"),
        (vec![[0, 2, 2]], "has the vertex 2 twice"),
    ] {
        let error = subdivided(&with(indices), 1).expect_err(message);
        assert!(error.contains(message), "{error}");
    }
    assert!(subdivided(&octahedron(), 20).is_err());
    // Vertices that no triangle has, and two fans that meet at a point, are no harm.
    assert!(subdivided(&with(vec![[0, 2, 4]]), 2).is_ok());
    assert!(subdivided(&with(vec![[0, 2, 4], [0, 3, 5]]), 2).is_ok());
}
