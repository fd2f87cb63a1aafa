//! Shapes with the parameters of pbrt, and its defaults.

use glam::{Vec2, Vec3};
use lucerna::desc::{CurveKindDesc, QuadricDesc, ShapeKind, Textured, TubeBasis};

use super::{errors, world};

fn kinds(text: &str) -> Vec<ShapeKind> {
    world(text).shapes.into_iter().map(|shape| shape.kind).collect()
}

/// The surface and how far it goes around.
fn quadric(kind: &ShapeKind) -> (QuadricDesc, f64) {
    match kind {
        ShapeKind::Quadric { surface, phi_max } => (*surface, *phi_max),
        other => panic!("{other:?}"),
    }
}

#[test]
fn quadrics_have_the_parameters_of_pbrt() {
    let kinds = kinds(
        r#"Shape "cylinder"
        Shape "cylinder" "float radius" 2 "float zmin" 3 "float zmax" -1 "float phimax" 90
        Shape "disk"
        Shape "disk" "float height" 2 "float radius" 3 "float innerradius" 1 "float phimax" 400
        Shape "sphere" "float radius" 2 "float zmin" -1 "float zmax" 9 "float phimax" 360
        Shape "sphere" "float phimax" 180
        Shape "sphere" "float radius" 2 "float zmin" -2 "float zmax" 2 "float phimax" 360"#,
    );
    let z = [-1.0, 1.0];
    let disk = |height, radius, inner_radius| QuadricDesc::Disk {
        height,
        radius,
        inner_radius,
        radial_uv: false,
    };
    let expected = [
        (QuadricDesc::Cylinder { radius: 1.0, z }, 360.0),
        (
            QuadricDesc::Cylinder {
                radius: 2.0,
                z: [-1.0, 3.0],
            },
            90.0,
        ),
        (disk(0.0, 1.0, 0.0), 360.0),
        (disk(2.0, 3.0, 1.0), 360.0),
        (
            QuadricDesc::Sphere {
                radius: 2.0,
                z: [-1.0, 2.0],
            },
            360.0,
        ),
        (QuadricDesc::Sphere { radius: 1.0, z }, 180.0),
    ];
    for (kind, expected) in kinds.iter().zip(expected) {
        assert_eq!(quadric(kind), expected);
    }
    assert!(matches!(kinds[6], ShapeKind::Sphere { radius: 2.0 }));
}

#[test]
fn patches_arrive_whole() {
    let points = "\"point3 P\" [0 0 0  1 0 0  0 1 0  1 1 1]";
    let text = format!(
        "Shape \"bilinearmesh\" {points}\nShape \"bilinearmesh\" {points} \"integer indices\" [0 1 2 3  3 2 1 0]
         \"normal N\" [0 0 1 0 0 1 0 0 1 1 0 0] \"point2 uv\" [0 0 2 0 0 2 2 2]"
    );
    let kinds = kinds(&text);
    let mesh = |i: usize| match &kinds[i] {
        ShapeKind::BilinearMesh(mesh) => mesh,
        other => panic!("{other:?}"),
    };
    assert_eq!(mesh(0).indices, [[0, 1, 2, 3]]);
    assert!(mesh(0).normals.is_empty() && mesh(0).uvs.is_empty());
    assert_eq!(mesh(1).indices, [[0, 1, 2, 3], [3, 2, 1, 0]]);
    assert_eq!((mesh(1).positions[3], mesh(1).normals[3]), (Vec3::ONE, Vec3::X));
    assert_eq!(mesh(1).uvs[1], Vec2::X * 2.0);
}

#[test]
fn cages_and_displacements_arrive_with_their_defaults() {
    let cage = "\"point3 P\" [0 0 0  1 0 0  0 1 0] \"integer indices\" [0 1 2]";
    let kinds = kinds(&format!(
        "Shape \"loopsubdiv\" {cage}\nShape \"loopsubdiv\" {cage} \"integer levels\" 1 \"string scheme\" \"loop\""
    ));
    let levels: Vec<u32> = kinds
        .iter()
        .map(|kind| match kind {
            ShapeKind::LoopSubdivision { levels, cage } if cage.indices == [[0, 1, 2]] => *levels,
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(levels, [3, 1]);
    let directory = tempfile::tempdir().unwrap();
    let text = "WorldBegin Texture \"bumps\" \"float\" \"checkerboard\"
        Shape \"plymesh\" \"string filename\" \"m.ply\" \"texture displacement\" \"bumps\"
        Shape \"plymesh\" \"string filename\" \"m.ply\" \"texture displacement\" \"bumps\" \"float displacement.edgelength\" .25
        Shape \"plymesh\" \"string filename\" \"m.ply\" \"texture displacement\" \"bumps\" \"float edgelength\" .5";
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
               property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2";
    std::fs::write(directory.path().join("m.ply"), ply).unwrap();
    std::fs::write(directory.path().join("main.pbrt"), text).unwrap();
    let scene =
        lucerna::desc::load(&directory.path().join("main.pbrt"), &super::STRICT).unwrap_or_else(|e| panic!("{e}"));
    let lengths: Vec<f64> = scene
        .shapes
        .iter()
        .map(|shape| match &shape.kind {
            ShapeKind::DisplacedMesh { displacement, .. } => {
                assert!(matches!(displacement.texture, Textured::Texture(_)));
                displacement.edge_length
            }
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(lengths, [1.0, 0.25, 0.5]);
}

#[test]
fn curves_of_every_basis_are_cubic_segments() {
    let points = "\"point3 P\" [0 0 0  3 0 0  3 3 0  0 3 3]";
    let kinds = kinds(&format!(
        "Shape \"curve\" {points}\nShape \"curve\" {points} \"string basis\" \"bspline\" \"string type\" \"cylinder\" \"float width0\" .5
         Shape \"curve\" \"point3 P\" [0 0 0  3 0 0  3 3 0] \"integer degree\" 2 \"float width\" .25 \"integer splitdepth\" 0
         Shape \"curve\" {points} \"integer degree\" 2 \"string basis\" \"bspline\" \"string type\" \"ribbon\" \"normal N\" [0 0 1 0 1 0 1 0 0]"
    ));
    let curve = |i: usize| match &kinds[i] {
        ShapeKind::Curve(curve) => curve,
        other => panic!("{other:?}"),
    };
    let v = Vec3::new;
    assert_eq!(
        curve(0).segments,
        [[v(0.0, 0.0, 0.0), v(3.0, 0.0, 0.0), v(3.0, 3.0, 0.0), v(0.0, 3.0, 3.0)]]
    );
    assert_eq!(
        (curve(0).widths, curve(0).kind, curve(0).split_depth),
        ([1.0, 1.0], CurveKindDesc::Flat, 3)
    );
    assert_eq!(
        curve(1).segments,
        [[v(2.5, 0.5, 0.0), v(3.0, 1.0, 0.0), v(3.0, 2.0, 0.0), v(2.5, 2.5, 0.5)]]
    );
    assert_eq!((curve(1).widths, curve(1).kind), ([0.5, 1.0], CurveKindDesc::Cylinder));
    assert_eq!(
        curve(2).segments,
        [[v(0.0, 0.0, 0.0), v(2.0, 0.0, 0.0), v(3.0, 1.0, 0.0), v(3.0, 3.0, 0.0)]]
    );
    assert_eq!((curve(2).widths, curve(2).split_depth), ([0.25, 0.25], 0));
    assert_eq!(curve(3).segments.len(), 2);
    assert_eq!(
        curve(3).segments[0],
        [v(1.5, 0.0, 0.0), v(2.5, 0.0, 0.0), v(3.0, 0.5, 0.0), v(3.0, 1.5, 0.0)]
    );
    assert_eq!(curve(3).normals, [Vec3::Z, Vec3::Y, Vec3::X]);
}

#[test]
fn tubes_have_a_radius_at_each_point() {
    let kinds = kinds(
        "Shape \"tubes\" \"point3 P\" [0 0 0  1 0 0  1 1 0]
         Shape \"tubes\" \"point3 P\" [0 0 0  1 0 0  1 1 0  2 2 2] \"float radius\" .5 \"integer counts\" [2 2]
         Shape \"tubes\" \"string basis\" \"bspline\" \"point3 P\" [0 0 0  1 0 0  1 1 0  2 2 2] \"float radius\" [.1 .2 0 .4]",
    );
    let tubes = |i: usize| match &kinds[i] {
        ShapeKind::Tubes(tubes) => tubes,
        other => panic!("{other:?}"),
    };
    assert_eq!(
        (tubes(0).basis, &tubes(0).radii[..], &tubes(0).counts[..]),
        (TubeBasis::Linear, &[1.0; 3][..], &[3][..])
    );
    assert_eq!(
        (&tubes(1).radii[..], &tubes(1).counts[..]),
        (&[0.5; 4][..], &[2, 2][..])
    );
    assert_eq!(
        (tubes(2).basis, &tubes(2).radii[..], &tubes(2).counts[..]),
        (TubeBasis::CubicBSpline, &[0.1, 0.2, 0.0, 0.4][..], &[4][..])
    );
}

#[test]
fn bad_displacements_are_refused() {
    for (parameter, message) in [
        (
            "\"texture displacement\" \"no such\"",
            "there is no float texture `no such`",
        ),
        ("\"float displacement.edgelength\" 0", "it must be positive"),
        ("\"float edgelength\" -1", "it must be positive"),
    ] {
        // The file is missing too.
        let found = errors(&format!(
            "WorldBegin Shape \"plymesh\" \"string filename\" \"x.ply\" {parameter}"
        ));
        assert_eq!(found.len(), 2);
        assert!(
            found.iter().any(|e| e.message.contains(message)),
            "{parameter}: {found:?}"
        );
    }
}
