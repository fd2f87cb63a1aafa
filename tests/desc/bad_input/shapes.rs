//! `Shape`: kinds, values, meshes.

use super::{Case, check};

#[test]
fn kinds_and_values() {
    let cases: [Case; 12] = [
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
        ("WorldBegin Shape \"sphere\" @\"float zmin\" 0", "parts of spheres", ""),
        ("WorldBegin Shape @\"spere\"", "unknown shape `spere`", "`sphere`"),
        (
            "WorldBegin Shape @\"disk\" \"float radius\" 3",
            "the shape `disk` is not supported yet",
            "",
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
