//! The order and the nesting of directives, transforms, objects.

use super::{Case, check};

#[test]
fn structure() {
    let cases: [Case; 22] = [
        ("@Shape \"sphere\" WorldBegin", "only after `WorldBegin`", ""),
        ("@AttributeBegin WorldBegin", "only after `WorldBegin`", ""),
        ("WorldBegin @Camera \"perspective\"", "only before `WorldBegin`", ""),
        ("WorldBegin @WorldBegin", "only before `WorldBegin`", ""),
        ("WorldBegin @AttributeEnd", "nothing has been begun", ""),
        ("WorldBegin @AttributeBegin", "`AttributeEnd` for this is missing", ""),
        ("WorldBegin @ObjectBegin \"a\"", "`ObjectEnd` for this is missing", ""),
        (
            "WorldBegin ObjectBegin \"a\" @AttributeEnd ObjectEnd",
            "begun last is `ObjectBegin`",
            "",
        ),
        (
            "WorldBegin ObjectBegin \"a\" AttributeBegin @ObjectEnd AttributeEnd ObjectEnd",
            "last is `AttributeBegin`",
            "",
        ),
        (
            "WorldBegin ObjectBegin \"a\" ObjectBegin @\"b\" ObjectEnd ObjectEnd",
            "not allowed between",
            "",
        ),
        (
            "WorldBegin ObjectBegin \"a\" ObjectEnd ObjectBegin @\"a\" ObjectEnd",
            "an object `a` already",
            "",
        ),
        (
            "WorldBegin ObjectBegin \"tree\" ObjectEnd ObjectInstance @\"trea\"",
            "no object `trea`",
            "`tree`",
        ),
        (
            "WorldBegin ObjectBegin \"a\" ObjectInstance @\"a\" ObjectEnd",
            "not allowed between",
            "",
        ),
        (
            "WorldBegin AreaLightSource \"diffuse\" ObjectBegin \"a\" Shape @\"sphere\" ObjectEnd",
            "lights in an object",
            "",
        ),
        ("WorldBegin @Scale 1 0 1", "singular", ""),
        ("WorldBegin @Rotate 30 0 0 0", "axis", ""),
        ("WorldBegin @LookAt 0 0 0 0 0 1 0 0 2", "parallel", ""),
        (
            "WorldBegin @Transform [1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1]",
            "not affine",
            "",
        ),
        ("WorldBegin Scale 1e200 1 1 @Scale 1e200 1 1", "not finite", ""),
        (
            "WorldBegin CoordSysTransform @\"cmera\"",
            "no coordinate system `cmera`",
            "",
        ),
        ("@TransformTimes 1 1 WorldBegin", "must come before", ""),
        (
            "WorldBegin Attribute @\"sape\" \"float radius\" 1",
            "unknown target `sape`",
            "`shape`",
        ),
    ];
    cases.iter().for_each(check);
    check(&(
        "Camera \"perspective\" WorldBegin CoordSysTransform @\"cmera\"",
        "no coordinate system `cmera`",
        "`camera`",
    ));
}
