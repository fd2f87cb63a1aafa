//! `Texture`, and where textures are named.

use super::{Case, check};
use crate::{errors, scene};

#[test]
fn textures() {
    let cases: [Case; 11] = [
        (
            "WorldBegin Texture \"a\" \"spectrum\" @\"ptex\" \"string filename\" \"x\"",
            "spectrum texture `ptex` is not supported yet",
            "",
        ),
        (
            "WorldBegin Texture \"a\" @\"color\" \"constant\"",
            "`float` or `spectrum`, not `color`",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" @\"mixx\"",
            "unknown float texture `mixx`",
            "`mix`",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"constant\" Texture @\"a\" \"float\" \"constant\"",
            "already",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"constant\" @\"rgb value\" [1 1 1]",
            "has the type `rgb`, expected `float`",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"spectrum\" \"constant\" @\"float value\" 1",
            "has the type `float`, expected `rgb`",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"scale\" @\"float amount\" 1",
            "float texture `scale` has no parameter `amount`",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"scale\" \"texture tex\" @\"b\" Texture \"b\" \"float\" \"constant\"",
            "defined before it",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"scale\" \"texture tex\" @\"a\"",
            "defined before it",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"directionmix\" @\"vector3 dir\" [0 0 0]",
            "must not be zero",
            "",
        ),
        (
            "@Texture \"a\" \"float\" \"constant\" WorldBegin",
            "only after `WorldBegin`",
            "",
        ),
    ];
    cases.iter().for_each(check);
}

#[test]
fn textures_may_not_be_stacked_without_end() {
    let chain = |n: usize| {
        let mut text = "WorldBegin Texture \"t0\" \"float\" \"constant\"\n".to_owned();
        for i in 1..n {
            text += &format!("Texture \"t{i}\" \"float\" \"scale\" \"texture tex\" \"t{}\"\n", i - 1);
        }
        text
    };
    assert_eq!(scene(&chain(64)).textures.len(), 64);
    let errors = errors(&chain(65));
    assert_eq!((errors.len(), errors[0].line), (1, 65), "{errors:?}");
    assert!(errors[0].message.contains("more than 64"));
}

#[test]
fn a_material_may_name_a_texture_that_is_defined_later() {
    let later = "WorldBegin Material \"diffuse\" \"texture reflectance\" \"a\" Texture \"a\" \"spectrum\" \"constant\"";
    assert_eq!(scene(later).textures[0].name, "a");
}

#[test]
fn image_textures() {
    let cases: [Case; 9] = [
        (
            "WorldBegin Texture \"a\" \"float\" @\"imagemap\"",
            "has no `\"string filename\"`",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"imagemap\" \"string filename\" @\"no-such.png\"",
            "cannot read the image",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"x.png\" \"string filter\" @\"ewa\"",
            "`filter` is one of point, bilinear, trilinear, EWA, not `ewa`",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"x.png\" \"string wrap\" @\"repeet\"",
            "`wrap` is one of",
            "`repeat`",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"imagemap\" \"string encoding\" @\"gamma 0\" \"string filename\" \"x.png\"",
            "`gamma` with a positive exponent",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"imagemap\" \"float maxanisotropy\" @0.5 \"string filename\" \"x.png\"",
            "must be 1 or more",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"checkerboard\" \"integer dimension\" @4",
            "must be 2 to 3",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"spectrum\" @\"fbm\"",
            "unknown spectrum texture `fbm`",
            "supported are constant, ",
        ),
        (
            "WorldBegin Shape \"sphere\" \"float alpha\" @1.5",
            "`alpha` is 1.5, it must be between 0 and 1",
            "",
        ),
    ];
    for case @ (marked, message, _) in &cases {
        if message.contains("one of") || message.contains("gamma") || message.contains("1 or more") {
            // The file is not there either.
            let text = marked.replace('@', "");
            assert!(errors(&text).iter().any(|e| e.message.contains(message)), "{marked}");
        } else {
            check(case);
        }
    }
}

#[test]
fn attributes_of_meshes() {
    let cases: [Case; 4] = [
        (
            "WorldBegin Texture \"a\" \"float\" @\"meshattribute\"",
            "this `meshattribute` has no `\"string name\"`",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" @\"meshattribute\" \"string name\" \"vertex_color\"",
            "no mesh has the attribute `vertex_color`: none has any",
            "",
        ),
        (
            "WorldBegin Texture \"a\" \"spectrum\" @\"meshattribute\" \"string name\" \"vertex_colour\"
            Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"float vertex_color\" [1 2 3]",
            "no mesh has the attribute `vertex_colour`: there are vertex_color",
            "`vertex_color`",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" @\"meshattribute\" \"string name\" \"face_color\"
            ObjectBegin \"o\" Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"rgb face_color\" [1 2 3] ObjectEnd",
            "the attribute `face_color` is a color",
            "",
        ),
    ];
    cases.iter().for_each(check);
}
