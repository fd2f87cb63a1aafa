//! `Shape`: kinds, values, meshes.

use super::{Case, check};

#[test]
fn kinds_and_values() {
    let cases: [Case; 11] = [
        (
            "WorldBegin Shape \"sphere\" \"float radius\" @\"big\"",
            "expected a finite number, found `\"big\"`",
            "",
        ),
        (
            "WorldBegin Shape \"sphere\" \"float radius\" [1 @x]",
            "expected a finite number, found `x`",
            "",
        ),
        (
            "WorldBegin Shape \"sphere\" \"float radius\" @[1 2]",
            "takes 1 value, found 2",
            "",
        ),
        (
            "WorldBegin Shape \"sphere\" \"float radius\" @[]",
            "takes 1 value, found 0",
            "",
        ),
        (
            "WorldBegin Shape \"sphere\" @\"integer radius\" 1",
            "has the type `integer`, expected `float`",
            "",
        ),
        (
            "WorldBegin Shape \"sphere\" \"float radius\" @-2",
            "`radius` is -2, it must be positive",
            "",
        ),
        (
            "WorldBegin Shape \"sphere\" \"float radius\" @0",
            "must be positive",
            "",
        ),
        (
            "WorldBegin Shape \"sphere\" \"float radius\" @1e39",
            "does not fit into 32-bit",
            "",
        ),
        (
            "WorldBegin Shape \"sphere\" @\"float raduis\" 2",
            "shape `sphere` has no parameter `raduis`",
            "`radius`",
        ),
        ("WorldBegin Shape @\"spere\"", "unknown shape `spere`", "`sphere`"),
        (
            "WorldBegin Shape @\"teapot\"",
            "unknown shape `teapot`",
            "supported are trianglemesh, ",
        ),
    ];
    cases.iter().for_each(check);
}

#[test]
fn meshes() {
    let cases: [Case; 12] = [
        ("WorldBegin Shape @\"trianglemesh\"", "no vertices", ""),
        (
            "WorldBegin Shape @\"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1]",
            "no `\"integer indices\"`",
            "",
        ),
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" @[0 0 0 1 0 0 0 1]",
            "3 numbers a vertex, found 8",
            "",
        ),
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 @nan 0]",
            "finite",
            "",
        ),
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0\n 0 @1e40 0]",
            "32-bit",
            "",
        ),
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 # three\n @3 2 1 0]",
            "there is no vertex 3: `P` has 3",
            "",
        ),
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 @-1]",
            "there is no vertex -1",
            "",
        ),
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" @[0 1]",
            "3 integers a triangle, found 2",
            "",
        ),
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"normal N\" @[0 0 1 0 0 1]",
            "`N` is given for 2 vertices, but there are 3",
            "",
        ),
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] @\"vector3 N\" [0 0 1]",
            "has the type `vector3`, expected `normal`",
            "",
        ),
        ("WorldBegin Shape @\"plymesh\"", "no `\"string filename\"`", ""),
        (
            "WorldBegin Shape \"plymesh\" \"string filename\" @\"no/such.ply\"",
            "cannot read the mesh",
            "",
        ),
    ];
    cases.iter().for_each(check);
}

/// One mistake is one error: what could only be judged without it is passed over.
#[test]
fn nothing_follows_from_a_mistake() {
    let cases: [Case; 5] = [
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 @1e40] \"integer indices\" [0 1 2] \"float vertex_a\" [1 2 3]",
            "32-bit",
            "",
        ),
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 @7] \"float face_a\" [1]",
            "there is no vertex 7",
            "",
        ),
        (
            "WorldBegin Shape \"bilinearmesh\" \"point3 P\" @[0 0] \"integer indices\" [0 1 2 3]",
            "3 numbers a vertex, found 2",
            "",
        ),
        (
            "WorldBegin Shape \"cylinder\" @\"float zmin\" 1 \"float phimax\" 90",
            "`zmin` and `zmax` are equal",
            "",
        ),
        (
            "WorldBegin Shape \"disk\" @\"float phimax\" 0 \"bool radialuv\" true",
            "more than 0 degrees",
            "",
        ),
    ];
    cases.iter().for_each(check);
}

#[test]
fn quadrics_patches_and_cages() {
    let cases: [Case; 13] = [
        (
            "WorldBegin Shape \"sphere\" @\"float zmin\" 2 \"float zmax\" 3",
            "nothing of the sphere",
            "",
        ),
        (
            "WorldBegin Shape \"cylinder\" @\"float zmin\" 1",
            "`zmin` and `zmax` are equal",
            "",
        ),
        (
            "WorldBegin Shape \"cylinder\" @\"float phimax\" 0",
            "more than 0 degrees",
            "",
        ),
        (
            "WorldBegin Shape \"cylinder\" \"float radius\" @-1",
            "`radius` is -1, it must be positive",
            "",
        ),
        (
            "WorldBegin Shape \"disk\" @\"float innerradius\" 1",
            "the hole of the disk is as large",
            "",
        ),
        (
            "WorldBegin Shape \"disk\" \"float innerradius\" @-1",
            "must be 0 or more",
            "",
        ),
        ("WorldBegin Shape \"disk\" \"float height\" @nan", "finite", ""),
        ("WorldBegin Shape \"disk\" @\"float zmin\" 0", "no parameter `zmin`", ""),
        ("WorldBegin Shape @\"bilinearmesh\"", "no vertices", ""),
        (
            "WorldBegin Shape @\"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1 2 2 2]",
            "only one of 4 vertices needs none",
            "",
        ),
        (
            "WorldBegin Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1] \"integer indices\" @[0 1 2]",
            "4 integers a patch, found 3",
            "",
        ),
        (
            "WorldBegin Shape @\"loopsubdiv\" \"point3 P\" [0 0 0 1 0 0 0 1 0]",
            "this `loopsubdiv` has no `\"integer indices\"`",
            "",
        ),
        (
            "WorldBegin Shape \"loopsubdiv\" \"integer levels\" @21 \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 2]",
            "`levels` is 21, it must be from 0 to 20",
            "",
        ),
    ];
    cases.iter().for_each(check);
}

#[test]
fn curves() {
    let cases: [Case; 12] = [
        ("WorldBegin Shape @\"curve\"", "no vertices", ""),
        (
            "WorldBegin Shape \"curve\" \"point3 P\" @[0 0 0 1]",
            "3 numbers a vertex",
            "",
        ),
        (
            "WorldBegin Shape \"curve\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0] \"string type\" @\"round\"",
            "expected flat, cylinder, ribbon",
            "",
        ),
        (
            "WorldBegin Shape \"curve\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0] \"string basis\" @\"hermite\"",
            "expected bezier, bspline",
            "",
        ),
        (
            "WorldBegin Shape \"curve\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0] \"integer degree\" @4",
            "it must be 2 or 3",
            "",
        ),
        (
            "WorldBegin Shape \"curve\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0] \"float width\" @-1",
            "must be 0 or more",
            "",
        ),
        (
            "WorldBegin Shape \"curve\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0] @\"float width\" 0",
            "the curve has no width",
            "",
        ),
        (
            "WorldBegin Shape \"curve\" @\"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0 4 0 0]",
            "`P` has 5 points, expected 4 and 3 for each further segment",
            "",
        ),
        (
            "WorldBegin Shape \"curve\" \"string basis\" \"bspline\" @\"point3 P\" [0 0 0 1 0 0 2 0 0]",
            "expected 4 or more",
            "",
        ),
        (
            "WorldBegin Shape \"curve\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0] @\"string type\" \"ribbon\"",
            "needs normals",
            "",
        ),
        (
            "WorldBegin Shape \"curve\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0] \"string type\" \"ribbon\" @\"normal N\" [0 0 1]",
            "`N` is given 1 times, expected 2",
            "",
        ),
        (
            "WorldBegin Shape \"curve\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0] \"string type\" \"ribbon\" @\"normal N\" [0 0 1 0 0 0]",
            "normal 1 of `N` is zero",
            "",
        ),
    ];
    cases.iter().for_each(check);
}

#[test]
fn tubes() {
    let cases: [Case; 8] = [
        ("WorldBegin Shape @\"tubes\"", "no vertices", ""),
        (
            "WorldBegin Shape \"tubes\" \"string basis\" @\"bezier\" \"point3 P\" [0 0 0 1 1 1]",
            "`basis` is `bezier`, expected linear, bspline",
            "",
        ),
        (
            "WorldBegin Shape \"tubes\" @\"point3 P\" [0 0 0]",
            "`P` has 1 points, expected 2 or more",
            "",
        ),
        (
            "WorldBegin Shape \"tubes\" \"string basis\" \"bspline\" \"integer counts\" [4 @3] \"point3 P\" [0 0 0 1 1 1]",
            "a curve of 3 points, expected 4 or more",
            "",
        ),
        (
            "WorldBegin Shape \"tubes\" \"integer counts\" [@-4] \"point3 P\" [0 0 0 1 1 1]",
            "a curve of -4 points",
            "",
        ),
        (
            "WorldBegin Shape \"tubes\" \"integer counts\" @[2 2] \"point3 P\" [0 0 0 1 1 1 2 2 2]",
            "`counts` are 4 points together, but `P` has 3",
            "",
        ),
        (
            "WorldBegin Shape \"tubes\" \"float radius\" @[1 2 3] \"point3 P\" [0 0 0 1 1 1]",
            "`radius` is given for 3 vertices, but there are 2",
            "",
        ),
        (
            "WorldBegin Shape \"tubes\" \"float radius\" @[1 -2] \"point3 P\" [0 0 0 1 1 1]",
            "`radius` is -2, it must be 0 or more",
            "",
        ),
    ];
    cases.iter().for_each(check);
}

#[test]
fn attributes_of_meshes() {
    let cases: [Case; 6] = [
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"rgb vertex_color\" @[1 2 3]",
            "has 3 numbers, expected 3 for each of 3 vertices",
            "",
        ),
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"float face_heat\" @[1 2]",
            "has 2 numbers, expected 1 for each of 1 triangles",
            "",
        ),
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"float face_heat\" [@1e39]",
            "does not fit into 32-bit",
            "",
        ),
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] @\"float face_\" [1]",
            "cannot be the name of an attribute",
            "",
        ),
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] @\"vector3 vertex_color\" [1 2 3]",
            "has the type `vector3`, expected `float` or `rgb`",
            "",
        ),
        (
            "WorldBegin ColorSpace \"rec2020\" Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] @\"rgb face_color\" [1 2 3]",
            "colors of meshes are in srgb",
            "",
        ),
    ];
    cases.iter().for_each(check);
}
