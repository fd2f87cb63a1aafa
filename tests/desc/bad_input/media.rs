use super::{Case, check};

#[test]
fn media() {
    let cases: [Case; 13] = [
        (
            "MakeNamedMedium @\"fog\" \"float g\" 0 WorldBegin",
            "this medium has no type",
            "",
        ),
        (
            "MakeNamedMedium \"fog\" \"string type\" @\"cloud\" WorldBegin",
            "the medium `cloud` is not supported yet",
            "",
        ),
        (
            "MakeNamedMedium \"fog\" \"string type\" @\"homogenous\" WorldBegin",
            "unknown medium `homogenous`",
            "`homogeneous`",
        ),
        (
            "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"float g\" @1 WorldBegin",
            "more than -1 and less than 1",
            "",
        ),
        (
            "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"float scale\" @-2 WorldBegin",
            "must be 0 or more",
            "",
        ),
        (
            "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 1 @-1 0 ] WorldBegin",
            "must be 0 or more",
            "",
        ),
        (
            "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_t\" [1 1 1] @\"rgb sigma_s\" [1 1 1] WorldBegin",
            "`sigma_t` and `sigma_s` exclude each other",
            "",
        ),
        (
            "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb albedo\" [1 @2 1] WorldBegin",
            "between 0 and 1",
            "",
        ),
        (
            "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"string preset\" @\"Cokes\" WorldBegin",
            "`preset` is one of",
            "`Coke`",
        ),
        (
            "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" @\"float density\" 1 WorldBegin",
            "has no parameter `density`",
            "",
        ),
        (
            "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" MakeNamedMedium @\"fog\" \"string type\" \"homogeneous\" WorldBegin",
            "there is a medium `fog` already",
            "",
        ),
        (
            "MakeNamedMedium @\"\" \"string type\" \"homogeneous\" WorldBegin",
            "a medium needs a name",
            "",
        ),
        (
            "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" WorldBegin MediumInterface @\"fok\" \"\" Shape \"sphere\"",
            "there is no medium `fok`",
            "`fog`",
        ),
    ];
    cases.iter().for_each(check);
}
