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
            "WorldBegin Shape @\"curve\" \"float width\" 3",
            "the shape `curve` is not supported yet",
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

#[test]
fn quadrics_patches_and_cages() {
    let cases: [Case; 15] = [
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
        (
            "WorldBegin Shape \"plymesh\" \"string filename\" \"x.ply\" \"texture displacement\" @\"no such\"",
            "no such",
            "",
        ),
        (
            "WorldBegin Shape \"plymesh\" \"string filename\" \"x.ply\" \"float displacement.edgelength\" @0",
            "must be positive",
            "",
        ),
    ];
    cases.iter().for_each(check);
}
